"""Landing: side load, drift, rebound (14 CFR 25.479 to 25.487)."""

from __future__ import annotations

from typing import ClassVar, Literal

from ..expressions.calculus import absolute
from ..quantities.record import Fraction, Number
from .base import FRICTION, Context, LoadCase, Loads, trail_left

__all__ = ["DriftLanding", "Rebound", "SideLoad"]

GRAVITY = 9.80665


class SideLoad(LoadCase):
    """Side load on the main gear: half the largest vertical of a level landing, 0.8 of that inward (0.6 outward)."""

    RULE: ClassVar[str] = "14 CFR 25.485(b)"
    READ: ClassVar[str] = "lexbuild.dev, faraim.org"
    GEARS: ClassVar[tuple[str, ...]] = ("main",)

    kind: Literal["side_load"]
    vertical_share: Fraction = 0.5
    """F_z over the largest vertical of a level landing [1]."""
    side: Fraction = FRICTION
    """Side force over F_z [1]."""

    def forces(self, context: Context) -> Loads:
        """At the friction limit: no pneumatic trail."""
        vertical = context.landing(self.vertical_share)
        return Loads(vertical, self.side * vertical, lever=absolute(context.e_eff) + trail_left(self.side) * context.trail)


class DriftLanding(LoadCase):
    """Drift landing: 75 % of the largest vertical, with 40 % of that as drag and 25 % as side force."""

    RULE: ClassVar[str] = "14 CFR 25.479(d)(2)"
    READ: ClassVar[str] = "lawstack.com"

    kind: Literal["drift_landing"]
    vertical_share: Fraction = 0.75
    """F_z over the largest vertical of a level landing [1]."""
    side: Fraction = 0.25
    """Side force over F_z [1]."""
    drag: Fraction = 0.4
    """Drag over F_z [1]."""

    def forces(self, context: Context) -> Loads:
        """Of two wheels one has the drag."""
        vertical = context.landing(self.vertical_share)
        lever = absolute(context.e_eff) + trail_left(self.side, self.drag) * context.trail
        return Loads(vertical, self.side * vertical, self.drag * vertical, lever, context.half_track)


class Rebound(LoadCase):
    """Rebound: a load factor of 20 on the unsprung mass, gear extended and in the air; no yaw torque."""

    RULE: ClassVar[str] = "14 CFR 25.487(b)"
    READ: ClassVar[str] = "faraim.org"
    NEEDS: ClassVar[tuple[str, ...]] = ("unsprung_mass",)

    kind: Literal["rebound"]
    load_factor: Number = 20.0
    """Of the unsprung mass [1]."""

    def forces(self, context: Context) -> Loads:
        """Downward, along the strut."""
        return Loads(self.load_factor * GRAVITY * context.unsprung_mass, acts_at="centre of the unsprung mass, downward")

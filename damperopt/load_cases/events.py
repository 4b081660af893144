"""What no rule prescribes: the tyre's own moment, the simulated shimmy, and a user's cases."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from ..expressions.calculus import absolute
from ..quantities.record import Coordinate, Distance, Name, Number, Torque
from ..quantities.units import Quantity
from .base import Context, LoadCase, Loads

__all__ = ["Given", "Shimmy", "TyreMoment"]

_Force = Annotated[float, Quantity("N", at_least=0, example="40 kN")]
_Torque = Annotated[float, Quantity("N m", at_least=0, example="2 kN m")]


class TyreMoment(LoadCase):
    """A yaw torque that is given, or a factor times the largest that the tyre's law can make."""

    RULE: ClassVar[str] = "requirements.limit_torque, or limit_torque_factor times the tyre's peak"
    READ: ClassVar[str] = "no rule"

    kind: Literal["tyre_moment"]
    torque: Torque | None = None
    """Limit yaw torque [N m]; left out: requirements.limit_torque, else the factor times the peak of the tyre."""
    factor: Number | None = None
    """On the peak of the tyre [1]; left out: requirements.limit_torque_factor."""

    def missing(self, context: Context) -> tuple[str, ...]:
        """A torque, where the tyre has no peak."""
        given = (self.torque, context.limit_torque, context.tyre_moment)
        return () if any(torque is not None for torque in given) else ("requirements.limit_torque",)

    def forces(self, context: Context) -> Loads:
        """The torque alone."""
        torque = self.torque if self.torque is not None else context.limit_torque if self.factor is None else None
        if torque is None:
            torque = (context.limit_torque_factor if self.factor is None else self.factor) * context.tyre_moment
        return Loads(context.largest_vertical, moment=torque, acts_at="footprint")


class Shimmy(LoadCase):
    """The shimmy event itself: the peak of the simulated release or kick of the decay requirement."""

    RULE: ClassVar[str] = "simulated release or kick"
    READ: ClassVar[str] = "no rule"
    NEEDS: ClassVar[tuple[str, ...]] = ("shimmy_torque",)

    kind: Literal["shimmy"]

    @property
    def nature(self) -> Literal["static", "dynamic"]:
        """The peak of a motion."""
        return "dynamic"

    def forces(self, context: Context) -> Loads:
        """The torque alone."""
        return Loads(context.largest_vertical, moment=context.shimmy_torque, acts_at="strut axis")


class Given(LoadCase):
    """A case of one's own: forces at the ground, and a torque beside them."""

    READ: ClassVar[str] = "the study"

    kind: Literal["given"]
    by: Name = "the study"
    """Rule or report that it comes from."""
    vertical: _Force
    """F_z [N]."""
    side: _Force = 0.0
    """Side force [N]."""
    drag: _Force = 0.0
    """Drag [N]."""
    lever: Coordinate | None = None
    """Of the side force behind the strut axis [m]; left out: e_eff."""
    offset: Distance | None = None
    """Of the drag beside the strut axis [m]; left out: half the track of two wheels."""
    torque: _Torque = 0.0
    """Beside what the forces make [N m]."""
    loads_are: Literal["limit", "ultimate"] = "limit"
    """Limit loads or ultimate ones."""
    acts: Literal["static", "dynamic"] = "static"
    """Static, or the peak of a motion."""
    acts_at: Name = "ground contact point"
    """Where the forces act."""

    @property
    def rule(self) -> str:
        """Whence it comes."""
        return self.by

    @property
    def level(self) -> Literal["limit", "ultimate"]:
        """As given."""
        return self.loads_are

    @property
    def nature(self) -> Literal["static", "dynamic"]:
        """As given."""
        return self.acts

    def forces(self, context: Context) -> Loads:
        """As given."""
        lever = absolute(context.e_eff if self.lever is None else self.lever)
        offset = context.half_track if self.offset is None else self.offset
        return Loads(self.vertical, self.side, self.drag, lever, offset, self.torque, self.acts_at)

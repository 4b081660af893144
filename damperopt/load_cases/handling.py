"""Ground handling: braking, turning, pivoting, towing, a flat tyre (14 CFR 25.493 to 25.511)."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal, Self

from pydantic import model_validator

from ..expressions.calculus import Expr, absolute, cos, log, sin, sqrt, where
from ..quantities.record import Fraction, Number, Torque, refuse
from ..quantities.units import Quantity
from .base import FRICTION, Context, LoadCase, Loads, trail_left

__all__ = [
    "BrakedRoll",
    "FlatTyre",
    "NoseSteering",
    "NoseYaw",
    "Pivoting",
    "ReversedBraking",
    "Towing",
    "Turning",
    "scrub_radius",
    "towing_force",
]

POUND = 4.4482216152605
"""Of force [N]."""


class BrakedRoll(LoadCase):
    """Braked roll: drag of 0.8 of the vertical, at 1 g and ramp weight (1.2 g at landing weight)."""

    RULE: ClassVar[str] = "14 CFR 25.493"
    READ: ClassVar[str] = "faraim.org"
    GEARS: ClassVar[tuple[str, ...]] = ("main",)

    kind: Literal["braked_roll"]
    load_factor: Number = 1.0
    """Vertical load factor [1]."""
    drag: Fraction = FRICTION
    """Drag over F_z [1]."""

    def forces(self, context: Context) -> Loads:
        """Of two wheels one has it all: one brake, or one flat tyre."""
        vertical = self.load_factor * context.static
        return Loads(vertical, drag=self.drag * vertical, offset=context.half_track)


class Turning(LoadCase):
    """Turning: a side force of half the vertical."""

    RULE: ClassVar[str] = "14 CFR 25.495"
    READ: ClassVar[str] = "lexbuild.dev, gpo.gov (2006)"

    kind: Literal["turning"]
    side: Fraction = 0.5
    """Side force over F_z [1]."""

    def forces(self, context: Context) -> Loads:
        """Short of the friction limit: some of the pneumatic trail is left."""
        lever = absolute(context.e_eff) + trail_left(self.side) * context.trail
        return Loads(context.static, self.side * context.static, lever=lever)


class NoseYaw(LoadCase):
    """Nose-wheel yaw: a side force of 0.8 of the vertical at 1 g."""

    RULE: ClassVar[str] = "14 CFR 25.499(a)"
    GEARS: ClassVar[tuple[str, ...]] = ("nose",)

    kind: Literal["nose_yaw"]
    side: Fraction = FRICTION
    """Side force over F_z [1]."""

    def forces(self, context: Context) -> Loads:
        """At the friction limit: no pneumatic trail."""
        lever = absolute(context.e_eff) + trail_left(self.side) * context.trail
        return Loads(context.static, self.side * context.static, lever=lever)


class NoseSteering(LoadCase):
    """Nose-wheel steering: full steering torque, with 1.33 of the static vertical."""

    RULE: ClassVar[str] = "14 CFR 25.499(e)"
    GEARS: ClassVar[tuple[str, ...]] = ("nose",)

    kind: Literal["nose_steering"]
    torque: Torque | None = None
    """Full normal steering torque [N m]."""
    vertical_factor: Number = 1.33
    """F_z over the static reaction [1]."""

    @model_validator(mode="after")
    def _enabled_with_torque(self) -> Self:
        if self.enabled and self.torque is None:
            raise refuse("enabled", "a case without its torque", "torque, or leave the case off")
        return self

    def missing(self, context: Context) -> tuple[str, ...]:
        """Its torque."""
        return () if self.torque is not None else ("loads.cases.nose_steering.torque",)

    def forces(self, context: Context) -> Loads:
        """The torque, and the vertical beside it."""
        return Loads(self.vertical_factor * context.static, moment=self.torque, acts_at="steering")


class Pivoting(LoadCase):
    """Pivoting about a main gear with locked brakes: the footprint scrubs on the spot at a friction of 0.8."""

    RULE: ClassVar[str] = "14 CFR 25.503"
    READ: ClassVar[str] = "pilotfriend.com"
    GEARS: ClassVar[tuple[str, ...]] = ("main",)

    kind: Literal["pivoting"]
    friction: Fraction = FRICTION
    """Of the tyre on the ground [1]."""
    pressure: Literal["uniform", "parabolic"] = "uniform"
    """Along the footprint."""

    def forces(self, context: Context) -> Loads:
        """Friction times vertical times the mean distance of the footprint from the pivot."""
        radius = scrub_radius(context.half_contact_length, context.half_track, self.pressure)
        return Loads(context.static, moment=self.friction * context.static * radius, acts_at="footprint")


def scrub_radius(a: Expr, half_track: Expr = None, pressure: str = "uniform") -> Expr:
    """Mean distance of a narrow footprint from the strut axis, by its pressure [m].

    Parameters
    ----------
    a : Expr
        Half contact length [m].
    half_track : Expr or None
        Of two wheels [m]; None or 0: on the axis.
    pressure : str
        ``uniform`` or ``parabolic``.

    Examples
    --------
    >>> scrub_radius(0.1), round(scrub_radius(0.1, pressure="parabolic"), 12)
    (0.05, 0.0375)
    """
    if half_track is None or (isinstance(half_track, (int, float)) and half_track == 0):
        return a / 2 if pressure == "uniform" else 3 * a / 8
    # w half track, r distance of the ends; integrals of r and x^2 r over 0 < x < a
    w = half_track
    r = sqrt(a**2 + w**2)
    log_term = log((a + r) / w)
    of_r = (a * r + w**2 * log_term) / 2
    if pressure == "uniform":
        return of_r / a
    of_x2_r = (a * (2 * a**2 + w**2) * r - w**4 * log_term) / 8
    return 1.5 / a**3 * (a**2 * of_r - of_x2_r)


class ReversedBraking(LoadCase):
    """Reversed braking: 0.55 of the vertical, or 1.2 times the brakes' static torque if that is less."""

    RULE: ClassVar[str] = "14 CFR 25.507"
    READ: ClassVar[str] = "faraim.org"
    GEARS: ClassVar[tuple[str, ...]] = ("main",)

    kind: Literal["reversed_braking"]
    drag: Fraction = 0.55
    """Forward force over F_z [1]."""
    brake_factor: Number = 1.2
    """On the nominal maximum static brake torque [1]."""

    def forces(self, context: Context) -> Loads:
        """Of two wheels one has it all."""
        drag = self.drag * context.static
        if context.brake_torque is not None:
            by_brake = self.brake_factor * context.brake_torque / context.wheel_radius
            drag = where(by_brake < drag, by_brake, drag)
        return Loads(context.static, drag=drag, offset=context.half_track)


class Towing(LoadCase):
    """Towing at the main gear: 0.75 of the tow force, 30 degrees from straight ahead; the ground answers its side part."""

    RULE: ClassVar[str] = "14 CFR 25.509"
    READ: ClassVar[str] = "faraim.org, risingup.com (two copies print /7 for /70, which would jump at 30 000 lb)"
    GEARS: ClassVar[tuple[str, ...]] = ("main",)
    NEEDS: ClassVar[tuple[str, ...]] = ("aircraft_weight",)

    kind: Literal["towing"]
    share: Fraction = 0.75
    """Of the tow force, per main gear [1]."""
    angle: Annotated[float, Quantity("rad", at_least=0, below=1.5707963, example="30 deg")] = 0.5235987755982988
    """Of the force to straight ahead [rad]."""

    def forces(self, context: Context) -> Loads:
        """Tow fitting in the plane of the strut axis: drag has no offset."""
        force = self.share * towing_force(context.aircraft_weight)
        side, drag = force * sin(self.angle), force * cos(self.angle)
        return Loads(context.static, side, drag, absolute(context.e_eff), acts_at="tow fitting and static ground line")


class FlatTyre(LoadCase):
    """One of two tyres is flat: the other has the drag of braking that it has beside a sound one; half the side of a turn."""

    RULE: ClassVar[str] = "14 CFR 25.511(e)"
    READ: ClassVar[str] = "faraim.org (2019)"

    kind: Literal["flat_tyre"]
    side: Fraction = 0.25
    """Side force over F_z, 50 % of the side load factor of a turn [1]."""
    drag: Fraction = FRICTION / 2
    """Drag over F_z at the inflated tyre, its half of a braked roll; 40 % of the drag load factor would be less [1]."""

    def missing(self, context: Context) -> tuple[str, ...]:
        """A second wheel."""
        return () if context.wheels == 2 else ("two wheels",)

    def forces(self, context: Context) -> Loads:
        """F_z is not less than at 1 g; the drag is that of one wheel, and of a gear with brakes."""
        lever, braked = absolute(context.e_eff) + trail_left(self.side, self.drag) * context.trail, context.gear == "main"
        drag = self.drag * context.static if braked else 0.0
        return Loads(context.static, self.side * context.static, drag, lever, context.half_track)


def towing_force(weight: Expr) -> Expr:
    """F_TOW by the weight of the aircraft at ramp [N], 25.509(a)(3).

    Parameters
    ----------
    weight : Expr
        A force [N].

    Examples
    --------
    >>> [round(towing_force(W * POUND) / POUND) for W in (20e3, 30e3, 65e3, 100e3, 200e3)]
    [6000, 9000, 12000, 15000, 30000]
    """
    W = weight / POUND
    middle = where(W > 100e3, 0.15 * W, (6 * W + 450e3) / 70)
    return POUND * where(W < 30e3, 0.3 * W, middle)

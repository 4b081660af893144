"""What every gear is: how it moves its wheels, and how the ground and the damper move it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, ClassVar, Self

from pydantic import Field, model_validator

from ..expressions.calculus import Expr, cos, sin, tan
from ..expressions.corners import Corners
from ..ports.motion import Attachment, Motion, Torque
from ..ports.wheel import Contact, Wheel
from ..quantities.named import Output, State
from ..quantities.record import Angle, Coordinate, Inertia, Record
from ..quantities.units import Quantity
from .friction import Friction
from .strut import ShockStrut

__all__ = ["Gear", "Names"]

EXAMPLE = {
    "gas": {"pressure": "1.2 MPa", "area": "0.012 m^2", "volume": "0.005 m^3", "exponent": 1.1},
    "travel": "0.3 m",
}

Names = Mapping[str, Expr]
"""States by name."""


class Gear(Record):
    """Landing gear: the numbers that all gears have, and the questions that the model asks of each.

    A gear is a file of its own with a class derived from this one, a literal `kind`, its `STATES`, and the methods `wheels`
    and `rates`. The yaw of the piston about the strut axis is always there, as ``yaw_angle`` and ``yaw_rate``.
    """

    GROUP: ClassVar[str] = "damperopt.gears"
    STATES: ClassVar[tuple[State, ...]] = ()
    OUTPUTS: ClassVar[tuple[Output, ...]] = ()
    SPEED_POWERS: ClassVar[tuple[int, ...]] = (-1, 0, 1)
    """Powers of V in the linear model, beside those of the tyre."""
    LOAD_POWERS: ClassVar[tuple[int, ...] | None] = (0, 1)
    """Powers of F_z; None: no polynomial in F_z, so that proofs go load by load."""
    ORDER: ClassVar[int | None] = None
    """What older studies call this kind: ``order: 3``."""
    EXTENDS: ClassVar[tuple[str, str] | None] = None
    """(kind, key): a study of that kind which gives the key means this kind."""
    MIRRORS: ClassVar[bool] = True
    """Whether a mirrored motion is a motion too."""
    STROKES: ClassVar[bool] = True
    """Whether its numbers follow the stroke of a shock strut."""

    kind: str
    yaw_inertia: Inertia
    """I_z of all that yaws, about the strut axis [kg m^2]."""
    caster_length: Coordinate
    """e, offset of the axle from the strut axis, + behind it [m]; the mechanical trail with rake is `lever`."""
    rake_angle: Angle = 0.0
    """phi, between the strut axis and the vertical, + with the foot of the strut forward [rad]."""
    wheel_radius: Annotated[float, Quantity("m", above=0, example="0.36 m")]
    """R_w, loaded [m]."""
    friction: Friction | None = None
    """Dry friction of the strut in yaw."""
    strut: Annotated[ShockStrut | None, Field(examples=[EXAMPLE])] = None
    """Shock strut that comes in under the load; left out: its stroke is frozen, and all numbers hold as they are given."""

    @model_validator(mode="after")
    def _strut_fits(self) -> Self:
        if self.strut is not None:
            self.strut.refuse_beside(self)
        return self

    def wheels(self, x: Names, speed: Expr, load: Expr) -> tuple[Wheel, ...]:
        """The wheels on the ground.

        Parameters
        ----------
        x : mapping of str to Expr
            States by name.
        speed, load : Expr
            V [m/s], and F_z on the gear [N].
        """
        raise NotImplementedError  # every kind says it

    def rates(self, x: Names, contacts: Sequence[Contact], damper: Torque, yaw_torque: Expr, corners: Corners) -> Motion:
        """Equations of motion.

        Parameters
        ----------
        x : mapping of str to Expr
            States by name.
        contacts : sequence of Contact
            One for each wheel, in their order; each knows its wheel.
        damper : Torque
            Of linkage and damper; ``damper.torque`` acts on the piston.
        yaw_torque : Expr
            External, about the strut axis [N m].
        corners : Corners
            Version of the nonlinear elements.
        """
        raise NotImplementedError  # every kind says it

    def lever(self) -> Expr:
        """Effective caster with rake, e cos(phi) + (R_w + e sin(phi)) tan(phi) [m]; thesis (4-5)."""
        e, phi, R_w = self.caster_length, self.rake_angle, self.wheel_radius
        return e * cos(phi) + (R_w + e * sin(phi)) * tan(phi)

    def stroke(self, load: Expr) -> Expr:
        """Of the shock strut at a vertical load on the gear [N], from fully out [m]; 0 without one."""
        return 0 if self.strut is None else self.strut.at_load(load)

    def at(self, load: Expr, stroke: Expr, rate: Expr = 0) -> Self:
        """The gear with its numbers as they are at a load [N], a stroke of the strut [m] and a rate of it [m/s]."""
        return self if self.strut is None else self.model_copy(update=self.strut.changed(self, load, stroke, rate))

    @property
    def load_powers(self) -> tuple[int, ...] | None:
        """Powers of F_z with the strut, whose stroke is no polynomial."""
        return self.LOAD_POWERS if self.strut is None else None

    @property
    def order(self) -> int:
        """Of the linear gear with a string tyre of one state, as the field counts it."""
        return len(self.states()) + 1

    def states(self) -> tuple[State, ...]:
        """States of the gear; one whose numbers say how many it has says it here."""
        return self.STATES

    def attachments(self, x: Names) -> dict[str, Attachment]:
        """Where linkages act: ``damper`` between piston and strut."""
        return {"damper": Attachment(x["yaw_angle"], x["yaw_rate"])}

    def leaves_out(self) -> tuple[str, ...]:
        """What a proof of this gear does not speak of, in words."""
        friction = "dry friction of the strut (gear.friction)"
        if self.friction is not None:
            friction = "the dry friction of the strut: simulate has it"
        strut = "motion of the shock strut: its stroke is frozen (gear.strut)"
        if self.strut is not None:
            strut = "motion of the shock strut: at each load it stands in balance, at rest (quasi-static)"
        drag = getattr(self, "drag", None)  # of kinds that have it in their equations
        return (friction, *(() if drag is None else drag.leaves_out()), strut)

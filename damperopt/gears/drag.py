"""Steady forces of the ground along a wheel, backwards: of braking, and of rolling.

They act in the plane of the wheel, which holds the strut axis: by themselves they have no moment about it. But the ground holds
the tyre where it has given way sideways, by w = F_y/K_y in the direction of the side force, and there a drag D turns the wheel
on, with D w about the vertical: the side force acts on a trail that is shorter by D/K_y. And a wheel that swivels takes its
drag with it: D sin(theta) pushes the strut to the side to which the wheel has swung. A brake holds its wheel on the strut, so
that its drag acts at the ground; a wheel that rolls freely hands on what it feels through its axle alone.
"""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from ..errors import ConfigError
from ..expressions.calculus import Expr, sin
from ..ports.wheel import Contact, Wheel
from ..quantities.record import Record, Stiffness, refuse
from ..quantities.units import Quantity

__all__ = ["Drag", "Dragged", "deflected", "pushes"]


class Drag(Record):
    """Steady braking and rolling drag of the gear, the same on every wheel of it."""

    brake_torque: Annotated[float, Quantity("N m", at_least=0, example="3 kN m")] = 0.0
    """T_b, steady, of all brakes about the axle [N m]."""
    force: Annotated[float, Quantity("N", at_least=0, example="1 kN")] = 0.0
    """D_r of wheels that roll freely, as on soft ground [N]."""
    rolling_resistance: Annotated[float, Quantity("1", at_least=0, below=1, example="0.02")] = 0.0
    """Such a drag over the vertical load, beside that force [1]."""
    lateral_stiffness: Stiffness | None = None
    """K_y, side force over side deflection of all tyres [N/m]; left out: that of their strings, C_Fa/(a + sigma) each."""

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not (self.brake_torque or self.force or self.rolling_resistance):
            raise refuse("", "no drag", "brake_torque, force or rolling_resistance above 0, or no block drag")
        return self

    def braking(self, radius: Expr) -> Expr:
        """D_b = T_b/R_w [N]."""
        return self.brake_torque / radius

    def rolling(self, load: Expr) -> Expr:
        """D_r at a vertical load [N]."""
        return self.force + self.rolling_resistance * load

    def leaves_out(self) -> tuple[str, ...]:
        """Words."""
        return (
            "the grip that a steady drag takes from the side force, and what it does to stiffness and speed (gear.drag)",
            "rolling with less drag than this one, and free of it (gear.drag)",
        )


Dragged = Annotated[Drag | None, Field(examples=[{"brake_torque": "1 kN m", "lateral_stiffness": "1 MN/m"}])]
"""Of a gear."""


def deflected(drag: Drag | None, contact: Contact, radius: Expr) -> Expr:
    """Moment D w about the vertical that turns the wheel on [N m].

    Parameters
    ----------
    drag : Drag or None
    contact : Contact
    radius : Expr
        R_w [m].
    """
    if drag is None:
        return 0
    assert contact.wheel is not None
    if drag.lateral_stiffness is None and contact.deflection is None:
        allowed = "a stiffness, which this contact line does not know"
        raise ConfigError(f"gear.drag.lateral_stiffness: missing key; allowed: {allowed}")
    w = contact.deflection if drag.lateral_stiffness is None else contact.side_force / drag.lateral_stiffness
    return (drag.braking(radius) + drag.rolling(contact.wheel.load)) * w


def pushes(drag: Drag | None, wheel: Wheel, radius: Expr) -> tuple[Expr, Expr]:
    """What the drag pushes the strut aside with, at the ground and at the axle: D_b sin(theta), D_r sin(theta) [N].

    Parameters
    ----------
    drag : Drag or None
    wheel : Wheel
    radius : Expr
        R_w [m].
    """
    if drag is None:
        return 0, 0
    return drag.braking(radius) * sin(wheel.swivel), drag.rolling(wheel.load) * sin(wheel.swivel)

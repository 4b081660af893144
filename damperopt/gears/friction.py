"""Dry friction of the strut."""

from __future__ import annotations

from typing import Annotated

from ..expressions.calculus import Expr
from ..expressions.corners import Corners
from ..quantities.record import Record
from ..quantities.units import Quantity

__all__ = ["Friction", "friction_torque"]


class Friction(Record):
    """Dry (Coulomb) friction of the strut in yaw."""

    torque: Annotated[float, Quantity("N m", above=0, example="50 N m")]
    """Largest, sliding or sticking [N m]."""
    smoothing: Annotated[float, Quantity("rad/s", above=0, example="0.001 rad/s")] = 1e-3
    """Yaw rate over which the smooth version turns around [rad/s]."""


def friction_torque(friction: Friction | None, rate: Expr, corners: Corners) -> Expr:
    """Torque [N m] against the yaw rate [rad/s]; 0 without friction.

    An exact simulation lets it stick: it knows the corner by its name ``friction``.

    Parameters
    ----------
    friction : Friction or None
    rate : Expr
        Yaw rate [rad/s].
    corners : Corners
        Version of the nonlinear elements.
    """
    if friction is None:
        return 0
    return friction.torque * corners.sign("friction", rate, friction.smoothing)

"""Records of what a real gear has besides its ideal linkage: compliance, freeplay, stops, friction, orifices."""

from __future__ import annotations

from typing import Annotated

from ..quantities.record import Length, Record, Stiffness, Torque
from ..quantities.units import Quantity

__all__ = ["EndStop", "Freeplay", "Friction", "Orifice"]

_Smoothing = Annotated[float, Quantity("1", above=0, at_most=0.5)]


class Freeplay(Record):
    """Clearance of the apex joint: it moves freely by `gap` to either side before it carries a force."""

    gap: Length
    """To one side, along the path of the apex [m]."""
    smoothing: _Smoothing = 0.02
    """Width of the rounded corner of the smooth version, as a fraction of the gap."""


class EndStop(Record):
    """Stop of the damper at +-`stroke` from rest; without `stiffness` the model ends there."""

    stroke: Length
    stiffness: Stiffness | None = None
    """Of the contact [N/m]."""
    smoothing: _Smoothing = 0.002
    """Width of the rounded corner of the smooth version, as a fraction of the stroke."""


class Friction(Record):
    """Dry (Coulomb) friction of the strut in yaw."""

    torque: Torque
    smoothing: Annotated[float, Quantity("rad/s", above=0, example="0.001 rad/s")] = 1e-3
    """Yaw rate over which the smooth version turns around [rad/s]."""


class Orifice(Record):
    """Quadratic damping of an orifice, F = c_lambda v + coefficient v |v|."""

    coefficient: Annotated[float, Quantity("N s^2/m^2", above=0, example="5e4 N s^2/m^2")]
    smoothing: Annotated[float, Quantity("m/s", above=0, example="1 mm/s")] = 1e-3
    """Damper speed below which the smooth version is rounded [m/s]."""

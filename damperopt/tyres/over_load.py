"""Numbers of a tyre that may be tables over the load of the wheel."""

from __future__ import annotations

from typing import Annotated, Any

from ..ports.over_load import OverLoad, over_load
from ..quantities.record import Length
from ..quantities.units import Quantity

__all__ = ["LengthOverLoad", "SlopeOverLoad"]

CorneringStiffness = Annotated[float, Quantity("N/rad", above=0, example="440 kN/rad")]


class LengthTable(OverLoad):
    """A length over load, ``{load: [50 kN, 100 kN], value: [0.12 m, 0.17 m]}``."""

    value: tuple[Length, ...]
    """The length at each load [m]."""


class SlopeTable(OverLoad):
    """A cornering stiffness over load, ``{load: [50 kN, 100 kN], value: [300 kN/rad, 440 kN/rad]}``."""

    value: tuple[CorneringStiffness, ...]
    """The cornering stiffness at each load [N/rad]."""


LengthOverLoad: Any = over_load(Length, LengthTable)
SlopeOverLoad: Any = over_load(CorneringStiffness, SlopeTable)

"""A length of a tyre that changes with the load: a table, in straight lines between its points."""

from __future__ import annotations

from functools import partial
from itertools import pairwise
from typing import Annotated, Any, Self, TypeAlias

from pydantic import Discriminator, Tag, model_validator

from ..expressions.calculus import Expr, piecewise
from ..quantities.record import Force, Length, Record, refuse

__all__ = ["LengthOverLoad", "OverLoad"]


class OverLoad(Record):
    """A length at some loads of the wheel, ``{load: [50 kN, 100 kN], value: [0.12 m, 0.17 m]}``."""

    load: tuple[Force, ...]
    """Loads of one wheel, ascending [N]."""
    value: tuple[Length, ...]
    """The length at each of them [m]."""

    @model_validator(mode="after")
    def _whole(self) -> Self:
        if len(self.load) < 2 or len(self.load) != len(self.value):
            found = f"{len(self.load)} loads and {len(self.value)} values"
            raise refuse("", found, "as many values as loads, two at least")
        if any(low >= high for low, high in pairwise(self.load)):
            raise refuse("load", "loads that do not ascend", "each above the one before")
        return self

    def at(self, load: Expr) -> Expr:
        """The length at a load [N]; beyond the table its last line goes on, and `Tyre.beyond` says so."""
        points = list(zip(self.load, self.value, strict=True))
        return piecewise(load, self.load[1:-1], [partial(_line, *ends) for ends in pairwise(points)])


def _line(start: tuple[float, float], end: tuple[float, float], load: Expr) -> Expr:
    (F_0, l_0), (F_1, l_1) = start, end
    return l_0 + (l_1 - l_0) / (F_1 - F_0) * (load - F_0)


def _which(found: Any) -> str:
    return "<table>" if isinstance(found, (dict, OverLoad)) else "<number>"


LengthOverLoad: TypeAlias = Annotated[
    Annotated[Length, Tag("<number>")] | Annotated[OverLoad, Tag("<table>")], Discriminator(_which)
]
"""A number with a unit, or a table over the load."""

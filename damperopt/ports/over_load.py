"""A number that changes with the load: a table, in straight lines between its points."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import pairwise
from typing import Annotated, Any, Self

from pydantic import Discriminator, Tag, model_validator

from ..expressions.calculus import Expr, piecewise
from ..quantities.record import Force, Record, refuse

__all__ = ["OverLoad", "over_load", "straight"]


class OverLoad(Record):
    """A number at some loads, ``{load: [50 kN, 100 kN], value: [0.12 m, 0.17 m]}``."""

    load: tuple[Force, ...]
    """Ascending [N]; of one wheel in a tyre's table, of the whole gear in that of a strut."""
    value: tuple[float, ...]
    """The number at each of them, in the unit of its key."""

    @model_validator(mode="after")
    def _whole(self) -> Self:
        if len(self.load) < 2 or len(self.load) != len(self.value):
            found = f"{len(self.load)} loads and {len(self.value)} values"
            raise refuse("", found, "as many values as loads, two at least")
        if any(low >= high for low, high in pairwise(self.load)):
            raise refuse("load", "loads that do not ascend", "each above the one before")
        return self

    def at(self, load: Expr) -> Expr:
        """The number at a load [N]; beyond the table its last line goes on, and `beyond` says so."""
        return straight(load, self.load, self.value)


def straight(x: Expr, places: Sequence[float], values: Sequence[float]) -> Expr:
    """Straight lines through values at ascending places; beyond them the last line goes on."""
    points = list(zip(places, values, strict=True))
    return piecewise(x, places[1:-1], [partial(_line, *ends) for ends in pairwise(points)])


def _line(start: tuple[float, float], end: tuple[float, float], load: Expr) -> Expr:
    (F_0, v_0), (F_1, v_1) = start, end
    return v_0 + (v_1 - v_0) / (F_1 - F_0) * (load - F_0)


def over_load(number: Any, table: type[OverLoad]) -> Any:
    """Field type of a number that may be a table over the load as well."""
    return Annotated[
        Annotated[number, Tag("<number>")] | Annotated[table, Tag("<table>")],
        Discriminator(lambda found: "<table>" if isinstance(found, (dict, OverLoad)) else "<number>"),
    ]

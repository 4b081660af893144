"""A sweep and its points, each made when it is asked for."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from math import prod
from typing import Any, overload

import numpy as np

from ..errors import ConfigError
from ..provenance import program
from ..study.study import Study

__all__ = ["Point", "Points", "Sweep", "study_or_problem"]

MOST_PROBES = 1000
"""Points that are looked at before the work begins."""


@dataclass(frozen=True)
class Point:
    """A study of a sweep; it is made when it is asked for, as there may be a million.

    Attributes
    ----------
    index : int
    values : dict
        Of what is varied, by key path: numbers [SI] or names.
    base : Study
    given : dict
        The same values as the file gives them.
    """

    index: int
    values: dict[str, float | str]
    base: Study
    given: dict[str, Any]

    @cached_property
    def _made(self) -> tuple[Study | None, str]:
        return study_or_problem(self.base, self.given)

    @property
    def study(self) -> Study | None:
        """None where the values make none."""
        return self._made[0]

    @property
    def problem(self) -> str:
        """Why they make none."""
        return self._made[1]


@dataclass(frozen=True, eq=False)
class Points(Sequence[Point]):
    """The grid in the order of the axes, the last one fastest; samples within.

    Attributes
    ----------
    base : Study
    given, axes : dict
        Values of each axis, as the file gives them and as a study keeps them.
    draws : dict
        Values of each sampled key [SI], arrays of equal length; empty without samples.
    """

    base: Study
    given: dict[str, list[Any]]
    axes: dict[str, tuple[float | str, ...]]
    draws: dict[str, np.ndarray]

    @property
    def samples(self) -> int:
        """For every point of the grid; 1 without samples."""
        return len(next(iter(self.draws.values()))) if self.draws else 1

    def __len__(self) -> int:
        return prod(map(len, self.axes.values())) * self.samples

    @overload
    def __getitem__(self, index: int) -> Point: ...

    @overload
    def __getitem__(self, index: slice) -> Sequence[Point]: ...

    def __getitem__(self, index: int | slice) -> Point | Sequence[Point]:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        if not -len(self) <= index < len(self):
            raise IndexError(index)
        rest, sample = divmod(index % len(self), self.samples)
        drawn = {key: float(column[sample]) for key, column in self.draws.items()}
        chosen: dict[str, int] = {}
        for key in reversed(self.axes):
            rest, chosen[key] = divmod(rest, len(self.axes[key]))
        values: dict[str, float | str] = {key: shown[chosen[key]] for key, shown in self.axes.items()}
        given = {key: raw[chosen[key]] for key, raw in self.given.items()}
        return Point(index % len(self), {**values, **drawn}, self.base, given | drawn)


@dataclass(frozen=True, eq=False)
class Sweep:
    """A sweep that can be run.

    Attributes
    ----------
    name : str
    run : str
        ``optimise`` or ``analyse``.
    points : Points
    warm_start : bool
        Whether a point takes its nearest finished neighbour's design for the study's own start; the other starts stay.
    eigenvalue_speeds : int
        Speeds at which eigenvalues are stored.
    units : dict
        SI unit of each key with numbers.
    """

    name: str
    run: str
    points: Points
    warm_start: bool
    eigenvalue_speeds: int
    units: dict[str, str]

    @property
    def axes(self) -> dict[str, tuple[float | str, ...]]:
        """Values of each key of the grid, in order; empty without one."""
        return self.points.axes

    @property
    def sampled(self) -> tuple[str, ...]:
        """Keys that are sampled."""
        return tuple(self.points.draws)

    @property
    def count(self) -> int:
        """Samples for every point of the grid; 1 without samples."""
        return self.points.samples

    @cached_property
    def spans(self) -> dict[str, float]:
        """Largest less smallest value of each key with numbers [SI]; 1 where they are equal."""
        numbers = {key: shown for key, shown in self.axes.items() if isinstance(shown[0], float)} | self.points.draws
        return {key: float(np.ptp(np.array(values, float))) or 1.0 for key, values in numbers.items()}

    def key(self, point: Point) -> str:
        """What identifies the work at a point: the question, and the program that answers it."""
        shown = [
            (key, value if isinstance(value, float) else json.dumps(point.given[key], sort_keys=True, default=str))
            for key, value in point.values.items()
        ]
        return sha256(f"{self._question} {shown!r}".encode()).hexdigest()

    @cached_property
    def _question(self) -> str:
        return f"{program()} {self.run} {self.eigenvalue_speeds} {self.points.base.model_dump_json()}"

    def probes(self) -> Sequence[Point]:
        """All points of a small sweep, of a large one some that are evenly spread, to look at before the work."""
        step = -(-len(self.points) // MOST_PROBES)
        return self.points[:: step + (step > 1 and step % 2 == 0)]  # odd: an even step would miss every other value


def study_or_problem(base: Study, values: Mapping[str, Any]) -> tuple[Study | None, str]:
    """The base with values by key path, or why they make none."""
    try:
        return base.replace(**{key.replace(".", "__"): value for key, value in values.items()}), ""
    except ConfigError as error:
        return None, "; ".join(error.problems)

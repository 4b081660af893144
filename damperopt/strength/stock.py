"""Sizes that exist: tubes of a stock list, and choices of sizes for several parts by rising mass."""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TypeVar

from ..ports.section import Section

__all__ = ["Tube", "at_least", "lightest_first", "tubes"]

T = TypeVar("T")


@dataclass(frozen=True)
class Tube:
    """A round tube of a stock list: outer diameter and wall [m]."""

    diameter: float
    wall: float

    @property
    def area(self) -> float:
        """[m^2]"""
        return math.pi * (self.diameter - self.wall) * self.wall

    @property
    def inertia(self) -> float:
        """Second moment of area [m^4]."""
        return math.pi / 64 * (self.diameter**4 - (self.diameter - 2 * self.wall) ** 4)

    @property
    def section(self) -> Section:
        """Its family: tubes with this ratio of wall to diameter."""
        return Section(family="tube", thickness_ratio=self.wall / self.diameter)

    def __str__(self) -> str:
        return f"{1e3 * self.diameter:g} x {1e3 * self.wall:g} mm"


def tubes(diameters: Sequence[float], walls: Sequence[float], area: float = 0.0, inertia: float = 0.0) -> tuple[Tube, ...]:
    """Every tube of a stock list with at least an area and a second moment of area, the lightest first.

    Parameters
    ----------
    diameters, walls : sequence of float
        Outer diameters and walls [m]; every wall goes with every diameter that it leaves a bore.
    area, inertia : float
        Least of each [m^2], [m^4].

    Returns
    -------
    tuple of Tube

    Examples
    --------
    >>> [str(tube) for tube in tubes([0.03, 0.02], [0.002, 0.011])]
    ['20 x 2 mm', '30 x 2 mm', '30 x 11 mm']
    """
    found = (Tube(diameter, wall) for diameter in diameters for wall in walls if 2 * wall < diameter)
    wide = (tube for tube in found if tube.area >= area and tube.inertia >= inertia)
    return tuple(sorted(wide, key=lambda tube: (tube.area, tube.diameter)))


def at_least(sizes: Sequence[float], needed: float) -> tuple[float, ...]:
    """Sizes that are enough, the smallest first."""
    return tuple(sorted(size for size in sizes if size >= needed))


def lightest_first(choices: Mapping[str, Sequence[T]], mass: Callable[[str, T], float]) -> Iterator[dict[str, T]]:
    """Every way to choose one size for each part, by rising mass of all; made as it is asked for.

    Parameters
    ----------
    choices : mapping of str to sequence
        Sizes by part.
    mass : callable
        (part, size) -> mass [kg].

    Yields
    ------
    dict
        Part -> size.
    """
    parts = {part: sorted(sizes, key=partial(mass, part)) for part, sizes in choices.items()}
    if not parts or not all(parts.values()):
        return

    def total(position: tuple[int, ...]) -> float:
        return sum(mass(part, sizes[i]) for (part, sizes), i in zip(parts.items(), position, strict=True))

    first = (0,) * len(parts)
    waiting, seen = [(total(first), first)], {first}
    while waiting:
        _, position = heapq.heappop(waiting)
        yield {part: sizes[i] for (part, sizes), i in zip(parts.items(), position, strict=True)}
        for j, sizes in enumerate(parts.values()):
            after = (*position[:j], position[j] + 1, *position[j + 1 :])
            if after[j] < len(sizes) and after not in seen:
                seen.add(after)
                heapq.heappush(waiting, (total(after), after))

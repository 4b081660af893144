"""Sizes that exist: tubes of a stock list."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from ..ports.section import Section

__all__ = ["Tube", "tubes"]


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


def tubes(diameters: Sequence[float], walls: Sequence[float]) -> tuple[Tube, ...]:
    """Every tube of a stock list, the lightest first.

    Parameters
    ----------
    diameters, walls : sequence of float
        Outer diameters and walls [m]; every wall goes with every diameter that it leaves a bore.

    Returns
    -------
    tuple of Tube

    Examples
    --------
    >>> [str(tube) for tube in tubes([0.03, 0.02], [0.002, 0.011])]
    ['20 x 2 mm', '30 x 2 mm', '30 x 11 mm']
    """
    found = (Tube(diameter, wall) for diameter in diameters for wall in walls if 2 * wall < diameter)
    return tuple(sorted(found, key=lambda tube: (tube.area, tube.diameter)))

"""Where roots of a gear with a delay cross a line Re = level, along speed.

The exact roots are followed over a fine row of speeds. Between two of them a root that changes sides is met by bracketing; a
root that comes near and turns back is followed to where it turns. A root that crosses twice between neighbours, and is as far
from the line at both as a whole step, would be missed: the certificate (`proof.delay`) rests on none of this.
"""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from .delay import DelayGear
from .modes import followed

__all__ = ["PER_DECADE", "DelayLine"]

PER_DECADE, FEWEST = 160, 40
"""Speeds at which roots are found."""

NEARBY = 3.0
"""A root is followed to its turning point where that lies this many steps from the line, at most."""


class DelayLine:
    """Roots of a gear along speed at one load.

    Parameters
    ----------
    gear : DelayGear
    load : float
        [N]
    low, high : float
        Range of the speed [m/s].
    """

    def __init__(self, gear: DelayGear, load: float, low: float, high: float):
        self._gear, self._load = gear, load
        count = max(FEWEST, math.ceil(PER_DECADE * math.log10(high / low)))
        self._speeds = np.geomspace(low, high, count)
        self._speeds[0], self._speeds[-1] = low, high

    @cached_property
    def _roots(self) -> np.ndarray:
        """(m, k) exact roots, each column one root followed."""
        values, _ = self._gear.modes(self._speeds, self._load)
        return followed(self._speeds, values, values.shape[1])[0]

    def crossings(self, level: float) -> np.ndarray:
        """Speeds at which a root has the real part `level` [1/s], ascending; none for a single speed."""
        speeds, found = self._speeds, []
        if speeds[0] == speeds[-1]:
            return np.zeros(0)
        for column in self._roots.T[self._roots.imag.max(axis=0) >= -1e-9]:
            away = column.real - level
            brackets = [(k, k + 1) for k in np.flatnonzero(away[1:] * away[:-1] <= 0).tolist()]
            step = np.abs(np.diff(away))
            for k in range(1, len(speeds) - 1):
                turns = (away[k] - away[k - 1]) * (away[k + 1] - away[k]) <= 0 and away[k - 1] * away[k + 1] > 0
                towards = abs(away[k]) <= min(abs(away[k - 1]), abs(away[k + 1]))
                if turns and towards and abs(away[k]) <= NEARBY * max(step[k - 1], step[k]):
                    found += self._turning(column, k, level)
            found += [self._met(column, k, level, speeds[k], speeds[j]) for k, j in brackets]
        return np.unique(np.array(found, float))

    def _real(self, column: np.ndarray, k: int, level: float, speed: float) -> float:
        """Real part beyond the level of the root that is column[k] at the speed k."""
        speeds = self._speeds
        near = slice(max(k - 1, 0), k + 2)
        real, imag = (np.interp(speed, speeds[near], part[near]) for part in (column.real, column.imag))
        guess = real + 1j * imag
        roots = self._gear.roots(speed, self._load, self._roots.shape[1])[0]
        return float(roots[np.abs(roots - guess).argmin()].real - level)

    def _met(self, column: np.ndarray, k: int, level: float, low: float, high: float) -> float:
        ends = [self._real(column, k, level, V) for V in (low, high)]
        if ends[0] * ends[1] > 0:
            return low if abs(ends[0]) < abs(ends[1]) else high
        return float(brentq(lambda V: self._real(column, k, level, V), low, high, xtol=1e-13 * high, rtol=1e-13))

    def _turning(self, column: np.ndarray, k: int, level: float) -> list[float]:
        """Where a root that turns back between its neighbours meets the line: twice, once, or nowhere."""
        low, high = self._speeds[k - 1], self._speeds[k + 1]
        side = np.sign(column[k].real - level)
        best = minimize_scalar(
            lambda V: side * self._real(column, k, level, V),
            bounds=(low, high),
            method="bounded",
            options={"xatol": 1e-9 * high},
        )
        if best.fun > 0:
            return [float(best.x)] if best.fun <= 1e-9 * (1 + abs(column[k])) else []
        return [self._met(column, k, level, low, best.x), self._met(column, k, level, best.x, high)]

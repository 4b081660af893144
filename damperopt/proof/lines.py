"""Lines on boxes of variables, in intervals, and the constants of tangents and chords."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .intervals import Interval, logarithm, monotone, of

__all__ = ["Line", "Places", "added", "chord", "either", "entropy", "short", "softplus"]


@dataclass(frozen=True)
class Line:
    """constant + slope . (x - place), intervals (m,) and (m, n)."""

    constant: Interval
    slope: Interval

    def plus(self, other: Line) -> Line:
        return Line(self.constant + other.constant, self.slope + other.slope)

    def times(self, factor: Any) -> Line:
        factor = of(factor)
        wide = Interval(factor.low[..., None], factor.high[..., None]) if factor.low.ndim else factor
        return Line(self.constant * factor, self.slope * wide)

    def raised(self, by: Any) -> Line:
        return Line(self.constant + by, self.slope)

    def reversed(self) -> Line:
        return Line(-self.constant, -self.slope)


class Places:
    """m boxes of n variables, each with a place in it about which lines are written.

    Parameters
    ----------
    low, high, place : ndarray
        (m, n)
    """

    def __init__(self, low: np.ndarray, high: np.ndarray, place: np.ndarray):
        self.place, self.shape = place, place.shape
        self._moves = Interval(low, high) - place

    def range(self, line: Line) -> Interval:
        """Of a line's values on each box."""
        return line.constant + (line.slope * self._moves).sum(axis=1)


def added(p: np.ndarray, q: np.ndarray) -> Interval:
    """ln(e^p + e^q)"""
    larger = np.maximum(p, q)
    return of(larger) + softplus(of(np.minimum(p, q)) - larger)


def entropy(w: np.ndarray) -> Interval:
    """-w ln w - (1 - w) ln(1 - w)"""
    other = 1.0 - of(w)
    return -(of(w) * logarithm(w)) - other * logarithm(other)


def softplus(d: Interval) -> Interval:
    """ln(1 + e^d)"""
    return monotone(lambda x: np.logaddexp(0.0, x), d)


def short(d: Interval) -> Interval:
    """ln(1 - e^d); the rounding of what the logarithm is taken of counts."""
    inside = monotone(lambda x: -np.expm1(x), d, rising=False)
    return logarithm(Interval(np.maximum(inside.low, 1e-300), np.maximum(inside.high, 1e-300)))


def chord(f: tuple[Interval, Interval], d: Interval, otherwise: np.ndarray) -> np.ndarray:
    """Slope of the chord over intervals d, from values f at their ends; of no width: another slope."""
    width = d.high - d.low
    wide = width > 1e-9 * (1 + np.abs(d.high))
    with np.errstate(all="ignore"):
        return np.where(wide, (f[1].middle - f[0].middle) / np.where(wide, width, 1.0), otherwise)


def either(first: np.ndarray, one: Line, other: Line) -> Line:
    """One line on some boxes, the other on the rest."""

    def chosen(a: Interval, b: Interval) -> Interval:
        mask = np.reshape(first, (-1,) + (1,) * (max(a.low.ndim, b.low.ndim) - 1))
        return Interval(np.where(mask, a.low, b.low), np.where(mask, a.high, b.high))

    return Line(chosen(one.constant, other.constant), chosen(one.slope, other.slope))

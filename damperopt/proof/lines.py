"""Lines on boxes of variables, in intervals, and the constants of tangents and chords."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .intervals import Interval, logarithm, monotone, of

__all__ = ["Line", "Places", "added", "arsinh_gap", "arsinh_slope", "chord", "either", "entropy", "short", "softplus"]


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


def arsinh_slope(x: Interval, at: np.ndarray) -> np.ndarray:
    """In (0, 1], of a line that should lie close below arsinh x about a place; any is allowed."""
    with np.errstate(all="ignore"):
        left, p = x.low, np.ones_like(at)
        for _ in range(5):  # of the chord from the upper end, as steep as it gets
            p = np.where(x.high > left, (np.arcsinh(x.high) - np.arcsinh(left)) / (x.high - left), 1.0)
            left = np.maximum(x.low, -np.sqrt(np.maximum(1 / p**2 - 1, 0)))
        tangent = 1 / np.hypot(1.0, at)
        p = np.where(x.high <= 0, tangent, np.where(at < 0, np.minimum(p, tangent), p))
    return np.clip(np.nan_to_num(p, nan=1.0), 1e-100, 1.0)


def arsinh_gap(x: Interval, p: np.ndarray) -> Interval:
    """Not above arsinh x - p x on an interval of x, for 0 < p <= 1.

    Up to 0 it is convex, with its least value q - ln((1 + q)/p), q = sqrt(1 - p^2), where the slope is p; beyond 0, where
    it is 0, it is concave. So the least is that value, or at an end; at an end where the slope at the lower one is p or more.
    """
    inner = 1.0 - of(p) * p
    q = monotone(np.sqrt, Interval(np.maximum(inner.low, 0.0), np.maximum(inner.high, 0.0)))
    touched = (q + logarithm(p) - logarithm(1.0 + q)).low
    with np.errstate(all="ignore"):
        first, last = ((monotone(np.arcsinh, of(end)) - of(p) * end).low for end in (x.low, x.high))
        rises = (x.low >= 0) | ((of(p) * p * (1.0 + of(x.low) * x.low)).high <= 1)
    least = np.minimum(np.where(rises, first, touched), np.where(rises | (x.high > 0), last, touched))
    return of(np.where(np.isnan(least), -np.inf, least))


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

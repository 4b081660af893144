"""Arrays of intervals, rounded outwards.

Sums, products, quotients and roots of floats are the nearest floats to the exact ones, so that the next float beyond
encloses them. Exponentials and logarithms of NumPy are good to a few units of the last place; here they are widened by
`WIDENED` of themselves.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

__all__ = ["Interval", "exponential", "logarithm", "monotone", "of"]

WIDENED = 2.0**-49
"""Relative; eight times the rounding unit."""

TINY = 1e-300


class Interval:
    """low <= x <= high, elementwise; shapes broadcast as arrays do."""

    __slots__ = ("high", "low")
    __array_ufunc__ = None  # an array on the left asks the interval

    def __init__(self, low: Any, high: Any):
        self.low, self.high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)

    def __add__(self, other: Any) -> Interval:
        other = of(other)
        return _outwards(self.low + other.low, self.high + other.high)

    def __neg__(self) -> Interval:
        return Interval(-self.high, -self.low)

    def __sub__(self, other: Any) -> Interval:
        return self + -of(other)

    def __mul__(self, other: Any) -> Interval:
        other = of(other)
        ends = (self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high)
        low, high = ends[0], ends[0]
        for end in ends[1:]:
            low, high = np.minimum(low, end), np.maximum(high, end)
        return _outwards(low, high)

    def __truediv__(self, other: Any) -> Interval:
        """Of what does not hold 0."""
        other = of(other)
        return self * _outwards(1 / other.high, 1 / other.low)

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other: Any) -> Interval:
        return of(other) - self

    def __getitem__(self, key: Any) -> Interval:
        return Interval(self.low[key], self.high[key])

    def sum(self, axis: int) -> Interval:
        """Over one axis."""
        total = Interval(0.0, 0.0)
        for part in range(self.low.shape[axis]):
            total = total + Interval(np.take(self.low, part, axis), np.take(self.high, part, axis))
        return total

    @property
    def middle(self) -> np.ndarray:
        """A float inside."""
        return np.clip(self.low / 2 + self.high / 2, self.low, self.high)


def of(x: Any) -> Interval:
    """An interval as it is, or of one float."""
    return x if isinstance(x, Interval) else Interval(x, x)


def _outwards(low: np.ndarray, high: np.ndarray) -> Interval:
    return Interval(np.nextafter(low, -np.inf), np.nextafter(high, np.inf))


def monotone(f: Callable[[np.ndarray], np.ndarray], x: Any, rising: bool = True) -> Interval:
    """A monotone function of NumPy, widened."""
    x = of(x)
    low, high = (f(x.low), f(x.high)) if rising else (f(x.high), f(x.low))
    return Interval(low - np.abs(low) * WIDENED - TINY, high + np.abs(high) * WIDENED + TINY)


def exponential(x: Any) -> Interval:
    """e^x"""
    found = monotone(np.exp, x)
    return Interval(np.maximum(found.low, 0.0), found.high)


def logarithm(x: Any) -> Interval:
    """ln x of what is positive."""
    return monotone(np.log, x)

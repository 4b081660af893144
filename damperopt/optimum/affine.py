"""Affine functions on boxes of variables, and the tangents and chords that bounds are made of."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

__all__ = ["Affine", "Bounded", "Boxes", "below_arsinh", "chord", "either", "expit", "short", "short_slope", "softplus"]

TOUCHES = 4
"""Steps to where a line from the upper end touches; each leaves a line below."""

NEAR = 1e-9
"""Width of an interval below which its chord is its tangent."""


@dataclass(frozen=True)
class Affine:
    """value + slope . (x - reference), (m,) and (m, n)."""

    value: np.ndarray
    slope: np.ndarray

    def __add__(self, other: Affine | Any) -> Affine:
        if isinstance(other, Affine):
            return Affine(self.value + other.value, self.slope + other.slope)
        return Affine(self.value + other, self.slope)

    def __mul__(self, factor: Any) -> Affine:
        return Affine(self.value * factor, self.slope * np.reshape(factor, (-1, 1)))


@dataclass(frozen=True)
class Boxes:
    """m boxes of n variables.

    Attributes
    ----------
    low, high, reference : ndarray
        (m, n) ends, and a point in each.
    """

    low: np.ndarray
    high: np.ndarray
    reference: np.ndarray

    def least(self, of: Affine) -> np.ndarray:
        """Least value on each box."""
        corner = np.where(of.slope > 0, self.low, self.high) - self.reference
        return of.value + (of.slope * corner).sum(axis=1)

    def most(self, of: Affine) -> np.ndarray:
        """Largest value on each box."""
        return -self.least(of * -1.0)


@dataclass(frozen=True)
class Bounded:
    """A quantity between two affine functions, in an interval, and at the reference point."""

    below: Affine
    above: Affine
    low: np.ndarray
    high: np.ndarray
    at: np.ndarray


def either(first: np.ndarray, one: Bounded, other: Bounded) -> Bounded:
    """The one on some boxes, the other on the rest."""

    def line(a: Affine, b: Affine) -> Affine:
        return Affine(np.where(first, a.value, b.value), np.where(np.reshape(first, (-1, 1)), a.slope, b.slope))

    rest = (np.where(first, getattr(one, name), getattr(other, name)) for name in ("low", "high", "at"))
    return Bounded(line(one.below, other.below), line(one.above, other.above), *rest)


def softplus(d: np.ndarray) -> np.ndarray:
    """ln(1 + e^d)"""
    return np.logaddexp(0.0, d)


def expit(d: np.ndarray) -> np.ndarray:
    """1/(1 + e^-d)"""
    return np.exp(-np.logaddexp(0.0, -d))


def short(d: np.ndarray) -> np.ndarray:
    """ln(1 - e^d), d < 0."""
    return np.log(-np.expm1(d))


def short_slope(d: np.ndarray) -> np.ndarray:
    """Its slope, -1/(e^-d - 1)."""
    return -1 / np.expm1(-d)


def chord(f: Callable[[Any], Any], slope: Callable[[Any], Any], low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Slope of the chord of f; of its tangent where the interval has no width."""
    wide = high - low > NEAR * (1 + np.abs(high))
    return np.where(wide, (f(high) - f(low)) / np.where(wide, high - low, 1.0), slope(low))


def below_arsinh(low: np.ndarray, high: np.ndarray, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Slope and constant of a line below arsinh, which is convex up to 0 and concave beyond: near to it at a place."""

    def slope(x: np.ndarray) -> np.ndarray:
        return 1 / np.hypot(1, x)

    touch = low
    for _ in range(TOUCHES):  # of the line from the upper end; at the lower one it is the chord
        steep = chord(np.arcsinh, slope, touch, high)
        touch = np.maximum(low, -np.sqrt(np.maximum(1 / steep**2 - 1, 0)))
    convex = (high <= 0) | (at < touch)
    place, p = np.where(convex, at, touch), np.where(convex, slope(at), steep)
    return p, np.arcsinh(place) - p * place

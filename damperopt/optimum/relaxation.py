"""Bounds of expressions over boxes of variables, by affine functions that lie below and above them.

A positive quantity is bounded in its logarithm, a sum of atoms with coefficients: products, quotients and powers are exact,
and what stands above and below cancels. A sum ln(e^u + e^v) = u + ln(1 + e^(v - u)) is convex: its tangent lies below it,
its chord above; it is an atom of its own. What can have either sign is bounded itself. Sizing formulas are products of
powers and sums of such, so that their relaxations are tight without a cut of the box.

Many boxes at once: arrays (m,) of values and (m, n) of slopes, at a reference point in each box. These are floats: what
rests on them is a search, that `proof` checks.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, TypeAlias

import casadi as ca
import numpy as np

from ..expressions.graph import walk
from .affine import Affine, Bounded, Boxes, below_arsinh, chord, either, expit, short, short_slope, softplus
from .forms import METHODS, OF_FLOATS, Log, Piece, Truth

__all__ = ["relaxed"]

LOWEST = -690.0
"""Below the logarithm of any square."""

NOTHING = 1e3
"""Logarithm that stands for no bound."""


class _Unbounded(Exception):
    """An operation that has no bound here, or none on these boxes."""


Value: TypeAlias = float | Bounded | Log


class _Relaxations:
    """Visitor of a graph."""

    def __init__(self, boxes: Boxes, logarithmic: Sequence[bool]):
        self._boxes = boxes
        m, n = boxes.low.shape
        self._zero = Affine(np.zeros(m), np.zeros((m, n)))
        self._inputs: list[Value] = []
        for i, log in enumerate(logarithmic):
            slope = np.zeros((m, n))
            slope[:, i] = 1.0
            own = Affine(boxes.reference[:, i], slope)
            bounded = Bounded(own, own, boxes.low[:, i], boxes.high[:, i], own.value)
            self._inputs.append(self._atom(bounded) if log else bounded)

    def constant(self, value: float) -> float:
        return value

    def input(self, argument: int, position: int) -> Value:
        return self._inputs[position]

    def operation(self, code: int, operands: Sequence[Any]) -> Any:
        """None: it has no bound."""
        try:
            if any(x is None for x in operands):
                return None
            if code in OF_FLOATS and all(isinstance(x, float) for x in operands):
                return float(OF_FLOATS[code](*operands))
            return getattr(self, METHODS[code])(*operands) if code in METHODS else None
        except _Unbounded:
            return None

    def logarithm_of(self, x: Any) -> Bounded | None:
        """Of an entry, `NOTHING` away from it on boxes without bounds; None where there are none, or it may be negative."""
        try:
            found = self._log(x)
        except _Unbounded:
            return None
        if found.sign < 0:
            return None
        bounded = self._sum_of(found)
        finite = np.logical_and.reduce(
            [~np.broadcast_to(found.open, self._zero.value.shape)]
            + [np.isfinite(end.value) & np.isfinite(end.slope).all(axis=1) for end in (bounded.below, bounded.above)]
        )
        if finite.all():
            return bounded

        def kept(of: Affine, otherwise: float) -> Affine:
            return Affine(np.where(finite, of.value, otherwise), np.where(finite[:, None], of.slope, 0.0))

        ends = kept(bounded.below, -NOTHING), kept(bounded.above, NOTHING)
        low, high = np.where(finite, bounded.low, -np.inf), np.where(finite, bounded.high, np.inf)
        return Bounded(*ends, low, high, np.where(finite, bounded.at, 0.0))

    # forms of one value

    def _atom(self, bounded: Bounded, sign: int = 1) -> Log:
        return Log(sign, 0.0, {id(bounded): (1.0, bounded)})

    def _made(self, below: Affine, above: Affine, at: Any, low: Any = -np.inf, high: Any = np.inf) -> Bounded:
        low, high = np.maximum(low, self._boxes.least(below)), np.minimum(high, self._boxes.most(above))
        return Bounded(below, above, np.minimum(low, high), np.maximum(low, high), at)

    def _sum_of(self, u: Log) -> Bounded:
        """u itself."""
        if len(u.atoms) == 1 and u.constant is not None:
            ((c, only),) = u.atoms.values()
            if isinstance(c, float) and c == 1.0 and isinstance(u.constant, float) and u.constant == 0.0:
                return only
        low = high = at = self._zero.value + u.constant
        for c, atom in u.atoms.values():
            ends = c * atom.low, c * atom.high
            low, high, at = low + np.minimum(*ends), high + np.maximum(*ends), at + c * atom.at
        return self._made(self._side(u, True), self._side(u, False), at, low, high)

    def _side(self, u: Log, below: bool) -> Affine:
        total = self._zero + u.constant
        for c, atom in u.atoms.values():
            rising = (np.asarray(c) > 0) == below
            if rising.ndim == 0:
                total = total + (atom.below if rising else atom.above) * c
            else:
                slope = np.where(rising[:, None], atom.below.slope, atom.above.slope)
                total = total + Affine(np.where(rising, atom.below.value, atom.above.value), slope) * c
        return total

    def _flat(self, low: Any, high: Any, at: Any) -> Bounded:
        low, high, at = (np.broadcast_to(x, self._zero.value.shape) for x in (low, high, at))
        return Bounded(self._zero + low, self._zero + high, low, high, at)

    def _log(self, x: Any) -> Log:
        """In its logarithm."""
        if isinstance(x, Log):
            return x
        if isinstance(x, float):
            if x == 0 or not math.isfinite(x):
                raise _Unbounded
            return Log(1 if x > 0 else -1, math.log(abs(x)), {})
        if not isinstance(x, Bounded):
            raise _Unbounded
        if (x.low > 0).all():
            return self._atom(self._outer(x, np.log, lambda v: 1 / v, convex=False))
        if (x.high < 0).all():
            return replace(self._log(self.negative(x)), sign=-1)
        raise _Unbounded

    def _plain(self, x: Any) -> Bounded:
        """In itself."""
        if isinstance(x, float):
            return self._flat(x, x, x)
        if isinstance(x, Log):
            if x.terms is not None:
                return self._added(*x.terms)
            if np.any(x.open):
                raise _Unbounded
            found = self._outer(self._sum_of(x), np.exp, np.exp, convex=True)
            return found if x.sign > 0 else self.negative(found)
        if not isinstance(x, Bounded):
            raise _Unbounded
        return x

    def _outer(self, x: Bounded, f: Callable[[Any], Any], slope: Callable[[Any], Any], convex: bool) -> Bounded:
        """f of what is bounded, convex or concave there: its tangent to one side, its chord to the other."""
        at = np.clip(x.at, x.low, x.high)
        at_low, at_high = f(x.low), f(x.high)
        secant = chord(f, slope, x.low, x.high)

        def line(s: np.ndarray, value: np.ndarray, place: np.ndarray, below: bool) -> Affine:
            rising = (s > 0) == below
            taken = Affine(
                np.where(rising, x.below.value, x.above.value),
                np.where(rising[:, None], x.below.slope, x.above.slope),
            )
            return taken * s + (value - s * place)

        tangents, chords = line(slope(at), f(at), at, convex), line(secant, at_low, x.low, not convex)
        ends = np.minimum(at_low, at_high), np.maximum(at_low, at_high)
        below, above = (tangents, chords) if convex else (chords, tangents)
        monotone = np.sign(slope(x.low)) == np.sign(slope(x.high))
        low = np.where(monotone, ends[0], -np.inf) if convex else ends[0]
        high = ends[1] if convex else np.where(monotone, ends[1], np.inf)
        return self._made(below, above, f(at), low, high)

    # operations

    def assign(self, x: Any) -> Any:
        return x

    def negative(self, x: Any) -> Any:
        if isinstance(x, float):
            return -x
        if isinstance(x, Log):
            terms = None if x.terms is None else (self.negative(x.terms[0]), self.negative(x.terms[1]))
            return replace(x, sign=-x.sign, terms=terms)
        return Bounded(x.above * -1.0, x.below * -1.0, -x.high, -x.low, -x.at)

    def times(self, x: Any, y: Any) -> Any:
        x, y = (y, x) if isinstance(y, float) else (x, y)
        if isinstance(x, float):
            if x == 0:
                return 0.0
            if isinstance(y, Bounded):
                ends = (y.below, y.above) if x > 0 else (y.above, y.below)
                low, high = np.minimum(y.low * x, y.high * x), np.maximum(y.low * x, y.high * x)
                return Bounded(ends[0] * x, ends[1] * x, low, high, y.at * x)
        try:
            return self._log(x).plus(self._log(y))
        except _Unbounded:
            p, q = self._plain(x), self._plain(y)
        corners = np.array([p.low * q.low, p.low * q.high, p.high * q.low, p.high * q.high])
        return self._flat(corners.min(axis=0), corners.max(axis=0), p.at * q.at)

    def over(self, x: Any, y: Any) -> Any:
        return self.times(x, self.inverse(y))

    def inverse(self, x: Any) -> Any:
        return self._log(x).scaled(-1.0)

    def square(self, x: Any) -> Any:
        if isinstance(x, Log) and x.most is not None:
            flat = self._flat(LOWEST, 2 * x.most, LOWEST)
            return self._atom(either(x.open, flat, self._sum_of(x.scaled(2.0))))
        if isinstance(x, Bounded) and not ((x.low > 0).all() or (x.high < 0).all()):
            found = self._outer(x, np.square, lambda v: 2 * v, convex=True)
            return replace(found, low=np.maximum(found.low, 0.0))
        return self._log(x).scaled(2.0, sign=1)

    def twice(self, x: Any) -> Any:
        return self.times(2.0, x)

    def root(self, x: Any) -> Any:
        return self.power(x, 0.5)

    def power(self, x: Any, exponent: Any) -> Any:
        u = self._log(x)
        if not isinstance(exponent, float) or u.sign < 0:
            raise _Unbounded
        return u.scaled(exponent)

    def plus(self, x: Any, y: Any) -> Any:
        if isinstance(x, Piece) and isinstance(y, Piece):
            return self._chosen(x, y)
        if isinstance(x, float) and x == 0:
            return y
        if isinstance(y, float) and y == 0:
            return x
        try:
            u, v = self._log(x), self._log(y)
            return self._together(u, v) if u.sign == v.sign else replace(self._difference(u, v), terms=(u, v))
        except _Unbounded:
            return self._added(x, y)

    def _added(self, x: Any, y: Any) -> Bounded:
        """Of either sign."""
        p, q = self._plain(x), self._plain(y)
        return self._made(p.below + q.below, p.above + q.above, p.at + q.at, p.low + q.low, p.high + q.high)

    def minus(self, x: Any, y: Any) -> Any:
        return self.plus(x, self.negative(y))

    def _apart(self, u: Log, v: Log) -> Bounded:
        """v - u."""
        found = self._sum_of(v.plus(u.scaled(-1.0)))
        return replace(found, at=np.clip(found.at, found.low, found.high))

    def _mixed(self, u: Log, v: Log, weight: Any, constant: Any, below: bool) -> Affine:
        """u + weight (v - u) + constant, from below or above."""
        return self._side(u.scaled(1 - weight).plus(v.scaled(weight)), below) + constant

    def _together(self, u: Log, v: Log) -> Log:
        """u + ln(1 + e^(v - u))."""
        d = self._apart(u, v)
        w, s = expit(d.at), chord(softplus, expit, d.low, d.high)
        below = self._mixed(u, v, w, softplus(d.at) - w * d.at, True)
        above = self._mixed(u, v, s, softplus(d.low) - s * d.low, False)
        p, q = self._sum_of(u), self._sum_of(v)
        ends = np.logaddexp(p.low, q.low), np.logaddexp(p.high, q.high)
        made = self._made(below, above, p.at + softplus(d.at), *ends)
        return replace(self._atom(made, u.sign), open=u.open | v.open)

    def _difference(self, u: Log, v: Log) -> Log:
        """u + ln(1 - e^(v - u)), of the larger one's sign."""
        d = self._apart(u, v)
        if (d.low > 0).sum() > (d.high < 0).sum():
            u, v = v, u
            d = self._apart(u, v)
        told = d.high < 0
        d = Bounded(d.below, d.above, *(np.where(told, x, -1.0) for x in (d.low, d.high, d.at)))
        w, s = short_slope(d.at), chord(short, short_slope, d.low, d.high)
        above = self._mixed(u, v, w, short(d.at) - w * d.at, False)
        below = self._mixed(u, v, s, short(d.low) - s * d.low, True)
        found = self._atom(self._made(below, above, self._sum_of(u).at + short(d.at)), u.sign)
        found = replace(found, open=~told | u.open | v.open)
        return found if told.all() else replace(found, most=np.maximum(self._sum_of(u).high, self._sum_of(v).high))

    def logarithm(self, x: Any) -> Any:
        u = self._log(x)
        if u.sign < 0 or np.any(u.open):
            raise _Unbounded
        return self._sum_of(u)

    def exponential(self, x: Any) -> Any:
        return self._atom(self._plain(x))

    def magnitude(self, x: Any) -> Any:
        return replace(self._log(x), sign=1, most=None, terms=None)

    def arsinh(self, x: Any) -> Bounded:
        x = self._plain(x)
        (p, c), (q, d) = below_arsinh(x.low, x.high, x.at), below_arsinh(-x.high, -x.low, -x.at)  # odd
        ends = np.arcsinh(x.low), np.arcsinh(x.high)
        return self._made(x.below * p + c, x.above * q + -d, np.arcsinh(x.at), *ends)

    def sine(self, x: Any) -> Any:
        return self._of_angle(x, lambda v: np.log(np.sin(v)), lambda v: 1 / np.tan(v), 0.0, math.pi)

    def cosine(self, x: Any) -> Any:
        return self._of_angle(x, lambda v: np.log(np.cos(v)), lambda v: -np.tan(v), -math.pi / 2, math.pi / 2)

    def _of_angle(self, x: Any, f: Any, slope: Any, least: float, most: float) -> Log:
        x = self._plain(x)
        if not ((x.low > least) & (x.high < most)).all():
            raise _Unbounded
        return self._atom(self._outer(x, f, slope, convex=False))

    def larger(self, x: Any, y: Any) -> Any:
        u, v = self._log(x), self._log(y)
        if u.sign < 0 or v.sign < 0 or np.any(u.open | v.open):
            raise _Unbounded
        d = self._apart(u, v)
        w, s = (d.at > 0) * 1.0, chord(lambda d: np.maximum(d, 0), lambda d: (d > 0) * 1.0, d.low, d.high)
        below = self._mixed(u, v, w, 0.0, True)
        above = self._mixed(u, v, s, np.maximum(d.low, 0) - s * d.low, False)
        return self._atom(self._made(below, above, self._sum_of(u).at + np.maximum(d.at, 0)))

    def less(self, x: Any, y: Any) -> Truth:
        p, q = self._plain(x), self._plain(y)
        return Truth(p.high < q.low, p.low >= q.high)

    def is_not(self, x: Any) -> Truth:
        return Truth(not x, bool(x)) if isinstance(x, float) else Truth(x.no, x.yes)

    def if_else_zero(self, when: Any, x: Any) -> Any:
        if isinstance(when, float):
            return x if when else 0.0
        return Piece(when, x)

    def _chosen(self, x: Piece, y: Piece) -> Log:
        """One of two, by a condition and its opposite."""
        u, v = self._log(x.value), self._log(y.value)
        if u.sign < 0 or v.sign < 0 or np.any(u.open | v.open):
            raise _Unbounded
        p, q = self._sum_of(u), self._sum_of(v)
        low, high = np.minimum(p.low, q.low), np.maximum(p.high, q.high)
        flat = self._flat(low, high, np.minimum(p.at, q.at))
        return self._atom(either(x.when.yes, p, either(y.when.yes, q, flat)))


def relaxed(function: ca.Function, boxes: Boxes, logarithmic: Sequence[bool]) -> list[Bounded | None]:
    """Bounds of the logarithms of positive quantities, entries of an SX function of one vector with one dense vector as output.

    Parameters
    ----------
    function : casadi.Function
    boxes : Boxes
        Of the variables, logarithms where `logarithmic`.
    logarithmic : sequence of bool

    Returns
    -------
    list of Bounded or None
        None where an operation has no bound, here or on these boxes.
    """
    visitor = _Relaxations(boxes, logarithmic)
    with np.errstate(all="ignore"):
        return [visitor.logarithm_of(value) for value in walk(function, visitor)]

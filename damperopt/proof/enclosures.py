"""Affine functions below and above the logarithms of expressions on boxes, proved: what a bound on mass rests on.

A positive number is e^u; u is kept as a combination of atoms, each with an affine function below and one above it. A sum is
e^u + e^v = e^(u + ln(1 + e^d)), d = v - u, and for any w in (0, 1)

    ln(1 + e^d) >= w d - w ln w - (1 - w) ln(1 - w),

which is Jensen's inequality; above, on an interval of d, it lies under any line that is above it at both ends. A difference has
ln(1 - e^d) = -ln(1 + e^c) with c = ln(e^d/(1 - e^d)), so that the two change their sides. Slopes w may be any floats: what is
computed with care is the constants, in intervals. Where an operation has no rule the entry has no bound, and may not be used.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np

from ..expressions.graph import walk
from .forms import RULES, Atom, Piece, Power, Truth, joined, positive, product
from .intervals import Interval, exponential, logarithm, monotone, of
from .lines import Line, Places, added, arsinh_gap, arsinh_slope, chord, either, entropy, short, softplus

__all__ = ["lines"]

LOWEST = -690.0
"""Below the logarithm of any square."""

EDGE = 1e-12
"""Slopes are kept this far from 0 and 1."""


class _Unknown(Exception):
    """No rule, or none on these boxes."""


class _Rules:
    """Visitor of a graph."""

    def __init__(self, places: Places, logarithmic: Sequence[bool]):
        self._places = places
        m, n = places.shape
        self._nothing = Line(Interval(np.zeros(m), np.zeros(m)), Interval(np.zeros((m, n)), np.zeros((m, n))))
        self._inputs: list[Any] = []
        for i, log in enumerate(logarithmic):
            slope = np.zeros((m, n))
            slope[:, i] = 1.0
            own = Line(of(places.place[:, i]), of(slope))
            atom = Atom(own, own, places.range(own), places.place[:, i])
            self._inputs.append(Power(1, of(0.0), ((1.0, atom),)) if log else atom)

    def constant(self, value: float) -> float:
        return value

    def input(self, argument: int, position: int) -> Any:
        return self._inputs[position]

    def operation(self, code: int, operands: Sequence[Any]) -> Any:
        rule = RULES.get(code)
        if rule is None or any(x is None for x in operands):
            return None
        try:
            return getattr(self, rule)(*operands)
        except _Unknown:
            return None

    def line_below(self, x: Any) -> Line | None:
        return self._side(x, True)

    def line_above(self, x: Any) -> Line | None:
        return self._side(x, False)

    def _side(self, x: Any, below: bool) -> Line | None:
        try:
            u = self._power(x)
        except _Unknown:
            return None
        if u.sign < 0:
            return None
        line = self._line(u, below)
        return line if u.open is False else line.raised(np.where(u.open, -np.inf if below else np.inf, 0.0))

    # forms

    def _power(self, x: Any) -> Power:
        if isinstance(x, Power):
            return x
        if isinstance(x, float) and x != 0 and math.isfinite(x):
            return Power(1 if x > 0 else -1, logarithm(abs(x)), ())
        if not isinstance(x, Atom):
            raise _Unknown
        if (x.range.low > 0).all():
            return self._single(self._bent(x, False))
        if (x.range.high < 0).all():
            mirrored = self._power(self.negative(x))
            return replace(mirrored, sign=-1)
        raise _Unknown

    def _plain(self, x: Any) -> Atom:
        if isinstance(x, Atom):
            return x
        if isinstance(x, float):
            line = self._nothing.raised(x)
            constant = np.full(self._places.shape[0], x)
            return Atom(line, line, of(constant), constant)
        if isinstance(x, Power) and x.terms is not None:
            return self._sum(*x.terms)
        if not isinstance(x, Power) or np.any(x.open):
            raise _Unknown
        found = self._bent(self._value(x), True)
        return found if x.sign > 0 else self.negative(found)

    def _single(self, atom: Atom, sign: int = 1) -> Power:
        return Power(sign, of(0.0), ((1.0, atom),))

    def _value(self, u: Power) -> Atom:
        """The exponent itself."""
        below, above = self._line(u, True), self._line(u, False)
        low, high = self._places.range(below).low, self._places.range(above).high
        plain = u.constant + np.zeros(self._places.shape[0])
        for c, atom in u.atoms:
            plain = plain + atom.range * c
        return Atom(below, above, Interval(np.maximum(low, plain.low), np.minimum(high, plain.high)), self._at(u))

    def _line(self, u: Power, below: bool) -> Line:
        total = self._nothing.raised(u.constant)
        for c, atom in u.atoms:
            rising, falling = of(c).low >= 0, of(c).high <= 0
            first, second = (atom.below, atom.above) if below else (atom.above, atom.below)
            if rising.all() or falling.all():
                total = total.plus((first if rising.all() else second).times(c))
                continue
            moved = either(rising, first, second).times(c)
            total = total.plus(either(rising | falling, moved, self._nothing.raised(atom.range * c)))
        return total

    def _bent(self, x: Atom, convex: bool) -> Atom:
        """e^x, or else ln x: a tangent with any slope to one side, to the other the line with the slope of the chord."""
        f, at = exponential if convex else logarithm, np.clip(x.at, x.range.low, x.range.high)
        with np.errstate(all="ignore"):
            value, slope = (np.exp(at), np.exp(at)) if convex else (np.log(at), 1 / at)
        ends = f(x.range.low), f(x.range.high)
        width = x.range.high - x.range.low
        with np.errstate(all="ignore"):
            chord = np.where(width > 0, (ends[1].middle - ends[0].middle) / np.where(width > 0, width, 1.0), slope)
        # the tangent of slope p: e^x >= p x + p (1 - ln p), and ln x <= p x - 1 - ln p
        p = np.maximum(slope, 1e-280)
        constant = of(p) * (1.0 - logarithm(p)) if convex else -1.0 - logarithm(p)
        tangent = self._along(x, p, constant, convex)
        gaps = [end - of(chord) * place for end, place in zip(ends, (x.range.low, x.range.high), strict=True)]
        if convex:
            secant = self._along(x, chord, of(np.maximum(gaps[0].high, gaps[1].high)), False)
            return Atom(tangent, secant, Interval(ends[0].low, ends[1].high), value)
        secant = self._along(x, chord, of(np.minimum(gaps[0].low, gaps[1].low)), True)
        return Atom(secant, tangent, Interval(ends[0].low, ends[1].high), value)

    def _along(self, x: Atom, slope: np.ndarray, constant: Interval, below: bool) -> Line:
        """slope x + constant from below or above; slopes are not negative here."""
        return (x.below if below else x.above).times(np.maximum(slope, 0.0)).raised(constant)

    # rules

    def same(self, x: Any) -> Any:
        return x

    def negative(self, x: Any) -> Any:
        if isinstance(x, float):
            return -x
        if isinstance(x, Power):
            terms = None if x.terms is None else (self.negative(x.terms[0]), self.negative(x.terms[1]))
            return replace(x, sign=-x.sign, terms=terms)
        return Atom(x.above.reversed(), x.below.reversed(), -x.range, -x.at)

    def times(self, x: Any, y: Any) -> Any:
        if any(isinstance(factor, float) and factor == 0 for factor in (x, y)):
            return 0.0
        for a, b in ((x, y), (y, x)):
            if isinstance(a, float) and isinstance(b, Atom):
                ends = b.below.times(a), b.above.times(a)
                return Atom(*(ends if a > 0 else ends[::-1]), b.range * a, b.at * a)
        u, v = self._power(x), self._power(y)
        return Power(u.sign * v.sign, u.constant + v.constant, joined(u.atoms, v.atoms), u.open | v.open)

    def over(self, x: Any, y: Any) -> Any:
        return self.times(x, self.inverse(y))

    def inverse(self, x: Any) -> Any:
        return self._raised(self._power(x), -1.0)

    def square(self, x: Any) -> Any:
        if isinstance(x, Power) and x.most is not None:
            whole = self._value(self._raised(x, 2.0))
            least, most = self._nothing.raised(LOWEST), self._nothing.raised(of(x.most) * 2.0)
            below, above = either(x.open, least, whole.below), either(x.open, most, whole.above)
            ranged = Interval(np.where(x.open, LOWEST, whole.range.low), np.where(x.open, most.constant.high, whole.range.high))
            return self._single(Atom(below, above, ranged, np.where(x.open, LOWEST, whole.at)))
        if isinstance(x, Atom) and not ((x.range.low > 0).all() or (x.range.high < 0).all()):
            return self._square(x)
        return positive(self._raised(self._power(x), 2.0))

    def _square(self, x: Atom) -> Atom:
        """Of either sign: x^2 >= 2 p x - p^2, and below the chord on [a, b], (a + b) x - a b."""
        p = x.range.middle
        below = either(p >= 0, x.below, x.above).times(2 * p).raised(-(of(p) * p))
        total = of(x.range.low) + x.range.high
        sign = total.low >= 0
        exact = sign | (total.high <= 0)
        chord = either(sign, x.above, x.below).times(total).raised(-(of(x.range.low) * x.range.high))
        most = np.maximum((of(x.range.low) * x.range.low).high, (of(x.range.high) * x.range.high).high)
        above = either(exact, chord, self._nothing.raised(most))
        return Atom(below, above, Interval(np.maximum(self._places.range(below).low, 0.0), most), x.at**2)

    def twice(self, x: Any) -> Any:
        return self.times(2.0, x)

    def root(self, x: Any) -> Any:
        return self.power(x, 0.5)

    def power(self, x: Any, exponent: Any) -> Any:
        u = self._power(x)
        if u.sign < 0 or not isinstance(exponent, float):
            raise _Unknown
        return self._raised(u, exponent)

    def _raised(self, u: Power, exponent: float) -> Power:
        atoms = tuple((product(c, exponent), atom) for c, atom in u.atoms)
        return Power(u.sign, u.constant * exponent, atoms, u.open)

    def plus(self, x: Any, y: Any) -> Any:
        if isinstance(x, Piece) and isinstance(y, Piece):
            return self._chosen(x, y)
        for a, b in ((x, y), (y, x)):
            if isinstance(a, float) and a == 0:
                return b
        try:
            u, v = self._power(x), self._power(y)
            if u.sign == v.sign:
                return Power(u.sign, of(0.0), ((1.0, self._together(u, v)),), u.open | v.open)
            return replace(self._apart(u, v), terms=(u, v))
        except _Unknown:
            return self._sum(x, y)

    def _sum(self, x: Any, y: Any) -> Atom:
        """Itself, of either sign."""
        p, q = self._plain(x), self._plain(y)
        return Atom(p.below.plus(q.below), p.above.plus(q.above), p.range + q.range, p.at + q.at)

    def minus(self, x: Any, y: Any) -> Any:
        return self.plus(x, self.negative(y))

    def _mixed(self, u: Power, v: Power, w: np.ndarray, constant: Interval, below: bool) -> Line:
        """(1 - w) u + w v + constant."""
        first, second = self._weighted(u, 1.0 - of(w)), self._weighted(v, of(w))
        both = Power(1, first.constant + second.constant, joined(first.atoms, second.atoms))
        return self._line(both, below).raised(constant)

    def _weighted(self, u: Power, w: Interval) -> Power:
        return Power(1, u.constant * w, tuple((w * c, atom) for c, atom in u.atoms))

    def _distance(self, u: Power, v: Power) -> Interval:
        """Of v - u."""
        less = self._raised(positive(u), -1.0)
        return self._value(Power(1, v.constant + less.constant, joined(v.atoms, less.atoms))).range

    def _together(self, u: Power, v: Power) -> Atom:
        """ln(e^u + e^v)."""
        d = self._distance(u, v)
        at = np.clip(self._at(v) - self._at(u), d.low, d.high)
        w = np.clip(1 / (1 + np.exp(-np.clip(at, -600, 600))), EDGE, 1 - EDGE)
        below = self._mixed(u, v, w, entropy(w), True)
        f = softplus(Interval(d.low, d.low)), softplus(Interval(d.high, d.high))
        s = chord(f, d, w)
        gap = np.maximum((f[0] - of(s) * d.low).high, (f[1] - of(s) * d.high).high)
        above = self._mixed(u, v, s, of(gap), False)
        p, q = self._value(u).range, self._value(v).range
        plain = Interval(added(p.low, q.low).low, added(p.high, q.high).high)
        ends = self._places.range(below).low, self._places.range(above).high
        reached = np.logaddexp(self._at(u), self._at(v))
        return Atom(below, above, Interval(np.maximum(ends[0], plain.low), np.minimum(ends[1], plain.high)), reached)

    def _apart(self, u: Power, v: Power) -> Power:
        """ln(e^u - e^v), of the sign of the larger."""
        d = self._distance(u, v)
        if (d.low > 0).sum() > (d.high < 0).sum():
            u, v, d = v, u, -d
        told = d.high < 0
        d = Interval(np.where(told, d.low, -1.0), np.where(told, d.high, -1.0))
        at = np.clip(self._at(v) - self._at(u), d.low, d.high)
        # phi(d) = ln(1 - e^d), concave and falling: phi(d) <= phi(p) + phi'(p) (d - p) with phi' = -1/(e^-p - 1)
        w = 1 / np.expm1(-at)
        # of the slope -w, phi(d) + w d has its most at e^d = w/(1 + w): -(1 + w) ln(1 + w) + w ln w
        top = of(w) * logarithm(w) - (1.0 + of(w)) * logarithm(1.0 + of(w))
        above = self._mixed(u, v, -w, top, False)
        f = short(Interval(d.low, d.low)), short(Interval(d.high, d.high))
        s = -chord(f, d, -w)
        gap = np.minimum((f[0] + of(s) * d.low).low, (f[1] + of(s) * d.high).low)
        below = self._mixed(u, v, -s, of(gap), True)
        reached = self._at(u) + np.log(-np.expm1(at))
        ranged = Atom(below, above, Interval(self._places.range(below).low, self._places.range(above).high), reached)
        found = Power(u.sign, of(0.0), ((1.0, ranged),), ~told | u.open | v.open)
        if told.all():
            return found
        return replace(found, most=np.maximum(self._value(u).range.high, self._value(v).range.high))

    def _at(self, u: Power) -> np.ndarray:
        total = np.zeros(self._places.shape[0]) + u.constant.middle
        for c, atom in u.atoms:
            total = total + of(c).middle * atom.at
        return total

    def magnitude(self, x: Any) -> Any:
        return replace(positive(self._power(x)), most=None)

    def logarithm(self, x: Any) -> Any:
        u = self._power(x)
        if u.sign < 0 or np.any(u.open):
            raise _Unknown
        return self._value(u)

    def exponential(self, x: Any) -> Any:
        return self._single(self._plain(x))

    def arsinh(self, x: Any) -> Any:
        """Odd: a line above it is one below its mirror image."""
        x = self._plain(x)
        p, q = arsinh_slope(x.range, x.at), arsinh_slope(-x.range, -x.at)
        below = x.below.times(p).raised(arsinh_gap(x.range, p))
        above = x.above.times(q).raised(-arsinh_gap(-x.range, q))
        return Atom(below, above, monotone(np.arcsinh, x.range), np.arcsinh(x.at))

    def larger(self, x: Any, y: Any) -> Any:
        """Of two positive numbers: not below the one that is larger at the place, and not above their sum."""
        u, v = self._power(x), self._power(y)
        if u.sign < 0 or v.sign < 0 or np.any(u.open | v.open):
            raise _Unknown
        first = self._at(u) >= self._at(v)
        below = either(first, self._line(u, True), self._line(v, True))
        p, q = self._value(u), self._value(v)
        together = self._together(u, v)
        ranged = Interval(np.maximum(p.range.low, q.range.low), np.maximum(p.range.high, q.range.high))
        return self._single(Atom(below, together.above, ranged, np.maximum(p.at, q.at)))

    def less(self, x: Any, y: Any) -> Any:
        p, q = self._plain(x).range, self._plain(y).range
        return Truth(p.high < q.low, p.low >= q.high)

    def is_not(self, x: Any) -> Any:
        if not isinstance(x, Truth):
            raise _Unknown
        return Truth(x.no, x.yes)

    def if_else_zero(self, when: Any, x: Any) -> Any:
        if not isinstance(when, Truth):
            raise _Unknown
        return Piece(when, x)

    def _chosen(self, x: Piece, y: Piece) -> Any:
        """One of two positive numbers, by a condition and its opposite."""
        u, v = self._power(x.value), self._power(y.value)
        if u.sign < 0 or v.sign < 0 or x.when.yes is not y.when.no or np.any(u.open | v.open):
            raise _Unknown
        p, q, yes, no = self._value(u), self._value(v), x.when.yes, y.when.yes
        low, high = np.minimum(p.range.low, q.range.low), np.maximum(p.range.high, q.range.high)
        below = either(yes, p.below, either(no, q.below, self._nothing.raised(low)))
        above = either(yes, p.above, either(no, q.above, self._nothing.raised(high)))
        return self._single(Atom(below, above, Interval(low, high), np.where(yes, p.at, q.at)))


def lines(function: ca.Function, places: Places, logarithmic: Sequence[bool]) -> tuple[list[Line | None], list[Line | None]]:
    """Lines below and above the logarithms of the entries of an SX function of one vector; None: no rule gives one.

    Parameters
    ----------
    function : casadi.Function
        Its output one dense vector.
    places : Places
    logarithmic : sequence of bool
        Which variables are logarithms.

    Returns
    -------
    tuple of list of Line or None
    """
    rules = _Rules(places, logarithmic)
    entries = walk(function, rules)
    return [rules.line_below(x) for x in entries], [rules.line_above(x) for x in entries]

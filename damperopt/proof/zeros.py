"""Zeros of polynomials with rational coefficients, counted and excluded exactly.

In one variable by Sturm's theorem; in two over a rectangle by Bernstein coefficients with subdivision.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from fractions import Fraction
from math import comb, lcm
from typing import Any, TypeAlias

import flint
import numpy as np

from .rationals import decimal

__all__ = ["zero_in_rectangle", "zeros_in_range"]

Q: TypeAlias = flint.fmpq
MAX_BOXES = 20_000


# one variable: Sturm


def zeros_in_range(condition: Any, speeds: tuple[float, float]) -> list[float]:
    """Zeros of a polynomial in V within a closed range, counted exactly and then enclosed; [] is a proof of none.

    Parameters
    ----------
    condition : fmpq_mpoly
        Polynomial in (u, V, F) without u and F.
    speeds : tuple of float
        Ends of the range, the decimals that they are written as [m/s].

    Returns
    -------
    list of float
        Ascending [m/s], each to about 1e-9 of the upper end.
    """
    low, high = decimal(speeds[0]), decimal(speeds[1])
    degree = condition.degrees()[1]
    coefficients = [Q(0)] * (degree + 1)
    for monomial, coefficient in condition.terms():
        coefficients[monomial[1]] += coefficient
    polynomial = flint.fmpq_poly(coefficients)
    if polynomial == 0:
        return [speeds[0]]
    ends = [float(speed) for speed, end in zip(speeds, (low, high), strict=True) if polynomial(end) == 0]
    return sorted({*ends, *_enclosed(_sturm_chain(polynomial), low, high)})


def _sturm_chain(polynomial: flint.fmpq_poly) -> list[flint.fmpz_poly]:
    """Sturm's chain; a member may be scaled by a positive number, so each is kept primitive with integer coefficients.

    Of the square-free part: at a multiple zero all members of the polynomial's own chain vanish, and nothing is counted.
    """
    whole = polynomial.numer()
    first = _primitive(whole // whole.gcd(whole.derivative())) if whole.degree() > 0 else whole
    chain = [first, _primitive(first.derivative())]
    while chain[-1].degree() > 0:
        above, below = chain[-2:]
        scale = abs(below.leading_coefficient()) ** (above.degree() - below.degree() + 1)
        remainder = -((above * scale) % below)
        if remainder == 0:
            break
        chain.append(_primitive(remainder))
    return [p for p in chain if p != 0]


def _primitive(polynomial: flint.fmpz_poly) -> flint.fmpz_poly:
    return polynomial // polynomial.content() if polynomial != 0 else polynomial


def _sign_changes(chain: list[flint.fmpz_poly], at: Q) -> int:
    signs = [value > 0 for value in (p(at) for p in chain) if value != 0]
    return sum(a != b for a, b in itertools.pairwise(signs))


def _enclosed(chain: list[flint.fmpz_poly], low: Q, high: Q) -> list[float]:
    """Distinct zeros in (low, high], each to about 1e-9 of the range's upper end."""
    count = _sign_changes(chain, low) - _sign_changes(chain, high)
    if count == 0:
        return []
    if (high - low) < high * Q(1, 10**9):
        return [float(Fraction(int(high.p), int(high.q)))]
    middle = (low + high) / 2
    return _enclosed(chain, low, middle) + _enclosed(chain, middle, high)


# two variables: Bernstein


def zero_in_rectangle(
    condition: Any, speeds: tuple[float, float], loads: Sequence[float | Fraction]
) -> tuple[tuple[float, float] | None, int]:
    """A point where a polynomial in V and F vanishes, changes sign or cannot be told from zero; None is a proof of none.

    Bernstein coefficients enclose the polynomial on a box and equal it at the corners; the box is halved until all have
    one sign. All numbers are integers (the scale of a box is positive and does not matter).

    Parameters
    ----------
    condition : fmpq_mpoly
        Polynomial in (u, V, F) without u.
    speeds, loads : sequence of float
        Ends of the rectangle, the decimals that they are written as [m/s], [N]; a fraction is itself, of whatever F stands for.

    Returns
    -------
    tuple
        (speed, load) or None, and the number of boxes examined.
    """
    whole = _bernstein(condition, speeds, loads)
    if whole[0, 0] < 0:
        whole = -whole
    unit = Fraction(0), Fraction(1)
    stack = [(whole, unit, unit)]
    examined = 0
    while stack:
        box, v, f = stack.pop()
        examined += 1
        if (box > 0).all():
            continue
        for i, j in ((0, 0), (0, -1), (-1, 0), (-1, -1)):
            if box[i, j] <= 0:
                return (_inside(speeds, v[i]), _inside(loads, f[j])), examined
        if examined > MAX_BOXES:
            return (_inside(speeds, (v[0] + v[1]) / 2), _inside(loads, (f[0] + f[1]) / 2)), examined
        # halve where the polynomial varies more: a ridge along one axis needs no cuts across it
        along_v = _variation(box, 0) >= _variation(box, 1)
        for half, interval in zip(_halves(box, 0 if along_v else 1), _halved(v if along_v else f), strict=True):
            stack.append((half, interval, f) if along_v else (half, v, interval))
    return None, examined


def _variation(box: np.ndarray, axis: int) -> int:
    """Largest difference of neighbouring coefficients along an axis; 0 where there is one coefficient only."""
    return max(map(abs, np.diff(box, axis=axis).ravel().tolist()), default=0)


def _inside(ends: Sequence[float | Fraction], fraction: Fraction) -> float:
    low, high = _fraction(ends[0]), _fraction(ends[-1])
    return float(low + (high - low) * fraction)


def _fraction(value: float | Fraction) -> Fraction:
    """A number of the envelope, as the decimal that was written."""
    return value if isinstance(value, Fraction) else Fraction(repr(float(value)))


def _halved(interval: tuple[Fraction, Fraction]) -> tuple[tuple[Fraction, Fraction], tuple[Fraction, Fraction]]:
    middle = (interval[0] + interval[1]) / 2
    return (interval[0], middle), (middle, interval[1])


def _bernstein(condition: Any, speeds: tuple[float, float], loads: Sequence[float | Fraction]) -> np.ndarray:
    """Integer Bernstein coefficients on the rectangle, (degree in V + 1, degree in F + 1), up to a positive factor."""
    _, m, n = condition.degrees()
    power = np.full((m + 1, n + 1), Fraction(0), dtype=object)
    for (_, i, j), coefficient in condition.terms():
        power[i, j] = Fraction(int(coefficient.p), int(coefficient.q))
    for axis, ends in enumerate((speeds, loads)):
        lines = np.moveaxis(power, axis, 0).reshape(power.shape[axis], -1).T
        converted = [_bernstein_1d(line, _fraction(ends[0]), _fraction(ends[-1])) for line in lines]
        power = np.array(converted, dtype=object).reshape(-1, power.shape[axis])
        power = power.T if axis == 0 else power
    scale = lcm(*(c.denominator for c in power.ravel()))
    return np.array([[int(c * scale) for c in row] for row in power], dtype=object)


def _bernstein_1d(power: Any, low: Fraction, high: Fraction) -> list[Fraction]:
    n = len(power) - 1
    # p(low + (high - low) t) in powers of t, then b_k = sum_i C(k, i)/C(n, i) p_i
    width = high - low
    zero = Fraction(0)
    moved = [width**i * sum((power[k] * comb(k, i) * low ** (k - i) for k in range(i, n + 1)), zero) for i in range(n + 1)]
    return [sum((Fraction(comb(k, i), comb(n, i)) * moved[i] for i in range(k + 1)), zero) for k in range(n + 1)]


def _halves(box: np.ndarray, axis: int) -> tuple[np.ndarray, np.ndarray]:
    """Bernstein coefficients of both halves along an axis, times 2^degree (de Casteljau without division)."""
    row = np.moveaxis(box, axis, 0)
    degree = len(row) - 1
    left, right = [row[0] * 2**degree], [row[-1] * 2**degree]
    for step in range(1, degree + 1):
        row = row[:-1] + row[1:]
        left.append(row[0] * 2 ** (degree - step))
        right.append(row[-1] * 2 ** (degree - step))
    return np.moveaxis(np.array(left), 0, axis), np.moveaxis(np.array(right[::-1]), 0, axis)

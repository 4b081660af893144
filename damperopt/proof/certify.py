"""Exact proof of stability over a continuous range of speeds, and of loads.

With the design and the data as rationals, M(V, F) = V (A(V, F) + sigma 1) is a matrix of polynomials with rational
coefficients, and its eigenvalues lie where those of A + sigma 1 do, left or right of the axis. Write its characteristic
polynomial as q(mu) = E(mu^2) + mu O(mu^2). As V and F vary continuously, a root can reach the imaginary axis only where
q(0) = 0 (through zero) or where E and O have a common root (a pair +-i w), that is where their resultant vanishes; up to
a power of the leading coefficient that resultant is the last Hurwitz determinant. So if neither q(0) nor the resultant
has a zero in the range, and one point of it is stable, every point is.

Zeros are counted exactly: Sturm's theorem in rational arithmetic for a range of speeds; Bernstein coefficients in
rational arithmetic, with subdivision, for a rectangle of speeds and loads. No part of the optimiser is used.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from fractions import Fraction
from math import comb, lcm
from typing import Any, TypeAlias

import flint
import numpy as np

from ..errors import CertificateError
from ..results import Certificate
from ..stability.linear import LinearModel
from ..study.study import Study
from ..symbols import data_values
from .rationals import evaluate, rational

__all__ = ["certify"]

Q: TypeAlias = flint.fmpq
MAX_BOXES = 20_000


def certify(
    study: Study, design: Mapping[str, float], margin: float | None = None, model: LinearModel | None = None
) -> Certificate:
    """Prove that a design keeps the stability margin over the whole envelope, or say where it does not.

    Parameters
    ----------
    study : Study
    design : mapping
        Design variables by name [SI]; taken at their exact binary values.
    margin : float or None
        Stability margin [1/s]; None: the study's own (0 if it has no requirements).
    model : LinearModel or None
        Of the study, if it is at hand.

    Returns
    -------
    Certificate

    Raises
    ------
    CertificateError
        If the model cannot be evaluated exactly. A design that is not stable is no error.
    """
    if margin is None:
        margin = study.required.stability_margin if study.requirements else 0.0
    envelope = study.envelope
    speeds, loads = (envelope.speed.min, envelope.speed.max), envelope.loads
    family = _Family(study, design, margin, model or LinearModel(study))
    method = "bernstein" if envelope.load_is_range else "sturm"

    def outcome(point: tuple[float, float] | None, reason: str, boxes: int = 0, proved: bool | None = None) -> Certificate:
        return Certificate(point is None if proved is None else proved, margin, speeds, loads, method, point, reason, boxes)

    # one stable point for each separate proof
    for load in loads[:1] if envelope.load_is_range else loads:
        if not family.stable_at(rational(speeds[0]), rational(load)):
            start = speeds[0], load
            return outcome(start, f"missed at {_place(start)}, the low end of the range")

    if envelope.load_is_range:
        boxes = 0
        for condition in family.conditions():
            point, examined = _zero_in_rectangle(condition, speeds, loads)
            boxes += examined
            if point is not None and family.stable_at(rational(point[0]), rational(point[1])):
                return outcome(None, f"undecided near {_place(point)}, where the margin is kept", boxes, proved=False)
            if point is not None:
                return outcome(point, f"missed or touched at {_place(point)}", boxes)
        return outcome(None, "one point is stable, and no root can cross anywhere in the rectangle of speeds and loads", boxes)

    for load in loads:
        zeros = [V for condition in family.conditions(rational(load)) for V in _zeros_in_range(condition, speeds)]
        if zeros:
            worst = family.worst_between(sorted(zeros), speeds, load), load
            meeting = ", ".join(f"{V:.6g}" for V in sorted(zeros))
            return outcome(worst, f"missed or touched at {_place(worst)}; roots meet the line at {meeting} m/s")
    return outcome(None, "one point is stable, and no root can cross at any speed")


def _place(point: tuple[float, float]) -> str:
    return f"{point[0]:.6g} m/s, {point[1] / 1e3:.6g} kN"


class _Family:
    """A(V, F) + sigma 1 of one design as exact functions of speed and load."""

    def __init__(self, study: Study, design: Mapping[str, float], margin: float, model: LinearModel):
        self._gear, self._margin, self._n = model.at(design), margin, len(model.state_names)
        values = [rational(design[name]) for name in model.design_names]
        data = [rational(value) for value in data_values(study)]

        def matrix(V: Q, F: Q) -> flint.fmpq_mat:
            entries = evaluate(model.state_matrix, [values, [V], [F], data])
            shift = rational(margin)
            return flint.fmpq_mat([[e + (shift if i == j else 0) for j, e in enumerate(row)] for i, row in enumerate(entries)])

        self.matrix = matrix
        self._parts = self._split()

    def _split(self) -> dict[tuple[int, int], flint.fmpq_mat]:
        """Matrices of V^i F^j, i = -1, 0, 1 and j = 0, 1: all that a rolling tyre on a linear string makes of V and F."""
        V = [Q(1), Q(2), Q(4)]
        inverse = flint.fmpq_mat([[1 / v, Q(1), v] for v in V]).inv()
        parts = {}
        for j, samples in enumerate(self._load_samples(V)):
            for i in range(3):
                parts[i - 1, j] = sum((samples[k] * inverse[i, k] for k in range(1, 3)), samples[0] * inverse[i, 0])
        V, F = Q(7, 3), Q(5, 2)
        rebuilt = sum((part * V**i * F**j for (i, j), part in parts.items()), parts[0, 0] * Q(0))
        if rebuilt != self.matrix(V, F):
            raise CertificateError("the state matrix is no combination of V, 1, 1/V with 1, F_z: no certificate for this model")
        return parts

    def _load_samples(self, speeds: list[Q]) -> list[list[flint.fmpq_mat]]:
        unloaded = [self.matrix(V, Q(0)) for V in speeds]
        return [unloaded, [self.matrix(V, Q(1)) - without for V, without in zip(speeds, unloaded, strict=True)]]

    def stable_at(self, V: Q, F: Q) -> bool:
        """Whether every eigenvalue at one rational point lies left of the line, by Routh's array in exact arithmetic."""
        coefficients = self.matrix(V, F).charpoly().coeffs()[::-1]
        upper, lower = coefficients[0::2], coefficients[1::2]
        while lower:
            if upper[0] <= 0 or lower[0] <= 0:
                return False
            ratio = upper[0] / lower[0]
            padded = lower[1:] + [Q(0)] * (len(upper) - len(lower))
            upper, lower = lower, [u - ratio * w for u, w in zip(upper[1:], padded, strict=True)]
        return upper[0] > 0

    def conditions(self, load: Q | None = None) -> list[flint.fmpq_mpoly]:
        """Polynomials in V (and F, if no load is given) that vanish wherever a root meets the line."""
        ring = flint.fmpq_mpoly_ctx.get(("u", "V", "F"), "lex")
        u, V, F = ring.gens()
        F = F if load is None else ring.constant(load)
        n = self._n
        powers = {-1: ring.constant(1), 0: V, 1: V * V}
        M = [
            [sum((powers[i] * F**j * part[r, c] for (i, j), part in self._parts.items()), ring.constant(0)) for c in range(n)]
            for r in range(n)
        ]
        q = _characteristic(M, ring)
        even = sum((q[n - k] * u ** (k // 2) for k in range(0, n + 1, 2)), ring.constant(0))
        odd = sum((q[n - k] * u ** (k // 2) for k in range(1, n + 1, 2)), ring.constant(0))
        return [_without_factor(condition, V) for condition in (q[n], even.resultant(odd, "u"))]

    def worst_between(self, zeros: list[float], speeds: tuple[float, float], load: float) -> float:
        """Speed of the largest abscissa among the zeros and the middles between them."""
        ends = [speeds[0], *zeros, speeds[1]]
        candidates = np.array([*zeros, *((a + b) / 2 for a, b in itertools.pairwise(ends))])
        return float(candidates[self._gear.abscissa(candidates, load).argmax()])


def _characteristic(M: list[list[Any]], ring: Any) -> list[Any]:
    """Coefficients [1, c_1, ..., c_n] of det(mu 1 - M) over a polynomial ring (Faddeev-LeVerrier divides by integers)."""
    n, zero = len(M), ring.constant(0)
    coefficients = [ring.constant(1)]
    product = [[ring.constant(int(i == j)) for j in range(n)] for i in range(n)]
    for k in range(1, n + 1):
        product = [[sum((M[i][m] * product[m][j] for m in range(n) if M[i][m] != 0), zero) for j in range(n)] for i in range(n)]
        c_k = sum((product[i][i] for i in range(n)), zero) * Q(-1, k)
        coefficients.append(c_k)
        for i in range(n):
            product[i][i] += c_k
    return coefficients


def _without_factor(polynomial: Any, V: Any) -> Any:
    """Polynomial without its powers of V, which is positive throughout."""
    while polynomial != 0 and all(monomial[1] > 0 for monomial in polynomial.monoms()):
        polynomial = polynomial // V
    return polynomial


# one variable: Sturm


def _zeros_in_range(condition: Any, speeds: tuple[float, float]) -> list[float]:
    """Zeros of a polynomial in V within a closed range, counted exactly and then enclosed; [] is a proof of none."""
    low, high = rational(speeds[0]), rational(speeds[1])
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


def _zero_in_rectangle(
    condition: Any, speeds: tuple[float, float], loads: tuple[float, ...]
) -> tuple[tuple[float, float] | None, int]:
    """A point where a polynomial in V and F vanishes, changes sign or cannot be told from zero; None is a proof of none.

    Bernstein coefficients enclose the polynomial on a box and equal it at the corners; the box is halved until all have
    one sign. All numbers are integers (the scale of a box is positive and does not matter).
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
        for half, interval in zip(_halves(box, 0 if along_v else 1), _split(v if along_v else f), strict=True):
            stack.append((half, interval, f) if along_v else (half, v, interval))
    return None, examined


def _variation(box: np.ndarray, axis: int) -> int:
    """Largest difference of neighbouring coefficients along an axis; 0 where there is one coefficient only."""
    return max(map(abs, np.diff(box, axis=axis).ravel().tolist()), default=0)


def _inside(ends: tuple[float, ...], fraction: Fraction) -> float:
    return float(Fraction(ends[0]) + (Fraction(ends[-1]) - Fraction(ends[0])) * fraction)


def _split(interval: tuple[Fraction, Fraction]) -> tuple[tuple[Fraction, Fraction], tuple[Fraction, Fraction]]:
    middle = (interval[0] + interval[1]) / 2
    return (interval[0], middle), (middle, interval[1])


def _bernstein(condition: Any, speeds: tuple[float, float], loads: tuple[float, ...]) -> np.ndarray:
    """Integer Bernstein coefficients on the rectangle, (degree in V + 1, degree in F + 1), up to a positive factor."""
    _, m, n = condition.degrees()
    power = np.full((m + 1, n + 1), Fraction(0), dtype=object)
    for (_, i, j), coefficient in condition.terms():
        power[i, j] = Fraction(int(coefficient.p), int(coefficient.q))
    for axis, ends in enumerate((speeds, loads)):
        lines = np.moveaxis(power, axis, 0).reshape(power.shape[axis], -1).T
        converted = [_bernstein_1d(line, Fraction(ends[0]), Fraction(ends[-1])) for line in lines]
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

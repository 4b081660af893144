"""Exact proof of stability over a continuous range of speeds, and of loads.

With the design and the data as rationals, M(V, F) = V^p (A(V, F) + sigma 1) is, for some p >= 0, a matrix of polynomials with
rational coefficients (which powers of V and F occur, the components declare; that they keep it is checked), and its eigenvalues
lie where those of A + sigma 1 do, left or right of the axis. Write its characteristic
polynomial as q(mu) = E(mu^2) + mu O(mu^2). As V and F vary continuously, a root can reach the imaginary axis only where
q(0) = 0 (through zero) or where E and O have a common root (a pair +-i w), that is where their resultant vanishes; up to
a power of the leading coefficient that resultant is the last Hurwitz determinant. So if neither q(0) nor the resultant
has a zero in the range, and one point of it is stable, every point is.

Zeros are counted exactly: Sturm's theorem in rational arithmetic for a range of speeds; Bernstein coefficients in
rational arithmetic, with subdivision, for a rectangle of speeds and loads, or of speeds and dampings at each load of a list.
No part of the optimiser is used.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import Any, TypeAlias

import flint
import numpy as np

from ..results import Certificate
from ..stability.linear import LinearModel
from ..study.scope import place_words
from ..study.study import Study
from ..symbols import data_values
from .damping import Interval, over_damping
from .delay import certify_delay
from .parts import parts_in_powers
from .rationals import decimal, evaluate, rational
from .zeros import zero_in_rectangle, zeros_in_range

__all__ = ["certify"]

Q: TypeAlias = flint.fmpq
ONE = Q(1)

MARGINAL = 1e-9
"""Relative to the largest root: an abscissa that is the margin but for the rounding of eigenvalues."""


def certify(
    study: Study, design: Mapping[str, float], margin: float | None = None, model: LinearModel | None = None
) -> Certificate:
    """Prove that a design keeps the stability margin over the whole envelope, or say where it does not.

    Parameters
    ----------
    study : Study
        Its numbers are taken as the shortest decimals that return their floats: as they were written.
    design : mapping
        Design variables by name [SI]; taken at their exact binary values.
    margin : float or None
        Stability margin [1/s], a decimal as well; None: the study's own (0 if it has no requirements).
    model : LinearModel or None
        That of the study, if it has been built; None: it is built.

    Returns
    -------
    Certificate

    Raises
    ------
    CertificateError
        If the model cannot be evaluated exactly, or does not keep the powers of speed and load that its components declare. A
        design that is not stable is no error.
    """
    if margin is None:
        margin = study.required.stability_margin if study.requirements else 0.0
    envelope = study.envelope
    speeds, loads = (envelope.speed.min, envelope.speed.max), envelope.loads
    model = LinearModel(study) if model is None else model
    if model.structure is not None or (envelope.load_is_range and model.powers.load is None):
        return certify_delay(study, design, margin, model)
    method = "bernstein" if envelope.load_is_range else "sturm"

    place = partial(place_words, study)

    def outcome(point: tuple[float, float] | None, reason: str, boxes: int = 0, proved: bool | None = None) -> Certificate:
        proved = point is None if proved is None else proved
        verdict: Any = "proved" if proved else "undecided" if point is None else "refuted"
        return Certificate(proved, margin, speeds, loads, method, point, reason, boxes, verdict)

    if interval := Interval.of(study):
        return _over_damping(study, model, design, margin, interval)
    family = _Family(study, model, design, margin)

    # one stable point for each separate proof
    for load in loads[:1] if envelope.load_is_range else loads:
        if not family.stable_at(decimal(speeds[0]), decimal(load)):
            start = speeds[0], load
            if family.marginal_throughout(load):
                return outcome(
                    start, f"marginal at every speed: a root lies on the line Re = {0 - margin:g} 1/s at each of them"
                )
            return outcome(start, f"missed at {place(start)}, the low end of the range")

    if envelope.load_is_range:
        boxes = 0
        for condition in family.conditions():
            point, examined = zero_in_rectangle(condition, speeds, loads)
            boxes += examined
            if point is not None and family.stable_at(decimal(point[0]), decimal(point[1])):
                return outcome(None, f"undecided near {place(point)}, where the margin is kept", boxes, proved=False)
            if point is not None:
                return outcome(point, f"missed or touched at {place(point)}", boxes)
        return outcome(None, "one point is stable, and no root can cross anywhere in the rectangle of speeds and loads", boxes)

    for load in loads:
        zeros = [V for condition in family.conditions(load) for V in zeros_in_range(condition, speeds)]
        if zeros:
            worst = family.worst_between(sorted(zeros), speeds, load), load
            meeting = ", ".join(f"{V:.6g}" for V in sorted(zeros))
            return outcome(worst, f"missed or touched at {place(worst)}; roots meet the line at {meeting} m/s")
    return outcome(None, "one point is stable, and no root can cross at any speed")


def _over_damping(
    study: Study, model: LinearModel, design: Mapping[str, float], margin: float, interval: Interval
) -> Certificate:
    """The same over a rectangle of speeds and dampings, load by load."""
    speeds, loads, boxes = (study.envelope.speed.min, study.envelope.speed.max), study.envelope.loads, 0

    def outcome(verdict: Any, point: tuple[float, float, float] | None, reason: str) -> Certificate:
        place, factor = (None, None) if point is None else (point[:2], point[2])
        known = verdict == "proved", margin, speeds, loads, "bernstein, damping", place, reason, boxes, verdict
        return Certificate(*known, damping=interval.factors, damping_factor=factor)

    def near(V: float, load: float, factor: float) -> str:
        return f"{place_words(study, (V, load))}, {factor:.6g} times the damping"

    for load in loads:
        family = _OverDamping(study, model, design, margin, load, interval)
        # the corner that gives the conditions their sign
        start = speeds[0], load, family.over.factor(float(family.ends[0]))
        if not family.stable(*start):
            return outcome("refuted", start, f"missed at {near(*start)}, a corner of the rectangle")
        for condition in family.conditions():
            found, examined = zero_in_rectangle(condition, speeds, family.ends)
            boxes += examined
            if found is not None:
                point = found[0], load, family.over.factor(found[1])
                if family.stable(*point):
                    return outcome("undecided", None, f"undecided near {near(*point)}, where the margin is kept")
                return outcome("refuted", point, f"missed or touched at {near(*point)}")
    return outcome(
        "proved", None, "one point is stable, and no root can cross anywhere in the rectangle of speeds and dampings"
    )


class _Family:
    """A(V, F) + sigma 1 of one design as exact functions of speed and load."""

    def __init__(self, study: Study, model: LinearModel, design: Mapping[str, float], margin: float):
        self._gear, self._margin, self._n = model.at(design), margin, len(model.state_names)
        self._powers, self._envelope = model.powers, study.envelope
        exact = {name: rational(design[name]) for name in model.design_names}
        data, shift = [decimal(value) for value in data_values(study)], decimal(margin)

        def matrix(V: Q, F: Q, factor: Q = ONE) -> flint.fmpq_mat:
            values = list(study.damper.with_damping(exact, factor).values())
            entries = evaluate(model.state_matrix, [values, [V], [F], data])
            return flint.fmpq_mat([[e + (shift if i == j else 0) for j, e in enumerate(row)] for i, row in enumerate(entries)])

        self.matrix: Callable[..., flint.fmpq_mat] = matrix
        self._split: dict[float | None, dict[tuple[int, int], flint.fmpq_mat]] = {}

    def _parts(self, load: float) -> dict[tuple[int, int], flint.fmpq_mat]:
        """Matrices of V^i F^j in the declared powers; at one load alone where it is no polynomial in F."""
        key = None if self._powers.load is not None else load
        if key not in self._split:
            ends = [decimal(load)] if self._powers.load is None else [decimal(F) for F in self._envelope.loads]
            speeds = decimal(self._envelope.speed.min), decimal(self._envelope.speed.max)
            self._split[key] = parts_in_powers(self.matrix, self._powers, speeds, sorted(ends))
        return self._split[key]

    def marginal_throughout(self, load: float) -> bool:
        """Whether a root lies on the line at every speed (a condition vanishes identically) and none to its right."""
        given = load if not self._envelope.load_is_range else None
        if all(condition != 0 for condition in self.conditions(given)):
            return False
        speeds = np.geomspace(self._envelope.speed.min, self._envelope.speed.max, 32)
        roots = np.linalg.eigvals(self._gear.matrices(speeds, load))
        return bool((roots.real.max(axis=1) + self._margin <= MARGINAL * np.abs(roots).max(axis=1)).all())

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

    def conditions(self, load: float | None = None) -> list[flint.fmpq_mpoly]:
        """Polynomials in V (and F, if no load is given) that vanish wherever a root meets the line."""
        ring = flint.fmpq_mpoly_ctx.get(("u", "V", "F"), "lex")
        u, V, F = ring.gens()
        n, parts = self._n, self._parts(self._envelope.loads[0] if load is None else load)
        # times powers of V and F, which are positive, so that none is negative
        lowest = [min(0, *(power[axis] for power in parts)) for axis in (0, 1)]
        if load is not None:
            lowest[1] = 0
            parts = self._at_load(parts, decimal(load))
        products = [(V ** (i - lowest[0]) * F ** (j - lowest[1]), part) for (i, j), part in parts.items()]
        M = [[sum((p * part[r, c] for p, part in products), ring.constant(0)) for c in range(n)] for r in range(n)]
        q = _characteristic(M, ring)
        even = sum((q[n - k] * u ** (k // 2) for k in range(0, n + 1, 2)), ring.constant(0))
        odd = sum((q[n - k] * u ** (k // 2) for k in range(1, n + 1, 2)), ring.constant(0))
        return [_without_factor(condition, V) for condition in (q[n], even.resultant(odd, "u"))]

    def _at_load(self, parts: dict[tuple[int, int], flint.fmpq_mat], F: Q) -> dict[tuple[int, int], flint.fmpq_mat]:
        """The parts at one load, which is then no variable."""
        joined: dict[tuple[int, int], flint.fmpq_mat] = {}
        for (i, j), part in parts.items():
            joined[i, 0] = joined.get((i, 0), flint.fmpq_mat(self._n, self._n)) + part * F**j
        return joined

    def worst_between(self, zeros: list[float], speeds: tuple[float, float], load: float) -> float:
        """Speed of the largest abscissa among the zeros and the middles between them."""
        ends = [speeds[0], *zeros, speeds[1]]
        candidates = np.array([*zeros, *((a + b) / 2 for a, b in itertools.pairwise(ends))])
        return float(candidates[self._gear.abscissa(candidates, load).argmax()])


class _OverDamping(_Family):
    """The same at one load as functions of speed and of what the equations are linear in, the damping or its inverse."""

    def __init__(
        self, study: Study, model: LinearModel, design: Mapping[str, float], margin: float, load: float, interval: Interval
    ):
        super().__init__(study, model, design, margin)
        whole, F, speeds = self.matrix, decimal(load), (decimal(study.envelope.speed.min), decimal(study.envelope.speed.max))
        self.over, parts = over_damping(lambda V, factor: whole(V, F, factor), self._powers.speed, speeds, interval)
        self.matrix, self._split = (lambda V, g: whole(V, F, self.over.factor(g))), {None: parts, load: parts}
        self._powers = replace(self._powers, load=(0, 1))
        self.ends = [Fraction(int(g.p), int(g.q)) for g in self.over.ends]

    def stable(self, V: float, load: float, factor: float) -> bool:
        """Whether every eigenvalue lies left of the line at a speed and a factor on the damping."""
        return self.stable_at(decimal(V), self.over.linear_in(decimal(factor)))


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

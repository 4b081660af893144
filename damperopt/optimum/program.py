"""Nonlinear programs of a design problem: for least mass, and for the least relaxation under which a design exists.

Each comes with two ways to say "stable with the margin at these speeds and loads":

* Hurwitz: the Lienard-Chipart conditions of the shifted characteristic polynomial. It finds the best basin most often, but
  where two modes sit on the margin at once the last Hurwitz determinant, the product of their two dampings, has no gradient
  and the program no constraint qualification.
* Factors: the shifted polynomial equals a product of factors s^2 + b s + c and s + r with b, c, r >= 0. Regular at such
  corners, but it stops where a real root passes from one factor to another.

Stability is imposed at slots, each a speed and a load given as parameters, so that one program serves every round of the
exchange; slots without a point impose nothing.

Decay is imposed by cuts: ln(decay ratio) at one speed and load with its gradient, both from an integrator, and the curvature
that earlier gradients show, as a function of the scaled variables about the design where it was simulated. The exchange
renews them until the solution is that design, so that the multipliers are those of the decay itself. Simulated peaks that
size the parts are modelled in the same way.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any, ClassVar, Protocol

import casadi as ca
import numpy as np

from ..motion.measure import PEAKS
from ..stability.hurwitz import characteristic_polynomial, lienard_chipart
from .cuts import Cut
from .problem import ESTIMATED, DesignProblem

__all__ = [
    "CUTS",
    "ElasticFactorProgram",
    "ElasticHurwitzProgram",
    "FactorProgram",
    "HurwitzProgram",
    "Instance",
    "Program",
    "relaxable",
]

Points = Sequence[tuple[float, float]]

CUTS = 12
"""Decay cuts that a program has room for."""

NEVER = -1e3
"""ln(decay ratio) of a cut that is not used."""

EXCESS_PRICE = 1e3
"""kg per unit of ln(decay ratio) by which cuts may be exceeded: far above any multiplier, so that it is 0 where it can be."""


@dataclass(frozen=True)
class Instance:
    """Numbers that turn a program into one problem: start, bounds and parameters."""

    x0: np.ndarray
    lbx: np.ndarray
    ubx: np.ndarray
    lbg: np.ndarray
    ubg: np.ndarray
    p: np.ndarray


class Program(Protocol):
    """A program with a fixed number of slots.

    Attributes
    ----------
    nlp : dict
        x, p, f, g for `casadi.nlpsol`. x begins with the scaled variables and, with a decay requirement, the excess of the
        cuts; g with the strength, geometry and decay rows; p with data, load limit, speeds and loads of the slots.
    """

    nlp: dict[str, ca.SX]

    def __init__(self, problem: DesignProblem, slots: int): ...

    def instance(self, design: Mapping[str, float], points: Points, **options: Any) -> Instance: ...


def relaxable(problem: DesignProblem) -> tuple[str, ...]:
    """Names of the constraints that an elastic program can relax: strength and geometry rows, decay, margin."""
    decay = ("decay_ratio",) if problem.study.required.decay is not None else ()
    return (*problem.constraint_names, *decay, "stability_margin")


class _Slots:
    """Variables, parameters, mass, strength, geometry and decay rows, and the shifted polynomial at every slot."""

    def __init__(self, problem: DesignProblem, slots: int, margin: ca.SX | None = None):
        self.problem, self.slots, self.order = problem, slots, len(problem.model.state_names)
        self.x = ca.SX.sym("x", len(problem.variables))
        physical = problem.physical(self.x)
        n = len(problem.design_names)
        design, sizes = physical[:n], physical[n:]
        data, load_limit = ca.SX.sym("data", len(problem.data)), ca.SX.sym("load_limit")
        V, F_z, self.rate = (ca.SX.sym(name, slots) for name in ("V", "F_z", "rate"))
        self.p = ca.vertcat(data, load_limit, V, F_z, self.rate)
        factors: Any = ESTIMATED
        x = self.x[: len(problem.design_names)]
        monomials = ca.vertcat(1, x, ca.vec(x @ x.T) / 2)
        if problem.study.required.limit_event == "simulated":
            peaks, simulated = ca.SX.sym("peaks", monomials.numel(), len(PEAKS)), ca.SX.sym("simulated")
            estimated = problem.estimated_peaks(design, data, load_limit)
            factors = ca.exp(simulated * (peaks.T @ monomials - ca.log(estimated)))
            self.p = ca.vertcat(self.p, simulated, ca.vec(peaks))
        self.mass, self.rows = problem.mass_and_rows(design, sizes, data, load_limit, factors)
        self.decay_rows, self.excess = ca.SX(0, 1), ca.SX(0, 1)
        if problem.study.required.decay is not None:
            self.excess = ca.SX.sym("excess")
            cuts = ca.SX.sym("cuts", monomials.numel(), CUTS)
            ratio = data[problem.data_names.index("requirements.decay.ratio")]
            limit = ca.log(ratio) + np.log1p(-problem.study.solver.decay_reserve)
            self.decay_rows = cuts.T @ monomials - limit
            self.p = ca.vertcat(self.p, ca.vec(cuts))
        if margin is not None:
            data = ca.vertcat(data)  # a copy: the parameter keeps its place, the model sees the variable
            data[problem.data_names.index("requirements.stability_margin")] = margin
        self.polynomials = [
            characteristic_polynomial(problem.shifted_matrix(design, data, V[i], F_z[i]) / self.rate[i]) for i in range(slots)
        ]

    def numbers(
        self,
        design: Mapping[str, float],
        points: Points,
        cuts: Sequence[Cut] = (),
        peaks: Sequence[Cut] = (),
        margin: float | None = None,
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Common parameters; per slot the roots at `design`, shifted by the margin, and the rate that scales them to 1."""
        problem = self.problem
        filled = [*points, *[points[-1]] * (self.slots - len(points))]
        V, F_z = np.array(filled).T
        shift = problem.study.solver.margin_reserve
        shift += problem.study.required.stability_margin if margin is None else margin
        roots = np.linalg.eigvals(problem.model.at(design).matrices(V, F_z)) + shift
        rates = np.exp(np.log(np.abs(roots) + 1e-3).mean(axis=1))
        p = [problem.data, [problem.load_limit], V, F_z, rates]
        n = len(problem.design_names)
        if problem.study.required.limit_event == "simulated":
            models = [peak.about_zero() for peak in peaks] or [np.zeros(1 + n + n * n)] * len(PEAKS)
            p += [[float(bool(peaks))], *models]
        if self.decay_rows.numel():
            columns = [cut.about_zero() for cut in cuts]
            unused = np.append(NEVER, np.zeros(n + n * n))
            p += [*columns, *[unused] * (CUTS - len(columns))]
        return np.concatenate(p), roots, rates

    def box(self, design: Mapping[str, float], radius: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Scaled variables of a design and their bounds, no design variable further than `radius` from it."""
        lower, upper = self.problem.bounds()
        x0 = np.clip(self.problem.scaled(design), lower, upper)
        free = len(self.problem.size_names)
        around = np.append(np.full(x0.size - free, radius), np.full(free, np.inf))  # sizes of parts follow the design
        return x0, np.maximum(lower, x0 - around), np.minimum(upper, x0 + around)


class _HurwitzConditions:
    """Lienard-Chipart conditions of all slots as rows <= 0; no variables of its own, one weight per slot."""

    def __init__(self, common: _Slots):
        weight = ca.SX.sym("weight", common.slots)
        last = f"H{common.order - 1}"
        conditions = [lienard_chipart(a) for a in common.polynomials]
        self.variables, self.parameters = ca.SX(0, 1), weight
        self.rows = ca.vertcat(
            *(-value * (weight[i] if name == last else 1) for i, slot in enumerate(conditions) for name, value in slot.items())
        )
        self._per_slot = len(conditions[0])

    def instance(self, roots: np.ndarray, rates: np.ndarray, used: int) -> Instance:
        limits = np.zeros(self.rows.numel())
        limits[used * self._per_slot :] = np.inf
        nothing = np.zeros(0)
        weights = np.array([_damping_weight(r, rate) for r, rate in zip(roots, rates, strict=True)])
        return Instance(nothing, nothing, nothing, np.full(limits.size, -np.inf), limits, weights)


def _damping_weight(roots: np.ndarray, rate: float) -> float:
    """Weight of the last Hurwitz determinant, the product of -(s_i + s_j) over all pairs of roots: divided by the factors
    that are no conjugate pairs it is the product of -2 Re(s) over the oscillating modes, in 1/s, as a margin is."""
    i, j = np.triu_indices(len(roots), 1)
    sums = roots[i] + roots[j]
    conjugate = (np.abs(sums.imag) < 1e-9 * np.abs(roots[i])) & (np.abs(roots[i].imag) > 0)
    return float(rate ** conjugate.sum() / np.prod(np.abs(sums[~conjugate]) / rate + 1e-6))


class _StableFactors:
    """Shifted polynomial = product of factors with variables b [1/s], c/rate^2, ..., r/rate >= 0 at every slot."""

    def __init__(self, common: _Slots):
        n = common.order
        lifted = ca.SX.sym("lifted", n, common.slots)
        equalities = []
        for i, a in enumerate(common.polynomials):
            pairs = [[1, lifted[2 * k, i] / common.rate[i], lifted[2 * k + 1, i]] for k in range(n // 2)]
            single = [[1, lifted[n - 1, i]]] if n % 2 else []
            product = reduce(_multiply, pairs + single)
            equalities += [product[k] - a[k] for k in range(1, n + 1)]
        self.variables, self.parameters = ca.vec(lifted), ca.SX(0, 1)
        self.rows = ca.vertcat(*equalities)
        self._per_slot = n

    def instance(self, roots: np.ndarray, rates: np.ndarray, used: int) -> Instance:
        factors = np.concatenate([_factors(r, rate) for r, rate in zip(roots, rates, strict=True)])
        lower = np.where(np.arange(factors.size) < used * self._per_slot, 0.0, -np.inf)
        equal = np.zeros(factors.size)
        return Instance(factors, lower, np.full(factors.size, np.inf), equal, equal, np.zeros(0))


def _multiply(p: list[Any], q: list[Any]) -> list[Any]:
    product: list[Any] = [0] * (len(p) + len(q) - 1)
    for i, p_i in enumerate(p):
        for j, q_j in enumerate(q):
            product[i + j] = product[i + j] + p_i * q_j
    return product


def _factors(roots: np.ndarray, rate: float) -> list[float]:
    """[b, c/rate^2, ..., r/rate] of real factors: conjugate pairs, then neighbouring real roots; r is the fastest."""
    real = np.abs(roots.imag) <= 1e-9 * (1 + np.abs(roots))
    fast_to_slow = sorted(roots[real].real)
    single = [fast_to_slow.pop(0)] if len(fast_to_slow) % 2 else []
    pairs = [(-2 * s.real, abs(s) ** 2) for s in roots[~real] if s.imag > 0]
    pairs += [(-(s + t), s * t) for s, t in zip(fast_to_slow[::2], fast_to_slow[1::2], strict=True)]
    ordered = sorted(pairs, key=lambda pair: pair[1])
    return [number for b, c in ordered for number in (b, c / rate**2)] + [-s / rate for s in single]


class _MassProgram:
    """Least mass under the strength and geometry rows and the stability conditions.

    Parameters
    ----------
    problem : DesignProblem
    slots : int
        Number of (speed, load) points it has room for.
    """

    stability_type: ClassVar[type]

    def __init__(self, problem: DesignProblem, slots: int):
        self._common = common = _Slots(problem, slots)
        self._stability = stability = self.stability_type(common)
        excess = ca.sum1(common.excess)
        self.nlp = {
            "x": ca.vertcat(common.x, common.excess, stability.variables),
            "p": ca.vertcat(common.p, stability.parameters),
            "f": common.mass + EXCESS_PRICE * excess,
            "g": ca.vertcat(common.rows, common.decay_rows - excess, stability.rows),
        }

    def instance(
        self,
        design: Mapping[str, float],
        points: Points,
        cuts: Sequence[Cut] = (),
        peaks: Sequence[Cut] = (),
        radius: float = np.inf,
        **options: Any,
    ) -> Instance:
        """The program at `points`, started and scaled at `design`, no design variable further than `radius` from there."""
        common = self._common
        p, roots, rates = common.numbers(design, points, cuts, peaks)
        x0, lower, upper = common.box(design, radius)
        none, rows = np.zeros(common.excess.numel()), common.rows.numel() + common.decay_rows.numel()
        own = Instance(
            np.append(x0, none),
            np.append(lower, none),
            np.append(upper, none + np.inf),
            np.full(rows, -np.inf),
            np.zeros(rows),
            p,
        )
        return _joined(own, self._stability.instance(roots, rates, len(points)))


def _joined(first: Instance, second: Instance) -> Instance:
    return Instance(*(np.concatenate([getattr(first, key), getattr(second, key)]) for key in Instance.__annotations__))


class HurwitzProgram(_MassProgram):
    """Least mass; stability by Lienard-Chipart conditions."""

    stability_type = _HurwitzConditions


class FactorProgram(_MassProgram):
    """Least mass; stability by factors."""

    stability_type = _StableFactors


class _ElasticProgram:
    """Least relaxation under which a design exists: strength and geometry rows and the margin may give way.

    The objective is the sum of the slacks: logarithmic ratios, lengths over 0.1 m, and the loss of margin over the margin
    (or 0.1 1/s if that is larger). Which of them may move is set at each instance. The variables after those of the design
    are the excess of the decay cuts (with a decay requirement), the slacks and the margin.

    Parameters
    ----------
    problem : DesignProblem
    slots : int
        Number of (speed, load) points it has room for.
    """

    stability_type: ClassVar[type]

    def __init__(self, problem: DesignProblem, slots: int):
        margin = ca.SX.sym("margin")
        self._common = common = _Slots(problem, slots, margin)
        self._stability = stability = self.stability_type(common)
        self._margin = required = problem.study.required.stability_margin
        names = relaxable(problem)
        slack, excess = ca.SX.sym("slack", len(names) - 1), common.excess
        prices = ca.DM([1.0] * slack.numel())
        prices[: len(problem.constraints)] = [1.0 if c.ratio else 10.0 for c in problem.constraints]
        rows = common.rows.numel()
        self._names = names
        self.nlp = {
            "x": ca.vertcat(common.x, excess, slack, margin, stability.variables),
            "p": ca.vertcat(common.p, stability.parameters),
            "f": ca.dot(prices, slack) + (required - margin) / max(required, 0.1) + EXCESS_PRICE * ca.sum1(excess),
            "g": ca.vertcat(
                common.rows - slack[:rows], common.decay_rows - ca.sum1(slack[rows:]) - ca.sum1(excess), stability.rows
            ),
        }

    def instance(
        self,
        design: Mapping[str, float],
        points: Points,
        cuts: Sequence[Cut] = (),
        peaks: Sequence[Cut] = (),
        radius: float = np.inf,
        **options: Any,
    ) -> Instance:
        """The program at `points`, started at `design`; the constraints named in the option `relaxed` may give way."""
        common, problem = self._common, self._common.problem
        may_move = np.array([name in options["relaxed"] for name in self._names])
        slack = np.zeros(len(self._names) - 1)
        slack[: len(problem.constraints)] = np.maximum(list(problem.rows(design).values()), 0.0)
        abscissa = float(problem.model.at(design).abscissa(*np.array(points).T).max())
        kept = min(self._margin, -abscissa - 2 * problem.study.solver.margin_reserve)
        start = np.where(may_move, np.append(slack + 1e-3, kept), np.append(np.zeros(slack.size), self._margin))
        p, roots, rates = common.numbers(design, points, cuts, peaks, margin=float(start[-1]))
        x0, lower, upper = common.box(design, radius)
        none, rows = np.zeros(common.excess.numel()), common.rows.numel() + common.decay_rows.numel()
        own = Instance(
            np.concatenate([x0, none, start]),
            np.concatenate([lower, none, np.zeros(slack.size), [-np.inf if may_move[-1] else self._margin]]),
            np.concatenate([upper, none + np.inf, np.where(may_move[:-1], np.inf, 0.0), [self._margin]]),
            np.full(rows, -np.inf),
            np.zeros(rows),
            p,
        )
        return _joined(own, self._stability.instance(roots, rates, len(points)))


class ElasticHurwitzProgram(_ElasticProgram):
    """Least relaxation; stability by Lienard-Chipart conditions."""

    stability_type = _HurwitzConditions


class ElasticFactorProgram(_ElasticProgram):
    """Least relaxation; stability by factors."""

    stability_type = _StableFactors

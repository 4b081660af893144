"""Nonlinear programs of a design problem: two ways to say "stable with the margin at these speeds and loads".

Both have slots, each a speed and a load given as parameters, so that one program serves every round of the exchange.

* `HurwitzProgram` imposes the Lienard-Chipart conditions of the shifted characteristic polynomial. It finds the best
  basin most often, but where two modes sit on the margin at once the last Hurwitz determinant, the product of their two
  dampings, has no gradient and the program no constraint qualification.
* `FactorProgram` lifts: the shifted polynomial equals a product of factors s^2 + b s + c and s + r with b, c, r >= 0.
  It is regular at such corners, but stops where a real root passes from one factor to another.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any, Protocol

import casadi as ca
import numpy as np

from .hurwitz import characteristic_polynomial, lienard_chipart
from .problem import DesignProblem

__all__ = ["ElasticProgram", "FactorProgram", "HurwitzProgram", "Instance", "Program"]


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
        x, p, f, g for `casadi.nlpsol`. x begins with the scaled variables, g with the strength and geometry rows, p with
        data, load limit, speeds and loads of the slots.
    """

    nlp: dict[str, ca.SX]

    def __init__(self, problem: DesignProblem, slots: int): ...

    def instance(self, design: Mapping[str, float], points: Sequence[tuple[float, float]]) -> Instance: ...


class _Slots:
    """What both programs share: variables, parameters, the rows of strength and geometry."""

    def __init__(self, problem: DesignProblem, slots: int, margin: ca.SX | None = None):
        self.problem, self.slots, self.order = problem, slots, len(problem.model.state_names)
        self.x = ca.SX.sym("x", len(problem.variables))
        physical = problem.physical(self.x)
        design, rod = physical[:-1], physical[-1]
        data, load_limit = ca.SX.sym("data", len(problem.data)), ca.SX.sym("load_limit")
        V, F_z, self.rate = (ca.SX.sym(name, slots) for name in ("V", "F_z", "rate"))
        self.mass, self.rows = problem.mass_and_rows(design, rod, data, load_limit)
        self.p = ca.vertcat(data, load_limit, V, F_z, self.rate)
        if margin is not None:
            data = ca.vertcat(data)  # a copy: the parameter keeps its place, the model sees the variable
            data[problem.data_names.index("requirements.stability_margin")] = margin
        identity = ca.SX.eye(self.order)
        self.polynomials = [
            characteristic_polynomial(
                problem.shifted_matrix(design, data, V[i], F_z[i]) / self.rate[i], identity, ca.trace, self.order
            )
            for i in range(slots)
        ]

    def numbers(self, design: Mapping[str, float], points: Sequence[tuple[float, float]]):
        """Common parameters, and per slot the shifted roots at `design` with the rate that scales them to about 1."""
        problem = self.problem
        filled = [*points, *[points[-1]] * (self.slots - len(points))]
        V, F_z = np.array(filled).T
        required = problem.study.required.stability_margin + problem.study.solver.margin_reserve
        roots = np.linalg.eigvals(problem.model.at(design).matrices(V, F_z)) + required
        rates = np.exp(np.log(np.abs(roots) + 1e-3).mean(axis=1))
        return np.concatenate([problem.data, [problem.load_limit], V, F_z, rates]), roots, rates


class HurwitzProgram:
    """Lienard-Chipart conditions at every slot.

    Parameters
    ----------
    problem : DesignProblem
    slots : int
        Number of (speed, load) points it has room for.
    """

    def __init__(self, problem: DesignProblem, slots: int):
        self._common = common = _Slots(problem, slots)
        weight = ca.SX.sym("weight", slots)
        self._stability = _hurwitz_rows(common, weight)
        self.nlp = {
            "x": common.x,
            "p": ca.vertcat(common.p, weight),
            "f": common.mass,
            "g": ca.vertcat(common.rows, self._stability),
        }

    def instance(self, design: Mapping[str, float], points: Sequence[tuple[float, float]]) -> Instance:
        """The program at `points`, started and scaled at `design`; slots without a point impose nothing."""
        common, problem = self._common, self._common.problem
        p, roots, rates = common.numbers(design, points)
        lower, upper = problem.bounds()
        limits = _limits(self.nlp["g"], self._stability, common.slots, len(points))
        x0 = np.clip(problem.scaled(design), lower, upper)
        return Instance(x0, lower, upper, np.full(len(limits), -np.inf), limits, np.concatenate([p, _weights(roots, rates)]))


def _hurwitz_rows(common: _Slots, weight: ca.SX) -> ca.SX:
    """Lienard-Chipart conditions of all slots as rows <= 0."""
    last = f"H{common.order - 1}"
    conditions = (lienard_chipart(a) for a in common.polynomials)
    return ca.vertcat(
        *(-value * (weight[i] if name == last else 1) for i, slot in enumerate(conditions) for name, value in slot.items())
    )


def _limits(g: ca.SX, stability: ca.SX, slots: int, used: int) -> np.ndarray:
    """Upper limits of the rows: 0, and none for the stability rows of unused slots."""
    limits = np.zeros(g.numel())
    limits[limits.size - (slots - used) * (stability.numel() // slots) :] = np.inf
    return limits


def _weights(roots: np.ndarray, rates: np.ndarray) -> list[float]:
    return [_damping_weight(r, rate) for r, rate in zip(roots, rates, strict=True)]


def _damping_weight(roots: np.ndarray, rate: float) -> float:
    """Weight of the last Hurwitz determinant, the product of -(s_i + s_j) over all pairs of roots: divided by the factors
    that are no conjugate pairs it is the product of -2 Re(s) over the oscillating modes, in 1/s, as a margin is."""
    i, j = np.triu_indices(len(roots), 1)
    sums = roots[i] + roots[j]
    conjugate = (np.abs(sums.imag) < 1e-9 * np.abs(roots[i])) & (np.abs(roots[i].imag) > 0)
    return float(rate ** conjugate.sum() / np.prod(np.abs(sums[~conjugate]) / rate + 1e-6))


class FactorProgram:
    """Shifted characteristic polynomial = product of stable factors, at every slot.

    Parameters
    ----------
    problem : DesignProblem
    slots : int
        Number of (speed, load) points it has room for.
    """

    def __init__(self, problem: DesignProblem, slots: int):
        self._common = common = _Slots(problem, slots)
        n = common.order
        lifted = ca.SX.sym("lifted", n, slots)  # per slot b [1/s], c/rate^2, ..., r/rate
        equalities = []
        for i, a in enumerate(common.polynomials):
            pairs = [[1, lifted[2 * k, i] / common.rate[i], lifted[2 * k + 1, i]] for k in range(n // 2)]
            single = [[1, lifted[n - 1, i]]] if n % 2 else []
            product = reduce(_multiply, pairs + single)
            equalities += [product[k] - a[k] for k in range(1, n + 1)]
        self.nlp = {
            "x": ca.vertcat(common.x, ca.vec(lifted)),
            "p": common.p,
            "f": common.mass,
            "g": ca.vertcat(common.rows, *equalities),
        }

    def instance(self, design: Mapping[str, float], points: Sequence[tuple[float, float]]) -> Instance:
        """The program at `points`, its factors started at the roots of `design`; slots without a point are free."""
        common, problem = self._common, self._common.problem
        p, roots, rates = common.numbers(design, points)
        lower, upper = problem.bounds()
        factors = np.concatenate([_factors(r, rate) for r, rate in zip(roots, rates, strict=True)])
        used = np.arange(factors.size) < len(points) * common.order
        equal = np.zeros(factors.size)
        return Instance(
            np.concatenate([np.clip(problem.scaled(design), lower, upper), factors]),
            np.concatenate([lower, np.where(used, 0.0, -np.inf)]),
            np.concatenate([upper, np.full(factors.size, np.inf)]),
            np.concatenate([np.full(common.rows.numel(), -np.inf), equal]),
            np.concatenate([np.zeros(common.rows.numel()), equal]),
            p,
        )


class ElasticProgram:
    """Least relaxation under which a design exists: strength and geometry rows and the margin may give way.

    The objective is the sum of the slacks: logarithmic ratios, lengths over 0.1 m, and the loss of margin over the margin
    (or 0.1 1/s if that is larger). Which of them may move is set at each instance.

    Parameters
    ----------
    problem : DesignProblem
    slots : int
        Number of (speed, load) points it has room for.
    """

    def __init__(self, problem: DesignProblem, slots: int):
        margin, weight = ca.SX.sym("margin"), ca.SX.sym("weight", slots)
        self._common = common = _Slots(problem, slots, margin)
        self._margin = problem.study.required.stability_margin
        slack = ca.SX.sym("slack", common.rows.numel())
        prices = ca.DM([1.0 if c.ratio else 10.0 for c in problem.constraints])
        self._stability = _hurwitz_rows(common, weight)
        self.nlp = {
            "x": ca.vertcat(common.x, slack, margin),
            "p": ca.vertcat(common.p, weight),
            "f": ca.dot(prices, slack) + (self._margin - margin) / max(self._margin, 0.1),
            "g": ca.vertcat(common.rows - slack, self._stability),
        }
        self.relaxable = (*problem.constraint_names, "stability_margin")

    def instance(
        self, design: Mapping[str, float], points: Sequence[tuple[float, float]], relaxed: Sequence[str] | None = None
    ) -> Instance:
        """The program at `points`, started at `design`; only the constraints named in `relaxed` may give way (None: all)."""
        common, problem = self._common, self._common.problem
        p, roots, rates = common.numbers(design, points)
        lower, upper = problem.bounds()
        may_move = np.array([relaxed is None or name in relaxed for name in self.relaxable])
        slack = np.maximum(list(problem.rows(design).values()), 0.0) + 1e-3
        abscissa = float(problem.model.at(design).abscissa(*np.array(points).T).max())
        reserve = problem.study.solver.margin_reserve
        start = np.append(slack, min(self._margin, -abscissa - 2 * reserve))
        start = np.where(may_move, start, np.append(np.zeros(slack.size), self._margin))
        limits = _limits(self.nlp["g"], self._stability, common.slots, len(points))
        return Instance(
            np.concatenate([np.clip(problem.scaled(design), lower, upper), start]),
            np.concatenate([lower, np.zeros(slack.size), [-np.inf if may_move[-1] else self._margin]]),
            np.concatenate([upper, np.where(may_move[:-1], np.inf, 0.0), [self._margin]]),
            np.full(len(limits), -np.inf),
            limits,
            np.concatenate([p, _weights(roots, rates)]),
        )


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

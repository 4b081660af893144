"""Two ways to say "every root of these polynomials lies left of the axis"; see `program` for what each is good at."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any, Protocol

import casadi as ca
import numpy as np

from ..stability.hurwitz import lienard_chipart
from .parameters import Limits

__all__ = ["ConditionNumbers", "Conditions", "HurwitzConditions", "Slots", "StableFactors"]

REAL = 1e-9
"""Imaginary part over magnitude below which a root is real, or a sum of two roots is."""

WEIGHT_FLOOR = 1e-6
"""Least sum of two roots over the rate that divides a weight, or the difference of the two."""


@dataclass(frozen=True)
class Slots:
    """Characteristic polynomials, shifted by the margin and divided by the rate of time, at every slot of a program.

    Attributes
    ----------
    polynomials : sequence of list
        [1, a_1, ..., a_n] of each slot, expressions.
    rate : casadi.SX
        (slots,) that scales time.
    """

    polynomials: Sequence[list[Any]]
    rate: ca.SX

    @property
    def order(self) -> int:
        """Degree of the polynomials."""
        return len(self.polynomials[0]) - 1

    def __len__(self) -> int:
        return len(self.polynomials)


@dataclass(frozen=True)
class ConditionNumbers:
    """Numbers of the conditions at one design: their variables, their rows and their parameters."""

    variables: Limits
    rows: Limits
    parameters: np.ndarray


class Conditions(Protocol):
    """Conditions as variables, parameters and rows of a program.

    Attributes
    ----------
    variables, parameters, rows : casadi.SX
        Columns; any of the first two may be empty.
    """

    variables: ca.SX
    parameters: ca.SX
    rows: ca.SX

    def __init__(self, slots: Slots): ...

    def numbers(self, roots: np.ndarray, rates: np.ndarray, used: int) -> ConditionNumbers: ...


class HurwitzConditions:
    """Lienard-Chipart conditions of all slots as rows <= 0; no variables of its own, one weight per slot.

    Parameters
    ----------
    slots : Slots
    """

    def __init__(self, slots: Slots):
        weight = ca.SX.sym("weight", len(slots))
        last = f"H{slots.order - 1}"
        unknown = ca.SX.sym("a", slots.order)
        values = lienard_chipart([1.0, *ca.vertsplit(unknown)])
        function = ca.Function("conditions", [unknown], [ca.vertcat(*values.values())])
        conditions = [dict(zip(values, ca.vertsplit(function(ca.vertcat(*a[1:]))), strict=True)) for a in slots.polynomials]
        self.variables, self.parameters = ca.SX(0, 1), weight
        self.rows = ca.vertcat(
            *(-value * (weight[i] if name == last else 1) for i, slot in enumerate(conditions) for name, value in slot.items())
        )
        self._per_slot = len(conditions[0])

    def numbers(self, roots: np.ndarray, rates: np.ndarray, used: int) -> ConditionNumbers:
        """Weights at the shifted roots (slots, n) of a design; the rows of the first `used` slots hold."""
        limits = np.zeros(self.rows.numel())
        limits[used * self._per_slot :] = np.inf
        weights = np.array([_damping_weight(r, rate) for r, rate in zip(roots, rates, strict=True)])
        nothing = np.zeros(0)
        return ConditionNumbers(Limits(nothing, nothing, nothing), Limits(-np.inf, limits), weights)


def _damping_weight(roots: np.ndarray, rate: float) -> float:
    """Weight of the last Hurwitz determinant, the product of -(s_i + s_j) over all pairs of roots: divided by the factors
    that are no conjugate pairs it is the product of -2 Re(s) over the oscillating modes, in 1/s, as a margin is."""
    i, j = np.triu_indices(len(roots), 1)
    sums = roots[i] + roots[j]
    conjugate = (np.abs(sums.imag) < REAL * np.abs(roots[i])) & (np.abs(roots[i].imag) > 0)
    return float(rate ** conjugate.sum() / np.prod(np.abs(sums[~conjugate]) / rate + WEIGHT_FLOOR))


class StableFactors:
    """Shifted polynomial = product of factors with variables b [1/s], c/rate^2, ..., r/rate >= 0 at every slot.

    Parameters
    ----------
    slots : Slots
    """

    def __init__(self, slots: Slots):
        n = slots.order
        lifted = ca.SX.sym("lifted", n, len(slots))
        equalities = []
        for i, a in enumerate(slots.polynomials):
            pairs = [[1, lifted[2 * k, i] / slots.rate[i], lifted[2 * k + 1, i]] for k in range(n // 2)]
            single = [[1, lifted[n - 1, i]]] if n % 2 else []
            product = reduce(_multiply, pairs + single)
            equalities += [product[k] - a[k] for k in range(1, n + 1)]
        self.variables, self.parameters = ca.vec(lifted), ca.SX(0, 1)
        self.rows = ca.vertcat(*equalities)
        self._per_slot = n

    def numbers(self, roots: np.ndarray, rates: np.ndarray, used: int) -> ConditionNumbers:
        """Factors of the shifted roots (slots, n) of a design; those of the first `used` slots may not be negative."""
        factors = np.concatenate([_factors(r, rate) for r, rate in zip(roots, rates, strict=True)])
        lower = np.where(np.arange(factors.size) < used * self._per_slot, 0.0, -np.inf)
        return ConditionNumbers(Limits(lower, np.inf, factors), Limits(0.0, 0.0), np.zeros(0))


def _multiply(p: list[Any], q: list[Any]) -> list[Any]:
    product: list[Any] = [0] * (len(p) + len(q) - 1)
    for i, p_i in enumerate(p):
        for j, q_j in enumerate(q):
            product[i + j] = product[i + j] + p_i * q_j
    return product


def _factors(roots: np.ndarray, rate: float) -> list[float]:
    """[b, c/rate^2, ..., r/rate] of real factors: conjugate pairs, then real roots by two; r is the one left over.

    Real roots that are about to meet and part as a conjugate pair must have one factor, or there is no way on from there.
    """
    real = np.abs(roots.imag) <= REAL * (1 + np.abs(roots))
    pairs = [(-2 * s.real, abs(s) ** 2) for s in roots[~real] if s.imag > 0]
    single = np.sort(roots[real].real)
    while single.size > 1:
        near = int(np.argmin(np.diff(single) / (np.abs(single[:-1] + single[1:]) + WEIGHT_FLOOR * rate)))
        s, t = single[near : near + 2]
        pairs.append((-(s + t), s * t))
        single = np.delete(single, [near, near + 1])
    ordered = sorted(pairs, key=lambda pair: pair[1])
    return [number for b, c in ordered for number in (b, c / rate**2)] + [-s / rate for s in single]

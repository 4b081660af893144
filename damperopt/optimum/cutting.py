"""Affine bounds of a few rounds on many boxes, and the linear programs that they make: multipliers, bounds and solutions."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import block_diag, csr_matrix

from .affine import Affine

__all__ = ["Cuts", "tame"]

STEEP = 300.0
"""Value or slope of a logarithm beyond which a bound is not used."""

SHORT = 50.0
"""ln(mass) for a unit of violation: above multipliers of requirements that a design can meet."""

LEAST = 1e-9
"""Multiplier that is left out."""


def tame(row: Affine) -> Affine:
    """Without the boxes on which it says next to nothing, in numbers that would upset a linear program."""
    kept = (np.abs(row.value) < STEEP) & (np.abs(row.slope) < STEEP).all(axis=1)
    return Affine(np.where(kept, row.value, -1.0), np.where(kept[:, None], row.slope, 0.0))


class Cuts:
    """Affine bounds of several rounds on boxes (m, n), and the linear programs of all boxes as one."""

    def __init__(self, low: np.ndarray, high: np.ndarray):
        self._low, self._high = low, high
        self._names: list[tuple[int, str]] = []
        self._references: list[np.ndarray] = []
        self._slopes: list[np.ndarray] = []
        self._values: list[np.ndarray] = []
        self._duals = np.zeros((len(low), 0))

    def add(self, rows: Mapping[str, Any], reference: np.ndarray) -> None:
        for name, row in rows.items():
            self._names.append((len(self._references), name))
            self._slopes.append(row.slope)
            self._values.append(row.value - (row.slope * reference).sum(axis=1))
        self._references.append(reference.copy())

    def solve(self) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]:
        """Solutions (m, n), bounds of ln(mass) (m,), and multipliers (m,) of each row, those of all rounds together."""
        (m, n), count = self._low.shape, len(self._names)
        slopes, values = np.array(self._slopes).transpose(1, 0, 2), np.array(self._values).T
        A = np.zeros((m, count, n + 2))
        A[:, :, :n] = slopes
        is_mass = np.array([name == "mass" for _, name in self._names])
        A[:, is_mass, n], A[:, ~is_mass, n + 1] = -1.0, -1.0
        bounds = np.empty((m, n + 2, 2))
        bounds[:, :n, 0], bounds[:, :n, 1] = self._low, self._high
        bounds[:, n], bounds[:, n + 1] = (-1e6, 1e6), (0.0, np.inf)
        cost = np.tile([*[0.0] * n, 1.0, SHORT], m)
        matrix = block_diag([csr_matrix(a) for a in A], format="csr")
        found = linprog(cost, A_ub=matrix, b_ub=-values.ravel(), bounds=bounds.reshape(-1, 2), method="highs")
        if found.x is None:
            duals, solution = np.zeros((m, count)), (self._low + self._high) / 2
            duals[:, 0] = 1.0
        else:
            duals = np.maximum(-found.ineqlin.marginals.reshape(m, count), 0.0)
            solution = found.x.reshape(m, n + 2)[:, :n]
        duals = np.where(duals > LEAST, duals, 0.0)
        duals[(duals * is_mass).sum(axis=1) < 0.5, 0] = 1.0  # not solved: the first bound of the mass alone
        self._duals = duals / (duals * is_mass).sum(axis=1)[:, None]
        slope = (self._duals[..., None] * slopes).sum(axis=1)
        bound = (self._duals * values).sum(axis=1) + np.where(slope > 0, slope * self._low, slope * self._high).sum(axis=1)
        gathered = {name: np.zeros(m) for _, name in self._names}
        for j, (_, name) in enumerate(self._names):
            gathered[name] += self._duals[:, j]
        return solution, bound, gathered

    def terms(self, i: int) -> list[tuple[np.ndarray, dict[str, float]]]:
        """Reference points of a box, each with the multipliers of the bounds that were taken there."""
        found: list[tuple[np.ndarray, dict[str, float]]] = []
        for r, reference in enumerate(self._references):
            used = {n: float(self._duals[i, j]) for j, (k, n) in enumerate(self._names) if k == r and self._duals[i, j] > 0}
            if used:
                found.append((reference[i].copy(), used))
        return found

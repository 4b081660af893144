"""Differential evolution against an optimum: mass and rows by the plain functions, roots of the gear by numbers of its own."""

from __future__ import annotations

from typing import Any

import numpy as np
from frame import tube_area
from own_gear import chain_by_hand, damper_stiffness, least_of, state_matrices
from own_studies import FORMS, MARGIN, RATIO, plain_numbers, speeds
from scipy.optimize import differential_evolution

SIZES = ("A_link", "I_link", "A_support", "I_support", "A_piston", "s_damper")
"""That strength asks for; each is searched as a multiple of the least."""

ROWS = {"A_link": "link", "I_link": "link", "A_support": "support", "I_support": "support"}

ASK = 50.0
"""Penalty on a violation [kg per unit]: far above the price of any row of these studies."""


class Attack:
    """The problem as penalised mass over the unit cube, for many designs at once."""

    def __init__(self, problem: Any, topology: str):
        self.problem, self.topology = problem, topology
        self.names = problem.design_names
        self.own = [name for name in self.names if name not in (*SIZES, "rod_diameter")]
        self.sizes = [name for name in self.names if name in SIZES]
        bounds = {v.name: (np.log(v.lower), np.log(v.upper)) for v in problem.variables}
        self.bounds = [bounds[name] for name in self.own] + [(0.0, 2.0)] * len(self.sizes)
        self.gear, self.speeds = plain_numbers(topology), speeds(topology, 24)

    def designs(self, x: np.ndarray) -> np.ndarray:
        """(m, n) of logarithms (m, k): sizes are the least ones, found by repetition, times their factors."""
        d = {name: np.exp(x[:, i]) for i, name in enumerate(self.own)}
        for name in self.sizes:
            d[name] = np.full(len(x), self.problem.study.start[name])
        d["rod_diameter"] = np.full(len(x), self.problem.study.start["rod_diameter"])
        factors = {name: np.exp(x[:, len(self.own) + i]) for i, name in enumerate(self.sizes)}
        for _ in range(6):
            rows = dict(zip(self.problem.constraint_names, self.problem.over_designs(self._stacked(d))["rows"].T, strict=True))
            for name in (*self.sizes, "rod_diameter"):
                asked = [row for key, row in rows.items() if self._is_of(key, name)]
                d[name] = d[name] * np.exp(np.max(asked, axis=0)) * factors.get(name, 1.0)
        return self._stacked(d)

    def _is_of(self, row: str, size: str) -> bool:
        exact = {"A_piston": "piston_pressure", "s_damper": "damper_stroke"}
        if size == "rod_diameter":
            return row.startswith("rod_")
        return row == exact[size] if size in exact else row.startswith(f"{ROWS[size]}_")

    def _stacked(self, d: dict[str, np.ndarray]) -> np.ndarray:
        return np.stack([d[name] for name in self.names], axis=1)

    def violation(self, designs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mass and the sum of what is violated."""
        found = self.problem.over_designs(designs)
        d = dict(zip(self.names, designs.T, strict=True))
        study = self.problem.study
        area = tube_area(d["I_arm"]) if "I_arm" in d else None
        chain = chain_by_hand(self.topology, d, study.material.youngs_modulus, FORMS[self.topology], area)
        matrices = state_matrices(self.speeds, self.gear, chain, d["c_lambda"], damper_stiffness(d))
        abscissa, ratio = least_of(matrices)
        over = (
            np.maximum(found["rows"], 0).sum(axis=1) + np.maximum(abscissa + MARGIN, 0) / 10 + np.maximum(RATIO - ratio, 0) * 10
        )
        return found["mass"], over

    def __call__(self, x: np.ndarray) -> np.ndarray:
        with np.errstate(all="ignore"):
            mass, over = self.violation(self.designs(x.T))
        value = mass + ASK * over
        return np.where(np.isfinite(value), value, 1e9)


def attacked(attack: Attack, generations: int, seed: int, population: int = 10) -> tuple[float, np.ndarray]:
    """Least penalised mass and its design."""
    found = differential_evolution(
        attack,
        attack.bounds,
        vectorized=True,
        updating="deferred",
        polish=False,
        rng=seed,
        maxiter=generations,
        popsize=population,
        tol=1e-10,
    )
    return float(found.fun), attack.designs(found.x[None, :])[0]

"""Promising starts: the lightest layout at each torsional stiffness, with the least damping that is enough there.

The damper enters the linear gear through (k_psi, c_psi) alone, and at a given k_psi less damping is never heavier. So
along the lower border of the stable region the design problem has one dimension left, and its local minima there are
near those of the whole problem, however thin the pocket of the stable region that they lie in.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from scipy.stats import qmc

from .problem import DesignProblem
from .solve import raise_if_interrupted

__all__ = ["ScanPoint", "promising_designs", "sobol_designs", "steady_designs", "stiffness_scan"]

SAMPLE = 1024
"""Sobol designs that show which stiffnesses and dampings the bounds allow; a power of two."""

STIFFNESSES, DAMPINGS = 64, 96
"""Grid of the scan."""

STRIDE = 4
"""Every so many stiffnesses are looked at first, the others beside those that strength and geometry allow."""


@dataclass(frozen=True)
class ScanPoint:
    """Lightest layout with this stiffness [N m/rad] and at least this damping [N m s/rad]; mass [kg]."""

    k_psi: float
    c_psi: float
    mass: float
    design: dict[str, float]


def sobol_designs(problem: DesignProblem, count: int) -> np.ndarray:
    """Scrambled Sobol points within the bounds of the free variables, scaled as the solver scales them.

    Parameters
    ----------
    problem : DesignProblem
    count : int

    Returns
    -------
    ndarray
        (count, n) design variables [SI]; the first ones do not depend on `count`.
    """
    variables = problem.variables[: len(problem.design_names)]
    free = [i for i, v in enumerate(variables) if v.lower < v.upper]
    designs = np.tile([v.start for v in variables], (count, 1))
    if not free or not count:
        return designs
    sobol = qmc.Sobol(len(free), rng=problem.study.solver.seed)
    unit = sobol.random_base2(max(count - 1, 1).bit_length())[:count]
    for column, i in zip(unit.T, free, strict=True):
        low, high = variables[i].scale(variables[i].lower), variables[i].scale(variables[i].upper)
        designs[:, i] = [variables[i].unscale(low + u * (high - low)) for u in column]
    return designs


def stiffness_scan(problem: DesignProblem) -> list[ScanPoint]:
    """Lightest stable layouts over the torsional stiffness.

    Parameters
    ----------
    problem : DesignProblem

    Returns
    -------
    list of ScanPoint
        Ascending in stiffness; stiffnesses where nothing is stable or no layout meets strength and geometry are left out.
    """
    k, c, start = _reachable(problem)
    K, C = np.meshgrid(k, c, indexing="ij")
    stable = problem.screening.least_conditions(K.ravel(), C.ravel()) > 0
    decay = problem.study.required.decay
    if decay is not None:
        stable[stable] = problem.screening.linear_decay(K.ravel()[stable], C.ravel()[stable]) <= decay.ratio
    stable = stable.reshape(K.shape)
    layouts, rows = _Layouts(problem, start), np.flatnonzero(stable.any(axis=1))
    found: dict[int, ScanPoint] = {}

    def look(places: Iterable[int]) -> None:
        for i in places:
            point = layouts.lightest(k[rows[i]], c[int(stable[rows[i]].argmax())])
            if point is not None:
                found[i] = point

    look(range(0, rows.size, STRIDE))
    near = {i for place in found for i in range(place - STRIDE + 1, place + STRIDE)} if found else {*range(rows.size)}
    look(sorted(i for i in near - {*range(0, rows.size, STRIDE)} if 0 <= i < rows.size))
    return [found[i] for i in sorted(found)]


def steady_designs(problem: DesignProblem, count: int) -> list[dict[str, float]]:
    """Layouts that are as stable as strength and geometry allow, whatever their mass: starts where the margin is the issue.

    Parameters
    ----------
    problem : DesignProblem
    count : int

    Returns
    -------
    list of dict
        At most `count` designs, the steadiest first, each in another stiffness of the grid.
    """
    if not problem.has_one_damping:
        return []
    k, c, start = _reachable(problem)
    K, C = np.meshgrid(k, c, indexing="ij")
    abscissa = problem.screening.worst_abscissae(K.ravel(), C.ravel()).reshape(K.shape)
    layouts, designs = _Layouts(problem, start), []
    for i in np.argsort(abscissa.min(axis=1)):
        point = layouts.lightest(k[i], c[int(abscissa[i].argmin())])
        if point is not None:
            designs.append(point.design)
        if len(designs) == count:
            break
    return designs


def _reachable(problem: DesignProblem) -> tuple[np.ndarray, np.ndarray, dict[str, float]]:
    """Stiffnesses and dampings that designs near strength and geometry have, and the nearest of these designs."""
    designs = sobol_designs(problem, SAMPLE)
    found = problem.over_designs(designs)
    nearly = np.argsort(np.maximum(found["rows"], 0).sum(axis=1))[: SAMPLE // 4]
    k_psi, c_psi = found["torsional_stiffness"][nearly], found["torsional_damping"]
    return (
        np.geomspace(k_psi.min(), k_psi.max(), STIFFNESSES),
        np.geomspace(c_psi.min(), c_psi.max(), DAMPINGS),
        dict(zip(problem.design_names, designs[nearly[0]].tolist(), strict=True)),
    )


class _Layouts:
    """Lightest layouts of given stiffness and damping, stability left aside; each search starts at the last answer."""

    def __init__(self, problem: DesignProblem, start: dict[str, float]):
        x = ca.SX.sym("x", len(problem.variables))
        physical, n = problem.physical(x), len(problem.design_names)
        data, load = ca.SX.sym("data", len(problem.data)), ca.SX.sym("load_limit")
        log_k, log_c = ca.SX.sym("log_k"), ca.SX.sym("log_c")
        mass, rows = problem.mass_and_rows(physical[:n], physical[n:], data, load)
        k_psi, c_psi = problem.stiffness_and_damping(physical[:n], data)
        nlp = {
            "x": x,
            "p": ca.vertcat(data, load, log_k, log_c),
            "f": mass,
            "g": ca.vertcat(rows, log_c - ca.log(c_psi), ca.log(k_psi) - log_k),
        }
        options: dict[str, Any] = {"print_time": False, "show_eval_warnings": False, "ipopt.print_level": 0, "ipopt.sb": "yes"}
        options |= {"ipopt.max_iter": 60, "ipopt.tol": 1e-5}
        self._problem = problem
        self._solver = ca.nlpsol("layout", "ipopt", nlp, options)
        self._x = problem.scaled(start)
        self._ubg = np.zeros(len(problem.constraints) + 2)
        self._lbg = np.append(np.full(self._ubg.size - 1, -np.inf), 0.0)

    def lightest(self, k_psi: float, c_psi: float) -> ScanPoint | None:
        """Lightest layout with this stiffness and at least this damping; None if IPOPT finds none."""
        lower, upper = self._problem.bounds()
        p = np.concatenate([self._problem.data, [self._problem.load_limit, np.log(k_psi), np.log(c_psi)]])
        x0 = np.clip(self._x, lower, upper)
        result = self._solver(x0=x0, p=p, lbx=lower, ubx=upper, lbg=self._lbg, ubg=self._ubg)
        raise_if_interrupted(self._solver.stats())
        if not self._solver.stats()["success"]:
            return None
        self._x = result["x"].full().ravel()
        return ScanPoint(float(k_psi), float(c_psi), float(result["f"]), self._problem.unscaled(self._x.tolist()))


def promising_designs(problem: DesignProblem, count: int) -> list[dict[str, float]]:
    """At most `count` designs at the local minima of the scan, the lightest first."""
    if not problem.has_one_damping:
        return []
    points = stiffness_scan(problem)
    mass = np.array([np.inf, *(point.mass for point in points), np.inf])
    minima = [p for p, before, here, after in zip(points, mass, mass[1:], mass[2:], strict=False) if before >= here <= after]
    return [point.design for point in sorted(minima, key=lambda point: point.mass)[:count]]

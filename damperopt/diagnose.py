"""Why no design exists: what is missing by how much, and which single requirement would make room if it gave way."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .exchange import MAX_ROUNDS, first_points
from .program import ElasticProgram
from .results import Infeasibility, Relaxation
from .solve import NlpSolver
from .stability import worst_points

__all__ = ["Diagnosis", "diagnose"]

_STABILITY = "stability_margin"


@dataclass(frozen=True)
class Diagnosis:
    """Outcome of `diagnose`: a design that needs no relaxation after all, or the reasons why there is none."""

    feasible_design: dict[str, float] | None
    infeasibility: Infeasibility | None


@dataclass(frozen=True)
class _Elastic:
    price: float
    design: dict[str, float]
    slacks: dict[str, float]
    speed: float
    load: float


def diagnose(solver: NlpSolver, starts: Sequence[Mapping[str, float]]) -> Diagnosis:
    """Least relaxation of a study for which no start has led to a design.

    Parameters
    ----------
    solver : NlpSolver
    starts : sequence of mapping
        Designs to start from; the best outcome counts.

    Returns
    -------
    Diagnosis
        With neither a design nor reasons if the elastic program failed from every start.
    """
    least = _least(solver, starts, None)
    if least is None:
        return Diagnosis(None, None)
    if max(least.slacks.values()) < 1e-7:
        return Diagnosis(least.design, None)
    short = [name for name, slack in least.slacks.items() if slack > 1e-6]
    alone = []
    for name in least.slacks:
        found = _least(solver, [least.design, *starts[:2]], [name])
        if found is not None:
            alone.append(_relaxation(solver, found, name))
    shortfalls = tuple(_relaxation(solver, least, name) for name in short)
    return Diagnosis(None, Infeasibility(shortfalls=shortfalls, alone_enough=tuple(alone)))


def _least(solver: NlpSolver, starts: Sequence[Mapping[str, float]], relaxed: list[str] | None) -> _Elastic | None:
    found = [elastic for elastic in (_elastic(solver, start, relaxed) for start in starts) if elastic is not None]
    return min(found, key=lambda elastic: elastic.price, default=None)


def _elastic(solver: NlpSolver, start: Mapping[str, float], relaxed: list[str] | None) -> _Elastic | None:
    """Local solution of the elastic program, exchanged over the envelope."""
    problem = solver.problem
    study, required = problem.study, problem.study.required.stability_margin
    points, design = first_points(solver), dict(start)
    for _ in range(MAX_ROUNDS):
        solution = solver.solve(design, points, ElasticProgram, relaxed=relaxed)
        if not solution.converged:
            return None
        *slack, margin = solution.extra
        worst = worst_points(problem.model.at(solution.design), study.envelope)
        violating = [p for p in worst if p.abscissa > -margin - study.solver.margin_reserve / 2]
        if not violating or any((violating[0].speed, violating[0].load) == point for point in points):
            slacks = dict(zip(problem.constraint_names, map(float, slack), strict=True))
            slacks[_STABILITY] = float(required - margin)
            return _Elastic(solution.objective, solution.design, slacks, worst[0].speed, worst[0].load)
        points += [(p.speed, p.load) for p in violating]
        design = solution.design
    return None


def _relaxation(solver: NlpSolver, elastic: _Elastic, name: str) -> Relaxation:
    problem, slack = solver.problem, elastic.slacks[name]
    if name == _STABILITY:
        required = problem.study.required.stability_margin
        return Relaxation(
            name=name,
            limit=required,
            needed=required - slack,
            unit="1/s",
            inputs=("requirements.stability_margin", "envelope.speed", "envelope.vertical_load"),
            speed=elastic.speed,
            load=elastic.load,
        )
    constraint = problem.constraints[problem.constraint_names.index(name)]
    _, limit = problem.values(elastic.design)[name]
    sign = -1 if constraint.at_least else 1
    needed = limit * float(np.exp(sign * slack)) if constraint.ratio else limit + sign * slack
    return Relaxation(name=name, limit=limit, needed=needed, unit=constraint.unit, inputs=constraint.relaxed_by)

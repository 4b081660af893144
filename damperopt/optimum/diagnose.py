"""Why no design exists: what is missing by how much, and which single requirement would make room if it gave way."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from ..results import Infeasibility, OperatingPoint, Relaxation
from .decay_exchange import solve_with_decay
from .exchange import first_points
from .local import best_local
from .problem import DesignProblem
from .program import ElasticFactorProgram, ElasticHurwitzProgram, Program, price
from .scan import steady_designs
from .solve import NlpSolver

__all__ = ["Diagnosis", "diagnose"]

_STABILITY = "stability_margin"

STEADY = 2
"""Layouts of the steadiest kind to start from."""

ENOUGH = 1e-6
"""Slack (logarithmic, in m, or in 1/s) that counts as none."""

ROUNDS = 8

HOLDS_BACK = 1e-3
"""Multiplier above which a constraint stands in the way of a lower decay ratio (the unit being `program.EXCESS_PRICE`)."""


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


def diagnose(solver: NlpSolver, starts: Sequence[Mapping[str, float]], among: Sequence[str] = ()) -> Diagnosis:
    """Least relaxation of a study for which no start has led to a design.

    Parameters
    ----------
    solver : NlpSolver
    starts : sequence of mapping
        Designs to start from, beside the steadiest layouts; the best outcome counts.
    among : sequence of str
        Constraints that may give way; none: all, and each that would be enough on its own is looked for too.

    Returns
    -------
    Diagnosis

    Notes
    -----
    Every relaxation that is reported belongs to a design whose rows and worst abscissa were evaluated, whether or not IPOPT
    converged to it: it is enough. That no smaller one exists is not proved.
    """
    if solver.problem.study.required.decay is not None:
        rest = NlpSolver(DesignProblem(solver.problem.study.replace(**_without_decay(solver.problem))))
        found = diagnose(rest, starts, among)
        if found.feasible_design is None:
            return found
        return _decay_out_of_reach(solver, [found.feasible_design, *steady_designs(solver.problem, STEADY)])
    starts = [*steady_designs(solver.problem, STEADY), *starts]
    everything = (*solver.problem.constraint_names, _STABILITY)
    least = _least(solver, starts, tuple(among) or everything)
    if least is None:
        return Diagnosis(None, None)
    if max(least.slacks.values()) < ENOUGH:
        return Diagnosis(least.design, None)
    each = {name: _least(solver, [least.design, *starts[:1]], (name,)) for name in everything if not among}
    enough = {name: elastic for name, elastic in each.items() if elastic is not None}
    # the elastic program has local optima: one relaxation alone may turn out cheaper than what it found for all
    least = min([least, *enough.values()], key=lambda elastic: elastic.price)
    short = [name for name, slack in least.slacks.items() if slack > ENOUGH]
    return Diagnosis(
        None,
        Infeasibility(
            shortfalls=tuple(_relaxation(solver, least, name) for name in short),
            alone_enough=tuple(_relaxation(solver, elastic, name) for name, elastic in enough.items()),
        ),
    )


def _without_decay(problem: DesignProblem) -> dict[str, Any]:
    """Changes that take the decay requirement away, and the simulated limit event with it: its torque stands in for it then."""
    if problem.study.required.limit_event != "simulated":
        return {"requirements__decay": None}
    start = ca.SX([problem.study.start[name] for name in problem.design_names])
    torque = float(problem.estimated_peaks(start, ca.SX(problem.data), ca.SX(problem.load_limit))[0])
    required = problem.study.required.model_copy(update={"decay": None, "limit_event": "torque", "limit_torque": torque})
    return {"requirements": required.model_dump()}


def _decay_out_of_reach(solver: NlpSolver, starts: Sequence[Mapping[str, float]]) -> Diagnosis:
    """Least decay ratio of all designs that meet the other requirements, and which of these would make room."""
    problem, points = solver.problem, first_points(solver)
    reached = [best_local(solver, start, points) for start in starts]
    for found in reached:
        if found.solved:
            return Diagnosis(found.solution.design, None)
    reached = [found for found in reached if found.decay]
    if not reached:
        return Diagnosis(None, None)
    best = min(reached, key=lambda found: found.decay[0].ratio)
    at_bounds = np.abs(best.solution.multipliers.bounds[: len(problem.design_names)]) > HOLDS_BACK
    bounds = tuple(f"design.{v.name}" for v, at in zip(problem.variables, at_bounds, strict=False) if at)
    required, worst = problem.study.required.decay, best.decay[0]
    assert required is not None
    ratio = Relaxation(
        name="decay_ratio",
        limit=required.ratio,
        needed=worst.ratio,
        unit="1",
        inputs=("requirements.decay.ratio", "requirements.decay.cycles", *bounds),
        speed=worst.speed,
        load=worst.load,
    )
    alone = [ratio]
    for constraint, multiplier in zip(problem.constraints, best.solution.multipliers.rows, strict=True):
        if multiplier <= HOLDS_BACK:
            continue
        form, name = ElasticHurwitzProgram, constraint.name
        relaxed = solve_with_decay(solver, best.solution.design, best.solution.points, form, relaxed=(name,))
        rows = problem.rows(relaxed.solution.design, solver.simulated_factors(relaxed.solution.design))
        if relaxed.solved and all(row <= ENOUGH for other, row in rows.items() if other != name):
            outcome = _outcome(solver, relaxed.solution.design, relaxed.worst[0])
            alone.append(_relaxation(solver, outcome, name))
    return Diagnosis(None, Infeasibility(shortfalls=(ratio,), alone_enough=tuple(alone)))


def _least(solver: NlpSolver, starts: Sequence[Mapping[str, float]], relaxed: Sequence[str]) -> _Elastic | None:
    """Cheapest outcome over the starts and both programs; a second program runs only where the first fails."""
    found: list[_Elastic] = []
    for start in starts:
        for form in (ElasticHurwitzProgram, ElasticFactorProgram):
            outcomes, converged = _elastic(solver, start, relaxed, form)
            found += outcomes
            if converged:
                break
    return min(found, key=lambda elastic: elastic.price, default=None)


def _elastic(
    solver: NlpSolver, start: Mapping[str, float], relaxed: Sequence[str], form: type[Program]
) -> tuple[list[_Elastic], bool]:
    """Designs on the way of the elastic program that need no other relaxation, and whether it converged."""
    problem = solver.problem
    points, design = first_points(solver), dict(start)
    outcomes = []
    for _ in range(ROUNDS):
        solution = solver.solve(design, points, form, relaxed=relaxed)
        design = solution.design
        worst = problem.worst_points(design)
        outcome = _outcome(solver, design, worst[0])
        if all(slack <= ENOUGH or name in relaxed for name, slack in outcome.slacks.items()):
            outcomes.append(outcome)
        if not solution.converged:
            return outcomes, False
        assert solution.margin is not None
        allowed = -solution.margin - problem.study.solver.margin_reserve / 2
        violating = [p for p in worst if p.abscissa > allowed]
        if not violating or any(violating[0].place == point for point in points):
            return outcomes, True
        points += [p.place for p in violating]
    return outcomes, False


def _outcome(solver: NlpSolver, design: dict[str, float], worst: OperatingPoint) -> _Elastic:
    """What a design would need to be relaxed, and at what price (that of the elastic program)."""
    problem = solver.problem
    required = problem.study.required.stability_margin
    rows = problem.rows(design, solver.simulated_factors(design))
    slacks, lost = {name: max(row, 0.0) for name, row in rows.items()}, max(required + worst.abscissa, 0.0)
    cost = price(problem, slacks, lost)
    slacks[_STABILITY] = lost
    return _Elastic(cost, design, slacks, worst.speed, worst.load)


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
    _, limit = problem.values(elastic.design, solver.simulated_factors(elastic.design))[name]
    sign = -1 if constraint.at_least else 1
    needed = limit * float(np.exp(sign * slack)) if constraint.ratio else limit + sign * slack
    return Relaxation(name=name, limit=limit, needed=needed, unit=constraint.unit, inputs=constraint.relaxed_by)

"""A continuous envelope with few points: solve, find the worst speed and load, add it, repeat until none violates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..motion.decay import DecayPoint
from ..results import OperatingPoint
from ..study.study import Study
from .damping_exchange import DampingPoint
from .program import HurwitzProgram, Program
from .rational import STILL_CORRECTION
from .solve import LocalSolution, NlpSolver

__all__ = ["EnvelopeSolution", "allowed_abscissa", "first_points", "missed_points", "solve_envelope"]

MAX_ROUNDS = 30

SAME_POINT = 1e-9
"""Relative difference of speeds and of loads up to which two points are one."""


@dataclass(frozen=True)
class EnvelopeSolution:
    """A local optimum over the whole envelope.

    Attributes
    ----------
    solution : LocalSolution
        Of the last round.
    worst : tuple of OperatingPoint
        Local maxima of the spectral abscissa of its design, the worst first; empty if the last round failed.
    decay : tuple of DecayPoint
        Local maxima of its decay ratio over the speed, the worst first; empty where none is required.
    damping : tuple of DampingPoint
        Dips of the damping ratio of the yaw mode, the least first; empty where none is required.
    rounds : int
    solved : bool
        True when no point of the envelope violates the margin.
    """

    solution: LocalSolution
    worst: tuple[OperatingPoint, ...]
    rounds: int
    solved: bool
    decay: tuple[DecayPoint, ...] = ()
    damping: tuple[DampingPoint, ...] = ()


def first_points(solver: NlpSolver) -> list[tuple[float, ...]]:
    """Both ends and the geometric middle of the speed range, at every load (or both ends of a load range) and damping's end.

    With an actuator, at each of them with and without it.
    """
    envelope = solver.problem.study.envelope
    low, high = envelope.speed.min, envelope.speed.max
    factors = dict.fromkeys(solver.problem.study.damper.damping_factors())
    if solver.problem.fail_safe is not None:
        factors |= dict.fromkeys(-factor for factor in factors)
    return [(V, F, c) for c in factors for F in envelope.loads for V in dict.fromkeys((low, (low * high) ** 0.5, high))]


def solve_envelope(
    solver: NlpSolver,
    start: Mapping[str, float],
    points: Sequence[tuple[float, ...]],
    form: type[Program] = HurwitzProgram,
) -> EnvelopeSolution:
    """Local optimum from `start`, exchanged until the margin holds at every speed and load.

    Parameters
    ----------
    solver : NlpSolver
    start : mapping
        Design variables by name [SI].
    points : sequence of (speed, load, damping factor)
        Where stability is imposed in the first round.
    form : type
        `HurwitzProgram` or `FactorProgram`.

    Returns
    -------
    EnvelopeSolution
    """
    study = solver.problem.study
    allowed = allowed_abscissa(study)
    points, design, worst, before = list(points), dict(start), [], np.inf
    exact = solver.problem.search_model is solver.problem.model
    for rounds in range(1, MAX_ROUNDS + 1):
        solution = solver.solve(design, points, form)
        if not solution.converged:
            return EnvelopeSolution(solution, (), rounds, False)
        worst = solver.problem.worst_points(solution.design, allowed)
        still = exact or abs(solution.objective - before) <= STILL_CORRECTION * solution.objective
        before = solution.objective
        if worst[0].abscissa <= allowed and still:
            return EnvelopeSolution(solution, tuple(worst), rounds, True)
        new = missed_points(worst, allowed, points)
        if not new and still:  # the program holds the point already and cannot meet it more exactly
            break
        points += new
        design = solution.design
    return EnvelopeSolution(solution, tuple(worst), rounds, False)


def allowed_abscissa(study: Study) -> float:
    """Spectral abscissa [1/s] that an optimum may have: half of the reserve is for what the program cannot meet exactly."""
    return -study.required.stability_margin - study.solver.margin_reserve / 2


def missed_points(
    worst: Sequence[OperatingPoint], allowed: float, points: Sequence[tuple[float, ...]]
) -> list[tuple[float, ...]]:
    """Speeds, loads and damping factors above an abscissa that are not among the points yet."""
    return [p.place for p in worst if p.abscissa > allowed and not any(_close(p, q) for q in points)]


def _close(point: OperatingPoint, used: tuple[float, ...]) -> bool:
    return all(abs(own - other) <= SAME_POINT * abs(other) for own, other in zip(point.place, (*used, 1.0), strict=False))

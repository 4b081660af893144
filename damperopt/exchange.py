"""A continuous envelope with few points: solve, find the worst speed and load, add it, repeat until none violates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from .program import FactorProgram, HurwitzProgram, Program
from .results import OperatingPoint
from .solve import LocalSolution, NlpSolver
from .worst import worst_points

__all__ = ["EnvelopeSolution", "best_local", "first_points", "solve_envelope"]

MAX_ROUNDS = 30


@dataclass(frozen=True)
class EnvelopeSolution:
    """A local optimum over the whole envelope.

    Attributes
    ----------
    solution : LocalSolution
        Of the last round.
    worst : tuple of OperatingPoint
        Local maxima of the spectral abscissa of its design, the worst first; empty if the last round failed.
    rounds : int
    solved : bool
        True when no point of the envelope violates the margin.
    """

    solution: LocalSolution
    worst: tuple[OperatingPoint, ...]
    rounds: int
    solved: bool


def first_points(solver: NlpSolver) -> list[tuple[float, float]]:
    """Both ends and the geometric middle of the speed range, at every load (or both ends of a load range)."""
    envelope = solver.problem.study.envelope
    low, high = envelope.speed.min, envelope.speed.max
    return [(V, F_z) for F_z in envelope.loads for V in dict.fromkeys((low, (low * high) ** 0.5, high))]


def solve_envelope(
    solver: NlpSolver,
    start: Mapping[str, float],
    points: Sequence[tuple[float, float]],
    form: type[Program] = HurwitzProgram,
) -> EnvelopeSolution:
    """Local optimum from `start`, exchanged until the margin holds at every speed and load.

    Parameters
    ----------
    solver : NlpSolver
    start : mapping
        Design variables by name [SI].
    points : sequence of (speed, load)
        Where stability is imposed in the first round.
    form : type
        `HurwitzProgram` or `FactorProgram`.

    Returns
    -------
    EnvelopeSolution
    """
    study = solver.problem.study
    allowed = -study.required.stability_margin - study.solver.margin_reserve / 2
    points, design, worst = list(points), dict(start), []
    for rounds in range(1, MAX_ROUNDS + 1):
        solution = solver.solve(design, points, form)
        if not solution.converged:
            return EnvelopeSolution(solution, (), rounds, False)
        worst = worst_points(solver.problem.model.at(solution.design), study.envelope, allowed)
        violating = [p for p in worst if p.abscissa > allowed]
        if not violating:
            return EnvelopeSolution(solution, tuple(worst), rounds, True)
        new = [(p.speed, p.load) for p in violating if not any(_close(p, q) for q in points)]
        if not new:  # the program holds the point already and cannot meet it more exactly
            break
        points += new
        design = solution.design
    return EnvelopeSolution(solution, tuple(worst), rounds, False)


def best_local(solver: NlpSolver, start: Mapping[str, float], points: Sequence[tuple[float, float]]) -> EnvelopeSolution:
    """Local optimum from `start` by the Hurwitz program; where that fails by the factor program, improved by the first."""
    found = solve_envelope(solver, start, points, HurwitzProgram)
    if found.solved:
        return found
    found = solve_envelope(solver, start, points, FactorProgram)
    if not found.solved:
        return found
    again = solve_envelope(solver, found.solution.design, found.solution.points, HurwitzProgram)
    return again if again.solved and again.solution.objective < found.solution.objective else found


def _close(point: OperatingPoint, used: tuple[float, float]) -> bool:
    return abs(point.speed - used[0]) <= 1e-9 * used[0] and abs(point.load - used[1]) <= 1e-9 * used[1]

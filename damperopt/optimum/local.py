"""The best local optimum from one start, by the one or the other way to impose stability: first without decay, which asks for
no simulation, then with it from the design found."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from .decay_exchange import solve_with_decay
from .exchange import EnvelopeSolution, solve_envelope
from .problem import DesignProblem
from .program import FactorProgram, HurwitzProgram, Program, has_models
from .solve import NlpSolver

__all__ = ["best_local", "held_again"]

HURWITZ_STATES = 6
"""States up to which the Hurwitz program is tried first; determinants of a higher degree rarely let IPOPT come to an end."""

MUCH_BETTER = 0.1
"""Part of the required decay ratio below which a start decays so much better that it lies in no basin of its own."""


def best_local(solver: NlpSolver, start: Mapping[str, float], points: Sequence[tuple[float, ...]]) -> EnvelopeSolution:
    """Local optimum from `start` by the program that suits the number of states; where that fails by the other.

    Parameters
    ----------
    solver : NlpSolver
    start : mapping
        Design variables by name [SI].
    points : sequence of (speed, load, damping factor)
        Where stability is imposed in the first round.

    Returns
    -------
    EnvelopeSolution
        That meets the decay requirement too, if there is one.
    """
    if not has_models(solver.problem):
        return _best_stable(solver, start, points)
    if _decays_moderately(solver.problem, start):  # such a start may lie in a basin of its own
        direct = solve_with_decay(solver, start, points, _forms(solver.problem)[0])
        if direct.solved:
            return direct
    found = _best_stable(solver, start, points)
    return solver.remembered(found.solution.design, lambda: _best_decayed(solver, found)) if found.solved else found


def held_again(
    solver: NlpSolver,
    found: EnvelopeSolution,
    points: Sequence[tuple[float, ...]] = (),
    decay_points: Sequence[tuple[float, ...]] = (),
) -> EnvelopeSolution:
    """An optimum solved again with points that its exchange has missed.

    Parameters
    ----------
    solver : NlpSolver
    found : EnvelopeSolution
    points, decay_points : sequence of (speed, load, damping factor)
        For stability and for decay [m/s], [N].

    Returns
    -------
    EnvelopeSolution
    """
    design, points = found.solution.design, [*found.solution.points, *points]
    if not has_models(solver.problem):
        return best_local(solver, design, points)
    form = FactorProgram if found.solution.form == FactorProgram.__name__ else HurwitzProgram
    return solve_with_decay(solver, design, points, form, decay_points)


def _forms(problem: DesignProblem) -> tuple[type[Program], type[Program]]:
    """The program that is tried first, and the other one."""
    few = len(problem.search_model.state_names) <= HURWITZ_STATES
    return (HurwitzProgram, FactorProgram) if few else (FactorProgram, HurwitzProgram)


def _best_stable(solver: NlpSolver, start: Mapping[str, float], points: Sequence[tuple[float, ...]]) -> EnvelopeSolution:
    first, other = _forms(solver.problem)
    found = solve_envelope(solver, start, points, first)
    if found.solved:
        return found
    found = solve_envelope(solver, start, points, other)
    if not found.solved:
        return found
    again = solve_envelope(solver, found.solution.design, found.solution.points, first)
    return again if again.solved and again.solution.objective < found.solution.objective else found


def _decays_moderately(problem: DesignProblem, design: Mapping[str, float]) -> bool:
    """Whether the linear gear decays, and not ten times as well as it must."""
    required = problem.study.required.decay
    if required is None:
        return False
    if not problem.has_one_damping:
        return True
    yaw = problem.yaw_numbers(design)
    k_psi, c_psi = (np.array([yaw[name]]) for name in ("torsional_stiffness", "torsional_damping"))
    return bool(MUCH_BETTER * required.ratio < problem.screening.linear_decay(k_psi, c_psi)[0] < 1)


def _best_decayed(solver: NlpSolver, found: EnvelopeSolution) -> EnvelopeSolution:
    points, (first, other) = list(found.solution.points), _forms(solver.problem)
    decayed = solve_with_decay(solver, found.solution.design, points, first)
    return decayed if decayed.solved else solve_with_decay(solver, found.solution.design, points, other)

"""Deterministic multi-start: the config's own start and Sobol points, one local optimum each, in parallel processes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass

from ..study.study import Study
from .exchange import EnvelopeSolution, first_points
from .local import best_local
from .problem import DesignProblem
from .scan import promising_designs, sobol_designs
from .solve import NlpSolver

HOPELESS = 3
"""Sobol starts that are still tried where the scan finds no design."""

__all__ = ["StartOutcome", "run_starts", "starting_designs"]


@dataclass(frozen=True)
class StartOutcome:
    """Local optimum (or failure) of the start with this index."""

    index: int
    found: EnvelopeSolution


def starting_designs(problem: DesignProblem) -> list[dict[str, float]]:
    """Where to start: the config's own design, the promising ones of the stiffness scan, and Sobol points.

    Parameters
    ----------
    problem : DesignProblem

    Returns
    -------
    list of dict
        `solver.starts` designs, the same for the same seed; one alone is the config's own.
    """
    study = problem.study
    others = study.solver.starts - 1
    if not others or all(v.lower == v.upper for v in problem.variables[: len(problem.design_names)]):
        return [study.start]
    promising = promising_designs(problem, (others + 1) // 2)
    if not promising and problem.has_one_damping and problem.fail_safe is None:
        # nothing meets the requirements at any stiffness: most likely nothing does at all
        others = min(others, HOPELESS)
    sobol = sobol_designs(problem, others - len(promising)).tolist()
    return [study.start, *promising, *(dict(zip(problem.design_names, row, strict=True)) for row in sobol)]


def _run(solver: NlpSolver, index: int, start: dict[str, float]) -> StartOutcome:
    return StartOutcome(index, best_local(solver, start, first_points(solver)))


class _Worker:
    """What a worker process keeps between the starts that it is sent: solvers are not sent, each process builds its own."""

    solver: NlpSolver | None = None

    @classmethod
    def run(cls, study: Study, index: int, start: dict[str, float]) -> StartOutcome:
        if cls.solver is None or cls.solver.problem.study != study:
            cls.solver = NlpSolver(DesignProblem(study))
        return _run(cls.solver, index, start)


def run_starts(solver: NlpSolver, pool: Executor | None, progress: Callable[[int, int], None] | None) -> list[StartOutcome]:
    """Local optima from all starts.

    Parameters
    ----------
    solver : NlpSolver
        Of this process; worker processes build their own.
    pool : Executor or None
        Of `executor`; None: one after another in this process.
    progress : callable or None
        Called with (done, total) after each start.

    Returns
    -------
    list of StartOutcome
        In the order of the starts, whatever the order of completion.
    """
    starts = starting_designs(solver.problem)
    total = len(starts)

    def outcomes() -> Iterator[StartOutcome]:
        if pool is None:
            yield from (_run(solver, index, start) for index, start in enumerate(starts))
        else:
            yield from pool.map(_Worker.run, [solver.problem.study] * total, range(total), starts)

    found = []
    for outcome in outcomes():
        found.append(outcome)
        if progress:
            progress(len(found), total)
    return found

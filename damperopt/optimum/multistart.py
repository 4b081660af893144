"""Deterministic multi-start: the config's own start and Sobol points, one local optimum each, in parallel processes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import lru_cache

from ..study.study import Study
from .exchange import EnvelopeSolution, best_local, first_points
from .problem import DesignProblem
from .scan import promising_designs, sobol_designs
from .solve import NlpSolver

HOPELESS = 3
"""Sobol starts that are still tried where the scan finds no design."""

__all__ = ["StartOutcome", "run_starts", "solver_for", "starting_designs"]


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
    if not promising and problem.has_one_damping:
        # nothing meets the requirements at any stiffness: most likely nothing does at all
        others = min(others, HOPELESS)
    sobol = sobol_designs(problem, others - len(promising)).tolist()
    return [study.start, *promising, *(dict(zip(problem.design_names, row, strict=True)) for row in sobol)]


@lru_cache(maxsize=4)
def solver_for(study_json: str) -> NlpSolver:
    """Solver of a study given as JSON; kept, since a process meets the same study many times."""
    return NlpSolver(DesignProblem(Study.model_validate_json(study_json)))


def _run(study_json: str, index: int, start: dict[str, float]) -> StartOutcome:
    solver = solver_for(study_json)
    return StartOutcome(index, best_local(solver, start, first_points(solver)))


def run_starts(study: Study, pool: Executor | None, progress: Callable[[int, int], None] | None) -> list[StartOutcome]:
    """Local optima from all starts.

    Parameters
    ----------
    study : Study
    pool : Executor or None
        Of `executor`; None: one after another in this process.
    progress : callable or None
        Called with (done, total) after each start.

    Returns
    -------
    list of StartOutcome
        In the order of the starts, whatever the order of completion.
    """
    text = study.model_dump_json()
    starts = starting_designs(solver_for(text).problem)
    total = len(starts)

    def outcomes() -> Iterator[StartOutcome]:
        if pool is None:
            yield from (_run(text, index, start) for index, start in enumerate(starts))
        else:
            yield from pool.map(_run, [text] * total, range(total), starts)

    found = []
    for outcome in outcomes():
        found.append(outcome)
        if progress:
            progress(len(found), total)
    return found

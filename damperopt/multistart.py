"""Deterministic multi-start: the config's own start and Sobol points, one local optimum each, in parallel processes."""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache

from scipy.stats import qmc

from .exchange import EnvelopeSolution, best_local, first_points
from .problem import DesignProblem
from .solve import NlpSolver
from .specs import Study

__all__ = ["StartOutcome", "executor", "run_starts", "solver_for", "starting_designs"]


@dataclass(frozen=True)
class StartOutcome:
    """Local optimum (or failure) of the start with this index."""

    index: int
    found: EnvelopeSolution


def starting_designs(problem: DesignProblem) -> list[dict[str, float]]:
    """The start of the config, then scrambled Sobol points within the bounds of the free variables (scaled).

    Parameters
    ----------
    problem : DesignProblem

    Returns
    -------
    list of dict
        `solver.starts` designs, the same for the same seed.
    """
    settings, variables = problem.study.solver, problem.variables[:-1]
    own = {v.name: v.start for v in variables}
    free = [v for v in variables if v.lower < v.upper]
    if not free or settings.starts == 1:
        return [own]
    sobol = qmc.Sobol(len(free), rng=settings.seed)
    unit = sobol.random_base2((settings.starts - 1).bit_length())[: settings.starts - 1]
    scaled = qmc.scale(unit, [v.scale(v.lower) for v in free], [v.scale(v.upper) for v in free])
    return [own] + [own | {v.name: v.unscale(x) for v, x in zip(free, row, strict=True)} for row in scaled.tolist()]


@lru_cache(maxsize=4)
def solver_for(study_json: str) -> NlpSolver:
    """Solver of a study given as JSON; kept, since a process meets the same study many times."""
    return NlpSolver(DesignProblem(Study.model_validate_json(study_json)))


def _run(study_json: str, index: int) -> StartOutcome:
    solver = solver_for(study_json)
    start = starting_designs(solver.problem)[index]
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
    total = len(starting_designs(solver_for(text).problem))

    def outcomes() -> Iterator[StartOutcome]:
        if pool is None:
            yield from (_run(text, index) for index in range(total))
        else:
            yield from pool.map(_run, [text] * total, range(total))

    found = []
    for outcome in outcomes():
        found.append(outcome)
        if progress:
            progress(len(found), total)
    return found


@contextmanager
def executor(workers: int) -> Iterator[Executor | None]:
    """Pool of worker processes, or None for a single worker; an interrupt ends them at once.

    Parameters
    ----------
    workers : int
    """
    if workers <= 1:
        yield None
        return
    methods = multiprocessing.get_all_start_methods()
    context = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
    if "forkserver" in methods:
        context.set_forkserver_preload([__name__])  # casadi is imported once, not once per worker
    pool = ProcessPoolExecutor(workers, mp_context=context, initializer=_ignore_interrupt)
    try:
        yield pool
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        raise
    pool.shutdown()


def _ignore_interrupt() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the parent's to handle

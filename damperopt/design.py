"""One study from start to end: solve from many starts, keep the best, prove and check it, explain it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, datetime
from functools import partial
from pathlib import Path

from .cycles.requirement import check_limit_cycles, cycle_failures
from .errors import ConfigError, Unfinished
from .lightest import mass_bound
from .motion.exact import ExactSimulator
from .optimum.answer import (
    SAME_MASS,
    constraint_results,
    damping_over_temperature,
    decided_by,
    infeasible_message,
    local_optima,
    not_checked,
    nothing_yet,
    start_result,
    worst_of,
)
from .optimum.diagnose import diagnose
from .optimum.exchange import EnvelopeSolution
from .optimum.local import best_local, held_again
from .optimum.margins import load_rows, margin_rows
from .optimum.multistart import StartOutcome, run_starts, starting_designs
from .optimum.problem import DesignProblem
from .optimum.said import said_of
from .optimum.sensitivity import sensitivities
from .optimum.solve import NlpSolver
from .optimum.stock import StockSearch, of_chosen_sizes, of_stock
from .proof.certify import certify
from .proof.check import check_damping, check_decay, check_grid
from .provenance import provenance_of
from .results import Certificate, DecayCheck, DesignResult, MassResult, Verification
from .study.components import optimisable
from .study.passive_rest import passive_rest
from .study.study import Study
from .workers import executor

__all__ = ["combinations", "optimise", "optimise_each", "rank"]

KKT_TOLERANCE = 1e-5
"""Largest KKT residual that counts as optimal (kg per unit of a scaled variable, and scaled rows)."""

DIAGNOSED = 4
"""Starts from which the least relaxation is looked for where no design is found."""

REFINEMENTS = 5
"""Times that a counterexample of the certificate (over a load range) or of the exact simulation goes back to the solver."""

PEAK_TOLERANCE = 2e-3
"""Relative excess of exact peaks over those that size the parts: what lies between the speeds of the search, and smoothing."""

MARGIN_ROUNDING = 1e-6
"""Negative margin of safety that is the tolerance of the program."""

NEARLY = 0.05
"""Relative excess of the exact decay ratio up to which it is taken for a speed that was missed, not for a fault."""

Progress = Callable[[int, int], None]


def optimise(
    study: Study,
    *,
    workers: int = 1,
    progress: Progress | bool | None = None,
    config_file: str | Path | None = None,
) -> DesignResult:
    """Lightest damper of a study, proved stable over its envelope.

    Parameters
    ----------
    study : Study
    workers : int
        Processes for the starts; 1 keeps everything in this one.
    progress : callable, bool or None
        Called with (done, total) after each start; True: a bar, in a notebook too.
    config_file : str, Path or None
        Source of the study, for the provenance.

    Returns
    -------
    DesignResult
        `status` says whether it is solved (and verified), infeasible or failed; nothing is raised for those. Of a study with
        sizes that exist the lightest design of these, with what it costs in `stock`; its `config` is the study with them.

    Raises
    ------
    ConfigError
        If the layout has no design variables (topology ``rotational``), or no size that exists fits its bounds.
    Unfinished
        If the search among sizes that exist is interrupted, with the optimum of any size.
    """
    combinations(study, [], [])  # refuses what cannot be optimised
    listed = study.available is not None or study.catalogue is not None
    search = StockSearch(study, _proved_alone) if listed else None
    clock, started = time.perf_counter(), datetime.now(UTC).isoformat(timespec="seconds")
    solver = NlpSolver(DesignProblem(study))
    with executor(workers) as pool, _bar(study, progress is True) as shown:
        outcomes = run_starts(solver, pool, shown if isinstance(progress, bool) else progress)
    result, stopped = _answer(solver, outcomes), False
    if search is not None:
        result, stopped = of_stock(study, search, result)
    result = result.model_copy(update={"bound": mass_bound(study, result)})
    provenance = provenance_of(study, config_file, started, time.perf_counter() - clock)
    config = of_chosen_sizes(study, result).model_dump(mode="json")
    result = result.model_copy(update={"provenance": provenance, "config": config})
    if stopped:
        raise Unfinished(result)
    return result


def _proved_alone(solver: NlpSolver, found: EnvelopeSolution) -> DesignResult:
    return _answer(solver, [StartOutcome(0, found)])


@contextmanager
def _bar(study: Study, wanted: bool) -> Iterator[Progress | None]:
    if not wanted:
        yield None
        return
    from tqdm.auto import tqdm

    with tqdm(desc=f"{study.damper.topology}, {study.material.name}", unit="start") as bar:

        def advance(done: int, total: int) -> None:
            bar.total = total
            bar.update(done - bar.n)

        yield advance


def combinations(study: Study, topologies: Sequence[str], materials: Sequence[str]) -> list[Study]:
    """The study with each layout and material, everything else equal.

    Parameters
    ----------
    study : Study
    topologies, materials : sequence of str
        Empty: the study's own.

    Returns
    -------
    list of Study

    Raises
    ------
    ConfigError
        If the study lacks what a combination needs.
    """
    if not topologies and not study.variables:
        raise ConfigError(
            f"{study.name}: damper.topology: 'rotational' has no design variables with kind '{study.damper.kind}'; allowed: "
            f"{', '.join(optimisable())}, or kind vane (or use 'damperopt analyse', for kind friction 'damperopt breakout')"
        )
    variants = []
    for topology in topologies or [study.damper.topology]:
        for material in materials or [""]:
            changes = {"damper__topology": topology} | ({"material": material} if material else {})
            try:
                variants.append(study.replace(**changes))
            except ConfigError as error:
                raise ConfigError(
                    f"{study.name}: with topology {topology}, material {material or 'as given'}: {'; '.join(error.problems)}"
                ) from None
    return variants


def optimise_each(
    studies: Sequence[Study],
    *,
    workers: int = 1,
    progress: Callable[[int, int, Study], None] | None = None,
    config_file: str | Path | None = None,
) -> Iterator[DesignResult]:
    """Optimise several studies, side by side if there are workers; each result is yielded as soon as its turn comes.

    Parameters
    ----------
    studies : sequence of Study
    workers : int
        Processes; each takes whole studies. A single study shares its starts among them instead.
    progress : callable or None
        Called with (done, total, study): starts of a single study or of studies in this process, else studies.
    config_file : str, Path or None
        Source, for the provenance.

    Yields
    ------
    DesignResult
        In the order of the studies.
    """
    if len(studies) > 1 and workers > 1:
        with executor(workers) as pool:
            results = (pool.map if pool else map)(partial(optimise, config_file=config_file), studies)
            for done, result in enumerate(results, 1):
                if progress:
                    progress(done, len(studies), studies[done - 1])
                yield result
        return
    total, before = sum(study.solver.starts for study in studies), 0
    for study in studies:

        def report(done: int, _: int, study: Study = study, before: int = before) -> None:
            if progress:
                progress(before + done, total, study)

        yield optimise(study, workers=workers, progress=report, config_file=config_file)
        before += study.solver.starts


def rank(results: Iterable[DesignResult]) -> list[DesignResult]:
    """The lightest first, those without a verified design last."""
    return sorted(results, key=lambda r: (r.status != "solved", r.mass.total if r.mass else float("inf")))


def _answer(solver: NlpSolver, outcomes: list[StartOutcome]) -> DesignResult:
    problem, study = solver.problem, solver.problem.study
    starts = tuple(start_result(outcome.index, outcome.found) for outcome in outcomes)
    solved = [outcome.found for outcome in outcomes if outcome.found.solved]
    base = nothing_yet(study).model_copy(update={"starts": starts, "local_optima": local_optima(solved)})
    if not solved:
        diagnosis = diagnose(solver, starting_designs(problem)[:DIAGNOSED])
        if diagnosis.infeasibility:
            message = infeasible_message(diagnosis.infeasibility.shortfalls, diagnosis.infeasibility.alone_enough)
            return base.model_copy(
                update={"status": "infeasible", "message": message, "infeasibility": diagnosis.infeasibility}
            )
        if diagnosis.feasible_design is None:
            message = "no start converged, nor did the search for a relaxation; try other starts or bounds"
            return base.model_copy(update={"message": message})
        rescued = best_local(solver, diagnosis.feasible_design, _points_for(problem, diagnosis.feasible_design))
        if not rescued.solved:
            message = (
                f"a design exists, but the solver stopped from every start ({rescued.solution.status}); raise solver.starts"
            )
            return base.model_copy(update={"message": message, "design": diagnosis.feasible_design})
        solved = [rescued]
    best, certificate = _proved(solver, min(solved, key=lambda found: found.solution.objective))
    best, certificate, decay = _decayed(solver, best, certificate)
    return _checked(solver, best, certificate, decay, solved, base)


def _proved(solver: NlpSolver, best: EnvelopeSolution) -> tuple[EnvelopeSolution, Certificate]:
    """The optimum with its certificate; solved again with points that the proof, or that without an actuator, finds missed."""
    study, model = solver.problem.study, solver.problem.model
    rest = passive_rest(study)
    certificate = certify(study, best.solution.design, model=model)
    for _ in range(REFINEMENTS):
        places = [] if certificate.place is None else [certificate.place]
        off = None if rest is None else certify(rest, best.solution.design).place
        places += [] if off is None else [(*off[:2], -off[2])]
        if not places:
            break
        again = held_again(solver, best, places)
        if not again.solved:
            break
        best, certificate = again, certify(study, again.solution.design, model=model)
    return best, certificate


def _decayed(
    solver: NlpSolver, best: EnvelopeSolution, certificate: Certificate
) -> tuple[EnvelopeSolution, Certificate, DecayCheck | None]:
    """The optimum with its exact simulation; where that finds a speed that the search has missed, solved again with it."""
    study, missed = solver.problem.study, list[tuple[float, float, float]]()
    if study.required.decay is None:
        return best, certificate, None
    simulator = ExactSimulator(study, model=solver.problem.model)
    for _ in range(REFINEMENTS):
        points = [p.place for p in best.decay]
        check = check_decay(study, best.solution.design, points, simulator=simulator)
        check = replace(check, optimised=best.decay[0].ratio, engine=solver.decay.engine)
        if check.passed or check.ratio > (1 + NEARLY) * check.limit:
            break
        missed.append((check.speed, check.load, check.damping))
        again = held_again(solver, best, decay_points=missed)
        if not again.solved:
            break
        best, certificate = _proved(solver, again)
    return best, certificate, check


def _points_for(problem: DesignProblem, design: Mapping[str, float]) -> list[tuple[float, float, float]]:
    return [point.place for point in problem.worst_points(design)]


def _times(factor: float) -> str:
    """Where the damping is not as designed."""
    return "" if factor == 1 else f", {factor:.4g} times the damping"


def _checked(
    solver: NlpSolver,
    best: EnvelopeSolution,
    certificate: Certificate,
    decay: DecayCheck | None,
    solved: list[EnvelopeSolution],
    base: DesignResult,
) -> DesignResult:
    """Result of the best local optimum, with proof and verification."""
    problem, solution, worst = solver.problem, best.solution, worst_of(best)
    study = problem.study
    grid = check_grid(study, solution.design, model=problem.model)
    agreeing = sum(s.solution.objective <= solution.objective * (1 + SAME_MASS) for s in solved)
    failures, rest = [], passive_rest(study)
    fail_safe = None if rest is None else certify(rest, solution.design)
    if not certificate.proved:
        failures.append(f"the exact certificate does not hold: {certificate.reason}")
    if fail_safe is not None and not fail_safe.proved:
        failures.append(f"the exact certificate with the actuator off does not hold: {fail_safe.reason}")
    if not grid.passed:
        failures.append(
            f"an eigenvalue has the real part {grid.worst.abscissa:.6g} 1/s at {grid.worst.speed:.6g} m/s, "
            f"{grid.worst.load / 1e3:.6g} kN{_times(grid.worst.damping)}"
        )
    if decay is not None and not decay.passed:
        failures.append(
            f"the exact simulation decays to {decay.ratio:.6g} of the first amplitude in {decay.cycles} cycles at "
            f"{decay.speed:.6g} m/s, {decay.load / 1e3:.6g} kN{_times(decay.damping)}; required {decay.limit:.6g}"
        )
    factors = solver.simulated_factors(solution.design)
    event = problem.limit_event(solution.design, factors)
    if decay is not None and study.required.limit_event == "simulated":
        over = [name for name, peak in decay.peaks.items() if peak > (1 + PEAK_TOLERANCE) * event[name]]
        failures += [f"the exact simulation shows {decay.peaks[n]:.5g} for {n}, sized for {event[n]:.5g}" for n in over]
    if study.required.damping_ratio is not None:
        ratio, V, F_z, factor = check_damping(study, solution.design, problem.model)
        if ratio < study.required.damping_ratio:
            failures.append(
                f"the yaw mode has the damping ratio {ratio:.5g} at {V:.6g} m/s, {F_z / 1e3:.6g} kN{_times(factor)}"
            )
    failures += cycle_failures(cycles := check_limit_cycles(study, solution.design))
    simulated = {} if decay is None else decay.peaks
    rows = margin_rows(study, solution.design, simulated)
    failures += [f"{m.part} fails {m.check} in {m.case} (margin {m.value:+.3g})" for m in rows if m.value < -MARGIN_ROUNDING]
    if solution.kkt_residual > KKT_TOLERANCE:
        failures.append(f"the KKT residual is {solution.kkt_residual:.2g}")
    verification = Verification(
        passed=not failures,
        grid_passed=grid.passed,
        grid_speeds=grid.speeds,
        grid_loads=grid.loads,
        worst=grid.worst,
        kkt_residual=solution.kkt_residual,
        agreeing_starts=agreeing,
    )
    parts = problem.parts(solution.design, factors)
    mass = float(sum(parts.values()))
    constraints = constraint_results(problem, best, factors)
    weights, warm = decided_by(constraints, mass), damping_over_temperature(study, solution.design)
    viscous = problem.units.get(study.damper.VISCOUS, "")
    message = f"lightest design found: {mass:.4g} kg, proved stable at every speed of the envelope"
    if fail_safe is not None:
        message += f", and with the actuator off with the margin {fail_safe.margin:g} 1/s"
    if weights:
        message += f"; the mass is decided by {next(iter(weights))}"
    message = "; ".join(failures) or message
    found = base.model_copy(
        update={
            "status": "failed" if failures else "solved",
            "message": message,
            "design": solution.design,
            "derived": {**problem.yaw_numbers(solution.design), **problem.least_sizes(solution.design, factors), **warm},
            "units": problem.units
            | {"torsional_stiffness": "N m/rad", "torsional_damping": "N m s/rad"}
            | dict.fromkeys(warm, viscous),
            "limit_event": event,
            "mass": MassResult(total=mass, parts=parts),
            "stability": worst,
            "constraints": constraints,
            "decay": decay,
            "limit_cycle": cycles,
            "decided_by": weights,
            "loads": load_rows(study, solution.design, simulated),
            "margins": rows,
            "certificate": certificate,
            "fail_safe": fail_safe,
            "verification": verification,
            "sensitivities": sensitivities(problem, solution, solver.decay if decay else None),
        }
    )
    said = said_of(study, found, problem.model.at(solution.design))
    return found.model_copy(update=said | {"not_checked": (*said["leaves_out"], *not_checked(study))})

"""One study from start to end: solve from many starts, keep the best, prove and check it, explain it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from datetime import UTC, datetime
from functools import partial
from pathlib import Path

from .certify import certify
from .diagnose import diagnose
from .errors import ConfigError
from .exchange import EnvelopeSolution, best_local
from .multistart import StartOutcome, executor, run_starts, solver_for, starting_designs
from .problem import ROD, DesignProblem
from .provenance import provenance_of
from .results import (
    UNITS,
    Certificate,
    ConstraintResult,
    DesignResult,
    LocalOptimum,
    MassResult,
    Relaxation,
    StartResult,
    Verification,
)
from .sensitivity import sensitivities
from .solve import NlpSolver
from .specs import Study
from .variables import TOPOLOGIES
from .verify import check_grid
from .worst import worst_points

__all__ = ["combinations", "optimise", "optimise_each", "rank"]

SAME_MASS = 1e-4
"""Starts whose masses agree to this relative difference are counted as one local optimum."""

KKT_TOLERANCE = 1e-5
"""Largest KKT residual that counts as optimal (kg per unit of a scaled variable, and scaled rows)."""

REFINEMENTS = 5
"""Times that a counterexample of the certificate is handed back to the solver (over a load range)."""

Progress = Callable[[int, int], None]


def optimise(
    study: Study,
    *,
    workers: int = 1,
    progress: Progress | None = None,
    config_file: str | Path | None = None,
) -> DesignResult:
    """Lightest damper of a study, proved stable over its envelope.

    Parameters
    ----------
    study : Study
    workers : int
        Processes for the starts; 1 keeps everything in this one.
    progress : callable or None
        Called with (done, total) after each start.
    config_file : str, Path or None
        Source of the study, for the provenance.

    Returns
    -------
    DesignResult
        `status` says whether it is solved (and verified), infeasible or failed; nothing is raised for those.

    Raises
    ------
    ConfigError
        If the layout has no design variables (topology ``rotational``).
    """
    combinations(study, [], [])  # refuses what cannot be optimised
    clock, started = time.perf_counter(), datetime.now(UTC).isoformat(timespec="seconds")
    with executor(workers) as pool:
        outcomes = run_starts(study, pool, progress)
    solver = solver_for(study.model_dump_json())
    result = _answer(study, solver, outcomes)
    provenance = provenance_of(study, config_file, started, time.perf_counter() - clock)
    return result.model_copy(update={"provenance": provenance, "config": study.model_dump(mode="json")})


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
    if not topologies and study.damper.topology not in TOPOLOGIES:
        raise ConfigError(
            f"{study.name}: damper.topology: 'rotational' has no design variables to optimise; "
            f"allowed: {', '.join(TOPOLOGIES)} (or use 'damperopt analyse')"
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


def _answer(study: Study, solver: NlpSolver, outcomes: list[StartOutcome]) -> DesignResult:
    problem = solver.problem
    starts = tuple(_start_result(outcome.index, outcome.found) for outcome in outcomes)
    solved = [outcome.found for outcome in outcomes if outcome.found.solved]
    base = DesignResult(
        status="failed",
        message="",
        study=study.name,
        topology=study.damper.topology,
        geometry=study.damper.geometry,
        material=study.material.name,
        stability_margin=study.required.stability_margin,
        starts=starts,
        local_optima=_local_optima(solved),
    )
    if not solved:
        diagnosis = diagnose(solver, starting_designs(problem)[:4])
        if diagnosis.infeasibility:
            message = _infeasible_message(diagnosis.infeasibility.shortfalls, diagnosis.infeasibility.alone_enough)
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
    return _checked(problem, best, certificate, solved, base)


def _proved(solver: NlpSolver, best: EnvelopeSolution) -> tuple[EnvelopeSolution, Certificate]:
    """The optimum with its certificate; where the proof finds a point that the exchange has missed, solved again with it."""
    study = solver.problem.study
    certificate = certify(study, best.solution.design)
    for _ in range(REFINEMENTS):
        if certificate.counterexample is None:
            break
        points = [*best.solution.points, certificate.counterexample]
        again = best_local(solver, best.solution.design, points)
        if not again.solved:
            break
        best, certificate = again, certify(study, again.solution.design)
    return best, certificate


def _points_for(problem: DesignProblem, design: Mapping[str, float]) -> list[tuple[float, float]]:
    return [(p.speed, p.load) for p in worst_points(problem.model.at(design), problem.study.envelope)]


def _checked(
    problem: DesignProblem,
    best: EnvelopeSolution,
    certificate: Certificate,
    solved: list[EnvelopeSolution],
    base: DesignResult,
) -> DesignResult:
    """Result of the best local optimum, with proof and verification."""
    study, solution, worst = problem.study, best.solution, best.worst[0]
    grid = check_grid(study, solution.design)
    agreeing = sum(s.solution.objective <= solution.objective * (1 + SAME_MASS) for s in solved)
    passed = grid.passed and certificate.proved and solution.kkt_residual <= KKT_TOLERANCE
    verification = Verification(
        passed=passed,
        grid_passed=grid.passed,
        grid_speeds=grid.speeds,
        grid_loads=grid.loads,
        worst=grid.worst,
        kkt_residual=solution.kkt_residual,
        agreeing_starts=agreeing,
    )
    failures = []
    if not certificate.proved:
        failures.append(f"the exact certificate does not hold: {certificate.reason}")
    if not grid.passed:
        failures.append(
            f"an eigenvalue has the real part {grid.worst.abscissa:.6g} 1/s at {grid.worst.speed:.6g} m/s, "
            f"{grid.worst.load / 1e3:.6g} kN"
        )
    if solution.kkt_residual > KKT_TOLERANCE:
        failures.append(f"the KKT residual is {solution.kkt_residual:.2g}")
    mass = problem.mass(solution.design)
    message = "; ".join(failures) or f"lightest design found: {mass:.4g} kg, proved stable at every speed of the envelope"
    return base.model_copy(
        update={
            "status": "solved" if passed else "failed",
            "message": message,
            "design": solution.design,
            "derived": {**problem.yaw_numbers(solution.design), ROD: problem.rod_diameter(solution.design)},
            "mass": MassResult(total=mass, parts=problem.parts(solution.design)),
            "stability": worst,
            "constraints": _constraints(problem, best),
            "not_checked": _not_checked(study),
            "certificate": certificate,
            "verification": verification,
            "sensitivities": sensitivities(problem, solution),
        }
    )


def _constraints(problem: DesignProblem, best: EnvelopeSolution) -> tuple[ConstraintResult, ...]:
    study, solution, worst = problem.study, best.solution, best.worst[0]
    margin = study.required.stability_margin
    price = float(solution.data_gradient[problem.data_names.index("requirements.stability_margin")])
    results = [
        ConstraintResult(
            name="stability_margin",
            value=worst.abscissa,
            limit=-margin,
            sense="<=",
            unit="1/s",
            active=worst.abscissa > -margin - 10 * study.solver.margin_reserve,
            multiplier=price,
            shadow_price=-price,
            relaxed_by=("requirements.stability_margin", "envelope.speed", "envelope.vertical_load"),
        )
    ]
    values, rows = problem.values(solution.design), problem.rows(solution.design)
    for constraint, multiplier in zip(problem.constraints, solution.row_multipliers, strict=True):
        value, limit = values[constraint.name]
        per_limit = multiplier / limit if constraint.ratio else multiplier
        results.append(
            ConstraintResult(
                name=constraint.name,
                value=value,
                limit=limit,
                sense=">=" if constraint.at_least else "<=",
                unit=constraint.unit,
                active=abs(rows[constraint.name]) < 1e-6 or multiplier > 1e-6 * solution.objective,
                multiplier=float(multiplier),
                shadow_price=float(per_limit if constraint.at_least else -per_limit),
                relaxed_by=constraint.relaxed_by,
            )
        )
    return tuple(results) + _active_bounds(problem, best)


def _active_bounds(problem: DesignProblem, best: EnvelopeSolution) -> tuple[ConstraintResult, ...]:
    """Bounds of design variables that carry a multiplier (fixed variables: what fixing them costs)."""
    found = []
    for variable, multiplier in zip(problem.variables, best.solution.bound_multipliers, strict=True):
        if variable.name == ROD or abs(multiplier) < 1e-6 * best.solution.objective:
            continue
        upper = multiplier > 0
        limit = variable.upper if upper else variable.lower
        slope = multiplier / limit if variable.logarithmic else multiplier
        fixed = variable.lower == variable.upper
        found.append(
            ConstraintResult(
                name=f"{variable.name}_{'fixed' if fixed else 'max' if upper else 'min'}",
                value=best.solution.design[variable.name],
                limit=limit,
                sense="<=" if upper else ">=",
                unit=UNITS[variable.name],
                active=True,
                multiplier=abs(float(multiplier)),
                shadow_price=-float(slope),
                relaxed_by=(f"design.{variable.name}",),
            )
        )
    return tuple(found)


def _not_checked(study: Study) -> tuple[str, ...]:
    notes = ["decay of large disturbances on the nonlinear model", "damper compliance in series", "freeplay and end stops"]
    if study.damper.topology != "boeing" and not study.material.has_fatigue_data:
        notes.insert(0, f"fatigue of the bending arm: no Basquin data for {study.material.name}")
    return tuple(notes)


def _start_result(index: int, found: EnvelopeSolution) -> StartResult:
    solution = found.solution
    return StartResult(
        index=index,
        solved=found.solved,
        status=solution.status,
        mass=solution.objective if found.solved else None,
        rounds=found.rounds,
        form=solution.form,
        design=solution.design,
    )


def _local_optima(solved: list[EnvelopeSolution]) -> tuple[LocalOptimum, ...]:
    optima: list[LocalOptimum] = []
    for found in sorted(solved, key=lambda found: found.solution.objective):
        mass = found.solution.objective
        if optima and mass <= optima[-1].mass * (1 + SAME_MASS):
            optima[-1] = optima[-1].model_copy(update={"starts": optima[-1].starts + 1})
        else:
            optima.append(LocalOptimum(mass=mass, starts=1, design=found.solution.design))
    return tuple(optima)


def _infeasible_message(shortfalls: Sequence[Relaxation], alone: Sequence[Relaxation]) -> str:
    missing = "; ".join(_short(r) for r in shortfalls)
    text = f"no design was found that meets the requirements. Nearest: {missing}."
    if alone:
        text += " Enough on its own: " + "; or ".join(_enough(r) for r in alone) + "."
    return text


def _short(r: Relaxation) -> str:
    place = "" if r.speed is None or r.load is None else f" at {r.speed:.4g} m/s, {r.load / 1e3:.4g} kN"
    return f"{r.name} can reach {r.needed:.4g} {r.unit}{place}, required {r.limit:.4g} (short by {abs(r.limit - r.needed):.2g})"


def _enough(r: Relaxation) -> str:
    return f"{r.name} of {r.needed:.4g} {r.unit} instead of {r.limit:.4g} ({', '.join(r.inputs)})"

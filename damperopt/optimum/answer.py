"""From solutions to the records of an answer: constraints with their prices, local optima, messages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..quantities.temperature import ZERO_CELSIUS
from ..results import ConstraintResult, DesignResult, LocalOptimum, OperatingPoint, Relaxation, StartResult
from ..study.components import unit_of_name
from ..study.study import Study
from .exchange import EnvelopeSolution
from .problem import DesignProblem

__all__ = [
    "SAME_MASS",
    "constraint_results",
    "damping_over_temperature",
    "decided_by",
    "infeasible_message",
    "local_optima",
    "missing_words",
    "not_checked",
    "nothing_yet",
    "start_result",
    "worst_of",
]

SAME_MASS = 1e-4
"""Starts whose masses agree to this relative difference are counted as one local optimum."""


def worst_of(best: EnvelopeSolution) -> OperatingPoint:
    """Where the spectral abscissa is largest; of a gear with an actuator while it is on."""
    return next(point for point in best.worst if point.damping > 0)


def _fail_safe(problem: DesignProblem, best: EnvelopeSolution) -> ConstraintResult:
    """The margin with the actuator off."""
    assert problem.fail_safe is not None
    off, margin = next(point for point in best.worst if point.damping < 0), problem.study.fail_safe_margin
    abscissa, name = off.abscissa - problem.fail_safe.less, "requirements.fail_safe_margin"
    price = float(best.solution.gradient.data[problem.data_names.index(name)]) if name in problem.data_names else 0.0
    return ConstraintResult(
        name="fail_safe_margin",
        kind="stability",
        value=abscissa,
        limit=0 - margin,
        sense="<=",
        unit="1/s",
        active=abscissa > -margin - 10 * problem.study.solver.margin_reserve,
        multiplier=price,
        shadow_price=-price,
        relaxed_by=(name, "envelope.speed", "envelope.vertical_load"),
    )


def constraint_results(
    problem: DesignProblem, best: EnvelopeSolution, factors: np.ndarray | None = None
) -> tuple[ConstraintResult, ...]:
    """Every constraint at the optimum, with what it costs; `factors` as `DesignProblem.mass` takes them."""
    study, solution, worst = problem.study, best.solution, worst_of(best)
    margin = study.required.stability_margin
    price = float(solution.gradient.data[problem.data_names.index("requirements.stability_margin")])
    results = [
        ConstraintResult(
            name="stability_margin",
            kind="stability",
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
    if problem.fail_safe is not None:
        results.append(_fail_safe(problem, best))
    if best.decay:
        required = study.required.decay
        assert required is not None
        carried = float(solution.multipliers.cuts.sum())
        results.append(
            ConstraintResult(
                name="decay_ratio",
                kind="decay",
                value=best.decay[0].ratio,
                limit=required.ratio,
                sense="<=",
                unit="1",
                active=carried > 1e-6 * solution.objective,
                multiplier=carried,
                shadow_price=-carried / required.ratio,
                relaxed_by=("requirements.decay.ratio", "requirements.decay.cycles", "envelope.speed"),
            )
        )
    if best.damping:
        limit = study.required.damping_ratio
        assert limit is not None
        carried = float(solution.multipliers.damping.sum())
        results.append(
            ConstraintResult(
                name="damping_ratio",
                kind="decay",
                value=best.damping[0].ratio,
                limit=limit,
                sense=">=",
                unit="1",
                active=carried > 1e-6 * solution.objective,
                multiplier=carried,
                shadow_price=carried / limit,
                relaxed_by=("requirements.damping_ratio", "envelope.speed"),
            )
        )
    values, rows = problem.values(solution.design, factors), problem.rows(solution.design, factors)
    for constraint, multiplier in zip(problem.constraints, solution.multipliers.rows, strict=True):
        value, limit = values[constraint.name]
        per_limit = multiplier / limit if constraint.ratio else multiplier
        results.append(
            ConstraintResult(
                name=constraint.name,
                kind=constraint.kind,
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
    for variable, multiplier in zip(problem.variables, best.solution.multipliers.bounds, strict=True):
        if variable.name not in problem.design_names or abs(multiplier) < 1e-6 * best.solution.objective:
            continue
        upper = multiplier > 0
        limit = variable.upper if upper else variable.lower
        slope = multiplier / limit if variable.logarithmic else multiplier
        fixed = variable.lower == variable.upper
        found.append(
            ConstraintResult(
                name=f"{variable.name}_{'fixed' if fixed else 'max' if upper else 'min'}",
                kind="bound",
                value=best.solution.design[variable.name],
                limit=limit,
                sense="<=" if upper else ">=",
                unit=unit_of_name(variable.name),
                active=True,
                multiplier=abs(float(multiplier)),
                shadow_price=-float(slope),
                relaxed_by=(f"design.{variable.name}",),
            )
        )
    return tuple(found)


def damping_over_temperature(study: Study, design: Mapping[str, float]) -> dict[str, float]:
    """Damping with oil at the temperatures that are always asked for [N s/m], where the study says something of temperature.

    Parameters
    ----------
    study : Study
    design : mapping of str to float
        Design variables by name [SI].

    Examples
    --------
    Keys are the variable and the temperature in degC: ``c_lambda_at_-54_degC``.
    """
    name, found = study.damper.VISCOUS, study.damper.damping_by_temperature()
    return {f"{name}_at_{T - ZERO_CELSIUS:.0f}_degC": factor * design[name] for T, factor in found.items()}


def decided_by(constraints: Sequence[ConstraintResult], mass: float) -> dict[str, float]:
    """Per cent of mass for one per cent of the limits of each kind of constraint, the largest first."""
    weight: dict[str, float] = {}
    for c in constraints:
        if c.active:
            weight[c.kind] = weight.get(c.kind, 0.0) + abs(c.shadow_price * c.limit) / mass
    return dict(sorted(weight.items(), key=lambda item: -item[1]))


def not_checked(study: Study) -> tuple[str, ...]:
    """What a result says nothing about, beside what its proof leaves out."""
    notes = []
    if study.required.decay is None:
        notes.append("decay of large disturbances on the nonlinear model (requirements.decay)")
    if study.required.limit_event == "simulated":
        notes.append(
            "ground handling: with limit_event 'simulated' the motions after the required disturbance are the only load; no "
            "towing, turning, braking or landing case sizes the parts"
        )
    if "I_arm" in study.variable_names and not study.material.has_fatigue_data:
        notes.insert(0, f"fatigue of the bending arm: no Basquin data for {study.material.name}")
    return tuple(notes)


def nothing_yet(study: Study) -> DesignResult:
    """What a result says before anything is found."""
    return DesignResult(
        status="failed",
        message="",
        study=study.name,
        topology=study.damper.topology,
        geometry=study.damper.geometry,
        material=study.material.name,
        stability_margin=study.required.stability_margin,
    )


def start_result(index: int, found: EnvelopeSolution) -> StartResult:
    """What became of one start."""
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


def local_optima(solved: Sequence[EnvelopeSolution]) -> tuple[LocalOptimum, ...]:
    """Different local optima, the lightest first."""
    optima: list[LocalOptimum] = []
    for found in sorted(solved, key=lambda found: found.solution.objective):
        mass = found.solution.objective
        if optima and mass <= optima[-1].mass * (1 + SAME_MASS):
            optima[-1] = optima[-1].model_copy(update={"starts": optima[-1].starts + 1})
        else:
            optima.append(LocalOptimum(mass=mass, starts=1, design=found.solution.design))
    return tuple(optima)


def infeasible_message(shortfalls: Sequence[Relaxation], alone: Sequence[Relaxation]) -> str:
    """What is missing, and what would be enough on its own."""
    text = f"no design was found that meets the requirements. Nearest: {missing_words(shortfalls)}."
    if alone:
        text += " Enough on its own: " + "; or ".join(_enough(r) for r in alone) + "."
    return text


def missing_words(shortfalls: Sequence[Relaxation]) -> str:
    """What is missing, and by how much."""
    return "; ".join(_short(r) for r in shortfalls)


def _short(r: Relaxation) -> str:
    place = "" if r.speed is None or r.load is None else f" at {r.speed:.4g} m/s, {r.load / 1e3:.4g} kN"
    return f"{r.name} can reach {r.needed:.4g} {r.unit}{place}, required {r.limit:.4g} (short by {abs(r.limit - r.needed):.2g})"


def _enough(r: Relaxation) -> str:
    return f"{r.name} of {r.needed:.4g} {r.unit} instead of {r.limit:.4g} ({', '.join(r.inputs)})"

"""Post-optimal sensitivity: what each number of the study is worth in mass, from the multipliers of the optimum."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..motion.decay import DecayAnalysis
from ..results import Sensitivity
from ..study.study import Study, unit_of
from .cuts import Cut
from .problem import DesignProblem
from .solve import LocalSolution

__all__ = ["sensitivities"]


def sensitivities(
    problem: DesignProblem, solution: LocalSolution, analysis: DecayAnalysis | None = None
) -> tuple[Sensitivity, ...]:
    """Derivatives of the optimal mass, the largest elasticity first.

    Parameters
    ----------
    problem : DesignProblem
    solution : LocalSolution
        A local optimum over the envelope.
    analysis : DecayAnalysis or None
        For studies with a decay requirement: the gradient of each active cut is taken from it.

    Returns
    -------
    tuple of Sensitivity
        For every number of gear, tyre, material, requirements and mass model with an effect, the ends of the speed
        range and the vertical loads.

    Notes
    -----
    The envelope theorem gives d mass/d p = d Lagrangian/d p. At a worst speed inside the range the speed itself has no
    first-order effect; at an end of the range it has, and that is the sensitivity to the end.
    """
    study, points = problem.study, solution.points
    simulated: dict[str, float] = {}  # by what moves the active cuts and the peaks, times what these are worth
    worth = [(cut, 0, m) for cut, m in zip(solution.cuts, solution.multipliers.cuts, strict=True)]
    worth += [(cut, 1 + k, w) for k, (cut, w) in enumerate(zip(solution.peaks, solution.gradient.peaks, strict=True))]
    for cut, row, weight in worth:
        if analysis is None or abs(weight) <= 1e-7 * solution.objective:
            continue
        design = study.damper.with_damping(solution.design, cut.place[2])
        for name, slope in analysis.data_gradient(design, cut.speed, cut.load).items():
            for key in _inputs(study, name, cut):
                simulated[key] = simulated.get(key, 0.0) + float(weight * slope[row])
    found = [
        (name, float(value), unit_of(study, name), float(slope) + simulated.get(name, 0.0))
        for name, value, slope in zip(problem.data_names, problem.data, solution.gradient.data, strict=True)
    ]
    for end in ("min", "max"):
        speed = getattr(study.envelope.speed, end)
        slope = sum(d for d, point in zip(solution.gradient.points[:, 0], points, strict=True) if point[0] == speed)
        name = f"envelope.speed.{end}"
        found.append((name, speed, "m/s", float(slope) + simulated.get(name, 0.0)))
    names: Sequence[Any] = ("min", "max") if study.envelope.load_is_range else range(len(study.envelope.loads))
    for name, load in zip(names, study.envelope.loads, strict=True):
        slope = sum(d for d, point in zip(solution.gradient.points[:, 1], points, strict=True) if point[1] == load)
        slope += solution.gradient.load_limit if load == problem.load_limit else 0.0
        single = len(study.envelope.loads) == 1
        slope += simulated.get(f"load {load}", 0.0)
        found.append(("envelope.vertical_load" + ("" if single else f".{name}"), load, "N", float(slope)))
    results = [
        Sensitivity(input=name, value=value, unit=unit, derivative=slope, elasticity=slope * value / solution.objective)
        for name, value, unit, slope in found
        if abs(slope) * abs(value) > 1e-7 * solution.objective or (value == 0 and slope != 0)
    ]
    return tuple(sorted(results, key=lambda s: -abs(s.elasticity)))


def _inputs(study: Study, name: str, cut: Cut) -> list[str]:
    """Inputs of the study that move a number of the simulation; a speed inside the range is a maximum and moves nothing."""
    if name == "speed":
        return [f"envelope.speed.{end}" for end in ("min", "max") if getattr(study.envelope.speed, end) == cut.speed]
    return [f"load {cut.load}"] if name == "load" else [name]

"""Post-optimal sensitivity: what each number of the study is worth in mass, from the multipliers of the optimum."""

from __future__ import annotations

from .problem import DesignProblem
from .results import Sensitivity
from .solve import LocalSolution
from .specs import unit_of

__all__ = ["sensitivities"]


def sensitivities(problem: DesignProblem, solution: LocalSolution) -> tuple[Sensitivity, ...]:
    """Derivatives of the optimal mass, the largest elasticity first.

    Parameters
    ----------
    problem : DesignProblem
    solution : LocalSolution
        A local optimum over the envelope.

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
    found = [
        (name, float(value), unit_of(study, name), float(slope))
        for name, value, slope in zip(problem.data_names, problem.data, solution.data_gradient, strict=True)
    ]
    for end in ("min", "max"):
        speed = getattr(study.envelope.speed, end)
        slope = sum(d for d, point in zip(solution.point_gradient[:, 0], points, strict=True) if point[0] == speed)
        found.append((f"envelope.speed.{end}", speed, "m/s", float(slope)))
    names = ("min", "max") if study.envelope.load_is_range else range(len(study.envelope.loads))
    for name, load in zip(names, study.envelope.loads, strict=True):
        slope = sum(d for d, point in zip(solution.point_gradient[:, 1], points, strict=True) if point[1] == load)
        slope += solution.load_limit_gradient if load == problem.load_limit else 0.0
        single = len(study.envelope.loads) == 1
        found.append(("envelope.vertical_load" + ("" if single else f".{name}"), load, "N", float(slope)))
    results = [
        Sensitivity(input=name, value=value, unit=unit, derivative=slope, elasticity=slope * value / solution.objective)
        for name, value, unit, slope in found
        if abs(slope) * abs(value) > 1e-7 * solution.objective or (value == 0 and slope != 0)
    ]
    return tuple(sorted(results, key=lambda s: -abs(s.elasticity)))

"""Worst points of an envelope over an interval of dampings: the factor on the damping is the third coordinate."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from scipy.optimize import minimize_scalar

from ..results import OperatingPoint
from ..study.study import Study
from .linear import LinearModel
from .worst import worst_points

__all__ = ["worst_over_damping"]


def worst_over_damping(
    model: LinearModel, study: Study, design: Mapping[str, float], enough: float = math.inf
) -> list[OperatingPoint]:
    """Local maxima of the spectral abscissa over speeds, loads and factors on the damping, the largest first.

    Parameters
    ----------
    model : LinearModel
        Of the study.
    study : Study
    design : mapping of str to float
        Design variables by name [SI].
    enough : float
        If the ends of the interval show an abscissa above this, their maxima are returned without looking between.

    Returns
    -------
    list of OperatingPoint
        Between the ends the peak of a row of factors is refined, which is no proof: `certify` is.
    """
    row = study.damper.dampings()

    def at(factor: float) -> list[OperatingPoint]:
        gear = model.at(study.damper.with_damping(design, factor))
        return [replace(point, damping=factor) for point in worst_points(gear, study.envelope, enough)]

    points = [point for factor in dict.fromkeys((row[0], row[-1])) for point in at(factor)]
    if len(row) > 1 and max(point.abscissa for point in points) <= enough:
        tops = [
            max(points, key=lambda p: p.abscissa if p.damping == f else -math.inf) if f in (row[0], row[-1]) else at(f)[0]
            for f in row
        ]
        points += tops[1:-1]
        i = max(range(len(row)), key=lambda k: tops[k].abscissa)
        if 0 < i < len(row) - 1:
            bounds = math.log(row[i - 1]), math.log(row[i + 1])
            best = minimize_scalar(
                lambda x: -at(math.exp(x))[0].abscissa, bounds=bounds, method="bounded", options={"xatol": 1e-5, "maxiter": 16}
            )
            points.append(at(math.exp(best.x))[0])
    return sorted(points, key=lambda point: -point.abscissa)

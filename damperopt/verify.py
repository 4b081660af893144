"""Numerical check of a design, independent of problem and solver: true eigenvalues on a dense grid of the envelope."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .results import OperatingPoint
from .specs import Study
from .stability import linear_gear

__all__ = ["GridCheck", "check_grid"]


@dataclass(frozen=True)
class GridCheck:
    """Outcome of `check_grid`.

    Attributes
    ----------
    passed : bool
        No eigenvalue on the grid lies right of -margin.
    speeds, loads : int
        Size of the grid.
    worst : OperatingPoint
        Where the spectral abscissa is largest.
    """

    passed: bool
    speeds: int
    loads: int
    worst: OperatingPoint


def check_grid(study: Study, design: Mapping[str, float]) -> GridCheck:
    """Eigenvalues (`numpy.linalg.eigvals`) at `solver.verification_speeds` speeds and every load.

    Parameters
    ----------
    study : Study
        With requirements.
    design : mapping
        Design variables by name [SI].

    Returns
    -------
    GridCheck
        A load range is sampled at 21 loads; half of the speeds are spaced evenly, half geometrically.
    """
    envelope, count = study.envelope, study.solver.verification_speeds
    low, high = envelope.speed.min, envelope.speed.max
    speeds = np.union1d(np.linspace(low, high, count // 2 + 1), np.geomspace(low, high, count // 2 + 1))
    speeds = np.clip(speeds, low, high)
    loads = np.linspace(envelope.loads[0], envelope.loads[-1], 21) if envelope.load_is_range else np.array(envelope.loads)
    V, F_z = (grid.ravel() for grid in np.meshgrid(speeds, loads))
    abscissa = linear_gear(study, design).abscissa(V, F_z)
    top = int(abscissa.argmax())
    worst = OperatingPoint(float(V[top]), float(F_z[top]), float(abscissa[top]))
    return GridCheck(worst.abscissa <= -study.required.stability_margin, len(speeds), len(loads), worst)

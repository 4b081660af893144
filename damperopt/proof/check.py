"""Numerical checks of a design, independent of problem and solver: true eigenvalues, and exact simulations."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from ..motion.exact import ExactSimulator
from ..motion.measure import PEAKS, decay, fastest_rate, latest_count, loads_of, slowest_rate
from ..motion.trajectory import Trajectory
from ..results import DecayCheck, OperatingPoint
from ..stability.linear import LinearModel
from ..study.study import Study

__all__ = ["GridCheck", "check_damping", "check_decay", "check_grid"]

PER_CYCLE = 64
"""Output points in a cycle of the fastest mode."""

MORE_CYCLES = 3
"""Cycles that are simulated beyond those counted."""

TOLERANCE = 1e-9
"""Of the exact simulation, relative."""


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


def check_grid(study: Study, design: Mapping[str, float], model: LinearModel | None = None) -> GridCheck:
    """Eigenvalues (`numpy.linalg.eigvals`) at `solver.verification_speeds` speeds and every load.

    Parameters
    ----------
    study : Study
        With requirements.
    design : mapping
        Design variables by name [SI].
    model : LinearModel or None
        Of the study, if it is at hand.

    Returns
    -------
    GridCheck
        A load range is sampled at 21 loads; half of the speeds are spaced evenly, half geometrically; an interval of dampings
        is sampled at 7.
    """
    envelope, count = study.envelope, study.solver.verification_speeds
    low, high = envelope.speed.min, envelope.speed.max
    speeds = np.union1d(np.linspace(low, high, count // 2 + 1), np.geomspace(low, high, count // 2 + 1))
    speeds, model = np.clip(speeds, low, high), model or LinearModel(study)
    loads = np.linspace(envelope.loads[0], envelope.loads[-1], 21) if envelope.load_is_range else np.array(envelope.loads)
    V, F_z = (grid.ravel() for grid in np.meshgrid(speeds, loads))
    found = []
    for factor in study.damper.dampings():
        abscissa = model.at(study.damper.with_damping(design, factor)).abscissa(V, F_z)
        top = int(abscissa.argmax())
        found.append(OperatingPoint(float(V[top]), float(F_z[top]), float(abscissa[top]), factor))
    worst = max(found, key=lambda point: point.abscissa)
    return GridCheck(worst.abscissa <= -study.required.stability_margin, len(speeds), len(loads), worst)


def check_damping(
    study: Study, design: Mapping[str, float], model: LinearModel | None = None
) -> tuple[float, float, float, float]:
    """Least damping ratio of the yaw mode on the grid of `check_grid`, with the speed and load where it is.

    Parameters
    ----------
    study : Study
    design : mapping
        Design variables by name [SI].
    model : LinearModel or None
        Of the study, if it is at hand.

    Returns
    -------
    tuple of float
        Ratio, speed [m/s], load [N], factor on the damping; the mode is the oscillation in whose participation factors angle
        and rate of yaw have the largest share, found anew at each point.
    """
    model, envelope = model or LinearModel(study), study.envelope
    speeds = np.geomspace(envelope.speed.min, envelope.speed.max, study.solver.verification_speeds)
    least = (math.inf, math.nan, math.nan, math.nan)
    for factor, load in itertools.product(study.damper.dampings(), envelope.loads):
        gear = model.at(study.damper.with_damping(design, factor))
        angle, rate = gear.index("yaw_angle"), gear.index("yaw_rate")
        for V, A in zip(speeds, gear.matrices(speeds, load), strict=True):
            roots, modes = np.linalg.eig(A)
            parts = np.abs(np.linalg.solve(modes, np.eye(len(A)))) * np.abs(modes).T  # of each state, in each mode
            shares = parts[:, [angle, rate]].sum(axis=1) / parts.sum(axis=1)
            found = [(shares[i], -roots[i].real / abs(roots[i])) for i in range(len(roots)) if roots[i].imag > 0]
            if found and max(found)[1] < least[0]:
                least = (float(max(found)[1]), float(V), load, factor)
    return least


def check_decay(
    study: Study,
    design: Mapping[str, float],
    points: Sequence[tuple[float, float, float]] = (),
    simulator: ExactSimulator | None = None,
) -> DecayCheck:
    """Decay by exact simulation, on twice as many speeds as the optimiser has looked at, and refined at the worst.

    Parameters
    ----------
    study : Study
        With a decay requirement.
    design : mapping
        Design variables by name [SI].
    points : sequence of (speed, load, damping factor)
        Where to look besides [m/s], [N].
    simulator : ExactSimulator or None
        Of the study, if it is at hand.

    Returns
    -------
    DecayCheck
        With `optimised` equal to `ratio`, for the caller to fill. Of an interval of dampings, both ends and the middle.
    """
    required, envelope = study.required.decay, study.envelope
    assert required is not None
    simulator, damper, made = simulator or ExactSimulator(study), study.damper, 0
    runs: dict[float, ExactSimulator] = {}

    peaks = dict.fromkeys(PEAKS, 0.0)

    def ratio(speed: float, load: float, factor: float) -> float:
        nonlocal made
        made += 1
        if factor not in runs:
            runs[factor] = simulator.with_design(damper.with_damping(design, factor))
        found, motion = _exact_ratio(runs[factor], speed, load)
        for name in PEAKS:
            peaks[name] = max(peaks[name], float(np.abs(motion[name]).max()))
        return found

    low, high = envelope.speed.min, envelope.speed.max
    if required.speeds is not None:
        speeds = np.array(required.speeds)
    else:
        speeds = np.unique(np.clip(np.geomspace(low, high, 2 * study.solver.decay_speeds), low, high))
    grid = [(float(V), load, factor) for factor in damper.dampings(1) for load in loads_of(study) for V in speeds]
    grid += points
    found = {point: ratio(*point) for point in grid}
    (speed, load, factor), largest = max(found.items(), key=lambda item: item[1])
    if required.speeds is None and low < high and largest < math.inf:
        around = [V for V, _, _ in found if speed != V]
        bounds = max([low, *(V for V in around if speed > V)]), min([high, *(V for V in around if speed < V)])
        best = minimize_scalar(
            lambda V: -ratio(float(V), load, factor),
            bounds=bounds,
            method="bounded",
            options={"xatol": 1e-4 * high, "maxiter": 8},
        )
        speed, largest = max((speed, largest), (float(best.x), -float(best.fun)), key=lambda pair: pair[1])
    kept = largest <= required.ratio
    return DecayCheck(kept, required.ratio, required.cycles, speed, load, largest, largest, made, peaks, damping=factor)


def _exact_ratio(simulator: ExactSimulator, speed: float, load: float) -> tuple[float, Trajectory]:
    """Decay ratio at one speed and load, infinite where the motion leaves the validity of the model, and the motion."""
    required = simulator.study.required.decay
    assert required is not None
    A, names = simulator.gear.visible(speed, load)
    latest = latest_count(A, required.cycles, names)
    duration = (required.cycles + MORE_CYCLES) * 2 * math.pi / slowest_rate(A, names)
    while True:
        points = math.ceil(duration * fastest_rate(A) / (2 * math.pi) * PER_CYCLE)
        motion = simulator(speed, load, required.disturbance, duration, TOLERANCE, points)
        if motion.status == "stopped":
            return math.inf, motion
        found = decay(motion.time, motion["yaw_angle"], motion["yaw_rate"], required.cycles, latest)
        if found is not None:
            return found.ratio, motion
        duration *= 2

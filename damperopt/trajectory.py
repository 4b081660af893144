"""A trajectory and what it shows: cycles, decay, peaks, and whether it settles, cycles or diverges."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from scipy.interpolate import CubicHermiteSpline, CubicSpline

__all__ = ["TRAJECTORY_UNITS", "Decay", "Motion", "Trajectory", "crossings", "decay", "extrema", "motion_of"]

Kind: TypeAlias = Literal["settled", "decaying", "limit cycle", "growing", "diverging"]

STEADY = 2e-3
"""Relative change of the amplitude per cycle below which a motion counts as a limit cycle."""

SETTLED = 1e-2
"""Fraction of the largest amplitude below which a decaying motion counts as settled."""

TRAJECTORY_UNITS = {
    "time": "s",
    "yaw_angle": "rad",
    "yaw_rate": "rad/s",
    "yaw_acceleration": "rad/s^2",
    "bending_angle": "rad",
    "bending_rate": "rad/s",
    "string_deflection": "m",
    "dashpot_stroke": "m",
    "link_angle": "rad",
    "damper_stroke": "m",
    "damper_speed": "m/s",
    "damper_force": "N",
    "spring_deflection": "m",
    "spring_force": "N",
    "stop_force": "N",
    "linkage_torque": "N m",
    "torque_without_friction": "N m",
    "slip_angle": "rad",
    "side_force": "N",
    "aligning_moment": "N m",
    "lateral_displacement": "m",
    "arm_stress": "Pa",
    "unclosed": "m",
}
"""SI unit of every state and output; for a damper given about the yaw axis strokes are angles and forces torques."""

NEWTON_STEPS = 6

ROUNDING = 1e-9
"""Amplitude [rad] that is nothing but integration error."""


@dataclass(frozen=True)
class Trajectory:
    """Motion of the gear after a disturbance.

    Attributes
    ----------
    speed, load : float
        [m/s], [N]
    time : ndarray
        (n,) [s]
    states, outputs : dict of str to ndarray
        (n,) each [SI]: the states of the model, and forces, strokes, slip and stress.
    status : str
        ``completed``, or ``stopped`` where the model left its validity.
    message : str
        Why it stopped; empty if completed.
    engine : str
        Integrator.
    """

    speed: float
    load: float
    time: np.ndarray
    states: Mapping[str, np.ndarray]
    outputs: Mapping[str, np.ndarray]
    status: Literal["completed", "stopped"]
    message: str
    engine: str

    def __getitem__(self, name: str) -> np.ndarray:
        """State or output by name."""
        return self.states[name] if name in self.states else self.outputs[name]


@dataclass(frozen=True)
class Motion:
    """What a trajectory shows.

    Attributes
    ----------
    kind : str
        ``settled``, ``decaying``, ``limit cycle``, ``growing`` or ``diverging`` (it left the validity of the model).
    cycles : float
        Cycles of the yaw angle that were completed, from its first extremum.
    decay_ratio : float or None
        Largest yaw angle in magnitude after m cycles over the first extremum; None if there were fewer cycles.
    amplitude, frequency : float
        Of the yaw angle at the end: half the peak-to-peak value [rad], [Hz].
    mean : float
        Middle between the last two extrema [rad]: not zero where the motion is asymmetric.
    peaks : dict of str to float
        Largest magnitude of every state and output [SI].
    """

    kind: Kind
    cycles: float
    decay_ratio: float | None
    amplitude: float
    frequency: float
    mean: float
    peaks: dict[str, float]


def crossings(time: np.ndarray, value: np.ndarray, slope: np.ndarray) -> np.ndarray:
    """Times at which a function passes through zero.

    Parameters
    ----------
    time, value, slope : ndarray
        (n,) samples of the function and of its derivative.

    Returns
    -------
    ndarray
        Of the cubic Hermite interpolant, after the first sample.

    Examples
    --------
    >>> t = np.linspace(0, 10, 200)
    >>> (crossings(t, np.cos(t), -np.sin(t)) / np.pi).round(6).tolist()
    [0.5, 1.5, 2.5]
    """
    left = np.flatnonzero((value[:-1] * value[1:] < 0) | ((value[1:] == 0) & (value[:-1] != 0)))
    h = time[left + 1] - time[left]
    y0, y1, d0, d1 = value[left], value[left + 1], h * slope[left], h * slope[left + 1]
    # the cubic on [0, 1] by powers of u, its zero by Newton's method from the chord
    b, a = 3 * (y1 - y0) - 2 * d0 - d1, 2 * (y0 - y1) + d0 + d1
    u = y0 / (y0 - y1)
    for _ in range(NEWTON_STEPS):
        tangent = (3 * a * u + 2 * b) * u + d0
        u = np.clip(u - (((a * u + b) * u + d0) * u + y0) / np.where(tangent == 0, np.inf, tangent), 0.0, 1.0)
    return time[left] + u * h


def extrema(time: np.ndarray, value: np.ndarray, rate: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Extrema of a function inside its samples.

    Parameters
    ----------
    time, value, rate : ndarray
        (n,) samples of the function and of its derivative; fewer than three show no extremum.

    Returns
    -------
    tuple of ndarray
        Times, and values from the cubic Hermite interpolant. An error of the time hardly matters to the value there, but
        it does to the sensitivities that are read at that time: a spline gives the slope of the rate to fourth order.
    """
    if time.size < 3:
        return np.zeros(0), np.zeros(0)
    times = crossings(time, rate, CubicSpline(time, rate)(time, 1))
    return times, CubicHermiteSpline(time, value, rate)(times)


@dataclass(frozen=True)
class Decay:
    """Decay of an oscillation, and where it was read.

    Attributes
    ----------
    ratio : float
        Largest |value| after the cycles over the first extremum.
    first, last : float
        Times of the first extremum and of the largest |value| [s].
    counted : bool
        False where the cycles were not completed before `latest`; `last` may then be `latest` itself.
    """

    ratio: float
    first: float
    last: float
    counted: bool


def decay(
    time: np.ndarray,
    value: np.ndarray,
    rate: np.ndarray,
    cycles: int,
    latest: float = np.inf,
) -> Decay | None:
    """Decay over m cycles: the largest magnitude after the 2m-th zero that follows the first extremum, over that extremum.

    Parameters
    ----------
    time, value, rate : ndarray
        (n,) samples of an oscillation and of its derivative; starting at rest counts as an extremum.
    cycles : int
        m
    latest : float
        Time [s] from which the decay is taken at the latest, for motions so damped that they hardly oscillate.

    Returns
    -------
    Decay or None
        None where the samples end before the extremum that follows.

    Examples
    --------
    >>> t = np.linspace(0, 4, 2000)
    >>> s = -0.5 + 2j * np.pi
    >>> z = np.exp(s * t) * (1 - 0.5j / np.pi / 2)  # released at rest
    >>> found = decay(t, z.real, (s * z).real, cycles=3)
    >>> round(found.ratio, 6) == round(float(np.exp(-1.5)), 6)
    True
    """
    zeros = crossings(time, value, rate)
    turns, heights = extrema(time, value, rate)
    if abs(rate[0]) <= 1e-12 * np.abs(rate).max() and value[0] != 0:
        turns, heights = np.append(time[0], turns), np.append(value[0], heights)
    if not turns.size:
        return None
    zeros = zeros[zeros > turns[0]]
    counted = zeros.size >= 2 * cycles and zeros[2 * cycles - 1] <= latest
    start = zeros[2 * cycles - 1] if counted else latest
    times, candidates = turns[turns > start], heights[turns > start]
    if not counted and time[-1] >= latest:
        times = np.append(times, latest)
        candidates = np.append(candidates, CubicHermiteSpline(time, value, rate)(latest))
    if not times.size:
        return None
    peak = np.abs(candidates).argmax()
    return Decay(float(abs(candidates[peak] / heights[0])), float(turns[0]), float(times[peak]), bool(counted))


def motion_of(trajectory: Trajectory, cycles: int = 3) -> Motion:
    """Cycles, decay, peaks and kind of a motion, from its yaw angle.

    Parameters
    ----------
    trajectory : Trajectory
    cycles : int
        m, after which the decay is taken.

    Returns
    -------
    Motion
    """
    t, psi, rate = trajectory.time, trajectory["yaw_angle"], trajectory["yaw_rate"]
    zeros = crossings(t, psi, rate)
    turns, values = extrema(t, psi, rate)
    if rate[0] == 0 and psi[0] != 0:
        turns, values = np.append(t[0], turns), np.append(psi[0], values)
    peaks = {name: float(np.abs(v).max()) for name, v in {**trajectory.states, **trajectory.outputs}.items()}
    counted = zeros[zeros > turns[0]] if turns.size else zeros[:0]
    found = decay(t, psi, rate, cycles)
    ratio = found.ratio if found else None
    amplitudes, middles = np.abs(np.diff(values)) / 2, (values[1:] + values[:-1]) / 2
    done = max(counted.size - 1, 0) / 2
    if amplitudes.size < 6:
        end = psi[-max(len(psi) // 10, 2) :]
        last = float(np.abs(end).max())
        ends: Kind = "diverging" if trajectory.status == "stopped" else _kind_of_ends(end, float(np.abs(psi).max()))
        return Motion(ends, done, ratio, last, 0.0, 0.0, peaks)
    recent = slice(-max(6, min(20, amplitudes.size // 3)), None)
    per_cycle = 2 * np.polyfit(np.arange(amplitudes[recent].size), np.log(amplitudes[recent] + 1e-300), 1)[0]
    frequency = (turns[recent].size - 1) / 2 / (turns[recent][-1] - turns[recent][0])
    amplitude, largest = float(amplitudes[-1]), float(amplitudes.max())
    kind: Kind
    if trajectory.status == "stopped":
        kind = "diverging"
    elif amplitude < ROUNDING:
        kind = "settled"
    elif abs(per_cycle) < STEADY and np.ptp(amplitudes[recent]) < 0.02 * amplitude:
        kind = "limit cycle"
    elif per_cycle > 0:
        kind = "growing"
    else:
        kind = "settled" if amplitude < SETTLED * largest else "decaying"
    return Motion(kind, done, ratio, amplitude, float(frequency), float(middles[-1]), peaks)


def _kind_of_ends(end: np.ndarray, largest: float) -> Kind:
    """Kind of a motion with too few cycles to judge by its extrema, from its last tenth."""
    if np.ptp(end) < SETTLED * largest:  # at rest, be it away from zero
        return "settled"
    return "growing" if np.abs(end).max() == largest else "decaying"

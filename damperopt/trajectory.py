"""A trajectory and what it shows: cycles, decay, peaks, and whether it settles, cycles or diverges."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

__all__ = ["Motion", "Trajectory", "crossings", "extrema", "motion_of"]

Kind: TypeAlias = Literal["settled", "decaying", "limit cycle", "growing", "diverging"]

STEADY = 2e-3
"""Relative change of the amplitude per cycle below which a motion counts as a limit cycle."""

SETTLED = 1e-2
"""Fraction of the largest amplitude below which a decaying motion counts as settled."""

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
        Largest |yaw| after m cycles over the first extremum; None if there were fewer cycles.
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
        From the cubic Hermite interpolant of each interval in which the sign changes.

    Examples
    --------
    >>> t = np.linspace(0, 10, 200)
    >>> (crossings(t, np.cos(t), -np.sin(t)) / np.pi).round(6).tolist()
    [0.5, 1.5, 2.5]
    """
    left = np.flatnonzero((value[:-1] == 0) | (value[:-1] * value[1:] < 0))
    left = left[~((value[left] == 0) & (time[left] == time[0]))]
    h = time[left + 1] - time[left]
    low, high = np.zeros(left.size), np.ones(left.size)
    start = np.sign(value[left])
    start[start == 0] = -np.sign(slope[left][start == 0])
    for _ in range(52):  # bisection: every bit of the fraction of the interval
        middle = (low + high) / 2
        before = np.sign(_hermite(middle, value[left], value[left + 1], h * slope[left], h * slope[left + 1])) == start
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return time[left] + (low + high) / 2 * h


def extrema(time: np.ndarray, value: np.ndarray, rate: np.ndarray, acceleration: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Extrema of a function inside its samples.

    Parameters
    ----------
    time, value, rate, acceleration : ndarray
        (n,) samples of the function and of its first two derivatives.

    Returns
    -------
    tuple of ndarray
        Times, and values from the cubic Hermite interpolant.
    """
    times = crossings(time, rate, acceleration)
    i = np.clip(np.searchsorted(time, times, "right") - 1, 0, time.size - 2)
    h = time[i + 1] - time[i]
    return times, _hermite((times - time[i]) / h, value[i], value[i + 1], h * rate[i], h * rate[i + 1])


def _hermite(u, left, right, left_slope, right_slope):
    """Cubic on [0, 1] from values and slopes at its ends."""
    bulge = (1 - u) * (left_slope - (right - left)) - u * (right_slope - (right - left))
    return left + u * (right - left) + u * (1 - u) * bulge


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
    turns, values = extrema(t, psi, rate, trajectory["yaw_acceleration"])
    if rate[0] == 0 and psi[0] != 0:
        turns, values = np.append(t[0], turns), np.append(psi[0], values)
    peaks = {name: float(np.abs(v).max()) for name, v in {**trajectory.states, **trajectory.outputs}.items()}
    counted = zeros[zeros > turns[0]] if turns.size else zeros[:0]
    ratio = None
    if counted.size >= 2 * cycles and (turns > counted[2 * cycles - 1]).any():
        ratio = float(np.abs(psi[t >= counted[2 * cycles - 1]]).max() / abs(values[0]))
    amplitudes, middles = np.abs(np.diff(values)) / 2, (values[1:] + values[:-1]) / 2
    done = max(counted.size - 1, 0) / 2
    if amplitudes.size < 6:
        last = float(np.abs(psi[-max(len(psi) // 10, 2) :]).max())
        ends: Kind = "diverging" if trajectory.status == "stopped" else _kind_of_ends(last, float(np.abs(psi).max()))
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


def _kind_of_ends(last: float, largest: float) -> Kind:
    """Kind of a motion with too few cycles to judge by its extrema."""
    if last < SETTLED * largest:
        return "settled"
    return "growing" if last == largest else "decaying"

"""What decay, cycles and peaks of a motion are; the search and its check both measure by these, and share nothing else."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from ..study.study import Study

__all__ = [
    "PEAKS",
    "Decay",
    "crossings",
    "decay",
    "extrema",
    "fastest_rate",
    "latest_count",
    "loads_of",
    "slowest_rate",
    "yaw_frequency",
]

PEAKS = ("linkage_torque", "yaw_angle", "damper_stroke", "damper_force", "spring_force")
"""What sizes the parts where `requirements.limit_event` is ``simulated``."""


NEWTON_STEPS = 6

CREEPING = 1.0
"""Rate [rad/s] below which a mode is a creep and sets no time scale."""

EVEN_IF_SLOW = 20.0
"""Rate [rad/s] that time steps follow even where every mode is slower."""

YAW = ("yaw_angle", "yaw_rate")


def yaw_frequency(state_matrix: np.ndarray, state_names: Sequence[str]) -> float:
    """Circular frequency [rad/s] of the yaw angle with all else at rest, at least `CREEPING`."""
    angle, rate = (state_names.index(name) for name in YAW)
    return math.sqrt(max(-state_matrix[rate, angle], CREEPING**2))


def fastest_rate(state_matrix: np.ndarray) -> float:
    """Largest circular frequency [rad/s] of the modes, at least `EVEN_IF_SLOW`: what time steps must follow."""
    return float(max(np.abs(np.linalg.eigvals(state_matrix).imag).max(), EVEN_IF_SLOW))


def slowest_rate(state_matrix: np.ndarray, state_names: Sequence[str]) -> float:
    """Least circular frequency [rad/s] of the modes that oscillate, and of the yaw angle alone: what a cycle may last."""
    rates = np.abs(np.linalg.eigvals(state_matrix).imag)
    return float(min([yaw_frequency(state_matrix, state_names), *rates[rates > CREEPING]]))


def latest_count(state_matrix: np.ndarray, cycles: int, state_names: Sequence[str]) -> float:
    """Time [s] from which the decay is taken at the latest: twice m periods of the yaw mode with all else at rest."""
    return 2 * cycles * 2 * math.pi / yaw_frequency(state_matrix, state_names)


def loads_of(study: Study) -> tuple[float, ...]:
    """Loads at which decay is looked at [N]: those of the list, or five over a range."""
    envelope = study.envelope
    if not envelope.load_is_range:
        return envelope.loads
    return tuple(np.linspace(envelope.loads[0], envelope.loads[1], 5).tolist())


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

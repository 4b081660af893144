"""What a motion along a history shows: peaks with where they were, and when the gear could shimmy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .history import Frozen
from .trajectory import Trajectory

__all__ = ["Peak", "Roll", "Stretch", "roll_of"]


@dataclass(frozen=True)
class Peak:
    """Largest magnitude of a state or output [SI], and where it was."""

    name: str
    value: float
    time: float
    speed: float
    load: float


@dataclass(frozen=True)
class Stretch:
    """A part of a history, by its ends: times [s], speeds [m/s], loads [N]."""

    time: tuple[float, float]
    speed: tuple[float, float]
    load: tuple[float, float]


@dataclass(frozen=True)
class Roll:
    """What a motion along a history shows.

    Attributes
    ----------
    peaks : dict of str to Peak
        Of every state and output.
    margin : float
        Stability margin that the study asks for [1/s]; 0 where it asks for none.
    unstable, below : tuple of Stretch
        Where the gear with time held is unstable, and where it keeps less than the margin (these included).
    worst : float
        Largest spectral abscissa of the gear with time held [1/s], and
    worst_at : Peak
        where it is.
    """

    peaks: dict[str, Peak]
    margin: float
    unstable: tuple[Stretch, ...]
    below: tuple[Stretch, ...]
    worst: float
    worst_at: Peak


def roll_of(trajectory: Trajectory, frozen: Frozen, margin: float) -> Roll:
    """Of a trajectory along a history.

    Parameters
    ----------
    trajectory : Trajectory
    frozen : Frozen
        The gear with time held, along the same history.
    margin : float
        [1/s]

    Returns
    -------
    Roll
    """
    t, V, F = trajectory.time, trajectory["speed"], trajectory["vertical_load"]
    peaks = {}
    for name, values in {**trajectory.states, **trajectory.outputs}.items():
        k = int(np.abs(values).argmax())
        peaks[name] = Peak(name, float(abs(values[k])), float(t[k]), float(V[k]), float(F[k]))
    k = int(frozen.abscissa.argmax())
    worst = float(frozen.abscissa[k])
    at = Peak("spectral_abscissa", worst, float(frozen.time[k]), float(frozen.speed[k]), float(frozen.load[k]))
    unstable, below = (_stretches(frozen, frozen.beyond(level)) for level in (0.0, margin))
    return Roll(peaks, margin, unstable, below, worst, at)


def _stretches(frozen: Frozen, intervals: Sequence[tuple[float, float]]) -> tuple[Stretch, ...]:
    def ends(of: np.ndarray, interval: tuple[float, float]) -> tuple[float, float]:
        first, last = np.interp(interval, frozen.time, of)
        return float(first), float(last)

    return tuple(Stretch(i, ends(frozen.speed, i), ends(frozen.load, i)) for i in intervals)

"""A trajectory and what it shows: cycles, decay, peaks, and whether it settles, cycles or diverges."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np

from .measure import crossings, decay, extrema

__all__ = ["Motion", "Trajectory", "motion_of"]

Kind: TypeAlias = Literal["settled", "decaying", "limit cycle", "forced response", "growing", "diverging"]

STEADY = 2e-3
"""Relative change of the amplitude per cycle below which a motion counts as a limit cycle."""

SETTLED = 1e-2
"""Fraction of the largest amplitude below which a decaying motion counts as settled."""

BEAT = 0.02
"""Relative rise and fall of the amplitude from which it counts as beating, and not as one that changes steadily."""

NEAR = 1e-2
"""Relative change of the amplitude per cycle below which a motion can be on its way into a cycle, and"""

VANISHING = 0.25
"""part of that change that may be left when it is extrapolated: 0 for an amplitude that tends to a limit, 1 for an exponential
decay, 2/3 for one that goes with the reciprocal of time."""

SAME_FREQUENCY = 0.02
"""Relative; a motion at the frequency of what drives it."""

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
    forcing : float
        Frequency [Hz] at which the gear is driven; 0: by nothing.
    units : mapping of str to str
        SI unit of the time and of every state and output, as the components declare them.
    along : str
        The history that speed and load follow, in words; they are outputs then, and `speed`, `load` those at the start.
    """

    speed: float
    load: float
    time: np.ndarray
    states: Mapping[str, np.ndarray]
    outputs: Mapping[str, np.ndarray]
    status: Literal["completed", "stopped"]
    message: str
    engine: str
    forcing: float = 0.0
    units: Mapping[str, str] = field(default_factory=dict)
    along: str = ""

    def __getitem__(self, name: str) -> np.ndarray:
        """State or output by name."""
        return self.states[name] if name in self.states else self.outputs[name]


@dataclass(frozen=True)
class Motion:
    """What a trajectory shows.

    Attributes
    ----------
    kind : str
        ``settled``, ``decaying``, ``limit cycle``, ``forced response`` (at the frequency that drives it),
        ``growing`` or ``diverging`` (it left the validity of the model). Where the amplitude beats, its peaks count.
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
    frequency = float((turns[recent].size - 1) / 2 / (turns[recent][-1] - turns[recent][0]))
    amplitude = float(amplitudes[-1])
    kind: Kind
    if trajectory.status == "stopped":
        kind = "diverging"
    elif amplitude < ROUNDING:
        kind = "settled"
    else:
        kind = _kind_of_amplitudes(amplitudes)
        driven = abs(frequency - trajectory.forcing) < SAME_FREQUENCY * trajectory.forcing
        kind = "forced response" if driven and kind != "growing" else kind
    return Motion(kind, done, ratio, amplitude, frequency, float(middles[-1]), peaks)


def _kind_of_amplitudes(amplitudes: np.ndarray) -> Kind:
    """Kind of a motion from its amplitudes, one for each half cycle."""
    index, heights = _envelope(amplitudes)
    beating = index.size < amplitudes.size
    count = max(2, (index.size + 1) // 2) if beating else max(6, min(20, index.size // 3))
    index, heights = index[-count:], heights[-count:]
    per_cycle = 2 * np.polyfit(index, np.log(heights + 1e-300), 1)[0]
    steady = abs(per_cycle) < STEADY and np.ptp(heights) < 0.02 * heights[-1]
    if steady or (not beating and _tends_to_a_limit(amplitudes)):
        return "limit cycle"
    if per_cycle > 0 and (beating or _rises_for_long(amplitudes)):
        return "growing"
    return "settled" if heights[-1] < SETTLED * amplitudes.max() else "decaying"


def _envelope(amplitudes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Numbers and values of the peaks of a beating amplitude; all amplitudes where it does not beat, or no longer does."""
    from scipy.signal import find_peaks  # a third of a second to import

    peaks, _ = find_peaks(np.log(amplitudes + 1e-300), prominence=BEAT)
    if peaks.size < 2 or amplitudes.size - 1 - peaks[-1] > 1.5 * (peaks[-1] - peaks[-2]):
        return np.arange(amplitudes.size), amplitudes
    return peaks, amplitudes[peaks]


def _tends_to_a_limit(amplitudes: np.ndarray) -> bool:
    """Whether the amplitude changes little, and ever less: extrapolated, its logarithmic change per cycle vanishes."""
    part = np.log(amplitudes[-(amplitudes.size // 6 * 3) :] + 1e-300)
    third = part.size // 3
    if third < 4:
        return False
    early, middle, late = (2 * np.polyfit(np.arange(third), part[i * third :][:third], 1)[0] for i in range(3))
    first, second = middle - early, late - middle
    if abs(late) > NEAR or first * second <= 0 or abs(second) >= abs(first) or late * second >= 0:
        return False
    limit = late - second**2 / (second - first)
    return bool(abs(limit) < VANISHING * abs(late))


def _rises_for_long(amplitudes: np.ndarray) -> bool:
    """Whether a rise is more than the first half of a beat: it has exceeded all before, or lasts half of the motion."""
    lowest = int(amplitudes[: amplitudes.size - 1].argmin())
    return bool(amplitudes[-1] >= amplitudes.max() or amplitudes.size - 1 - lowest >= amplitudes.size / 2)


def _kind_of_ends(end: np.ndarray, largest: float) -> Kind:
    """Kind of a motion with too few cycles to judge by its extrema, from its last tenth."""
    if np.ptp(end) < SETTLED * largest:  # at rest, be it away from zero
        return "settled"
    return "growing" if np.abs(end).max() == largest else "decaying"

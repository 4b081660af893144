"""A limit cycle and what it shows: period, amplitudes, peaks, stability; and branches of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from ..motion.question import valid_part
from .collocation import Leg, Path
from .floquet import multipliers
from .newton import Corrected

__all__ = ["Branch", "Orbit", "orbit_of"]

PER_INTERVAL = 8
"""Points at which an orbit is looked at in each interval; extrema are those of parabolas through three of them."""

UNKNOWN_STEPS = 3
"""Of Newton's method for the unknowns between stages."""

LOST = ("lost", "another order", "the most orbits")
"""Words of ends at which a branch goes on, unseen."""

NEUTRAL = 1e-9
"""By which a multiplier must exceed 1 to count as growing: rounding."""


@dataclass(frozen=True)
class Orbit:
    """One limit cycle.

    Attributes
    ----------
    parameter : float
        Value of what is varied [SI].
    period : float
        [s]
    amplitudes, peaks, means : mapping of str to float
        Half the peak-to-peak value, the largest magnitude and the middle between the extremes of every state and output [SI].
    multipliers : ndarray
        (n - 1,) of Floquet, the largest first.
    label : str
        What is special here: ``fold``, ``Neimark-Sacker``, ``period doubling``, ``loss of symmetry``, or nothing.
    beyond : str
        Why the model is not valid for it, in words; empty where it is.
    path : Path
        Its states.
    """

    parameter: float
    period: float
    amplitudes: Mapping[str, float]
    peaks: Mapping[str, float]
    means: Mapping[str, float]
    multipliers: np.ndarray
    label: str
    beyond: str
    path: Path = field(repr=False, compare=False)

    @property
    def frequency(self) -> float:
        """[Hz]"""
        return 1 / self.period

    @property
    def unstable(self) -> int:
        """Multipliers outside the unit circle."""
        return int((np.abs(self.multipliers) > 1 + NEUTRAL).sum())

    @property
    def stable(self) -> bool:
        """Whether small disturbances die."""
        return self.unstable == 0

    def time_and_states(self, count: int = 200) -> tuple[np.ndarray, np.ndarray]:
        """Times [s] (k,) and states (k, n) over a whole cycle."""
        return _whole(self.path, count)


@dataclass(frozen=True)
class Branch:
    """Limit cycles that belong together.

    Attributes
    ----------
    name, unit : str
        Of what is varied.
    orbits : tuple of Orbit
        In order along the branch.
    begins, ends : str
        In words.
    kind : str
        ``hopf``: joints closed, from a critical value; ``simulation``: joints as they are, from a motion.
    error : float
        Relative change of amplitude and period of some orbits when their intervals are halved.
    multiplier_error : float
        Change of the largest multiplier then: nearer to 1, stability is not known.
    """

    name: str
    unit: str
    orbits: tuple[Orbit, ...]
    begins: str
    ends: str
    kind: Literal["hopf", "simulation"]
    error: float
    multiplier_error: float

    @property
    def lost(self) -> bool:
        """Whether an end of it is where the method failed, and not where the branch ends or leaves the range."""
        return any(word in self.begins + self.ends for word in LOST)

    @property
    def special(self) -> tuple[Orbit, ...]:
        """Folds and other points where stability changes."""
        return tuple(orbit for orbit in self.orbits if orbit.label)

    def largest(self, quantity: str = "yaw_angle") -> Orbit:
        """Orbit of the largest amplitude."""
        return max(self.orbits, key=lambda orbit: orbit.amplitudes[quantity])


def orbit_of(found: Corrected, parameter: float, events: bool, label: str = "") -> Orbit:
    """What a solved orbit shows.

    Parameters
    ----------
    found : Corrected
    parameter : float
        Value of what is varied [SI].
    events : bool
        Whether its legs end at events.
    label : str
    """
    path = found.path
    flow = path.legs[0].flow
    columns = _shown(path)
    high, low = _extremes(columns)
    names = flow.output_names
    amplitudes, means = ((high - low) / 2).tolist(), ((high + low) / 2).tolist()
    peaks = np.maximum(np.abs(high), np.abs(low)).tolist()
    rows = np.vstack([columns.T, np.zeros(len(columns))])
    _, beyond = valid_part(rows, (*names, "unclosed"), flow.study)
    half, most, middle = (dict(zip(names, values, strict=True)) for values in (amplitudes, peaks, means))
    return Orbit(parameter, path.period, half, most, middle, multipliers(found, events), label, beyond, path)


def _whole(path: Path, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Times and states over the whole cycle, `count` to a leg, the end left out."""
    begin, times, states = 0.0, [], []
    for leg in path.legs:
        u = np.arange(count) / count
        times.append(begin + u * leg.duration)
        states.append(leg.at(u))
        begin += leg.duration
    t, x = np.concatenate(times), np.vstack(states)
    if path.half:
        t, x = np.concatenate([t, begin + t]), np.vstack([x, path.closing * x])
    return t, x


def _shown(path: Path) -> np.ndarray:
    """States and outputs (k, q) over the whole cycle."""
    sides = (np.ones_like(path.closing), path.closing) if path.half else (path.closing,)
    return np.vstack([_of_leg(leg, path.parameters, side) for side in sides for leg in path.legs])


def _of_leg(leg: Leg, parameters: np.ndarray, side: np.ndarray) -> np.ndarray:
    count = PER_INTERVAL * len(leg.x)
    x = leg.at(np.arange(count) / count) * side
    z = np.repeat(leg.z[:, -1], PER_INTERVAL, axis=0)
    flow = leg.flow if (side > 0).all() else leg.flow.mirrored
    if flow.m:
        z = flow.unknowns(x, parameters) if (side < 0).any() else z
        for _ in range(UNKNOWN_STEPS):
            z = z + flow.slopes(x, z, parameters, np.zeros_like(parameters)).unknowns[0]
    return flow.outputs(x, z, parameters)


def _extremes(columns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Largest and least value of each column of a periodic table, by parabolas."""
    found = []
    for sign in (1, -1):
        values = sign * columns
        k, every = values.argmax(axis=0), np.arange(columns.shape[1])
        left, top, right = (values[(k + i) % len(values), every] for i in (-1, 0, 1))
        bend = left - 2 * top + right
        with np.errstate(all="ignore"):
            more = np.where(bend < 0, -((right - left) ** 2) / (8 * bend), 0.0)
        found.append(sign * (top + np.minimum(more, np.abs(top - np.minimum(left, right)))))
    return found[0], found[1]

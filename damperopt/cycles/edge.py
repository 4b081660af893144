"""The border between motions that die and motions that do not: the largest kick or release, by bisection on exact motions."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from .. import interrupts
from ..errors import ConfigError
from ..motion.exact import ExactSimulator
from ..motion.measure import fastest_rate
from ..motion.question import refuse_start, valid_part

__all__ = ["SIZES", "Edge", "Kicker", "Threshold", "edge", "threshold"]

Fate = Literal["dies", "grows", "stays", "leaves"]
"""The yaw angle falls to a part `DEAD` while all else falls too; it exceeds `GROWN` times the first; neither within `CHUNKS`;
the model is left."""

DEAD, GROWN = 0.05, 1.5

CYCLES, CHUNKS = 4, 25
"""Of the slowest mode in one stretch of motion, and stretches of a motion."""

SLOWEST = 2 * np.pi
"""Rate [rad/s] of an oscillation below which it sets no length of a stretch."""

PER_CYCLE = 60
"""Samples in a cycle of the fastest mode."""

SIZES = {"release": ("yaw_angle", "rad", 0.9), "kick": ("yaw_rate", "rad/s", 500.0)}
"""What is disturbed, its unit, and the largest that is tried."""

DECADES = 4
"""Below the largest, down to which a start that dies is sought."""

CLOSE = 1e-2
"""Relative width of the bracket in which a threshold is left."""


@dataclass(frozen=True)
class Threshold:
    """Between the largest disturbance that was seen to die and the least that was not, at one speed.

    Attributes
    ----------
    speed, load : float
        [m/s], [N]
    dies, not_dies : float or None
        [rad] or [rad/s]; None where all that were tried do not die, or all do.
    fate : str
        Of the least that did not die.
    """

    speed: float
    load: float
    dies: float | None
    not_dies: float | None
    fate: Fate


class Kicker:
    """Exact motions after disturbances of one kind and any size, told by what becomes of them.

    Parameters
    ----------
    simulator : ExactSimulator
    kind : str
        ``release`` or ``kick``.
    """

    def __init__(self, simulator: ExactSimulator, kind: str = "release"):
        self.study, self.kind, self.simulator = simulator.study, kind, simulator
        self.name, self.unit, self.most = SIZES[kind]
        self._visible = np.array([not state.hidden for state in simulator.gear.states])

    def disturbance(self, size: float) -> dict[str, dict[str, float]]:
        """As `Disturbance` takes it."""
        return {self.kind: {self.name: size}}

    def chunk(self, speed: float, load: float) -> np.ndarray:
        """Times of one stretch [s]."""
        A, _ = self.simulator.gear.visible(speed, load)
        rates = np.abs(np.linalg.eigvals(A).imag)
        duration = CYCLES * 2 * np.pi / min(rates[rates > SLOWEST], default=SLOWEST)
        return np.linspace(0, duration, int(np.ceil(PER_CYCLE * duration * fastest_rate(A) / (2 * np.pi))) + 2)

    def fate(self, speed: float, load: float, size: float) -> tuple[Fate, list[np.ndarray]]:
        """What becomes of a motion, and its states (k, n) stretch by stretch."""
        stretches: list[np.ndarray] = []
        yaw = self.simulator.state_names.index("yaw_angle")
        first, before = np.zeros(0), np.zeros(0)
        for states, whole in self.stretches(speed, load, self.disturbance(size)):
            stretches.append(states)
            if not whole:
                return "leaves", stretches
            sizes = np.ptp(states, axis=0)
            if not first.size:
                first = sizes
            elif sizes[yaw] >= GROWN * first[yaw]:
                return "grows", stretches
            elif sizes[yaw] <= DEAD * first[yaw] and (sizes <= np.maximum(before, DEAD * first))[self._visible].all():
                return "dies", stretches
            before = sizes
        return "stays", stretches

    def stretches(
        self, speed: float, load: float, disturbance: Mapping[str, Any], most: int = CHUNKS
    ) -> Iterator[tuple[np.ndarray, bool]]:
        """A motion stretch by stretch: states (k, n), and whether the model holds to the end of it."""
        time, names, start = self.chunk(speed, load), (*self.simulator.names, "unclosed"), None
        for number in range(most):
            interrupts.check()
            rows = self.simulator.stretch(speed, load, disturbance, time, start)
            shown = np.vstack([rows.T, np.zeros(len(rows))])
            if number == 0:
                refuse_start(shown[:, :1], names, self.study)
            kept, beyond = valid_part(shown, names, self.study)
            states = rows[:kept, : len(self.simulator.state_names)]
            whole = not beyond and len(rows) == len(time)
            yield states, whole
            if not whole:
                return
            start = states[-1]


@dataclass(frozen=True)
class Edge:
    """A bracket of disturbances, and the motions at its ends."""

    dies: float | None
    not_dies: float | None
    fate: Fate
    motions: Sequence[list[np.ndarray]]


def edge(kicker: Kicker, speed: float, load: float, near: float | None = None, close: float = CLOSE) -> Edge:
    """Bisection between a disturbance that dies and one that does not.

    Parameters
    ----------
    kicker : Kicker
    speed, load : float
        [m/s], [N]
    near : float or None
        Where the threshold of a neighbour was.
    close : float
        Relative width of the bracket.
    """
    low: float | None = None
    high: float | None = None
    fate: Fate = "dies"
    motions: dict[bool, list[np.ndarray]] = {}

    def look(size: float) -> None:
        nonlocal low, high, fate
        found, states = kicker.fate(speed, load, size)
        if found == "dies":
            low = size
        else:
            high, fate = size, found
        motions[found == "dies"] = states

    size = near or kicker.most / 30
    look(size)
    while low is None and size > kicker.most / 10**DECADES:
        size /= 2 if near else 4
        look(size)
    while high is None and size < kicker.most:
        size = min(size * (2 if near else 4), kicker.most)
        if _too_large(kicker, speed, load, size):
            break
        look(size)
    while low is not None and high is not None and high - low > close * low:
        look(float(np.sqrt(low * high)))
    return Edge(low, high, fate, [motions[key] for key in (True, False) if key in motions])


def _too_large(kicker: Kicker, speed: float, load: float, size: float) -> bool:
    """Whether a disturbance begins beyond the model."""
    try:
        rows = kicker.simulator.stretch(speed, load, kicker.disturbance(size), np.array([0.0, 1e-6]))
        refuse_start(np.vstack([rows[:1].T, np.zeros(1)]), (*kicker.simulator.names, "unclosed"), kicker.study)
    except ConfigError:
        return True
    return False


def threshold(
    kicker: Kicker, speeds: Sequence[float], load: float, report: Callable[[Threshold], None] = lambda found: None
) -> list[Threshold]:
    """The largest disturbance that dies over speed.

    Parameters
    ----------
    kicker : Kicker
    speeds : sequence of float
        [m/s]
    load : float
        [N]
    report : callable
        Called with each.
    """
    found: list[Threshold] = []
    near = None
    for speed in speeds:
        at = edge(kicker, speed, load, near)
        found.append(Threshold(speed, load, at.dies, at.not_dies, at.fate))
        near = at.dies if at.not_dies is not None else None
        report(found[-1])
    return found

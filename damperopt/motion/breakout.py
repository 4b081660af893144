"""How much dry friction brings a wheel to rest: the least breakout of a friction damper after a disturbance, by simulation.

A gear that is unstable without friction rests after a small disturbance and shimmies after a large one. More friction moves the
border, so that a breakout that suffices is met by doubling, and the least one by halving the interval. With what is found the
wheel rests at every speed that is looked at, and with a little less it does not at one of them; no proof says more.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from ..errors import ConfigError
from ..study.disturbances import Disturbance
from ..study.study import Study
from .exact import ExactSimulator

__all__ = ["Breakout", "comes_to_rest", "least_breakout", "with_breakout"]

CLOSE = 1.03
"""Ratio of a breakout that suffices to one that does not, at which the search ends."""

SMALLEST, LEAST, DOUBLINGS = 1 / 64, 0.02, 16
"""The search begins with this part of the study's breakout, or so many newton or N m, and doubles it at most so often."""

POINTS, AT_THE_END = 400, 40
"""Of a trajectory; the yaw rate is exactly 0 at the last ones where the wheel has come to rest."""


@dataclass(frozen=True)
class Breakout:
    """The least breakout that suffices at every speed that was looked at.

    Attributes
    ----------
    torque : float or None
        [N m], without what the load adds; None: none was found.
    speed : float
        Which asked for it, or at which none was found [m/s].
    """

    torque: float | None
    speed: float


def with_breakout(study: Study, torque: float) -> Study:
    """The study with another breakout.

    Parameters
    ----------
    study : Study
    torque : float
        [N m], without what the load adds.
    """
    keys = {"breakout_force": None, "breakout_lever": None, "breakout_torque": torque}
    return study.replace(**{f"damper__{key}": value for key, value in keys.items()})


def comes_to_rest(study: Study, speed: float, load: float, disturbance: Disturbance, duration: float) -> bool:
    """Whether the piston sticks at the end of an exact simulation.

    Parameters
    ----------
    study : Study
    speed, load : float
        [m/s], [N]
    disturbance : Disturbance
    duration : float
        [s]
    """
    return _rests(ExactSimulator(study, study.start), speed, load, disturbance, duration)


def _rests(run: ExactSimulator, speed: float, load: float, disturbance: Disturbance, duration: float) -> bool:
    with np.errstate(all="ignore"):  # a motion that grows may overflow on its way out of the model's validity
        motion = run(speed, load, disturbance, duration, points=POINTS)
    return motion.status == "completed" and not motion["yaw_rate"][-AT_THE_END:].any()


def _given(study: Study) -> float:
    """Breakout torque of a study without what the load adds [N m]."""
    damper = study.damper
    if damper.breakout_torque is not None:
        return float(damper.breakout_torque)
    lever = abs(study.gear.caster_length) if damper.breakout_lever is None else damper.breakout_lever
    return float(damper.breakout_force * lever)


def least_breakout(
    study: Study,
    disturbance: Disturbance,
    speeds: Sequence[float],
    load: float,
    duration: float,
    at_least: float = 0.0,
    progress: Callable[[float, float], None] | None = None,
) -> Breakout:
    """The least breakout with which the wheel comes to rest at every one of some speeds, to 3 %.

    Parameters
    ----------
    study : Study
        With a damper of kind ``friction``.
    disturbance : Disturbance
    speeds : sequence of float
        [m/s]
    load : float
        [N]
    duration : float
        In which it must [s].
    at_least : float
        Breakout below which it is known not to [N m].
    progress : callable or None
        Is told speed [m/s] and breakout [N m] before each simulation.

    Returns
    -------
    Breakout
        What suffices; the true border lies up to 3 % below.
    """
    if study.damper.kind != "friction":
        raise ConfigError(f"damper.kind: found '{study.damper.kind}'; allowed: friction, which lets a wheel stick")

    @cache
    def simulator(torque: float) -> ExactSimulator:
        own = with_breakout(study, torque)
        return ExactSimulator(own, own.start)

    def rests(torque: float, speed: float) -> bool:
        if progress is not None:
            progress(speed, torque)
        return _rests(simulator(torque), speed, load, disturbance, duration)

    torque, decides = max(at_least, _given(study) * SMALLEST), float(speeds[0])
    row, before = np.asarray(speeds, float).tolist(), None
    while torque != before:  # at last every speed is looked at with what was found
        before = torque
        for speed in row:
            if rests(torque, speed):
                continue
            low, high = torque, 2 * torque
            doubled = 1
            while not rests(high, speed):
                low, high, doubled = high, 2 * high, doubled + 1
                if doubled > DOUBLINGS:
                    return Breakout(None, speed)
            while high > CLOSE * low:
                middle = float(np.sqrt(low * high))
                low, high = (low, middle) if rests(middle, speed) else (middle, high)
            torque, decides = high, speed
    return Breakout(torque, decides)

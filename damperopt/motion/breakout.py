"""The least breakout torque of a friction damper with which a gear comes to rest after a kick, by exact simulation.

Linear models see no friction, so no proof speaks here: every speed that is looked at is simulated, with friction that sticks.
At the torque found the gear rests at all of them, and with a little less it does not at the worst.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import ConfigError
from ..study.disturbances import Disturbance
from ..study.study import Study
from .exact import ExactSimulator

__all__ = ["Breakout", "least_breakout"]

SPEEDS = 12
"""Spaced geometrically over the envelope, unless some are given."""

TOLERANCE = 0.01
"""Relative, of the torque."""

DOUBLINGS = 24
"""From the torque of the study, before it is said that none is enough."""

LAST = 0.05
"""Part of the motion at whose end nothing moves."""


@dataclass(frozen=True)
class Breakout:
    """What holds a kick.

    Attributes
    ----------
    torque : float
        Least breakout torque without load, to 1 % [N m].
    force : float or None
        The same as a pull at the axle [N]; None: the axle lies on the axis.
    speed, load : float
        Where a little less does not hold [m/s], [N].
    speeds : tuple of float
        That were looked at [m/s].
    simulations : int
    """

    torque: float
    force: float | None
    speed: float
    load: float
    speeds: tuple[float, ...]
    simulations: int


def least_breakout(study: Study, kick: Disturbance, *, speeds: Sequence[float] = (), duration: float = 3.0) -> Breakout:
    """Least breakout torque with which the gear comes to rest within `duration`, at every speed and load that is looked at.

    Parameters
    ----------
    study : Study
        With a damper of kind ``friction``.
    kick : Disturbance
    speeds : sequence of float
        [m/s]; none: 12 over the envelope.
    duration : float
        [s]

    Returns
    -------
    Breakout

    Raises
    ------
    ConfigError
        If the damper is of another kind, or no torque, or none at all, is enough.
    """
    if study.damper.kind != "friction":
        raise ConfigError(f"damper.kind: found '{study.damper.kind}'; allowed: friction, whose exact motion sticks")
    envelope = study.envelope
    row = tuple(speeds) or tuple(np.unique(np.geomspace(envelope.speed.min, envelope.speed.max, SPEEDS)).tolist())
    search = _Search(study, kick, row, duration)
    low, torque, worst = search.bracket()
    while torque > (1 + TOLERANCE) * low:
        middle = (torque * low) ** 0.5
        if missed := search.missed(middle):
            low, worst = middle, missed
        else:
            torque = middle
    lever = abs(study.gear.caster_length)
    return Breakout(torque, torque / lever if lever else None, *worst, row, search.simulations)


class _Search:
    """Motions of a study with other breakout torques."""

    def __init__(self, study: Study, kick: Disturbance, speeds: Sequence[float], duration: float):
        self._study, self._kick, self._duration = study, kick, duration
        self._places = [(V, F) for F in study.envelope.loads for V in speeds]
        self.simulations = 0
        damper = study.damper
        by_force = damper.breakout_force is not None
        lever = damper.breakout_lever if damper.breakout_lever is not None else abs(study.gear.caster_length)
        self._given = float(damper.breakout_force * lever if by_force else damper.breakout_torque)

    def bracket(self) -> tuple[float, float, tuple[float, float]]:
        """A torque that is too small, one twice as large that is enough, and where the first is too small."""
        torque, missed = self._given, self.missed(self._given)
        up = missed is not None
        for _ in range(DOUBLINGS):
            following = 2 * torque if up else torque / 2
            found = self.missed(following)
            if up and found is None and missed is not None:
                return torque, following, missed
            if not up and found is not None:
                return following, torque, found
            torque, missed = following, found
        if up:
            raise ConfigError(f"breakout: none up to {torque:.3g} N m brings the gear to rest after this kick")
        raise ConfigError("breakout: the gear comes to rest with hardly any friction; allowed: a larger kick")

    def missed(self, torque: float) -> tuple[float, float] | None:
        """Speed and load at which the gear does not come to rest; None: there is none. What was missed last comes first."""
        keys = {"breakout_force": None, "breakout_lever": None, "breakout_torque": torque}
        run = ExactSimulator(self._study.replace(**{f"damper__{key}": value for key, value in keys.items()}))
        for place in self._places:
            self.simulations += 1
            motion = run(*place, self._kick, self._duration, points=400)
            if motion.status != "completed" or motion["yaw_rate"][-int(LAST * 400) :].any():
                self._places.sort(key=lambda other, place=place: other != place)  # type: ignore[misc]
                return place
        return None

"""From one event to the next: a motion whose corners are passed exactly, and which sticks where dry friction holds it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Protocol

import casadi as ca
import numpy as np
from scipy.integrate import solve_ivp

from ..expressions.buffered import Buffered
from ..study.disturbances import Disturbance

__all__ = ["Drive", "Fast", "Run", "Steady"]

MAX_EVENTS = 100_000

NEWTON_TOLERANCE = 1e-14
"""Step of the algebraic unknowns [m, rad] at which the linkage counts as closed."""

RELAXING_STEPS = 4
"""Until the corners agree with where the relaxed chain stands: each step is Newton's on straight pieces."""

NEWTON_STEPS = 50

STILL = 1e-13
"""Rate [rad/s] below which nothing rubs: what rounding leaves where the motion has stopped."""

NOISE = 1e-11
"""Relative to the sizes that its argument has had: how far a corner must be passed, beside what the integrator does not
resolve. A motion that creeps into a corner, or stays on it as the force of a damper in a gap, would meet it again and again."""

ABSOLUTE = 1e-3
"""Absolute over relative tolerance."""

STEPS_PER_CYCLE = 40
"""Least steps in a cycle of the fastest mode: a corner that is passed and passed back within one would be missed."""

STEPS_WITHOUT_JOINTS = 12
"""The same where the only corner is that of the slip limit, at which the moment of the tyre has no jump."""


class Drive(Protocol):
    """What drives a motion from outside.

    Attributes
    ----------
    start : float
        Time at which it begins [s].
    """

    start: float

    def point(self, t: float) -> np.ndarray:
        """Numbers that the equations take beside states, unknowns and modes."""
        ...

    def until(self, t: float, end: float) -> float:
        """Time up to which it is smooth from t on, at most `end`."""
        ...


class Steady:
    """Constant speed, load and torque, and an unbalance that turns: what drives a motion without a history."""

    start = 0.0

    def __init__(self, speed: float, load: float, disturbance: Disturbance, radius: float):
        self._rate, self._moment = speed / radius, disturbance.unbalance_moment
        self._torque, self._point = disturbance.yaw_torque, np.array([speed, load, disturbance.yaw_torque])

    def point(self, t: float) -> np.ndarray:
        """Speed, load, torque."""
        if self._moment:
            self._point[2] = self._torque + self._moment * self._rate**2 * math.sin(self._rate * t)
        return self._point

    def until(self, t: float, end: float) -> float:
        """Time up to which it is smooth from t on."""
        return end


class Fast:
    """Expressions of vectors, called without overhead."""

    def __init__(self, inputs: list[ca.SX], outputs: list[ca.SX]):
        self._at = Buffered(ca.Function("fast", inputs, ca.cse([ca.densify(ca.SX(e)) for e in outputs])))

    def __call__(self, *arguments: np.ndarray) -> list[np.ndarray]:
        """Outputs, in arrays that the next call overwrites."""
        for mine, given in zip(self._at.given, arguments, strict=True):
            mine[:] = given
        return self._at()


class CannotClose(Exception):
    pass


class Run:
    """One motion, from event to event."""

    def __init__(self, model: Any, drive: Drive, disturbance: Disturbance | None, tolerance: float, rate: float):
        self._model, self._drive, self._tolerance = model, drive, tolerance
        self._point = drive.point(drive.start)
        # modes of the corners, and the direction of dry friction: +-1 sliding, 0 sticking
        self._modes = np.ones(model.corners + 1)
        self._modes[-1] = 0.0
        self._sticks, self._sizes, self._unresolved = False, np.zeros(model.corners), np.zeros(model.corners)
        self._z = np.zeros(model.unknowns)
        start = [0.0] * len(model.state_names) if disturbance is None else disturbance.start(model.state_names)
        self._x0 = self._relaxed(np.array(start))
        self._z = model.first_guess(self._x0, self._z, self._modes, self._point)[0].copy()
        steps = STEPS_PER_CYCLE if model.has_joints else STEPS_WITHOUT_JOINTS
        self._max_step = 2 * math.pi / rate / steps

    def begin_at(self, x: np.ndarray) -> None:
        """Start at these states, wherever the chain stands."""
        self._x0 = x.copy()
        arguments = self._model.motion(x, self._z, self._modes, self._point)[2]
        self._modes[:-1] = np.where(arguments < 0, -1.0, 1.0)

    def _relaxed(self, given: np.ndarray) -> np.ndarray:
        """State with the chain at rest; where it stands hangs on the corners, and which are passed on where it stands."""
        x = given
        for _ in range(RELAXING_STEPS):
            arguments = self._model.motion(x, self._z, self._modes, self._point)[2]
            self._modes[:-1] = np.where(arguments < 0, -1.0, 1.0)
            x = self._model.relaxed(given, self._z, self._modes, self._point)[0].copy()
        return x

    def _evaluated(self, t: float, x: np.ndarray) -> list[np.ndarray]:
        """ode, Newton step, arguments of the corners, and `grip_of`; with the linkage closed."""
        self._point = self._drive.point(t)
        if not self._z.size:
            return self._model.motion(x, self._z, self._modes, self._point)
        for _ in range(NEWTON_STEPS):
            found = self._model.motion(x, self._z, self._modes, self._point)
            change = np.abs(found[1]).max()
            if change < NEWTON_TOLERANCE:
                return found
            if not np.isfinite(change):
                break
            self._z = self._z - found[1]
        self._z = self._model.first_guess(x, self._z, self._modes, self._point)[0].copy()
        raise CannotClose

    def _held(self, t: float, x: np.ndarray) -> list[np.ndarray]:
        """`_evaluated` with the friction that keeps what sticks where it is."""
        found = self._evaluated(t, x)
        if not self._sticks:
            return found
        _, drive, most = found[3][:3]
        self._modes[-1] = drive / most
        return self._evaluated(t, x)

    def _rate(self, t: float, x: np.ndarray) -> np.ndarray:
        found = self._held(t, x)
        rate = found[0].copy()
        if not self._sticks:
            return rate
        slope = found[3][3:].copy()
        return rate - np.dot(slope, rate) / np.dot(slope, slope) * slope  # and not even rounding moves it

    def rows_at(self, time: np.ndarray) -> tuple[list[np.ndarray], str]:
        """States and outputs at `time`, and why it ended early."""
        t, x = float(time[0]), self._x0
        rows: list[np.ndarray] = []
        try:
            self._settle(t, x, range(len(self._modes)))
            rows.append(self._row(t, x))
            for _ in range(MAX_EVENTS):
                end = self._drive.until(t, float(time[-1]))
                leg = solve_ivp(
                    self._rate,
                    (t, end),
                    x,
                    method="DOP853",
                    rtol=self._tolerance,
                    atol=ABSOLUTE * self._tolerance,
                    max_step=self._max_step,
                    first_step=min(1e-3 * self._max_step, (end - t) / 2),
                    events=self._events(),
                    dense_output=True,
                )
                last = leg.t[-1]
                moments = time[len(rows) :]
                moments = moments[(moments < last) | ((moments == last) & (leg.status != 1))]
                if moments.size:
                    rows += [self._row(*place) for place in zip(moments, leg.sol(moments).T, strict=True)]
                if leg.status == -1 or (leg.status == 0 and end == time[-1]):
                    return rows, "" if leg.status == 0 else f"the integrator cannot go on: {leg.message}"
                t, x = last, leg.y[:, -1].copy()
                self._grow(leg.t, leg.y)
                if leg.status == 1:
                    self._cross(t, x, [i for i, times in enumerate(leg.t_events) if times.size])
        except CannotClose:
            return rows, "the equations of the closed linkage are not solved"
        return rows, f"more than {MAX_EVENTS} events"

    def _row(self, t: float, x: np.ndarray) -> np.ndarray:
        self._held(t, x)
        return self._model.rows(x, self._z, self._modes, self._point)[0].copy()

    def _events(self) -> list[Callable[[float, np.ndarray], float]]:
        """Functions that fall through zero when a corner is passed, friction last."""

        def corner(i: int) -> Callable[[float, np.ndarray], float]:
            play = NOISE * self._sizes[i] + self._unresolved[i]
            return lambda t, x: float(self._held(t, x)[2][i] * self._modes[i] + play)

        def grip(t: float, x: np.ndarray) -> float:
            rate, drive, most = self._evaluated(t, x)[3][:3]
            if not most:  # in a gap nothing rubs
                return 1.0
            return float(most - abs(drive) if self._sticks else rate * self._modes[-1])

        functions = [corner(i) for i in range(self._model.corners)]
        functions += [grip] if self._model.sticks else []
        for function in functions:
            function.terminal, function.direction = True, -1  # type: ignore[attr-defined]  # how SciPy is told
        return functions

    def _grow(self, times: np.ndarray, states: np.ndarray) -> None:
        for t, x in zip(times, states.T, strict=True):
            self._sizes = np.maximum(self._sizes, np.abs(self._held(t, x)[2]))

    def _cross(self, t: float, x: np.ndarray, passed: list[int]) -> None:
        """Change the modes of the corners that were passed, and of those that this moves."""
        for i in passed:
            if i < self._model.corners:
                self._modes[i] *= -1
        others = [i for i in range(self._model.corners) if i not in passed]
        if self._model.corners in passed and self._sticks:
            self._settle(t, x, others)
            self._sticks, self._modes[-1] = False, np.sign(self._evaluated(t, x)[3][1])
            self._settle(t, x, others)
            return
        if self._model.corners in passed:
            rate, _, most, *slope = self._evaluated(t, x)[3]
            if most:
                x -= rate * np.array(slope) / np.dot(slope, slope)
        self._settle(t, x, [*others, self._model.corners])

    def _settle(self, t: float, x: np.ndarray, which: Any) -> None:
        """Modes that go with a state, those of corners on what sticks or slides anew where that changes."""
        self._settle_corners(t, x, which)
        if not self._model.sticks or self._model.corners not in which:
            return
        rate, drive, most = self._evaluated(t, x)[3][:3]
        if abs(rate) <= STILL:
            self._sticks = abs(drive) <= most > 0
            self._modes[-1] = 0.0 if self._sticks else np.sign(drive)
        else:
            self._sticks, self._modes[-1] = False, np.sign(rate)
        self._settle_corners(t, x, which)

    def _settle_corners(self, t: float, x: np.ndarray, which: Any) -> None:
        """A corner that is met exactly is judged by where the motion goes."""
        for _ in range(2):  # a corner's argument may hang on the mode of another
            arguments = self._held(t, x)[2].copy()
            self._sizes = np.maximum(self._sizes, np.abs(arguments))
            self._unresolved = ABSOLUTE * self._tolerance * self._model.slopes(x, self._z, self._modes, self._point)[0]
            ahead = self._evaluated(t, x + 1e-9 * self._rate(t, x))[2] - arguments
            for i in which:
                if i < self._model.corners:
                    side = arguments[i] if arguments[i] else ahead[i]
                    self._modes[i] = np.sign(side) if side else self._modes[i]

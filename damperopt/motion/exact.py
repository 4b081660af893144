"""Exact simulation: every corner of the model is an event, between events the motion is smooth.

Nothing is rounded off here, and no integrator is shared with `integrators`: SciPy's Runge-Kutta method of order 8 runs from
one event to the next, the closed linkage is solved by Newton's method at every evaluation, and dry friction sticks until
what drives it exceeds it. It checks the smooth model, and designs made with it.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Mapping
from typing import Any, Literal

import casadi as ca
import numpy as np
from scipy.integrate import solve_ivp

from ..dynamics import build
from ..expressions.corners import Switched
from ..stability.linear import LinearGear, LinearModel
from ..study.disturbances import Disturbance
from ..study.study import Study
from ..symbols import data_values, symbolic
from .friction import grip_of, one_friction, slopes_of
from .measure import fastest_rate
from .question import output_points, posed, refuse_start, valid_part
from .trajectory import Trajectory

__all__ = ["ExactSimulator", "simulate_exactly"]

MAX_EVENTS = 100_000

FEWEST_POINTS = 2000

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


def simulate_exactly(
    study: Study,
    design: Mapping[str, float] | None = None,
    *,
    speed: float,
    load: float | None = None,
    disturbance: Disturbance | Mapping[str, Any],
    duration: float = 3.0,
    tolerance: float = 1e-10,
    points: int | None = None,
) -> Trajectory:
    """Motion after a disturbance, with the corners of freeplay, stops, friction and slip limit as events.

    Parameters
    ----------
    study : Study
    design : mapping or None
        Design variables [SI]; None: the starts of the study.
    speed : float
        [m/s]
    load : float or None
        Vertical load [N]; None: the largest of the envelope.
    disturbance : Disturbance or mapping
    duration : float
        [s]
    tolerance : float
        Relative, of SciPy's DOP853; absolute 1/1000 of it.
    points : int or None
        Output points, evenly spaced; None: enough for every cycle of the fastest mode.

    Returns
    -------
    Trajectory

    Raises
    ------
    ConfigError
        If the question is not well posed.
    """
    return ExactSimulator(study, design)(speed, load, disturbance, duration, tolerance, points)


class ExactSimulator:
    """Exact motion of a gear, built once, for any design, speed, load and disturbance; see `simulate_exactly`.

    Parameters
    ----------
    study : Study
    design : mapping or None
        Design variables [SI] of calls that give none; None: the starts of the study.
    model : LinearModel or None
        Of the study, if it is at hand.
    """

    def __init__(self, study: Study, design: Mapping[str, float] | None = None, model: LinearModel | None = None):
        self.study, self.model = study, LinearModel(study) if model is None else model
        corners = Switched()
        dae = build(symbolic(study), corners)
        dae, friction = one_friction(dae, corners)
        self.corners, self.sticks = len(corners.switches), friction is not None
        self.has_joints = friction is not None or any(not name.startswith("slip limit") for name in corners.switches)
        modes = [switch.mode for switch in corners.switches.values()]
        modes += [friction.mode] if friction else [ca.SX.sym("no friction")]
        step = ca.inv_minor(ca.jacobian(dae.alg, dae.z)) @ dae.alg if dae.z.numel() else dae.z
        outputs = {"yaw_acceleration": dae.ode[dae.index("yaw_rate")], **dae.outputs}
        self.unknowns, self.units = dae.z.numel(), dae.units
        self.state_names, self.names = dae.state_names, (*dae.state_names, *outputs)
        self._hidden = {state.name for state in dae.states if state.hidden}

        inputs = [dae.x, dae.z, ca.vertcat(*modes), ca.vertcat(dae.speed, dae.load, dae.yaw_torque)]
        arguments = ca.vertcat(ca.SX(0, 1), *(switch.argument for switch in corners.switches.values()))
        motion = [dae.ode, step, arguments, grip_of(dae, friction)]
        rows = ca.vertcat(dae.x, *(ca.SX(value) for value in outputs.values()))
        self._inputs, self._known = inputs, ca.vertcat(dae.design, dae.data)
        self._expressions = (
            motion,
            [rows],
            [ca.SX(dae.first_guess())],
            [dae.relaxed],
            [ca.sum2(ca.fabs(slopes_of(dae, arguments)))],
        )
        self._take(study.start if design is None else design, complete=design is not None)

    def _take(self, design: Mapping[str, float], complete: bool = True) -> None:
        """Functions with the numbers of a design in them, which makes them shorter; `ConfigError` if it lacks some."""
        self.design = dict(design)
        if not complete and not set(self.model.design_names) <= self.design.keys():
            return  # calls will give one
        self.model.at(design)
        values = ca.DM([*(design[name] for name in self.model.design_names), *data_values(self.study)])
        self.motion, self.rows, self.first_guess, self.relaxed, self.slopes = (
            _Fast(self._inputs, [ca.substitute(e, self._known, values) for e in expressions])
            for expressions in self._expressions
        )

    @property
    def gear(self) -> LinearGear:
        """Linear gear with the design of calls that give none."""
        return self.model.at(self.design)

    def with_design(self, design: Mapping[str, float]) -> ExactSimulator:
        """The same, for calls that give no design; nothing is built again."""
        other = copy.copy(self)
        other._take(design)
        return other

    def __call__(
        self,
        speed: float,
        load: float | None,
        disturbance: Disturbance | Mapping[str, Any],
        duration: float,
        tolerance: float = 1e-10,
        points: int | None = None,
        *,
        design: Mapping[str, float] | None = None,
    ) -> Trajectory:
        """Motion of a design at `speed` [m/s] and `load` [N] over `duration` [s]; see `simulate_exactly`."""
        if design is not None:
            return self.with_design(design)(speed, load, disturbance, duration, tolerance, points)
        load = max(self.study.envelope.loads) if load is None else load
        disturbance = posed(self.study, self.state_names, speed, load, disturbance, duration)
        enough = output_points(self.gear, speed, load, duration)
        time = np.linspace(0, duration, max(enough + 1, FEWEST_POINTS) if points is None else points)
        rows, message = _Run(self, speed, load, disturbance, tolerance).rows_at(time)
        values = np.vstack([np.array(rows).T, np.zeros(len(rows))])
        names = (*self.names, "unclosed")  # the unknowns solve the equations, or the run stops
        refuse_start(values[:, :1], names, self.study)
        kept, beyond = valid_part(values, names, self.study)
        values, message = values[:, :kept], beyond or message
        time = time[: values.shape[1]]
        named = dict(zip(names, values, strict=True))
        states = {name: named.pop(name) for name in self.state_names}
        states = {name: row for name, row in states.items() if name not in self._hidden}
        if message:
            message = f"{message} after {time[-1]:.4g} s"
        status: Literal["completed", "stopped"] = "stopped" if message else "completed"
        forcing = speed / self.study.gear.wheel_radius / (2 * math.pi) if disturbance.unbalance_moment else 0.0
        return Trajectory(speed, load, time, states, named, status, message, "exact", forcing, self.units)


class _Fast:
    """A CasADi function of vectors, called without its overhead (about 20 us)."""

    def __init__(self, inputs: list[ca.SX], outputs: list[ca.SX]):
        function = ca.Function("fast", inputs, [ca.densify(ca.SX(e)) for e in outputs])
        self._buffer, self._evaluate = function.buffer()
        self._in = [np.zeros(e.numel()) for e in inputs]
        self._out = [np.zeros(e.numel()) for e in outputs]
        for k, array in enumerate(self._in):
            self._buffer.set_arg(k, memoryview(array))  # type: ignore[arg-type, call-arg]  # CasADi's stub lacks memoryviews
        for k, array in enumerate(self._out):
            self._buffer.set_res(k, memoryview(array))  # type: ignore[arg-type, call-arg]  # and the second argument

    def __call__(self, *arguments: np.ndarray) -> list[np.ndarray]:
        """Outputs, in arrays that the next call overwrites."""
        for mine, given in zip(self._in, arguments, strict=True):
            mine[:] = given
        self._evaluate()
        return self._out


class _CannotClose(Exception):
    pass


class _Run:
    """One motion, from event to event."""

    def __init__(self, model: ExactSimulator, speed: float, load: float, disturbance: Disturbance, tolerance: float):
        self._model, self._tolerance = model, tolerance
        self._torque, self._unbalance = disturbance.yaw_torque, disturbance.unbalance_moment
        self._wheel_rate = speed / model.study.gear.wheel_radius
        self._point, self._external = np.array([speed, load, 0.0]), 2
        # modes of the corners, and the direction of dry friction: +-1 sliding, 0 sticking
        self._modes = np.ones(model.corners + 1)
        self._modes[-1] = 0.0
        self._sticks, self._sizes, self._unresolved = False, np.zeros(model.corners), np.zeros(model.corners)
        self._z = np.zeros(model.unknowns)
        self._x0 = self._relaxed(np.array(disturbance.start(model.state_names)))
        self._z = model.first_guess(self._x0, self._z, self._modes, self._point)[0].copy()
        steps = STEPS_PER_CYCLE if model.has_joints else STEPS_WITHOUT_JOINTS
        self._max_step = 2 * math.pi / fastest_rate(model.gear.visible(speed, load)[0]) / steps

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
        self._point[self._external] = self._torque
        if self._unbalance:
            self._point[self._external] += self._unbalance * self._wheel_rate**2 * math.sin(self._wheel_rate * t)
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
        raise _CannotClose

    def _rate(self, t: float, x: np.ndarray) -> np.ndarray:
        found = self._evaluated(t, x)
        if not self._sticks:
            return found[0].copy()
        _, drive, most, *slope = found[3]
        self._modes[-1] = drive / most  # the friction that keeps it so
        rate = self._evaluated(t, x)[0]
        return rate - np.dot(slope, rate) / np.dot(slope, slope) * np.array(slope)  # and not even rounding moves it

    def rows_at(self, time: np.ndarray) -> tuple[list[np.ndarray], str]:
        """States and outputs at `time`, and why it ended early."""
        t, x = 0.0, self._x0
        rows: list[np.ndarray] = []
        try:
            self._settle(t, x, range(len(self._modes)))
            rows.append(self._row(t, x))
            for _ in range(MAX_EVENTS):
                leg = solve_ivp(
                    self._rate,
                    (t, time[-1]),
                    x,
                    method="DOP853",
                    rtol=self._tolerance,
                    atol=ABSOLUTE * self._tolerance,
                    max_step=self._max_step,
                    first_step=min(1e-3 * self._max_step, (time[-1] - t) / 2),
                    events=self._events(),
                    dense_output=True,
                )
                last = leg.t[-1]
                for moment in time[len(rows) :]:
                    if moment > last or (moment == last and leg.status == 1):
                        break
                    rows.append(self._row(moment, leg.sol(moment)))
                if leg.status != 1:
                    return rows, "" if leg.status == 0 else f"the integrator cannot go on: {leg.message}"
                t, x = last, leg.y[:, -1].copy()
                self._grow(leg.t, leg.y)
                self._cross(t, x, [i for i, times in enumerate(leg.t_events) if times.size])
        except _CannotClose:
            return rows, "the equations of the closed linkage are not solved"
        return rows, f"more than {MAX_EVENTS} events"

    def _row(self, t: float, x: np.ndarray) -> np.ndarray:
        self._evaluated(t, x)
        return self._model.rows(x, self._z, self._modes, self._point)[0].copy()

    def _events(self) -> list[Callable[[float, np.ndarray], float]]:
        """Functions that fall through zero when a corner is passed, friction last."""

        def corner(i: int) -> Callable[[float, np.ndarray], float]:
            play = NOISE * self._sizes[i] + self._unresolved[i]
            return lambda t, x: float(self._evaluated(t, x)[2][i] * self._modes[i] + play)

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
            self._sizes = np.maximum(self._sizes, np.abs(self._evaluated(t, x)[2]))

    def _cross(self, t: float, x: np.ndarray, passed: list[int]) -> None:
        """Change the modes of the corners that were passed, and of those that this moves."""
        for i in passed:
            if i < self._model.corners:
                self._modes[i] *= -1
        others = [i for i in range(self._model.corners) if i not in passed]
        if self._model.corners in passed and self._sticks:
            self._settle(t, x, others)
            self._sticks, self._modes[-1] = False, np.sign(self._evaluated(t, x)[3][1])
            return
        if self._model.corners in passed:
            rate, _, most, *slope = self._evaluated(t, x)[3]
            if most:
                x -= rate * np.array(slope) / np.dot(slope, slope)
        self._settle(t, x, [*others, self._model.corners])

    def _settle(self, t: float, x: np.ndarray, which: Any) -> None:
        """Modes that go with a state; a corner that is met exactly is judged by where the motion goes."""
        for _ in range(2):  # a corner's argument may hang on the mode of another
            arguments = self._evaluated(t, x)[2].copy()
            self._sizes = np.maximum(self._sizes, np.abs(arguments))
            self._unresolved = ABSOLUTE * self._tolerance * self._model.slopes(x, self._z, self._modes, self._point)[0]
            ahead = self._evaluated(t, x + 1e-9 * self._rate(t, x))[2] - arguments
            for i in which:
                if i < self._model.corners:
                    side = arguments[i] if arguments[i] else ahead[i]
                    self._modes[i] = np.sign(side) if side else self._modes[i]
        if not self._model.sticks or self._model.corners not in which:
            return
        rate, drive, most = self._evaluated(t, x)[3][:3]
        if abs(rate) <= STILL:
            self._sticks = abs(drive) <= most > 0
            self._modes[-1] = 0.0 if self._sticks else np.sign(drive)
        else:
            self._sticks, self._modes[-1] = False, np.sign(rate)

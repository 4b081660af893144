"""Exact simulation: every corner of the model is an event, between events the motion is smooth.

Nothing is rounded off here, and no integrator is shared with `integrators`: SciPy's Runge-Kutta method of order 8 runs from
one event to the next, the closed linkage is solved by Newton's method at every evaluation, and dry friction sticks until
what drives it exceeds it. It checks the smooth model, and designs made with it.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Literal

import casadi as ca
import numpy as np

from ..dynamics import build
from ..expressions.corners import Switched
from ..stability.linear import LinearGear, LinearModel
from ..study.disturbances import Disturbance
from ..study.history import History
from ..study.study import Study
from ..symbols import data_values, symbolic
from .course import Along, Course, dae_along
from .events import Drive, Fast, Run, Steady
from .grip import grip_of, one_friction, slopes_of
from .measure import fastest_rate
from .question import output_points, posed, refuse_start, valid_part
from .trajectory import Trajectory

__all__ = ["ExactSimulator", "simulate_exactly"]

FEWEST_POINTS = 2000


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
    own_stroke : bool or None
        Of motions along histories: whether the stroke of the shock strut is that of the history. None: of other motions.
    """

    def __init__(
        self,
        study: Study,
        design: Mapping[str, float] | None = None,
        model: LinearModel | None = None,
        own_stroke: bool | None = None,
    ):
        self.study, self.model = study, LinearModel(study) if model is None else model
        corners = Switched()
        if own_stroke is None:
            dae = build(symbolic(study), corners)
            data, point = dae.data, ca.vertcat(dae.speed, dae.load, dae.yaw_torque)
        else:
            dae, point = dae_along(study, corners, own_stroke)
            data = dae.data[: len(dae.data_names)]
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

        inputs = [dae.x, dae.z, ca.vertcat(*modes), point]
        arguments = ca.vertcat(ca.SX(0, 1), *(switch.argument for switch in corners.switches.values()))
        motion = [dae.ode, step, arguments, grip_of(dae, friction)]
        rows = ca.vertcat(dae.x, *(ca.SX(value) for value in outputs.values()))
        self._inputs, self._known = inputs, ca.vertcat(dae.design, data)
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
            Fast(self._inputs, [ca.substitute(e, self._known, values) for e in expressions])
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
        forcing = speed / self.study.gear.wheel_radius / (2 * math.pi) if disturbance.unbalance_moment else 0.0
        found = self._moved(
            Steady(speed, load, disturbance, self.study.gear.wheel_radius),
            disturbance,
            time,
            tolerance,
            self._rate(speed, load),
        )
        return replace(found, speed=speed, load=load, forcing=forcing)

    def along(
        self,
        history: History,
        disturbance: Disturbance | Mapping[str, Any] | None = None,
        tolerance: float = 1e-10,
        points: int | None = None,
    ) -> Trajectory:
        """Motion along a history, of a simulator that is made for such; see `history.simulate_along`."""
        course = Course.of(history, self.study, self.state_names, disturbance)
        enough = course.points(self.gear)
        time = np.linspace(course.time[0], course.time[-1], max(enough + 1, FEWEST_POINTS) if points is None else points)
        rate = max(self._rate(*point) for point in course.looked_at)
        found = self._moved(Along(course), course.disturbance, time, tolerance, rate)
        V, F = course.values[:2, 0]
        return replace(found, speed=float(V), load=float(F), along=course.words())

    def _rate(self, speed: float, load: float) -> float:
        return fastest_rate(self.gear.visible(speed, load)[0])

    def _moved(
        self, drive: Drive, disturbance: Disturbance | None, time: np.ndarray, tolerance: float, rate: float
    ) -> Trajectory:
        """Motion under a drive at output times, with steps that follow a rate [rad/s]."""
        rows, message = Run(self, drive, disturbance, tolerance, rate).rows_at(time)
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
        return Trajectory(0.0, 0.0, time, states, named, status, message, "exact", units=self.units)

    def stretch(
        self,
        speed: float,
        load: float,
        disturbance: Disturbance | Mapping[str, Any],
        time: np.ndarray,
        start: np.ndarray | None = None,
        tolerance: float = 1e-8,
    ) -> np.ndarray:
        """States, hidden ones too, and outputs by `names` (k, q) at `time` (m,) [s]; k < m where the motion cannot go on.

        Parameters
        ----------
        speed, load : float
            [m/s], [N]
        disturbance : Disturbance or mapping
        time : ndarray
            Ascending from 0.
        start : ndarray or None
            (n,) states at the start, in the place of those of the disturbance.
        tolerance : float
            Relative.
        """
        disturbance = posed(self.study, self.state_names, speed, load, disturbance, float(time[-1]))
        drive = Steady(speed, load, disturbance, self.study.gear.wheel_radius)
        run = Run(self, drive, disturbance, tolerance, self._rate(speed, load))
        if start is not None:
            run.begin_at(start)
        return np.array(run.rows_at(time)[0])

"""Speed, load, stroke and external torque along a history, in straight lines between its rows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import casadi as ca
import numpy as np

from ..dynamics import Ride, build
from ..errors import ConfigError
from ..expressions.corners import Corners, Switched
from ..expressions.dae import DAE
from ..stability.gear import LinearGear
from ..study.disturbances import Disturbance
from ..study.history import History
from ..study.study import Study
from ..symbols import symbolic
from .question import output_points, posed

__all__ = ["Along", "Course", "dae_along"]

LOOKED_AT = 16
"""Rows at which the gear is asked for the rate of its modes."""

QUANTITIES = ("speed", "load", "stroke", "yaw_torque")
"""Of a history, in the order of the numbers that a segment hands on: values at its start, then rates."""


@dataclass(frozen=True)
class Course:
    """A history as arrays, with what disturbs the gear along it.

    Attributes
    ----------
    time : ndarray
        (m,) of the rows [s].
    values : ndarray
        (4, m) by `QUANTITIES` [SI], a step of torque in the last; of what the history leaves out, zeros.
    own_stroke : bool
        Whether the stroke is that of the history; else it is in balance with the load.
    radius : float
        R_w, of the wheel that an unbalance turns with [m].
    disturbance : Disturbance or None
        At the start, and an unbalance.
    """

    time: np.ndarray
    values: np.ndarray
    own_stroke: bool
    radius: float
    disturbance: Disturbance | None = None

    @classmethod
    def of(
        cls,
        history: History,
        study: Study,
        names: tuple[str, ...],
        disturbance: Disturbance | Mapping[str, Any] | None = None,
    ) -> Course:
        """Of a history, with a study whose gear has states of these names; `ConfigError` where it has no answer at a row."""
        columns = [history.column(name) for name in QUANTITIES]
        time = np.array(history.column("time"))
        values = np.array([np.zeros(time.size) if column is None else column for column in columns])
        if columns[2] is not None:
            strut = study.gear.strut
            if strut is None:
                raise ConfigError("history: stroke: of a gear without gear.strut; allowed: no such column, or a shock strut")
            if (most := values[2].max()) > strut.longest:
                found = f"stroke at {time[values[2].argmax()]:g} s: {most:g} m"
                raise ConfigError(f"history: {found}; allowed: at most {strut.longest:g} m, the travel of gear.strut")
        strokes = [None] * time.size if columns[2] is None else values[2].tolist()
        for load, stroke, t in zip(values[1].tolist(), strokes, time.tolist(), strict=True):
            if words := study.beyond_data(load, stroke):
                allowed = "loads that tyre and strut have data for"
                raise ConfigError(f"history: load at {t:g} s: {load / 1e3:.6g} kN {words}; allowed: {allowed}")
        given = None
        if disturbance is not None:
            given = posed(study, names, values[0].max(), values[1, 0], disturbance, float(np.ptp(time)))
            values[3] += given.yaw_torque
        return cls(time, values, columns[2] is not None, study.gear.wheel_radius, given)

    @property
    def turned(self) -> np.ndarray:
        """(m,) angle by which the wheel has turned at the rows [rad]."""
        V = self.values[0]
        return np.append(0.0, np.cumsum((V[1:] + V[:-1]) / 2 * np.diff(self.time))) / self.radius

    def segments(self) -> np.ndarray:
        """(m - 1, 10) numbers of each segment: values at its start, rates, angle of the wheel, unbalance."""
        rates = np.diff(self.values) / np.diff(self.time)
        moment = 0.0 if self.disturbance is None else self.disturbance.unbalance_moment
        return np.vstack([self.values[:, :-1], rates, self.turned[:-1], np.full(len(self.time) - 1, moment)]).T

    def at(self, time: Any) -> tuple[np.ndarray, np.ndarray]:
        """Speed [m/s] and load [N] at times [s]."""
        return np.interp(time, self.time, self.values[0]), np.interp(time, self.time, self.values[1])

    def words(self) -> str:
        """From where to where, for a title."""
        V, F = self.values[:2]
        loads = f"{F[0] / 1e3:.4g} to {F[-1] / 1e3:.4g} kN"
        if F.max() > max(F[0], F[-1]):
            loads += f", at most {F.max() / 1e3:.4g} kN"
        return f"{V[0]:.4g} to {V[-1]:.4g} m/s, {loads}, {np.ptp(self.time):.4g} s"

    @property
    def looked_at(self) -> list[tuple[float, float]]:
        """Speed and load of some rows, the extreme ones among them."""
        V, F = self.values[:2]
        spread = np.linspace(0, V.size - 1, LOOKED_AT).astype(int)
        rows = np.unique([V.argmin(), V.argmax(), F.argmin(), F.argmax(), *spread])
        return [(float(V[k]), float(F[k])) for k in rows]

    def points(self, gear: LinearGear) -> int:
        """Output points that show every cycle; `ConfigError` where a contact line is too coarse, or they are too many."""
        duration = float(np.ptp(self.time))
        return max(output_points(gear, V, F, duration) for V, F in self.looked_at)


class Along:
    """A course as what drives a motion: within one segment after the other."""

    def __init__(self, course: Course):
        self.start, self._times, self._segments = float(course.time[0]), course.time, course.segments()
        self._point = np.zeros(1 + self._segments.shape[1])
        self.until(self.start, self.start)

    def until(self, t: float, end: float) -> float:
        """End of the segment that begins at t or has begun, at most `end`."""
        k = int(np.clip(np.searchsorted(self._times, t, side="right") - 1, 0, len(self._segments) - 1))
        self._begun, self._point[1:] = self._times[k], self._segments[k]
        return min(float(self._times[k + 1]), end)

    def point(self, t: float) -> np.ndarray:
        """Time since the segment began, and its numbers."""
        self._point[0] = t - self._begun
        return self._point


def dae_along(study: Study, corners: Corners, own_stroke: bool) -> tuple[DAE, ca.SX]:
    """The model within a segment of a history.

    Parameters
    ----------
    study : Study
    corners : Corners
        Those that are `Switched` follow the history too.
    own_stroke : bool
        Whether the stroke is that of the history.

    Returns
    -------
    tuple
        The model, behind whose data stand the time since the segment began [s] and the numbers of `Course.segments`; and
        these.
    """
    clock, numbers = ca.SX.sym("clock"), ca.SX.sym("segment", 10)
    V, F, x_s, T = (numbers[k] + numbers[4 + k] * clock for k in range(4))
    load_rate, stroke, stroke_rate = (ca.SX.sym(name) for name in ("load_rate", "stroke", "stroke_rate"))
    symbols = symbolic(study)
    dae = build(symbols, corners, Ride(load_rate, stroke, stroke_rate))
    x_t = numbers[6]
    if not own_stroke:  # in balance
        load = ca.SX.sym("load")
        balance = ca.SX(symbols.study.gear.stroke(load))
        x_s, x_t = (ca.substitute(e, load, F) for e in (balance, ca.densify(ca.jacobian(balance, load)) * numbers[5]))
    radius = study.gear.wheel_radius
    angle = numbers[8] + (numbers[0] * clock + numbers[4] * clock**2 / 2) / radius
    torque = T + numbers[9] * (V / radius) ** 2 * ca.sin(angle)
    of = ca.vertcat(dae.speed, dae.load, dae.yaw_torque, load_rate, stroke, stroke_rate)
    by = ca.vertcat(V, F, torque, numbers[5], x_s, x_t)

    def put(*expressions: Any) -> list[ca.SX]:
        return list(ca.substitute([ca.SX(e) for e in expressions], [of], [by]))

    if isinstance(corners, Switched):
        corners.switches = {
            name: replace(switch, argument=put(switch.argument)[0]) for name, switch in corners.switches.items()
        }
    ode, alg, rest, relaxed = put(dae.ode, dae.alg, dae.rest, dae.relaxed)
    shown = {**dae.outputs, "speed": dae.speed, "vertical_load": dae.load, "external_torque": dae.yaw_torque}
    outputs = dict(zip(shown, put(*shown.values()), strict=True))
    point = ca.vertcat(clock, numbers)
    more: dict[str, Any] = {"data": ca.vertcat(dae.data, point), "outputs": outputs}
    more["output_units"] = {**dae.output_units, "speed": "m/s", "vertical_load": "N", "external_torque": "N m"}
    return replace(dae, ode=ode, alg=alg, rest=rest, relaxed=relaxed, **more), point

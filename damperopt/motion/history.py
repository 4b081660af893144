"""Motion along a history of speed, load and stroke: touchdown, a braked roll, a bump, a whole landing.

Within a row of the history and the next one everything goes in straight lines, and the model is integrated from row to row, so
that no kink lies within a step. The contact line of the tyre lives in the path s, ds = V dt: its field is carried at the
speed of the moment, and stretched where the load changes the length of the footprint. The stroke of a shock strut is that of
the history, or in balance with the load; its rate moves the wheel of a bent strut, and the damper of links at an angle.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import casadi as ca
import numpy as np

from ..errors import ConfigError
from ..expressions.corners import Linear, Smooth
from ..expressions.dae import DAE, eliminate
from ..stability.gear import spectral_abscissa
from ..stability.linear import LinearModel, linearise
from ..study.disturbances import Disturbance
from ..study.history import History, read_history
from ..study.study import Study
from ..symbols import data_values
from .course import Course, dae_along
from .exact import ExactSimulator
from .integrators import ENGINES, Integrator, best_engine
from .question import refuse_start, valid_part
from .trajectory import Trajectory

__all__ = ["Frozen", "frozen_along", "posed_along", "simulate_along"]

MOST_STEPS = 64
"""Output steps of one call of an integrator."""

FROZEN_TIMES = 400
"""At which the frozen gear is looked at."""


@dataclass(frozen=True)
class Frozen:
    """The gear with time held, along a history.

    Attributes
    ----------
    time : ndarray
        (m,) [s]
    speed, load : ndarray
        (m,) [m/s], [N].
    abscissa : ndarray
        (m,) largest real part of its eigenvalues [1/s].
    """

    time: np.ndarray
    speed: np.ndarray
    load: np.ndarray
    abscissa: np.ndarray

    def beyond(self, margin: float) -> list[tuple[float, float]]:
        """Intervals of time [s] in which the abscissa lies above -margin [1/s], their ends between two times."""
        away = self.abscissa + margin
        ends = np.flatnonzero((away[1:] > 0) != (away[:-1] > 0))
        t = self.time[ends] + np.diff(self.time)[ends] * away[ends] / (away[ends] - away[ends + 1])
        edges = [*([self.time[0]] if away[0] > 0 else []), *t, *([self.time[-1]] if away[-1] > 0 else [])]
        return [(float(a), float(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def simulate_along(
    study: Study,
    design: Mapping[str, float] | None = None,
    *,
    history: History | str | Path,
    disturbance: Disturbance | Mapping[str, Any] | None = None,
    engine: str = "auto",
    tolerance: float = 1e-8,
) -> Trajectory:
    """Motion along a history.

    Parameters
    ----------
    study : Study
    design : mapping or None
        Design variables [SI]; None: the starts of the study.
    history : History, str or Path
        Rows, or a CSV file that `read_history` reads.
    disturbance : Disturbance, mapping or None
        At the start; None: what the history itself has as its yaw torque.
    engine : str
        ``erk``, ``cvodes``, ``idas``, ``exact``, or ``auto``: the fastest here.
    tolerance : float
        Of the integrator, relative.

    Returns
    -------
    Trajectory
        With the times of the history; ``speed``, ``vertical_load`` and ``external_torque`` are among its outputs.

    Raises
    ------
    ConfigError
        If the question is not well posed, or nothing disturbs the gear.
    """
    if engine not in ("auto", "exact", *ENGINES):
        raise ConfigError(f"engine: found '{engine}'; allowed: auto, exact, {', '.join(ENGINES)}")
    history = history if isinstance(history, History) else read_history(history)
    model, values = LinearModel(study), study.start if design is None else dict(design)
    course, points = posed_along(study, values, history, disturbance, model)
    if engine == "exact":
        exact = ExactSimulator(study, values, model, course.own_stroke)
        return exact.along(history, disturbance, min(tolerance, 1e-10))
    engine = best_engine() if engine == "auto" else engine
    return _Roll(study, [values[name] for name in model.design_names], course, engine, tolerance).motion(points)


def posed_along(
    study: Study,
    design: Mapping[str, float],
    history: History,
    disturbance: Disturbance | Mapping[str, Any] | None,
    model: LinearModel | None = None,
) -> tuple[Course, int]:
    """Course and output points of a motion along a history, if the question is well posed; else `ConfigError`."""
    if disturbance is None and not any(history.column("yaw_torque") or [0.0]):
        raise ConfigError("disturbance: nothing disturbs the gear; allowed: a disturbance, or a history with yaw_torque")
    model = LinearModel(study) if model is None else model
    gear = model.at(design)
    course = Course.of(history, study, tuple(state.name for state in model.states), disturbance)
    return course, course.points(gear)


class _Roll:
    """One motion on the smooth model."""

    def __init__(self, study: Study, design: list[float], course: Course, engine: str, tolerance: float):
        self._study, self._design, self._course, self._engine = study, design, course, engine
        self._dae, point = dae_along(study, Smooth(), course.own_stroke)
        self._data, self._segments, self._tolerance = np.array(data_values(study)), course.segments(), tolerance
        self._outputs, self._names = _outputs(self._dae)
        self._clock = point[0]

    def motion(self, points: int) -> Trajectory:
        """With so many output points, or more."""
        course, dae = self._course, self._dae
        spans = np.diff(course.time)
        step = spans.sum() / points
        steps = int(np.clip(math.ceil(spans.max() / step), 1, MOST_STEPS))
        run = Integrator(dae, self._values(0, 0.0)[0], steps, self._engine, self._tolerance, clock=self._clock)
        given = [0.0] * len(dae.states) if course.disturbance is None else course.disturbance.start(dae.state_names)
        start = ca.Function("start", [dae.x, dae.design, dae.speed, dae.load, dae.data], [dae.relaxed])
        x = start(given, self._design, 0, 0, self._values(0, 0.0)[0]).full()
        columns, times, message = [self._shown(x, 0, np.zeros(1))], [course.time[:1]], ""
        refuse_start(columns[0], self._names, self._study)
        for k, span in enumerate(spans):
            pieces = math.ceil(span / (steps * step) * (1 - 1e-9))
            for piece in range(pieces):
                begun, length = span * piece / pieces, span / pieces
                try:
                    states = run(x[:, -1], self._design, 0, 0, length, data=self._values(k, 0.0)[0], start=begun).x
                except FloatingPointError as error:
                    message = str(error)
                    break
                elapsed = begun + np.linspace(0, length, steps + 1)
                shown = self._shown(states, k, elapsed)
                kept, message = valid_part(shown, self._names, self._study)
                columns.append(shown[:, 1:kept])
                times.append(course.time[k] + elapsed[1:kept])
                x = states
                if message:
                    break
            if message:
                break
        return self._trajectory(np.concatenate(times), np.hstack(columns), message)

    def _values(self, k: int, clock: Any) -> np.ndarray:
        """(m, p) data, time since the segment began, and its numbers."""
        clock = np.atleast_1d(clock)
        fixed = np.concatenate([self._data, [0.0], self._segments[k]])
        found = np.tile(fixed, (clock.size, 1))
        found[:, self._data.size] = clock
        return found

    def _shown(self, states: np.ndarray, k: int, elapsed: np.ndarray) -> np.ndarray:
        design = ca.repmat(ca.DM(self._design), 1, elapsed.size)
        return self._outputs(states, design, self._values(k, elapsed).T).full()

    def _trajectory(self, time: np.ndarray, values: np.ndarray, message: str) -> Trajectory:
        dae, course = self._dae, self._course
        named = dict(zip(self._names, values, strict=True))
        hidden = {state.name for state in dae.states if state.hidden}
        states = {name: named.pop(name) for name in dae.state_names}
        states = {name: row for name, row in states.items() if name not in hidden}
        message = f"{message} after {time[-1]:.4g} s" if message else ""
        status: Literal["completed", "stopped"] = "stopped" if message else "completed"
        V, F = (float(value[0]) for value in course.at(course.time[:1]))
        return Trajectory(V, F, time, states, named, status, message, self._engine, 0.0, dae.units, course.words())


def _outputs(dae: DAE) -> tuple[ca.Function, tuple[str, ...]]:
    """(states, design, data) -> states and outputs, and their names."""
    model = eliminate(dae)
    outputs = {"yaw_acceleration": model.ode[model.index("yaw_rate")], **model.outputs}
    values = ca.vertcat(model.x, *(ca.SX(value) for value in outputs.values()))
    free = ca.Function("free", [model.x, *model.parameters], [values])
    x, design, data = (ca.SX.sym("u", e.numel()) for e in (model.x, model.design, model.data))
    return ca.Function("outputs", [x, design, data], [free(x, design, 0, 0, data, 0)]), (*model.state_names, *outputs)


def frozen_along(study: Study, design: Mapping[str, float] | None, history: History) -> Frozen:
    """Spectral abscissa of the gear with time held, along a history: where shimmy can grow, and where it must die out.

    Parameters
    ----------
    study : Study
    design : mapping or None
        Design variables [SI]; None: the starts of the study.
    history : History

    Returns
    -------
    Frozen
        Necessary in practice, no proof: growth takes time, and a change of speed and load has a part in it.
    """
    values = study.start if design is None else dict(design)
    model = LinearModel(study)
    model.at(values)
    course = Course.of(history, study, tuple(state.name for state in model.states))
    rows = course.time[:: max(1, course.time.size // FROZEN_TIMES)]
    times = np.union1d(np.linspace(course.time[0], course.time[-1], FROZEN_TIMES), rows)
    V, F = course.at(times)
    if not course.own_stroke:
        return Frozen(times, V, F, model.at(values).abscissa(V, F))
    dae, _ = dae_along(study, Linear(), own_stroke=True)
    at = [np.interp(times, course.time, row) for row in course.values]
    still = np.zeros((times.size, 7))
    numbers = np.vstack([np.tile(data_values(study), (times.size, 1)).T, still[:, :1].T, *at, still[:, :6].T])
    design_columns = np.tile([[values[name]] for name in model.design_names], (1, times.size))
    matrices = linearise(dae)(design_columns, np.zeros((1, times.size)), np.zeros((1, times.size)), numbers).full()
    n = len(dae.states)
    return Frozen(times, V, F, spectral_abscissa(matrices.reshape(n, times.size, n).transpose(1, 0, 2)))

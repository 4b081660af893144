"""Transient motion of a gear after a disturbance, on the nonlinear model with its smooth elements."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import casadi as ca
import numpy as np

from ..dynamics import build
from ..errors import ConfigError
from ..expressions.corners import Smooth
from ..expressions.dae import DAE, eliminate
from ..stability.linear import LinearModel
from ..study.disturbances import Disturbance
from ..study.study import Study
from ..symbols import data_values, symbolic
from .integrators import ENGINES, Integrator, best_engine
from .question import output_points, posed, refuse_start, valid_part
from .trajectory import Trajectory

__all__ = ["Outputs", "Simulator", "simulate"]

STEPS = 256
"""Output steps of one stretch; validity is checked after each stretch."""


def simulate(
    study: Study,
    design: Mapping[str, float] | None = None,
    *,
    speed: float,
    load: float | None = None,
    disturbance: Disturbance | Mapping[str, Any],
    duration: float = 3.0,
    engine: str = "auto",
    tolerance: float = 1e-8,
) -> Trajectory:
    """Motion after a disturbance.

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
        Such as ``{"release": {"yaw_angle": "1 deg"}}``.
    duration : float
        [s]
    engine : str
        ``erk``, ``cvodes``, ``idas``, or ``auto``: the fastest here.
    tolerance : float
        Of the integrator, relative.

    Returns
    -------
    Trajectory
        Cut short, with the status ``stopped``, where the model leaves its validity.

    Raises
    ------
    ConfigError
        If the question is not well posed.

    Notes
    -----
    The model is built, and compiled where there is a compiler, for the first motion of a study; the simulator of the last
    study is kept, so that a loop over designs, speeds, loads or disturbances of one `Study` object builds nothing again.
    `Simulator` is the same by a name of its own.

    Examples
    --------
    >>> import damperopt
    >>> study = damperopt.load("configs/minimal.yaml")
    >>> motion = simulate(study, speed=40, disturbance={"release": {"yaw_angle": "1 deg"}}, duration=0.5)
    >>> motion.status
    'completed'
    """
    return _Last.simulator(study, engine, tolerance)(speed, load, disturbance, duration, design=design)


class Simulator:
    """Transient motion of a gear, built once, for any design, speed, load and disturbance.

    Parameters
    ----------
    study : Study
    design : mapping or None
        Design variables [SI] of calls that give none; None: the starts of the study.
    engine : str
        ``erk``, ``cvodes``, ``idas``, or ``auto``: the fastest here.
    tolerance : float
        Of the integrator, relative.
    model : LinearModel or None
        Of the study, if it is at hand.

    Examples
    --------
    >>> import damperopt
    >>> run = Simulator(damperopt.load("configs/minimal.yaml"), engine="cvodes")
    >>> release = {"release": {"yaw_angle": "1 deg"}}
    >>> dampings = [{"c_lambda": c} for c in (2e4, 4e4)]
    >>> [run(40, None, release, 0.1, design=run.design | c).status for c in dampings]
    ['completed', 'completed']
    """

    def __init__(
        self,
        study: Study,
        design: Mapping[str, float] | None = None,
        engine: str = "auto",
        tolerance: float = 1e-8,
        model: LinearModel | None = None,
    ):
        if engine not in ("auto", *ENGINES):
            raise ConfigError(f"engine: found '{engine}'; allowed: auto, {', '.join(ENGINES)}")
        if not 1e-13 <= tolerance <= 1e-3:
            raise ConfigError(f"tolerance: found {tolerance}; allowed: 1e-13 to 1e-3")
        self.study, self.engine = study, best_engine() if engine == "auto" else engine
        self.tolerance, self.design = tolerance, study.start if design is None else dict(design)
        self._model = LinearModel(study) if model is None else model
        if design is not None:
            self._model.at(self.design)  # refuses an incomplete design
        dae = build(symbolic(study), Smooth())
        self._state_names, self._units = dae.state_names, dae.units
        self._hidden = {state.name for state in dae.states if state.hidden}
        self._integrator = Integrator(dae, data_values(study), STEPS, self.engine, tolerance)
        self._outputs = Outputs(dae, study)
        self._data = data_values(study)
        self._start = ca.Function("start", [dae.x, dae.design, dae.speed, dae.load, dae.data], [dae.relaxed])

    def __call__(
        self,
        speed: float,
        load: float | None,
        disturbance: Disturbance | Mapping[str, Any],
        duration: float,
        *,
        design: Mapping[str, float] | None = None,
    ) -> Trajectory:
        """Motion of a design at `speed` [m/s] and `load` [N] over `duration` [s]; see `simulate`."""
        design = self.design if design is None else design
        gear, values = self._model.at(design), [float(design[name]) for name in self._model.design_names]
        load = max(self.study.envelope.loads) if load is None else load
        disturbance = posed(self.study, self._state_names, speed, load, disturbance, duration)
        stretches = math.ceil(output_points(gear, speed, load, duration) / STEPS)
        stretch, rate = duration / stretches, speed / self.study.gear.wheel_radius
        torque, unbalance = disturbance.yaw_torque, disturbance.unbalance_moment
        given = disturbance.start(self._state_names)
        x = self._start(given, values, speed, load, self._data).full()
        columns, times = [self._outputs(x, values, speed, load, torque)], [np.zeros(1)]
        refuse_start(columns[0], self._outputs.names, self.study)
        message, t, length = "", 0.0, stretch
        while not message and duration - t > 1e-9 * duration:
            length = min(length, duration - t)
            try:
                states = self._integrator(x[:, -1], values, speed, load, length, t, None, torque, unbalance, rate).x
            except FloatingPointError as error:
                length /= 4  # up to where it fails
                message = str(error) if length < stretch / STEPS else ""
                continue
            time = t + np.linspace(0, length, STEPS + 1)
            external = torque + unbalance * rate**2 * np.sin(rate * time)
            shown = self._outputs(states, values, speed, load, external)
            kept, message = valid_part(shown, self._outputs.names, self.study)
            columns.append(shown[:, 1:kept])
            times.append(time[1:kept])
            x, t = states, time[-1]
        time = np.concatenate(times)
        named = dict(zip(self._outputs.names, np.hstack(columns), strict=True))
        states_of = {name: named.pop(name) for name in self._state_names}
        kept_states = {name: values for name, values in states_of.items() if name not in self._hidden}
        if message:
            message = f"{message} after {time[-1]:.4g} s"
        status: Literal["completed", "stopped"] = "stopped" if message else "completed"
        forcing = rate / (2 * math.pi) if unbalance else 0.0
        return Trajectory(speed, load, time, kept_states, named, status, message, self.engine, forcing, self._units)


class _Last:
    """The simulator that `simulate` used last. Studies do not change, so the same object needs no other one."""

    kept: Simulator | None = None

    @classmethod
    def simulator(cls, study: Study, engine: str, tolerance: float) -> Simulator:
        kept = cls.kept
        named = best_engine() if engine == "auto" else engine
        if kept is None or kept.study is not study or (kept.engine, kept.tolerance) != (named, tolerance):
            kept = cls.kept = Simulator(study, None, engine, tolerance)
        return kept


class Outputs:
    """States and outputs of the smooth model at given states, for any design.

    Parameters
    ----------
    dae : DAE
    study : Study

    Attributes
    ----------
    names : tuple of str
        States, yaw_acceleration, and the outputs of the model.
    """

    def __init__(self, dae: DAE, study: Study):
        model = eliminate(dae)
        outputs = {"yaw_acceleration": model.ode[model.index("yaw_rate")], **model.outputs}
        self.names = (*model.state_names, *outputs)
        self._data = ca.DM(data_values(study))
        values = [model.x, *(ca.SX(value) for value in outputs.values())]
        self._function = ca.Function("outputs", [model.x, *model.parameters], [ca.vertcat(*values)])

    def __call__(self, states: np.ndarray, design: Sequence[float], speed: float, load: float, yaw_torque: Any) -> np.ndarray:
        """(k, m) values by `names` at (n, m) states of a design; external yaw torque (m,) or scalar [N m]."""
        m = states.shape[1]
        torque = np.broadcast_to(yaw_torque, m)[None, :]
        columns = [ca.repmat(ca.DM(values), 1, m) for values in (design, self._data)]
        return self._function(states, columns[0], speed, load, columns[1], torque).full()

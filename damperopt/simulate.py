"""Transient motion of a gear after a disturbance, on the nonlinear model with its smooth elements."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import casadi as ca
import numpy as np
from pydantic import ValidationError

from .dae import DAE, eliminate
from .disturbances import Disturbance
from .dynamics import build
from .elements import Smooth
from .errors import ConfigError
from .integrators import ENGINES, NEWTON_STEPS, Integrator, best_engine
from .specs import Study
from .stability import LinearGear, linear_gear
from .symbols import data_values, symbolic
from .trajectory import Trajectory

__all__ = ["Outputs", "Simulator", "output_points", "posed", "refuse_start", "simulate", "valid_part"]

STEPS = 256
"""Output steps of one stretch; validity is checked after each stretch."""

PER_CYCLE = 40
"""Least output points in a cycle of the fastest mode."""

MAX_POINTS = 2_000_000

YAW_RANGE = 1.0
"""Yaw angle [rad] up to which linkage and tyre laws are trusted."""

UNCLOSED = 1e-9
"""Residual of the closed linkage [m^2, m] above which it counts as not closed."""


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

    Examples
    --------
    >>> import damperopt
    >>> study = damperopt.load("configs/minimal.yaml")
    >>> motion = simulate(study, speed=40, disturbance={"release": {"yaw_angle": "1 deg"}}, duration=0.5)
    >>> motion.status
    'completed'
    """
    return Simulator(study, design, engine, tolerance)(speed, load, disturbance, duration)


class Simulator:
    """Transient motion of one gear with one design, at any speed, load and disturbance.

    Parameters
    ----------
    study : Study
    design : mapping or None
        Design variables [SI]; None: the starts of the study.
    engine : str
        ``erk``, ``cvodes``, ``idas``, or ``auto``: the fastest here.
    tolerance : float
        Of the integrator, relative.
    """

    def __init__(self, study: Study, design: Mapping[str, float] | None = None, engine: str = "auto", tolerance: float = 1e-8):
        if engine not in ("auto", *ENGINES):
            raise ConfigError(f"engine: found '{engine}'; allowed: auto, {', '.join(ENGINES)}")
        if not 1e-13 <= tolerance <= 1e-3:
            raise ConfigError(f"tolerance: found {tolerance}; allowed: 1e-13 to 1e-3")
        self.study, self.engine = study, best_engine() if engine == "auto" else engine
        design = study.start if design is None else design
        self._gear = linear_gear(study, design)  # refuses an incomplete design
        dae = build(symbolic(study), Smooth())
        self._state_names = dae.state_names
        self._design = [design[name] for name in dae.design_names]
        self._integrator = Integrator(dae, data_values(study), STEPS, self.engine, tolerance)
        self._outputs = Outputs(dae, study, self._design)

    def __call__(
        self, speed: float, load: float | None, disturbance: Disturbance | Mapping[str, Any], duration: float
    ) -> Trajectory:
        """Motion at `speed` [m/s] and `load` [N] over `duration` [s]; see `simulate`."""
        load = max(self.study.envelope.loads) if load is None else load
        disturbance = posed(self.study, self._state_names, speed, load, disturbance, duration)
        stretches = math.ceil(output_points(self._gear, speed, load, duration) / STEPS)
        stretch, rate = duration / stretches, speed / self.study.gear.wheel_radius
        torque, unbalance = disturbance.yaw_torque, disturbance.unbalance_moment
        x = np.array(disturbance.start(self._state_names))[:, None]
        columns, times = [self._outputs(x, speed, load, torque)], [np.zeros(1)]
        refuse_start(columns[0], self._outputs.names, self.study)
        message, t, length = "", 0.0, stretch
        while not message and duration - t > 1e-9 * duration:
            length = min(length, duration - t)
            try:
                states = self._integrator(x[:, -1], self._design, speed, load, length, t, None, torque, unbalance, rate).x
            except FloatingPointError as error:
                length /= 4  # up to where it fails
                message = str(error) if length < stretch / STEPS else ""
                continue
            time = t + np.linspace(0, length, STEPS + 1)
            values = self._outputs(states, speed, load, torque + unbalance * rate**2 * np.sin(rate * time))
            kept, message = valid_part(values, self._outputs.names, self.study)
            columns.append(values[:, 1:kept])
            times.append(time[1:kept])
            x, t = states, time[-1]
        values, time = np.hstack(columns), np.concatenate(times)
        named = dict(zip(self._outputs.names, values, strict=True))
        kept_states = {name: named.pop(name) for name in self._state_names}
        if message:
            message = f"{message} after {time[-1]:.4g} s"
        return Trajectory(speed, load, time, kept_states, named, "stopped" if message else "completed", message, self.engine)


def output_points(gear: LinearGear, speed: float, load: float, duration: float) -> int:
    """Output points that show every cycle of the fastest mode.

    Parameters
    ----------
    gear : LinearGear
    speed, load, duration : float
        [m/s], [N], [s]

    Returns
    -------
    int

    Raises
    ------
    ConfigError
        If they would be too many.
    """
    fastest = np.abs(np.linalg.eigvals(gear.matrices(speed, load)[0]).imag).max()
    step = 2 * math.pi / max(fastest, 20.0) / PER_CYCLE
    if duration > MAX_POINTS * step:
        longest = MAX_POINTS * step
        raise ConfigError(f"duration: found {duration:g} s; allowed: at most {longest:.3g} s for oscillations this fast")
    return math.ceil(duration / step)


class Outputs:
    """States and outputs of the smooth model at given states.

    Parameters
    ----------
    dae : DAE
    study : Study
    design : sequence of float
        Design variables [SI].

    Attributes
    ----------
    names : tuple of str
        States, yaw_acceleration, and the outputs of the model.
    """

    def __init__(self, dae: DAE, study: Study, design: Sequence[float]):
        model = eliminate(dae, NEWTON_STEPS)
        outputs = {"yaw_acceleration": model.ode[1], **model.outputs}
        self.names = (*model.state_names, *outputs)
        self._known = ca.DM(design), ca.DM(data_values(study))
        values = [model.x, *(ca.SX(value) for value in outputs.values())]
        self._function = ca.Function("outputs", [model.x, *model.parameters], [ca.vertcat(*values)])

    def __call__(self, states: np.ndarray, speed: float, load: float, yaw_torque: Any) -> np.ndarray:
        """(k, m) values by `names` at (n, m) states; external yaw torque (m,) or scalar [N m]."""
        design, data = self._known
        m = states.shape[1]
        torque = np.broadcast_to(yaw_torque, m)[None, :]
        return self._function(states, ca.repmat(design, 1, m), speed, load, ca.repmat(data, 1, m), torque).full()


def refuse_start(values: np.ndarray, names: Sequence[str], study: Study) -> None:
    """`ConfigError` if the start, one column of `values` by `names`, lies beyond the validity of the model."""
    _, beyond = valid_part(values, names, study)
    if beyond:
        raise ConfigError(f"disturbance: {beyond} at the start; allowed: a smaller one")


def valid_part(values: np.ndarray, names: Sequence[str], study: Study) -> tuple[int, str]:
    """How many of the columns lie within the validity of the model, and what is left first.

    Parameters
    ----------
    values : ndarray
        (k, m) rows by `names`.
    names : sequence of str
    study : Study

    Returns
    -------
    tuple of int and str
        The message is empty where all are valid; else the first invalid column is counted in.
    """
    slip_range = study.tyre.slip_range
    limits = [
        ("yaw_angle", YAW_RANGE, f"the yaw angle exceeds {YAW_RANGE:g} rad"),
        ("unclosed", UNCLOSED, "the equations of the closed linkage are not solved"),
        ("slip_angle", slip_range, f"the slip exceeds tyre.slip_range, {math.degrees(slip_range):.4g} deg"),
    ]
    stop = study.damper.end_stop
    if stop is not None and stop.stiffness is None:
        limits.append(("damper_stroke", stop.stroke, f"the damper meets its stop at {stop.stroke * 1e3:.4g} mm"))
    first, message = values.shape[1], ""
    for name, limit, words in limits:
        beyond = np.flatnonzero(~(np.abs(values[names.index(name)]) <= limit))
        if beyond.size and beyond[0] + 1 < first + (not message):
            first, message = int(beyond[0]) + 1, words
    return first, message


def posed(
    study: Study,
    state_names: tuple[str, ...],
    speed: float,
    load: float,
    disturbance: Disturbance | Mapping[str, Any],
    duration: float,
) -> Disturbance:
    """The disturbance, if the question is well posed.

    Parameters
    ----------
    study : Study
    state_names : tuple of str
        States of its gear.
    speed, load, duration : float
        [m/s], [N], [s]
    disturbance : Disturbance or mapping

    Returns
    -------
    Disturbance

    Raises
    ------
    ConfigError
        If a number is not positive and finite, or the gear lacks what is disturbed.
    """
    for name, value, unit in (("speed", speed, "m/s"), ("load", load, "N"), ("duration", duration, "s")):
        if not 0 < value < np.inf:
            raise ConfigError(f"{name}: found {value}; allowed: a positive number in {unit}")
    try:
        disturbance = Disturbance.model_validate(disturbance)
    except ValidationError as error:
        problems = [f"disturbance.{'.'.join(map(str, p['loc']))}: {p['msg']}" for p in error.errors(include_url=False)]
        raise ConfigError(problems) from None
    given = disturbance.initial_values
    lacking = [name for name, value in given.items() if value and name not in state_names]
    if lacking:
        raise ConfigError(
            f"disturbance: found {lacking[0]}, which a gear of order {study.gear.order} does not have; "
            f"allowed: {', '.join(state_names)}"
        )
    return disturbance

"""Whether a question about a motion is well posed, how finely it is answered, and how far the answer is valid."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from pydantic import ValidationError

from ..errors import ConfigError
from ..stability.delay import DelayGear
from ..stability.gear import LinearGear
from ..study.disturbances import Disturbance
from ..study.study import Study
from .measure import fastest_rate

__all__ = ["UNCLOSED", "output_points", "posed", "refuse_start", "valid_part"]

PER_CYCLE = 40
"""Least output points in a cycle of the fastest mode."""

MAX_POINTS = 2_000_000

YAW_RANGE = 1.0
"""Yaw angle [rad] up to which linkage and tyre laws are trusted."""

MOST_ACCELERATION = 1e6
"""Yaw acceleration [rad/s^2] by a torque above which nothing is simulated: within 1.5 ms it turns the gear out of its range."""

COARSE = 1e-5
"""Relative error of eigenvalues above which a contact line as a field has too low an order for a motion."""

UNCLOSED = 1e-9
"""Residual of the closed linkage [m^2, m] above which it counts as not closed."""


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
    if isinstance(gear, DelayGear) and (error := gear.field_error(speed, load)) > COARSE:
        raise ConfigError(
            f"tyre.contact.order: found one with which eigenvalues at {speed:g} m/s are wrong by {error:.1g} of themselves; "
            f"allowed: a larger one for motions at this speed ({COARSE:g} at most)"
        )
    step = 2 * math.pi / fastest_rate(gear.visible(speed, load)[0]) / PER_CYCLE
    if duration > MAX_POINTS * step:
        longest = MAX_POINTS * step
        raise ConfigError(f"duration: found {duration:g} s; allowed: at most {longest:.3g} s for oscillations this fast")
    return math.ceil(duration / step)


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
    ]
    slip = f"the slip exceeds tyre.slip_range, {math.degrees(slip_range):.4g} deg"
    limits += [(name, slip_range, slip) for name in names if name.startswith("slip_angle")]  # of every wheel
    stop = study.damper.stop
    if stop is not None and stop.stiffness is None:
        rotary = study.damper.ROTARY
        where = f"{math.degrees(stop.stroke):.4g} deg" if rotary else f"{stop.stroke * 1e3:.4g} mm"
        limits.append(("damper_angle" if rotary else "damper_stroke", stop.stroke, f"the damper meets its stop at {where}"))
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
        If a number is not positive and finite, the tyre has no data for the load, or the gear lacks what is disturbed.
    """
    for name, value, unit in (("speed", speed, "m/s"), ("load", load, "N"), ("duration", duration, "s")):
        if not 0 < value < np.inf:
            raise ConfigError(f"{name}: found {value}; allowed: a positive number in {unit}")
    if words := study.beyond_data(load):
        raise ConfigError(f"load: {load / 1e3:.6g} kN {words}; allowed: loads that tyre and strut have data for")
    try:
        disturbance = Disturbance.model_validate(disturbance)
    except ValidationError as error:
        problems = [f"disturbance.{'.'.join(map(str, p['loc']))}: {p['msg']}" for p in error.errors(include_url=False)]
        raise ConfigError(problems) from None
    rate, inertia = speed / study.gear.wheel_radius, study.gear.yaw_inertia
    torques = {"step.yaw_torque": (disturbance.yaw_torque, 1.0, "N m")}
    torques["unbalance.moment"] = disturbance.unbalance_moment, rate**2, "kg m^2"
    for key, (value, lever, unit) in torques.items():
        if not abs(value) * lever <= MOST_ACCELERATION * inertia:
            largest = MOST_ACCELERATION * inertia / lever
            raise ConfigError(f"disturbance.{key}: found {value:g} {unit}; allowed: at most {largest:.3g} {unit} for this gear")
    given = disturbance.initial_values
    lacking = [name for name, value in given.items() if value and name not in state_names]
    if lacking:
        raise ConfigError(
            f"disturbance: found {lacking[0]}, which a gear of order {study.gear.order} does not have; "
            f"allowed: {', '.join(state_names)}"
        )
    return disturbance

"""The linear gear as state-space matrices over speed and load, for other tools: x' = A x + B u, y = C x + D u.

u is a torque on the gear about the strut axis, y the states of yaw and what damper and tyres show. With a contact line that
remembers, the matrices are those of the line as a field of a stated order; beside them stands the exact gear,
lambda x = (A_0 + sum over wheels of (f b_F - m b_M) e') x with the weights f, m of `tyres.string`, E = exp(-lambda delay).
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from ..dynamics import build
from ..errors import ConfigError
from ..quantities.named import Output
from ..study.study import Study
from ..symbols import data_values, symbolic
from .delay import LENGTH, DelayGear
from .linear import LinearModel
from .response import FOOTPRINT

__all__ = ["Delay", "StateSpace", "state_space"]

YAW = "yaw"
"""Degree of freedom whose states are outputs."""

SHOWN = (
    *(f"damper_{name}" for name in ("stroke", "speed", "force", "angle", "rate", "torque")),
    *(f"{name}{side}" for name in ("side_force", "aligning_moment") for side in ("", "_left", "_right")),
)
"""Other outputs, of those that a study has."""


@dataclass(frozen=True)
class Delay:
    """The exact gear with its delay over p speeds and q loads; w wheels, n states.

    Attributes
    ----------
    states : tuple of Output
        Of the structure, and the foremost contact point of each wheel.
    A_0 : ndarray
        (p, q, n, n) without what the contact lines remember.
    b : ndarray
        (p, q, n, 2 w) columns b_F, -b_M of each wheel.
    footprint : ndarray
        (p, q, w, 12) numbers of each wheel's contact line.
    footprint_names : tuple of str
        Of these.
    delay : ndarray
        (p, q, w) 2 a/V [s].
    field_error : ndarray
        (p, q) how far, relative, eigenvalues of the field's matrices are from the exact ones.
    """

    states: tuple[Output, ...]
    A_0: np.ndarray
    b: np.ndarray
    footprint: np.ndarray
    footprint_names: tuple[str, ...]
    delay: np.ndarray
    field_error: np.ndarray


@dataclass(frozen=True)
class StateSpace:
    """Matrices over p speeds and q loads.

    Attributes
    ----------
    speeds, loads : ndarray
        (p,) [m/s], (q,) [N].
    A, B, C, D : ndarray
        (p, q, n, n), (p, q, n, 1), (p, q, m, n), (p, q, m, 1) [SI].
    states, inputs, outputs : tuple of Output
        Names and units.
    design : mapping of str to float
        [SI]
    contact : str
        The contact line in words, with its order where it stands for a delay.
    delay : Delay or None
        None where there is none.
    """

    speeds: np.ndarray
    loads: np.ndarray
    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: np.ndarray
    states: tuple[Output, ...]
    inputs: tuple[Output, ...]
    outputs: tuple[Output, ...]
    design: Mapping[str, float]
    contact: str
    delay: Delay | None


def state_space(
    study: Study, design: Mapping[str, float], speeds: Sequence[float], loads: Sequence[float], order: int | None = None
) -> StateSpace:
    """State-space matrices of a study with a design.

    Parameters
    ----------
    study : Study
    design : mapping of str to float
        Design variables by name [SI].
    speeds, loads : sequence of float
        Grid [m/s], [N].
    order : int or None
        Of the contact line as a field, where it remembers; None: the study's own.

    Raises
    ------
    ConfigError
        If an order is given for a contact line without delay.
    """
    line: Any = study.tyre.contact
    if order is not None:
        if line.RATIONAL:
            raise ConfigError(f"--order: found {order}, but tyre.contact '{line.contact}' has no delay; allowed: no --order")
        study = study.replace(tyre__contact={**line.model_dump(exclude={"contact"}), "kind": line.contact, "order": order})
        line = study.tyre.contact
    gear = LinearModel(study).at(design)
    V, F_z = (grid.ravel() for grid in np.meshgrid(speeds, loads, indexing="ij"))
    system, outputs = _system(study)
    p, q, n, m = len(speeds), len(loads), len(gear.states), len(outputs)
    values = ca.DM([design[name] for name in study.variable_names])
    data = ca.DM(data_values(study))
    whole = np.array([system(values, v, f, data).full() for v, f in zip(V, F_z, strict=True)]).reshape(p, q, n + m, n + 1)
    words = str(line.contact)
    delay = None
    if isinstance(gear, DelayGear):
        words = f"{line.contact}: as a field of order {line.order}, which stands for its delay"
        delay = _delay(gear, V, F_z, (p, q))
    return StateSpace(
        np.asarray(speeds, float),
        np.asarray(loads, float),
        whole[:, :, :n, :n],
        whole[:, :, :n, n:],
        whole[:, :, n:, :n],
        whole[:, :, n:, n:],
        tuple(Output(state.name, state.unit) for state in gear.states),
        (Output("yaw_torque", "N m", "about the strut axis"),),
        outputs,
        dict(design),
        words,
        delay,
    )


def _system(study: Study) -> tuple[ca.Function, tuple[Output, ...]]:
    """(design, speed, load, data) -> [[A, B], [C, D]], and the outputs."""
    dae = build(symbolic(study))
    yaw = [i for i, state in enumerate(dae.states) if state.freedom == YAW]
    shown = [name for name in SHOWN if name in dae.outputs]
    outputs = *(Output(dae.states[i].name, dae.states[i].unit) for i in yaw), *(Output(n, dae.output_units[n]) for n in shown)
    f = ca.vertcat(dae.ode, *(dae.x[i] for i in yaw), *(ca.SX(dae.outputs[name]) for name in shown))
    v = ca.vertcat(dae.x, dae.yaw_torque)
    at_rest = ca.vertcat(v, dae.z), ca.vertcat(ca.SX.zeros(v.shape), dae.rest)
    f_v, f_z, g_v, g_z = (ca.substitute(ca.jacobian(e, of), *at_rest) for e, of in itertools.product((f, dae.alg), (v, dae.z)))
    system = ca.densify(f_v - f_z @ ca.inv_minor(g_z) @ g_v if dae.z.numel() else f_v)
    return ca.Function("system", [dae.design, dae.speed, dae.load, dae.data], [system]), outputs


def _delay(gear: DelayGear, V: np.ndarray, F_z: np.ndarray, shape: tuple[int, int]) -> Delay:
    frozen = gear.frozen(V, F_z)
    error = np.array([gear.field_error(float(v), float(f)) for v, f in zip(V, F_z, strict=True)])
    return Delay(
        tuple(Output(state.name, state.unit) for state in gear.principal),
        frozen.A_0.reshape(*shape, *frozen.A_0.shape[1:]),
        np.moveaxis(frozen.b, 1, 2).reshape(*shape, frozen.b.shape[2], frozen.b.shape[1]),
        frozen.numbers.reshape(*shape, *frozen.numbers.shape[1:]),
        FOOTPRINT,
        (frozen.numbers[:, :, LENGTH] / V[:, None]).reshape(*shape, -1),
        error.reshape(shape),
    )

"""The record that joins model and analysis: a semi-explicit DAE in named symbols."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import casadi as ca

from ..quantities.named import State

__all__ = ["DAE", "NEWTON_STEPS", "eliminate"]

NEWTON_STEPS = 6
"""Enough for the residual of a closed linkage to reach rounding at yaw angles up to 0.6 rad."""


@dataclass(frozen=True)
class DAE:
    """x' = ode(x, z, design, speed, load, data), 0 = alg(...), with x = 0, z = rest an equilibrium.

    Attributes
    ----------
    x, z : casadi.SX
        (n,) states and (m,) algebraic unknowns.
    design, data : casadi.SX
        Design variables and the numbers of the study.
    speed, load : casadi.SX
        Operating point: V [m/s], F_z [N].
    yaw_torque : casadi.SX
        External torque on the gear about the strut axis [N m].
    ode, alg : casadi.SX
        (n,) and (m,) right-hand sides.
    rest : casadi.SX
        (m,) algebraic unknowns at x = 0; of design and data.
    relaxed : casadi.SX
        (n,) the states when those of the gear and its tyres are held as `x` says, for long; of x, design and data.
    outputs : mapping of str to SX
        Other quantities by name [SI].
    output_units : mapping of str to str
        Their SI units.
    states : tuple of State
        Declarations of the states, in the order of `x`.
    design_names, data_names : tuple of str
        Names, in the order of the vectors.
    newton_steps : int
        From the first-order guess of the unknowns to a solution.
    """

    x: ca.SX
    z: ca.SX
    design: ca.SX
    data: ca.SX
    speed: ca.SX
    load: ca.SX
    yaw_torque: ca.SX
    ode: ca.SX
    alg: ca.SX
    rest: ca.SX
    relaxed: ca.SX
    states: tuple[State, ...]
    design_names: tuple[str, ...]
    data_names: tuple[str, ...]
    outputs: Mapping[str, Any] = field(default_factory=dict)
    output_units: Mapping[str, str] = field(default_factory=dict)
    newton_steps: int = NEWTON_STEPS

    @property
    def state_names(self) -> tuple[str, ...]:
        """Names of the states, in the order of `x`."""
        return tuple(state.name for state in self.states)

    @property
    def units(self) -> dict[str, str]:
        """SI unit of every state and output by name, of what simulations add to them, and of time."""
        added = {"time": "s", "yaw_acceleration": "rad/s^2", "unclosed": "m"}
        return {state.name: state.unit for state in self.states} | dict(self.output_units) | added

    def index(self, name: str) -> int:
        """Position of a state in `x`."""
        return self.state_names.index(name)

    @property
    def parameters(self) -> list[ca.SX]:
        """[design, speed, load, data, yaw_torque]: everything that is neither state nor unknown."""
        return [self.design, self.speed, self.load, self.data, self.yaw_torque]

    def first_guess(self) -> ca.SX:
        """Algebraic unknowns to first order about rest."""
        if not self.z.numel():
            return self.rest
        at_rest = ca.vertcat(self.x, self.z), ca.vertcat(ca.SX.zeros(self.x.shape), self.rest)
        slope = ca.inv_minor(ca.jacobian(self.alg, self.z)) @ ca.jacobian(self.alg, self.x)
        return self.rest - ca.substitute(slope, *at_rest) @ self.x


def eliminate(dae: DAE, iterations: int | None = None) -> DAE:
    """The same system without algebraic unknowns: Newton's method from the first-order guess, written out.

    Parameters
    ----------
    dae : DAE
    iterations : int or None
        Newton steps; each about squares the error once it is small. None: those of the system.

    Returns
    -------
    DAE
        With z empty. `unclosed` among its outputs is the largest residual that is left: where it is not small, the unknowns
        have no solution near rest (the linkage cannot close) or need more steps.
    """
    if not dae.z.numel():
        return replace(dae, outputs={**dae.outputs, "unclosed": ca.SX(0)})
    z = ca.SX.sym("z", dae.z.numel())
    inputs = [dae.x, z, *dae.parameters]
    residual = ca.Function("residual", [dae.x, dae.z, *dae.parameters], [dae.alg])
    step = -ca.inv_minor(ca.jacobian(residual(*inputs), z)) @ residual(*inputs)
    newton = ca.Function("newton", inputs, [z + step])
    closed = dae.first_guess()
    for _ in range(dae.newton_steps if iterations is None else iterations):
        closed = newton(dae.x, closed, *dae.parameters)
    # functions of x alone, evaluated once however often they occur
    names = list(dae.outputs)
    expressions = [dae.ode, *(ca.SX(dae.outputs[name]) for name in names)]
    values = ca.Function("closed", [dae.x, dae.z, *dae.parameters], expressions)(dae.x, closed, *dae.parameters)
    outputs = dict(zip(names, values[1:], strict=True))
    outputs["unclosed"] = ca.norm_inf(residual(dae.x, closed, *dae.parameters))
    return replace(dae, z=ca.SX(0, 1), alg=ca.SX(0, 1), rest=ca.SX(0, 1), ode=values[0], outputs=outputs)

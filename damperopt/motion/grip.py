"""Dry friction that sticks: the corner of a model that holds, and what it takes to hold it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import casadi as ca

from ..errors import ConfigError
from ..expressions.corners import Switch, Switched
from ..expressions.dae import DAE

__all__ = ["FRICTIONS", "grip_of", "one_friction", "slopes_of"]

FRICTIONS = ("friction", "damper friction")
"""Corners at which the motion sticks: of the strut, and of a damper."""


def one_friction(dae: DAE, corners: Switched) -> tuple[DAE, Switch | None]:
    """The friction of a model, taken out of its other corners; one mode for all that rubs at the same rate."""
    found = [corners.switches.pop(name) for name in FRICTIONS if name in corners.switches]
    found = [switch for switch in found if ca.depends_on(ca.vertcat(dae.ode, dae.alg), switch.mode)]
    if len(found) == 2:
        if not ca.is_equal(ca.SX(found[0].argument), ca.SX(found[1].argument), 10):
            raise ConfigError("friction of strut and damper at two places cannot be simulated exactly; allowed: one of the two")
        ode, alg = (ca.substitute(rows, found[1].mode, found[0].mode) for rows in (dae.ode, dae.alg))
        outputs = {name: ca.substitute(ca.SX(value), found[1].mode, found[0].mode) for name, value in dae.outputs.items()}
        dae = replace(dae, ode=ode, alg=alg, outputs=outputs)
    return dae, found[0] if found else None


def grip_of(dae: DAE, friction: Switch | None) -> Any:
    """Rate at which the friction rubs; its derivative without friction; what full friction takes off that; d rate/dx."""
    if friction is None:
        return ca.SX.zeros(3 + dae.x.numel())
    rate = ca.SX(friction.argument)
    slope = slopes_of(dae, rate)
    change = slope @ dae.ode
    return ca.vertcat(rate, ca.substitute(change, friction.mode, 0), -ca.jacobian(change, friction.mode), slope.T)


def slopes_of(dae: DAE, rows: Any) -> Any:
    """d rows/dx, with the unknowns that go with x."""
    if not dae.z.numel():
        return ca.jacobian(rows, dae.x)
    by_unknowns = ca.jacobian(rows, dae.z) @ ca.inv_minor(ca.jacobian(dae.alg, dae.z))
    return ca.jacobian(rows, dae.x) - by_unknowns @ ca.jacobian(dae.alg, dae.x)

"""The record that joins model and analysis: a semi-explicit DAE in named symbols."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

__all__ = ["DAE"]


@dataclass(frozen=True)
class DAE:
    """x' = ode(x, z, design, speed, load, data), 0 = alg(...), with x = 0 an equilibrium.

    Attributes
    ----------
    x, z : casadi.SX
        (n,) states and (m,) algebraic unknowns; `state_names` names the states.
    design, data : casadi.SX
        Design variables and the numbers of the study.
    speed, load : casadi.SX
        Operating point: V [m/s], F_z [N].
    ode, alg : casadi.SX
        (n,) and (m,) right-hand sides.
    state_names, design_names, data_names : tuple of str
        Names, in the order of the vectors.
    """

    x: ca.SX
    z: ca.SX
    design: ca.SX
    data: ca.SX
    speed: ca.SX
    load: ca.SX
    ode: ca.SX
    alg: ca.SX
    state_names: tuple[str, ...]
    design_names: tuple[str, ...]
    data_names: tuple[str, ...]

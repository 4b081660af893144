"""Records of a damper linkage: lengths and levers as expressions of the yaw angle."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import casadi as ca

__all__ = ["Linkage", "Position"]


@dataclass(frozen=True)
class Position:
    """The linkage at a yaw angle; expressions.

    Attributes
    ----------
    deflection, stroke : SX
        Deflection eps of the spring or arm tip, and stroke s of the damper from rest [m].
    spring_lever, damper_lever : SX
        d eps/d psi and ds/d psi [m/rad].
    """

    deflection: Any
    spring_lever: Any
    stroke: Any
    damper_lever: Any


@dataclass(frozen=True)
class Linkage:
    """A damper layout; expressions in the design variables.

    Attributes
    ----------
    stiffness, damping : SX
        k_eps [N/m] along the deflection and c_lambda [N s/m] along the stroke.
    at : callable
        psi [rad] -> Position.
    spring_lever, damper_lever : SX
        d eps/d psi and ds/d psi at psi = 0 [m/rad].
    reach : SX
        Horizontal distance of the apex from the strut axis, L sin(gamma) [m].
    arm_length : SX or None
        Length of the bending arm that enters its bending [m].
    damper_length : SX or None
        Pin-to-pin length of the damper [m]; None where the layout does not limit it.
    unknowns, rest : SX
        (m,) algebraic unknowns of the closed loop, and their values at psi = 0; empty unless `spatial`.
    closure : callable
        psi -> (m,) residual, zero where the loop is closed.
    """

    stiffness: Any
    damping: Any
    at: Callable[[Any], Position]
    spring_lever: Any
    damper_lever: Any
    reach: Any
    arm_length: Any = None
    damper_length: Any = None
    unknowns: ca.SX = field(default_factory=lambda: ca.SX(0, 1))
    rest: ca.SX = field(default_factory=lambda: ca.SX(0, 1))
    closure: Callable[[Any], ca.SX] = lambda psi: ca.SX(0, 1)

    @property
    def torsional_stiffness(self) -> Any:
        """k_psi [N m/rad] at psi = 0."""
        return self.stiffness * self.spring_lever**2

    @property
    def torsional_damping(self) -> Any:
        """c_psi [N m s/rad] at psi = 0."""
        return self.damping * self.damper_lever**2

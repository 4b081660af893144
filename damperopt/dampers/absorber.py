"""Tuned absorber on the yaw axis: an inertia on a spring and a damper, beside the viscous damping of the gear."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar, Literal

from ..expressions.calculus import Expr
from ..expressions.corners import Corners
from ..ports.sizing import Force
from ..quantities.named import State
from ..quantities.record import Inertia, TorsionalDamping, TorsionalStiffness
from ..quantities.units import Quantity
from .base import Context, Damper

__all__ = ["Absorber"]


class Absorber(Damper):
    """Tuned absorber, I_a chi'' = c_a (psi' - chi') + k_a (psi - chi) + k_3 (psi - chi)^3, beside T = c_psi psi'."""

    ROTARY: ClassVar = True
    STATES: ClassVar = (
        State("absorber_angle", "rad", "absorber", twin="absorber_rate"),
        State("absorber_rate", "rad/s", "absorber", twin="absorber_angle"),
    )

    kind: Literal["absorber"]
    absorber_inertia: Inertia
    """I_a about the yaw axis; at a radius r a mass I_a/r^2 [kg m^2]."""
    absorber_stiffness: TorsionalStiffness
    """k_a [N m/rad]."""
    absorber_damping: TorsionalDamping
    """c_a [N m s/rad]."""
    cubic_stiffness: Annotated[float, Quantity("N m/rad^3", at_least=0, example="1e6 N m/rad^3")] = 0.0
    """k_3 [N m/rad^3]."""
    torsional_damping: TorsionalDamping = 0.0
    """c_psi about the yaw axis, of what damps beside it [N m s/rad]."""

    def force(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        rate: Expr,
        context: Context,
        corners: Corners,
    ) -> Force:
        """T = c_psi psi' + T_a with I_a chi'' = T_a."""
        twist, twist_rate = stroke - states["absorber_angle"], rate - states["absorber_rate"]
        torque = self.absorber_damping * twist_rate + self.absorber_stiffness * twist + self.cubic_stiffness * twist**3
        rates = {"absorber_angle": states["absorber_rate"], "absorber_rate": torque / self.absorber_inertia}
        return Force(self.torsional_damping * rate + torque, rates)

    def equivalent(
        self, design: Mapping[str, Expr], amplitude: Expr, frequency: Expr, context: Context
    ) -> tuple[Expr, Expr] | None:
        """(k_a + s c_a) I_a s^2/(I_a s^2 + c_a s + k_a) at s = i omega; None with a cubic spring."""
        if self.cubic_stiffness:
            return None
        I_a, k, c, omega = self.absorber_inertia, self.absorber_stiffness, self.absorber_damping, frequency
        inertia, open_ = -I_a * omega**2, k - I_a * omega**2
        size = open_**2 + (c * omega) ** 2
        stiffness = inertia * (k * open_ + (c * omega) ** 2) / size
        return stiffness, self.torsional_damping + inertia * c * (open_ - k) / size

    def leaves_out(self) -> tuple[str, ...]:
        """Room and ageing."""
        return ("the room that the absorber needs, and a spring that changes with temperature and age",)

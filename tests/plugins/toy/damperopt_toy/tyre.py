"""Slip laws of a company: the cornering stiffness saturates with the load, or grows with its root."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from damperopt.expressions.calculus import Expr, sin, sqrt
from damperopt.expressions.corners import Corners
from damperopt.ports.sizing import Peaks
from damperopt.quantities.record import Distance, Force
from damperopt.quantities.units import Quantity
from damperopt.tyres.base import Linear, SlipLaw


class SaturatingLaw(SlipLaw):
    """F_y = C_Fa sin(2 alpha)/2 with C_Fa = c_0 F_z (1 - F_z/(2 F_0)); M_z = t F_y."""

    LOAD_POWERS: ClassVar = (0, 1, 2)

    law: Literal["saturating"]
    cornering_slope: Annotated[float, Quantity("1/rad", above=0, example="8 1/rad")]
    """c_0, slope of F_y/F_z over the slip angle at a small load [1/rad]."""
    saturation_load: Force
    """F_0, load of the largest cornering stiffness [N]."""
    pneumatic_trail: Distance
    """t [m]."""

    def cornering_stiffness(self, load: Expr) -> Expr:
        """C_Fa [N/rad]."""
        return self.cornering_slope * load * (1 - load / (2 * self.saturation_load))

    def linear(self, load: Expr, pressure: Expr) -> Linear:
        """C_Fa, and t C_Fa."""
        shared = self.relaxation_length, self.half_contact_length
        stiffness = self.cornering_stiffness(load)
        return Linear(stiffness, self.pneumatic_trail * stiffness, *shared)

    def force(self, alpha_F: Expr, load: Expr, pressure: Expr) -> Expr:
        """F_y [N]."""
        return self.cornering_stiffness(load) * sin(2 * alpha_F) / 2

    def moment(self, alpha_M: Expr, load: Expr, pressure: Expr, corners: Corners) -> Expr:
        """M_z [N m]."""
        return self.pneumatic_trail * self.force(alpha_M, load, pressure)

    def peaks(self, load: Expr, pressure: Expr) -> Peaks:
        """Both at 45 degrees."""
        force = self.cornering_stiffness(load) / 2
        return Peaks(force, self.pneumatic_trail * force)


class RootLaw(SaturatingLaw):
    """As saturating, with C_Fa = c_0 sqrt(F_z F_0): no polynomial in the load."""

    LOAD_POWERS: ClassVar = None

    law: Literal["root"]

    def cornering_stiffness(self, load: Expr) -> Expr:
        """C_Fa [N/rad]."""
        return self.cornering_slope * sqrt(load * self.saturation_load)

"""Force and moment in proportion to slip angle and load."""

from __future__ import annotations

from typing import Annotated, Literal

from ...expressions.calculus import Expr
from ...expressions.corners import Corners
from ...quantities.units import Quantity
from ..base import Linear, SlipLaw

__all__ = ["LinearLaw"]


class LinearLaw(SlipLaw):
    """F_y = cornering_slope alpha F_z and M_z = aligning_coefficient alpha F_z."""

    law: Literal["linear"]
    cornering_slope: Annotated[float, Quantity("1/rad", at_least=0, example="8 1/rad")]
    """Slope of F_y/F_z over the slip angle [1/rad]."""
    aligning_coefficient: Annotated[float, Quantity("m/rad", example="0.5 m/rad")]
    """C_M, slope of M_z/F_z over the slip angle, + where it restores [m/rad]."""

    def linear(self, load: Expr, pressure: Expr) -> Linear:
        """Both stiffnesses in proportion to the load."""
        shared = self.relaxation_length, self.half_contact_length  # type: ignore[attr-defined]  # of the tyre it belongs to
        return Linear(self.cornering_slope * load, self.aligning_coefficient * load, *shared)

    def force(self, alpha_F: Expr, load: Expr, pressure: Expr) -> Expr:
        """F_y [N]."""
        return self.cornering_slope * alpha_F * load

    def moment(self, alpha_M: Expr, load: Expr, pressure: Expr, corners: Corners) -> Expr:
        """M_z [N m]."""
        return self.aligning_coefficient * alpha_M * load

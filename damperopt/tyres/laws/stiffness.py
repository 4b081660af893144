"""Force and moment by stiffnesses that do not depend on the load, or by the string that they come from."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal, Self

from pydantic import model_validator

from ...expressions.calculus import Expr, tan
from ...expressions.corners import Corners
from ...quantities.record import refuse
from ...quantities.units import Quantity
from ..base import Linear, SlipLaw

__all__ = ["StiffnessLaw"]


class StiffnessLaw(SlipLaw):
    """F_y = cornering_stiffness tan(alpha), M_z = aligning_stiffness tan(alpha), for any load; or both by the carcass."""

    LOAD_POWERS: ClassVar = (0,)

    law: Literal["stiffness", "straight_tangent"]
    cornering_stiffness: Annotated[float, Quantity("N/rad", at_least=0, example="440 kN/rad")] | None = None
    """C_Fa [N/rad]."""
    aligning_stiffness: Annotated[float, Quantity("N m/rad", example="34 kN m/rad")] | None = None
    """C_Ma, + where it restores [N m/rad]."""
    carcass_stiffness: Annotated[float, Quantity("N/m^2", above=0, example="1.4 MN/m^2")] | None = None
    """c_c, lateral, per length of the string; stands for both [N/m^2]."""

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        both = self.cornering_stiffness is not None and self.aligning_stiffness is not None
        either = self.cornering_stiffness is not None or self.aligning_stiffness is not None
        if not (both if self.carcass_stiffness is None else not either):
            raise refuse(
                "", "incomplete or double stiffness", "cornering_stiffness and aligning_stiffness, or carcass_stiffness alone"
            )
        return self

    def linear(self, load: Expr, pressure: Expr) -> Linear:
        """The stiffnesses, or those of the string, 2 c_c (sigma + a)^2 and 2 c_c a (sigma (sigma + a) + a^2/3).

        Here c_c is the lateral carcass stiffness per length, a the half contact length and sigma = sqrt(S/c_c) the relaxation
        length under string tension S. Source: Pacejka, Tyre and Vehicle Dynamics, ch. 5.
        """
        sigma, a = self.relaxation_length, self.half_contact_length  # type: ignore[attr-defined]  # of the tyre it belongs to
        c_c = self.carcass_stiffness
        if c_c is None:
            return Linear(self.cornering_stiffness, self.aligning_stiffness, sigma, a)
        return Linear(2 * c_c * (sigma + a) ** 2, 2 * c_c * a * (sigma * (sigma + a) + a**2 / 3), sigma, a)

    def force(self, alpha_F: Expr, load: Expr, pressure: Expr) -> Expr:
        """F_y [N]; thesis (2-4)."""
        return self.linear(load, pressure).cornering_stiffness * tan(alpha_F)

    def moment(self, alpha_M: Expr, load: Expr, pressure: Expr, corners: Corners) -> Expr:
        """M_z [N m]; thesis (2-5) with the sign of a moment that restores."""
        return self.linear(load, pressure).aligning_stiffness * tan(alpha_M)

"""The brush law of Fiala: bristles that stick at the front of the footprint and slide at its rear.

At zero camber and without drive or brake the UA law of Gim and Nikravesh is the same function, C_a S l^2 + mu F_z (1 - 3 l^2 +
2 l^3) with l = 1 - C_a S/(3 mu F_z) and S = |tan(alpha)|; the Basic and Enhanced models of Adams Aircraft are these two.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal, Self

from pydantic import model_validator

from ...expressions.calculus import Expr, absolute, tan, where
from ...expressions.corners import Corners
from ...ports.sizing import Peaks
from ...quantities.record import refuse
from ...quantities.units import Quantity
from ..base import Linear, SlipLaw
from ..over_load import SlopeOverLoad

__all__ = ["BrushLaw"]


class BrushLaw(SlipLaw):
    """Fiala's cubic up to sliding, with friction that may fall with slip; C_Ma = C_Fa a/3."""

    LOAD_POWERS: ClassVar = (0,)

    law: Literal["brush", "fiala", "ua"]
    cornering_stiffness: SlopeOverLoad
    """C_Fa, slope of the side force at zero slip [N/rad]; a number for any load, or a table over load."""
    friction: Annotated[float, Quantity("1", above=0, at_most=2, example="0.7")]
    """mu of the footprint at zero slip [1]."""
    sliding_friction: Annotated[float, Quantity("1", above=0, at_most=2, example="0.7")] | None = None
    """mu at a slip of 1 and beyond, linear between; left out: as `friction` [1]."""

    @model_validator(mode="after")
    def _falls(self) -> Self:
        if self.sliding_friction is not None and self.sliding_friction > self.friction:
            raise refuse("sliding_friction", f"{self.sliding_friction:g} is above friction", f"<= {self.friction:g}")
        return self

    def linear(self, load: Expr, pressure: Expr) -> Linear:
        """C_Fa, and a third of the half contact length as trail."""
        sigma, a = self.relaxation_length, self.half_contact_length  # type: ignore[attr-defined]  # of the tyre it belongs to
        return Linear(self.cornering_stiffness, self.cornering_stiffness * a / 3, sigma, a)

    def _sliding(self, alpha: Expr, load: Expr) -> tuple[Expr, Expr]:
        """mu F_z [N], and the part of the footprint that slides, 1 from where all of it does."""
        slip = absolute(tan(alpha))
        mu = self.friction
        if self.sliding_friction is not None:
            mu = mu - (mu - self.sliding_friction) * where(slip < 1, slip, 1.0)
        part = self.cornering_stiffness * slip / (3 * mu * load)
        return mu * load, where(part < 1, part, 1.0)

    def force(self, alpha_F: Expr, load: Expr, pressure: Expr) -> Expr:
        """F_y = mu F_z (1 - (1 - h)^3) sign(alpha), h the part that slides [N]."""
        grip, h = self._sliding(alpha_F, load)
        # mu F_z h = C_Fa |tan(alpha)|/3 while part of the footprint sticks: written with it, the law is smooth at zero slip
        sticks = self.cornering_stiffness * tan(alpha_F) * (3 - 3 * h + h**2) / 3
        return where(h < 1, sticks, grip * where(alpha_F < 0, -1.0, 1.0))

    def moment(self, alpha_M: Expr, load: Expr, pressure: Expr, corners: Corners) -> Expr:
        """M_z = mu F_z a h (1 - h)^3 sign(alpha) [N m]."""
        _, h = self._sliding(alpha_M, load)
        a = self.half_contact_length  # type: ignore[attr-defined]  # of the tyre it belongs to
        return self.cornering_stiffness * tan(alpha_M) * a / 3 * (1 - h) ** 3

    def peaks(self, load: Expr, pressure: Expr) -> Peaks:
        """mu F_z, and the moment at a quarter of the slip at which all slides, 27/256 mu F_z a (constant friction)."""
        a = self.half_contact_length  # type: ignore[attr-defined]  # of the tyre it belongs to
        return Peaks(self.friction * load, 27 / 256 * self.friction * load * a)

"""The nonlinear law of the thesis, with an arctangent in the side force and a half sine in the aligning moment."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from ...expressions.calculus import Expr, absolute, atan, cos, sin, tan
from ...expressions.corners import Corners
from ...ports.sizing import Peaks
from ...quantities.units import Quantity
from ..base import Linear, SlipLaw

__all__ = ["ArctangentLaw"]

# X cos(0.95 X) is largest where 0.95 X tan(0.95 X) = 1, at 0.95 X = 0.860333589...
_PEAK_ARGUMENT = 0.8603335890193798 / 0.95
PEAK_SHAPE = _PEAK_ARGUMENT * math.cos(0.95 * _PEAK_ARGUMENT)
"""Largest F_y/(C_F F_z)."""


class ArctangentLaw(SlipLaw):
    """F_y = C_F X cos(0.95 X) F_z with X = atan(7 tan(alpha)), M_z a half sine up to a slip limit; thesis (2-10), (4-8)."""

    law: Literal["arctangent", "nonlinear"]
    cornering_coefficient: Annotated[float, Quantity("1/rad", at_least=0, example="0.002 1/rad")]
    """C_F [1/rad]; the slope of F_y/F_z at zero slip is 7 C_F."""
    aligning_coefficient: Annotated[float, Quantity("m/rad", example="1 m/rad")]
    """C_M, slope of M_z/F_z at zero slip, + where it restores [m/rad]."""
    aligning_slip_limit: Annotated[float, Quantity("rad", above=0, below=1.5, example="10 deg")]
    """alpha_m, slip angle beyond which there is no aligning moment [rad]."""

    def linear(self, load: Expr, pressure: Expr) -> Linear:
        """Slopes at zero slip, 7 C_F F_z and C_M F_z."""
        shared = self.relaxation_length, self.half_contact_length  # type: ignore[attr-defined]  # of the tyre it belongs to
        return Linear(7 * self.cornering_coefficient * load, self.aligning_coefficient * load, *shared)

    def force(self, alpha_F: Expr, load: Expr, pressure: Expr) -> Expr:
        """F_y [N]; thesis (2-10)."""
        X = atan(7 * tan(alpha_F))
        return self.cornering_coefficient * X * cos(0.95 * X) * load

    def moment(self, alpha_M: Expr, load: Expr, pressure: Expr, corners: Corners) -> Expr:
        """M_z [N m]; thesis (4-8), zero beyond the slip limit."""
        limit = self.aligning_slip_limit
        half_sine = self.aligning_coefficient * limit / math.pi * sin(math.pi * alpha_M / limit) * load
        return corners.within("slip limit", alpha_M, limit) * half_sine

    def peaks(self, load: Expr, pressure: Expr) -> Peaks:
        """Side force at 0.95 X = 0.8603, moment at half the slip limit."""
        moment = absolute(self.aligning_coefficient) * self.aligning_slip_limit / math.pi * load
        return Peaks(self.cornering_coefficient * PEAK_SHAPE * load, moment)

"""The Magic Formula, of coefficients or of a property file: pure lateral slip and aligning moment, offsets removed.

An asymmetric tyre does not roll straight: with its offsets there would be no equilibrium about which shimmy could be judged.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator

from ...expressions.calculus import Expr, absolute, cos, sin, where
from ...expressions.corners import Corners
from ...ports.sizing import Peaks
from ...quantities.record import Name, Range, refuse
from ...quantities.units import Quantity
from ..base import Linear, SlipLaw
from ..coefficients import Coefficients, Curves

__all__ = ["DataLoads", "MagicFormulaLaw"]

STEPS = 80
"""Slips at which the largest moment is bounded."""

EXAMPLE = {
    **{"FNOMIN": "100 kN", "UNLOADED_RADIUS": "0.6 m", "PCY1": 1.4, "PDY1": 0.8, "PDY2": -0.1, "PEY1": -0.5, "PKY1": -12.0},
    **{"PKY2": 2.5, "PTY1": 1.2, "PTY2": 2.5, "QBZ1": 6.0, "QCZ1": 1.2, "QDZ1": 0.1, "QDZ2": -0.02, "QEZ1": -1.0},
}
"""Of no tyre in particular."""


class DataLoads(Range):
    """Loads of the measurements."""

    min: Annotated[float, Quantity("N", at_least=0, example="10 kN")]
    max: Annotated[float, Quantity("N", above=0, example="200 kN")]


class MagicFormulaLaw(SlipLaw):
    """Magic Formula (PAC2002, MF 5.2) at pure lateral slip, symmetric; needs `half_contact_length`, which its files lack."""

    LOAD_POWERS: ClassVar = None
    GIVES: ClassVar = ("relaxation_length",)

    law: Literal["magic_formula", "pac2002"]
    coefficients: Annotated[Coefficients, Field(examples=[EXAMPLE])]
    """Under their names in property files; those of offsets are not used."""
    data_loads: DataLoads | None = None
    """Loads that the coefficients hold for; others are refused [N]."""
    source: Name | None = None
    """Property file that they come from."""

    @model_validator(mode="after")
    def _complete(self) -> Self:
        c = self.coefficients
        if c.PKY1 == 0 or c.PDY1 == 0:
            raise refuse(f"coefficients.{'PKY1' if c.PKY1 == 0 else 'PDY1'}", "0", "another number, of either sign")
        if not c.QDZ1 > 0:
            raise refuse("coefficients.QDZ1", f"{c.QDZ1:g}: no trail behind the centre of contact", "> 0")
        if getattr(self, "relaxation_length", 0) is None and c.relaxation_length(c.FNOMIN, None) is None:
            raise refuse("relaxation_length", "missing key", "a length, or coefficients PTY1 and PTY2, or LATERAL_STIFFNESS")
        return self

    def _curves(self, load: Expr, pressure: Expr) -> Curves:
        """Without offsets, and with a positive slope; odd curves of either sign are these, mirrored."""
        c = self.coefficients.symmetric()
        return c.model_copy(update={"PKY1": absolute(c.PKY1)}).at(load, pressure)

    def linear(self, load: Expr, pressure: Expr) -> Linear:
        """C_Fa = K, C_Ma = D_t K, sigma of the coefficients or the study, a of the study."""
        curves, sigma = self._curves(load, pressure), self.relaxation_length  # type: ignore[attr-defined]  # of the tyre
        if sigma is None:
            sigma = self.coefficients.relaxation_length(load, pressure)
        a = self.half_contact_length  # type: ignore[attr-defined]  # of the tyre it belongs to
        return Linear(curves.K, curves.D_t * curves.K, sigma, a)

    def force(self, alpha_F: Expr, load: Expr, pressure: Expr) -> Expr:
        """F_y [N]."""
        return self._curves(load, pressure).side_force(alpha_F)

    def moment(self, alpha_M: Expr, load: Expr, pressure: Expr, corners: Corners) -> Expr:
        """M_z = t F_y, both at the slip angle of the moment [N m]."""
        return -self._curves(load, pressure).moment(alpha_M)

    def peaks(self, load: Expr, pressure: Expr) -> Peaks:
        """D, and a bound of t F_y that is met within some 6 %, step by step over the slip.

        With E and E_t at most 1 and C_t at most 2, f = t/cos(alpha) falls with the slip, and sin(side_angle) grows up to 1: on
        a step |t| is at most |f| at one of its ends times the cosine of its start, and F_y the largest up to its end.
        """
        curves, top = self._curves(load, pressure), self.slip_range  # type: ignore[attr-defined]  # of the tyre it belongs to
        slips = [top * (k / STEPS) ** 2 for k in range(STEPS + 1)]
        f = [absolute(curves.trail(slip)) / cos(slip) for slip in slips]
        most: Expr = 0.0
        for k, (start, end) in enumerate(pairwise(slips)):
            trail, angle = where(f[k] > f[k + 1], f[k], f[k + 1]) * cos(start), curves.side_angle(end)
            bound = trail * curves.D * sin(where(angle < math.pi / 2, angle, math.pi / 2))
            most = where(bound > most, bound, most)
        return Peaks(curves.D, most)

    def loads(self) -> tuple[float, float]:
        """Those of the data, or a fifth to 1.5 of the nominal load."""
        given, nominal = self.data_loads, self.coefficients.LFZO * self.coefficients.FNOMIN
        return (0.2 * nominal, 1.5 * nominal) if given is None else (max(given.min, 0.05 * given.max), given.max)

    def beyond(self, load: float, pressure: float | None) -> str:
        """A load beyond that of the data, or one at which a fit has lost friction, stiffness, trail or relaxation length."""
        loads = self.data_loads
        if loads is not None and not loads.min <= load <= loads.max:
            return f"is beyond the tyre's data, {loads.min / 1e3:g} to {loads.max / 1e3:g} kN (tyre.data_loads)"
        c, curves = self.coefficients, self._curves(load, pressure)
        nominal = c.LFZO * c.FNOMIN
        friction = (c.PDY1 + c.PDY2 * (load - nominal) / nominal) / c.PDY1
        sigma = self.linear(load, pressure).relaxation_length
        found = {"friction": friction, "cornering stiffness": curves.K, "trail": curves.D_t, "relaxation length": sigma}
        lost = next((name for name, value in found.items() if not value > 0), None)
        return "" if lost is None else f"is beyond the tyre's coefficients: they give no positive {lost} there"

    def radius(self) -> float:
        """R_0 [m]."""
        return self.coefficients.UNLOADED_RADIUS

    def leaves_out(self) -> tuple[str, ...]:
        """Camber and offsets."""
        return ("camber of the wheel, and offsets of the tyre (tyre.coefficients)",)

    def origin(self) -> str:
        """What is left of the file."""
        named = f" of {self.source}" if self.source else ""
        return f"The tyre is a Magic Formula{named} at pure lateral slip and zero camber, its offsets removed."

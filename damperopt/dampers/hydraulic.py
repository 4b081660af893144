"""Hydraulic damper: viscous, with an orifice, and with the stiffness of oil column, rod and brackets in series."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

from ..expressions.calculus import Expr, sqrt, symbol
from ..expressions.corners import Corners
from ..ports.sizing import Force, LimitEvent, Size, Sized
from ..quantities.named import DesignVariable
from ..quantities.record import Record, SeriesStiffness
from ..quantities.units import Quantity
from ..strength.cylinder import bore, cylinder_mass, rod_diameters, rod_length
from .base import Context, Damper
from .oil import Oil, damping_factor

__all__ = ["Hydraulic", "Orifice"]


class Orifice(Record):
    """Quadratic damping of an orifice, F = c_lambda v + coefficient v |v|."""

    coefficient: Annotated[float, Quantity("N s^2/m^2", above=0, example="5e4 N s^2/m^2")]
    """c_2 [N s^2/m^2]."""
    smoothing: Annotated[float, Quantity("m/s", above=0, example="1 mm/s")] = 1e-3
    """Damper speed below which the smooth version is rounded [m/s]."""


class Hydraulic(Damper):
    """Through-rod hydraulic damper, F = c_lambda v, with an orifice F = c_lambda v + c_2 v |v|."""

    VARIABLES: ClassVar = (DesignVariable("c_lambda", "N s/m", r"$c_\lambda$", "damping of the damper", example="1e4 N s/m"),)

    kind: Literal["hydraulic"] = "hydraulic"
    orifice: Orifice | None = None
    """Quadratic part of the force."""
    oil: Oil | None = None
    """Its temperature; left out: that at which the damping is given."""
    series_stiffness: SeriesStiffness | None = None
    """Of oil column, rod and brackets, in series with the damper [N/m]."""

    def force(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        rate: Expr,
        context: Context,
        corners: Corners,
    ) -> Force:
        """F = c_lambda v + c_2 v |v|."""
        c, v, orifice = design["c_lambda"] * damping_factor(self.oil, context.temperature), rate, self.orifice
        if orifice is None:
            return Force(c * v)
        return Force(c * v + orifice.coefficient * v * corners.magnitude(v, orifice.smoothing))

    def rate(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        force: Expr,
        context: Context,
        corners: Corners,
    ) -> Expr:
        """The positive root of c_2 v^2 + c v = |F|, in the form that also holds for c_2 = 0."""
        c, F, orifice = design["c_lambda"] * damping_factor(self.oil, context.temperature), force, self.orifice
        if orifice is None:
            return F / c
        magnitude = corners.magnitude(F, c * orifice.smoothing)
        return 2 * F / (c + sqrt(c**2 + 4 * orifice.coefficient * magnitude))

    def equivalent(self, design: Mapping[str, Expr], amplitude: Expr, frequency: Expr, context: Context) -> tuple[Expr, Expr]:
        """c_lambda + 8/(3 pi) c_2 omega X of the damper alone, without what stands in series with it."""
        c_2 = 0.0 if self.orifice is None else self.orifice.coefficient
        c = design["c_lambda"] * damping_factor(self.oil, context.temperature)
        return 0.0, c + 8 / (3 * math.pi) * c_2 * frequency * amplitude

    def series(self, design: Mapping[str, Expr]) -> Expr | None:
        """The key `series_stiffness`."""
        return self.series_stiffness

    def parts(self, event: LimitEvent, model: Any) -> Sized:
        """A cylinder with rod, caps and oil; its rod diameter meets two limits and is chosen by the optimiser."""
        diameter = symbol("rod_diameter")
        rod = Size("rod_diameter", "m", diameter, rod_diameters(event, model), start=0.02, lower=1e-5, upper=10.0)
        length = rod_length(event, model) + event.stroke + bore(event, model, diameter)
        return Sized({"damper": cylinder_mass(event, model, diameter)}, (rod,), length)

    def leaves_out(self) -> tuple[str, ...]:
        """The oil column and its temperature, where they are not given."""
        words = []
        if self.series_stiffness is None:
            words.append("compliance of oil column, rod and brackets in series with the damper (damper.series_stiffness)")
        if self.oil is None:
            words.append("oil that is cold or hot (damper.oil)")
        return tuple(words)

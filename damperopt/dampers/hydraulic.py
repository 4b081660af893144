"""Hydraulic damper: viscous, with an orifice, and with the stiffness of oil column, rod and brackets in series."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, model_validator
from pydantic.config import JsonDict

from ..expressions.calculus import Expr, sqrt, symbol
from ..expressions.corners import Corners
from ..ports.linkage import Compliant
from ..ports.sizing import Force, LimitEvent, Size, Sized
from ..quantities.named import DesignVariable
from ..quantities.record import Number, Record, SeriesStiffness, refuse
from ..quantities.temperature import ZERO_CELSIUS, Temperature, TemperatureRange
from ..quantities.units import Quantity
from ..strength.cylinder import (
    bore,
    cylinder_mass,
    oil_stiffness,
    piston_area,
    rod_diameters,
    rod_length,
    rod_stiffness,
)
from .base import Context, Damper
from .oil import SHOWN, Oil, damping_factor

__all__ = ["Hydraulic", "Orifice"]


class Orifice(Record):
    """Quadratic damping of an orifice, F = c_lambda v + coefficient v |v|."""

    coefficient: Annotated[float, Quantity("N s^2/m^2", above=0, example="5e4 N s^2/m^2")]
    """c_2 [N s^2/m^2]."""
    smoothing: Annotated[float, Quantity("m/s", above=0, example="1 mm/s")] = 1e-3
    """Damper speed below which the smooth version is rounded [m/s]."""


_TWO: JsonDict = {"minItems": 2, "maxItems": 2}


class Hydraulic(Damper):
    """Through-rod hydraulic damper, F = c_lambda v, with an orifice F = c_lambda v + c_2 v |v|."""

    VARIABLES: ClassVar = (DesignVariable("c_lambda", "N s/m", r"$c_\lambda$", "damping of the damper", example="1e4 N s/m"),)

    AREA: ClassVar = DesignVariable("A_piston", "m^2", "$A_p$", "area of the piston", example="6e-4 m^2")
    ROD: ClassVar = DesignVariable("rod_diameter", "m", "$d_{rod}$", "diameter of the rod", example="16 mm")
    STROKE: ClassVar = DesignVariable("s_damper", "m", "$s_d$", "stroke of the damper to one side", example="10 mm")
    ELASTIC: ClassVar = ("damper",)
    SIZES: ClassVar = (AREA, ROD, STROKE)
    VISCOUS: ClassVar = "c_lambda"
    CONSTANTS: ClassVar = ("temperature", "reference_temperature", "laminar_fraction", "oil")

    kind: Literal["hydraulic"] = "hydraulic"
    orifice: Orifice | None = None
    """Quadratic part of the force."""
    series_stiffness: SeriesStiffness | None = None
    """Of oil column, rod and brackets, in series with the damper [N/m]."""
    damping_range: list[Number] | None = Field(None, examples=[[0.5, 2.0]], json_schema_extra=_TWO)
    """Least and largest factor on c_lambda at which the requirements hold, such as [0.5, 2]; comes before `temperature`."""
    temperature: TemperatureRange | None = Field(None, examples=[{"min": "-54 degC", "max": "70 degC"}])
    """Of the oil: the requirements hold for the damping at each temperature of the range [K]."""
    reference_temperature: Temperature | None = None
    """At which the damping is c_lambda [K]; left out: 20 degC."""
    laminar_fraction: Annotated[float, Quantity("1", at_least=0, at_most=1, example="0.2")] | None = None
    """What of the damping is a laminar leak and goes with the viscosity [1]; left out: 0.2, a typical figure."""
    oil: Oil | None = Field(None, examples=[{"viscosity_40": "13.5 mm^2/s", "viscosity_100": "5 mm^2/s"}])
    """Left out: typical of MIL-PRF-5606."""

    @model_validator(mode="after")
    def _uncertain(self) -> Self:
        found = self.damping_range
        if found is not None and not (len(found) == 2 and found[0] < found[1] and found[0] <= 1 <= found[1]):
            allowed = "two factors on c_lambda, the first below the second, with 1 among them or between them"
            raise refuse("damping_range", f"found {found}", allowed)
        given, T_0 = self.temperature, self._reference
        if given is not None and not given.min <= T_0 <= given.max:
            allowed = f"a reference_temperature within it, {given.min:g} to {given.max:g} K"
            raise refuse("temperature", f"the reference temperature {T_0:g} K lies outside the range", allowed)
        return self

    @property
    def _reference(self) -> float:
        return ZERO_CELSIUS + 20.0 if self.reference_temperature is None else self.reference_temperature

    def damping_factors(self) -> tuple[float, float]:
        """Ends of `damping_range`, or the factors at the hot and the cold end of `temperature`."""
        if self.damping_range is not None:
            return self.damping_range[0], self.damping_range[1]
        if self.temperature is None:
            return 1.0, 1.0
        return self.damping_factor_at(self.temperature.max), self.damping_factor_at(self.temperature.min)

    def damping_factor_at(self, temperature: float) -> float:
        """c(T)/c_lambda at a temperature of the oil [K]."""
        return damping_factor(Oil() if self.oil is None else self.oil, temperature, self._reference, self._laminar)

    def orifice_share(self) -> float | None:
        """What of c_lambda is an orifice at the reference temperature [1]; None where the study says nothing of temperature."""
        return 1 - self._laminar if self.damping_by_temperature() else None

    @property
    def _laminar(self) -> float:
        return 0.2 if self.laminar_fraction is None else self.laminar_fraction

    def damping_by_temperature(self) -> dict[float, float]:
        """Factor on c_lambda by temperature [K] at those of `SHOWN`; empty where the study says nothing of temperature."""
        said = (self.temperature, self.reference_temperature, self.laminar_fraction, self.oil)
        return {} if said == (None,) * 4 else {T: self.damping_factor_at(T) for T in SHOWN}

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
        c, v, orifice = design["c_lambda"], rate, self.orifice
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
        c, F, orifice = design["c_lambda"], force, self.orifice
        if orifice is None:
            return F / c
        magnitude = corners.magnitude(F, c * orifice.smoothing)
        return 2 * F / (c + sqrt(c**2 + 4 * orifice.coefficient * magnitude))

    def equivalent(self, design: Mapping[str, Expr], amplitude: Expr, frequency: Expr, context: Context) -> tuple[Expr, Expr]:
        """c_lambda + 8/(3 pi) c_2 omega X of the damper alone, without what stands in series with it."""
        c_2 = 0.0 if self.orifice is None else self.orifice.coefficient
        return 0.0, design["c_lambda"] + 8 / (3 * math.pi) * c_2 * frequency * amplitude

    def series(self, design: Mapping[str, Expr]) -> Expr | None:
        """The key `series_stiffness`."""
        return self.series_stiffness

    def sizes(self) -> tuple[DesignVariable, ...]:
        """Piston, rod and stroke, where the stiffness of oil column and rod comes from them."""
        return Hydraulic.SIZES if self.is_sized("damper") else ()

    def elastic(self, design: Mapping[str, Expr], study: Any, stroke: Expr = 0) -> tuple[Compliant, ...]:
        """Oil column and rod."""
        if not self.is_sized("damper"):
            return ()
        model, own = study.mass, design["s_damper"]
        oil = oil_stiffness(design["A_piston"], own, model)
        rod = rod_stiffness(design["rod_diameter"], 2 * own + model.dead_length, model)
        return Compliant("damper", oil), Compliant("damper", rod)

    def parts(self, event: LimitEvent, model: Any) -> Sized:
        """A cylinder with rod, caps and oil; its sizes meet several limits and are chosen by the optimiser."""
        if not self.is_sized("damper"):
            return self._cylinder(event, model, symbol("rod_diameter"), piston_area(event, model))
        area, stroke = event.design["A_piston"], event.design["s_damper"]
        sized = self._cylinder(replace(event, stroke=stroke), model, event.design["rod_diameter"], area)
        torque = ("loads",)
        chosen = (
            Size("A_piston", "m^2", area, {"piston_pressure": (piston_area(event, model), ("mass.working_pressure", *torque))}),
            Size("s_damper", "m", stroke, {"damper_stroke": (event.stroke, torque)}),
        )
        masses = {part: mass + model.damper_fixed_mass for part, mass in sized.masses.items()}
        return Sized(masses, (*sized.sizes, *chosen), sized.length)

    def _cylinder(self, event: LimitEvent, model: Any, diameter: Expr, area: Expr) -> Sized:
        rod = Size("rod_diameter", "m", diameter, rod_diameters(event, model), start=0.02, lower=1e-5, upper=10.0)
        length = rod_length(event, model) + event.stroke + bore(area, diameter)
        return Sized({"damper": cylinder_mass(event, model, diameter, area)}, (rod,), length)

    def leaves_out(self) -> tuple[str, ...]:
        """The oil column, where it has no stiffness."""
        if self.series_stiffness is None and not self.is_sized("damper"):
            return ("compliance of oil column, rod and brackets in series with the damper (damper.compliance)",)
        return ()

"""Hydraulic damper: viscous, with an orifice, and with the stiffness of oil column, rod and brackets in series."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Any, ClassVar, Literal

from ..expressions.calculus import Expr, sqrt, symbol
from ..expressions.corners import Corners
from ..ports.linkage import Compliant
from ..ports.sizing import Capacity, Force, LimitEvent, Size, Sized
from ..quantities.named import DesignVariable
from ..quantities.record import Length, Record, SeriesStiffness
from ..quantities.units import Quantity
from ..strength.cylinder import (
    bore,
    cylinder_mass,
    oil_stiffness,
    piston_area,
    rod_column,
    rod_diameters,
    rod_length,
    rod_stiffness,
)
from .base import Context
from .oil import Oiled, damping_factor

__all__ = ["Hydraulic", "Orifice"]


class Orifice(Record):
    """Quadratic damping of an orifice, F = c_lambda v + coefficient v |v|."""

    coefficient: Annotated[float, Quantity("N s^2/m^2", above=0, example="5e4 N s^2/m^2")]
    """c_2 [N s^2/m^2]."""
    smoothing: Annotated[float, Quantity("m/s", above=0, example="1 mm/s")] = 1e-3
    """Damper speed below which the smooth version is rounded [m/s]."""


class Hydraulic(Oiled):
    """Through-rod hydraulic damper, F = c_lambda v, with an orifice F = c_lambda v + c_2 v |v|."""

    VARIABLES: ClassVar = (DesignVariable("c_lambda", "N s/m", r"$c_\lambda$", "damping of the damper", example="1e4 N s/m"),)

    AREA: ClassVar = DesignVariable("A_piston", "m^2", "$A_p$", "area of the piston", example="6e-4 m^2")
    ROD: ClassVar = DesignVariable("rod_diameter", "m", "$d_{rod}$", "diameter of the rod", example="16 mm")
    STROKE: ClassVar = DesignVariable("s_damper", "m", "$s_d$", "stroke of the damper to one side", example="10 mm")
    ELASTIC: ClassVar = ("damper",)
    SIZES: ClassVar = (AREA, ROD, STROKE)
    VISCOUS: ClassVar = "c_lambda"

    kind: Literal["hydraulic"] = "hydraulic"
    orifice: Orifice | None = None
    """Quadratic part of the force."""
    series_stiffness: SeriesStiffness | None = None
    """Of oil column, rod and brackets, in series with the damper [N/m]."""
    bore: Length | None = None
    """Of the cylinder, where it is given [m]; the area of the piston then follows from the rod and is no design variable."""

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

    def sizes(self) -> tuple[DesignVariable, ...]:
        """Piston, rod and stroke, where the stiffness of oil column and rod comes from them."""
        if not self.is_sized("damper"):
            return ()
        return Hydraulic.SIZES if self.bore is None else (Hydraulic.ROD, Hydraulic.STROKE)

    def piston(self, design: Mapping[str, Expr]) -> Expr | None:
        """A_piston, or what the rod leaves of a given bore; None where neither is chosen."""
        if self.bore is None:
            return design["A_piston"] if self.is_sized("damper") else None
        rod = design.get("rod_diameter")
        return None if rod is None else math.pi / 4 * (self.bore**2 - rod**2)

    def elastic(self, design: Mapping[str, Expr], study: Any, stroke: Expr = 0) -> tuple[Compliant, ...]:
        """Oil column and rod."""
        if not self.is_sized("damper"):
            return ()
        model, own = study.mass, design["s_damper"]
        oil = oil_stiffness(self.piston(design), own, model)
        rod = rod_stiffness(design["rod_diameter"], 2 * own + model.dead_length, model)
        return Compliant("damper", oil), Compliant("damper", rod)

    def parts(self, event: LimitEvent, model: Any) -> Sized:
        """A cylinder with rod, caps and oil; its sizes meet several limits and are chosen by the optimiser."""
        least, torque = piston_area(event, model), ("loads",)
        relaxed = ("mass.working_pressure", *torque)
        if not self.is_sized("damper"):
            rod = symbol("rod_diameter")
            area = least if self.bore is None else math.pi / 4 * (self.bore**2 - rod**2)
            return self._cylinder(event, model, rod, area, () if self.bore is None else self._pressed(area, least, relaxed))
        area, stroke = self.piston(event.design), event.design["s_damper"]
        chosen = [Size("s_damper", "m", stroke, {"damper_stroke": (event.stroke, torque)})]
        if self.bore is None:
            chosen.insert(0, Size("A_piston", "m^2", area, {"piston_pressure": (least, relaxed)}))
        given = () if self.bore is None else self._pressed(area, least, relaxed)
        sized = self._cylinder(replace(event, stroke=stroke), model, event.design["rod_diameter"], area, given)
        masses = {part: mass + model.damper_fixed_mass for part, mass in sized.masses.items()}
        (rod,) = sized.sizes
        column = {"rod_column": (rod_column(replace(event, stroke=stroke), model), ("requirements.ultimate_factor", *torque))}
        return replace(sized, masses=masses, sizes=(replace(rod, least={**rod.least, **column}), *chosen))

    def _cylinder(self, event: LimitEvent, model: Any, diameter: Expr, area: Expr, capacities: tuple[Capacity, ...]) -> Sized:
        rod = Size("rod_diameter", "m", diameter, rod_diameters(event, model), start=0.02, lower=1e-5, upper=10.0)
        length = rod_length(event, model) + event.stroke + bore(area, diameter)
        return Sized({"damper": cylinder_mass(event, model, diameter, area)}, (rod,), length, capacities)

    def _pressed(self, area: Expr, least: Expr, relaxed: tuple[str, ...]) -> tuple[Capacity, ...]:
        """The given bore under the working pressure."""
        return (Capacity("piston_pressure", "m^2", area, least, ("damper.bore", *relaxed)),)

    def leaves_out(self) -> tuple[str, ...]:
        """The oil column and its temperature, where they are not given."""
        words = []
        if "damper" not in self.given_compliance() and not self.is_sized("damper"):
            words.append("compliance of oil column, rod and brackets in series with the damper (damper.compliance)")
        if self.oil is None:
            words.append("oil that is cold or hot (damper.oil)")
        if self.charge_pressure is None:
            words.append("cavitation of the oil (damper.charge_pressure)")
        return tuple(words)

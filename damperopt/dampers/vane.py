"""Rotary vane damper about the yaw axis: vanes on a rotor push oil through gaps and an orifice in a fixed housing."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import model_validator

from ..expressions.calculus import Expr, sqrt, symbol
from ..expressions.corners import Corners
from ..ports.sizing import Force, LimitEvent, Size, Sized
from ..quantities.named import DesignVariable
from ..quantities.record import Length, Record, Stress, refuse
from ..quantities.units import Quantity
from ..strength.materials import allowable_stress
from .base import Context
from .oil import Oiled, damping_factor

__all__ = ["RotaryOrifice", "Vane"]


class RotaryOrifice(Record):
    """Quadratic damping of an orifice, T = c_vane psi' + coefficient psi' |psi'|."""

    coefficient: Annotated[float, Quantity("N m s^2/rad^2", above=0, example="500 N m s^2/rad^2")]
    """c_2 [N m s^2/rad^2]."""
    smoothing: Annotated[float, Quantity("rad/s", above=0, example="0.01 rad/s")] = 1e-2
    """Rate below which the smooth version is rounded [rad/s]."""


class Vane(Oiled):
    """Rotary vane damper, T = c psi' + c_2 psi' |psi'|, in series with the stiffness of its oil; sized by torque and pressure.

    Vanes of height h and width b at the mean radius R displace D = n h b R of oil per radian, so that T = p D.
    """

    ROTARY: ClassVar = True
    VARIABLES: ClassVar = (
        DesignVariable("c_vane", "N m s/rad", "$c_v$", "damping of the vane damper about the yaw axis", example="1 kN m s/rad"),
    )

    VISCOUS: ClassVar = "c_vane"

    kind: Literal["vane"]
    mean_radius: Length
    """R, of the middle of a vane from the yaw axis [m]."""
    vane_width: Length
    """b, radial [m]."""
    vanes: Annotated[float, Quantity("1", at_least=1, at_most=4, example="2")] = 2.0
    """n, with as many fixed partitions between them [1]."""
    orifice: RotaryOrifice | None = None
    """Quadratic part of the torque."""
    displacement: Annotated[float, Quantity("m^3/rad", above=0, example="1e-4 m^3/rad")] | None = None
    """D, where it is given: then the oil is compressible, and the vanes are made at least as large [m^3/rad]."""
    sweep: Annotated[float, Quantity("rad", above=0, below=3.1415, example="50 deg")] = 0.8726646259971648
    """Angle of a chamber at rest; with its neighbour it makes room for the stroke [rad]."""
    bulk_modulus: Stress = 1.2e9
    """beta, of the oil with the air in it [Pa]."""

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if self.vane_width >= 2 * self.mean_radius:
            raise refuse(
                "vane_width", f"{self.vane_width:g} m at a mean radius of {self.mean_radius:g} m", "less than twice that"
            )
        if self.vanes * self.sweep >= math.pi:
            words = f"{self.vanes:g} vanes with chambers of {math.degrees(self.sweep):.3g} deg on both sides"
            raise refuse("sweep", words, "less than a full turn together")
        return self

    def force(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        rate: Expr,
        context: Context,
        corners: Corners,
    ) -> Force:
        """T = c psi' + c_2 psi' |psi'|."""
        c, orifice = design["c_vane"] * damping_factor(self.oil, context.temperature), self.orifice
        if orifice is None:
            return Force(c * rate)
        return Force(c * rate + orifice.coefficient * rate * corners.magnitude(rate, orifice.smoothing))

    def rate(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        force: Expr,
        context: Context,
        corners: Corners,
    ) -> Expr:
        """The positive root of c_2 w^2 + c w = |T|, in the form that also holds for c_2 = 0."""
        c, T, orifice = design["c_vane"] * damping_factor(self.oil, context.temperature), force, self.orifice
        if orifice is None:
            return T / c
        magnitude = corners.magnitude(T, c * orifice.smoothing)
        return 2 * T / (c + sqrt(c**2 + 4 * orifice.coefficient * magnitude))

    def series(self, design: Mapping[str, Expr]) -> Expr | None:
        """2 beta D/sweep of two chambers of the volume D sweep, one under pressure and one relieved [N m/rad]."""
        return None if self.displacement is None else 2 * self.bulk_modulus * self.displacement / self.sweep

    def swept(self, design: Mapping[str, Expr]) -> Expr | None:
        """D, where it is given."""
        return self.displacement

    def equivalent(self, design: Mapping[str, Expr], amplitude: Expr, frequency: Expr, context: Context) -> tuple[Expr, Expr]:
        """c + 8/(3 pi) c_2 omega X, without the oil in series."""
        c_2 = 0.0 if self.orifice is None else self.orifice.coefficient
        c = design["c_vane"] * damping_factor(self.oil, context.temperature)
        return 0.0, c + 8 / (3 * math.pi) * c_2 * frequency * amplitude

    def parts(self, event: LimitEvent, model: Any) -> Sized:
        """Housing, caps, rotor, vanes, partitions and oil; the height of the vanes meets the pressure."""
        # p pressure, sigma allowable stress, R mean radius, b width, n vanes, h height; walls as thin ones, caps as clamped
        # plates, a vane as a cantilever of the length b under p: 3 p b^2/sigma is the square of its thickness
        steel, p, T, n = model.damper_material, model.working_pressure, event.damper_force, self.vanes
        R, b, extra = self.mean_radius, self.vane_width, model.wall_allowance
        sigma = allowable_stress(steel, event.safety_factor)
        h, inner, outer = symbol("vane_height"), R - b / 2, R + b / 2
        limits = {
            "vane_pressure": (T / (p * n * b * R), ("mass.working_pressure",)),
            "vane_minimum": (0.01, ("damper.mean_radius",)),
        }
        if self.displacement is not None:
            limits["vane_displacement"] = (self.displacement / (n * b * R), ("damper.displacement",))
        size = Size("vane_height", "m", h, limits, start=0.05, lower=1e-3, upper=10.0)
        wall, cap = extra + p * outer / sigma, extra + outer * sqrt(0.75 * p / sigma)
        shaft = extra + sqrt(3) * T / (2 * math.pi * inner**2 * sigma)
        vane = b * (extra + b * sqrt(3 * p / sigma))
        metal = 2 * math.pi * (outer + wall / 2) * wall * h + 2 * math.pi * (outer + wall) ** 2 * cap
        metal += 2 * math.pi * inner * shaft * (h + 2 * cap) + 2 * n * vane * h
        oil = model.oil_density * 2 * math.pi * R * b * h
        return Sized({"damper": steel.density * metal * (1 + model.damper_fittings_fraction) + oil}, (size,))

    def leaves_out(self) -> tuple[str, ...]:
        """The oil, where no displacement or temperature is given."""
        words = ["cavitation where the relieved chamber runs empty (damper.charge_pressure)"] * (self.charge_pressure is None)
        if self.displacement is None:
            words.append("compressibility of the oil (damper.displacement)")
        if self.oil is None:
            words.append("oil that is cold or hot (damper.oil)")
        return tuple(words)

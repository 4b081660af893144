"""Dampers: with gas that gives way slowly, and with a force that no formula turns around."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

from damperopt.dampers.base import Context, Damper
from damperopt.expressions.calculus import Expr, sqrt, symbol
from damperopt.expressions.corners import Corners
from damperopt.ports.sizing import Force, LimitEvent, Size, Sized
from damperopt.quantities.named import DesignVariable, Output, State
from damperopt.quantities.record import Time
from damperopt.quantities.units import Quantity

DAMPING = DesignVariable("c_lambda", "N s/m", r"$c_\lambda$", "damping of the damper", example="1e4 N s/m")


class Piston(Damper):
    """What both have: a piston whose area carries the force."""

    def parts(self, event: LimitEvent, model: Any) -> Sized:
        """A cylinder filled with oil, as wide as the force and the pressure of the mass model ask for."""
        diameter = symbol("piston_diameter")
        least = sqrt(4 * event.damper_force / (math.pi * model.working_pressure))
        limits = {"piston_pressure": (least, ("mass.working_pressure",))}
        size = Size("piston_diameter", "m", diameter, limits, start=0.03, lower=1e-4, upper=10.0)
        mass = model.damper_material.density * diameter**2 / 2 * (2 * event.stroke + diameter)
        return Sized({"damper": mass}, (size,), 4 * event.stroke + diameter)


class Gas(Piston):
    """F = c_lambda v + k_gas (s - q) with the volume that leaked across, q' = (s - q)/leak_time."""

    VARIABLES: ClassVar = (
        DAMPING,
        DesignVariable("k_gas", "N/m", "$k_{gas}$", "stiffness of the gas in the damper", example="1e5 N/m"),
    )
    STATES: ClassVar = (State("leaked_stroke", "m", "gas"),)
    OUTPUTS: ClassVar = (Output("gas_force", "N", "of the gas alone"),)

    kind: Literal["gas"]
    leak_time: Time
    """In which the gas gives way [s]."""

    def force(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        rate: Expr,
        context: Context,
        corners: Corners,
    ) -> Force:
        """Oil and gas side by side."""
        compressed = stroke - states["leaked_stroke"]
        gas = design["k_gas"] * compressed
        return Force(design["c_lambda"] * rate + gas, {"leaked_stroke": compressed / self.leak_time}, {"gas_force": gas})

    def rate(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        force: Expr,
        context: Context,
        corners: Corners,
    ) -> Expr:
        """What the gas leaves, over the damping."""
        return (force - design["k_gas"] * (stroke - states["leaked_stroke"])) / design["c_lambda"]


class Quintic(Piston):
    """F = c_lambda v (1 + (v/v_0)^2 + (v/v_0)^4), whose rate is a root of a quintic."""

    VARIABLES: ClassVar = (DAMPING,)

    kind: Literal["quintic"]
    reference_speed: Annotated[float, Quantity("m/s", above=0, example="0.5 m/s")]
    """v_0 [m/s]."""

    def force(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        rate: Expr,
        context: Context,
        corners: Corners,
    ) -> Force:
        """Odd in the rate."""
        ratio = (rate / self.reference_speed) ** 2
        return Force(design["c_lambda"] * rate * (1 + ratio + ratio**2))

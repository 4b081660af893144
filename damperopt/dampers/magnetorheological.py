"""Magnetorheological dampers: a viscous part that is always there, and a yield force that a current raises.

Linear models and proofs have the viscous part alone (with hysteresis: and a spring at the idle current): the fail-safe damper,
which must keep a margin of its own. What a current adds, by the rate of the stroke with a lag, only simulation shows.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

from ..expressions.calculus import Expr, symbol
from ..expressions.corners import Corners, Linear, Smooth
from ..ports.sizing import Force, LimitEvent, Size, Sized
from ..quantities.named import DesignVariable, Output, State
from ..quantities.record import Density, Fraction, Length, Time
from ..quantities.record import Force as ForceNumber
from ..quantities.units import Quantity
from ..strength.cylinder import bore, cylinder_mass, piston_area, rod_diameters, rod_length
from .base import FORGOTTEN, Context, Damper

__all__ = ["Bingham", "BoucWen"]

Current = Annotated[float, Quantity("A", at_least=0, example="1 A")]
Yield = Annotated[float, Quantity("N", at_least=0, example="200 N")]


class _Magnetorheological(Damper):
    """What both have: the yield force over the current, the command, and the parts."""

    VARIABLES: ClassVar = (
        DesignVariable("c_lambda", "N s/m", r"$c_\lambda$", "damping of the damper without current", example="1e4 N s/m"),
    )
    COMMANDED: ClassVar = True
    STATES: ClassVar[tuple[State, ...]] = (State("control_current", "A", "current", even=True),)
    OUTPUTS: ClassVar = (Output("yield_force", "N", "at the current that flows"),)

    residual_yield: Yield = 0.0
    """f_0, of the fluid and the seals without current [N]."""
    yield_per_ampere: Annotated[float, Quantity("N/A", above=0, example="500 N/A")]
    """f_1 [N/A]."""
    idle_current: Current = 0.0
    """i_0 that always flows [A]."""
    control_current: Current = 0.0
    """i_1, the most that is added: by the rate of the stroke i_1 v^2/(v^2 + v_1^2), or by a law (`control`) [A]."""
    control_rate: Annotated[float, Quantity("m/s", above=0, example="0.1 m/s")] = 0.1
    """v_1, at which it adds half of that [m/s]."""
    switching_band: ForceNumber = 50.0
    """F_b over which a law (`control`) switches the current on and off [N]."""
    switching_smoothing: Annotated[float, Quantity("1", above=0, at_most=0.5)] = 0.002
    """Width of the rounded corners of that in the smooth version, as a fraction of the band."""
    response_time: Time = 0.02
    """tau, lag of the current and the fluid [s]."""
    fluid_density: Density = 3000.0
    """[kg/m^3]"""
    coil_fraction: Fraction = 0.2
    """Mass of coil and poles over that of the cylinder [1]."""

    def yield_force(self, added: Expr) -> Expr:
        """f_0 + f_1 (i_0 + added), with the current that control adds [N]."""
        return self.residual_yield + self.yield_per_ampere * (self.idle_current + added)

    def _lagging(self, added: Expr, rate: Expr, force: Expr, wanted: Expr, corners: Corners) -> Expr:
        """tau i' = i_1 v^2/(v^2 + v_1^2) - i; with a law that wants a force, its share of i_1 in the place of the first."""
        share = rate**2 / (rate**2 + self.control_rate**2) if wanted is None else self._clipped(force, wanted, corners)
        return (self.control_current * share - added) / self.response_time

    def _clipped(self, force: Expr, wanted: Expr, corners: Corners) -> Expr:
        """1 where the force has the sign of what is wanted and is smaller, else 0; between them a band F_b of forces.

        With f = clip(F/F_b, -1, 1) it is (F* f - |F|)/F_b, clipped to 0 .. 1; F_b to 0 is the clipped-optimal law of Dyke,
        Spencer, Sain & Carlson, Smart Materials and Structures 5 (1996), as one that switches without chattering.
        """
        band, width = self.switching_band, self.switching_smoothing
        side = force / band - corners.contact("law, force", force / band, 1, width)
        lacking = wanted / band * side - corners.sign("law, side", force, width * band) * force / band
        return self._share(lacking, corners) - self._share(0, corners if isinstance(corners, Smooth) else Linear())

    def _share(self, lacking: Expr, corners: Corners) -> Expr:
        return lacking - corners.contact("law, lacking", lacking - 0.5, 0.5, self.switching_smoothing)

    def peak_force(self, design: Mapping[str, Expr], rate: Expr) -> Expr:
        """Viscous force at the largest rate, and the yield force at the largest current."""
        return design["c_lambda"] * rate + self.yield_force(self.control_current)

    def parts(self, event: LimitEvent, model: Any) -> Sized:
        """The cylinder of a hydraulic damper, with a heavier fluid, coil and poles."""
        diameter = symbol("rod_diameter")
        rod = Size("rod_diameter", "m", diameter, rod_diameters(event, model), start=0.02, lower=1e-5, upper=10.0)
        area = piston_area(event, model)
        length = rod_length(event, model) + event.stroke + bore(area, diameter)
        fluid = area * rod_length(event, model)
        cylinder = (1 + self.coil_fraction) * cylinder_mass(event, model, diameter, area)
        return Sized({"damper": cylinder + (self.fluid_density - model.oil_density) * fluid}, (rod,), length)

    def leaves_out(self) -> tuple[str, ...]:
        """What the linear model of it does not hold."""
        current = "the yield force, and the current that rate or law adds: simulate has them (damper.control_current)"
        return (current, "saturation of the yield force over the current, and its fall with temperature")


class Bingham(_Magnetorheological):
    """Magnetorheological damper as a Bingham body, F = c v + f(i) sign(v), with a current that lags."""

    kind: Literal["magnetorheological"]
    smoothing: Annotated[float, Quantity("m/s", above=0, example="1 mm/s")] = 1e-3
    """Rate over which the smooth version turns around [m/s]."""

    def force(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        rate: Expr,
        context: Context,
        corners: Corners,
    ) -> Force:
        """F = c v + f(i) sign(v), tau i' = wanted - i; linear models have c v alone."""
        added = states["control_current"]
        top = self.yield_force(added)
        force = design["c_lambda"] * rate + top * corners.sign("damper friction", rate, self.smoothing)
        rates = {"control_current": self._lagging(added, rate, force, context.wanted, corners)}
        return Force(force, rates, {"yield_force": top})

    def rate(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        force: Expr,
        context: Context,
        corners: Corners,
    ) -> Expr:
        """What goes beyond the yield force, over c."""
        c, top = design["c_lambda"], self.yield_force(states["control_current"])
        return corners.gap("yield", force, top, c * self.smoothing)[0] / c

    def equivalent(
        self, design: Mapping[str, Expr], amplitude: Expr, frequency: Expr, context: Context
    ) -> tuple[Expr, Expr] | None:
        """c + 4 f/(pi omega X); None where the current follows the rate."""
        if self.control_current:
            return None
        return 0.0, design["c_lambda"] + 4 * self.yield_force(0.0) / (math.pi * frequency * amplitude)


class BoucWen(_Magnetorheological):
    """Magnetorheological damper with hysteresis, F = c v + f(i) z, after Bouc and Wen in its normalised form.

    x_y z' = v - beta |v| z |z|^(n-1) - (1 - beta) v |z|^n, so that |z| goes to 1: Ikhouane & Rodellar, Systems with Hysteresis
    (2007); for these dampers Spencer, Dyke, Sain & Carlson, J. Eng. Mech. 123 (1997). beta = 1, n = 1 is Dahl's friction.
    """

    STATES: ClassVar = (*_Magnetorheological.STATES, State("hysteresis", "1", "hysteresis"))

    kind: Literal["bouc_wen"]
    knee: Length
    """x_y, stroke over which the yield force builds up [m]."""
    sharpness: Literal[1, 2] = 2
    """n."""
    unloading: Annotated[float, Quantity("1", at_least=0.5, at_most=1, example="0.5")] = 0.5
    """beta; 1/2: it unloads along a straight line [1]."""

    def force(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        rate: Expr,
        context: Context,
        corners: Corners,
    ) -> Force:
        """F = c v + f(i) z; the linear model has the spring f(i_0)/x_y beside c."""
        added, z, x_y, beta = states["control_current"], states["hysteresis"], self.knee, self.unloading
        top = self.yield_force(added)
        if isinstance(corners, Linear):
            turn = rate / x_y - FORGOTTEN * (z - stroke / x_y)
        else:
            fast, size = corners.magnitude(rate, 1e-6 * self.control_rate), corners.magnitude(z, 1e-9)
            loading, reloading = (z, size) if self.sharpness == 1 else (z * size, z**2)
            turn = (rate - beta * fast * loading - (1 - beta) * rate * reloading) / x_y
        force = design["c_lambda"] * rate + top * z
        rates = {"control_current": self._lagging(added, rate, force, context.wanted, corners), "hysteresis": turn}
        return Force(force, rates, {"yield_force": top})

    def rate(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        force: Expr,
        context: Context,
        corners: Corners,
    ) -> Expr:
        """(F - f(i) z)/c."""
        return (force - self.yield_force(states["control_current"]) * states["hysteresis"]) / design["c_lambda"]

"""A tyre estimated from its size and pressure by the formulas of NASA TR R-64 (Smiley and Horne), for bias-ply tyres.

All of them are pressures times lengths, so that they hold in any system of units; friction alone, which falls with the
pressure in psi, is converted.
"""

from __future__ import annotations

import re
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, StringConstraints, model_validator

from ...expressions.calculus import Expr, absolute, exp, log, piecewise, sqrt, where
from ...expressions.corners import Corners
from ...ports.sizing import Peaks
from ...quantities.named import Output
from ...quantities.record import Length, Pressure, refuse
from ...quantities.units import Quantity
from ..base import Linear, SlipLaw

__all__ = ["TR_R64Law"]

INCH = 0.0254
PSI = 6894.757293168
SIZE = re.compile(r"([0-9]{1,3}(?:\.[0-9]+)?) ?[xX] ?([0-9]{1,2}(?:\.[0-9]+)?)(?: ?- ?[0-9]{1,2}(?:\.[0-9]+)?)?")
"""Outside diameter x width, and the rim, in inches."""
DEEPEST = 0.3
"""Deflection over width up to which the formulas are used."""


def _parabola(r: Expr, c: float, b: float, a: float) -> Expr:
    """c + b r - a r^2 with the square completed: of a ball it holds no more than it must."""
    beside = r - b / (2 * a)
    return c + b * b / (4 * a) - a * beside**2


class TR_R64Law(SlipLaw):
    """NASA TR R-64: an estimate, +-20 %, of a bias-ply tyre of type III or VII from size, load and pressure."""

    LOAD_POWERS: ClassVar = None
    GIVES: ClassVar = ("half_contact_length", "relaxation_length")
    TABLE: ClassVar = (
        Output("vertical_deflection", "m", "d0"),
        Output("lateral_stiffness", "N/m", "K_y, static"),
        Output("fore_aft_stiffness", "N/m", "K_x, static"),
        Output("twist_stiffness", "N m/rad", "K_a, static"),
        Output("static_relaxation_length", "m", "L_s, unyawed"),
        Output("stiffness_ratio_length", "m", "N/K_y - h, the other estimate of sigma"),
        Output("friction", "1", "mu"),
    )

    law: Literal["tr_r64"]
    size: Annotated[str, StringConstraints(max_length=40), Field(examples=["49x17"])]
    """Outside diameter x width in inches, with or without the rim: 49x17, 18x5.5, 22x6.75-10."""
    type: Literal["VII", "III"]
    """Of the tyre: VII, extra high pressure; III, low pressure."""
    rated_pressure: Pressure
    """p_r, of the catalogue; `pressure`, left out, is this one [Pa]."""
    outside_diameter: Length | None = None
    """d, where the size does not name it, as 8.50-10 [m]."""
    width: Length | None = None
    """w, where the size does not name it [m]."""
    friction: Annotated[float, Quantity("1", above=0, at_most=2, example="0.7")] | None = None
    """mu of the yawed tyre; left out: 0.93 - 0.0011 p in psi [1]."""
    relaxation: Literal["yawed_rolling", "stiffness_ratio"] = "yawed_rolling"
    """Estimate of sigma: the report's for yawed rolling, or cornering over lateral stiffness less h, 15 to 27 % shorter."""

    @model_validator(mode="after")
    def _known(self) -> Self:
        allowed = "diameter x width in inches of a bias-ply tyre, such as 49x17, or outside_diameter and width beside it"
        if re.search(r"\dR\d", self.size, re.IGNORECASE):
            raise refuse("size", f"'{self.size}' is a radial tyre, for which the formulas do not hold", allowed)
        if not SIZE.fullmatch(self.size.strip()) and None in (self.outside_diameter, self.width):
            raise refuse("size", f"'{self.size}' names no outside diameter and width", allowed)
        d, w = self._lengths()
        if not (0.1 < d < 3 and 0.1 * d < w < 0.6 * d):
            raise refuse(
                "size", f"found a diameter of {d:.4g} m and a width of {w:.4g} m", "0.1 to 3 m, and a tenth to 0.6 of it"
            )
        p = self._pressure(getattr(self, "pressure", None))
        if not 0.5 <= p / self.rated_pressure <= 1.5:
            raise refuse("pressure", f"{p / self.rated_pressure:.3g} of the rated pressure", "0.5 to 1.5 of it")
        return self

    def _lengths(self) -> tuple[Expr, Expr]:
        """d, w [m]."""
        named = SIZE.fullmatch(self.size.strip())
        d, w = (float(text) * INCH for text in named.groups()) if named else (None, None)
        return d if self.outside_diameter is None else self.outside_diameter, w if self.width is None else self.width

    def _pressure(self, pressure: Expr | None) -> Expr:
        return self.rated_pressure if pressure is None else pressure

    def _deflections(self, load: Expr, pressure: Expr) -> tuple[Expr, Expr]:
        """d0/d and d0/w: F_z/((p + 0.08 p_r) w sqrt(w d)) = 0.96 x + 0.216 x^2/C_z up to x = 10/3 C_z, then 2.4 (x - C_z)."""
        d, w = self._lengths()
        C_z = {"VII": 0.02, "III": 0.03}[self.type]
        f = load / ((self._pressure(pressure) + 0.08 * self.rated_pressure) * w * sqrt(w * d))
        x = piecewise(
            f,
            [5.6 * C_z],
            [lambda f: (sqrt(0.96 * 0.96 + 0.864 / C_z * f) - 0.96) * C_z / 0.432, lambda f: f / 2.4 + C_z],
        )
        return x * w / d, x

    def _half_length(self, load: Expr, pressure: Expr) -> Expr:
        """h = 0.85 d sqrt(r - r^2), r = d0/d; or that of the study."""
        r, _ = self._deflections(load, pressure)
        given = self.half_contact_length  # type: ignore[attr-defined]  # of the tyre it belongs to
        return 0.85 * self._lengths()[0] * sqrt(_parabola(r, 0.0, 1.0, 1.0)) if given is None else given

    def _cornering(self, load: Expr, pressure: Expr) -> Expr:
        """N = C_c w^2 (p + 0.44 p_r) (1.2 r - 8.8 r^2 up to r = 0.0875, then 0.067375 - 0.34 r) [N/rad].

        The constant is known as 0.0674; with 0.067375 the pieces meet.
        """
        r, _ = self._deflections(load, pressure)
        _, w = self._lengths()
        C_c = {"VII": 57.0, "III": 63.0}[self.type]
        shape = piecewise(r, [0.0875], [lambda r: _parabola(r, 0.0, 1.2, 8.8), lambda r: 0.067375 - 0.34 * r])
        return C_c * w * w * (self._pressure(pressure) + 0.44 * self.rated_pressure) * shape

    def _lateral(self, load: Expr, pressure: Expr) -> Expr:
        """K_y = tau w (p + 0.24 p_r) (1 - 0.7 d0/w) [N/m]."""
        _, x = self._deflections(load, pressure)
        tau = {"VII": 2.0, "III": 3.0}[self.type]
        return tau * self._lengths()[1] * (self._pressure(pressure) + 0.24 * self.rated_pressure) * (1 - 0.7 * x)

    def _yawed_rolling(self, load: Expr, pressure: Expr) -> Expr:
        """L_y = (2.8 - 0.8 p/p_r) w times a function of r in three pieces [m]."""
        r, _ = self._deflections(load, pressure)
        shape = piecewise(
            r, [0.053, 0.068], [lambda r: 11 * r, lambda r: _parabola(r, -1.4045, 64, 500), lambda r: 0.9075 - 4 * r]
        )
        return (2.8 - 0.8 * self._pressure(pressure) / self.rated_pressure) * self._lengths()[1] * shape

    def _stiffness_ratio(self, load: Expr, pressure: Expr) -> Expr:
        """N = (sigma + h) K_y, as a string has it [m]."""
        return self._cornering(load, pressure) / self._lateral(load, pressure) - self._half_length(load, pressure)

    def linear(self, load: Expr, pressure: Expr) -> Linear:
        """C_Fa = N, C_Ma = 0.8 h N, sigma = L_y or N/K_y - h, a = h."""
        N, h = self._cornering(load, pressure), self._half_length(load, pressure)
        sigma = self.relaxation_length  # type: ignore[attr-defined]  # of the tyre it belongs to
        if sigma is None:
            estimate = {"yawed_rolling": self._yawed_rolling, "stiffness_ratio": self._stiffness_ratio}[self.relaxation]
            sigma = estimate(load, pressure)
        return Linear(N, 0.8 * h * N, sigma, h)

    def _grip(self, load: Expr, pressure: Expr) -> Expr:
        """mu F_z [N]."""
        mu = 0.93 - 0.0011 / PSI * self._pressure(pressure) if self.friction is None else self.friction
        return mu * load

    def force(self, alpha_F: Expr, load: Expr, pressure: Expr) -> Expr:
        """F_y = mu F_z (P - 4/27 P^3) up to P = N alpha/(mu F_z) = 1.5, then mu F_z [N]."""
        N, grip = self._cornering(load, pressure), self._grip(load, pressure)
        P = absolute(N * alpha_F / grip)
        return where(P < 1.5, N * alpha_F * (1 - 4 / 27 * P * P), grip * where(alpha_F < 0, -1.0, 1.0))

    def moment(self, alpha_M: Expr, load: Expr, pressure: Expr, corners: Corners) -> Expr:
        """M_z = mu F_z h (0.8 P up to 0.1, P - P^2 - 0.01 up to 0.55, 0.2925 - 0.1 P), and 0 from P = 2.925 on [N m]."""
        N, grip, h = self._cornering(load, pressure), self._grip(load, pressure), self._half_length(load, pressure)
        P = absolute(N * alpha_M / grip)
        beyond = where(P < 0.55, P - P * P - 0.01, where(P < 2.925, 0.2925 - 0.1 * P, 0.0))
        return where(P < 0.1, 0.8 * N * alpha_M * h, grip * h * beyond * where(alpha_M < 0, -1.0, 1.0))

    def peaks(self, load: Expr, pressure: Expr) -> Peaks:
        """mu F_z, and 0.24 mu F_z h at P = 0.5."""
        grip = self._grip(load, pressure)
        return Peaks(grip, 0.24 * grip * self._half_length(load, pressure))

    def others(self, load: float, pressure: float | None) -> dict[str, float]:
        """K_x = 0.6 d (p + 4 p_r) r^(1/3), K_a = (p + 0.8 p_r) w^3 (250 r^2 up to r = 0.03, then 15 (r - 0.015)), and more."""
        (r, x), (d, w) = self._deflections(load, pressure), self._lengths()
        p, p_r = self._pressure(pressure), self.rated_pressure
        twist = piecewise(r, [0.03], [lambda r: 250 * r * r, lambda r: 15 * (r - 0.015)])
        return {
            "vertical_deflection": x * w,
            "lateral_stiffness": self._lateral(load, pressure),
            "fore_aft_stiffness": 0.6 * d * (p + 4 * p_r) * exp(log(r) / 3),
            "twist_stiffness": (p + 0.8 * p_r) * w * w * w * twist,
            "static_relaxation_length": (2.8 - 0.8 * p / p_r) * (1 - 4.5 * r) * w,
            "stiffness_ratio_length": self._stiffness_ratio(load, pressure),
            "friction": self._grip(load, pressure) / load,
        }

    def loads(self) -> tuple[float, float]:
        """From a twentieth of the load that presses the tyre flat by 0.3 of its width, to that load."""
        d, w = self._lengths()
        pressure = self._pressure(self.pressure)  # type: ignore[attr-defined]  # of the tyre it belongs to
        C_z = {"VII": 0.02, "III": 0.03}[self.type]
        most = float(2.4 * (DEEPEST - C_z) * (pressure + 0.08 * self.rated_pressure) * w * sqrt(w * d))
        return 0.05 * most, 0.999999 * most

    def beyond(self, load: float, pressure: float | None) -> str:
        """A deflection of more than 0.3 of the width, or none."""
        _, x = self._deflections(load, pressure)
        if 0 < x <= DEEPEST:
            return ""
        return f"presses a {self.size} tyre flat by {x:.3g} of its width, where its formulas end at {DEEPEST:g}"

    def radius(self) -> float:
        """d/2 [m]."""
        return float(self._lengths()[0]) / 2

    def leaves_out(self) -> tuple[str, ...]:
        """The spread."""
        return ("spread of the estimated tyre, about 20 % to either side (tyre.size)",)

    def origin(self) -> str:
        """What the numbers are."""
        return (
            f"The tyre is an estimate from its size ({self.size}, type {self.type}) by NASA TR R-64, whose formulas spread by "
            "about 20 % to either side of measured tyres; they hold for bias-ply tyres alone."
        )

"""A point contact that gives way sideways, with a time lag between side force and slip."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, ClassVar, Literal

from ...expressions.calculus import Expr, atan, cos, sin
from ...ports.wheel import Wheel
from ...quantities.named import State
from ...quantities.record import Stiffness
from ...quantities.units import Quantity
from ..base import ContactLine, Linear, Slips

__all__ = ["Moreland"]


class Moreland(ContactLine):
    """One contact point on a lateral spring, whose slip follows the side force with a time lag."""

    STATES: ClassVar = (State("string_deflection", "m", "string"), State("contact_slip", "rad", "contact line"))
    SPEED_POWERS: ClassVar = (0, 1)
    LOAD_POWERS: ClassVar = None  # k_y/C_Fa
    RELAXES: ClassVar = False

    contact: Literal["moreland"]
    lateral_stiffness: Stiffness
    """k_y of the tyre standing still [N/m]; the relaxation length is C_Fa/k_y."""
    time_constant: Annotated[float, Quantity("s", above=0, example="2.5 ms")]
    """tau of the lag, from a test [s]; valid for frequencies well below 1/tau."""

    def slips(self, wheel: Wheel, linear: Linear, x: Sequence[Expr]) -> Slips:
        """u' = V (sin(theta) - cos(theta) tan(alpha)) - eta', tau (tan(alpha))' = k_y u/C_Fa - tan(alpha).

        u is the deflection of the contact point against the wheel; F_y = k_y u, M_z = C_Ma tan(alpha). Source: Moreland (1954).
        """
        u, slip = x
        C_Fa, *_ = linear
        V, theta, eta_t = wheel.speed, wheel.swivel, wheel.lateral_rate
        tan_F = self.lateral_stiffness * u / C_Fa
        rates = V * (sin(theta) - cos(theta) * slip) - eta_t, (tan_F - slip) / self.time_constant
        return Slips(rates, atan(tan_F), atan(slip))

    def side_stiffness(self, linear: Linear) -> Expr:
        """k_y [N/m]."""
        return self.lateral_stiffness

    def response(self, s: Expr, linear: Linear, speed: Expr = 1.0) -> tuple[Expr, Expr, Expr, Expr]:
        """u = (theta - s eta)/(s + (k_y/C_Fa)/(1 + tau V s))."""
        C_Fa, C_Ma, *_ = linear
        k_y, lag = self.lateral_stiffness, 1 + self.time_constant * speed * s
        u = 1 / (s + k_y / (C_Fa * lag))
        slip = C_Ma * k_y / (C_Fa * lag) * u
        return k_y * u, -k_y * s * u, slip, -slip * s

    def leaves_out(self) -> tuple[str, ...]:
        """What one contact point cannot hold."""
        return ("length and memory of the contact line (tyre.contact moreland: one point with a time lag)",)

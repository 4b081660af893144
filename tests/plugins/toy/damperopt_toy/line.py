"""A contact line whose footprint follows the string with a lag of its own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Literal

from damperopt.expressions.calculus import Expr, atan, cos, sin
from damperopt.ports.wheel import Wheel
from damperopt.quantities.named import State
from damperopt.quantities.record import Length
from damperopt.tyres.base import ContactLine, Linear, Slips


class TwoLags(ContactLine):
    """Two relaxations in a row: of the carcass over sigma, and of the tread over a length of its own."""

    STATES: ClassVar = (State("carcass_deflection", "m", "carcass"), State("tread_deflection", "m", "tread"))
    SPEED_POWERS: ClassVar = (0, 1)

    contact: Literal["two_lags"]
    tread_length: Length
    """Over which the tread follows the carcass [m]."""

    def slips(self, wheel: Wheel, linear: Linear, x: Sequence[Expr]) -> Slips:
        """y of the carcass as a string led by its foremost point; z' = V (y - z)/length; slip angles atan(z/sigma)."""
        y, z = x
        _, _, sigma, a = linear
        V, theta = wheel.speed, wheel.swivel
        y_t = V * sin(theta) - wheel.lateral_rate - a * cos(theta) * wheel.swivel_rate - V / sigma * y * cos(theta)
        alpha = atan(z / sigma)
        return Slips((y_t, V * (y - z) / self.tread_length), alpha, alpha)

    def response(self, s: Expr, linear: Linear) -> tuple[Expr, Expr, Expr, Expr]:
        """That of the leading point, over 1 + length s."""
        C_Fa, C_Ma, sigma, a = linear
        lag = (1 + sigma * s) * (1 + self.tread_length * s)
        theta, eta = (1 - a * s) / lag, -s / lag
        return C_Fa * theta, C_Fa * eta, C_Ma * theta, C_Ma * eta

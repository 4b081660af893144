"""The contact line by a Taylor series of the path of the contact centre."""

from __future__ import annotations

from collections.abc import Sequence
from math import factorial
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from ...expressions.calculus import Expr, atan, cos, sin
from ...ports.wheel import Wheel
from ...quantities.named import State
from ..base import ContactLine, Linear, Slips

__all__ = ["Smiley"]


class Smiley(ContactLine):
    """The string led by the series of order n of the path of its contact centre; it does not converge to the exact line."""

    SPEED_POWERS: ClassVar = (0, 1)

    contact: Literal["smiley"]
    order: Annotated[int, Field(ge=1, le=6)] = 2
    """n of the series."""

    def states(self) -> tuple[State, ...]:
        """Deflection of the contact centre against the wheel plane, then derivatives of its path over the distance."""
        slope = (State("path_slope", "rad", "contact line", hidden=True),) if self.order > 1 else ()
        more = (State(f"path_derivative_{k}", f"1/m^{k - 1}", "contact line", hidden=True) for k in range(2, self.order))
        return (State("string_deflection", "m", "string"), *slope, *more)

    def slips(self, wheel: Wheel, linear: Linear, x: Sequence[Expr]) -> Slips:
        """sum_k A_k d^k q0/ds^k = eta + (a + sigma) theta; tan(alpha_F) = (q0 - eta)/(a + sigma), tan(alpha_M) = theta - q0'.

        q0 path of the contact centre, A_k = a^k/k! + sigma a^(k - 1)/(k - 1)!. The states are q0 - eta, q0' - theta, q0'', ...
        """
        _, _, sigma, a = linear
        V, theta, theta_t, eta_t = wheel.speed, wheel.swivel, wheel.swivel_rate, wheel.lateral_rate
        A = self._series(sigma, a)
        highest = -sum(A[k] * x[k] for k in range(self.order)) / A[-1]
        d = (*x, highest)
        U = V * cos(theta)
        rates = [U * d[1] + V * sin(theta) - eta_t]
        if self.order > 1:
            rates.append(U * d[2] - cos(theta) * theta_t)
        rates += [U * d[k + 1] for k in range(2, self.order)]
        return Slips(tuple(rates), atan(d[0] / (a + sigma)), atan(-d[1]))

    def response(self, s: Expr, linear: Linear, speed: Expr = 1.0) -> tuple[Expr, Expr, Expr, Expr]:
        """q0 = (eta + (a + sigma) theta)/sum_k A_k s^k."""
        C_Fa, C_Ma, sigma, a = linear
        path = sum(A_k * s**k for k, A_k in enumerate(self._series(sigma, a)))
        by_theta, by_eta = (a + sigma) / path, 1 / path
        per = C_Fa / (a + sigma)
        return per * by_theta, per * (by_eta - 1), C_Ma * (1 - s * by_theta), -C_Ma * s * by_eta

    def least_wave(self) -> float:
        """Where force or moment is off by a tenth; a higher order gains little."""
        return 8.0

    def leaves_out(self) -> tuple[str, ...]:
        """What a series of finite order cannot hold."""
        return (f"contact memory beyond a series of order {self.order} of the path (tyre.contact smiley)",)

    def _series(self, sigma: Expr, a: Expr) -> list[Expr]:
        return [1, *(a**k / factorial(k) + sigma * a ** (k - 1) / factorial(k - 1) for k in range(1, self.order + 1))]

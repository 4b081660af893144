"""The string that touches the ground at its leading point alone: the straight tangent."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Literal

from ...expressions.calculus import Expr, atan, cos, sin
from ...ports.wheel import Wheel
from ...quantities.named import State
from ..base import ContactLine, Linear, Slips

__all__ = ["LeadingPoint"]


class LeadingPoint(ContactLine):
    """A string led by its foremost contact point; what that point laid down is forgotten at once (straight tangent)."""

    STATES: ClassVar = (State("string_deflection", "m", "string"),)
    SPEED_POWERS: ClassVar = (0, 1)

    contact: Literal["leading_point"]

    def slips(self, wheel: Wheel, linear: Linear, x: Sequence[Expr]) -> Slips:
        """y is the deflection of the leading point against the wheel plane.

        The leading point y + eta + a sin(theta) stays on the ground but for what the string gives way; thesis (2-14).

        y' = V sin(theta) - (V/sigma) y cos(theta) - d/dt(eta + a sin(theta)); both slip angles are atan(y/sigma). As the
        footprint grows, its front moves over the ground at V + a': a' sin(theta) falls out, and V/sigma is (V + a')/sigma.
        """
        # V speed, theta swivel, eta lateral position of the contact centre, a half contact length, sigma relaxation length
        (y,) = x
        _, _, sigma, a = linear
        V, theta, theta_t, eta_t = wheel.speed, wheel.swivel, wheel.swivel_rate, wheel.lateral_rate
        front = V * cos(theta) + linear.half_contact_length_rate
        y_t = V * sin(theta) - eta_t - a * cos(theta) * theta_t - front / sigma * y
        alpha = atan(y / sigma)
        return Slips((y_t,), alpha, alpha)

    def response(self, s: Expr, linear: Linear, speed: Expr = 1.0) -> tuple[Expr, Expr, Expr, Expr]:
        """C (theta (1 - a s) - s eta)/(1 + sigma s), with C the stiffness of force or moment."""
        C_Fa, C_Ma, sigma, a = linear
        theta, eta = (1 - a * s) / (1 + sigma * s), -s / (1 + sigma * s)
        return C_Fa * theta, C_Fa * eta, C_Ma * theta, C_Ma * eta

    def leaves_out(self) -> tuple[str, ...]:
        """The memory of the footprint."""
        return ("contact memory of the tyre (tyre.contact leading_point; memory has it)",)

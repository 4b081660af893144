"""The delay of the contact line by a diagonal Pade approximation: contact memory with rational transfer functions."""

from __future__ import annotations

from math import factorial, pi
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator

from ...expressions.calculus import Expr
from ...quantities.record import refuse
from ...quantities.units import Quantity
from ..string import StringLine, Weights

__all__ = ["Pade"]


class Pade(StringLine):
    """The string with contact memory, its delay by the Pade approximation of an order n: n more states, good to 2 a w/V = n."""

    RATIONAL: ClassVar = True

    contact: Literal["pade"]
    order: Annotated[int, Field(ge=1, le=20)] = 2
    """n of the approximation; 1 with `line` von_schlippe or parabola alone."""
    line: Literal["memory", "von_schlippe", "parabola"] = "memory"
    """The contact line whose delay is approximated."""
    damping_time: Annotated[float, Quantity("s", above=0, example="2.6 ms")] | None = None
    """b/c of the string's side damping b and stiffness c per length [s]; left out: no damping. Not with `line` parabola."""

    @model_validator(mode="after")
    def _holds_its_moment(self) -> Self:
        if self.order == 1 and self.line == "memory":
            raise refuse("order", "1 holds no first moment of the line", "2 or more, or line: von_schlippe")
        if self.damping_time is not None and self.line == "parabola":
            raise refuse("damping_time", "line parabola, whose slope is no deflection", "line: memory or von_schlippe")
        return self

    def weights(self, sigma: Expr, a: Expr) -> Weights:
        """Of the contact line that is approximated."""
        from . import memory, parabola, von_schlippe  # of which one approximates itself by this kind

        lines = {"memory": memory.Memory, "von_schlippe": von_schlippe.VonSchlippe, "parabola": parabola.Parabola}
        return lines[self.line](contact=self.line).weights(sigma, a)

    def side_damping(self) -> Expr | None:
        """`damping_time`."""
        return self.damping_time

    def delay(self, z: Expr) -> tuple[Expr, Expr, Expr]:
        """E = N(-z)/N(z) with N = sum of c_k z^k, and phi1, chi of that E."""
        n = self.order
        c = [factorial(2 * n - k) * factorial(n) / (factorial(2 * n) * factorial(k) * factorial(n - k)) for k in range(n + 1)]
        N = sum(c[k] * z**k for k in range(n + 1))
        odd = sum(c[k] * z ** (k - 1) for k in range(1, n + 1, 2))
        first = sum((2 * c[k - 1] - 4 * (c[k] if k <= n else 0)) * z ** (k - 2) for k in range(3, n + 2, 2))
        return 1 - 2 * z * odd / N, 2 * odd / N, first / N

    def least_wave(self) -> float:
        """That at which 2 a w/V is the order."""
        return 2 * pi / self.order

    def leaves_out(self) -> tuple[str, ...]:
        """How far an approximation reaches."""
        found = f"contact memory beyond 2 a w/V = {self.order} (tyre.contact pade, order {self.order}; memory is exact)"
        damped = (
            "that damping of the carcass is a loss per cycle rather than per rate: with damping_time it grows with the speed"
        )
        return (found,) if self.damping_time is None else (found, damped)

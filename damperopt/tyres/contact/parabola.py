"""The contact line as a parabola through its two ends, with the slope of its foremost point."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from ...expressions.calculus import Expr
from ..base import ContactLine
from ..string import StringLine, Weights
from .pade import Pade

__all__ = ["Parabola"]


class Parabola(StringLine):
    """The string whose contact line is a parabola through its two ends, with the slope of its foremost point."""

    RATIONAL: ClassVar = False

    contact: Literal["parabola"]
    order: Annotated[int, Field(ge=1, le=40)] = 8
    """Of the contact line as a field in transients; eigenvalues and certificate take the exact delay."""

    def weights(self, sigma: Expr, a: Expr) -> Weights:
        """The slope at the front is -y/sigma, that of the string before the footprint."""
        ends = a**2 / 3 + sigma * (a + sigma)
        return Weights(front=4 * a / 3 + sigma + 2 * a**2 / (3 * sigma), rear=2 * a / 3 + sigma, inside=0, ends=ends, twist=0)

    def realisation(self, purpose: str) -> ContactLine:
        """In an optimisation the Pade approximation of its delay."""
        return Pade(contact="pade", order=2, line="parabola") if purpose == "search" else self

    def least_wave(self) -> float:
        """Where force or moment is off by a tenth."""
        return 3.0

    def leaves_out(self) -> tuple[str, ...]:
        """The shape between the ends."""
        return ("the shape of the contact line beyond a parabola (tyre.contact parabola; memory has it)",)

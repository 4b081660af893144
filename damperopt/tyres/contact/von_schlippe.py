"""The contact line as a straight line between its two ends."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from ...expressions.calculus import Expr
from ..base import ContactLine
from ..string import StringLine, Weights
from .pade import Pade

__all__ = ["VonSchlippe"]


class VonSchlippe(StringLine):
    """The string whose contact line is straight from its foremost point to where that point was 2 a earlier."""

    RATIONAL: ClassVar = False

    contact: Literal["von_schlippe"]
    order: Annotated[int, Field(ge=1, le=40)] = 8
    """Of the contact line as a field in transients; eigenvalues and certificate take the exact delay."""

    def weights(self, sigma: Expr, a: Expr) -> Weights:
        """Source: von Schlippe & Dietrich (1941)."""
        return Weights(front=a + sigma, rear=a + sigma, inside=0, ends=a**2 / 3 + sigma * (a + sigma), twist=0)

    def realisation(self, purpose: str) -> ContactLine:
        """In an optimisation the Pade approximation of its delay."""
        return Pade(contact="pade", order=2, line="von_schlippe") if purpose == "search" else self

    def least_wave(self) -> float:
        """Where force or moment is off by a tenth."""
        return 4.0

    def leaves_out(self) -> tuple[str, ...]:
        """The shape between the ends."""
        return ("the shape of the contact line between its ends (tyre.contact von_schlippe; memory has it)",)

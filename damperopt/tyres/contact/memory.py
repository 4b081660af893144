"""The string with its whole contact line: what the ground has laid down passes under the wheel, exactly."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from ...expressions.calculus import Expr
from ..base import ContactLine
from ..string import StringLine, Weights
from .pade import Pade

__all__ = ["SEARCH_ORDER", "Memory"]

SEARCH_ORDER = 2
"""Of the Pade approximation in the place of the delay in an optimisation: good to 2 a w/V = 2."""


class Memory(StringLine):
    """The exact string with contact memory: the contact line keeps the shape that its foremost point has laid down."""

    RATIONAL: ClassVar = False

    contact: Literal["memory"]
    order: Annotated[int, Field(ge=2, le=40)] = 8
    """Of the contact line as a field in transients; eigenvalues and certificate take the exact delay."""

    def weights(self, sigma: Expr, a: Expr) -> Weights:
        """Ends that decay outside, and all that lies between."""
        return Weights(front=sigma, rear=sigma, inside=1, ends=sigma * (a + sigma), twist=1)

    def realisation(self, purpose: str) -> ContactLine:
        """In an optimisation the Pade approximation of a low order."""
        return Pade(contact="pade", order=SEARCH_ORDER) if purpose == "search" else self

    def least_wave(self) -> float:
        """None: the delay is exact."""
        return 0.0

    def leaves_out(self) -> tuple[str, ...]:
        """What a string is not."""
        return (
            "inertia and damping of the tyre's carcass",
            "one carcass stiffness for force and moment, where C_Fa and C_Ma are given apart (then energy is not conserved)",
        )

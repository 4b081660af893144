"""An A-frame: two legs from the strut to the apex, where a damper holds it sideways."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Literal

from damperopt.expressions.calculus import Expr, sin, sqrt
from damperopt.linkages.base import Layout, from_lengths
from damperopt.ports.linkage import Linkage, Member
from damperopt.ports.sizing import LimitEvent
from damperopt.quantities.named import DesignVariable
from damperopt.quantities.record import Length


class AFrame(Layout):
    """Legs of an A-frame in tension and compression are the spring; a wide frame is stiff, and heavy."""

    VARIABLES: ClassVar = (
        DesignVariable("w", "m", "$w$", "width of the A-frame at the strut", example="0.3 m"),
        DesignVariable("A_leg", "m^2", "$A_{leg}$", "section of a leg of the A-frame", example="1e-4 m^2"),
    )
    SPRING: ClassVar = "A_leg"

    topology: Literal["a_frame"]
    apex: Length
    """Distance of the apex from the strut axis [m]."""

    def leg(self, design: Mapping[str, Expr]) -> Expr:
        """Length of a leg [m]."""
        return sqrt(self.apex**2 + (design["w"] / 2) ** 2)

    def linkage(self, design: Mapping[str, Expr], youngs_modulus: Expr, stroke: Expr = 0) -> Linkage:
        """k = 2 E A/l (w/(2 l))^2 at the apex, which moves by R sin(psi)."""
        leg = self.leg(design)
        stiffness = 2 * youngs_modulus * design["A_leg"] / leg * (design["w"] / (2 * leg)) ** 2

        def sideways(psi: Expr) -> Expr:
            return self.apex * sin(psi)

        return from_lengths(stiffness, sideways, sideways, self.apex)

    def members(self, design: Mapping[str, Expr], stroke: Expr = 0) -> tuple[Member, ...]:
        """Two legs, and the damper at the apex; `masses` weighs the legs."""
        apex, half = (self.apex, 0.0, 0.0), design["w"] / 2
        return (
            Member("left leg", "", "link", (0.0, -half, 0.0), apex),
            Member("right leg", "", "link", (0.0, half, 0.0), apex),
            Member("damper at the apex", "", "damper", apex, (self.apex, 0.1, 0.0), load="damper_force"),
        )

    def masses(self, design: Mapping[str, Expr], event: LimitEvent, study: Any) -> dict[str, Expr]:
        """Two legs of constant section."""
        return {"A-frame": 2 * study.material.density * design["A_leg"] * self.leg(design)}

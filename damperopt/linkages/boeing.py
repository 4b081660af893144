"""Boeing's layout: two stiff torque links, with spring and damper between them at the apex."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Literal

from ..expressions.calculus import Expr, sin
from ..ports.linkage import Linkage, Member
from ..ports.sizing import LimitEvent
from ..quantities.named import DesignVariable
from ..strength.members import belleville_mass, belleville_stress
from .base import TorqueLinks, from_lengths, reach_and_height, viscous
from .spatial import closed_loop

__all__ = ["Boeing"]

GAP = 0.05
"""Half the width of the apex joint as it is drawn, in parts of the reach."""


class Boeing(TorqueLinks):
    """Two torque links with spring and damper in the gap at their apex, along y."""

    VARIABLES: ClassVar = (
        DesignVariable("k_lambda", "N/m", r"$k_\lambda$", "stiffness of the spring at the apex", example="4 MN/m"),
        *TorqueLinks.LENGTHS,
    )
    SPRING: ClassVar = "k_lambda"
    LINKS: ClassVar = 2

    topology: Literal["boeing"]

    def planar(self, design: Mapping[str, Expr], E: Expr, stroke: Expr) -> tuple[Linkage, tuple[Expr, Expr]]:
        """Both act on the apex gap ell sin(psi); thesis (3-9) .. (3-12)."""
        ell, _ = reach_and_height(design, stroke)

        def gap(psi: Expr) -> Expr:
            return ell * sin(psi)

        printed = design["k_lambda"] * ell**2, viscous(design) * ell**2
        return from_lengths(design["k_lambda"], gap, gap, ell), printed

    def spatial(self, design: Mapping[str, Expr], E: Expr, stroke: Expr) -> Linkage:
        """Two rigid links whose ends part by eps along y."""
        ell, _ = reach_and_height(design, stroke)
        return closed_loop(design, design["k_lambda"], stroke=stroke, spring_lever=ell, damper_lever=ell)

    def members(self, design: Mapping[str, Expr], stroke: Expr = 0) -> tuple[Member, ...]:
        """Two links and the damper between them."""
        ell, h = reach_and_height(design, stroke)
        apex = (ell, 0.0, 0.0)
        return (
            *self.link_members("lower torque link", design, -h, apex),
            *self.link_members("upper torque link", design, h, apex),
            Member("damper at the apex", "", "damper", (ell, -GAP * ell, 0.0), (ell, GAP * ell, 0.0), load="damper_force"),
        )

    def masses(self, design: Mapping[str, Expr], event: LimitEvent, study: Any) -> dict[str, Expr]:
        """Links and the Belleville stack."""
        return {**super().masses(design, event, study), "spring": belleville_mass(event, study)}

    def springs(self, event: LimitEvent, study: Any) -> dict[str, Expr]:
        """The Belleville stack."""
        return {"spring": belleville_stress(event, study)}

"""The thesis' new layout: a bending arm as the upper link, and a damper across it at the apex, from a rigid support."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Literal

from ..expressions.calculus import Expr, sin
from ..ports.linkage import Linkage, Member
from .base import TorqueLinks, from_lengths, reach_and_height, viscous
from .spatial import closed_loop

__all__ = ["Arreaza"]


class Arreaza(TorqueLinks):
    """One torque link; a bending arm in the plane of the strut, and a damper of length b across it at the apex."""

    VARIABLES: ClassVar = (TorqueLinks.ARM, *TorqueLinks.LENGTHS, TorqueLinks.SIDE)
    SPRING: ClassVar = "I_arm"
    MIRRORS: ClassVar = False  # in space the damper stands on one side; its stroke is odd to the fourth power of psi only

    topology: Literal["arreaza"]

    def planar(self, design: Mapping[str, Expr], E: Expr, stroke: Expr) -> tuple[Linkage, tuple[Expr, Expr]]:
        """Arm along the reach, damper across it; thesis (3-40) .. (3-45)."""
        I_arm, b, (ell, _) = design["I_arm"], design["b"], reach_and_height(design, stroke)

        def apex(psi: Expr) -> Expr:
            return ell * sin(psi)

        printed = 2 * E * I_arm / ell, viscous(design) * ell**2
        return from_lengths(3 * E * I_arm / ell**3, apex, apex, ell, ell, b), printed

    def spatial(self, design: Mapping[str, Expr], E: Expr, stroke: Expr) -> Linkage:
        """Arm from (0, 0, h), damper from (ell, -b, 0) on a rigid support; at rest it is perpendicular to the links."""
        L, b, (ell, _) = design["L"], design["b"], reach_and_height(design, stroke)
        return closed_loop(
            design,
            3 * E * design["I_arm"] / L**3,
            stroke=stroke,
            arm_length=L,
            damper_end=(ell, -b, 0),
            damper_length=b,
            spring_lever=ell,
            damper_lever=ell,
        )

    def members(self, design: Mapping[str, Expr], stroke: Expr = 0) -> tuple[Member, ...]:
        """Link, arm, damper, and the support that stands out by b from the upper hinge line."""
        L, b, (ell, h) = design["L"], design["b"], reach_and_height(design, stroke)
        apex, support = (ell, 0.0, 0.0), (ell, -b, 0.0)
        return (
            Member("lower torque link", "torque links", "link", (0.0, 0.0, -h), apex, "link_section", length=L),
            Member(
                "bending arm",
                "bending arm",
                "arm",
                (0.0, 0.0, h),
                apex,
                "arm_section",
                inertia=design["I_arm"],
                load="spring_force",
                length=L,
                bending_length=L if self.geometry == "spatial" else ell,
            ),
            # weighed as a cantilever of length b, which is less than what reaches from the hinge line to the damper
            Member(
                "rigid support",
                "support arm",
                "support",
                (0.0, -b, h),
                support,
                "support_section",
                load="damper_force",
                length=b,
            ),
            Member("damper", "", "damper", support, apex, load="damper_force"),
        )

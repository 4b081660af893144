"""UTAS' layout: a bending arm and the damper side by side, from the upper hinge line to the apex."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Literal

from ..expressions.calculus import Expr, sin, sqrt
from ..ports.linkage import Linkage, Member
from .base import TorqueLinks, from_lengths, reach_and_height, viscous
from .spatial import closed_loop

__all__ = ["Utas"]


class Utas(TorqueLinks):
    """One torque link; a bending arm rooted at y = b and a damper rooted at y = -b on the upper hinge line."""

    VARIABLES: ClassVar = (TorqueLinks.ARM, *TorqueLinks.LENGTHS, TorqueLinks.SIDE)
    SPRING: ClassVar = "I_arm"
    MIRRORS: ClassVar = False

    topology: Literal["utas"]

    def planar(self, design: Mapping[str, Expr], E: Expr, stroke: Expr) -> tuple[Linkage, tuple[Expr, Expr]]:
        """The arm's tip moves across it, the apex on the circle of radius ell; thesis (3-23) .. (3-30)."""
        # R length of arm and damper from the top, alpha the arm's angle at the apex
        c_lambda, I_arm, b = viscous(design), design["I_arm"], design["b"]
        ell, _ = reach_and_height(design, stroke)
        R = sqrt(ell**2 + b**2)
        sin_alpha = ell / R

        def arm_tip(psi: Expr) -> Expr:
            return ell * sin_alpha * sin(psi)

        def damper(psi: Expr) -> Expr:
            return -sqrt(ell**2 + b**2 - 2 * ell * b * sin(psi))

        printed = 2 * E * I_arm * ell * sin_alpha / R**2, c_lambda * ell**2 * b / (10 * R)
        return from_lengths(3 * E * I_arm / R**3, arm_tip, damper, ell, R, R), printed

    def spatial(self, design: Mapping[str, Expr], E: Expr, stroke: Expr) -> Linkage:
        """Arm from (0, b, h), damper from (0, -b, h), both to the apex."""
        L, b, (ell, h) = design["L"], design["b"], reach_and_height(design, stroke)
        l_arm = sqrt(L**2 + b**2)
        return closed_loop(
            design,
            3 * E * design["I_arm"] / l_arm**3,
            stroke=stroke,
            y_root=b,
            arm_length=l_arm,
            damper_end=(0, -b, h),
            damper_length=l_arm,
            spring_lever=ell * l_arm / L,
            damper_lever=2 * b * ell / l_arm,
        )

    def members(self, design: Mapping[str, Expr], stroke: Expr = 0) -> tuple[Member, ...]:
        """Link, arm and damper."""
        L, b, (ell, h) = design["L"], design["b"], reach_and_height(design, stroke)
        apex, true_length = (ell, 0.0, 0.0), sqrt(L**2 + b**2)
        bends_over = true_length if self.geometry == "spatial" else sqrt(ell**2 + b**2)
        return (
            Member("lower torque link", "torque links", "link", (0.0, 0.0, -h), apex, "link_section", length=L),
            Member(
                "bending arm",
                "bending arm",
                "arm",
                (0.0, b, h),
                apex,
                "arm_section",
                inertia=design["I_arm"],
                load="spring_force",
                length=true_length,
                bending_length=bends_over,
            ),
            Member("damper", "", "damper", (0.0, -b, h), apex, load="damper_force"),
        )

"""UTAS' layout: a bending arm and the damper side by side, from the upper hinge line to the apex.

Both hang on the hinge line, a beam of the arm's section that is held where it leaves the strut, at the distance a from its
ends (a = b where the strut has no width). Arm shear V and damper force S bend its halves by M_+(t) = V l_arm + q t and
M_-(t) = q t at the distance t from their ends, q = S L/l_arm: across the plane of arm and damper nothing but they acts on the
apex, so that the arm pushes as the damper pulls. The strain energy,

    2 E I U = V^2 l^2 (l/3 + a) + V q l a^2 + 2/3 q^2 a^3,    l = l_arm,

gives with S = 0 the deflection of the arm's tip, 1 + 3 a/l times that of a clamped arm, and the retreat of its root,
3 a^2/(2 l (l + 3 a)) of that, which takes stroke from the damper; and at its least over V (the apex held) the stiffness along
the damper, 1/k = (L/l)^2 a^3/(E I) (2/3 - 3 a/(4 (l + 3 a))).

V also pushes the arm with V b/L and pulls the half beside it with V l/L: over the deflection V/k the arm is shorter by
m = k l b/(L E A), and its root moves aside by n = k l a/(L E A). For small motions that is a spring softer by 1 + (m b + n l)/L
and a retreat of the root by another (m l + n b)/L.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar, Literal

from ..expressions.calculus import Expr, sin, sqrt
from ..ports.linkage import Compliant, Linkage, Member
from ..strength.sections import area, shape_numbers
from .base import TorqueLinks, from_lengths, reach_and_height, viscous
from .spatial import closed_loop

__all__ = ["Utas"]


class Utas(TorqueLinks):
    """One torque link; a bending arm rooted at y = b and a damper rooted at y = -b on the upper hinge line."""

    VARIABLES: ClassVar = (TorqueLinks.ARM, *TorqueLinks.LENGTHS, TorqueLinks.SIDE)
    SPRING: ClassVar = "I_arm"
    ELASTIC: ClassVar = ("link", "arm")
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
        return from_lengths(3 * E * I_arm / R**3 / self._softer(b, R), arm_tip, damper, ell, R, R), printed

    def linkage_of(self, study: Any, design: Mapping[str, Expr], stroke: Expr = 0) -> Linkage:
        """With the arm as short as its shear pushes it, V b/L over E A/l."""
        E = study.material.youngs_modulus
        if self.geometry != "spatial" or not self.is_sized("arm"):
            return self.linkage(design, E, stroke)
        kappa_area, _ = shape_numbers(study.mass.arm_section)
        return self.spatial(design, E, stroke, sqrt(design["I_arm"]) / kappa_area)

    def spatial(self, design: Mapping[str, Expr], E: Expr, stroke: Expr, gyration: Expr = None) -> Linkage:
        """Arm from (0, b, h), damper from (0, -b, h), both to the apex; an arm without its I/A [m^2] keeps its length."""
        L, b, (ell, h) = design["L"], design["b"], reach_and_height(design, stroke)
        l_arm = sqrt(L**2 + b**2)
        a = self.links.overhang(b)
        retreat = 3 * a**2 / (2 * l_arm * (l_arm + 3 * a)) if self.is_sized("arm") else 0
        stiffness = 3 * E * design["I_arm"] / l_arm**3 / self._softer(b, l_arm)
        if gyration is not None:
            shorter, aside = (3 * gyration * over / (L * l_arm**2 * self._softer(b, l_arm)) for over in (b, a))
            retreat = retreat + (shorter * l_arm + aside * b) / L
            stiffness = stiffness / (1 + (shorter * b + aside * l_arm) / L)
        return closed_loop(
            design,
            stiffness,
            stroke=stroke,
            y_root=b,
            root_retreat=retreat,
            arm_length=l_arm,
            damper_end=(0, -b, h),
            damper_length=l_arm,
            spring_lever=ell * l_arm / L,
            damper_lever=ell * (2 * b / l_arm - retreat),
        )

    def _softer(self, b: Expr, l_arm: Expr) -> Expr:
        """Deflection of the tip over that of an arm clamped at its root."""
        return 1 + 3 * self.links.overhang(b) / l_arm if self.is_sized("arm") else 1

    def elastic(self, design: Mapping[str, Expr], study: Any, stroke: Expr = 0) -> tuple[Compliant, ...]:
        """Along the damper: the arm in compression, and both halves of the hinge line."""
        links = super().elastic(design, study, stroke)
        if not self.is_sized("arm"):
            return links
        E, I_arm, L, b = study.material.youngs_modulus, design["I_arm"], design["L"], design["b"]
        l_arm, a = sqrt(L**2 + b**2), self.links.overhang(b)
        arm = Compliant("arm", E * area(study.mass.arm_section, I_arm) / l_arm)
        halves = E * I_arm / a**3 * (l_arm / L) ** 2 / (2 / 3 - 3 * a / (4 * (l_arm + 3 * a)))
        return (*links, arm, Compliant("arm", halves))

    def members(self, design: Mapping[str, Expr], stroke: Expr = 0) -> tuple[Member, ...]:
        """Link, arm and damper."""
        L, b, (ell, h) = design["L"], design["b"], reach_and_height(design, stroke)
        apex, true_length = (ell, 0.0, 0.0), sqrt(L**2 + b**2)
        bends_over = true_length if self.geometry == "spatial" else sqrt(ell**2 + b**2)
        arm = Member(
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
            thrust=b / L if self.is_sized("arm") else 0,
        )
        damper = Member("damper", "", "damper", (0.0, -b, h), apex, load="damper_force")
        links = self.link_members("lower torque link", design, -h, apex)
        if not self.is_sized("arm"):
            return (*links, arm, damper)
        ends: dict[str, Any] = {"start": (0.0, -b, h), "end": (0.0, b, h), "length": 2 * self.links.overhang(b)}
        beam = replace(arm, name="hinge line", part="hinge line", kind="beam", thrust=true_length / L, **ends)
        return (*links, arm, beam, damper)

"""The thesis' new layout: a bending arm as the upper link, and a damper across it at the apex, from a rigid support."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Literal

from ..expressions.calculus import Expr, sin, sqrt
from ..ports.linkage import Compliant, Linkage, Member, Point
from ..quantities.named import DesignVariable
from ..strength.sections import area
from .base import TorqueLinks, from_lengths, hinge_beam, reach_and_height, viscous
from .elastic import TAPERED_MASS, hinge_beam_stiffness, in_series, leg_length, tapered_stiffness, two_legs_stiffness
from .spatial import closed_loop

__all__ = ["Arreaza"]


class Arreaza(TorqueLinks):
    """One torque link; a bending arm in the plane of the strut, and a damper of length b across it at the apex."""

    VARIABLES: ClassVar = (TorqueLinks.ARM, *TorqueLinks.LENGTHS, TorqueLinks.SIDE)
    SPRING: ClassVar = "I_arm"
    A_SUPPORT: ClassVar = DesignVariable("A_support", "m^2", "$A_{sup}$", "area of each leg of the support", example="200 mm^2")
    I_SUPPORT: ClassVar = DesignVariable(
        "I_support", "m^4", "$I_{sup}$", "second moment of area at the root of the support", example="1e-6 m^4"
    )
    I_FOOT: ClassVar = DesignVariable(
        "I_foot", "m^4", "$I_{foot}$", "second moment of area of the beam between the feet of the support", example="4e-7 m^4"
    )
    ELASTIC: ClassVar = ("link", "support")
    SIZES: ClassVar = (*TorqueLinks.SIZES, A_SUPPORT, I_SUPPORT, I_FOOT)
    MIRRORS: ClassVar = False  # in space the damper stands on one side; its stroke is odd to the fourth power of psi only

    topology: Literal["arreaza"]

    def sizes(self) -> tuple[DesignVariable, ...]:
        """Of the torque link and of the support, and of the beams that they stand on."""
        if not self.is_sized("support"):
            return super().sizes()
        own = (self.A_SUPPORT, self.I_FOOT) if self.support.form == "a_frame" else (self.I_SUPPORT,)
        return (*super().sizes(), *own)

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

    def elastic(self, design: Mapping[str, Expr], study: Any, stroke: Expr = 0) -> tuple[Compliant, ...]:
        """The torque link, and the support along the damper."""
        links = super().elastic(design, study, stroke)
        if not self.is_sized("support"):
            return links
        E, L, b, (ell, _) = study.material.youngs_modulus, design["L"], design["b"], reach_and_height(design, stroke)
        if self.support.form == "a_frame":
            width = self.links.width(L)
            legs = leg_length(L, b + width / 2), leg_length(L, b - width / 2)
            I_foot = design["I_foot"]
            lengths = L, width, self.links.overhang(width / 2)
            beam = hinge_beam_stiffness(E, I_foot, area(study.mass.hinge_section, I_foot), *lengths, b)
            stiffness = in_series((two_legs_stiffness(E, design["A_support"], legs, width), beam))
        elif self.support.root == "hinge_line":  # its root hangs on a beam out to b, which it bends and pulls
            I_root = design["I_support"]
            beam = E / self.links.overhang(b) / (L**2 / I_root + 1 / area(study.mass.support_section, I_root))
            stiffness = in_series((tapered_stiffness(E, I_root, L), beam))
        else:  # the force along y has the lever ell; it bends an arm of length R
            R = sqrt(ell**2 + b**2)
            stiffness = tapered_stiffness(E, design["I_support"], R) * (R / ell) ** 2
        return (*links, Compliant("support", stiffness))

    def members(self, design: Mapping[str, Expr], stroke: Expr = 0) -> tuple[Member, ...]:
        """Link, arm, damper, and the support from the upper hinge line."""
        L, b, (ell, h) = design["L"], design["b"], reach_and_height(design, stroke)
        apex, held = (ell, 0.0, 0.0), (ell, -b, 0.0)
        arm = Member(
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
        )
        return (
            *self.link_members("lower torque link", design, -h, apex),
            arm,
            *self._support(design, held, ell, h),
            Member("damper", "", "damper", held, apex, load="damper_force"),
        )

    def _support(self, design: Mapping[str, Expr], end: Point, ell: Expr, h: Expr) -> tuple[Member, ...]:
        L, b = design["L"], design["b"]
        rest: dict[str, Any] = {"part": "support", "kind": "support", "end": end}
        rest |= {"section": "support_section", "load": "damper_force"}
        if not self.is_sized("support"):
            # weighed as a cantilever of length b, which is less than what reaches from the hinge line to the damper
            return (Member("rigid support", start=(0.0, -b, h), length=b, **{**rest, "part": "support arm"}),)
        if self.support.form == "cantilever":
            on_strut = self.support.root == "strut"
            length, lever = (sqrt(ell**2 + b**2), ell) if on_strut else (L, L)
            start = (0.0, 0.0, 0.0) if on_strut else (0.0, -b, h)
            root: dict[str, Any] = {"inertia": design["I_support"], "taper": TAPERED_MASS, "variable": "I_support"}
            arm = Member("support", start=start, length=length, bending_length=lever, **root, **rest)
            if on_strut:
                return (arm,)
            beam: dict[str, Any] = {**rest, "end": start, "inertia": design["I_support"], "variable": "I_support"}
            beam |= {"length": self.links.overhang(b), "bending_length": L, "thrust": 1}
            return (Member("support, hinge line", start=(0.0, 0.0, h), **beam), arm)
        width = self.links.width(L)
        members = []
        for name, foot in (("far", width / 2), ("near", -width / 2)):  # from the damper's end; the far one is the longer
            leg = leg_length(L, b + foot)
            more: dict[str, Any] = {"area": design["A_support"], "share": leg / width, "length": leg, "variable": "A_support"}
            members.append(Member(f"support, {name} leg", start=(0.0, foot, h), **more, **rest))
        lengths, of_foot = (L, width, self.links.overhang(width / 2)), {"kind": "foot", "load": "damper_force"}
        beneath = hinge_beam("hinge of the support", "support hinge", h, design["I_foot"], "I_foot", lengths, b, **of_foot)
        return (*members, beneath)

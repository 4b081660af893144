"""What every layout is: an angle becomes a deflection and a stroke, and members carry what acts along them.

Every layout is a pair of lengths that depend on the yaw angle psi: the deflection eps(psi) of the spring or arm tip, and
the stroke s(psi) of the damper. With a spring of stiffness k_eps and a damper force F(s'), virtual work gives

    torque = -k_eps eps(psi) eps'(psi) - F(s'(psi) psi') s'(psi).

Geometry `planar` is the linkage seen from the top: eps is that of an apex moving purely sideways by ell sin(psi), with
ell = L sin(gamma). Geometry `spatial` is the linkage itself, see `spatial`. Geometry `published` keeps the planar levers at
rest for strokes and stresses, but takes stiffness and damping as printed in the thesis, known errors included; see the errata
in the documentation.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, ClassVar, Literal

from ..errors import ConfigError
from ..expressions.calculus import Expr, cos, sin, slope, sqrt, symbol, value_at
from ..ports.linkage import Compliant, Linkage, Member, Point, Position
from ..ports.sizing import LimitEvent
from ..quantities.named import DesignVariable
from ..quantities.record import Record
from ..strength.members import member_mass
from ..strength.sections import area
from .elastic import (
    TAPERED_MASS,
    LinkForm,
    SupportForm,
    hinge_beam_stiffness,
    in_series,
    leg_length,
    tapered_stiffness,
    two_legs_stiffness,
)

__all__ = ["Layout", "TorqueLinks", "from_lengths", "hinge_beam", "reach_and_height", "straight", "viscous"]


class Layout(Record):
    """Layout of a shimmy damper: where spring, arm and damper act on the gear.

    A layout is a file of its own with a class derived from this one, a literal `topology`, its `VARIABLES`, and the methods
    `linkage` and `members`. In a study its keys stand in the block `damper` beside those of the damper.
    """

    GROUP: ClassVar[str] = "damperopt.linkages"
    VARIABLES: ClassVar[tuple[DesignVariable, ...]] = ()
    """Numbers of the layout that the optimiser may choose, beside those of the damper."""
    ROTARY: ClassVar[bool] = False
    """Whether dampers act about the yaw axis itself."""
    DAMPER: ClassVar[str] = "hydraulic"
    """Kind of the damper where a study names none."""
    SPRING: ClassVar[str | None] = None
    """Design variable that makes it stiff, for the axes of charts."""
    MIRRORS: ClassVar[bool] = True
    """Whether a mirrored motion is a motion too."""
    ELASTIC: ClassVar[tuple[str, ...]] = ()
    """Keys of the block ``compliance`` that this layout knows a section for."""
    SIZES: ClassVar[tuple[DesignVariable, ...]] = ()
    """Sizes of elastic parts that may be chosen beside `VARIABLES`; which of them, `sizes` says."""

    topology: str
    geometry: Literal["published", "planar", "spatial"] = "spatial"
    """How lengths follow from the yaw angle: as printed in the thesis, from the top, or in space."""

    def linkage(self, design: Mapping[str, Expr], youngs_modulus: Expr, stroke: Expr = 0) -> Linkage:
        """Lengths and levers.

        Parameters
        ----------
        design : mapping of str to Expr
            Design variables by name [SI].
        youngs_modulus : Expr
            E of the bending arm [Pa].
        stroke : Expr
            Of the shock strut [m]: it brings the lugs together by as much.
        """
        raise NotImplementedError  # every layout says it

    def linkage_of(self, study: Any, design: Mapping[str, Expr], stroke: Expr = 0) -> Linkage:
        """The linkage of a study, for layouts whose levers hang on sections too.

        Parameters
        ----------
        study : Study
            Floats or symbols: material, mass model.
        design : mapping of str to Expr
            Design variables by name [SI].
        stroke : Expr
            Of the shock strut [m].
        """
        return self.linkage(design, study.material.youngs_modulus, stroke)

    def members(self, design: Mapping[str, Expr], stroke: Expr = 0) -> tuple[Member, ...]:
        """Members at rest: one list to draw, to weigh and to check.

        Parameters
        ----------
        design : mapping of str to Expr
            Design variables by name [SI].
        stroke : Expr
            Of the shock strut [m].
        """
        return ()

    def sizes(self) -> tuple[DesignVariable, ...]:
        """Those of `SIZES` that this layout has: of parts whose stiffness comes from their section."""
        return ()

    def elastic(self, design: Mapping[str, Expr], study: Any, stroke: Expr = 0) -> tuple[Compliant, ...]:
        """Parts that give way, beside spring or arm.

        Parameters
        ----------
        design : mapping of str to Expr
            Design variables by name [SI].
        study : Study
            Floats or symbols: material, mass model.
        stroke : Expr
            Of the shock strut [m].
        """
        return ()

    def is_sized(self, part: str) -> bool:
        """Whether the stiffness of a part of the chain comes from its section; the study's compliance says it."""
        return False

    def masses(self, design: Mapping[str, Expr], event: LimitEvent, study: Any) -> dict[str, Expr]:
        """Mass of the layout by part, without the damper [kg].

        Parameters
        ----------
        design : mapping of str to Expr
            Design variables by name [SI].
        event : LimitEvent
        study : Study
            Floats or symbols: material, mass model, requirements.
        """
        parts: dict[str, Expr] = {}
        for member in self.members(design):
            if member.part:
                mass = member_mass(member, event, study)
                parts[member.part] = parts[member.part] + mass if member.part in parts else mass
        return parts

    def springs(self, event: LimitEvent, study: Any) -> dict[str, Expr]:
        """Stress of springs that are sized by the energy of the limit event, at that event, by part [Pa].

        Parameters
        ----------
        event : LimitEvent
        study : Study
            Floats or symbols; they are of the material of the damper.
        """
        return {}


class TorqueLinks(Layout):
    """Layouts with two lugs at the strut, 2 L cos(gamma) apart, and an apex at L sin(gamma) from its axis."""

    LINKS: ClassVar = 1
    """Torque links between gear and spring."""
    LENGTHS: ClassVar = (
        DesignVariable("L", "m", "$L$", "length of a torque link", example="0.6 m"),
        DesignVariable(
            "gamma", "rad", r"$\gamma$", "angle of a torque link to the strut axis", False, below=1.5707963, example="31 deg"
        ),
    )
    A_LINK: ClassVar = DesignVariable("A_link", "m^2", "$A_{link}$", "area of each leg of a torque link", example="250 mm^2")
    I_LINK: ClassVar = DesignVariable(
        "I_link", "m^4", "$I_{link}$", "second moment of area at the root of a torque link", example="1e-6 m^4"
    )
    I_HINGE: ClassVar = DesignVariable(
        "I_hinge",
        "m^4",
        "$I_{hinge}$",
        "second moment of area of the beam between the feet of a torque link",
        example="4e-7 m^4",
    )
    ELASTIC: ClassVar[tuple[str, ...]] = ("link",)
    SIZES: ClassVar[tuple[DesignVariable, ...]] = (A_LINK, I_LINK, I_HINGE)
    SIDE: ClassVar = DesignVariable("b", "m", "$b$", "side distance of arm or damper root from the axis", example="0.2 m")
    ARM: ClassVar = DesignVariable("I_arm", "m^4", "$I_{arm}$", "second moment of area of the arm", example="3.4e-6 m^4")

    links: LinkForm = LinkForm()
    """Form of the torque links."""
    support: SupportForm = SupportForm()
    """Form of what holds the outer end of the damper, in layouts that have such a part."""

    def sizes(self) -> tuple[DesignVariable, ...]:
        """Of the torque links, and of the beams that their feet stand on."""
        if not self.is_sized("link"):
            return ()
        return (self.A_LINK, self.I_HINGE) if self.links.form == "a_frame" else (self.I_LINK,)

    def elastic(self, design: Mapping[str, Expr], study: Any, stroke: Expr = 0) -> tuple[Compliant, ...]:
        """Every torque link of the layout, laterally at the apex."""
        if not self.is_sized("link"):
            return ()
        E, L = study.material.youngs_modulus, design["L"]
        if self.links.form == "cantilever":
            stiffness = tapered_stiffness(E, design["I_link"], L)
        else:
            width, I_hinge = self.links.width(L), design["I_hinge"]
            leg = leg_length(L, width / 2)
            legs = two_legs_stiffness(E, design["A_link"], (leg, leg), width)
            overhang = self.links.overhang(width / 2)
            beam = hinge_beam_stiffness(E, I_hinge, area(study.mass.hinge_section, I_hinge), L, width, overhang)
            stiffness = in_series((legs, beam))
        return tuple(Compliant("link", stiffness, in_front=True) for _ in range(self.LINKS))

    def link_members(self, name: str, design: Mapping[str, Expr], hinge: Expr, apex: Point) -> tuple[Member, ...]:
        """Members of the torque link from a hinge at this height [m] to the apex."""
        L, part = design["L"], "torque links"
        if not self.is_sized("link"):
            return (Member(name, part, "link", (0.0, 0.0, hinge), apex, "link_section", length=L),)
        if self.links.form == "cantilever":
            root = {"inertia": design["I_link"], "taper": TAPERED_MASS, "variable": "I_link"}
            return (Member(name, part, "link", (0.0, 0.0, hinge), apex, "link_section", length=L, **root),)
        width = self.links.width(L)
        leg = leg_length(L, width / 2)
        more = {"area": design["A_link"], "share": leg / width, "length": leg, "variable": "A_link"}
        feet = {"left": -width / 2, "right": width / 2}
        legs = tuple(
            Member(f"{name}, {side} leg", part, "link", (0.0, y, hinge), apex, "link_section", **more)
            for side, y in feet.items()
        )
        lengths = L, width, self.links.overhang(width / 2)
        return (*legs, hinge_beam(f"hinge of the {name}", "link hinges", hinge, design["I_hinge"], "I_hinge", lengths))

    def leaves_out(self) -> tuple[str, ...]:
        """What holds the hinges."""
        return ("give of the strut and of lugs where hinges and roots are held",) if self.is_sized("link") else ()

    def linkage(self, design: Mapping[str, Expr], youngs_modulus: Expr, stroke: Expr = 0) -> Linkage:
        """By the level of the geometry."""
        if self.geometry == "spatial":
            return self.spatial(design, youngs_modulus, stroke)
        if self.geometry == "published" and "c_lambda" not in design:
            raise ConfigError("damper.geometry: 'published' is of a viscous damper; allowed: planar, spatial for this kind")
        planar, (k_psi, c_psi) = self.planar(design, youngs_modulus, stroke)
        if self.geometry == "planar":
            return planar
        spring, lever = planar.spring_lever, planar.damper_lever
        lengths = planar.reach, planar.arm_length, planar.damper_length
        return straight(k_psi / spring**2, spring, lever, *lengths, as_printed={"c_lambda": c_psi / lever**2})

    def planar(self, design: Mapping[str, Expr], E: Expr, stroke: Expr) -> tuple[Linkage, tuple[Expr, Expr]]:
        """The linkage from the top, and k_psi [N m/rad] and c_psi [N m s/rad] as printed in the thesis."""
        raise NotImplementedError  # every layout says it

    def spatial(self, design: Mapping[str, Expr], E: Expr, stroke: Expr) -> Linkage:
        """The linkage in space."""
        raise NotImplementedError  # every layout says it


def hinge_beam(
    name: str,
    part: str,
    height: Expr,
    inertia: Expr,
    variable: str,
    lengths: tuple[Expr, Expr, Expr],
    across: Expr = 0,
    **more: Any,
) -> Member:
    """Beam between the feet of two legs, as `hinge_beam_stiffness` has it; what is inside the strut is no part of it.

    Parameters
    ----------
    name, part, variable : str
        As of a `Member`.
    height : Expr
        Of the hinge line [m].
    inertia : Expr
        [m^4]
    lengths : tuple of Expr
        L, width, overhang, as of `hinge_beam_stiffness` [m].
    across : Expr
        [m]
    more : Any
        Of the `Member`, such as its load.
    """
    L, width, overhang = lengths
    start, end = (0.0, -width / 2, height), (0.0, width / 2, height)
    own: dict[str, Any] = {"kind": "hinge", "section": "hinge_section", "inertia": inertia, "variable": variable}
    forces = {"length": 2 * overhang, "bending_length": L * overhang / width, "thrust": across / width + 1 / 2}
    return Member(name, part, start=start, end=end, **{**own, **forces, **more})


def reach_and_height(design: Mapping[str, Expr], stroke: Expr = 0) -> tuple[Expr, Expr]:
    """Reach of the apex, L sin(gamma), and half the lug distance, L cos(gamma) less half the stroke of the strut [m]."""
    L, gamma = design["L"], design["gamma"]
    if isinstance(stroke, (int, float)) and stroke == 0:
        return L * sin(gamma), L * cos(gamma)
    height = L * cos(gamma) - stroke / 2
    return sqrt(L**2 - height**2), height


def viscous(design: Mapping[str, Expr]) -> Expr:
    """c_lambda of a viscous damper, for formulas as printed [N s/m]; 0 for kinds that have another number."""
    return design.get("c_lambda", 0)


def straight(stiffness: Expr, spring_lever: Expr, damper_lever: Expr, *lengths: Expr, **more: Any) -> Linkage:
    """Linkage with constant levers; `lengths` are reach, arm and damper."""

    def at(psi: Expr) -> Position:
        return Position(spring_lever * psi, spring_lever, damper_lever * psi, damper_lever)

    return Linkage(stiffness, at, spring_lever, damper_lever, *lengths, **more)


def from_lengths(stiffness: Expr, eps: Callable[[Expr], Expr], s: Callable[[Expr], Expr], *lengths: Expr) -> Linkage:
    """Linkage of two lengths eps(psi), s(psi), with levers as their derivatives; `lengths` are reach, arm and damper."""
    psi = symbol("psi")
    expressions: Sequence[Expr] = [eps(psi), slope(eps, psi), s(psi) - s(0), slope(s, psi)]

    def at(angle: Expr) -> Position:
        return Position(*(value_at(expression, psi, angle) for expression in expressions))

    rest = at(0)
    return Linkage(stiffness, at, rest.spring_lever, rest.damper_lever, *lengths)

"""Stiffness of the parts between the gear and the damper, from the sections that they have.

In series: the strut in torsion, the lower torque link, in Boeing's layout the upper one; then spring or bending arm with the
damper beside it, and in series with the damper what holds it. A node between massless parts carries no inertia, so that the
chain has one state of its own, the dashpot's stroke.

Two legs of length l1, l2 from a hinge of width w carry a force across the apex by tension and compression N_i = F l_i/w, hence

    1/k = (l1^3 + l2^3)/(E A w^2).

Their feet pull and push the ends of the beam of the hinge line with F L/w. It is held where it leaves the strut, a from its
ends (w/2 where the strut has no width), bends there under F L a/w, and the apex moves by 2 F L^2 a^3/(3 E I w^2) more. Across,
the feet load its ends along themselves.

A cantilever of uniform stress in similar sections has the tip stiffness (5/3) E I_root/L^3 and weighs 3/5 of a prismatic one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Annotated, Any, Literal, Self

from pydantic import Discriminator, GetJsonSchemaHandler, Tag, model_validator
from pydantic_core import CoreSchema

from ..expressions.calculus import Expr, arsinh, exp, sqrt
from ..ports.linkage import Compliant, Linkage
from ..quantities.record import Length, Record, SeriesStiffness, TorsionalStiffness, refuse

__all__ = [
    "TAPERED_MASS",
    "Compliance",
    "LinkForm",
    "SupportForm",
    "elastic_linkage",
    "hinge_beam_stiffness",
    "in_series",
    "leg_length",
    "tapered_stiffness",
    "two_legs_stiffness",
]

TAPERED_MASS = 3 / 5
"""Mass of a cantilever of uniform stress in similar sections over that of the prismatic one with its root section."""


LEAST_OVERHANG = 0.003
"""Of a hinge as wide as the strut [m]; a wider one gains less than that."""

WORDS = ("sized", "rigid")
"""That stand for every part."""


def _word_or_number(found: Any) -> str:
    return "<word>" if isinstance(found, str) and found.strip().isalpha() else "<number>"


_Part = Annotated[
    Annotated[SeriesStiffness, Tag("<number>")] | Annotated[Literal["sized", "rigid"], Tag("<word>")],
    Discriminator(_word_or_number),
]
_Torsion = Annotated[
    Annotated[TorsionalStiffness, Tag("<number>")] | Annotated[Literal["rigid"], Tag("<word>")], Discriminator(_word_or_number)
]


class Compliance(Record):
    """What gives way between the gear and the damper: from the section that a part has, a number, or nothing.

    A part of given stiffness, and a rigid one, is sized by its strength alone, as a cantilever of uniform stress.
    """

    torsion: _Torsion = "rigid"
    """Of piston and cylinder in torsion, in front of the linkage [N m/rad]; a word says that no number is known."""
    link: _Part = "sized"
    """Of the torque links together, laterally at the apex [N/m]."""
    arm: _Part = "sized"
    """Of the bending arm along itself, and of the hinge line that its root hangs on, in series with the damper [N/m]."""
    support: _Part = "sized"
    """Of what holds the damper, along the damper [N/m]."""
    damper: _Part = "sized"
    """Of oil column and rod [N/m]."""

    @model_validator(mode="before")
    @classmethod
    def _one_word(cls, data: Any) -> Any:
        if data in WORDS:
            return dict.fromkeys(("link", "arm", "support", "damper"), data)
        return data

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"anyOf": [{"enum": list(WORDS)}, handler.resolve_ref_schema(handler(schema))]}

    def is_sized(self, part: str) -> bool:
        """Whether the stiffness of a part comes from its section."""
        return bool(getattr(self, part) == "sized")


class LinkForm(Record):
    """Form of the torque links."""

    form: Literal["a_frame", "cantilever"] = "a_frame"
    """Two legs from a hinge to the apex, or one tapered link that bends."""
    hinge_width: Length | None = None
    """Between the legs at the hinge [m]; left out: half the length of the link, the width of links that stand at 14 deg."""
    hinge_width_max: Length | None = None
    """Most that the strut has room for [m]."""
    strut_width: Length | None = None
    """Of the strut where it holds the beams of the hinge lines [m]; left out: they are held on its axis, on the safe side."""

    @model_validator(mode="after")
    def _fits(self) -> Self:
        width, most = self.hinge_width, self.hinge_width_max
        if width is not None and most is not None and isinstance(most, float) and width > most:
            raise refuse("hinge_width", f"{width:g} m is more than hinge_width_max", f"at most {most:g} m")
        return self

    def width(self, L: Expr) -> Expr:
        """w_h of a link of length L [m]."""
        return L / 2 if self.hinge_width is None else self.hinge_width

    def overhang(self, half: Expr) -> Expr:
        """Of a beam with its end `half` [m] from the axis, beside the strut, and never quite nothing [m].

        (x + sqrt(x^2 + 4 e^2))/2, smooth for the optimiser, with x beside the strut: of ln a bounds see that it is monotone.
        """
        if self.strut_width is None:
            return half
        wide = 2 * LEAST_OVERHANG
        return LEAST_OVERHANG * exp(arsinh(half / wide - self.strut_width / 2 / wide))


class SupportForm(Record):
    """Form of what holds the outer end of the damper."""

    form: Literal["a_frame", "cantilever"] = "a_frame"
    """Two legs from the upper hinge line, or one tapered arm that bends."""
    root: Literal["hinge_line", "strut"] = "hinge_line"
    """Of a cantilever: beside the arm on the upper hinge line, or on the strut at the height of the apex."""


def leg_length(L: Expr, across: Expr) -> Expr:
    """Length of a leg whose foot stands `across` [m] beside the foot of the perpendicular of length L [m]."""
    return sqrt(L**2 + across**2)


def two_legs_stiffness(E: Expr, area: Expr, legs: tuple[Expr, Expr], width: Expr) -> Expr:
    """Stiffness across the apex of two legs [N/m].

    Parameters
    ----------
    E, area : Expr
        Young's modulus [Pa], area of each leg [m^2].
    legs : tuple of Expr
        Their lengths [m].
    width : Expr
        Between their feet [m].

    Examples
    --------
    >>> l = leg_length(0.4781, 0.125)
    >>> round(two_legs_stiffness(207e9, 200e-6, (l, l), 0.25) / 1e7, 4)
    1.0721
    """
    return E * area * width**2 / (legs[0] ** 3 + legs[1] ** 3)


def hinge_beam_stiffness(E: Expr, inertia: Expr, area: Expr, L: Expr, width: Expr, overhang: Expr, across: Expr = 0) -> Expr:
    """Stiffness across the apex of two legs on the beam between their feet [N/m].

    Parameters
    ----------
    E, inertia, area : Expr
        Young's modulus [Pa], second moment [m^4] and area [m^2] of the beam.
    L : Expr
        Distance of the apex from the beam [m].
    width : Expr
        Between the feet [m].
    overhang : Expr
        Of the beam beside the strut, to each side [m].
    across : Expr
        Of the apex beside the middle of the beam [m].

    Examples
    --------
    >>> round(hinge_beam_stiffness(207e9, 4e-7, 1.3e-3, 0.56, 0.28, 0.14) / 1e6, 3)  # 12 E I/(L^2 w), and what is pushed
    11.282
    """
    bent, pushed = 2 * L**2 * overhang**3 / (3 * inertia * width**2), (2 * across**2 / width**2 + 1 / 2) * overhang / area
    return E / (bent + pushed)


def tapered_stiffness(E: Expr, inertia: Expr, L: Expr) -> Expr:
    """Tip stiffness of a cantilever of uniform stress in similar sections [N/m]; `inertia` at its root [m^4]."""
    return 5 / 3 * E * inertia / L**3


def in_series(stiffnesses: Sequence[Expr]) -> Expr:
    """Stiffness of parts in series; None: all of them are rigid."""
    if len(stiffnesses) <= 1:
        return stiffnesses[0] if stiffnesses else None
    return 1 / sum(1 / k for k in stiffnesses)


def elastic_linkage(study: Any, design: Mapping[str, Expr], stroke: Expr = 0, torsion: Expr = None) -> Linkage:
    """The linkage of a study with the compliance of its parts.

    Parameters
    ----------
    study : Study
        Floats or symbols.
    design : mapping of str to Expr
        Design variables by name [SI].
    stroke : Expr
        Of the shock strut [m].
    torsion : Expr or None
        Of piston and cylinder at this stroke [N m/rad], in the place of the study's; beside a rotary damper.

    Returns
    -------
    Linkage
    """
    damper = study.damper
    link = damper.linkage_of(study, design, stroke)
    if damper.ROTARY:
        stiffness = link.stiffness if torsion is None else torsion
        return replace(link, stiffness=stiffness, series=damper.series(design))
    parts = [part for part in damper.elastic(design, study, stroke) if damper.compliance.is_sized(part.part)]
    given, own = damper.given_compliance(), damper.series(design)
    given = given if torsion is None else {**given, "torsion": torsion}
    for name, value in given.items():
        if name == "torsion":
            parts.append(Compliant(name, value / link.reach**2, in_front=True))
        elif name != "damper" or own is None:
            parts.append(Compliant(name, value, in_front=name == "link"))
    if own is not None:
        parts.append(Compliant("damper", own))
    front, behind = ([part.stiffness for part in parts if part.in_front == which] for which in (True, False))
    return replace(link, links=in_series(front), series=in_series(behind))

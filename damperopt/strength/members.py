"""Mass and stress of the members of a layout: cantilevers sized by their load, bending arms, springs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from ..expressions.calculus import Expr, is_symbol, sqrt
from ..ports.linkage import Member, Point
from ..ports.sizing import LimitEvent, Size
from .materials import allowable_stress
from .sections import area, area_for_modulus, inertia_for_modulus, section_modulus, shape_numbers

__all__ = [
    "allowables",
    "belleville_mass",
    "distance",
    "least_sections",
    "member_mass",
    "member_sizes",
    "root_stress",
    "root_stress_of_force",
]

RELAXED = {
    "limit": ("requirements.limit_torque", "requirements.safety_factor"),
    "ultimate": ("requirements.limit_torque",),
    "buckling": ("requirements.limit_torque",),
}
"""What would relax each check of a section."""


def distance(start: Point, end: Point) -> Expr:
    """Distance between two points [m]."""
    squares = [(b - a) ** 2 for a, b in zip(start, end, strict=True) if is_symbol(a) or is_symbol(b) or a != b]
    return sqrt(sum(squares)) if squares else 0.0


def member_mass(member: Member, event: LimitEvent, study: Any) -> Expr:
    """Mass of a member with its fittings [kg].

    Parameters
    ----------
    member : Member
    event : LimitEvent
    study : Study
        Floats or symbols: material, mass model, safety factor.
    """
    model, rho = study.mass, study.material.density
    section, with_fittings = getattr(model, member.section), 1 + model.link_fittings_fraction
    length = distance(member.start, member.end) if member.length is None else member.length
    if member.area is not None:
        return rho * length * member.area * with_fittings
    if member.inertia is not None:
        return member.taper * rho * length * area(section, member.inertia) * with_fittings
    moment = getattr(event, member.load) * length
    allowable = allowable_stress(study.material, study.requirements.safety_factor)
    return model.cantilever_taper * rho * length * area_for_modulus(section, moment / allowable) * with_fittings


def allowables(material: Any, event: LimitEvent) -> dict[str, Expr]:
    """Stress at the limit load that each check allows [Pa]: yield at limit, rupture (of a laminate the strain) at ultimate."""
    found = {}
    if material.yield_strength is not None:
        found["limit"] = material.yield_strength / event.safety_factor
    if material.ultimate_strength is not None:
        found["ultimate"] = material.ultimate_strength / event.ultimate_factor
    if material.design_strain is not None:
        found["ultimate"] = material.youngs_modulus * material.design_strain / event.ultimate_factor
    return found


def least_sections(member: Member, event: LimitEvent, study: Any) -> dict[str, Expr]:
    """Least area of a leg [m^2], or second moment at the root of a cantilever [m^4], by what asks for it.

    Parameters
    ----------
    member : Member
        With an area or a second moment of area.
    event : LimitEvent
    study : Study

    Returns
    -------
    dict of str to Expr
        ``limit``, ``ultimate``, and for a leg ``buckling``: Euler's load of pinned ends at ultimate.
    """
    section, load = getattr(study.mass, member.section), getattr(event, member.load)
    allowed = allowables(study.material, event)
    if member.area is None:
        lever = distance(member.start, member.end) if member.bending_length is None else member.bending_length
        return {name: inertia_for_modulus(section, load * lever / stress) for name, stress in allowed.items()}
    force, length = load * member.share, distance(member.start, member.end) if member.length is None else member.length
    kappa_area, _ = shape_numbers(section)
    least: dict[str, Expr] = {name: force / stress for name, stress in allowed.items()}
    euler = event.ultimate_factor * force / (math.pi**2 * study.material.youngs_modulus)
    return least | {"buckling": kappa_area * length * sqrt(euler)}


def member_sizes(study: Any, design: Mapping[str, Any], event: LimitEvent) -> list[Size]:
    """Sections of members that are design variables, with the least that strength asks of each.

    Parameters
    ----------
    study : Study
    design : mapping of str to Expr
    event : LimitEvent

    Returns
    -------
    list of Size
        Named by their variables; members that share one are sized by the first of them.
    """
    declared = {variable.name: variable for variable in study.damper.variables()}
    found: dict[str, Size] = {}
    for member in study.damper.members(design):
        if member.variable and member.variable not in found:
            name, unit = member.variable, declared[member.variable].unit
            least = least_sections(member, event, study).items()
            limits = {f"{member.kind}_{check}": (value, RELAXED[check]) for check, value in least}
            found[name] = Size(name, unit, design[name], limits)
    return list(found.values())


def root_stress(member: Member, event: LimitEvent, study: Any) -> Expr:
    """Bending stress at the root of an arm at the limit event [Pa] (3 E eps h_f/R^2).

    Parameters
    ----------
    member : Member
        With a second moment of area.
    event : LimitEvent
    study : Study
    """
    return root_stress_of_force(member, getattr(event, member.load), study)


def root_stress_of_force(member: Member, force: Expr, study: Any) -> Expr:
    """The same for a force at its tip [N]."""
    lever = distance(member.start, member.end) if member.bending_length is None else member.bending_length
    return force * lever / section_modulus(getattr(study.mass, member.section), member.inertia)


def belleville_mass(event: LimitEvent, study: Any) -> Expr:
    """Mass of a Belleville stack [kg]: energy over eta sigma^2/(2 E) per volume."""
    steel = study.mass.damper_material
    sigma = allowable_stress(steel, study.requirements.safety_factor)
    return steel.density * event.spring_energy / (study.mass.spring_utilisation * sigma**2 / (2 * steel.youngs_modulus))

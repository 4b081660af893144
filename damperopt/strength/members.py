"""Mass and stress of the members of a layout: cantilevers sized by their load, bending arms, springs."""

from __future__ import annotations

from typing import Any

from ..expressions.calculus import Expr, is_symbol, sqrt
from ..ports.linkage import Member, Point
from ..ports.sizing import LimitEvent
from .materials import allowable_stress
from .sections import area, area_for_modulus, section_modulus

__all__ = ["belleville_mass", "distance", "member_mass", "root_stress", "root_stress_of_force"]


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
    if member.inertia is not None:
        return rho * length * area(section, member.inertia) * with_fittings
    moment = getattr(event, member.load) * length
    allowable = allowable_stress(study.material, study.requirements.safety_factor)
    return model.cantilever_taper * rho * length * area_for_modulus(section, moment / allowable) * with_fittings


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

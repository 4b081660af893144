"""Mass and stress of the members of a layout: cantilevers sized by their load, bending arms, springs."""

from __future__ import annotations

import math
from typing import Any

from ..expressions.calculus import Expr, is_symbol, sqrt, where
from ..ports.linkage import Member, Point
from ..ports.sizing import LimitEvent
from .buckling import least_lateral_inertia, local_buckling_stress, weak_axis
from .fatigue import Basquin, FlightStresses, life_damage
from .materials import allowable_stress, ultimate_stress
from .sections import area, area_for_modulus, section_modulus, shape_numbers

__all__ = [
    "allowables",
    "belleville_mass",
    "belleville_stress",
    "distance",
    "fatigue_ratio",
    "least_sections",
    "member_mass",
    "root_stress",
    "root_stress_of_force",
]


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
    allowable = allowable_stress(study.material, event.safety_factor, event.ultimate_factor)
    return model.cantilever_taper * rho * length * area_for_modulus(section, moment / allowable) * with_fittings


def allowables(material: Any, event: LimitEvent, section: Any = None, load: Any = "bending") -> dict[str, Expr]:
    """Stress at the limit load that each check allows [Pa].

    Yield at limit, rupture (of a laminate the strain) at ultimate, and of a section with thin parts their buckling at ultimate.

    Parameters
    ----------
    material : Material
    event : LimitEvent
    section : Section or None
    load : str
        ``axial`` or ``bending``.
    """
    found = {"ultimate": ultimate_stress(material) / event.ultimate_factor}
    if material.yield_strength is not None:
        found = {"limit": material.yield_strength / event.safety_factor, **found}
    thin = None if section is None else local_buckling_stress(section, material, load)
    return found if thin is None else found | {"wall": thin / event.ultimate_factor}


def fatigue_ratio(member: Member, stress: Expr, event: LimitEvent, study: Any) -> Expr:
    """Stresses of a life over those whose damage, scatter factor included, is 1; None without data or spectrum.

    Parameters
    ----------
    member : Member
        What the damper loads feels the transients of landing alone.
    stress : Expr
        At the limit load [Pa].
    event : LimitEvent
    study : Study
    """
    law = Basquin.of(study.material)
    if law is None or event.flight is None:
        return None
    shares = event.flight
    turn, tow = (0.0, 0.0) if member.load == "damper_force" else (shares.turn * stress, shares.tow * stress)
    return _life_ratio(FlightStresses(turn, tow, shares.landing * stress, shares.decay), study, law)


def _life_ratio(stresses: FlightStresses, study: Any, law: Basquin) -> Expr:
    return life_damage(stresses, study.requirements.fatigue.spectrum, law) ** -law.exponent


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
        ``limit``, ``ultimate``, ``wall``, ``lateral``, ``fatigue``, and for a leg ``buckling``: as a column with pinned ends at
        ultimate load, about its weak axis.
    """
    section, load = getattr(study.mass, member.section), getattr(event, member.load)
    allowed = allowables(study.material, event, section, "bending" if member.area is None else "axial")
    if member.area is None:
        lever = distance(member.start, member.end) if member.bending_length is None else member.bending_length
        stress = root_stress_of_force(member, load, study)
        found = {name: member.inertia * (stress / most) ** (4 / 3) for name, most in allowed.items()}
        tipped = least_lateral_inertia(section, study.material, event.ultimate_factor * load * lever, lever)
        found |= {} if tipped is None else {"lateral": tipped}
        ratio = fatigue_ratio(member, stress, event, study)
        return found if ratio is None else found | {"fatigue": member.inertia * ratio ** (4 / 3)}
    force, length = load * member.share, distance(member.start, member.end) if member.length is None else member.length
    kappa_area, _ = shape_numbers(section)
    least: dict[str, Expr] = {name: force / stress for name, stress in allowed.items()}
    # in the stress of Euler's load, c A: columns that are short yield first (Johnson), tangent to Euler's at half the yield
    F, c = event.ultimate_factor * force, math.pi**2 * study.material.youngs_modulus / (kappa_area * length) ** 2
    c = c * weak_axis(section)
    yields = ultimate_stress(study.material) if study.material.yield_strength is None else study.material.yield_strength
    euler = sqrt(F / c)
    column = where(c * euler < yields / 2, euler, F / yields + yields / (4 * c))
    ratio = fatigue_ratio(member, force / member.area, event, study)
    if ratio is not None:
        least["fatigue"] = member.area * ratio
    return least | {"buckling": column}


def root_stress(member: Member, event: LimitEvent, study: Any) -> Expr:
    """Largest stress at the root of a member that bends, and is pushed, at the limit event [Pa] (3 E eps h_f/R^2 of an arm).

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
    section = getattr(study.mass, member.section)
    bending = force * lever / section_modulus(section, member.inertia)
    if isinstance(member.thrust, (int, float)) and member.thrust == 0:
        return bending
    return bending + force * member.thrust / area(section, member.inertia)


def belleville_stress(event: LimitEvent, study: Any) -> Expr:
    """Stress that a Belleville stack is sized for at the limit event [Pa]: yield, rupture, or the spectrum of flights."""
    steel, shares = study.mass.damper_material, event.flight
    sigma, law = allowable_stress(steel, event.safety_factor, event.ultimate_factor), Basquin.of(steel)
    if law is None or shares is None:
        return sigma
    turn, tow, landing = (share * sigma for share in (shares.turn, shares.tow, shares.landing))
    ratio = _life_ratio(FlightStresses(turn, tow, landing, shares.decay), study, law)
    return where(ratio > 1, sigma / ratio, sigma)


def belleville_mass(event: LimitEvent, study: Any) -> Expr:
    """Mass of a Belleville stack [kg]: energy over eta sigma^2/(2 E) per volume."""
    steel, sigma = study.mass.damper_material, belleville_stress(event, study)
    return steel.density * event.spring_energy / (study.mass.spring_utilisation * sigma**2 / (2 * steel.youngs_modulus))

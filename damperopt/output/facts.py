"""What a design review asks beside the answer: loads and sizes of the parts, damping of the modes, the next critical speed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..dampers.oil import orifice_area
from ..motion.measure import PEAKS
from ..ports.linkage import Member
from ..ports.sizing import LimitEvent
from ..results import DesignResult
from ..stability.critical import CriticalSpeed, critical_speeds
from ..stability.linear import LinearGear
from ..stability.modes import ModeTable
from ..strength.cylinder import bore, piston_area, rod_diameters, rod_length
from ..strength.materials import allowable_stress
from ..strength.members import allowables, distance, least_sections, root_stress
from ..strength.sections import area_for_modulus, fibre_distance, shape_numbers
from ..study.study import Study

__all__ = ["LeastDamping", "Size", "damper_speed", "least_damping", "next_critical_speed", "sizes"]

BEYOND = 3.0
"""Speeds up to this multiple of the envelope's largest are searched for the next critical one."""


@dataclass(frozen=True)
class Size:
    """A dimension of a part [SI].

    Attributes
    ----------
    part, words : str
    value : float
    unit : str
        SI unit.
    margin : float or None
        Of safety, load that it bears over limit load, less 1; None where it is no measure of strength.
    group : str
        Part of the mass table that it belongs to.
    """

    part: str
    words: str
    value: float
    unit: str
    margin: float | None = None
    group: str = ""


@dataclass(frozen=True)
class LeastDamping:
    """Where a mode is damped least: damping ratio, frequency [Hz], speed [m/s] and load [N]."""

    mode: str
    ratio: float
    frequency: float
    speed: float
    load: float


def least_damping(tables: Sequence[ModeTable]) -> list[LeastDamping]:
    """Least damping ratio of every mode that oscillates, over speeds and loads.

    Parameters
    ----------
    tables : sequence of ModeTable
        One for each load.

    Returns
    -------
    list of LeastDamping
        The least first.
    """
    found: dict[str, LeastDamping] = {}
    for table in tables:
        ratios = np.where(np.abs(table.eigenvalues.imag) > 1e-6, table.damping_ratio, np.inf)
        for j, name in enumerate(table.names):
            i = int(ratios[:, j].argmin())
            ratio = float(ratios[i, j])
            if math.isfinite(ratio) and (name not in found or ratio < found[name].ratio):
                found[name] = LeastDamping(name, ratio, float(table.frequency[i, j]), float(table.speeds[i]), table.load)
    return sorted(found.values(), key=lambda least: least.ratio)


def next_critical_speed(study: Study, gear: LinearGear) -> CriticalSpeed | None:
    """Least speed beyond the envelope, up to `BEYOND` times its largest, at which the gear turns unstable."""
    high = study.envelope.speed.max
    found = [c for load in study.envelope.loads for c in critical_speeds(gear, load, high, BEYOND * high)]
    turning = [c for c in found if c.boundary and c.destabilising and c.speed > high]
    return min(turning, key=lambda c: c.speed, default=None)


def damper_speed(study: Study, result: DesignResult) -> float | None:
    """Peak speed of the damper in the limit event [m/s], by its linear damping; None where no one number says that."""
    force, damper = result.limit_event.get("damper_force"), study.damper
    largest = damper.with_damping(result.design, damper.damping_factors()[1])
    damping = damper.damping(largest) if result.design else None
    return force / float(damping) if force is not None and damping else None


def sizes(study: Study, result: DesignResult) -> list[Size]:
    """Sections of links and arms, rod, bore, wall and pressure of the damper, with margins of safety at the limit event.

    Parameters
    ----------
    study : Study
    result : DesignResult
        With a design.

    Returns
    -------
    list of Size
        Tapered links and supports at their root; without a size of their own it meets its allowable stress exactly. Members
        that share a size are shown once, by the first, which is stressed most.
    """
    event = _event(study, result)
    if event is None:
        return []
    members = [member for member in study.damper.members(result.design) if member.section]
    chosen = {member.variable: member for member in reversed(members) if member.variable}
    found: list[Size] = []
    for member in members:
        if not member.variable or chosen[member.variable] is member:
            legs = [other for other in members if member.variable and other.variable == member.variable] or [member]
            found += [replace(size, group=member.part) for size in _member(study, member, legs, event)]
    own = _cylinder(study, event, result.derived | result.design) + _orifice(study, result, event)
    return found + [replace(size, group="damper") for size in own]


def _event(study: Study, result: DesignResult) -> LimitEvent | None:
    """The limit event of a result, with what follows from its peaks."""
    peaks = result.limit_event
    if not set(PEAKS) <= peaks.keys():
        return None
    reach = study.damper.linkage(result.design, study.material.youngs_modulus).reach
    return LimitEvent(
        torque=peaks["linkage_torque"],
        yaw=peaks["yaw_angle"],
        yaw_rate=math.nan,
        stroke=peaks["damper_stroke"],
        damper_force=peaks["damper_force"],
        apex_force=peaks["linkage_torque"] / float(reach),
        arm_moment=math.nan,
        spring_force=peaks["spring_force"],
        spring_energy=math.nan,  # like the other two: no size of a member hangs on it
        safety_factor=study.required.limit_factor,
        ultimate_factor=study.required.ultimate_factor,
    )


def _member(study: Study, member: Member, legs: Sequence[Member], event: LimitEvent) -> list[Size]:
    """Section of a member, of a leg, of an arm, or at the root of a cantilever; lengths of all that share it; its eyes."""
    section = getattr(study.mass, member.section)
    part, inertia, margin = _section(study, member, event)
    height = 2 * fibre_distance(section, inertia)
    words = "outer diameter" if section.family in ("tube", "solid_round") else "height of the section"
    found = [Size(part, words, float(height), "m", float(margin))]
    if section.thickness_ratio is not None:
        found.append(Size(part, "wall", float(section.thickness_ratio * height), "m"))
    lengths = {leg.name.rpartition(", ")[2]: float(_length(leg)) for leg in legs}
    if len(set(lengths.values())) > 1:
        found += [Size(part, f"length, {name}", length, "m") for name, length in lengths.items()]
    else:
        found.append(Size(part, "length", next(iter(lengths.values())), "m"))
    if member.area is not None:
        found.insert(0, Size(part, "number of legs", float(len(legs)), "1"))
        feet = [float(leg.start[1]) for leg in legs]
        found.append(Size(part, "width between the feet", max(feet) - min(feet), "m"))
    if not member.is_beam and study.damper.has_sized_parts():
        found.append(Size(part, "bore of its eye, diameter of the pin", float(study.mass.lug.bore * height), "m"))
    return found


def _length(member: Member) -> Any:
    return distance(member.start, member.end) if member.length is None else member.length


def _section(study: Study, member: Member, event: LimitEvent) -> tuple[str, float, float]:
    """What a section is of, its second moment of area [m^4], and the least margin of safety."""
    kappa_area, _ = shape_numbers(getattr(study.mass, member.section))
    if member.variable:
        least = least_sections(member, event, study)
        if member.area is not None:  # Euler's load grows with the square of the area
            ratios = {check: (member.area / value) ** (2 if check == "buckling" else 1) for check, value in least.items()}
            return f"{member.part}, each leg", (member.area / kappa_area) ** 2, min(ratios.values()) - 1
        # the section modulus grows with I^(3/4)
        return f"{member.part}, root", member.inertia, min((member.inertia / value) ** 0.75 for value in least.values()) - 1
    if member.inertia is not None:
        section = getattr(study.mass, member.section)
        allowed = allowables(study.material, event, section) if study.damper.has_sized_parts() else {}
        stress = min(
            allowed.values(),
            default=allowable_stress(study.material, study.required.limit_factor, study.required.ultimate_factor),
        )
        return member.name, member.inertia, stress / root_stress(member, event, study) - 1
    length = _length(member)
    allowable = allowable_stress(study.material, study.required.limit_factor, study.required.ultimate_factor)
    area = area_for_modulus(getattr(study.mass, member.section), getattr(event, member.load) * length / allowable)
    return f"{member.name}, root", (area / kappa_area) ** 2, 0.0


def _orifice(study: Study, result: DesignResult, event: LimitEvent) -> list[Size]:
    """Orifice that gives its part of the damping at the reference temperature, for strokes as fast as the limit event's."""
    share, rate = study.damper.orifice_share(), damper_speed(study, result)
    if not share or rate is None or study.damper.ROTARY:
        return []
    area = float(result.design["A_piston"] if "A_piston" in result.design else piston_area(event, study.mass))
    c = share * result.design[study.damper.VISCOUS]
    found = orifice_area(c, area, rate, study.mass.oil_density)
    words = f"area of an orifice for {share:.3g} of the damping, as its first harmonic at {rate:.3g} m/s, C_d 0.65 (typical)"
    return [Size("damper", words, found, "m^2")]


def _cylinder(study: Study, event: LimitEvent, chosen: Mapping[str, float]) -> list[Size]:
    """Rod against yield (its area) and buckling (its second moment), cylinder against the working pressure."""
    rod, model = chosen.get("rod_diameter"), study.mass
    if rod is None:
        return []
    own, stroke = study.damper.piston(chosen), chosen.get("s_damper", event.stroke)
    area = piston_area(event, model) if own is None else own
    sigma = allowable_stress(model.damper_material, study.required.limit_factor, study.required.ultimate_factor)
    event = replace(event, stroke=stroke)
    least = {name: float(value) for name, (value, _) in rod_diameters(event, model).items()}
    diameter = float(bore(area, rod))
    needed = model.working_pressure * diameter / (2 * sigma)
    wall = model.wall_allowance + needed  # as `cylinder_mass` reckons it
    return [
        Size("damper rod", "diameter, against yield", rod, "m", (rod / least["rod_yield"]) ** 2 - 1),
        Size("damper rod", "diameter, against buckling", rod, "m", (rod / least["rod_buckling"]) ** 4 - 1),
        Size("damper cylinder", "bore", diameter, "m"),
        Size("damper cylinder", "wall", wall, "m", wall / needed - 1),
        Size("damper cylinder", "stroke to one side", float(stroke), "m"),
        Size("damper cylinder", "length of cylinder and rod", float(rod_length(event, model)), "m"),
        Size("damper cylinder", "peak pressure", float(event.damper_force / area), "Pa"),
        Size("damper cylinder", "proof pressure", float(model.proof_factor * event.damper_force / area), "Pa"),
        Size("damper cylinder", "burst pressure", float(model.burst_factor * event.damper_force / area), "Pa"),
        Size("damper", "oil volume", float(area * rod_length(event, model)), "m^3"),
    ]

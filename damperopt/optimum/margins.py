"""Load cases and margins of safety of a design: every part, check and case, from the sections that it has.

Static cases load links, arm and spring in proportion to their yaw torque, and the damper by the peak of the chain that is let
go from it. The simulated motions of the decay requirement are one more case, with the peaks that they show.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ..linkages.elastic import elastic_linkage
from ..ports.linkage import Member
from ..ports.sizing import LimitEvent
from ..results import LoadRow, MarginRow
from ..strength.buckling import least_lateral_inertia, local_buckling_stress, weak_axis
from ..strength.cylinder import bore, rod_length
from ..strength.fatigue import Basquin, FlightStresses, life_damage_counted
from ..strength.limit_event import limit_event
from ..strength.margins import (
    Column,
    Lug,
    Margin,
    bolt_margin,
    column_margins,
    fatigue_margin,
    lug_margins,
    stress_margins,
)
from ..strength.members import distance, root_stress
from ..strength.sections import fibre_distance, shape_numbers
from ..study.study import Study

__all__ = ["load_rows", "margin_rows", "margins"]

SHIMMY = "shimmy"
"""The simulated release or kick among the load cases."""


def load_rows(study: Study, design: Mapping[str, float], peaks: Mapping[str, float]) -> tuple[LoadRow, ...]:
    """Table of the load cases: those that count and those that do not, with what each gives.

    Parameters
    ----------
    study : Study
    design : mapping of str to float
        Design variables by name [SI].
    peaks : mapping of str to float
        Simulated, by the names of `measure.PEAKS`; empty where nothing was simulated.
    """
    reach = float(elastic_linkage(study, design).reach)
    rows = study.loads.table(study, shimmy_torque=peaks.get("linkage_torque"))
    torques = {row.name: float(row.limit_torque()) for row in rows}
    worst = max((torques[row.name] for row in rows if not row.off), default=0.0)
    found = []
    for row in rows:
        loads, torque = row.loads, torques[row.name]
        forces = (0.0, 0.0, 0.0) if loads is None else (float(loads.vertical), float(loads.side), float(loads.drag))
        sizing = not row.off and torque >= worst * (1 - 1e-9)
        found.append(
            LoadRow(row.name, row.rule, row.read, row.level, row.nature, *forces, torque, torque / reach, row.off, sizing)
        )
    return tuple(found)


def margin_rows(study: Study, design: Mapping[str, float], peaks: Mapping[str, float]) -> tuple[MarginRow, ...]:
    """Margins of safety as a result holds them, the least of each part and check first.

    Parameters
    ----------
    study : Study
    design : mapping of str to float
        Design variables by name [SI].
    peaks : mapping of str to float
        Simulated, by the names of `measure.PEAKS`; empty where nothing was simulated.
    """
    rows = [
        MarginRow(
            m.part, m.check, m.case, m.level, float(m.applied), float(m.allowable), float(m.factor), m.unit, float(m.value)
        )
        for m in margins(study, design, peaks)
    ]
    return tuple(sorted(rows, key=lambda row: row.value))


def margins(study: Study, design: Mapping[str, float], peaks: Mapping[str, float]) -> Iterator[Margin]:
    """Margins of safety of every part, check and case; none of a rigid chain, whose parts have no sections of their own."""
    if not study.damper.has_sized_parts():
        return
    link = elastic_linkage(study, design)
    event = limit_event(study, link, design, max(study.envelope.loads))
    worst = float(event.torque)
    cases = {
        row.case: _scaled(event, row.yaw_torque / worst)
        for row in load_rows(study, design, {})
        if not row.off and row.yaw_torque > 0
    }
    if peaks:
        cases[SHIMMY] = replace(
            event,
            apex_force=peaks["linkage_torque"] / float(link.reach),
            damper_force=peaks["damper_force"],
            spring_force=peaks["spring_force"],
            stroke=peaks["damper_stroke"],
        )
    for case, loads in cases.items():
        for member in _each_part(study, design):
            yield from _of_member(study, member, loads, case)
        for part, stress in study.damper.springs(event, study).items():
            at_case = float(stress * loads.spring_force / event.spring_force)
            yield from stress_margins(part, case, at_case, study.mass.damper_material, _factors(study))
        yield from _of_damper(study, design, loads, case)
    for member in _each_part(study, design):
        standing = 0.0 if member.load == "damper_force" else 1.0
        yield from _fatigue(study, member.part, study.material, _stress(study, member, event), event, standing)
    for part, stress in study.damper.springs(event, study).items():
        yield from _fatigue(study, part, study.mass.damper_material, float(stress), event)


def _scaled(event: LimitEvent, ratio: float) -> LimitEvent:
    forces: dict[str, Any] = {
        name: ratio * float(getattr(event, name)) for name in ("apex_force", "damper_force", "spring_force", "stroke")
    }
    return replace(event, **forces)


def _factors(study: Study) -> tuple[float, float]:
    """On yield at limit load, and ultimate over limit load."""
    return study.required.limit_factor, study.required.ultimate_factor


def _each_part(study: Study, design: Mapping[str, float]) -> list[Member]:
    """Members with sections; of legs that share one the longest, as it is declared first."""
    found: dict[str, Member] = {}
    for member in study.damper.members(design):
        if member.area is not None or member.inertia is not None:
            found.setdefault(member.variable or member.name, member)
    return list(found.values())


def _stress(study: Study, member: Member, loads: LimitEvent) -> float:
    if member.area is not None:
        return float(getattr(loads, member.load) * member.share / member.area)
    return float(root_stress(member, loads, study))


def _of_member(study: Study, member: Member, loads: LimitEvent, case: str) -> Iterator[Margin]:
    required, material = study.required, study.material
    section = getattr(study.mass, member.section)
    kappa_area, _ = shape_numbers(section)
    stress = _stress(study, member, loads)
    yield from stress_margins(member.part, case, stress, material, _factors(study))
    inertia = (member.area / kappa_area) ** 2 if member.inertia is None else member.inertia
    size = 2 * float(fibre_distance(section, inertia))
    wall = section.thickness_ratio * size if section.family == "tube" else None
    radius = None if wall is None else (size - wall) / 2
    force = stress * member.area if member.area is not None else float(getattr(loads, member.load))
    if member.area is not None:
        length = float(distance(member.start, member.end) if member.length is None else member.length)
        column = Column(member.area, float(inertia * weak_axis(section)), length, radius, wall)
        yield from column_margins(member.part, case, force, column, material, required.ultimate_factor)
    thin = local_buckling_stress(section, material, "bending" if member.area is None else "axial")
    if thin is not None and (member.area is None or wall is None):
        yield Margin(member.part, "wall", case, "ultimate", stress, float(thin), required.ultimate_factor)
    if member.area is None:
        lever = float(distance(member.start, member.end) if member.bending_length is None else member.bending_length)
        least = least_lateral_inertia(section, material, force * lever, lever)
        if least is not None:
            yield Margin(
                member.part, "lateral", case, "ultimate", float(least), member.inertia, required.ultimate_factor, "m^4"
            )
    if not member.is_beam:
        lug = study.mass.lug
        eye = Lug(*(ratio * size for ratio in (lug.bore, lug.thickness, lug.width, lug.edge)))
        yield from lug_margins(member.part, case, force, eye, material, (required.ultimate_factor, lug.fitting_factor))
        yield bolt_margin(f"pin, {member.part}", case, force, eye.bore, study.mass.damper_material, required.ultimate_factor)


def _of_damper(study: Study, design: Mapping[str, float], loads: LimitEvent, case: str) -> Iterator[Margin]:
    """What a damper of given size can do, and the parts of one that is made."""
    sized = study.damper.parts(loads, study.mass)
    for c in sized.capacities if sized is not None else ():
        yield Margin("damper", c.name.replace("_", " "), case, "limit", float(c.asked), float(c.has), unit=c.unit)
    area = study.damper.piston(design)
    if area is not None:
        yield from _of_cylinder(study, design, area, loads, case)


def _of_cylinder(study: Study, design: Mapping[str, float], area: float, loads: LimitEvent, case: str) -> Iterator[Margin]:
    """Rod, cylinder at proof and burst pressure, stroke."""
    model, required = study.mass, study.required
    steel, rod, F = model.damper_material, design["rod_diameter"], float(loads.damper_force)
    section, length = math.pi / 4 * rod**2, float(rod_length(replace(loads, stroke=design["s_damper"]), model))
    yield from stress_margins("damper rod", case, F / section, steel, _factors(study))
    column = Column(section, math.pi / 64 * rod**4, length)
    yield from column_margins("damper rod", case, F, column, steel, required.ultimate_factor)
    D = float(bore(area, rod))
    wall = model.wall_thickness(D, required.limit_factor, required.ultimate_factor)
    hoop = F / area * D / (2 * wall)
    yield Margin("damper cylinder", "proof pressure", case, "limit", hoop, steel.yield_strength, model.proof_factor)
    burst = steel.yield_strength if steel.ultimate_strength is None else steel.ultimate_strength
    yield Margin("damper cylinder", "burst pressure", case, "ultimate", hoop, burst, model.burst_factor)
    yield Margin("damper", "stroke", case, "limit", float(loads.stroke), design["s_damper"], unit="m")


def _fatigue(
    study: Study, part: str, material: Any, stress: float, event: LimitEvent, standing: float = 1.0
) -> Iterator[Margin]:
    """The spectrum of flights, counted; what the damper loads feels no standing torque."""
    law, shares = Basquin.of(material), event.flight
    if law is None or shares is None:
        return
    turn, tow, landing = (float(share) * stress for share in (standing * shares.turn, standing * shares.tow, shares.landing))
    damage = life_damage_counted(FlightStresses(turn, tow, landing, float(shares.decay)), study.required.fatigue.spectrum, law)
    yield fatigue_margin(part, max(damage, np.finfo(float).tiny), law)

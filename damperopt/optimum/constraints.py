"""What a design must meet besides stability: strength, strokes and lengths.

A constraint remembers who declared it, so that results and infeasibility reports can speak of the requirement.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

from ..expressions.calculus import cos, log
from ..linkages.base import TorqueLinks, reach_and_height
from ..objectives import RELAXED, SizedLayout
from ..ports.linkage import Linkage, Member
from ..ports.sizing import LimitEvent
from ..strength.buckling import least_lateral_inertia
from ..strength.materials import allowable_stress
from ..strength.members import allowables, distance, fatigue_ratio, root_stress

__all__ = ["Constraint", "geometry", "strength"]


@dataclass(frozen=True)
class Constraint:
    """`value` against `limit`, in SI.

    Attributes
    ----------
    name : str
        Of the requirement, as in results.
    value, limit : SX
        [unit]
    at_least : bool
        True for value >= limit, False for value <= limit.
    unit : str
        SI unit.
    relaxed_by : tuple of str
        Key paths of the study's numbers that would relax it.
    ratio : bool
        Scale by logarithms: for positive quantities that range over decades. Otherwise by `limit` units of 1.
    kind : str
        ``strength`` or ``geometry``.
    """

    name: str
    value: Any
    limit: Any
    at_least: bool
    unit: str
    relaxed_by: tuple[str, ...]
    ratio: bool = False
    kind: Literal["strength", "geometry"] = "geometry"

    @property
    def row(self) -> Any:
        """Scaled violation, <= 0 where the constraint holds."""
        excess = log(self.value / self.limit) if self.ratio else self.value - self.limit
        return -excess if self.at_least else excess


def strength(study: Any, design: Mapping[str, Any], sized: SizedLayout, softness: Any = 1) -> list[Constraint]:
    """Stress and fatigue of the bending arm, the damper's own sizes, and the least working stroke.

    Parameters
    ----------
    study : Study
        Floats or symbols.
    design : mapping
        Design variables by name.
    sized : SizedLayout
        With the shock strut fully out, where a torque makes the largest forces.
    softness : Expr
        Stroke of the damper under a torque with the shock strut furthest in, over that with it fully out.

    Returns
    -------
    list of Constraint
    """
    required = study.requirements
    bending = [member for member in study.damper.members(design) if member.kind in ("arm", "beam")]
    blocks = [c for member in bending for c in _arm(study, member, sized.event)]
    for size in sized.sizes:
        for name, (least, relaxed) in size.least.items():
            blocks.append(Constraint(name, size.symbol, least, True, size.unit, relaxed, ratio=True))
    blocks += [Constraint(c.name, c.asked, c.has, False, c.unit, c.relaxed_by, ratio=True) for c in sized.capacities]
    if not study.damper.ROTARY:  # which has no apex
        least_stroke = required.stroke_ratio * required.apex_clearance
        relaxed = ("requirements.stroke_ratio", "requirements.apex_clearance")
        stroke = sized.event.stroke if sized.event.service_stroke is None else sized.event.service_stroke
        blocks.append(Constraint("working_stroke", softness * stroke, least_stroke, True, "m", relaxed, ratio=True))
    return [replace(block, kind="strength") for block in blocks]


def _arm(study: Any, member: Member, event: LimitEvent) -> list[Constraint]:
    """Static and fatigue strength of a bending arm."""
    required, name, stress = study.requirements, member.kind, root_stress(member, event, study)
    if study.damper.has_sized_parts():
        return _elastic_arm(study, member, event, stress)
    torque = ("loads", "requirements.limit_torque", "requirements.limit_torque_factor")
    allowed = allowable_stress(study.material, event.safety_factor, event.ultimate_factor)
    found = [Constraint(f"{name}_stress", stress, allowed, False, "Pa", ("requirements.limit_factor", *torque), ratio=True)]
    if study.material.has_fatigue_data:
        amplitude, cycles = required.fatigue.stress_fraction * stress, required.fatigue.cycles
        endured = study.material.fatigue_strength_coefficient * (2 * cycles) ** study.material.fatigue_exponent
        relaxed = ("requirements.fatigue.stress_fraction", "requirements.fatigue.cycles", *torque)
        found.append(Constraint(f"{name}_fatigue", amplitude, endured, False, "Pa", relaxed, ratio=True))
    return found


def _elastic_arm(study: Any, member: Member, event: LimitEvent, stress: Any) -> list[Constraint]:
    """Yield at limit load, rupture at ultimate load, and the spectrum of flights."""
    name, section = member.kind, getattr(study.mass, member.section)
    found = [
        Constraint(f"{name}_{check}", stress, allowed, False, "Pa", RELAXED[check], ratio=True)
        for check, allowed in allowables(study.material, event, section).items()
    ]
    lever = distance(member.start, member.end) if member.bending_length is None else member.bending_length
    moment = event.ultimate_factor * getattr(event, member.load) * lever
    tipped = least_lateral_inertia(section, study.material, moment, lever)
    if tipped is not None:
        found.append(Constraint(f"{name}_lateral", member.inertia, tipped, True, "m^4", RELAXED["lateral"], ratio=True))
    ratio = fatigue_ratio(member, stress, event, study)
    if ratio is not None:
        found.append(Constraint(f"{name}_fatigue", ratio, 1, False, "1", RELAXED["fatigue"], ratio=True))
    return found


def geometry(study: Any, design: Mapping[str, Any], linkage: Linkage, sized: SizedLayout) -> list[Constraint]:
    """Lengths that the gear and its bay allow, with the shock strut fully out and fully in.

    Parameters
    ----------
    study : Study
        Floats or symbols.
    design : mapping
        Design variables by name.
    linkage : Linkage
    sized : SizedLayout

    Returns
    -------
    list of Constraint
    """
    if study.damper.ROTARY:  # nothing reaches out
        return []
    required, model, reach, stroke = study.requirements, study.mass, linkage.reach, 0
    keys = "requirements.lug_distance", "requirements.reach"
    links = isinstance(study.damper, TorqueLinks)
    if links and study.gear.strut is not None:
        stroke = study.gear.strut.longest
    furthest = reach_and_height(design, stroke)[0] if links else reach
    blocks = [
        Constraint("reach_min", reach, required.reach.min, True, "m", (f"{keys[1]}.min",)),
        Constraint("reach_max", furthest, required.reach.max, False, "m", (f"{keys[1]}.max",)),
    ]
    if links:
        height = design["L"] * cos(design["gamma"])
        lugs, clearance = 2 * height, height - stroke / 2 + model.lower_lug_height - study.gear.wheel_radius
        above = ("requirements.tyre_clearance", "mass.lower_lug_height")
        blocks = [
            Constraint("lug_distance_min", lugs - stroke, required.lug_distance.min, True, "m", (f"{keys[0]}.min",)),
            Constraint("lug_distance_max", lugs, required.lug_distance.max, False, "m", (f"{keys[0]}.max",)),
            *blocks,
            Constraint("tyre_clearance", clearance, required.tyre_clearance, True, "m", above),
        ]
    if linkage.damper_length is not None and sized.needed_length is not None:
        length, needed = linkage.damper_length, sized.needed_length
        blocks.append(Constraint("damper_length", length, needed, True, "m", ("mass.dead_length",)))
    elif study.damper.has_sized_parts() and sized.needed_length is not None:  # across the apex, where the bay has room
        blocks.append(Constraint("apex_room", sized.needed_length, required.apex_room, False, "m", ("requirements.apex_room",)))
    stop = study.damper.stop
    if study.damper.has_sized_parts() and stop is not None:  # no part of the limit torque may rest on it: it is not sized
        longer = ("damper.end_stop.stroke",)
        blocks.append(
            Constraint(
                "end_stop", stop.stroke, sized.event.stroke, True, "rad" if study.damper.ROTARY else "m", longer, ratio=True
            )
        )
    most = study.damper.links.hinge_width_max if isinstance(study.damper, TorqueLinks) else None
    if study.damper.has_sized_parts() and most is not None:
        width = study.damper.links.width(design["L"])
        blocks.append(Constraint("hinge_width", width, most, False, "m", ("damper.links.hinge_width_max",)))
    return blocks

"""What a design must meet besides stability: strength, strokes and lengths.

A constraint remembers who declared it, so that results and infeasibility reports can speak of the requirement.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import casadi as ca

from ..linkages.base import Linkage
from ..objectives import LimitEvent, allowable_stress, arm_stress, bore, rod_diameters, rod_length

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
        excess = ca.log(self.value / self.limit) if self.ratio else self.value - self.limit
        return -excess if self.at_least else excess


def strength(study: Any, design: Mapping[str, Any], event: LimitEvent, rod_diameter: Any) -> list[Constraint]:
    """Stress and fatigue of the bending arm, the rod, and the least working stroke.

    Parameters
    ----------
    study : Study
        Floats or symbols.
    design : mapping
        Design variables by name.
    event : LimitEvent
    rod_diameter : SX
        [m]

    Returns
    -------
    list of Constraint
    """
    required = study.requirements
    blocks: list[Constraint] = []
    relaxed: tuple[str, ...]
    if "I_arm" in design:
        stress = arm_stress(study, design, event)
        allowed = allowable_stress(study.material, required.safety_factor)
        relaxed = ("requirements.safety_factor", "requirements.limit_torque", "requirements.limit_torque_factor")
        blocks.append(Constraint("arm_stress", stress, allowed, False, "Pa", relaxed, ratio=True))
        if study.material.has_fatigue_data:
            amplitude, cycles = required.fatigue.stress_fraction * stress, required.fatigue.cycles
            endured = study.material.fatigue_strength_coefficient * (2 * cycles) ** study.material.fatigue_exponent
            relaxed = ("requirements.fatigue.stress_fraction", "requirements.fatigue.cycles", *relaxed[1:])
            blocks.append(Constraint("arm_fatigue", amplitude, endured, False, "Pa", relaxed, ratio=True))
    rod_keys = {"rod_yield": "requirements.safety_factor", "rod_buckling": "mass.rod_buckling_factor"}
    for name, least in rod_diameters(study, event).items():
        relaxed = (rod_keys.get(name, "mass.least_rod_diameter"),)
        blocks.append(Constraint(name, rod_diameter, least, True, "m", relaxed, ratio=True))
    least_stroke = required.stroke_ratio * required.apex_clearance
    relaxed = ("requirements.stroke_ratio", "requirements.apex_clearance")
    blocks.append(Constraint("working_stroke", event.stroke, least_stroke, True, "m", relaxed, ratio=True))
    return [replace(block, kind="strength") for block in blocks]


def geometry(study: Any, design: Mapping[str, Any], linkage: Linkage, event: LimitEvent, rod_diameter: Any) -> list[Constraint]:
    """Lengths that the gear and its bay allow.

    Parameters
    ----------
    study : Study
        Floats or symbols.
    design : mapping
        Design variables by name.
    linkage : Linkage
    event : LimitEvent
    rod_diameter : SX
        [m]

    Returns
    -------
    list of Constraint
    """
    required, model = study.requirements, study.mass
    height = design["L"] * ca.cos(design["gamma"])
    lugs, reach, keys = 2 * height, linkage.reach, ("requirements.lug_distance", "requirements.reach")
    clearance = height + model.lower_lug_height - study.gear.wheel_radius
    blocks = [
        Constraint("lug_distance_min", lugs, required.lug_distance.min, True, "m", (f"{keys[0]}.min",)),
        Constraint("lug_distance_max", lugs, required.lug_distance.max, False, "m", (f"{keys[0]}.max",)),
        Constraint("reach_min", reach, required.reach.min, True, "m", (f"{keys[1]}.min",)),
        Constraint("reach_max", reach, required.reach.max, False, "m", (f"{keys[1]}.max",)),
        Constraint(
            "tyre_clearance",
            clearance,
            required.tyre_clearance,
            True,
            "m",
            ("requirements.tyre_clearance", "mass.lower_lug_height"),
        ),
    ]
    if linkage.damper_length is not None:
        needed = rod_length(study, event) + event.stroke + bore(study, event, rod_diameter)
        blocks.append(Constraint("damper_length", linkage.damper_length, needed, True, "m", ("mass.dead_length",)))
    return blocks

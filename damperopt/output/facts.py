"""What a design review asks beside the answer: loads and sizes of the parts, damping of the modes, the next critical speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np

from ..objectives import allowable_stress, bore, rod_diameters, rod_length
from ..results import DesignResult
from ..stability.critical import CriticalSpeed, critical_speeds
from ..stability.linear import LinearGear
from ..stability.modes import ModeTable
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
    """

    part: str
    words: str
    value: float
    unit: str
    margin: float | None = None


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


def damper_speed(result: DesignResult) -> float | None:
    """Peak speed of the damper in the limit event [m/s], by its linear damping; None without one."""
    force, damping = result.limit_event.get("damper_force"), result.design.get("c_lambda")
    return force / damping if force is not None and damping else None


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
        Tapered links and supports at their root, which is sized to its allowable stress exactly.
    """
    peaks, design, model = result.limit_event, result.design, study.mass
    if not {"linkage_torque", "damper_stroke", "damper_force"} <= peaks.keys():
        return []
    found: list[Size] = []
    allowable = allowable_stress(study.material, study.required.safety_factor)
    if {"L", "gamma"} <= design.keys():
        root = peaks["linkage_torque"] / math.sin(design["gamma"]) / allowable
        found += _section("torque links, root", model.link_section, area_for_modulus(model.link_section, root), 0.0)
    if "I_arm" in design:
        stress = next((c for c in result.constraints if c.name == "arm_stress"), None)
        margin = None if stress is None else stress.limit / stress.value - 1
        found += _section(
            "bending arm", model.arm_section, shape_numbers(model.arm_section)[0] * design["I_arm"] ** 0.5, margin
        )
    if result.mass is not None and "support arm" in result.mass.parts:
        root = peaks["damper_force"] * design["b"] / allowable
        found += _section("support arm, root", model.support_section, area_for_modulus(model.support_section, root), 0.0)
    event = SimpleNamespace(stroke=peaks["damper_stroke"], damper_force=peaks["damper_force"])
    return found + _damper(study, event, result.derived.get("rod_diameter"))


def _section(part: str, section: Any, area: float, margin: float | None) -> list[Size]:
    """Height and wall of a section of known area."""
    inertia = (area / shape_numbers(section)[0]) ** 2
    height = 2 * fibre_distance(section, inertia)
    words = "outer diameter" if section.family in ("tube", "solid_round") else "height of the section"
    found = [Size(part, words, height, "m", margin)]
    if section.thickness_ratio is not None:
        found.append(Size(part, "wall", section.thickness_ratio * height, "m"))
    return found


def _damper(study: Study, event: Any, rod: float | None) -> list[Size]:
    """Rod against yield (its area) and buckling (its second moment), cylinder against the working pressure."""
    if rod is None:
        return []
    model, steel = study.mass, study.mass.damper_material
    sigma = allowable_stress(steel, study.required.safety_factor)
    least = {name: float(value) for name, value in rod_diameters(study, event).items()}
    diameter = float(bore(study, event, rod))
    needed = model.working_pressure * diameter / (2 * sigma)
    wall = model.wall_allowance + needed  # as the mass of the cylinder is reckoned
    return [
        Size("damper rod", "diameter, against yield", rod, "m", (rod / least["rod_yield"]) ** 2 - 1),
        Size("damper rod", "diameter, against buckling", rod, "m", (rod / least["rod_buckling"]) ** 4 - 1),
        Size("damper cylinder", "bore", diameter, "m"),
        Size("damper cylinder", "wall", wall, "m", wall / needed - 1),
        Size("damper cylinder", "length of cylinder and rod", float(rod_length(study, event)), "m"),
        Size("damper cylinder", "peak pressure", model.working_pressure, "Pa"),
    ]

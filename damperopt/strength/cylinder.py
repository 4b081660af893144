"""A through-rod hydraulic cylinder: rod, bore and walls from force, stroke and pressure."""

from __future__ import annotations

import math
from typing import Any

from ..expressions.calculus import Expr, sqrt, where
from ..ports.sizing import LimitEvent
from .materials import allowable_stress

__all__ = [
    "bore",
    "cylinder_mass",
    "oil_stiffness",
    "piston_area",
    "rod_column",
    "rod_diameters",
    "rod_length",
    "rod_stiffness",
]


def rod_length(event: LimitEvent, model: Any) -> Expr:
    """Length of cylinder and rod, two strokes and the dead length [m]."""
    return 2 * event.stroke + model.dead_length


def rod_diameters(event: LimitEvent, model: Any) -> dict[str, tuple[Expr, tuple[str, ...]]]:
    """Least rod diameter [m] against yield, against Euler buckling (pinned, full length), and to be made at all.

    Parameters
    ----------
    event : LimitEvent
    model : MassModel

    Returns
    -------
    dict
        Limit -> (diameter [m], key paths that would relax it).
    """
    steel, F = model.damper_material, event.damper_force
    allowable = allowable_stress(steel, event.safety_factor, event.ultimate_factor)
    buckling = 64 * model.rod_buckling_factor * F * rod_length(event, model) ** 2
    return {
        "rod_yield": (sqrt(4 * F / (math.pi * allowable)), ("requirements.limit_factor",)),
        "rod_buckling": ((buckling / (math.pi**3 * steel.youngs_modulus)) ** 0.25, ("mass.rod_buckling_factor",)),
        "rod_minimum": (model.least_rod_diameter, ("mass.least_rod_diameter",)),
    }


def rod_column(event: LimitEvent, model: Any) -> Expr:
    """Least rod diameter [m] as a column with pinned ends at ultimate load, as its margin of safety has it.

    Euler's load where its stress is below half the yield strength, else Johnson's parabola, which yields first.

    Parameters
    ----------
    event : LimitEvent
    model : MassModel
    """
    steel, length = model.damper_material, rod_length(event, model)
    E, yields, F = steel.youngs_modulus, steel.yield_strength, event.ultimate_factor * event.damper_force
    euler = (64 * F * length**2 / (math.pi**3 * E)) ** 0.25
    johnson = sqrt(4 / (math.pi * yields) * (F + yields**2 * length**2 / (math.pi * E)))
    return where(math.pi**2 * E * euler**2 / (16 * length**2) < yields / 2, euler, johnson)


def piston_area(event: LimitEvent, model: Any) -> Expr:
    """Least area of the piston [m^2], F_max/p_max."""
    return event.damper_force / model.working_pressure


def bore(area: Expr, rod_diameter: Expr) -> Expr:
    """Bore of the cylinder [m]: the area of the piston as an annulus around the rod."""
    return sqrt(4 * area / math.pi + rod_diameter**2)


def oil_stiffness(area: Expr, stroke: Expr, model: Any) -> Expr:
    """Stiffness of both chambers of a balanced damper at mid-stroke, 2 beta A/(stroke + dead) [N/m].

    Parameters
    ----------
    area : Expr
        Of the piston [m^2].
    stroke : Expr
        To one side [m].
    model : MassModel
    """
    return 2 * model.bulk_modulus * area / (stroke + model.chamber_dead_length)


def rod_stiffness(rod_diameter: Expr, length: Expr, model: Any) -> Expr:
    """Stiffness of the rod along itself, E A/l [N/m]."""
    return model.damper_material.youngs_modulus * math.pi / 4 * rod_diameter**2 / length


def cylinder_mass(event: LimitEvent, model: Any, rod_diameter: Expr, area: Expr) -> Expr:
    """Mass of the damper with its oil [kg].

    Parameters
    ----------
    event : LimitEvent
    model : MassModel
    rod_diameter : Expr
        [m]
    area : Expr
        Of the piston [m^2].
    """
    # D bore, t wall of a thin cylinder p D/(2 sigma) plus an allowance for wear and threads, caps as clamped plates
    # plus the same
    steel = model.damper_material
    sigma = allowable_stress(steel, event.safety_factor, event.ultimate_factor)
    p, length = model.working_pressure, rod_length(event, model)
    D = bore(area, rod_diameter)
    t = model.wall_allowance + p * D / (2 * sigma)
    cap = model.wall_allowance + D / 2 * sqrt(0.75 * p / sigma)
    cylinder = math.pi * (D + t) * t * length
    rod = math.pi / 4 * rod_diameter**2 * length
    caps = 2 * math.pi / 4 * (D + 2 * t) ** 2 * cap
    oil = model.oil_density * area * length
    return steel.density * (cylinder + rod + caps) * (1 + model.damper_fittings_fraction) + oil

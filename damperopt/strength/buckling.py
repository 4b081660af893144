"""Buckling that the shape of a section decides: walls and flanges, the weak axis of a leg, an arm that tips over.

A family keeps its shape at every size, so that the stress at which its walls buckle is one number of the family. What is left
out errs on the safe side: warping of I-sections, and the support that web and flanges give each other.
"""

from __future__ import annotations

import math
from typing import Any, Literal

from ..expressions.calculus import Expr, sqrt, where
from .margins import wall_buckling_stress

__all__ = ["least_lateral_inertia", "local_buckling_stress", "weak_axis"]

FLANGE, WEB = 0.43, {"axial": 4.0, "bending": 23.9}
"""Plate factors k of sigma = k pi^2 E/(12 (1 - nu^2)) (t/width)^2: one edge free; both edges held (Timoshenko and Gere)."""

TIPPED = 4.013
"""Of a cantilever with a force at its tip, M L = 4.013 sqrt(E I_y G J) (Timoshenko and Gere)."""


def _breadths(section: Any) -> tuple[Expr, Expr, Expr]:
    """(I_y/I, J/I, I) of a rectangle or an I-section of height 1; J as thin plates."""
    width = 1 / section.aspect_ratio
    if section.family == "rectangle":
        narrow = where(width < 1, width, 1.0)
        long = where(width < 1, 1.0, width)
        inertia = width / 12
        return width**3 / 12 / inertia, narrow**3 * long * (1 - 0.63 * narrow / long) / 3 / inertia, inertia
    t = section.thickness_ratio
    web = 1 - 2 * t
    inertia = (width - (width - t) * web**3) / 12
    return (2 * t * width**3 + web * t**3) / 12 / inertia, (2 * width + web) * t**3 / 3 / inertia, inertia


def weak_axis(section: Any) -> Expr:
    """Second moment of area about the axis about which a leg buckles first over that in the plane of bending.

    Parameters
    ----------
    section : Section
    """
    if section.family in ("solid_round", "tube"):
        return 1.0
    ratio, _, _ = _breadths(section)
    return where(ratio < 1, ratio, 1.0)


def local_buckling_stress(section: Any, material: Any, load: Literal["axial", "bending"]) -> Expr:
    """Stress at which wall, web or flange buckles [Pa]; None: nothing of the section is thin.

    Parameters
    ----------
    section : Section
    material : Material
    load : str
    """
    E, nu, t = material.youngs_modulus, material.poissons_ratio, section.thickness_ratio
    if section.family == "tube":
        return wall_buckling_stress(E, (1 - t) / 2, t, nu, load)
    if section.family != "i_section":
        return None
    plate = math.pi**2 * E / (12 * (1 - nu**2))
    flange = FLANGE * plate * (2 * t / (1 / section.aspect_ratio - t)) ** 2
    web = WEB[load] * plate * (t / (1 - 2 * t)) ** 2
    return where(flange < web, flange, web)


def least_lateral_inertia(section: Any, material: Any, moment: Expr, length: Expr) -> Expr:
    """Least second moment of area of a cantilever that is not to tip over [m^4]; None: its section is as stiff to all sides.

    Parameters
    ----------
    section : Section
    material : Material
    moment : Expr
        At its root, from a force at its tip, with its factor [N m].
    length : Expr
        [m]
    """
    if section.family not in ("rectangle", "i_section"):
        return None
    sideways, torsion, _ = _breadths(section)
    E, G = material.youngs_modulus, material.youngs_modulus / (2 * (1 + material.poissons_ratio))
    return moment * length / (TIPPED * sqrt(E * sideways * G * torsion))

"""Cross-section families of beams: area and outer-fibre distance as functions of the second moment of area.

A family keeps its shape at every size, so A = kappa_A sqrt(I) and h_f = kappa_h I^(1/4) with two shape numbers.
Arguments may be floats or CasADi expressions.
"""

from __future__ import annotations

import math
from typing import Any

__all__ = ["area", "area_for_modulus", "fibre_distance", "inertia_for_modulus", "section_modulus", "shape_numbers"]


def shape_numbers(section: Any) -> tuple[Any, Any]:
    """Shape numbers (A/sqrt(I), h_f/I^(1/4)) of a family.

    Parameters
    ----------
    section : Section
        Family and its ratios.

    Returns
    -------
    tuple
        (kappa_A, kappa_h), both dimensionless.

    Examples
    --------
    >>> from damperopt.ports.section import Section
    >>> kappa_A, kappa_h = shape_numbers(Section(family="solid_round"))
    >>> round(kappa_A, 6), round(kappa_h, 6)  # 2 sqrt(pi), (4/pi)^(1/4)
    (3.544908, 1.062252)
    """
    area_, inertia, half_height = _unit_section(section)
    return area_ / inertia**0.5, half_height / inertia**0.25


def _unit_section(section: Any) -> tuple[Any, Any, Any]:
    """(A, I, h_f) of the member of the family whose height is 1."""
    if section.family == "solid_round":
        return math.pi / 4, math.pi / 64, 0.5
    if section.family == "tube":
        bore = 1 - 2 * section.thickness_ratio
        return math.pi / 4 * (1 - bore**2), math.pi / 64 * (1 - bore**4), 0.5
    width = 1 / section.aspect_ratio
    if section.family == "rectangle":
        return width, width / 12, 0.5
    wall = section.thickness_ratio
    inner_height, inner_width = 1 - 2 * wall, width - wall
    return width - inner_width * inner_height, (width - inner_width * inner_height**3) / 12, 0.5


def area(section: Any, inertia: Any) -> Any:
    """Area [m^2] of the member with second moment of area `inertia` [m^4]."""
    return shape_numbers(section)[0] * inertia**0.5


def fibre_distance(section: Any, inertia: Any) -> Any:
    """Distance of the outer fibre from the neutral axis [m]; `inertia` in m^4."""
    return shape_numbers(section)[1] * inertia**0.25


def section_modulus(section: Any, inertia: Any) -> Any:
    """Elastic section modulus I/h_f [m^3]; `inertia` in m^4."""
    return inertia**0.75 / shape_numbers(section)[1]


def area_for_modulus(section: Any, modulus: Any) -> Any:
    """Area [m^2] of the member with elastic section modulus `modulus` [m^3]."""
    return shape_numbers(section)[0] * inertia_for_modulus(section, modulus) ** 0.5


def inertia_for_modulus(section: Any, modulus: Any) -> Any:
    """Second moment of area [m^4] of the member with elastic section modulus `modulus` [m^3]."""
    return (modulus * shape_numbers(section)[1]) ** (4 / 3)

"""The gear of Table 0.1 of Arreaza (2015), with stiffness and damping about the yaw axis: a benchmark for equations."""

from __future__ import annotations

from typing import Any

import numpy as np

from damperopt import Study
from damperopt.stability.linear import linear_gear

__all__ = ["CARCASS", "GEAR", "TYRE", "assert_printed", "eigenvalues", "table_gear"]

GEAR: dict[str, Any] = {
    "kind": "yaw_bending",
    "yaw_inertia": 100.0,
    "caster_length": 0.12,
    "wheel_radius": 0.362,
    "lateral": {"inertia": 600.0, "stiffness": 6.1e6, "damping": 300.0, "height": 2.5},
}
TYRE: dict[str, Any] = {
    "law": "linear",
    "contact": "leading_point",
    "half_contact_length": 0.1,
    "relaxation_length": 0.3,
    "cornering_slope": 0.014,
    "aligning_coefficient": 1.0,
    "tread_width_moment": 570.0,
}
CARCASS: dict[str, Any] = {
    "law": "stiffness",
    "contact": "leading_point",
    "half_contact_length": 0.1,
    "relaxation_length": 0.3,
    "carcass_stiffness": 1.4e6,
    "tread_width_moment": 570.0,
}
"""A string of this stiffness in the place of the moment-driven tyre of the table."""


def table_gear(stiffness: float = 3.8e5, damping: float = 300.0, tyre: dict[str, Any] = TYRE, **gear: Any) -> Study:
    """The study with keys of its gear changed."""
    return Study.model_validate({
        "name": "T",
        "gear": {**GEAR, **gear},
        "tyre": tyre,
        "damper": {"topology": "rotational", "torsional_stiffness": stiffness, "torsional_damping": damping},
        "envelope": {"speed": {"min": 5.0, "max": 150.0}, "vertical_load": 150e3},
    })  # fmt: skip


def eigenvalues(study: Study, speed: float) -> list[complex]:
    """Those with a positive imaginary part, or none, by falling real part."""
    found = np.linalg.eigvals(linear_gear(study).matrices(speed, 150e3)[0])
    return sorted(found[found.imag >= 0], key=lambda value: -value.real)


def assert_printed(found: list[complex], printed: list[complex]) -> None:
    """Each printed number, of six significant digits in either part, is among those found."""
    for value in printed:
        nearest = min(found, key=lambda other: abs(other - value))
        for mine, theirs in ((nearest.real, value.real), (nearest.imag, value.imag)):
            assert abs(mine - theirs) <= 5.1e-6 * abs(theirs) + 1e-9, (nearest, value)

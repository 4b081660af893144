"""Studies of three gears of no aircraft, one for each layout, and the same gears as plain numbers."""

from __future__ import annotations

from typing import Any

import numpy as np

VARIABLES: dict[str, Any] = {
    "c_lambda": {"start": 2e4, "min": 100.0, "max": 1e6},
    "L": {"start": 0.45, "min": 0.15, "max": 1.2},
    "gamma": {"start": 0.6, "min": 0.1, "max": 1.4},
    "b": {"start": 0.15, "min": 0.02, "max": 0.5},
    "I_arm": {"start": 5e-7, "min": 1e-9, "max": 1e-4},
    "k_lambda": {"start": 2e6, "min": 1e4, "max": 1e9},
}

GEARS: dict[str, dict[str, float]] = {
    "boeing": {"I_z": 18, "e": 0.09, "F_z": 45e3, "C_Fa": 210e3, "a": 0.09, "sigma": 0.24, "R_w": 0.3, "low": 4, "high": 75},
    "utas": {"I_z": 62, "e": 0.1, "F_z": 110e3, "C_Fa": 390e3, "a": 0.11, "sigma": 0.33, "R_w": 0.42, "low": 8, "high": 90},
    "arreaza": {"I_z": 40, "e": 0.11, "F_z": 80e3, "C_Fa": 300e3, "a": 0.1, "sigma": 0.28, "R_w": 0.38, "low": 6, "high": 85},
}
LATERAL = {
    "utas": {"I_x": 420, "k_d": 7e6, "c_d": 9e3, "l_g": 2.1},
    "arreaza": {"I_x": 300, "k_d": 5e6, "c_d": 8e3, "l_g": 1.9},
}
MATERIALS = {"boeing": "300M", "utas": "AISI 4340", "arreaza": "Ti-6Al-4V"}
FORMS: dict[str, tuple[str, str, str]] = {
    "boeing": ("a_frame", "a_frame", "hinge_line"),
    "utas": ("a_frame", "a_frame", "hinge_line"),
    "arreaza": ("cantilever", "cantilever", "strut"),
}
"""Of links, support, and the root of the support."""

MARGIN, RATIO, FRICTION = 0.5, 0.05, 0.7


def study_block(topology: str, starts: int = 4, **requirements: Any) -> dict[str, Any]:
    """YAML of the study of a layout, without decay."""
    g, (links, support, root) = GEARS[topology], FORMS[topology]
    gear: dict[str, Any] = {"kind": "yaw", "yaw_inertia": g["I_z"], "caster_length": g["e"], "wheel_radius": g["R_w"]}
    if topology in LATERAL:
        x = LATERAL[topology]
        lateral = {"inertia": x["I_x"], "stiffness": x["k_d"], "damping": x["c_d"], "height": x["l_g"]}
        gear |= {"kind": "yaw_bending", "lateral": lateral}
    names = ("c_lambda", "L", "gamma", *(("k_lambda",) if topology == "boeing" else ("b", "I_arm")))
    return {
        "name": f"gear of no aircraft, {topology}",
        "gear": gear,
        "tyre": {
            "contact": "leading_point",
            "law": "brush",
            "half_contact_length": g["a"],
            "relaxation_length": g["sigma"],
            "cornering_stiffness": g["C_Fa"],
            "friction": FRICTION,
        },
        "damper": {"topology": topology, "links": {"form": links}, "support": {"form": support, "root": root}},
        "material": MATERIALS[topology],
        "envelope": {"speed": {"min": g["low"], "max": g["high"]}, "vertical_load": g["F_z"]},
        "requirements": {
            "stability_margin": MARGIN,
            "damping_ratio": RATIO,
            "lug_distance": {"min": 0.3, "max": 1.1},
            "reach": {"min": 0.08, "max": 0.4},
            "tyre_clearance": "30 mm",
        }
        | requirements,
        "design": {name: VARIABLES[name] for name in names},
        "solver": {"starts": starts},
    }


def plain_numbers(topology: str) -> dict[str, float]:
    """Of `own_gear.state_matrix`; the trail of a brush is a third of the half contact length."""
    g = GEARS[topology]
    return {**g, **LATERAL.get(topology, {}), "C_Ma": g["C_Fa"] * g["a"] / 3}


def speeds(topology: str, count: int = 80) -> np.ndarray:
    """Of the envelope [m/s]."""
    return np.geomspace(GEARS[topology]["low"], GEARS[topology]["high"], count)

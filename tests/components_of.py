"""Records of gears, tyres and dampers as a study makes them from their blocks, for tests that need no whole study."""

from typing import Any

from pydantic import TypeAdapter

from damperopt.linkages.assembly import assembly_type
from damperopt.study.components import GEAR, TYRE

VARIABLES = {
    "boeing": ("c_lambda", "k_lambda", "L", "gamma"),
    "utas": ("c_lambda", "I_arm", "L", "gamma", "b"),
    "arreaza": ("c_lambda", "I_arm", "L", "gamma", "b"),
    "rotational": (),
}
"""Design variables of the layouts, written out once more."""


TWIN_LAWS = {"arctangent": "nonlinear", "linear": "linear", "stiffness": "straight_tangent"}
"""Slip laws as the basic twin calls them."""


def damper_block(topology: str, **keys: Any) -> dict[str, Any]:
    """Block `damper` of a study; a linkage is seen from the top and rigid, as in the thesis, unless the keys say otherwise."""
    seen = {} if topology == "rotational" else {"geometry": "planar", "compliance": "rigid"}
    return {"topology": topology, **seen, **keys}


def damper_of(**block: Any) -> Any:
    """Layout with damper and joints, of a `damper_block`."""
    return TypeAdapter(assembly_type()).validate_python(damper_block(**block))


def tyre_of(**block: Any) -> Any:
    """Tyre of a block `tyre`."""
    return TypeAdapter(TYRE).validate_python(block)


def gear_of(**block: Any) -> Any:
    """Gear of a block `gear`."""
    return TypeAdapter(GEAR).validate_python(block)


def coefficients_of(damper: Any, design: Any, youngs_modulus: float) -> tuple[float, float]:
    """Torsional stiffness [N m/rad] and damping [N m s/rad] at rest."""
    found = damper.linkage(design, youngs_modulus)
    damping = damper.damping({**design, **found.as_printed}) * found.damper_lever**2
    return float(found.torsional_stiffness), float(damping)


__all__ = ["TWIN_LAWS", "VARIABLES", "coefficients_of", "damper_block", "damper_of", "gear_of", "tyre_of"]

"""The rooms of components that a study chooses from, and what their kinds declare."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

from ..errors import ConfigError
from ..gears.base import Gear
from ..linkages.assembly import assembly_type, dampers, layouts
from ..linkages.torque import CHAIN_STATES, OUTPUTS, ROTARY_OUTPUTS
from ..load_cases.base import load_cases
from ..quantities.kinds import home_of, kinds, one_of
from ..quantities.named import DesignVariable
from ..quantities.record import refuse
from ..tyres.assembly import contact_lines, slip_laws, tyre_type
from ..tyres.base import Tyre

__all__ = [
    "DAMPER",
    "GEAR",
    "ORDERS",
    "TYRE",
    "components",
    "declared_units",
    "description",
    "design_variables",
    "gears",
    "optimisable",
    "rooms",
    "tag_names",
    "unit_of_name",
]


def gears() -> dict[str, type[Gear]]:
    """Gears by kind."""
    return kinds("gears", Gear, "kind")


ORDERS = {kind.ORDER: name for name, kind in gears().items() if kind.ORDER is not None}
"""What older studies call a kind of gear: ``order: 3``."""


def _gear_block(block: dict[str, Any]) -> dict[str, Any]:
    """``order: 5`` as the kind that it means, and a kind that a key of its own asks for."""
    if "order" in block:
        order = block.pop("order")
        if isinstance(order, bool) or order not in ORDERS:
            raise refuse("order", f"{order!r:.40} is no order", " or ".join(map(str, ORDERS)) + ", or kind")
        if block.setdefault("kind", ORDERS[order]) != ORDERS[order] and not _extends(block["kind"], ORDERS[order]):
            raise refuse("order", f"{order} contradicts kind '{block['kind']}'", "one of the two")
    for name, kind in gears().items():
        if kind.EXTENDS is not None and block.get("kind") == kind.EXTENDS[0] and block.get(kind.EXTENDS[1]) is not None:
            return {**block, "kind": name}
    return block


def _extends(kind: str, other: str) -> bool:
    known = gears().get(kind)
    return known is not None and known.EXTENDS is not None and known.EXTENDS[0] == other


GEAR: Any = one_of("gears", Gear, "kind", _gear_block)
TYRE: Any = tyre_type()
DAMPER: Any = assembly_type()


@cache
def rooms() -> dict[str, dict[str, type[Any]]]:
    """Every kind of component by room and tag."""
    return {
        "gears": dict(gears()),
        "slip laws": dict(slip_laws()),
        "contact lines": dict(contact_lines()),
        "linkages": dict(layouts()),
        "dampers": dict(dampers()),
        "load cases": dict(load_cases()),
    }


def components() -> dict[str, dict[str, str]]:
    """Every kind of component by room and tag, with its description.

    Examples
    --------
    >>> components()["contact lines"]["leading_point"]
    'A string led by its foremost contact point; what that point laid down is forgotten at once (straight tangent).'
    """
    return {room: {tag: description(kind) for tag, kind in kinds.items()} for room, kinds in rooms().items()}


def description(kind: type[Any]) -> str:
    """First line of what a kind says of itself."""
    return (kind.__doc__ or "").strip().partition("\n")[0]


def tag_names() -> tuple[str, ...]:
    """Keys that choose a kind."""
    return ("kind", "law", "contact", "topology")


def optimisable() -> tuple[str, ...]:
    """Layouts that have design variables with every damper; others are optimised with a damper that has some."""
    return tuple(topology for topology, layout in layouts().items() if layout.VARIABLES)


@cache
def design_variables() -> dict[str, DesignVariable]:
    """Design variables of all layouts and dampers by name; those of dampers first, as in every table."""
    found: dict[str, DesignVariable] = {}
    kinds_with: list[Any] = [*dampers().values(), *layouts().values()]
    for kind in kinds_with:
        for variable in (*kind.VARIABLES, *kind.SIZES):
            other = found.setdefault(variable.name, variable)
            if other.unit != variable.unit:
                units = f"in {variable.unit}, elsewhere in {other.unit}"
                words = f"design variable '{variable.name}' is declared by {home_of(kind)} {units}"
                raise ConfigError(f"{words}; allowed: one unit for a name")
    return found


DERIVED = {
    "rod_diameter": "m",
    "torsional_stiffness": "N m/rad",
    "torsional_damping": "N m s/rad",
    "time": "s",
    "yaw_acceleration": "rad/s^2",
    "arm_stress": "Pa",
    "unclosed": "m",
    "strut_stroke": "m",
    "mass": "kg",
    "speed": "m/s",
    "vertical_load": "N",
}
"""Units of what no component declares: what follows from a whole design or motion."""


@cache
def declared_units() -> dict[str, str]:
    """SI unit of every design variable, state and output that a component declares, and of what follows from them."""
    units = dict(DERIVED) | {name: variable.unit for name, variable in design_variables().items()}
    named: list[Any] = [*CHAIN_STATES, *OUTPUTS, *ROTARY_OUTPUTS, *Tyre.OUTPUTS]
    for kind in (kind for room in rooms().values() for kind in room.values()):
        named += [*getattr(kind, "STATES", ()), *getattr(kind, "OUTPUTS", ())]
    return units | {quantity.name: quantity.unit for quantity in named}


def unit_of_name(name: str, given: Mapping[str, str] | None = None) -> str:
    """SI unit of a design variable, state or output by its name, as the component that has it declares it.

    Parameters
    ----------
    name : str
    given : mapping of str to str or None
        Units that a result or a motion brings along; they come first.

    Raises
    ------
    KeyError
        If none declares it.
    """
    return (given or {}).get(name) or declared_units()[name]

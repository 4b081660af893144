"""Every kind of component, those of other distributions included."""

from __future__ import annotations

import json
import sys
from typing import Annotated, Any, Literal, get_args, get_origin

import typer

from .shared import out

__all__ = ["components"]

ROOMS = {
    "gears": "gear.kind",
    "slip laws": "tyre.law",
    "contact lines": "tyre.contact",
    "linkages": "damper.topology",
    "dampers": "damper.kind",
    "load cases": "loads.cases",
}
"""Key of a study that chooses from a room."""


def components(
    machine: Annotated[bool, typer.Option("--json", help="As JSON, for programs.")] = False,
) -> None:
    """Every kind of gear, tyre, linkage and damper with its states, design variables and keys."""
    from ..study.components import rooms

    found = {room: {tag: _facts(kind) for tag, kind in kinds.items()} for room, kinds in rooms().items()}
    if machine:
        sys.stdout.write(json.dumps(found, indent=2) + "\n")
        return
    for room, kinds in found.items():
        out.print(f"\n[bold]{room}[/] ({ROOMS[room]})", highlight=False)
        for tag, facts in kinds.items():
            out.print(f"  [bold]{tag}[/]: ", end="", soft_wrap=True)
            out.print(facts["description"], markup=False, soft_wrap=True)
            for words in ("states", "variables", "keys"):
                if facts[words]:
                    names = ", ".join(f"{item['name']} [{item['unit']}]" for item in facts[words])
                    out.print(f"      {words}: {names}", markup=False, soft_wrap=True)


def _facts(kind: Any) -> dict[str, Any]:
    """What a kind declares: description, states, design variables, and keys with units and whether they may be left out."""
    from ..quantities.record import quantity_of
    from ..study.components import description, tag_names

    keys = []
    for name, field in kind.model_fields.items():
        if name in tag_names():
            continue
        quantity = quantity_of(field.annotation, field.metadata)
        choices = " | ".join(map(str, get_args(field.annotation))) if get_origin(field.annotation) is Literal else "block"
        keys.append({"name": name, "unit": quantity.unit if quantity else choices, "required": field.is_required()})
    return {
        "description": description(kind),
        "from": kind.__module__.partition(".")[0],
        "states": [{"name": state.name, "unit": state.unit, "freedom": state.freedom} for state in getattr(kind, "STATES", ())],
        "variables": [
            {"name": v.name, "unit": v.unit, "symbol": v.symbol, "meaning": v.meaning} for v in getattr(kind, "VARIABLES", ())
        ],
        "keys": keys,
    }

"""Layout, damper and joints as the one block `damper` of a study, with the keys of all three side by side."""

from __future__ import annotations

import types
from collections.abc import Mapping
from functools import cache
from typing import Any, ClassVar

from ..dampers.base import Damper
from ..dampers.control import Control, Controlled
from ..errors import ConfigError
from ..expressions.calculus import Expr
from ..ports.linkage import Compliant
from ..quantities.kinds import home_of, kinds, tags_of, union_of
from ..quantities.named import DesignVariable
from ..quantities.record import refuse
from .base import Layout
from .joints import EndStop, Freeplay, Joints, RotaryEndStop, RotaryFreeplay, RotaryJoints

__all__ = ["Assembly", "assemblies", "assembly", "assembly_type", "dampers", "layouts"]


def layouts() -> dict[str, type[Layout]]:
    """Layouts by topology."""
    return kinds("linkages", Layout, "topology")


def dampers() -> dict[str, type[Damper]]:
    """Dampers by kind."""
    return kinds("dampers", Damper, "kind")


class Assembly:
    """What a layout with its damper answers as a whole; every `study.damper` is one."""

    LAYOUT: ClassVar[type[Layout]]
    KIND: ClassVar[type[Damper]]
    VARIABLES: ClassVar[tuple[DesignVariable, ...]]
    """Design variables of damper and layout, in the order of every table and file."""

    def variables(self) -> tuple[DesignVariable, ...]:
        """Design variables with the sizes of the elastic parts, in the order of every table and file."""
        parts: list[Any] = [self.KIND, self.LAYOUT]
        return (*self.VARIABLES, *(size for part in parts for size in part.sizes(self)))

    def is_sized(self, part: str) -> bool:
        """Whether the stiffness of a part of the chain comes from its section."""
        compliance = getattr(self, "compliance", None)
        return compliance is not None and part not in self.given_compliance() and compliance.is_sized(part)

    def elastic_parts(self) -> tuple[str, ...]:
        """Keys of the block ``compliance`` that layout and damper know a section for."""
        parts: list[Any] = [self.LAYOUT, self.KIND]
        return tuple(key for part in parts for key in part.ELASTIC)

    def has_sized_parts(self) -> bool:
        """Whether any part of the chain is elastic by its section: parts are then sized as the elastic chain loads them."""
        return any(map(self.is_sized, self.elastic_parts()))

    def given_compliance(self) -> dict[str, Any]:
        """Stiffnesses that the study gives as numbers, by the names of the parts."""
        compliance = getattr(self, "compliance", None)
        if compliance is None:
            return {}
        given = {
            part: value for part in type(compliance).model_fields if not isinstance(value := getattr(compliance, part), str)
        }
        older = {"link": getattr(self, "link_stiffness", None), "damper": getattr(self, "series_stiffness", None)}
        return given | {part: value for part, value in older.items() if value is not None}

    def elastic(self, design: Mapping[str, Expr], study: Any, stroke: Expr = 0) -> tuple[Compliant, ...]:
        """Parts that give way, of the layout and of the damper."""
        parts: list[Any] = [self.LAYOUT, self.KIND]
        return tuple(part for kind in parts for part in kind.elastic(self, design, study, stroke))

    @property
    def play(self) -> Freeplay | RotaryFreeplay | None:
        """Of the apex joint, or in front of what stands about the yaw axis."""
        return getattr(self, "freeplay", None)

    @property
    def stop(self) -> EndStop | RotaryEndStop | None:
        """Of the damper's stroke."""
        return getattr(self, "end_stop", None)

    @property
    def actuator(self) -> Control | None:
        """Control that acts by a torque of its own; None: there is none, or it commands a current."""
        return None if self.KIND.COMMANDED else getattr(self, "control", None)

    def leaves_out(self) -> tuple[str, ...]:
        """What layout, damper and joints do not hold, in words."""
        parts: list[Any] = [
            part for part in (self.LAYOUT, self.KIND, Joints, RotaryJoints, Controlled) if isinstance(self, part)
        ]
        return tuple(words for part in parts if hasattr(part, "leaves_out") for words in part.leaves_out(self))


@cache
def assembly(layout: type[Layout], damper: type[Damper]) -> type[Any]:
    """Record class of a layout with a damper.

    Parameters
    ----------
    layout, damper : type

    Returns
    -------
    type
        With the fields of both, of control, and of play and stop.

    Raises
    ------
    ConfigError
        If a key belongs to both.
    """
    fields, joints = (set(layout.model_fields), set(damper.model_fields)), {*Joints.model_fields, *Controlled.model_fields}
    if taken := sorted((fields[0] | fields[1]) & joints):
        owner = layout if taken[0] in fields[0] else damper
        raise ConfigError(f"{home_of(owner)} declares '{taken[0]}', which is a key of joints or control; allowed: other names")
    both = fields[0] & fields[1]
    names = [v.name for v in (*damper.VARIABLES, *layout.VARIABLES)]
    twice = sorted(both | {name for name in names if names.count(name) > 1})
    if twice:
        words = f"{home_of(layout)} and {home_of(damper)} both declare '{twice[0]}'"
        raise ConfigError(f"{words}; allowed: each key once")
    bases = (Assembly, layout, damper, RotaryJoints if layout.ROTARY else Joints, Controlled)
    facts = {
        "LAYOUT": layout,
        "KIND": damper,
        "VARIABLES": (*damper.VARIABLES, *layout.VARIABLES),
        "ROTARY": layout.ROTARY,
        "__doc__": f"{layout.__name__} with {damper.__name__}.",
        "__module__": __name__,
        "__annotations__": dict.fromkeys(("LAYOUT", "KIND", "VARIABLES", "ROTARY"), ClassVar[Any]),
    }
    name = f"{layout.__name__}{damper.__name__}"
    if name in globals():  # of a plug-in whose class is called the same
        name += f"_{tags_of(layout, 'topology')[0]}_{tags_of(damper, 'kind')[0]}"
    made = types.new_class(name, bases, {}, lambda namespace: namespace.update(facts))
    globals().setdefault(name, made)  # where pickle looks for it
    return made


@cache
def assemblies() -> dict[str, type[Any]]:
    """Every layout with every damper that goes with it, by ``topology kind``."""
    return {
        f"{topology} {kind}": assembly(layout, damper)
        for topology, layout in layouts().items()
        for kind, damper in dampers().items()
        if layout.ROTARY == damper.ROTARY
    }


def assembly_type() -> Any:
    """Field type of a study's block `damper`, with its JSON Schema."""
    return union_of(assemblies(), ("topology", "kind"), _prepared)


def _prepared(block: dict[str, Any]) -> dict[str, Any]:
    """With the kind of the damper written out."""
    topology = block.get("topology")
    layout = layouts().get(topology) if isinstance(topology, str) else None
    if layout is None:
        raise refuse("topology", "missing key" if topology is None else f"'{topology}' is unknown", ", ".join(layouts()))
    kind = block.setdefault("kind", layout.DAMPER)
    fitting = [name for name, damper in dampers().items() if damper.ROTARY == layout.ROTARY]
    if kind not in fitting:
        known = isinstance(kind, str) and kind in dampers()
        what = f"'{kind}' does not go with topology '{topology}'" if known else f"'{kind}' is unknown"
        raise refuse("kind", what, ", ".join(fitting))
    return block

"""Mass of a damper layout, part by part, sized by the limit event.

Everything is closed form in the design variables but for the sizes on which several limits act at once, such as the rod
diameter of a cylinder: those are variables of their own (mass grows with them, so the largest limit is met exactly).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .errors import ConfigError
from .ports.linkage import Linkage
from .ports.sizing import Capacity, LimitEvent, Size, Sized
from .strength.limit_event import limit_event
from .strength.sizes import RELAXED, member_sizes

__all__ = ["RELAXED", "SizedLayout", "limit_event", "member_sizes", "sized_layout"]


@dataclass(frozen=True)
class SizedLayout:
    """A layout with its damper under the limit event; expressions.

    Attributes
    ----------
    event : LimitEvent
    masses : mapping of str to Expr
        Part -> mass [kg], fittings included.
    sizes : tuple of Size
        Sizes that the masses hang on, to be chosen.
    needed_length : Expr or None
        Pin-to-pin length that the damper needs [m].
    capacities : tuple of Capacity
        Of a damper of given size.
    """

    event: LimitEvent
    masses: Mapping[str, Any]
    sizes: tuple[Size, ...]
    needed_length: Any
    capacities: tuple[Capacity, ...] = ()


def sized_layout(study: Any, design: Mapping[str, Any], linkage: Linkage, load: Any, factors: Any) -> SizedLayout:
    """Mass by part of a layout whose parts carry the limit event.

    Parameters
    ----------
    study : Study
        Floats or symbols.
    design : mapping of str to Expr
        Design variables by name [SI].
    linkage : Linkage
    load : Expr
        The largest vertical load of the envelope [N].
    factors : sequence of Expr
        (5,) of `limit_event`.

    Returns
    -------
    SizedLayout

    Raises
    ------
    ConfigError
        If the damper has no mass model.
    """
    event = limit_event(study, linkage, design, load, factors)
    damper: Sized | None = study.damper.parts(event, study.mass)
    if damper is None:
        raise ConfigError(
            f"damper.kind: '{study.damper.kind}' has no mass model; allowed: a kind that sizes its parts (or 'analyse')"
        )
    masses = {**study.damper.masses(design, event, study), **damper.masses}
    if study.damper.actuator is not None and study.damper.actuator.mass is not None:
        masses["actuator"] = study.damper.actuator.mass
    sizes = (*member_sizes(study, design, event), *damper.sizes)
    return SizedLayout(event, masses, sizes, damper.length, damper.capacities)

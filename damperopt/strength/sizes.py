"""Sections of members that are design variables, and what asks for them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..expressions.calculus import Expr
from ..ports.sizing import LimitEvent, Size
from .members import least_sections

__all__ = ["RELAXED", "member_sizes"]

RELAXED = {
    "limit": ("requirements.limit_factor", "loads"),
    "ultimate": ("requirements.ultimate_factor", "loads"),
    "wall": ("requirements.ultimate_factor", "mass", "loads"),
    "lateral": ("requirements.ultimate_factor", "mass", "loads"),
    "buckling": ("requirements.ultimate_factor", "loads"),
    "fatigue": ("requirements.fatigue.spectrum", "loads"),
}
"""What would relax each check of a section."""


def member_sizes(study: Any, design: Mapping[str, Expr], event: LimitEvent) -> list[Size]:
    """Sections of members that are design variables, with the least that strength asks of each.

    Parameters
    ----------
    study : Study
    design : mapping of str to Expr
    event : LimitEvent

    Returns
    -------
    list of Size
        Named by their variables; members that share one are sized by the first of them.
    """
    declared = {variable.name: variable for variable in study.damper.variables()}
    found: dict[str, Size] = {}
    for member in study.damper.members(design):
        if member.variable and member.variable not in found:
            name, unit = member.variable, declared[member.variable].unit
            least = least_sections(member, event, study).items()
            limits = {f"{member.kind}_{check}": (value, RELAXED[check]) for check, value in least}
            found[name] = Size(name, unit, design[name], limits)
    return list(found.values())

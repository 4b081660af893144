"""Figures: each function takes a record, computes nothing, and returns a figure; a module is loaded when its name is used."""

from __future__ import annotations

from importlib import import_module
from typing import Any

_HOME = {
    "cycle_map": "limit_cycles",
    "cycles": "limit_cycles",
    "decay": "motion",
    "loop_loci": "loop",
    "loop_margins": "loop",
    "mass_by_part": "design",
    "modes_before_after": "modes",
    "modes_over_speed": "modes",
    "region": "design",
    "plain": "style",
    "save": "style",
    "save_each": "style",
    "styled": "style",
    "sweep_figure": "sweep",
    "threshold": "limit_cycles",
    "tornado": "design",
    "roll": "motion",
    "trajectory": "motion",
    "tyre_over_load": "tyre",
    "tyre_over_path": "tyre",
    "tyre_over_slip": "tyre",
}
"""Module of each public function; that of a chart is `chart.chart`, that of a linkage `linkage.linkage`."""

__all__ = sorted(_HOME)  # one list, not two


def __getattr__(name: str) -> Any:
    """Public functions, and matplotlib with them, are imported when they are used."""
    if name in _HOME:
        return getattr(import_module(f".{_HOME[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__

"""Figures: from a record and axes to axes."""

from __future__ import annotations

from .style import decay, mass_by_part, modes_before_after, modes_over_speed, region, save, styled, tornado, trajectory

__all__ = [
    "decay",
    "mass_by_part",
    "modes_before_after",
    "modes_over_speed",
    "region",
    "save",
    "styled",
    "tornado",
    "trajectory",
]

"""A tyre: force and moment over slip, lengths and stiffnesses over load."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from ..quantities.shown import axis_label, scale
from ..tyres.curves import TyreCurves
from .style import plain, styled

__all__ = ["tyre_over_load", "tyre_over_slip"]

LENGTHS = {"relaxation_length": "relaxation length", "half_contact_length": "half contact length", "pneumatic_trail": "trail"}
SLOPES = {"cornering_stiffness": "Cornering stiffness", "aligning_stiffness": "Aligning stiffness"}


def tyre_over_slip(record: TyreCurves) -> Any:
    """Side force and aligning moment over the slip angle, a curve for each load.

    Parameters
    ----------
    record : TyreCurves

    Returns
    -------
    matplotlib Figure
    """
    with styled():
        figure, axes = plt.subplots(1, 2, figsize=(10, 4.2))
        colours = plt.get_cmap("viridis")(np.linspace(0.05, 0.85, len(record.drawn)))
        panels = (("Side force", "N", record.force), ("Aligning moment", "N m", record.moment))
        for axis, (words, unit, values) in zip(axes, panels, strict=True):
            for load, curve, colour in zip(record.drawn, values, colours, strict=True):
                axis.plot(np.degrees(record.slips), scale(unit)[1] * curve, color=colour, label=f"{load / 1e3:.4g} kN")
            axis.set_xlabel(axis_label("Slip angle", "rad"))
            axis.set_ylabel(axis_label(words, unit))
            axis.margins(x=0)
        axes[0].legend(title="Load", frameon=False, fontsize=8)
        figure.suptitle(plain(record.name), fontsize=11)
        return figure


def tyre_over_load(record: TyreCurves) -> Any:
    """Relaxation length, half contact length and trail over the load, and the slopes of force and moment.

    Parameters
    ----------
    record : TyreCurves

    Returns
    -------
    matplotlib Figure
    """
    with styled():
        figure, axes = plt.subplots(1, 3, figsize=(12, 4))
        line: dict[str, Any] = {"marker": "o" if len(record.loads) == 1 else "", "lw": 1.8}
        for name, words in LENGTHS.items():
            values = record.table[name].values
            if np.isfinite(values).any():
                axes[0].plot(record.loads / 1e3, scale("m")[1] * values, label=words, **line)
        axes[0].set_ylabel(axis_label("Length", "m"))
        axes[0].legend(frameon=False, fontsize=8)
        for axis, (name, words) in zip(axes[1:], SLOPES.items(), strict=True):
            column = record.table[name]
            axis.plot(record.loads / 1e3, scale(column.unit)[1] * column.values, color="#0b6e99", **line)
            axis.set_ylabel(axis_label(words, column.unit))
        for axis in axes:
            axis.set_xlabel("Load of a wheel [kN]")
            axis.set_ylim(bottom=0)
        figure.suptitle(plain(record.name), fontsize=11)
        return figure

"""A tyre: force and moment over slip, lengths and stiffnesses over load."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from ..quantities.shown import axis_label, scale
from ..tyres.curves import TyreCurves
from ..tyres.path_response import RESPONSES
from .style import plain, styled

__all__ = ["tyre_over_load", "tyre_over_path", "tyre_over_slip"]

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


def tyre_over_path(record: TyreCurves) -> Any:
    """Response of force and moment to a swivel over path frequency, and how far each contact line is from the exact one.

    Parameters
    ----------
    record : TyreCurves
        With a response.

    Returns
    -------
    matplotlib Figure
    """
    found = record.response
    assert found is not None
    names = list(RESPONSES)
    with styled():
        figure, axes = plt.subplots(2, 2, figsize=(11, 7), sharex=True)
        colours = plt.get_cmap("tab10")(np.arange(len(found.lines)))
        for (line, values), colour in zip(found.lines.items(), colours, strict=True):
            exact = line == "memory"
            look: dict[str, Any] = {"color": "black" if exact else colour, "lw": 2.4 if exact else 1.4, "label": line}
            for column, name in enumerate(("F/theta", "M/theta")):
                k = names.index(name)
                axes[0, column].loglog(found.frequencies, scale(RESPONSES[name])[1] * np.abs(values[k]), **look)
                if not exact:
                    worst = found.errors(line)[k : k + 2].max(axis=0)
                    axes[1, column].loglog(found.frequencies, 100 * worst, **look)
        for column, words in enumerate(("Side force", "Aligning moment")):
            unit = RESPONSES[("F/theta", "M/theta")[column]]
            axes[0, column].set_ylabel(axis_label(f"{words} per swivel", unit))
            axes[1, column].set_ylabel(f"{words}: off memory [%]")
            axes[1, column].set_ylim(0.1, 1000)
            axes[1, column].axhline(10, color="0.5", lw=0.8, ls="--")
            axes[1, column].set_xlabel("Path frequency, 2 pi/wavelength [rad/m]")
            for axis in axes[:, column]:
                axis.margins(x=0)
            product = float(found.frequencies[0] * found.contact_lengths[0])
            turned = lambda x, p=product: p / np.maximum(x, 1e-12)  # noqa: E731  # its own inverse
            above = axes[0, column].secondary_xaxis("top", functions=(turned, turned))
            above.set_xlabel("Contact lengths per wave")
            above.set_xticks([50, 16, 8, 4, 2], ["50", "16", "8", "4", "2"])
            above.minorticks_off()
        axes[0, 0].legend(title="Contact line", frameon=False, fontsize=8)
        figure.suptitle(f"{plain(record.name)}, {found.load / 1e3:.4g} kN", fontsize=11)
        return figure

"""Modes over speed: of one gear, and before and after."""

from __future__ import annotations

from itertools import cycle
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import NullLocator

from ..quantities.shown import written
from ..stability.modes import ModeTable
from .style import COLOURS, OTHERS, plain, styled

__all__ = ["modes_before_after", "modes_over_speed"]


def modes_over_speed(table: ModeTable, margin: float = 0.0, title: str = "", axes: Any = None) -> Any:
    """Real part and frequency of the modes over speed, unstable speeds shaded.

    Parameters
    ----------
    table : ModeTable
    margin : float
        Stability margin, drawn as a line [1/s].
    title : str
        Title of the upper panel.
    axes : array of Axes or None
        Two axes, for real part and frequency.

    Returns
    -------
    Figure
    """
    with styled():
        if axes is None:
            _, axes = plt.subplots(2, 1, sharex=True, figsize=(7, 6), height_ratios=[3, 2])
        _draw_modes(table, margin, title, axes)
        _limits(axes, [table], margin)
        _legend(axes[0].figure, axes[:1])
        return axes[0].figure


def _draw_modes(table: ModeTable, margin: float, title: str, axes: Any) -> None:
    upper, lower = axes
    line: dict[str, Any] = {"lw": 1.8, "marker": "o" if len(table.speeds) == 1 else ""}
    for name, colour in _colours(table).items():
        columns = [j for j, n in enumerate(table.names) if n == name]
        for j in columns:
            label = plain(name) if j == columns[0] else None
            upper.plot(table.speeds, table.eigenvalues[:, j].real, color=colour, label=label, **line)
            if name != "string":
                oscillating = np.abs(table.eigenvalues[:, j].imag) > 1e-6
                lower.plot(table.speeds, np.where(oscillating, table.frequency[:, j], np.nan), color=colour, **line)
    _shade(upper, table, margin)
    upper.axhline(0, color="black", lw=0.8)
    if margin > 0:
        upper.axhline(-margin, color="#a11d33", lw=1.2, ls="--", label=f"margin {margin:g} 1/s")
    linear = max(margin, 0.1)
    upper.set_yscale("asinh", linear_width=linear)
    decades = 10.0 ** np.arange(np.ceil(np.log10(linear)), 7)  # the scale's own ticks crowd its linear part
    upper.set_yticks([*-decades[::-1], 0, *decades], [f"{tick:g}" for tick in (*-decades[::-1], 0, *decades)])
    upper.yaxis.set_minor_locator(NullLocator())
    upper.set_ylabel("Real part of the eigenvalues [1/s]")
    upper.set_title(plain(title), fontsize=10)
    lower.set_ylabel("Frequency [Hz]")
    lower.set_xlabel("Speed [m/s]")


def _colours(table: ModeTable) -> dict[str, str]:
    """Colour of every mode that the table has, those of COLOURS first."""
    names = [name for name in COLOURS if name in table.names]
    others = [name for name in dict.fromkeys(table.names) if name not in COLOURS]
    return {name: COLOURS[name] for name in names} | dict(zip(others, cycle(OTHERS), strict=False))


def _limits(axes: Any, tables: list[ModeTable], margin: float) -> None:
    """Limits that hold every table: panels side by side share them."""
    real = np.concatenate([table.eigenvalues.real.ravel() for table in tables])
    linear = max(margin, 0.1)
    axes[0].set_ylim(1.5 * min(real.min(), 0) - linear, 1.5 * max(real.max(), 0) + 2 * linear)
    oscillating = [table.frequency[:, [name != "string" for name in table.names]].max() for table in tables]
    axes[1].set_ylim(0, 1.15 * max(*oscillating, 0.1))


def _legend(figure: Any, axes: Any) -> None:
    """One legend below the figure for what the axes show, each entry once."""
    entries: dict[str, Any] = {}
    for axis in axes:
        handles, labels = axis.get_legend_handles_labels()
        entries |= dict(zip(labels, handles, strict=True))
    figure.legend(entries.values(), entries.keys(), loc="outside lower center", ncols=6, frameon=False)


def _shade(axis: Any, table: ModeTable, margin: float) -> None:
    """Unstable speeds in red; stable ones that miss the margin in yellow."""
    abscissa = table.abscissa
    for inside, colour, label in (
        (abscissa >= 0, "#f2c4c4", "unstable"),
        ((abscissa < 0) & (abscissa > -margin * (1 + 1e-6)), "#f7ebc0", "margin missed"),
    ):
        if inside.any():
            axis.fill_between(
                table.speeds,
                0,
                1,
                where=inside,
                transform=axis.get_xaxis_transform(),
                color=colour,
                lw=0,
                label=label,
                step="mid",
            )


def modes_before_after(before: ModeTable, after: ModeTable, margin: float) -> Any:
    """Modes of the start and of the optimum side by side; returns the Figure."""
    with styled():
        figure, axes = plt.subplots(2, 2, sharex=True, sharey="row", figsize=(10, 6), height_ratios=[3, 2])
        _draw_modes(before, margin, "Before: start of the study", axes[:, 0])
        _draw_modes(after, margin, "After: optimum", axes[:, 1])
        _limits(axes[:, 0], [before, after], margin)
        _legend(figure, axes[0])
        for axis in axes[:, 1]:
            axis.set_ylabel("")
        figure.suptitle(f"Modes over speed at {written(load=after.load)}", fontsize=11)
        return figure

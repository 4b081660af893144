"""Branches of limit cycles: amplitude, frequency and the largest multiplier over what is varied."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from ..cycles.amplitude_map import AmplitudeMap
from ..cycles.edge import Threshold
from ..cycles.orbit import Branch
from ..quantities.shown import axis_label, scale
from .style import COLOURS, OTHERS, plain, quantity_words, styled

__all__ = ["cycle_map", "cycles", "threshold"]

MARKS = {"fold": "o", "Neimark-Sacker": "s", "period doubling": "D", "loss of symmetry": "^"}


def cycles(branches: Sequence[Branch], title: str = "") -> Any:
    """Amplitude of the yaw angle, frequency, and the largest Floquet multiplier; stable full, unstable dashed.

    Parameters
    ----------
    branches : sequence of Branch
        Of one question, at least one.
    title : str

    Returns
    -------
    matplotlib Figure
    """
    unit, factor = branches[0].unit, scale(branches[0].unit)[1]
    degrees = scale("rad")[1]
    rows = (
        (axis_label("Amplitude of yaw", "rad"), lambda orbit: degrees * orbit.amplitudes["yaw_angle"]),
        ("Frequency [Hz]", lambda orbit: orbit.frequency),
        ("Largest multiplier [1]", lambda orbit: float(np.abs(orbit.multipliers).max())),
    )
    colours = (*COLOURS.values(), *OTHERS)
    with styled():
        figure, panels = plt.subplots(len(rows), sharex=True, figsize=(8, 7.5))
        for panel, (label, value) in zip(panels, rows, strict=True):
            for branch, colour in zip(branches, colours * len(branches), strict=False):
                points = [(factor * orbit.parameter, value(orbit), orbit.stable) for orbit in branch.orbits]
                for before, after in zip(_runs(points), [*_runs(points)[1:], []], strict=True):
                    part = np.array([point[:2] for point in [*before, *after[:1]]])
                    panel.plot(*part.T, color=colour, ls="-" if before[0][2] else "--", lw=1.4)
                for orbit in branch.special:
                    at = factor * orbit.parameter, value(orbit)
                    panel.plot(*at, MARKS.get(orbit.label, "x"), color=colour, ms=5, label=orbit.label)
            panel.set_ylabel(label)
            panel.margins(x=0)
        panels[0].set_ylim(bottom=0)
        panels[2].axhline(1, color="#333333", ls=":", lw=1)
        kinds = dict(zip(*reversed(panels[0].get_legend_handles_labels()), strict=True))
        if kinds:
            panels[0].legend(kinds.values(), kinds.keys(), frameon=False, fontsize=8)
        panels[-1].set_xlabel(axis_label(quantity_words(branches[0].name), unit))
        figure.align_ylabels(panels)
        figure.suptitle(plain(title) + ("\n" if title else "") + "stable: full, unstable: dashed", fontsize=10)
        return figure


def _runs(points: Sequence[tuple[float, float, bool]]) -> list[list[tuple[float, float, bool]]]:
    """Neighbours of one stability."""
    return [list(run) for _, run in groupby(points, key=lambda point: point[2])]


def threshold(found: Sequence[Threshold], kind: str, unit: str, title: str = "") -> Any:
    """Largest disturbance that dies over speed, with the least that was seen not to.

    Parameters
    ----------
    found : sequence of Threshold
    kind : str
        ``release`` or ``kick``.
    unit : str
        SI unit of the disturbance.
    title : str

    Returns
    -------
    matplotlib Figure
    """
    factor = scale(unit)[1]
    with styled():
        figure, axis = plt.subplots(figsize=(8, 4.5))
        speeds = [t.speed for t in found]
        for values, label, colour in (
            ([t.dies for t in found], "dies", COLOURS["torsional"]),
            ([t.not_dies for t in found], "does not die", COLOURS["lateral"]),
        ):
            axis.plot(
                speeds, [np.nan if v is None else factor * v for v in values], "o-", ms=3, lw=1.2, color=colour, label=label
            )
        axis.set(xlabel="Speed [m/s]", ylabel=axis_label(f"{kind.capitalize()} of yaw", unit))
        axis.set_ylim(bottom=0)
        axis.legend(frameon=False)
        axis.set_title(plain(title), fontsize=10)
        return figure


def cycle_map(found: AmplitudeMap, title: str = "") -> Any:
    """Amplitude of yaw of the largest stable limit cycle over two quantities; white where there is none, grey: not known.

    Parameters
    ----------
    found : AmplitudeMap
    title : str

    Returns
    -------
    matplotlib Figure
    """
    x, y = (scale(axis.unit)[1] * values for axis, values in ((found.x, found.columns), (found.y, found.rows)))
    yaw = np.where(found.yaw > 0, scale("rad")[1] * found.yaw, np.nan)
    with styled():
        figure, axis = plt.subplots(figsize=(8, 5))
        axis.grid(False)
        unknown = np.where(found.lost & (found.yaw == 0), 0.7, np.nan)
        axis.pcolormesh(x, y, unknown, shading="nearest", cmap="gray", vmin=0, vmax=1)
        mesh = axis.pcolormesh(x, y, yaw, shading="nearest", cmap="viridis")
        figure.colorbar(mesh, ax=axis, label=axis_label("Amplitude of yaw", "rad"))
        axis.set_xlabel(axis_label(quantity_words(found.x.name), found.x.unit))
        axis.set_ylabel(axis_label(quantity_words(found.y.name), found.y.unit))
        axis.set_title(plain(title), fontsize=10)
        return figure

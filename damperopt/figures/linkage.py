"""The linkage to scale, from the side and from above: where its parts lie in the frame of the theory page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from .style import styled

__all__ = ["Part", "linkage", "parts_of"]

MM = 1e3
WIDTHS = {"link": 7.0, "support": 6.0, "damper": 5.0, "arm": 2.5}
"""The thinnest in front: from some side parts lie behind each other."""

COLOURS = {"link": "#4a4a4a", "arm": "#0b6e99", "damper": "#c2571a", "support": "#7a5195"}


@dataclass(frozen=True)
class Part:
    """A straight part between two points (x aft, y to the side, z up the strut; origin at the strut axis, apex height) [m]."""

    name: str
    kind: str
    start: tuple[float, float, float]
    end: tuple[float, float, float]


def parts_of(topology: str, design: Mapping[str, float]) -> list[Part]:
    """Parts of a layout at rest.

    Parameters
    ----------
    topology : str
        ``boeing``, ``utas`` or ``arreaza``.
    design : mapping
        ``L``, ``gamma`` and, but for Boeing, ``b`` [SI].

    Returns
    -------
    list of Part
    """
    reach, h_0 = design["L"] * np.sin(design["gamma"]), design["L"] * np.cos(design["gamma"])
    apex, lower, upper = (reach, 0.0, 0.0), (0.0, 0.0, -h_0), (0.0, 0.0, h_0)
    lower_link = Part("lower torque link", "link", lower, apex)
    if topology == "boeing":
        gap = 0.05 * reach
        return [
            lower_link,
            Part("upper torque link", "link", upper, apex),
            Part("damper at the apex", "damper", (reach, -gap, 0.0), (reach, gap, 0.0)),
        ]
    b = design["b"]
    if topology == "utas":
        return [lower_link, Part("bending arm", "arm", (0.0, b, h_0), apex), Part("damper", "damper", (0.0, -b, h_0), apex)]
    support = (reach, -b, 0.0)
    return [
        lower_link,
        Part("bending arm", "arm", upper, apex),
        Part("rigid support", "support", (0.0, -b, h_0), support),
        Part("damper", "damper", support, apex),
    ]


def linkage(topology: str, design: Mapping[str, float]) -> Any:
    """Side and top view in one scale.

    Parameters
    ----------
    topology : str
    design : mapping
        [SI]

    Returns
    -------
    matplotlib Figure
    """
    parts = parts_of(topology, design)
    points = MM * np.array([point for part in parts for point in (part.start, part.end)])
    low, high = points.min(axis=0), points.max(axis=0)
    room = 0.15 * (high - low).max()
    span = max(high[1] - low[1], high[2] - low[2]) + 2 * room  # of both views, so that their scale is one
    with styled():
        figure, axes = plt.subplots(1, 2, figsize=(9, 4.8), width_ratios=[1, 1])
        for axis, across, view in ((axes[0], 2, "Side"), (axes[1], 1, "Top")):
            for part in parts:
                a, b = MM * np.array(part.start), MM * np.array(part.end)
                look = {"lw": WIDTHS[part.kind], "zorder": 9 - WIDTHS[part.kind], "color": COLOURS[part.kind]}
                axis.plot([a[0], b[0]], [a[across], b[across]], "-", solid_capstyle="round", **look)
                axis.plot([a[0], b[0]], [a[across], b[across]], "o", ms=4, mfc="white", mec=COLOURS[part.kind], zorder=9)
            axis.axvline(0, color="#888888", lw=1, ls="-.") if across == 2 else axis.plot(0, 0, "+", ms=14, color="#888888")
            middle = (low[across] + high[across]) / 2
            axis.set(xlabel="x, aft of the strut axis [mm]", ylabel=f"{'z, up' if across == 2 else 'y, to the side'} [mm]")
            axis.set(ylim=(middle - span / 2, middle + span / 2), xlim=(low[0] - room, high[0] + room), title=view)
            axis.set_aspect("equal", adjustable="box")
        shown = {part.name: COLOURS[part.kind] for part in parts}
        handles = [plt.Line2D([], [], color=colour, lw=4) for colour in shown.values()]
        handles.append(plt.Line2D([], [], color="#888888", lw=1, ls="-."))
        figure.legend(handles, [*shown, "strut axis"], loc="outside lower center", ncols=5, frameon=False)
        return figure

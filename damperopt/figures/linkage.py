"""The linkage to scale, from the side and from above: where its parts lie in the frame of the theory page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from ..linkages.assembly import layouts
from ..linkages.base import Layout
from .style import plain, styled

__all__ = ["linkage"]

MM = 1e3
WIDTHS = {"link": 7.0, "support": 6.0, "hinge": 6.0, "damper": 5.0, "arm": 2.5}
"""The thinnest in front: from some side parts lie behind each other."""

COLOURS = {"link": "#4a4a4a", "arm": "#0b6e99", "hinge": "#3a7d44", "damper": "#c2571a", "support": "#7a5195"}


def linkage(layout: Layout | str, design: Mapping[str, float]) -> Any:
    """Side and top view in one scale.

    Parameters
    ----------
    layout : Layout or str
        The damper of a study, or a topology.
    design : mapping
        Design variables by name [SI].

    Returns
    -------
    matplotlib Figure
    """
    if isinstance(layout, str):
        layout = layouts()[layout].model_construct(topology=layout)
    parts = layout.members(design)
    if not parts:
        raise ValueError(f"layout '{layout.topology}' has no members to draw")
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
        shown = {part.name.partition(",")[0]: COLOURS[part.kind] for part in parts}  # legs by the part they belong to
        handles = [plt.Line2D([], [], color=colour, lw=4) for colour in shown.values()]
        handles.append(plt.Line2D([], [], color="#888888", lw=1, ls="-."))
        figure.legend(handles, [*map(plain, shown), "strut axis"], loc="outside lower center", ncols=5, frameon=False)
        return figure

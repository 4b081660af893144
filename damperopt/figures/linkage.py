"""The linkage to scale, from the side, from above and from behind: where its parts lie in the frame of the theory page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from ..linkages.assembly import layouts
from ..linkages.base import Layout
from ..ports.linkage import Member
from .style import plain, styled

__all__ = ["hinge_lines", "linkage"]

MM = 1e3
WIDTHS = {"link": 7.0, "support": 6.0, "beam": 6.0, "hinge": 6.0, "foot": 6.0, "damper": 5.0, "arm": 2.5}
"""The thinnest in front: from some side parts lie behind each other."""

HINGE = "#888888"
"""Of the lines about which parts turn at the strut."""

TOUCHES = 1e-9
"""Distance that is none [m]."""

VIEWS = (
    ("Side", 0, 2, "x, aft of the strut axis [mm]", "z, up [mm]"),
    ("Top", 0, 1, "x, aft of the strut axis [mm]", "y, to the side [mm]"),
    ("From behind", 1, 2, "y, to the side [mm]", "z, up [mm]"),
)
"""Title, coordinates along both axes of the figure, and their names."""

COLOURS = {
    "link": "#4a4a4a",
    "arm": "#0b6e99",
    "beam": "#3a7d44",
    "hinge": "#3a7d44",
    "foot": "#3a7d44",
    "damper": "#c2571a",
    "support": "#7a5195",
}


def linkage(layout: Layout | str, design: Mapping[str, float]) -> Any:
    """Views from the side, from above and from behind in one scale.

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
    span = (high - low).max() + 2 * room  # of all views, so that their scale is one
    with styled():
        figure, axes = plt.subplots(1, 3, figsize=(12, 4.8))
        for axis, (title, i, j, x_label, y_label) in zip(axes, VIEWS, strict=True):
            for ends in hinge_lines(parts):
                axis.plot(MM * ends[:, i], MM * ends[:, j], "--", color=HINGE, lw=1.2, zorder=1)
            for part in parts:
                a, b = MM * np.array(part.start), MM * np.array(part.end)
                look = {"lw": WIDTHS[part.kind], "zorder": 9 - WIDTHS[part.kind], "color": COLOURS[part.kind]}
                axis.plot([a[i], b[i]], [a[j], b[j]], "-", solid_capstyle="round", **look)
                axis.plot([a[i], b[i]], [a[j], b[j]], "o", ms=4, mfc="white", mec=COLOURS[part.kind], zorder=9)
            axis.axvline(0, color="#888888", lw=1, ls="-.") if j == 2 else axis.plot(0, 0, "+", ms=14, color="#888888")
            middle = (low + high) / 2
            axis.set(xlabel=x_label, ylabel=y_label, title=title)
            axis.set(xlim=(middle[i] - span / 2, middle[i] + span / 2), ylim=(middle[j] - span / 2, middle[j] + span / 2))
            axis.set_aspect("equal", adjustable="box")
        shown = {part.name.partition(",")[0]: COLOURS[part.kind] for part in parts}  # legs by the part they belong to
        handles = [plt.Line2D([], [], color=colour, lw=4) for colour in shown.values()]
        words = [*map(plain, shown), "strut axis"]
        handles.append(plt.Line2D([], [], color="#888888", lw=1, ls="-."))
        if len(hinge_lines(parts)):
            handles.append(plt.Line2D([], [], color=HINGE, lw=1.2, ls="--"))
            words.append("hinge axes")
        figure.legend(handles, words, loc="outside lower center", ncols=7, frameon=False)
        return figure


def hinge_lines(parts: Sequence[Member]) -> list[np.ndarray]:
    """Lines across the strut through the feet of members, one for each height at which feet stand apart.

    Parameters
    ----------
    parts : sequence of Member

    Returns
    -------
    list of ndarray
        (2, 3) ends [m].
    """
    feet: dict[float, list[tuple[float, ...]]] = {}
    for part in parts:
        start = tuple(map(float, part.start))
        if abs(start[0]) < TOUCHES and not part.is_beam:
            feet.setdefault(round(start[2], 9), []).append(start)
    ends = [np.array([min(at, key=lambda p: p[1]), max(at, key=lambda p: p[1])]) for at in feet.values()]
    return [line for line in ends if np.ptp(line[:, 1]) > TOUCHES]

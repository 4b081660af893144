"""A design: its mass by part, what the mass depends on, and what bounds it."""

from __future__ import annotations

from itertools import cycle
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from ..optimum.region import FeasibleRegion
from ..quantities.shown import axis_label, scale
from ..results import DesignResult
from ..study.components import unit_of_name
from .style import plain, quantity_words, styled

__all__ = ["bounding", "mass_by_part", "region", "tornado"]

OTHERS = (("#8c510a", "--"), ("#5e3c99", "-."), ("#1b7837", ":"), ("#c51b7d", (0, (5, 1, 1, 1))), ("#555555", (0, (1, 1))))
"""Looks of limits that have none of their own."""

LIMITS = {
    "decay_ratio": ("decay", "#00798c", "-"),
    "arm_stress": ("arm stress", "#333333", "--"),
    "arm_fatigue": ("arm fatigue", "#7a5195", ":"),
    "working_stroke": ("working stroke", "#2f6b3a", "-."),
    "damper_length": ("damper length", "#b36b00", (0, (5, 1, 1, 1))),
}


def mass_by_part(result: DesignResult, axis: Any = None) -> Any:
    """Horizontal bars of the mass by part of a result that holds a design; returns the Figure."""
    if result.mass is None:
        raise ValueError(f"no design to draw: {result.message}")
    with styled():
        if axis is None:
            _, axis = plt.subplots(figsize=(7, 0.6 * len(result.mass.parts) + 1.4))
        parts = dict(sorted(result.mass.parts.items(), key=lambda item: item[1]))
        bars = axis.barh([plain(part) for part in parts], list(parts.values()), color="#0b6e99", height=0.6)
        axis.bar_label(bars, [f"{mass:.2f} kg" for mass in parts.values()], padding=4)
        axis.margins(x=0.15)
        axis.grid(axis="y", visible=False)
        axis.set_xlabel("Mass [kg]")
        axis.set_title(f"{plain(result.topology)}, {plain(result.material)}: {result.mass.total:.2f} kg", fontsize=10)
        return axis.figure


def tornado(result: DesignResult, shown: int = 12) -> Any:
    """Change of mass for one per cent of each input, the largest first; returns the Figure."""
    strongest = [s for s in result.sensitivities if s.value != 0][:shown][::-1]
    with styled():
        figure, axis = plt.subplots(figsize=(7, 0.3 * len(strongest) + 1.2))
        slopes = [s.elasticity for s in strongest]
        colours = ["#a11d33" if slope > 0 else "#2f6b3a" for slope in slopes]
        bars = axis.barh([plain(s.input) for s in strongest], slopes, color=colours, height=0.65)
        axis.bar_label(bars, [f"{slope:+.3g} %" for slope in slopes], padding=3, fontsize=8)
        axis.axvline(0, color="#333333", lw=0.8)
        axis.margins(x=0.18)
        axis.grid(axis="y", visible=False)
        axis.set_xlabel("Change of mass for +1 % of the input [%]")
        return figure


def bounding(record: FeasibleRegion) -> list[str]:
    """Limits that are broken one step beyond the feasible designs.

    Parameters
    ----------
    record : FeasibleRegion

    Returns
    -------
    list of str
    """
    inside = np.pad(record.feasible, 1)
    beside = inside[:-2, 1:-1] | inside[2:, 1:-1] | inside[1:-1, :-2] | inside[1:-1, 2:]
    return [name for name, values in record.violated.items() if (beside & ~record.feasible & (values > 0)).any()]


def region(record: FeasibleRegion, axis: Any = None) -> Any:
    """Feasible region with the limits that bound it, lines of equal mass and the optimum; returns the Figure."""
    with styled():
        if axis is None:
            _, axis = plt.subplots(figsize=(7.5, 5.6))
        (_, to_x), (_, to_y) = scale(unit_of_name(record.x_name)), scale(unit_of_name(record.y_name))
        X, Y = record.x * to_x, record.y * to_y
        # the scale first: labels of the mass lines are placed on it
        axis.set(xscale="log", yscale="log", xlim=(X[0], X[-1]), ylim=(Y[0], Y[-1]))
        axis.contourf(X, Y, record.feasible.astype(float), levels=[0.5, 1.5], colors=["#cfe8d5"])
        handles: list[Any] = []
        labels: list[str] = []
        if record.feasible.any():
            handles.append(plt.Rectangle((0, 0), 1, 1, color="#cfe8d5"))
            labels.append("feasible")
        limits: dict[str, Any] = {"stability margin": (-record.stability, "#a11d33", "-")}
        for name, (words, colour, style) in LIMITS.items():
            if name in record.violated:
                limits[words] = (record.violated[name], colour, style)
        others = [name for name in bounding(record) if name not in LIMITS]
        limits |= {plain(name.replace("_", " ")): (record.violated[name], *look) for name, look in zip(others, cycle(OTHERS))}
        for name, (values, colour, style) in limits.items():
            if (values > 0).any() and (values < 0).any():
                axis.contour(X, Y, values, levels=[0], colors=[colour], linestyles=[style], linewidths=1.6)
                handles.append(plt.Line2D([], [], color=colour, ls=style, lw=1.6))
                labels.append(f"limit of {name}")
        total = record.mass[np.isfinite(record.mass)]
        low = float(record.mass[len(Y) // 2, len(X) // 2])
        levels = [m for m in low * np.array([0.6, 0.8, 1, 1.25, 1.5, 2]) if total.min() < m < total.max()]
        if levels:
            lines = axis.contour(X, Y, record.mass, levels=levels, colors="#8a8a8a", linewidths=0.8)
            axis.clabel(lines, fmt=lambda m: f"{m:.3g} kg", fontsize=8, inline_spacing=2)
        at = record.design[record.x_name] * to_x, record.design[record.y_name] * to_y
        (star,) = axis.plot(*at, "*", ms=14, color="#e0a100", mec="black", ls="none")
        handles.append(star)
        labels.append("optimum")
        axis.set_xlabel(axis_label(quantity_words(record.x_name), unit_of_name(record.x_name)))
        axis.set_ylabel(axis_label(quantity_words(record.y_name), unit_of_name(record.y_name)))
        axis.figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
        axis.set_title("Feasible region, other variables at the optimum", fontsize=10)
        return axis.figure

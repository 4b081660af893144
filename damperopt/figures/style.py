"""Figures: each function takes a record and an axes (or figure) and returns it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import NullLocator

from ..motion.trajectory import Motion, Trajectory
from ..optimum.region import FeasibleRegion
from ..results import UNITS, DecayCheck, DesignResult
from ..stability.modes import ModeTable

__all__ = [
    "STYLE",
    "SYMBOLS",
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

COLOURS = {"torsional": "#0b6e99", "lateral": "#c2571a", "string": "#6b6b6b"}
STYLE: Any = {
    "font.size": 10,
    "axes.grid": True,
    "grid.alpha": 0.25,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "figure.constrained_layout.use": True,
    "svg.hashsalt": "damperopt",
}
SYMBOLS = {
    "c_lambda": r"Damping $c_\lambda$",
    "k_lambda": r"Spring stiffness $k_\lambda$",
    "I_arm": r"Second moment of area of the arm $I_\mathrm{arm}$",
}
LIMITS = {
    "decay_ratio": ("decay", "#00798c", "-"),
    "arm_stress": ("arm stress", "#333333", "--"),
    "arm_fatigue": ("arm fatigue", "#7a5195", ":"),
    "working_stroke": ("working stroke", "#2f6b3a", "-."),
    "damper_length": ("damper length", "#b36b00", (0, (5, 1, 1, 1))),
}


@contextmanager
def styled() -> Iterator[None]:
    """Figures in the package's style; unlike `rc_context` it leaves alone what a notebook's backend sets."""
    before = {key: matplotlib.rcParams[key] for key in STYLE}
    matplotlib.rcParams.update(STYLE)
    try:
        yield
    finally:
        matplotlib.rcParams.update(before)


def save(figure: Any, folder: Path, name: str) -> list[Path]:
    """Write a figure as PNG and SVG and close it; returns both paths."""
    paths = [folder / f"{name}.png", folder / f"{name}.svg"]
    figure.savefig(paths[0], dpi=150)
    figure.savefig(paths[1], metadata={"Date": None})
    plt.close(figure)
    return paths


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
    for name in COLOURS:
        columns = [j for j, n in enumerate(table.names) if n == name]
        for j in columns:
            label = name if j == columns[0] else None
            upper.plot(table.speeds, table.eigenvalues[:, j].real, color=COLOURS[name], label=label, **line)
            if name != "string":
                oscillating = np.abs(table.eigenvalues[:, j].imag) > 1e-6
                lower.plot(table.speeds, np.where(oscillating, table.frequency[:, j], np.nan), color=COLOURS[name], **line)
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
    upper.set_title(title, fontsize=10)
    lower.set_ylabel("Frequency [Hz]")
    lower.set_xlabel("Speed [m/s]")


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
        figure.suptitle(f"Modes over speed at {after.load / 1e3:g} kN", fontsize=11)
        return figure


def mass_by_part(result: DesignResult, axis: Any = None) -> Any:
    """Horizontal bars of the mass by part of a result that holds a design; returns the Figure."""
    if result.mass is None:
        raise ValueError(f"no design to draw: {result.message}")
    with styled():
        if axis is None:
            _, axis = plt.subplots(figsize=(7, 0.6 * len(result.mass.parts) + 1.4))
        parts = dict(sorted(result.mass.parts.items(), key=lambda item: item[1]))
        bars = axis.barh(list(parts), list(parts.values()), color="#0b6e99", height=0.6)
        axis.bar_label(bars, [f"{mass:.2f} kg" for mass in parts.values()], padding=4)
        axis.margins(x=0.15)
        axis.grid(axis="y", visible=False)
        axis.set_xlabel("Mass [kg]")
        axis.set_title(f"{result.topology}, {result.material}: {result.mass.total:.2f} kg", fontsize=10)
        return axis.figure


def tornado(result: DesignResult, shown: int = 12) -> Any:
    """Change of mass for one per cent of each input, the largest first; returns the Figure."""
    strongest = [s for s in result.sensitivities if s.value != 0][:shown][::-1]
    with styled():
        figure, axis = plt.subplots(figsize=(7, 0.3 * len(strongest) + 1.2))
        slopes = [s.elasticity for s in strongest]
        colours = ["#a11d33" if slope > 0 else "#2f6b3a" for slope in slopes]
        bars = axis.barh([s.input for s in strongest], slopes, color=colours, height=0.65)
        axis.bar_label(bars, [f"{slope:+.3g} %" for slope in slopes], padding=3, fontsize=8)
        axis.axvline(0, color="#333333", lw=0.8)
        axis.margins(x=0.18)
        axis.grid(axis="y", visible=False)
        axis.set_xlabel("Change of mass for +1 % of the input [%]")
        return figure


def region(record: FeasibleRegion, axis: Any = None) -> Any:
    """Feasible region with the limits that bound it, lines of equal mass and the optimum; returns the Figure."""
    with styled():
        if axis is None:
            _, axis = plt.subplots(figsize=(7.5, 5.6))
        X, Y = record.x, record.y
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
        (star,) = axis.plot(
            record.design[record.x_name], record.design[record.y_name], "*", ms=14, color="#e0a100", mec="black", ls="none"
        )
        handles.append(star)
        labels.append("optimum")
        axis.set_xlabel(f"{SYMBOLS[record.x_name]} [{UNITS[record.x_name]}]")
        axis.set_ylabel(f"{SYMBOLS[record.y_name]} [{UNITS[record.y_name].replace('^4', '⁴')}]")
        axis.figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
        axis.set_title("Feasible region, other variables at the optimum", fontsize=10)
        return axis.figure


PANELS = (
    ("Yaw angle [deg]", (("yaw_angle", "", 180 / np.pi),)),
    ("Lateral [mm]", (("lateral_displacement", "gear, $l_g \\sin\\delta$", 1e3), ("string_deflection", "tyre string", 1e3))),
    ("Damper force [kN]", (("damper_force", "", 1e-3),)),
    ("Damper stroke [mm]", (("damper_stroke", "", 1e3),)),
    ("Arm stress [MPa]", (("arm_stress", "", 1e-6),)),
)
"""Panels of a trajectory: axis label, and (name, label, factor) of each curve."""


def trajectory(record: Trajectory, motion: Motion) -> Any:
    """Yaw, lateral motion, damper force and stroke, and arm stress over time.

    Parameters
    ----------
    record : Trajectory
    motion : Motion
        What it shows, for the title.

    Returns
    -------
    matplotlib Figure
    """
    panels = [(label, [c for c in curves if c[0] in {*record.states, *record.outputs}]) for label, curves in PANELS]
    panels = [(label, curves) for label, curves in panels if curves]
    with styled():
        figure, rows = plt.subplots(len(panels), sharex=True, figsize=(8, 1 + 1.5 * len(panels)), squeeze=False)
        for axis, (label, curves) in zip(rows[:, 0], panels, strict=True):
            for (name, legend, factor), colour in zip(curves, COLOURS.values(), strict=False):
                axis.plot(record.time, factor * record[name], lw=1, color=colour, label=legend)
            axis.set_ylabel(label)
            axis.margins(x=0)
            if len(curves) > 1:
                axis.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, frameon=False, fontsize=8, borderaxespad=0)
        rows[-1, 0].set_xlabel("Time [s]")
        figure.align_ylabels(rows[:, 0])
        words = motion.kind if not record.message else f"{motion.kind}: {record.message}"
        figure.suptitle(f"{record.speed:g} m/s, {record.load / 1e3:g} kN: {words}", fontsize=10)
        return figure


def decay(record: Trajectory, check: DecayCheck, speeds: np.ndarray, ratios: np.ndarray) -> Any:
    """The worst motion with the band that it must stay in, and the decay ratio over speed.

    Parameters
    ----------
    record : Trajectory
        At the worst speed.
    check : DecayCheck
    speeds, ratios : ndarray
        (m,) [m/s] and decay ratios at the worst load.

    Returns
    -------
    matplotlib Figure
    """
    limit = f"{check.limit:.3g} of the first"
    with styled():
        figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
        first = np.abs(record["yaw_angle"]).max()
        left.plot(record.time, np.degrees(record["yaw_angle"]), color=COLOURS["torsional"], lw=1.2)
        after = record.time[-1] / 1.8
        for sign in (1, -1):
            left.plot([after, record.time[-1]], [sign * np.degrees(check.limit * first)] * 2, color="#333333", ls="--", lw=1)
        left.text(record.time[-1], np.degrees(check.limit * first) * 1.15, limit, ha="right", fontsize=9, color="#333333")
        left.set(xlabel="Time [s]", ylabel="Yaw angle [deg]")
        left.set_title(f"Worst speed, {check.speed:.1f} m/s, {check.load / 1e3:g} kN", fontsize=10)
        left.margins(x=0)
        right.plot(speeds, ratios, color=COLOURS["torsional"])
        right.axhline(check.limit, color="#333333", ls="--", lw=1)
        right.plot(check.speed, check.ratio, "o", color=COLOURS["lateral"])
        right.text(speeds[-1], 1.02 * check.limit, limit, ha="right", va="bottom", fontsize=9, color="#333333")
        right.set(xlabel="Speed [m/s]", ylabel=f"Decay ratio after {check.cycles} cycles", ylim=(0, 1.25 * check.limit))
        right.margins(x=0)
        return figure

"""Motion over time, and its decay over speed."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from ..motion.history import Frozen
from ..motion.roll import Roll
from ..motion.trajectory import Motion, Trajectory
from ..quantities.shown import axis_label, scale, written
from ..results import DecayCheck
from .style import COLOURS, plain, styled

__all__ = ["decay", "roll", "trajectory"]

UNSTABLE = "#a11d33"

PANELS = (
    ("Yaw angle", (("yaw_angle", ""),)),
    ("Lateral", (("lateral_displacement", "gear, $l_g \\sin\\delta$"), ("string_deflection", "tyre string"))),
    ("Damper force", (("damper_force", ""),)),
    ("Damper stroke", (("damper_stroke", ""),)),
    ("Damper torque", (("damper_torque", ""),)),
    ("Damper angle", (("damper_angle", ""),)),
    ("Arm stress", (("arm_stress", ""),)),
)
"""Panels of a trajectory: words of the axis, and (name, label) of each curve; states that no panel names get one each."""

ELSEWHERE = {"yaw_rate", "bending_angle", "bending_rate", "dashpot_stroke", "link_angle"}
"""States that another curve shows."""


def trajectory(record: Trajectory, motion: Motion, after: str = "") -> Any:
    """Yaw, lateral motion, damper force and stroke, and arm stress over time.

    Parameters
    ----------
    record : Trajectory
    motion : Motion
        What it shows, for the title.
    after : str
        What set it off, for the title.

    Returns
    -------
    matplotlib Figure
    """
    panels = [(label, [c for c in curves if c[0] in {*record.states, *record.outputs}]) for label, curves in PANELS]
    drawn = {name for _, curves in panels for name, _ in curves} | ELSEWHERE
    panels += [(name.capitalize().replace("_", "\n"), [(name, "")]) for name in record.states if name not in drawn]
    panels = [(label, curves) for label, curves in panels if curves]
    with styled():
        figure, rows = plt.subplots(len(panels), sharex=True, figsize=(8, 1 + 1.5 * len(panels)), squeeze=False)
        for axis, (label, curves) in zip(rows[:, 0], panels, strict=True):
            unit = record.units.get(curves[0][0], "1")
            for (name, legend), colour in zip(curves, COLOURS.values(), strict=False):
                axis.plot(record.time, scale(unit)[1] * record[name], lw=1, color=colour, label=legend)
            axis.set_ylabel(axis_label(label, unit))
            axis.ticklabel_format(axis="y", useOffset=False)
            axis.margins(x=0)
            if len(curves) > 1:
                axis.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, frameon=False, fontsize=8, borderaxespad=0)
        rows[-1, 0].set_xlabel("Time [s]")
        figure.align_ylabels(rows[:, 0])
        words = motion.kind if not record.message else f"{motion.kind}: {plain(record.message)}"
        figure.suptitle(f"{written(record.speed, record.load)}: {words}" + (f"\n{plain(after)}" if after else ""), fontsize=10)
        return figure


def roll(record: Trajectory, found: Roll, frozen: Frozen, after: str = "") -> Any:
    """Yaw and damper force through a history, above speed, load and stroke, and the spectral abscissa of the frozen gear.

    Where that gear is unstable, or keeps less than its margin, all panels are shaded.

    Parameters
    ----------
    record : Trajectory
    found : Roll
        What it shows.
    frozen : Frozen
        The gear with time held.
    after : str
        What set it off, for the title.

    Returns
    -------
    matplotlib Figure
    """
    force = next(name for name in ("damper_force", "damper_torque", "linkage_torque") if name in record.outputs)
    names = ["yaw_angle", force, "speed", *(["strut_stroke"] if "strut_stroke" in record.outputs else [])]
    with styled():
        figure, axes = plt.subplots(len(names) + 1, sharex=True, figsize=(8, 1.5 + 1.5 * len(names)))
        for axis, name in zip(axes, names, strict=False):
            unit = record.units[name]
            colour = COLOURS["lateral" if name == force else "torsional"]
            axis.plot(record.time, scale(unit)[1] * record[name], lw=0.8, color=colour)
            axis.set_ylabel(axis_label(name.capitalize().replace("_", " "), unit))
        other = axes[2].twinx()
        other.plot(record.time, record["vertical_load"] / 1e3, lw=0.8, color=COLOURS["lateral"])
        other.set_ylabel("Load [kN]", color=COLOURS["lateral"])
        other.spines["right"].set_visible(True)
        other.grid(visible=False)
        axes[2].set_ylabel("Speed [m/s]", color=COLOURS["torsional"])
        for axis in (axes[2], other):
            axis.set_ylim(bottom=0)
        axes[-1].plot(frozen.time, frozen.abscissa, lw=1, color="#333333")
        axes[-1].axhline(0, color="#333333", lw=0.8)
        axes[-1].set(ylabel="Largest real\npart [1/s]", xlabel="Time [s]")
        if found.margin:
            axes[-1].axhline(-found.margin, color="#333333", lw=0.8, ls="--")
        for axis in axes:
            axis.margins(x=0)
            for stretches, shade in ((found.below, 0.1), (found.unstable, 0.15)):
                for stretch in stretches:
                    axis.axvspan(*stretch.time, color=UNSTABLE, alpha=shade, lw=0)
        figure.align_ylabels(axes)
        shaded = "shaded: unstable" + (f" (lightly: margin below {found.margin:g} 1/s)" if found.margin else "")
        words = f"stopped: {plain(record.message)}" if record.message else plain(record.along)
        lines = [words, *map(plain, after.split(" and ")), f"{shaded}, with time held"]
        figure.suptitle("\n".join(lines), fontsize=10)
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
        left.set_title(f"Worst speed, {check.speed:.1f} m/s, {written(load=check.load)}", fontsize=10)
        left.margins(x=0)
        right.plot(speeds, ratios, color=COLOURS["torsional"])
        right.axhline(check.limit, color="#333333", ls="--", lw=1)
        right.plot(check.speed, check.ratio, "o", color=COLOURS["lateral"])
        right.text(speeds[-1], 1.02 * check.limit, limit, ha="right", va="bottom", fontsize=9, color="#333333")
        right.set(xlabel="Speed [m/s]", ylabel=f"Decay ratio after {check.cycles} cycles", ylim=(0, 1.25 * check.limit))
        right.margins(x=0)
        return figure

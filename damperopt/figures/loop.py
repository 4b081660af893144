"""A loop over frequency, after Bode and after Nyquist, and its margins over speed."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from ..quantities.shown import written
from ..stability.margins_of_loop import Locus, OverSpeed
from .style import styled

__all__ = ["loop_loci", "loop_margins"]

COLOURS = ("#0b6e99", "#c2571a", "#2f6b3a", "#7a5195")
RED, SHADE = "#a11d33", "#f2c4c4"
FAINT = 1e-6
"""A locus that stays below is none."""

OF_LOOP = {"tyre": "loop opened at the tyres", "damper": "loop opened at the damper"}
OF_FACTOR = {"tyre": "force and moment of all tyres", "damper": "damping"}


def loop_loci(locus: Locus, where: str, speed: float, load: float) -> Any:
    """Magnitude and phase over frequency, and the locus about -1 with its turns.

    Parameters
    ----------
    locus : Locus
    where : str
        ``tyre`` or ``damper``.
    speed, load : float
        [m/s], [N]

    Returns
    -------
    matplotlib Figure
    """
    shown = [i for i in range(locus.loci.shape[1]) if np.abs(locus.loci[:, i]).max() > FAINT]
    with styled():
        figure = plt.figure(figsize=(11, 5.2))
        grid = figure.add_gridspec(2, 2, width_ratios=[1, 1])
        size = figure.add_subplot(grid[0, 0])
        phase, plane = figure.add_subplot(grid[1, 0], sharex=size), figure.add_subplot(grid[:, 1])
        f = locus.frequencies[1:] / (2 * np.pi)
        for colour, i in zip(COLOURS, shown, strict=False):
            l = locus.loci[1:, i]
            size.loglog(f, np.abs(l), color=colour, lw=1.6, label=f"locus {i + 1}" if len(shown) > 1 else None)
            phase.semilogx(f, np.degrees(np.angle(l)), ".", ms=2.5, color=colour)
            _nyquist(plane, locus.loci[:, i], colour)
        low, high = _band(locus, shown)
        size.set_xlim(low, high)
        beyond = [np.abs(locus.loci[1:, i][(f >= low) & (f <= high)]) for i in shown]
        top, least = max(b.max() for b in beyond), max(min(b.min() for b in beyond), 1e-5)
        size.set_ylim(least / 2, top * 2)
        size.axhline(1, color="0.4", lw=0.8, ls="--")
        size.set_ylabel("|L| [1]")
        size.tick_params(labelbottom=False)
        if len(shown) > 1:
            size.legend(frameon=False, fontsize=8)
        phase.set_ylabel("Phase of L [deg]")
        phase.set_yticks([-180, -90, 0, 90, 180])
        phase.set_xlabel("Frequency [Hz]")
        _unit(plane)
        verdict = "stable" if not locus.implied else f"{locus.implied} unstable poles"
        counts = f"unstable poles of the open loop {locus.open_unstable}, clockwise turns {locus.turns}"
        plane.set_title(f"{counts}: {verdict}", fontsize=9)
        figure.suptitle(f"{written(speed, load)}, {OF_LOOP[where]}", fontsize=11)
        return figure


def _band(locus: Locus, shown: list[int]) -> tuple[float, float]:
    """Frequencies [Hz] between which the loop moves."""
    l = np.abs(locus.loci[1:, shown]).max(axis=1)
    f = locus.frequencies[1:] / (2 * np.pi)
    top = f[l >= 1e-2 * min(l.max(), 1.0)].max()
    moving = np.abs(locus.loci[1:, shown] - locus.loci[0, shown]).max(axis=1) > 1e-2 * min(l.max(), 1.0)
    return float(f[moving].min()) / 2, float(top) * 2


def _squeezed(l: np.ndarray) -> np.ndarray:
    """As it is up to 1, by the logarithm beyond."""
    size = np.maximum(np.abs(l), 1e-300)
    return l / size * np.where(size <= 1, size, 1 + np.log10(np.maximum(size, 1)))


def _nyquist(plane: Any, l: np.ndarray, colour: str) -> None:
    """A locus over positive frequencies with arrows, and its mirror image."""
    shown = _squeezed(l)
    plane.plot(shown.real, shown.imag, color=colour, lw=1.6)
    plane.plot(shown.real, -shown.imag, color=colour, lw=0.9, ls=":")
    way = np.concatenate([[0], np.cumsum(np.abs(np.diff(shown)))])
    for part in (0.3, 0.7):
        k = int(np.clip(np.searchsorted(way, part * way[-1]), 1, len(l) - 1))
        if shown[k] != shown[k - 1]:
            step = (shown[k] - shown[k - 1]) / abs(shown[k] - shown[k - 1]) * 1e-3
            ends = shown[k] - step, shown[k] + step
            arrow = {"arrowstyle": "-|>", "color": colour}
            plane.annotate("", (ends[1].real, ends[1].imag), (ends[0].real, ends[0].imag), arrowprops=arrow)


def _unit(plane: Any) -> None:
    circle = np.exp(1j * np.linspace(0, 2 * np.pi, 181))
    plane.plot(circle.real, circle.imag, color="0.4", lw=0.8, ls="--")
    plane.plot(-1, 0, "+", color=RED, ms=12, mew=2)
    plane.set_aspect("equal", adjustable="datalim")
    decades = np.arange(0, 12)
    for axis in (plane.xaxis, plane.yaxis):
        reach = max(abs(x) for x in axis.get_view_interval())
        kept = [k for k in decades if k + 1 <= reach * 1.05]
        sizes = kept if len(kept) < 5 else kept[::2]
        ticks = [-(k + 1) for k in sizes[::-1]] + [0] + [k + 1 for k in sizes]
        words = [f"-$10^{{{k}}}$" if k else "-1" for k in sizes[::-1]] + ["0"]
        axis.set_ticks(ticks, words + [f"$10^{{{k}}}$" if k else "1" for k in sizes])
    plane.set_xlabel("Re L [1], beyond 1 by the logarithm of |L|")
    plane.set_ylabel("Im L [1]")


def loop_margins(over: OverSpeed, where: str) -> Any:
    """Disk, gain and phase margin over speed, unstable speeds shaded, the weakest marked.

    Parameters
    ----------
    over : OverSpeed
    where : str
        ``tyre`` or ``damper``.

    Returns
    -------
    matplotlib Figure
    """
    V = over.speeds
    values = {name: np.array([getattr(m, name) for m in over.margins]) for name in ("disk", "gain_down", "gain_up", "phase")}
    unstable = np.array([m.unstable > 0 for m in over.margins])
    line: dict[str, Any] = {"lw": 1.8, "marker": "o" if len(V) == 1 else ""}
    with styled():
        figure, (disk, gain, phase) = plt.subplots(3, 1, sharex=True, figsize=(8, 7.5))
        disk.plot(V, values["disk"], color=COLOURS[0], **line)
        disk.set_ylabel("Disk margin alpha [1]")
        disk.set_ylim(0, 2.05)
        gain.plot(V, np.where(np.isfinite(values["gain_up"]), values["gain_up"], np.nan), color=COLOURS[1], label="up", **line)
        down = np.where(values["gain_down"] > 0, values["gain_down"], np.nan)
        gain.plot(V, down, color=COLOURS[0], label="down" if np.isfinite(down).any() else None, **line)
        gain.axhline(1, color="0.4", lw=0.8, ls="--")
        gain.set_yscale("log")
        gain.set_ylabel("Gain at the limit [1]")
        gain.legend(frameon=False, fontsize=8, ncols=2)
        phase.plot(V, np.degrees(values["phase"]), color=COLOURS[2], **line)
        phase.set_ylabel("Phase margin [deg]")
        phase.set_ylim(0, 185)
        phase.set_yticks([0, 45, 90, 135, 180])
        phase.set_xlabel("Speed [m/s]")
        for axis in (disk, gain, phase):
            if unstable.any():
                axis.fill_between(
                    V,
                    0,
                    1,
                    where=unstable,
                    transform=axis.get_xaxis_transform(),
                    color=SHADE,
                    lw=0,
                    step="mid",
                    label="unstable",
                )
            axis.axvline(V[over.weakest], color=RED, lw=1, ls=":")
            if len(V) > 1:
                axis.set_xlim(V[0], V[-1])
        words = f"weakest at {V[over.weakest]:.4g} m/s"
        disk.set_title(f"{written(load=over.load)}, common factor on {OF_FACTOR[where]}; {words}", fontsize=10)
        return figure

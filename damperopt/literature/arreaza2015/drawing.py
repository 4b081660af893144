"""Response figures of the thesis."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from ...figures.style import styled
from ...quantities.shown import shown
from ...study.components import unit_of_name
from .responses import Response, ThesisResponse

__all__ = ["response"]


def response(figure: ThesisResponse, found: Sequence[Response]) -> Any:
    """Yaw angle of each motion; for the gear without a damper layout lateral displacement and string below it.

    Parameters
    ----------
    figure : ThesisResponse
    found : sequence of Response

    Returns
    -------
    matplotlib Figure
    """
    with styled():
        if figure.topology == "rotational":
            return _yaw_and_bending(figure, found[0])
        drawn, axes = plt.subplots(len(found), sharex=True, sharey=True, figsize=(7.5, 1 + 1.5 * len(found)), squeeze=False)
        colours = plt.get_cmap("viridis")(np.linspace(0, 0.75, len(found)))
        for axis, one, colour in zip(axes[:, 0], found, colours, strict=True):
            shown = one.trajectory.time <= figure.shown
            axis.plot(one.trajectory.time[shown], one.trajectory["yaw_angle"][shown], lw=0.8, color=colour)
            axis.set_title(
                f"{_values(one)}: {one.motion.kind}{_amplitude(one)}; linear {one.abscissa:.2g} 1/s", fontsize=9, loc="left"
            )
            axis.margins(x=0)
        drawn.supylabel("Yaw angle [rad]", fontsize=10)
        axes[-1, 0].set_xlabel("Time [s]")
        return drawn


def _yaw_and_bending(figure: ThesisResponse, one: Response) -> Any:
    drawn, axes = plt.subplots(2, sharex=True, figsize=(7.5, 4.6))
    motion, shown = one.trajectory, one.trajectory.time <= figure.shown
    axes[0].plot(motion.time[shown], motion["yaw_angle"][shown], lw=0.8, color="#0b6e99")
    axes[0].set(ylabel="Yaw angle [rad]")
    axes[0].set_title(f"{figure.speed:g} m/s, {figure.load / 1e3:g} kN: {one.motion.kind}{_amplitude(one)}", fontsize=10)
    curves = (("string_deflection", "tyre string", "#6b6b6b"), ("lateral_displacement", r"$l_g \sin\delta$", "#c2571a"))
    for name, label, colour in curves:
        axes[1].plot(motion.time[shown], motion[name][shown], lw=0.8, color=colour, label=label)
    axes[1].set(ylabel="Lateral [m]", xlabel="Time [s]")
    axes[1].legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, frameon=False, fontsize=9, borderaxespad=0)
    axes[1].margins(x=0)
    return drawn


def _values(one: Response) -> str:
    symbols = {"c_lambda": r"$c_\lambda$", "k_lambda": r"$k_\lambda$", "I_arm": r"$I_\mathrm{arm}$"}
    held = {symbol: shown(one.design[name], unit_of_name(name)) for name, symbol in symbols.items() if name in one.design}
    return ", ".join(f"{symbol} {value} {unit}" for symbol, (value, unit) in held.items())


def _amplitude(one: Response) -> str:
    if one.motion.kind != "limit cycle":
        return ""
    return f", {one.motion.amplitude:.3g} rad at {one.motion.frequency:.3g} Hz"

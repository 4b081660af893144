"""Figure of a sweep: curves over one number, a map over two, bars over names, clouds over samples."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from ..sweep.grid import Sweep
from ..sweep.records import PointRecord
from .style import styled

__all__ = ["sweep_figure"]

BLOCKS = ("gear", "tyre", "damper", "envelope", "requirements")

MARKS = ("solved", "stable", "margin missed", "unstable")
"""Whose numbers are shown."""

MOST_BARS, MOST_CURVES = 60, 24
"""What can still be told apart."""


def sweep_figure(sweep: Sweep, records: Mapping[int, PointRecord]) -> Any:
    """Mass (or, of an analysis, spectral abscissa) over what is varied.

    Parameters
    ----------
    sweep : Sweep
    records : mapping
        By index.

    Returns
    -------
    matplotlib Figure
    """
    name, label = ("mass", "Mass [kg]") if sweep.run == "optimise" else ("abscissa", "Spectral abscissa [1/s]")
    rows = ((point.values, records.get(point.index)) for point in sweep.points)
    points = [
        (values, record.numbers.get(name, np.nan) if record and record.status in MARKS else np.nan) for values, record in rows
    ]
    numeric = [key for key, values in sweep.axes.items() if isinstance(values[0], float)]
    names = [key for key in sweep.axes if key not in numeric]
    with styled():
        if sweep.sampled:
            figure = _clouds(sweep, points, label)
        elif len(numeric) == 2 and not names:
            figure = _map(sweep, points, label)
        elif numeric:
            figure = _curves(sweep, points, numeric[0], label)
        else:
            figure = _bars(sweep, points, label)
        lost = sum(not np.isfinite(value) for _, value in points)
        figure.suptitle(
            f"{_plain(sweep.name)}: {len(points)} points" + (f", {lost} without a value" if lost else ""), fontsize=10
        )
        return figure


def _plain(text: str) -> str:
    """Text in which a dollar sign is one and begins no formula."""
    return text.replace("$", r"\$")


def _words(sweep: Sweep, key: str) -> str:
    unit = sweep.units.get(key, "")
    block, _, name = key.rpartition(".")
    short = block in BLOCKS and "_" in name  # else the name alone says too little
    words = (name if short else f"{block.rpartition('.')[2]} {name}").replace("_", " ").strip().capitalize()
    return f"{words} [{unit}]" if unit and unit != "1" else words


def _value(sweep: Sweep, key: str, value: float | str) -> str:
    if isinstance(value, str):
        return _plain(value)
    unit = sweep.units.get(key, "")
    return f"{key.split('.')[-1].replace('_', ' ')} {value:.4g}" + (f" {unit}" if unit not in ("", "1") else "")


def _curves(sweep: Sweep, points: list, key: str, label: str) -> Any:
    figure, axis = plt.subplots(figsize=(7.5, 4.8))
    others = [other for other in sweep.axes if other != key]
    families: dict[tuple, list] = {}
    for values, found in points:
        families.setdefault(tuple(values[other] for other in others), []).append((values[key], found))
    colours = plt.get_cmap("viridis")(np.linspace(0, 0.85, len(families)))
    for (family, curve), colour in zip(families.items(), colours, strict=True):
        words = ", ".join(_value(sweep, other, value) for other, value in zip(others, family, strict=True))
        axis.plot(*np.array(curve).T, "o-", ms=4, color=colour, label=words or None)
    axis.set(xlabel=_words(sweep, key), ylabel=label)
    if others and len(families) <= MOST_CURVES:
        figure.legend(loc="outside lower center", ncols=3, frameon=False, fontsize=9)
    return figure


def _map(sweep: Sweep, points: list, label: str) -> Any:
    figure, axis = plt.subplots(figsize=(7, 5.2))
    (x, xs), (y, ys) = sweep.axes.items()
    found = np.array([value for _, value in points]).reshape(len(xs), len(ys))
    at_x, at_y = np.array(xs, float), np.array(ys, float)
    image = axis.pcolormesh(at_x, at_y, found.T, shading="nearest", cmap="viridis")
    figure.colorbar(image, ax=axis, label=label)
    for i, u in enumerate(at_x):
        for j, v in enumerate(at_y):
            text = f"{found[i, j]:.4g}" if np.isfinite(found[i, j]) else "none"
            if found.size <= 100:
                axis.text(u, v, text, ha="center", va="center", fontsize=8, color="white", bbox={"fc": "#0006", "ec": "none"})
    axis.grid(False)
    axis.set(xlabel=_words(sweep, x), ylabel=_words(sweep, y))
    return figure


def _bars(sweep: Sweep, points: list, label: str) -> Any:
    ordered = sorted(points, key=lambda point: (not np.isfinite(point[1]), point[1]))[:MOST_BARS]
    figure, axis = plt.subplots(figsize=(7.5, 1.2 + 0.3 * len(ordered)))
    names = [_plain(", ".join(str(value) for value in values.values())) for values, _ in ordered]
    found = np.array([value for _, value in ordered])
    bars = axis.barh(names, np.nan_to_num(found), color="#0b6e99")
    axis.bar_label(bars, [f"{v:.3f}" if np.isfinite(v) else "no design" for v in found], padding=3, fontsize=8)
    axis.invert_yaxis()
    axis.set(xlabel=label if len(ordered) == len(points) else f"{label}, the lowest {MOST_BARS}")
    axis.margins(x=0.12)
    axis.grid(axis="y", visible=False)
    return figure


def _clouds(sweep: Sweep, points: list, label: str) -> Any:
    columns = min(len(sweep.sampled), 3)
    lines = -(-len(sweep.sampled) // columns)
    figure, axes = plt.subplots(lines, columns, figsize=(3.6 * columns + 0.6, 3.2 * lines + 0.4), sharey=True, squeeze=False)
    for axis, key in zip(axes.flat, sweep.sampled, strict=False):
        axis.plot([values[key] for values, _ in points], [found for _, found in points], ".", ms=5, color="#0b6e99", alpha=0.7)
        axis.set(xlabel=_words(sweep, key))
    for axis in axes.flat[len(sweep.sampled) :]:
        axis.set_visible(False)
    for axis in axes[:, 0]:
        axis.set(ylabel=label)
    return figure

"""Figures of stability charts."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.ticker import FuncFormatter

from ..charts.chart import Curve, Family, StabilityChart
from ..charts.maps import FilledMap
from ..charts.plane import OPERATING
from ..quantities.shown import axis_label, rounded, scale, shown, written
from .style import quantity_words, styled

__all__ = ["chart"]

DIVERGENCE = (0, (4, 1.5))
STABLE_SIDE = ListedColormap(["#cfe8d5"])
SHADE_PIXELS = 400
FREQUENCY_STEP, FREQUENCY_CHANGE = 0.25, 0.02
"""Part of the axes between labels of frequency, and the least change that is worth one."""

MAPS = {"abscissa": ("Spectral abscissa", "RdBu_r", "1/s"), "damping": ("Least damping ratio", "RdBu", "1")}
"""Words, colours and unit of what fills a plane: white at zero, red where unstable."""

LABEL_EDGE, LABEL_SHAPE, LABEL_ROOM = 0.06, np.array([1.0, 2.5]), (0.05, 0.15)
"""Part of the axes without labels; how much less high than wide a label is; room that it wants to curves and to labels."""


def chart(
    record: StabilityChart, filled: FilledMap | None = None, axis: Any = None, neutral: StabilityChart | None = None
) -> Any:
    """Stability boundaries with their families, the stable side, corners and the design.

    Parameters
    ----------
    record : StabilityChart
    filled : FilledMap or None
        Drawn below the curves in place of the stable side.
    axis : matplotlib Axes or None
    neutral : StabilityChart or None
        The same with no margin: dotted, so that the margin is seen as what lies between.

    Returns
    -------
    matplotlib Figure
    """
    with styled():
        if axis is None:
            _, axis = plt.subplots(figsize=(7.5, 5.6))
        several = len(record.families) > 1
        colours = _colours(record, filled)
        entries: list[tuple[Any, str]] = []
        if filled is not None:
            _fill(axis, record, filled)
        elif _shade(axis, record):
            words = "stable" if record.margin == 0 else f"margin of {record.margin:g} 1/s kept"
            entries.append((plt.Rectangle((0, 0), 1, 1, color=STABLE_SIDE(1.0)), f"{words} in all" if several else words))
        for family, colour in zip(record.families, colours, strict=True):
            for curve in family.curves:
                _draw_curve(axis, record, curve, colour)
            if family.curves or several:  # without a curve its words alone: stable or not, at every point
                handle = plt.Line2D([], [], color=colour, lw=1.6, ls="-" if family.curves else "none")
                entries.append((handle, _family_words(record, family)))
        if several:
            _label_families(axis, record, colours)
        else:
            _label_frequencies(axis, record)
        if neutral is not None and any(family.curves for family in neutral.families):
            for family, colour in zip(neutral.families, colours, strict=True):
                for curve in family.curves:
                    axis.plot(*_scaled(neutral, curve.points).T, color=colour, lw=1, ls=":")
            entries.append((plt.Line2D([], [], color="#333333", lw=1, ls=":"), "no margin"))
        if any((~curve.hopf).any() for family in record.families for curve in family.curves):
            entries.append((plt.Line2D([], [], color="#333333", lw=1.6, ls=DIVERGENCE), "divergence (else Hopf)"))
        if not any(family.curves for family in record.families) and len({f.origin_stable for f in record.families}) == 1:
            side = "stable" if record.families[0].origin_stable else "unstable"
            axis.text(0.5, 0.5, f"{side} all over", transform=axis.transAxes, ha="center", va="center", color="#666666")
        if record.mark is not None and _inside(record, record.mark):
            (star,) = axis.plot(
                *_scaled(record, np.array(record.mark)), "*", ms=14, color="#e0a100", mec="black", ls="none", clip_on=False
            )
            entries.append((star, "design" if record.abscissa is None else f"design, abscissa {record.abscissa:.3g} 1/s"))
        low, high = _scaled(record, np.array([[record.x.low, record.y.low], [record.x.high, record.y.high]]))
        axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
        axis.set(xlabel=axis_label(quantity_words(record.x.name), record.x.unit))
        axis.set(ylabel=axis_label(quantity_words(record.y.name), record.y.unit))
        for one in (axis.xaxis, axis.yaxis):
            one.set_major_formatter(FuncFormatter(lambda value, _: rounded(value)))
        if entries:
            axis.figure.legend(*zip(*entries, strict=True), loc="outside lower center", ncols=3, frameon=False, fontsize=9)
        axis.set_title(_title(record, filled), fontsize=10)
        return axis.figure


def _colours(record: StabilityChart, filled: FilledMap | None) -> Any:
    if len(record.families) > 1:
        return plt.get_cmap("viridis")(np.linspace(0, 0.7, len(record.families)))
    return ["#0b6e99" if filled is None else "black"]


def _title(record: StabilityChart, filled: FilledMap | None) -> str:
    """What is drawn, and where."""
    boundary = "stability boundary" if record.margin == 0 else f"boundary of the margin of {record.margin:g} 1/s"
    words = boundary if filled is None else f"{MAPS[filled.quantity][0]} and {boundary}"
    held = [("speed", written(record.speed)), ("vertical_load", written(load=record.load))]
    names = {record.x.name, record.y.name, record.varied.name if record.varied else ""}
    return f"{words[0].upper()}{words[1:]}" + "".join(f", {text}" for name, text in held if name not in names)


def _factors(record: StabilityChart) -> np.ndarray:
    """(2,) from SI to what the axes show."""
    return np.array([scale(record.x.unit)[1], scale(record.y.unit)[1]])


def _scaled(record: StabilityChart, points: np.ndarray) -> np.ndarray:
    """(..., 2) points [SI] in the units of the axes."""
    return points * _factors(record)


def _inside(record: StabilityChart, mark: tuple[float, float]) -> bool:
    return record.x.low <= mark[0] <= record.x.high and record.y.low <= mark[1] <= record.y.high


def _shade(axis: Any, record: StabilityChart) -> bool:
    """The side on which every family keeps the margin; whether there is one."""
    axes = (record.x, record.y)
    x, y = (np.linspace(a.low, a.high, 2 * SHADE_PIXELS + 1)[1::2] for a in axes)
    X, Y = np.meshgrid(x, y)
    kept = np.all([record.stable(X, Y, k) for k in range(len(record.families))], axis=0)
    (low_x, low_y), (high_x, high_y) = _scaled(record, np.array([[a.low for a in axes], [a.high for a in axes]]))
    look: dict[str, Any] = {"origin": "lower", "aspect": "auto", "cmap": STABLE_SIDE, "vmin": 0, "vmax": 1}
    axis.imshow(np.where(kept, 1.0, np.nan), extent=(low_x, high_x, low_y, high_y), **look)
    return bool(kept.any())


def _fill(axis: Any, record: StabilityChart, filled: FilledMap) -> None:
    """Values by colour, white at zero; the colours end at the 90th percentile."""
    largest = max(float(np.percentile(np.abs(filled.values), 90)), 1e-12)
    words, colours, unit = MAPS[filled.quantity]
    to_x, to_y = _factors(record)
    look: dict[str, Any] = {"cmap": colours, "vmin": -largest, "vmax": largest, "rasterized": True}
    image = axis.pcolormesh(filled.x * to_x, filled.y * to_y, filled.values, **look)
    axis.figure.colorbar(image, ax=axis, label=f"{words} [{unit}]", extend="both")


def _draw_curve(axis: Any, record: StabilityChart, curve: Curve, colour: Any) -> None:
    """Hopf solid, divergence dashed, a dot where they meet."""
    points = _scaled(record, curve.points)
    segments = curve.hopf[1:] | curve.hopf[:-1]
    begin = 0
    for end in [*(np.flatnonzero(segments[1:] != segments[:-1]) + 1), len(segments)]:
        style = "-" if segments[begin] else DIVERGENCE
        axis.plot(*points[begin : end + 1].T, color=colour, lw=1.6, ls=style)
        begin = end
    axis.plot(*_scaled(record, curve.corners).T, "o", ms=4, color="black", ls="none")


def _value_words(record: StabilityChart, family: Family) -> str:
    if record.varied is None or family.value is None:
        return "boundary"
    if record.varied.name in OPERATING:
        return written(**{"speed" if record.varied.name == "speed" else "load": family.value})
    return " ".join(shown(family.value, record.varied.unit)).strip()


def _family_words(record: StabilityChart, family: Family) -> str:
    """Value and range of frequencies of a family, for the legend."""
    frequencies = np.concatenate([curve.frequency[curve.hopf] for curve in family.curves] or [np.zeros(0)])
    words = _value_words(record, family)
    if not family.curves:
        side = "stable" if family.origin_stable else "unstable"
        return side if words == "boundary" else f"{words}: {side}"
    if not frequencies.size:
        return words
    low, high = frequencies.min(), frequencies.max()
    return f"{words}: {low:.3g} Hz" if f"{low:.3g}" == f"{high:.3g}" else f"{words}: {low:.3g} to {high:.3g} Hz"


def _label_frequencies(axis: Any, record: StabilityChart) -> None:
    """The frequency at even steps along the curves, wherever it has changed since the label before."""
    low, span = np.array([record.x.low, record.y.low]), np.array([record.x.high - record.x.low, record.y.high - record.y.low])
    for curve in record.families[0].curves:
        p = (curve.points - low) / span
        along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))])
        last = -np.inf
        for place in np.arange(FREQUENCY_STEP / 2, along[-1], FREQUENCY_STEP):
            k = int(np.searchsorted(along, place))
            inside = ((p[k] > LABEL_EDGE) & (p[k] < 1 - LABEL_EDGE)).all()
            if curve.hopf[k] and inside and abs(curve.frequency[k] - last) > FREQUENCY_CHANGE * curve.frequency[k]:
                last = curve.frequency[k]
                box = {"boxstyle": "round,pad=0.1", "fc": "white", "ec": "none", "alpha": 0.8}
                words = f"{last:.3g} Hz"
                axis.text(
                    *_scaled(record, curve.points[k]), words, fontsize=7.5, color="#333333", ha="center", va="center", bbox=box
                )


def _label_families(axis: Any, record: StabilityChart, colours: Any) -> None:
    """A label on each family where it is farthest from the curves of the others and from the labels before it."""
    low, span = np.array([record.x.low, record.y.low]), np.array([record.x.high - record.x.low, record.y.high - record.y.low])
    points = [
        np.concatenate([(curve.points - low) / span for curve in family.curves] or [np.zeros((0, 2))])
        for family in record.families
    ]
    labels: list[np.ndarray] = []
    box = {"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.85}
    for k, own in enumerate(points):
        inside = own[((own > LABEL_EDGE) & (own < 1 - LABEL_EDGE)).all(axis=1)]
        if not len(inside):
            continue
        along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(inside, axis=0), axis=1))])
        candidates = inside[np.searchsorted(along, np.linspace(0, along[-1], 40))]
        others = np.concatenate([p for j, p in enumerate(points) if j != k])
        free = _distance(candidates, others, LABEL_ROOM[0]) + 2 * _distance(
            candidates, np.array(labels).reshape(-1, 2), LABEL_ROOM[1]
        )
        place = candidates[free.argmax()]
        labels.append(place)
        words = _value_words(record, record.families[k])
        axis.text(*_scaled(record, low + span * place), words, fontsize=8, color=colours[k], ha="center", va="center", bbox=box)


def _distance(points: np.ndarray, others: np.ndarray, enough: float) -> np.ndarray:
    """Distance (m,) to the nearest of others, in parts of what is enough and at most 1."""
    if not len(others):
        return np.ones(len(points))
    return np.minimum(np.linalg.norm((points[:, None] - others) * LABEL_SHAPE, axis=2).min(axis=1) / enough, 1)

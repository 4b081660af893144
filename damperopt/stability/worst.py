"""Worst points of an envelope: the speeds and loads at which the spectral abscissa is largest."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from scipy.ndimage import maximum_filter
from scipy.optimize import minimize, minimize_scalar

from ..results import OperatingPoint
from ..study.study import Envelope, Study
from .critical import along_loads, along_speeds
from .delay import DelayGear
from .delay_line import PER_DECADE
from .gear import LinearGear

__all__ = ["top_of", "tops_of", "worst_points"]

LOADS = 9
"""Loads of the first look at a load range, spaced evenly, and as many spaced geometrically."""

ROW, ZOOMS = 11, 6
"""Speeds of a row, and rows, that close in on a maximum: to 1e-6 of the speed, and to the square of that in the abscissa."""

LINES = 7
"""Lines of constant speed along which a load range is searched exactly."""


def worst_points(
    gear: LinearGear, envelope: Envelope | Study, enough: float = np.inf, samples: int = 40
) -> list[OperatingPoint]:
    """Local maxima of the spectral abscissa over the envelope, the global one first.

    Parameters
    ----------
    gear : LinearGear
    envelope : Envelope or Study
        A study stands for its envelope.
    enough : float
        Over a load range: if its ends show an abscissa above this, their maxima are returned without looking between. With a
        delay: if the samples show one, they are returned as they are.
    samples : int
        Speeds of the first look; the result does not hang on it, see Notes.

    Returns
    -------
    list of OperatingPoint
        Descending in abscissa.

    Notes
    -----
    At each load the maximum over speed is global: beyond the refined samples, the speeds at which a root crosses the level
    found, eigenvalues of a pencil, show whether any speed lies above it; if one does, it is refined in turn (level-set
    method, as for the H-infinity norm). Over a load range that holds at both ends; between them the peaks of a grid are
    refined, which is no proof: `certify` is. With a delay there are no such pencils: peaks of a fine row of speeds are refined.
    """
    if isinstance(envelope, Study):
        envelope = envelope.envelope
    points = [point for load in envelope.loads for point in _worst_at_load(gear, envelope, load, samples, enough)]
    if envelope.load_is_range and max(p.abscissa for p in points) <= enough:
        points += _worst_between_loads(gear, envelope, samples)
    return sorted(points, key=lambda point: -point.abscissa)


def _worst_between_loads(gear: LinearGear, envelope: Envelope, samples: int) -> list[OperatingPoint]:
    """Peaks of the abscissa over the rectangle of speeds and loads.

    Refined peaks of a grid first; then lines of constant speed, along which the abscissa's crossings of the level found are
    again eigenvalues of a pencil, now in the load: a ridge that lies between the loads of the grid is found where it cuts one.
    Last, the load of the best point is refined with the exact maximum over speed.
    """
    (low, high), (light, heavy) = (envelope.speed.min, envelope.speed.max), envelope.loads[:2]
    speeds = np.unique(np.clip(np.geomspace(low, high, samples), low, high))
    loads = np.union1d(np.linspace(light, heavy, LOADS), np.geomspace(light, heavy, LOADS))
    V, F_z = (grid.ravel() for grid in np.meshgrid(speeds, loads))
    height = gear.abscissa(V, F_z).reshape(len(loads), len(speeds))
    found = []
    for i, j in np.argwhere(height >= maximum_filter(height, 3, mode="nearest")):
        box = [
            (speeds[max(j - 1, 0)], speeds[min(j + 1, len(speeds) - 1)]),
            (loads[max(i - 1, 0)], loads[min(i + 1, len(loads) - 1)]),
        ]
        found.append(_refined_in_box(gear, (speeds[j], loads[i]), box))

    for speed in (max(found, key=lambda p: p.abscissa).speed, *np.unique(np.clip(np.geomspace(low, high, LINES), low, high))):
        level = max(p.abscissa for p in found)
        line = along_loads(gear, speed, light, heavy)
        cuts = loads[1:-1] if line is None else line.crossings(level + 1e-9 * (1 + abs(level)))
        ends = np.concatenate([[light], cuts, [heavy]])
        middles = (ends[1:] + ends[:-1]) / 2
        for i in np.flatnonzero(gear.abscissa(speed, middles) > level + 1e-9 * (1 + abs(level))):
            box = [(low, high), (ends[i], ends[i + 1])]
            found.append(_refined_in_box(gear, (speed, middles[i]), box))
            found += _worst_at_load(gear, envelope, found[-1].load, samples)
    # along an oblique ridge: the maximum over speed, exact at each load, as a function of the load
    top = max(found, key=lambda p: p.abscissa).load
    left, right = int(np.searchsorted(loads, top)), int(np.searchsorted(loads, top, "right"))
    bracket = loads[max(left - 1, 0)], loads[min(right, len(loads) - 1)]
    ridge = minimize_scalar(
        lambda load: -_worst_at_load(gear, envelope, load, samples)[0].abscissa,
        bounds=bracket,
        method="bounded",
        options={"xatol": 1e-8 * heavy, "maxiter": 60},
    )
    return found + _worst_at_load(gear, envelope, float(ridge.x), samples)


def _refined_in_box(gear: LinearGear, start: tuple[float, float], box: list[tuple[float, float]]) -> OperatingPoint:
    """Local maximum of the abscissa from a start within a box of speed and load."""
    low = np.array([edge[0] for edge in box])
    width = np.array([edge[1] - edge[0] for edge in box])

    def point(u: np.ndarray) -> OperatingPoint:
        speed, load = np.clip(low + u * width, [e[0] for e in box], [e[1] for e in box])
        return OperatingPoint(float(speed), float(load), float(gear.abscissa(speed, load)[0]))

    first = np.where(width > 0, (np.array(start) - low) / np.where(width > 0, width, 1), 0.0)
    best = minimize(
        lambda u: -point(u).abscissa,
        first,
        method="Nelder-Mead",
        bounds=[(0.0, float(w > 0)) for w in width],
        options={"xatol": 1e-7, "fatol": 1e-11, "maxfev": 400},
    )
    return max(point(first), point(best.x), key=lambda p: p.abscissa)


def tops_of(height: np.ndarray) -> list[int]:
    """Indices of the local maxima of a sequence, its ends included."""
    return [i for i in range(len(height)) if height[i] >= height[max(i - 1, 0) : i + 2].max()]


def top_of(height: Callable[[np.ndarray], np.ndarray], left: float, right: float) -> float:
    """Where a function has a maximum, by rows of arguments that close in on it: for what is quicker in rows.

    Parameters
    ----------
    height : callable
        (m,) arguments to (m,) values.
    left, right : float

    Returns
    -------
    float
    """
    for _ in range(ZOOMS):
        row = np.linspace(left, right, ROW)
        top = int(height(row).argmax())
        left, right = row[max(top - 1, 0)], row[min(top + 1, ROW - 1)]
    return float(row[top])


def _worst_at_load(
    gear: LinearGear, envelope: Envelope, load: float, samples: int, enough: float = np.inf
) -> list[OperatingPoint]:
    low, high = envelope.speed.min, envelope.speed.max
    delayed = isinstance(gear, DelayGear)

    def point(speed: float) -> OperatingPoint:
        return OperatingPoint(float(speed), float(load), float(gear.abscissa(speed, load)[0]))

    def refined(left: float, right: float) -> OperatingPoint:
        if delayed:
            return point(top_of(lambda V: gear.abscissa(V, load), left, right))
        best = minimize_scalar(
            lambda V: -gear.abscissa(V, load)[0], bounds=(left, right), method="bounded", options={"xatol": 1e-8 * right}
        )
        return max(point(best.x), point(left), point(right), key=lambda p: p.abscissa)

    if low == high:
        return [point(low)]
    samples = max(samples, math.ceil(PER_DECADE * math.log10(high / low))) if delayed else samples
    speeds = np.geomspace(low, high, samples)
    speeds[0], speeds[-1] = low, high
    height = gear.abscissa(speeds, load)
    if delayed and height.max() > enough:
        found = [OperatingPoint(float(speeds[i]), float(load), float(height[i])) for i in tops_of(height)]
        return sorted(found, key=lambda p: -p.abscissa)
    found = [refined(speeds[max(i - 1, 0)], speeds[min(i + 1, samples - 1)]) for i in tops_of(height)]

    if delayed:
        return sorted(found, key=lambda p: -p.abscissa)
    line = along_speeds(gear, load, low, high)
    for _ in range(20):
        best = max(p.abscissa for p in found)
        level = best + 1e-9 * (1 + abs(best))
        ends = np.concatenate([[low], line.crossings(level), [high]])
        middles = (ends[1:] + ends[:-1]) / 2
        above = [i for i, V in enumerate(middles) if gear.abscissa(V, load)[0] > level]
        if not above:
            break
        found += [refined(ends[i], ends[i + 1]) for i in above]
    return sorted(found, key=lambda p: -p.abscissa)

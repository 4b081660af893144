"""Stability charts: the boundary of a margin in a plane of two quantities, its type and frequency, and families of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..errors import ConfigError
from ..stability.linear import LinearModel
from ..study.study import Study
from .explicit import boundary as joint_lines
from .explicit import joint_of
from .plane import OPERATING, Axis, Plane, Tally, quantity_name
from .tracing import Polyline, trace

__all__ = ["Curve", "Family", "StabilityChart", "chart"]

STANDSTILL = 1e-6
"""Part of the largest eigenvalue below which the imaginary part of a critical one is zero."""

JUMP = 0.02
"""Relative change of frequency between neighbours that tells one mode from another."""

NEAR = 20
"""Tolerances between the neighbours at a corner, at most."""

CHECKED = 24
"""Points along an axis at which explicit curves are held against eigenvalues."""


@dataclass(frozen=True)
class Curve:
    """A piece of the boundary.

    Attributes
    ----------
    points : ndarray
        (m, 2) values of the two quantities [SI], in order; the first again at the end where it is closed.
    hopf : ndarray
        (m,) whether a pair of eigenvalues crosses; else a real one does: divergence.
    frequency : ndarray
        (m,) of the critical eigenvalue [Hz], 0 at divergence.
    closed : bool
    corners : ndarray
        (k, 2) points [SI] where divergence and Hopf meet, or another mode becomes critical.
    """

    points: np.ndarray
    hopf: np.ndarray
    frequency: np.ndarray
    closed: bool
    corners: np.ndarray


@dataclass(frozen=True)
class Family:
    """All curves for one value of what a chart varies (None: nothing is varied)."""

    value: float | None
    curves: tuple[Curve, ...]
    origin_stable: bool
    """Whether the margin is kept where both quantities are least."""
    abscissa: float | None
    """Spectral abscissa of the design that is drawn in [1/s]."""
    evaluations: int
    """State matrices whose eigenvalues were computed."""
    explicit: bool = False
    """Whether the curves are explicit ones, of quantities that act at one joint; else they are traced."""


@dataclass(frozen=True)
class StabilityChart:
    """Chart of a plane.

    Attributes
    ----------
    x, y : Axis
    margin : float
        [1/s]
    varied : Axis or None
        Name and unit of what distinguishes the families.
    families : tuple of Family
    design : dict
        Design variables [SI] that hold where they are not varied.
    mark : tuple or None
        (x, y) of the design in the plane.
    speed, load : float
        Where they are not varied [m/s], [N].
    tolerance, cell : float
        Distance of chords from the boundary, and the size down to which branches and islands are found by sign; both in
        fractions of the ranges. Smaller islands are sought from every local extremum of the grid, without a guarantee.
        Explicit curves need no search: their limit is the step in frequency.
    """

    x: Axis
    y: Axis
    margin: float
    varied: Axis | None
    families: tuple[Family, ...]
    design: dict[str, float]
    mark: tuple[float, float] | None
    speed: float
    load: float
    tolerance: float
    cell: float
    abscissa: float | None = None
    """Spectral abscissa of the design itself [1/s]: where speed or load is varied the largest, else at its own values."""

    def stable(self, x: np.ndarray, y: np.ndarray, family: int = 0) -> np.ndarray:
        """Whether the margin is kept, read off the curves alone.

        Parameters
        ----------
        x, y : ndarray
            (m,) points of the plane [SI].
        family : int

        Returns
        -------
        ndarray
            (m,) bool: from the corner of least values along the lower edge, then up, each crossing changes the side.
        """
        shown = self.families[family]
        low, span = np.array([self.x.low, self.y.low]), np.array([self.x.high - self.x.low, self.y.high - self.y.low])
        u, v = (np.stack([np.ravel(x), np.ravel(y)]) - low[:, None]) / span[:, None]
        crossings, order = np.zeros(u.size, int), np.argsort(u)
        for curve in shown.curves:
            p = (curve.points - low) / span
            if not curve.closed:
                ends = p[[0, -1]]
                crossings += (ends[ends[:, 1] == 0][:, 0][:, None] < u).sum(axis=0)
            a, b = p[:-1], p[1:]
            first, last = (
                np.searchsorted(u[order], end, side="right") for end in (np.minimum(a, b)[:, 0], np.maximum(a, b)[:, 0])
            )
            segment = np.repeat(np.arange(len(a)), last - first)  # each with the points in its range of x
            at = order[np.arange(segment.size) - np.repeat(np.cumsum(last - first) - last, last - first)]
            a, b = a[segment], b[segment]
            height = a[:, 1] + (b - a)[:, 1] * (u[at] - a[:, 0]) / (b - a)[:, 0]
            crossings += np.bincount(at[height < v[at]], minlength=u.size)
        return (shown.origin_stable ^ (crossings % 2 == 1)).reshape(np.shape(x))


def chart(
    study: Study,
    x: tuple[str, float, float],
    y: tuple[str, float, float],
    *,
    vary: tuple[str, Sequence[float]] | None = None,
    margin: float = 0.0,
    design: Mapping[str, float] | None = None,
    speed: float | None = None,
    load: float | None = None,
    cells: int = 48,
    tolerance: float = 1e-5,
    plane_type: type[Plane] = Plane,
) -> StabilityChart:
    """Trace the boundary of a stability margin in a plane of two quantities.

    Parameters
    ----------
    study : Study
    x, y : tuple
        (name, low, high) [SI]: ``speed``, ``vertical_load``, a design variable, or a number of the gear, the tyre, the damper
        or the material by its key path.
    vary : tuple or None
        (name, values) [SI]: one family of curves for each value.
    margin : float
        [1/s]
    design : mapping or None
        Design variables [SI], marked in the chart; None: the starts of the study, not marked.
    speed, load : float or None
        Where they are not varied [m/s], [N]; None: the largest of the envelope.
    cells : int
        Coarse cells along each axis.
    tolerance : float
        Distance between chords and boundary, in fractions of the ranges.
    plane_type : type
        What gives the matrices of the plane.

    Returns
    -------
    StabilityChart

    Raises
    ------
    ConfigError
        If a quantity or a range is not allowed.
    """
    if not 4 <= cells <= 2000:
        raise ConfigError(f"cells: found {cells}; allowed: 4 to 2000")
    if not 1e-9 <= tolerance <= 1e-2:
        raise ConfigError(f"tolerance: found {tolerance}; allowed: 1e-9 to 1e-2")
    if not 0 <= margin < np.inf:
        raise ConfigError(f"margin: found {margin}; allowed: a number >= 0 in 1/s")
    values = {**study.start, **(design or {})}
    speed = study.envelope.speed.max if speed is None else speed
    load = max(study.envelope.loads) if load is None else load
    plane = plane_type(study, Axis.of(study, *x), Axis.of(study, *y), values, speed, load, margin, model=LinearModel(study))
    varied: Axis | None = None
    families: list[float | None] = [None] if vary is None else list(vary[1])
    if vary is not None:
        name = quantity_name(study, vary[0])
        if name in (plane.x.name, plane.y.name):
            raise ConfigError(f"vary: {name} is on an axis; allowed: another quantity")
        varied = Axis.of(study, name, min(vary[1]), float(np.nextafter(max(vary[1]), np.inf)))
    numbers = {**values, "speed": speed, "vertical_load": load}
    mark = (numbers[plane.x.name], numbers[plane.y.name]) if {plane.x.name, plane.y.name} <= numbers.keys() and design else None
    record = StabilityChart(plane.x, plane.y, margin, varied, (), values, mark, speed, load, tolerance, 1 / cells)
    made = []
    for value in families:
        fixed = {} if varied is None or value is None else {varied.name: float(value)}
        here = replace(plane, fixed=fixed, tally=Tally())
        joint = joint_of(here)
        lines = None if joint is None else joint_lines(here, joint, tolerance)
        family = None if lines is None else _family(here, value, mark, lines, tolerance, explicit=True)
        if family is None or not _right_everywhere(replace(record, families=(family,)), here):
            family = _family(here, value, mark, trace(here.excess, cells, tolerance=tolerance), tolerance)
        made.append(family)
    return replace(record, families=tuple(made), abscissa=_of_design(plane, mark, varied, made))


def _of_design(plane: Plane, mark: tuple[float, float] | None, varied: Axis | None, made: Sequence[Family]) -> float | None:
    """Spectral abscissa of the design that is drawn in: a family with another value of a design variable is not that design."""
    if mark is None:
        return None
    if varied is not None and varied.name in OPERATING:
        return max(family.abscissa for family in made if family.abscissa is not None)
    return _at_mark(plane, mark)


def _at_mark(plane: Plane, mark: tuple[float, float]) -> float:
    place = [np.array([(m - a.low) / (a.high - a.low)]) for m, a in zip(mark, (plane.x, plane.y), strict=True)]
    return float(plane.excess(*place)[0]) - plane.margin


def _right_everywhere(record: StabilityChart, plane: Plane) -> bool:
    """Whether curves that no search has found tell the sides of a grid of points as eigenvalues do."""
    u, v = (grid.ravel() for grid in np.meshgrid(*2 * [(np.arange(CHECKED) + 0.5) / CHECKED]))
    return bool((record.stable(plane.x.at(u), plane.y.at(v)) == (plane.excess(u, v) < 0)).all())


def _family(
    plane: Plane,
    value: float | None,
    mark: tuple[float, float] | None,
    lines: Sequence[Polyline],
    tolerance: float,
    explicit: bool = False,
) -> Family:
    corner = bool(plane.excess(np.zeros(1), np.zeros(1))[0] < 0)
    curves = []
    for line in lines:
        u, v = line.points.T
        frequency = _frequency(plane, u, v) if line.frequency is None else line.frequency
        hopf = frequency > 0
        points = np.column_stack([plane.x.at(u), plane.y.at(v)])
        at = _corners(line.points, hopf, frequency, tolerance) if line.corners is None else line.corners
        curves.append(Curve(points, hopf, frequency, line.closed, (points[at] + points[at + 1]) / 2))
    abscissa = None if mark is None else _at_mark(plane, mark)
    return Family(value, tuple(curves), corner, abscissa, plane.evaluations, explicit)


def _frequency(plane: Plane, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Of the rightmost eigenvalue [Hz], 0 where it is real but for rounding."""
    roots = plane.rightmost(u, v)
    hopf = roots.imag > STANDSTILL * np.abs(plane.matrices(u, v)).max(axis=(1, 2))
    return np.where(hopf, roots.imag / (2 * np.pi), 0.0)


def _corners(points: np.ndarray, hopf: np.ndarray, frequency: np.ndarray, tolerance: float) -> np.ndarray:
    """Points (k,) behind which the kind changes, or the frequency jumps: there the chords are as short as the tolerance."""
    near = np.linalg.norm(np.diff(points, axis=0), axis=1) < NEAR * tolerance
    jump = near & (np.abs(np.diff(frequency)) > JUMP * np.maximum(frequency[1:], frequency[:-1]))
    kind = hopf[1:] != hopf[:-1]
    found: list[int] = []
    for k in [*np.flatnonzero(kind), *np.flatnonzero(jump & ~kind)]:
        if all(np.linalg.norm(points[k] - points[other]) > 3 * NEAR * tolerance for other in found):
            found.append(int(k))
    return np.array(sorted(found), int)

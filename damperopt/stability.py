"""Linear stability of a gear: state matrices, spectral abscissa, critical speeds and the worst points of an envelope."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.polynomial import Polynomial
from scipy.ndimage import maximum_filter
from scipy.optimize import brentq, minimize, minimize_scalar

from .dae import DAE
from .dynamics import build
from .hurwitz import characteristic_polynomial, hurwitz_determinants, shifted
from .results import OperatingPoint
from .specs import Envelope, Study
from .symbols import data_values, symbolic

__all__ = [
    "CriticalSpeed",
    "LinearGear",
    "LinearModel",
    "critical_speeds",
    "linear_gear",
    "linearise",
    "spectral_abscissa",
    "speed_polynomials",
    "worst_points",
]

DEGREE = 2
"""V times any coefficient of the characteristic polynomial is a polynomial of this degree in V, and a coefficient one of this
degree in F_z: V enters the state matrix as V in the string row and as 1/V in the yaw row only, F_z in two rows."""

LOADS = 9
"""Loads of the first look at a load range, spaced evenly, and as many spaced geometrically."""

LINES = 7
"""Lines of constant speed along which a load range is searched exactly."""


def linearise(dae: DAE) -> ca.Function:
    """State matrix at the equilibrium x = 0, by automatic differentiation.

    Parameters
    ----------
    dae : DAE

    Returns
    -------
    casadi.Function
        (design, speed, load, data) -> (n, n) matrix f_x - f_z g_z^-1 g_x.
    """
    A = ca.jacobian(dae.ode, dae.x)
    if dae.z.numel():
        A -= ca.jacobian(dae.ode, dae.z) @ ca.solve(ca.jacobian(dae.alg, dae.z), ca.jacobian(dae.alg, dae.x))
    A = ca.densify(ca.substitute(A, dae.x, ca.SX.zeros(dae.x.shape)))
    return ca.Function("state_matrix", [dae.design, dae.speed, dae.load, dae.data], [A])


@dataclass(frozen=True)
class CriticalSpeed:
    """A speed at which a root crosses the imaginary axis (or the line Re = -margin).

    Attributes
    ----------
    speed, load : float
        [m/s], [N].
    kind : str
        ``hopf`` (a pair, flutter-like shimmy) or ``divergence`` (a real root).
    frequency : float
        Of the crossing pair [Hz]; 0 for divergence.
    destabilising : bool
        True where the root moves to the right with rising speed.
    boundary : bool
        True where the gear as a whole changes between stable and unstable there.
    """

    speed: float
    load: float
    kind: str
    frequency: float
    destabilising: bool
    boundary: bool


@dataclass(frozen=True)
class LinearGear:
    """State matrices of one gear with one design.

    Attributes
    ----------
    matrices : callable
        (speeds, loads), each (m,) or scalar [m/s], [N] -> (m, n, n) state matrices.
    state_names : tuple of str
        Names of the n states.
    """

    matrices: Callable[[Any, Any], np.ndarray]
    state_names: tuple[str, ...]

    def abscissa(self, speeds: Any, loads: Any) -> np.ndarray:
        """Spectral abscissa [1/s], (m,)."""
        return spectral_abscissa(self.matrices(speeds, loads))


class LinearModel:
    """Linear model of a study, built once; `at(design)` gives the gear with a design.

    Parameters
    ----------
    study : Study
    """

    def __init__(self, study: Study):
        dae = build(symbolic(study))
        self.state_names = dae.state_names
        self.design_names = dae.design_names
        self.state_matrix = linearise(dae)
        self._data = ca.DM(data_values(study))

    def at(self, design: Mapping[str, float]) -> LinearGear:
        """The gear with `design` (design variables by name, SI)."""
        n = len(self.state_names)
        values = ca.DM([design[name] for name in self.design_names])

        def matrices(speeds: Any, loads: Any) -> np.ndarray:
            V, F_z = np.broadcast_arrays(np.atleast_1d(np.asarray(speeds, float)), np.asarray(loads, float))
            columns = self.state_matrix(ca.repmat(values, 1, V.size), V.reshape(1, -1), F_z.reshape(1, -1), self._data)
            return columns.full().reshape(n, V.size, n).transpose(1, 0, 2)

        return LinearGear(matrices, self.state_names)


def linear_gear(study: Study, design: Mapping[str, float] | None = None) -> LinearGear:
    """Linear model of a study with a design.

    Parameters
    ----------
    study : Study
    design : mapping or None
        Design variables [SI]; None: the starts of the study.

    Returns
    -------
    LinearGear
    """
    model = LinearModel(study)
    if design is None:
        design = study.start
    return model.at(design)


def spectral_abscissa(A: np.ndarray) -> np.ndarray:
    """Largest real part of the eigenvalues of stacked matrices.

    Parameters
    ----------
    A : ndarray
        (..., n, n) [1/s]

    Returns
    -------
    ndarray
        (...) [1/s]

    Examples
    --------
    >>> float(spectral_abscissa(np.array([[0.0, 1.0], [-4.0, -0.6]])).round(6))
    -0.3
    """
    return np.linalg.eigvals(A).real.max(axis=-1)


def speed_polynomials(gear: LinearGear, load: float, top_speed: float) -> list[Polynomial]:
    """Characteristic polynomial as a function of speed.

    Parameters
    ----------
    gear : LinearGear
    load : float
        Vertical load [N].
    top_speed : float
        Speed that scales the argument [m/s].

    Returns
    -------
    list of Polynomial
        v a_0, ..., v a_n as polynomials in v = V/top_speed (a common factor v > 0 moves no root).
    """
    v = _chebyshev_points()
    a = characteristic_polynomial(gear.matrices(v * top_speed, load))
    return _interpolated([a_i * v for a_i in a])


def _chebyshev_points() -> np.ndarray:
    return 0.5 + 0.5 * np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))


def _interpolated(samples: list[np.ndarray]) -> list[Polynomial]:
    """Polynomials of degree `DEGREE` through samples at the Chebyshev points."""
    points = _chebyshev_points()
    to_coefficients = np.linalg.inv(np.vander(points, increasing=True))
    return [Polynomial(to_coefficients @ np.broadcast_to(values, points.shape)) for values in samples]


def crossing_speeds(polynomials: list[Polynomial], top_speed: float, level: float, low: float, high: float) -> np.ndarray:
    """Speeds in [low, high] at which some root has the real part `level` [1/s], ascending [m/s]."""
    return _crossings(polynomials, level, low / top_speed, high / top_speed) * top_speed


def crossing_loads(gear: LinearGear, speed: float, level: float, low: float, high: float) -> np.ndarray:
    """Loads in [low, high] at which some root has the real part `level` [1/s] at one speed, ascending [N]."""
    f = _chebyshev_points()
    a = characteristic_polynomial(gear.matrices(speed, f * high))
    return _crossings(_interpolated(a), level, low / high, 1.0) * high


def _crossings(polynomials: list[Polynomial], level: float, low: float, high: float) -> np.ndarray:
    """Arguments in [low, high] at which a polynomial in s with these coefficients has a root of real part `level`."""
    moved = shifted(polynomials, -level)
    candidates = []
    for condition in (moved[-1], hurwitz_determinants(moved)[-2]):
        largest = np.abs(condition.coef).max()
        roots = condition.trim(largest * 1e-15).roots() if largest > 0 else np.array([])
        # a pair of equal roots comes out as a complex pair of tiny imaginary part: keep it, callers look for themselves
        candidates.append(roots.real[np.abs(roots.imag) < 1e-6 * (np.abs(roots.real) + 1e-9)])
    found = np.concatenate(candidates)
    return np.unique(found[(found >= low) & (found <= high)])


def critical_speeds(gear: LinearGear, load: float, low: float, high: float, margin: float = 0.0) -> list[CriticalSpeed]:
    """Speeds at which a root crosses Re = -margin, as roots of a_n and H_(n-1) in V, not as hits of a grid.

    Parameters
    ----------
    gear : LinearGear
    load : float
        Vertical load [N].
    low, high : float
        Speed range [m/s].
    margin : float
        Stability margin [1/s].

    Returns
    -------
    list of CriticalSpeed
        Ascending in speed.
    """
    polynomials = speed_polynomials(gear, load, high)
    found = []
    for rough in crossing_speeds(polynomials, high, -margin, low, high):
        eigenvalues = np.linalg.eigvals(gear.matrices(rough, load)[0]) + margin
        crossing = eigenvalues[np.abs(eigenvalues.real).argmin()]

        def real_part(V: float, near: complex = crossing) -> float:
            values = np.linalg.eigvals(gear.matrices(V, load)[0]) + margin
            return float(values[np.abs(values - near).argmin()].real)

        speed = _polish(real_part, float(rough))
        if abs(real_part(speed)) > 1e-6 * (1 + abs(crossing)):
            continue  # H_(n-1) = 0 also where two real roots are +-r: nothing crosses
        step = 1e-5 * speed
        before, after = gear.abscissa([speed - step, speed + step], load) + margin
        pair = abs(crossing.imag) > 1e-6 * (1 + abs(crossing))
        found.append(
            CriticalSpeed(
                speed=speed,
                load=load,
                kind="hopf" if pair else "divergence",
                frequency=float(abs(crossing.imag) / (2 * np.pi)) if pair else 0.0,
                destabilising=bool(real_part(speed + step) > real_part(speed - step)),
                boundary=bool((before < 0) != (after < 0)),
            )
        )
    return found


def _polish(function: Callable[[float], float], rough: float) -> float:
    for width in (1e-9, 1e-7, 1e-5, 1e-3):
        ends = rough * (1 - width), rough * (1 + width)
        if function(ends[0]) * function(ends[1]) < 0:
            return float(brentq(function, *ends, xtol=1e-14 * rough, rtol=1e-14))
    return rough  # touches the axis without crossing it


def worst_points(gear: LinearGear, envelope: Envelope, enough: float = np.inf, samples: int = 40) -> list[OperatingPoint]:
    """Local maxima of the spectral abscissa over the envelope, the global one first.

    Parameters
    ----------
    gear : LinearGear
    envelope : Envelope
    enough : float
        Over a load range: if its ends show an abscissa above this, their maxima are returned without looking between.
    samples : int
        Speeds of the first look; the result does not hang on it, see Notes.

    Returns
    -------
    list of OperatingPoint
        Descending in abscissa.

    Notes
    -----
    At each load the maximum over speed is global: beyond the refined samples, the polynomials a_n(V) and H_(n-1)(V),
    shifted to the level found, show whether any speed lies above it; if one does, it is refined in turn (level-set
    method, as for the H-infinity norm). Over a load range that holds at both ends; between them the peaks of a grid are
    refined, which is no proof: `certify` is.
    """
    points = [point for load in envelope.loads for point in _worst_at_load(gear, envelope, load, samples)]
    if envelope.load_is_range and max(p.abscissa for p in points) <= enough:
        points += _worst_between_loads(gear, envelope, samples)
    return sorted(points, key=lambda point: -point.abscissa)


def _worst_between_loads(gear: LinearGear, envelope: Envelope, samples: int) -> list[OperatingPoint]:
    """Peaks of the abscissa over the rectangle of speeds and loads.

    Refined peaks of a grid first; then lines of constant speed, along which the abscissa's crossings of the level found are
    again zeros of polynomials, now in the load: a ridge that lies between the loads of the grid is found where it cuts one.
    """
    (low, high), (light, heavy) = (envelope.speed.min, envelope.speed.max), envelope.loads[:2]
    speeds = np.unique(np.geomspace(low, high, samples))
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

    for speed in (max(found, key=lambda p: p.abscissa).speed, *np.unique(np.geomspace(low, high, LINES))):
        level = max(p.abscissa for p in found)
        ends = np.concatenate([[light], crossing_loads(gear, speed, level + 1e-9 * (1 + abs(level)), light, heavy), [heavy]])
        middles = (ends[1:] + ends[:-1]) / 2
        for i in np.flatnonzero(gear.abscissa(speed, middles) > level + 1e-9 * (1 + abs(level))):
            box = [(low, high), (ends[i], ends[i + 1])]
            found.append(_refined_in_box(gear, (speed, middles[i]), box))
            found += _worst_at_load(gear, envelope, found[-1].load, samples)
    return found


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


def _peaks(height: np.ndarray) -> list[int]:
    """Indices of the local maxima of a sequence, its ends included."""
    return [i for i in range(len(height)) if height[i] >= height[max(i - 1, 0) : i + 2].max()]


def _worst_at_load(gear: LinearGear, envelope: Envelope, load: float, samples: int) -> list[OperatingPoint]:
    low, high = envelope.speed.min, envelope.speed.max

    def point(speed: float) -> OperatingPoint:
        return OperatingPoint(float(speed), float(load), float(gear.abscissa(speed, load)[0]))

    def refined(left: float, right: float) -> OperatingPoint:
        best = minimize_scalar(
            lambda V: -gear.abscissa(V, load)[0], bounds=(left, right), method="bounded", options={"xatol": 1e-8 * right}
        )
        return max(point(best.x), point(left), point(right), key=lambda p: p.abscissa)

    if low == high:
        return [point(low)]
    speeds = np.geomspace(low, high, samples)
    speeds[0], speeds[-1] = low, high
    height = gear.abscissa(speeds, load)
    found = [refined(speeds[max(i - 1, 0)], speeds[min(i + 1, samples - 1)]) for i in _peaks(height)]

    polynomials = speed_polynomials(gear, load, high)
    for _ in range(20):
        best = max(p.abscissa for p in found)
        level = best + 1e-9 * (1 + abs(best))
        ends = np.concatenate([[low], crossing_speeds(polynomials, high, level, low, high), [high]])
        middles = (ends[1:] + ends[:-1]) / 2
        above = [i for i, V in enumerate(middles) if gear.abscissa(V, load)[0] > level]
        if not above:
            break
        found += [refined(ends[i], ends[i + 1]) for i in above]
    return sorted(found, key=lambda p: -p.abscissa)

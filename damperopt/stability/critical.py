"""Critical speeds: where a root of the characteristic polynomial crosses the axis, as roots and not as hits of a grid."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial
from scipy.optimize import brentq

from ..errors import ConfigError
from .hurwitz import characteristic_polynomial, hurwitz_determinant, shifted
from .linear import LinearGear

__all__ = ["CriticalSpeed", "critical_speeds", "crossing_loads", "crossing_speeds", "speed_polynomials"]

DEGREE = 2
"""V times any coefficient of the characteristic polynomial is a polynomial of this degree in V, and a coefficient one of this
degree in F_z: V enters the state matrix as V in the string row and as 1/V in the yaw row only, F_z in two rows."""


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
    for condition in (moved[-1], hurwitz_determinant(moved, len(moved) - 2)):
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

    Raises
    ------
    ConfigError
        If speeds or load are not positive, or the range is inverted.
    """
    if not (0 < low <= high < np.inf and 0 < load < np.inf):
        raise ConfigError(f"found speeds {low:g} to {high:g} m/s, load {load:g} N; allowed: 0 < low <= high, load > 0")
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

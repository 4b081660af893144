"""Hopf points over any parameter, and how an orbit begins there."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from .collocation import STAGES, Leg, Path, tableau
from .flow import Flow
from .newton import Tangent

__all__ = ["INTERVALS", "HopfPoint", "first_orbit", "hopf_points", "is_odd"]

INTERVALS = 10
"""Of half a cycle."""

SCAN = 400
"""Values of a parameter at which eigenvalues are counted; two crossings between two of them are missed."""

ODD = 1e-9
"""Relative: f(S x) - S f(x) of a mirror-symmetric model is rounding."""


@dataclass(frozen=True)
class HopfPoint:
    """Where a pair of eigenvalues crosses the imaginary axis.

    Attributes
    ----------
    parameter : float
        Value of what is varied [SI].
    frequency : float
        omega [rad/s].
    vector : ndarray
        (n,) complex eigenvector, of yaw angle 1 or else of length 1.
    destabilising : bool
        Whether the pair moves to the right with the parameter.
    """

    parameter: float
    frequency: float
    vector: np.ndarray
    destabilising: bool


def is_odd(flow: Flow, parameters: np.ndarray) -> bool:
    """Whether a motion and its mirror image are both motions of the model, to rounding."""
    x = np.random.default_rng(0).uniform(-1e-2, 1e-2, (16, flow.n))
    none = np.zeros_like(parameters)
    pairs = (flow, x), (flow.mirrored, x * flow.mirror)
    rates = [side.slopes(y, side.unknowns(y, parameters), parameters, none).rates for side, y in pairs]
    sizes = np.abs(rates[0]).max(axis=0)
    return bool((np.abs(rates[1] - flow.mirror * rates[0]) <= ODD * sizes).all())


def hopf_points(
    flow: Flow, parameters: np.ndarray, name: str, low: float, high: float, more: Iterable[float] = ()
) -> list[HopfPoint]:
    """Crossings of pairs over a parameter, ascending.

    Parameters
    ----------
    flow : Flow
    parameters : ndarray
        All others are held.
    name : str
    low, high : float
        Range of the parameter [SI].
    more : iterable of float
        Values near which a crossing is known.
    """
    direction = flow.along(name)
    rest = parameters * (1 - direction)

    def roots(p: float) -> np.ndarray:
        values = np.linalg.eigvals(flow.state_matrix(rest + p * direction))
        return values[values.imag > 1e-6 * np.abs(values).max()]

    near = [value * (1 + side * 1e-4) for value in more for side in (-1, 1)]
    values = np.unique(np.clip([*np.linspace(low, high, SCAN), *near], low, high))
    unstable = [int((roots(p).real > 0).sum()) for p in values]
    found = []
    for a, b, before, after in zip(values, values[1:], unstable, unstable[1:], strict=False):
        for number in range(min(before, after) + 1, max(before, after) + 1):

            def crossing(p: float, number: int = number) -> float:
                real = np.sort(roots(p).real)[::-1]
                return float(real[number - 1]) if len(real) >= number else -1.0

            at = float(brentq(crossing, a, b, xtol=1e-13 * abs(b), rtol=1e-14))
            found.append(_point(flow, rest + at * direction, at, after > before))
    return sorted(found, key=lambda point: point.parameter)


def _point(flow: Flow, parameters: np.ndarray, at: float, destabilising: bool) -> HopfPoint:
    values, vectors = np.linalg.eig(flow.state_matrix(parameters))
    kept = np.flatnonzero(values.imag > 1e-6 * np.abs(values).max())
    k = kept[np.abs(values[kept].real).argmin()]
    vector, yaw = vectors[:, k], vectors[flow.index("yaw_angle"), k]
    scale = yaw if abs(yaw) > 1e-6 * np.linalg.norm(vector) else np.linalg.norm(vector)
    return HopfPoint(at, float(values[k].imag), vector / scale, destabilising)


def first_orbit(flow: Flow, point: HopfPoint, parameters: np.ndarray, half: bool) -> tuple[Path, Tangent]:
    """The rest as an orbit of amplitude zero at a Hopf point, and the direction in which it grows: yaw angle 1."""
    c, _, _ = tableau()
    N = INTERVALS * (2 - half)
    duration = np.pi * (2 - half) / point.frequency
    times = duration / N * (np.arange(N)[:, None] + c)
    wave = np.real(np.exp(1j * point.frequency * times)[..., None] * point.vector)
    rest = np.zeros((N, STAGES, flow.n))
    z = flow.unknowns(np.zeros((1, flow.n)), parameters)[0]
    leg = Leg(flow, duration, np.zeros(flow.n), rest, np.broadcast_to(z, (N, STAGES, flow.m)).copy())
    z_x = flow.slopes(np.zeros((1, flow.n)), z[None], parameters, np.zeros_like(parameters)).unknowns[1][0]
    growth = Tangent((wave,), (wave @ z_x.T,), np.zeros(1), 0.0)
    return Path((leg,), parameters, half), growth

"""Periodic orbits by collocation: Radau IIA over intervals, each condensed to how its end follows its start.

An orbit is a chain of legs. Within a leg the equations are smooth; it ends where a corner is met, and its duration is an
unknown. The last leg closes the orbit: x(T) = S x(0), with S = 1, or with S the mirror where the second half of the cycle is
the mirrored first. Radau IIA of m stages is of order 2 m - 1 at the ends of intervals, and damps what is stiff (its stability
function vanishes at infinity), so that multipliers of fast modes are right. Source: Hairer & Wanner (1996), IV.5; condensation
as in Doedel, Keller & Kernevez (1991).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.polynomial import Legendre

from .flow import Flow

__all__ = ["STAGES", "Leg", "Linearised", "Path", "linearised", "points_of", "tableau"]

STAGES = 4
"""m, of order 7 at the ends of intervals."""


@cache
def tableau(stages: int = STAGES) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Nodes c (m,), matrix A (m, m) of Radau IIA, and Lagrange values: (m + 1, m + 1) from 0 and the nodes to powers.

    Examples
    --------
    >>> c, A, _ = tableau(2)
    >>> c.round(12).tolist(), (12 * A).round(12).tolist()
    ([0.333333333333, 1.0], [[5.0, -1.0], [9.0, 3.0]])
    """
    shifted = Legendre.basis(stages) - Legendre.basis(stages - 1)  # vanishes at x = 1 and at the other nodes
    c = np.sort((shifted.roots().real + 1) / 2)
    c[-1] = 1.0
    powers = np.vander(c, stages, increasing=True)
    integrals = powers * c[:, None] / np.arange(1, stages + 1)
    nodes = np.concatenate([[0.0], c])
    return c, np.linalg.solve(powers.T, integrals.T).T, np.linalg.inv(np.vander(nodes, increasing=True))


@dataclass(frozen=True)
class Leg:
    """A smooth part of an orbit.

    Attributes
    ----------
    flow : Flow
        Its equations.
    duration : float
        [s]
    start : ndarray
        (n,) state.
    x, z : ndarray
        (N, m, n) states and (N, m, k) unknowns at the stages of N intervals; the last stage is the end of its interval.
    """

    flow: Flow
    duration: float
    start: np.ndarray
    x: np.ndarray
    z: np.ndarray

    @property
    def end(self) -> np.ndarray:
        """(n,) state."""
        return self.x[-1, -1]

    @property
    def starts(self) -> np.ndarray:
        """(N, n) states at the starts of the intervals."""
        return np.vstack([self.start, self.x[:-1, -1]])

    @property
    def times(self) -> np.ndarray:
        """(N m,) of the stages from the start of the leg [s]."""
        N = len(self.x)
        return (self.duration / N * (np.arange(N)[:, None] + tableau(self.x.shape[1])[0])).ravel()

    def at(self, fractions: np.ndarray) -> np.ndarray:
        """States (k, n) at fractions 0 to 1 of the duration, by the polynomials of the intervals."""
        N = len(self.x)
        number = np.minimum((fractions * N).astype(int), N - 1)
        powers = np.vander(fractions * N - number, self.x.shape[1] + 1, increasing=True)
        values = np.concatenate([self.starts[:, None], self.x], axis=1)
        found: np.ndarray = np.einsum("kp,pj,kjn->kn", powers, tableau(self.x.shape[1])[2], values[number])
        return found


@dataclass(frozen=True)
class Path:
    """A chain of legs, parameters, and how the last end closes on the start.

    Attributes
    ----------
    legs : tuple of Leg
    parameters : ndarray
        As `Flow.values` has them.
    half : bool
        Whether the legs are half of the cycle, the other half mirrored.
    """

    legs: tuple[Leg, ...]
    parameters: np.ndarray
    half: bool

    @property
    def closing(self) -> np.ndarray:
        """(n,) diagonal of S."""
        mirror = self.legs[0].flow.mirror
        return mirror if self.half else np.ones_like(mirror)

    @property
    def period(self) -> float:
        """Of the whole cycle [s]."""
        return (1 + self.half) * sum(leg.duration for leg in self.legs)

    @property
    def states(self) -> np.ndarray:
        """(k, n) at all stages."""
        return np.concatenate([leg.x.reshape(-1, leg.flow.n) for leg in self.legs])

    def moved(self, corrections: Sequence[tuple[np.ndarray, np.ndarray, float]], parameters: np.ndarray) -> Path:
        """With (N, m, n) and (N, m, k) added to stages and unknowns and a time [s] to the duration of each leg."""
        start = corrections[-1][0][-1, -1] + self.legs[-1].end
        start = self.closing * start
        legs = []
        for leg, (dx, dz, dT) in zip(self.legs, corrections, strict=True):
            legs.append(replace(leg, start=start, x=leg.x + dx, z=leg.z + dz, duration=leg.duration + dT))
            start = legs[-1].end
        return replace(self, legs=tuple(legs), parameters=parameters)


@dataclass(frozen=True)
class Linearised:
    """A leg to first order: corrections of all stages by those of its start, duration and parameter.

    Attributes
    ----------
    states : ndarray
        (N, m, n, n + 3): d stage = [by start, by duration, by parameter, constant].
    unknowns : ndarray
        (N, m, k, n + 3)
    """

    states: np.ndarray
    unknowns: np.ndarray

    @property
    def end(self) -> np.ndarray:
        """(n, n + 3) of the last stage."""
        return self.states[-1, -1]

    def corrections(self, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Of stages and unknowns by (n + 3,) d start, d duration, d parameter, 1."""
        return self.states @ d, self.unknowns @ d


def linearised(leg: Leg, parameters: np.ndarray, direction: np.ndarray) -> Linearised:
    """One step of Newton's method on the collocation equations of a leg, its start, duration and parameter left open.

    Parameters
    ----------
    leg : Leg
    parameters, direction : ndarray
        Of the flow; what is varied.
    """
    N, m, n = leg.x.shape
    _, a, _ = tableau(m)
    h = leg.duration / N
    found = leg.flow.slopes(leg.x.reshape(-1, n), leg.z.reshape(N * m, -1), parameters, direction)
    rates, slopes, along = (
        value.reshape(N, m, *value.shape[1:]) for value in (found.rates, found.by_state, found.by_parameter)
    )
    # X_i - x - h sum a_ij f(X_j) = 0: d X = J^-1 (d x + a f dh + h a f_p dp - residual)
    J = np.eye(m * n) - h * np.einsum("ij,rjkl->rikjl", a, slopes).reshape(N, m * n, m * n)
    flow = np.einsum("ij,rjk->rik", a, rates)
    right = np.empty((N, m, n, n + 3))
    right[..., :n] = np.eye(n)
    right[..., n] = flow / N
    right[..., n + 1] = h * np.einsum("ij,rjk->rik", a, along)
    right[..., n + 2] = leg.starts[:, None] + h * flow - leg.x
    own = np.linalg.solve(J, right.reshape(N, m * n, n + 3)).reshape(N, m, n, n + 3)
    states = np.empty_like(own)
    before = np.zeros((n, n + 3))
    before[:, :n] = np.eye(n)
    # the start of the leg is that of the first interval; of later ones the end of the one before
    for r in range(N):
        states[r] = own[r, ..., :n] @ before
        states[r, ..., n:] += own[r, ..., n:]
        before = states[r, -1]
    step, z_x, z_p = (value.reshape(N, m, *value.shape[1:]) for value in found.unknowns)
    unknowns = z_x @ states
    unknowns[..., n + 1] += z_p
    unknowns[..., n + 2] += step
    return Linearised(states, unknowns)


def points_of(path: Path, count: int) -> list[tuple[np.ndarray, np.ndarray]]:
    """Times from the start of the orbit [s] and states of each leg at `count` + 1 even points, ends included."""
    begin, found = 0.0, []
    for leg in path.legs:
        u = np.linspace(0, 1, count + 1)
        found.append((begin + u * leg.duration, leg.at(u)))
        begin += leg.duration
    return found

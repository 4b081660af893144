"""The linear model as a finite sum over powers of speed and load: A(V, F_z) = sum of V^i F_z^j A_ij.

Which powers occur is a fact of the components, which declare it (`SPEED_POWERS`, `LOAD_POWERS`); a model that does not keep
them is refused. What rests on it: critical speeds, the worst speed, and the exact certificate.

Where a root of a gear crosses a line Re = level, either A - level 1 is singular (a real root), or two roots s_i, s_j have the
sum 2 level. The sums of two roots are the eigenvalues of the second additive compound of A (of half the bialternate product
2 A . 1), linear in A and of order n (n - 1)/2. Both are polynomials in V whose coefficients are matrices, so that all crossings
of a range are eigenvalues of two linear pencils: no determinant is expanded, and no degree is assumed.
Source: Govaerts, Numerical Methods for Bifurcations of Dynamical Equilibria (2000), section 4.4.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from scipy.linalg import eigvals, matrix_balance

from ..errors import ConfigError

__all__ = ["Line", "Powers", "coefficients", "compound", "powers_of", "united"]

KEPT = 1e-9
"""Relative to the terms of an entry: how closely the declared powers must give a matrix at points that made none of them."""

NOTHING = 1e-14
"""Relative to the largest term of an entry: what rounding leaves of a power that does not occur in it."""

DECADES = 3.0
"""Ratio of the ends of a stretch, in decades: over more of them a power's rounding would outgrow another power."""

NEAR_REAL = 1e-4
"""Relative imaginary part up to which a root of a pencil is kept: double roots part by the root of their rounding."""


@dataclass(frozen=True)
class Powers:
    """Powers of speed and load in the state matrix.

    Attributes
    ----------
    speed : tuple of int
        Of V; a rolling tyre on a string makes -1, 0 and 1.
    load : tuple of int or None
        Of F_z; None: no polynomial in the load.
    """

    speed: tuple[int, ...] = (-1, 0, 1)
    load: tuple[int, ...] | None = (0, 1)


def powers_of(study: Any) -> Powers:
    """Powers that the components of a study declare, united.

    Parameters
    ----------
    study : Study

    Returns
    -------
    Powers
    """
    return united(study.gear, study.tyre, getattr(study.tyre, "contact", study.tyre), study.damper, study.damper.actuator)


def united(*parts: Any) -> Powers:
    """Powers that parts of a model declare, united.

    Parameters
    ----------
    *parts : object
        Components, or others with `SPEED_POWERS` and `LOAD_POWERS`, or `load_powers` of their own numbers; None: a part that
        is not there.

    Returns
    -------
    Powers
    """
    parts = tuple(part for part in parts if part is not None)
    speed = [getattr(part, "SPEED_POWERS", Powers.speed) for part in parts]
    declared = [getattr(part, "load_powers", getattr(part, "LOAD_POWERS", Powers.load)) for part in parts]
    load = [powers for powers in declared if powers is not None]
    polynomial = tuple(sorted({0, *itertools.chain(*load)})) if len(load) == len(declared) else None
    return Powers(tuple(sorted({0, *itertools.chain(*speed)})), polynomial)


def coefficients(samples: Any, inverse: Any) -> list[Any]:
    """Coefficients of powers from samples, by the inverse of the matrix of powers at their points; numbers of any kind."""
    return [sum((sample * w for sample, w in zip(samples[1:], row[1:], strict=True)), samples[0] * row[0]) for row in inverse]


@cache
def _inverse(powers: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Points around 1, and the inverse of the matrix of their powers."""
    points = 2.0 ** (np.arange(len(powers)) - (len(powers) - 1) / 2)
    return points, np.linalg.inv(points[:, None] ** np.array(powers))


@cache
def _pairs(n: int) -> tuple[np.ndarray, np.ndarray]:
    """(n, n, m) antisymmetric matrices of unit length, one for each pair of states, and their numbers."""
    first, second = np.triu_indices(n, 1)
    basis = np.zeros((n, n, first.size))
    index = np.arange(first.size)
    basis[first, second, index], basis[second, first, index] = math.sqrt(0.5), -math.sqrt(0.5)
    return basis, index


def compound(A: np.ndarray) -> np.ndarray:
    """Second additive compound: its eigenvalues are the sums s_i + s_j, i < j, of those of A.

    Parameters
    ----------
    A : ndarray
        (n, n)

    Returns
    -------
    ndarray
        (m, m), m = n (n - 1)/2

    Examples
    --------
    >>> sums = np.linalg.eigvals(compound(np.diag([1.0, 2.0, 4.0])))
    >>> sorted(round(float(value), 12) for value in sums.real)
    [3.0, 5.0, 6.0]
    """
    basis, _ = _pairs(len(A))
    # the map X -> A X + X A' on antisymmetric matrices
    flat = basis.reshape(-1, basis.shape[2])
    moved = np.tensordot(A, basis, 1)
    return flat.T @ (moved - moved.transpose(1, 0, 2)).reshape(flat.shape)


class Line:
    """State matrices along one quantity, the other held: a polynomial in it.

    Parameters
    ----------
    matrices : callable
        (m,) values -> (m, n, n) state matrices.
    powers : sequence of int
        Powers that occur.
    low, high : float
        Range of the quantity, positive.
    name : str
        For messages.

    Raises
    ------
    ConfigError
        If the matrices are no combination of these powers.
    """

    def __init__(self, matrices: Callable[[np.ndarray], np.ndarray], powers: Sequence[int], low: float, high: float, name: str):
        self._powers, self._low, self._high = tuple(powers), low, high
        count = max(1, math.ceil(math.log10(high / low) / DECADES))
        ends = low * (high / low) ** (np.arange(count + 1) / count)
        ends[-1] = high
        self._stretches = [_Stretch(matrices, self._powers, *pair, name) for pair in itertools.pairwise(ends)]

    def crossings(self, level: float) -> np.ndarray:
        """Values within the range at which some root may have the real part `level` [1/s], ascending.

        None is missing but for rounding; callers look whether a root lies on the line at each, since two real roots that
        lie at equal distances to its two sides are found too.
        """
        return np.unique(np.clip(np.concatenate([s.crossings(level) for s in self._stretches]), self._low, self._high))


class _Stretch:
    """A part of a line over which rounding of one power does not outgrow another."""

    def __init__(
        self, matrices: Callable[[np.ndarray], np.ndarray], powers: tuple[int, ...], low: float, high: float, name: str
    ):
        self._low, self._high = low, high
        self._scale = scale = math.sqrt(low * high)
        points, inverse = _inverse(powers)
        parts = coefficients(matrices(points * scale), inverse)
        self._check(matrices, dict(zip(powers, parts, strict=True)), name)
        largest = np.abs(parts).max(axis=0)
        parts = [np.where(np.abs(part) > NOTHING * largest, part, 0.0) for part in parts]
        _, (weights, _) = matrix_balance(np.abs(parts).sum(axis=0), permute=False, separate=True)
        kept = {i: part * (weights / weights[:, None]) for i, part in zip(powers, parts, strict=True) if part.any()}
        lowest, highest = min([0, *kept]), max([0, *kept])
        zero = np.zeros_like(parts[0])
        self._origin = -lowest
        self._parts = [kept.get(i, zero) for i in range(lowest, highest + 1)]
        self._compounds = [compound(part) for part in self._parts]

    def _check(self, matrices: Callable[[np.ndarray], np.ndarray], parts: dict[int, np.ndarray], name: str) -> None:
        values = np.array([self._low, self._scale * 1.3, self._high])
        for value, found in zip(values, matrices(values), strict=True):
            terms = [part * (value / self._scale) ** i for i, part in parts.items()]
            rebuilt, size = sum(terms), sum(map(np.abs, terms))
            if (np.abs(found - rebuilt) > KEPT * size).any():
                declared = ", ".join(map(str, parts))
                raise ConfigError(
                    f"the linear model is no combination of the powers {declared} of the {name}, as its components declare; "
                    f"found another at {value:g}; allowed: powers that SPEED_POWERS and LOAD_POWERS name"
                )

    def crossings(self, level: float) -> np.ndarray:
        found = [
            _pencil_roots(self._shifted(self._parts, level)),
            _pencil_roots(self._shifted(self._compounds, 2 * level)),
        ]
        roots = np.concatenate(found) * self._scale
        real = roots.real[np.abs(roots.imag) <= NEAR_REAL * np.abs(roots.real)]
        return real[(real >= self._low * (1 - KEPT)) & (real <= self._high * (1 + KEPT))]

    def _shifted(self, parts: list[np.ndarray], level: float) -> list[np.ndarray]:
        moved = parts[self._origin] - level * np.eye(len(parts[0]))
        return [moved if i == self._origin else part for i, part in enumerate(parts)]


def _pencil_roots(parts: list[np.ndarray]) -> np.ndarray:
    """Finite roots u of det(sum of u^k P_k) = 0, as eigenvalues of the companion pencil."""
    degree, n = len(parts) - 1, len(parts[0])
    if degree == 0 or n == 0:
        return np.zeros(0, complex)
    left, right = np.eye(degree * n, k=n), np.eye(degree * n)
    left[-n:] = -np.hstack(parts[:-1])
    right[-n:, -n:] = parts[-1]
    numerator, denominator = eigvals(left, right, homogeneous_eigvals=True, check_finite=False)
    finite = np.abs(denominator) > 1e-300 + 1e-15 * np.abs(numerator)
    return numerator[finite] / denominator[finite]

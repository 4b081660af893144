"""Newton's method on a periodic orbit, bordered by one condition: a parameter is held, or a length along the branch."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from .collocation import Leg, Linearised, Path, linearised

__all__ = ["Corrected", "Metric", "NoOrbit", "Phase", "Tangent", "corrected", "phase", "tangent"]

ITERATIONS = 10

CONVERGED = 1e-10
"""Largest correction of a state over its scale, and of the duration over itself."""

Condition: TypeAlias = Callable[[np.ndarray, np.ndarray, np.ndarray], tuple[float, np.ndarray, float]]
"""Of a state, the parameters and the direction of what is varied: a value that is to vanish, its gradient, its slope."""


class NoOrbit(Exception):
    """Newton's method finds no orbit from where it started."""


@dataclass(frozen=True)
class Metric:
    """What is long: scales of the states (n,) and of the parameter."""

    states: np.ndarray
    parameter: float


@dataclass(frozen=True)
class Tangent:
    """Direction of a branch: of the stages of each leg (N, m, n), of their unknowns, durations, and the parameter."""

    stages: tuple[np.ndarray, ...]
    unknowns: tuple[np.ndarray, ...]
    durations: np.ndarray
    parameter: float

    def times(self, s: float) -> Tangent:
        """Longer by a factor."""
        return Tangent(
            tuple(s * x for x in self.stages), tuple(s * z for z in self.unknowns), s * self.durations, s * self.parameter
        )

    def along(self, other: Tangent, metric: Metric) -> float:
        """Scalar product."""
        count = sum(x[..., 0].size for x in self.stages)
        products = (np.sum(x * y / metric.states**2) for x, y in zip(self.stages, other.stages, strict=True))
        return float(sum(products) / count + self.parameter * other.parameter / metric.parameter**2)

    def moves(self, path: Path, direction: np.ndarray) -> Path:
        """A path moved by it."""
        corrections = list(zip(self.stages, self.unknowns, self.durations, strict=True))
        return path.moved(corrections, path.parameters + self.parameter * direction)


@dataclass(frozen=True)
class Corrected:
    """An orbit, its linearised legs, equations and gradients of conditions, and how many iterations it took."""

    path: Path
    legs: tuple[Linearised, ...]
    system: np.ndarray
    gradients: np.ndarray
    iterations: int


@dataclass(frozen=True)
class Phase:
    """That of all shifts in time an orbit of one leg is the one nearest to a reference: the integral of x x_ref' vanishes.

    Attributes
    ----------
    reference, weights : ndarray
        (N, m, n) states at the stages, and their rates over the squares of the scales.
    """

    reference: np.ndarray
    weights: np.ndarray

    def row(self, leg: Leg, states: np.ndarray) -> tuple[float, np.ndarray]:
        """Value, and slopes by the columns of a linearised leg (N, m, n, n + 3)."""
        value = float(np.sum(self.weights * (leg.x - self.reference)))
        return value, np.einsum("rin,rinj->j", self.weights, states)


def phase(path: Path, metric: Metric) -> Phase:
    """The phase of a path is kept."""
    (leg,) = path.legs
    N, m, n = leg.x.shape
    rates = leg.flow.slopes(leg.x.reshape(-1, n), leg.z.reshape(N * m, -1), path.parameters, 0 * path.parameters).rates
    weights = rates.reshape(N, m, n) / metric.states**2
    return Phase(leg.x, weights / np.sqrt(np.sum((weights * metric.states) ** 2)))


def corrected(
    path: Path, conditions: Sequence[Condition | Phase], direction: np.ndarray, metric: Metric, along: Tangent | None
) -> Corrected:
    """The orbit near a path; `NoOrbit` if there is none.

    Parameters
    ----------
    path : Path
        K legs.
    conditions : sequence of Condition
        (K,) at the ends of the legs but the last, and at the start of the orbit; or the phase of an orbit of one leg.
    direction : ndarray
        Of the parameter.
    metric : Metric
    along : Tangent or None
        Corrections stay orthogonal to it; None: the parameter is held.
    """
    for iteration in range(ITERATIONS):
        with np.errstate(all="ignore"):
            legs, system, right, gradients = _system(path, conditions, direction, metric, along)
            if not (np.isfinite(system).all() and np.isfinite(right).all()):
                raise NoOrbit
            try:
                d = np.linalg.solve(system, right)
            except np.linalg.LinAlgError:
                raise NoOrbit from None
            moved = _unfolded(legs, d)
            path = moved.moves(path, direction)
        size = max(float(np.abs(x / metric.states).max()) for x in moved.stages)
        size = max(size, *np.abs(moved.durations / [leg.duration for leg in path.legs]))
        if not size < 1e3 or min(leg.duration for leg in path.legs) <= 0:
            raise NoOrbit
        if size < CONVERGED:
            return Corrected(path, tuple(legs), system, gradients, iteration + 1)
    raise NoOrbit


def tangent(found: Corrected, metric: Metric, ahead: Tangent | None) -> Tangent:
    """Direction of the branch at an orbit, of length 1, on the side of `ahead`; None: to larger parameters."""
    right = np.zeros(len(found.system))
    right[-1] = 1.0  # along what the orbit was sought orthogonal to, or the parameter
    try:
        step = _unfolded(found.legs, np.linalg.solve(found.system, right), constant=0.0)
    except np.linalg.LinAlgError:
        raise NoOrbit from None
    side = step.parameter if ahead is None else step.along(ahead, metric)
    return step.times(np.copysign(1 / np.sqrt(step.along(step, metric)), side))


def _unfolded(legs: Sequence[Linearised], d: np.ndarray, constant: float = 1.0) -> Tangent:
    """Corrections of everything by those of the start, the durations and the parameter."""
    n = legs[0].end.shape[0]
    start, stages, unknowns = d[:n], [], []
    for leg, dT in zip(legs, d[n:-1], strict=True):
        x, z = leg.corrections(np.concatenate([start, [dT, d[-1], constant]]))
        stages.append(x)
        unknowns.append(z)
        start = x[-1, -1]
    return Tangent(tuple(stages), tuple(unknowns), d[n:-1], float(d[-1]))


def _system(
    path: Path, conditions: Sequence[Condition | Phase], direction: np.ndarray, metric: Metric, along: Tangent | None
) -> tuple[list[Linearised], np.ndarray, np.ndarray, np.ndarray]:
    """Legs to first order, and the equations for d start, d durations, d parameter."""
    n, K = path.legs[0].flow.n, len(path.legs)
    size = n + K + 1
    system, right = np.zeros((size, size)), np.zeros(size)
    legs, gradients = [], np.zeros((K, n))
    before = np.zeros((n, size + 1))  # d state at the start of a leg by the unknowns, and a constant
    before[:, :n] = np.eye(n)
    arc = np.zeros(size + 1)
    count = sum(leg.x[..., 0].size for leg in path.legs)
    for k, leg in enumerate(path.legs):
        legs.append(linearised(leg, path.parameters, direction))
        chain = np.zeros((n + 3, size + 1))
        chain[:n] = before
        chain[n, n + k] = chain[n + 1, size - 1] = chain[n + 2, size] = 1.0
        before = legs[-1].end @ chain
        if along is not None:
            arc += np.einsum("rin,rinj->j", along.stages[k] / metric.states**2, legs[-1].states) / count @ chain
        if k < K - 1:
            condition = conditions[k]
            assert not isinstance(condition, Phase)  # that is for orbits of one leg
            value, gradients[k], slope = condition(leg.end, path.parameters, direction)
            system[n + k] = gradients[k] @ before[:, :-1]
            system[n + k, -1] += slope
            right[n + k] = -value - gradients[k] @ before[:, -1]
    start = path.legs[0].start
    system[:n] = path.closing[:, None] * before[:, :-1]
    system[:n, :n] -= np.eye(n)
    right[:n] = start - path.closing * (path.legs[-1].end + before[:, -1])
    last = conditions[-1]
    if isinstance(last, Phase):
        value, columns = last.row(path.legs[0], legs[0].states)
        system[n + K - 1], right[n + K - 1] = columns[:-1], -value - columns[-1]
    else:
        value, gradients[-1], slope = last(start, path.parameters, direction)
        system[n + K - 1, :n], system[n + K - 1, -1], right[n + K - 1] = gradients[-1], slope, -value
    if along is None:
        system[-1, -1] = 1.0
    else:
        system[-1], right[-1] = arc[:-1], -arc[-1]
        system[-1, -1] += along.parameter / metric.parameter**2
    return legs, system, right, gradients

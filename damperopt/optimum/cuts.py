"""Quadratic models of the decay ratio and of peaks about one design: what the program knows of the transients."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import casadi as ca
import numpy as np

from .problem import DesignProblem

__all__ = ["CONSTANT", "Cut", "about", "cut_before", "held_with", "monomials", "place_before"]

Place = tuple[float, float, float]
"""Speed [m/s], load [N], factor on the damping."""

P = TypeVar("P", bound=tuple[float, ...])

ACROSS = 1e-8
"""Cosine between a step and what it shows of a gradient below which it shows no curvature along itself."""

SAME_SPEED = 0.05
"""Two worst speeds closer than this part of the larger may be one that has moved."""

CONSTANT = 0
"""Which of `monomials` is 1: its coefficient is the value at x = 0."""


def monomials(x: Any) -> Any:
    """1, x and x_i x_j/2 of an expression, in the order of `Cut.about_zero`."""
    return ca.vertcat(1, x, ca.vec(x @ x.T) / 2)


@dataclass(frozen=True)
class Cut:
    """ln(decay ratio), or ln(peak), at one speed, load and damping about one design.

    Attributes
    ----------
    place : tuple of float
        Speed [m/s], load [N], factor on the damping.
    value : float
        At the centre.
    gradient, centre : ndarray
        (n,) with respect to the scaled design variables, and where it was taken.
    curvature : ndarray
        (n, n) approximate second derivatives.
    """

    place: Place
    value: float
    gradient: np.ndarray
    centre: np.ndarray
    curvature: np.ndarray

    @property
    def speed(self) -> float:
        """[m/s]"""
        return self.place[0]

    @property
    def load(self) -> float:
        """[N]"""
        return self.place[1]

    @classmethod
    def constant(cls, value: float, variables: int) -> Cut:
        """The same everywhere, as of no speed and load."""
        nothing = np.zeros(variables)
        return cls((np.nan, np.nan, np.nan), value, nothing, nothing, np.zeros((variables, variables)))

    def at(self, x: np.ndarray) -> float:
        """Its value at scaled design variables."""
        step = x - self.centre
        return float(self.value + self.gradient @ step + step @ self.curvature @ step / 2)

    def about_zero(self) -> np.ndarray:
        """Value, gradient and curvature of the same function at x = 0: coefficients of `monomials`, in one vector."""
        linear = self.gradient - self.curvature @ self.centre
        return np.concatenate([[self.at(0 * self.centre)], linear, self.curvature.ravel()])


def about(
    problem: DesignProblem,
    design: Mapping[str, float],
    numbers: Sequence[tuple[Place, float, np.ndarray]],
    before: Sequence[Cut | None],
    learning_step: float,
) -> list[Cut]:
    """Cuts of (place, value, d ln value/d ln design) about a design; curvature by symmetric rank-one updates.

    Parameters
    ----------
    problem : DesignProblem
    design : mapping of str to float
        Design variables by name [SI].
    numbers : sequence of tuple
    before : sequence of Cut or None
        Of the same points in the last round; None where there was none.
    learning_step : float
        Step below which the difference of two gradients shows their errors and no curvature.
    """
    n = len(problem.design_names)
    x = problem.scaled(design)[:n]
    slopes = np.array([1.0 if v.logarithmic else 1 / design[v.name] for v in problem.variables[:n]])
    cuts = []
    for (place, value, gradient), last in zip(numbers, before, strict=True):
        scaled = gradient * slopes
        cuts.append(Cut(place, float(np.log(value)), scaled, x, _curvature(last, x, scaled, learning_step)))
    return cuts


def _curvature(last: Cut | None, x: np.ndarray, gradient: np.ndarray, learning_step: float) -> np.ndarray:
    if last is None:
        return np.zeros((x.size, x.size))
    step = x - last.centre
    surprise = gradient - last.gradient - last.curvature @ step
    along = surprise @ step
    if np.linalg.norm(step) < learning_step or abs(along) <= ACROSS * np.linalg.norm(surprise) * np.linalg.norm(step):
        return last.curvature
    return last.curvature + np.outer(surprise, surprise) / along


def place_before(place: tuple[float, ...], earlier: Sequence[tuple[float, ...]]) -> int | None:
    """Index of the place that has moved here: the nearest speed at this load and damping, if it is near enough."""
    near = [
        (abs(place[0] - speed), i)
        for i, (speed, *rest) in enumerate(earlier)
        if rest == list(place[1:]) and abs(place[0] - speed) <= SAME_SPEED * max(place[0], speed)
    ]
    return min(near)[1] if near else None


def held_with(held: Sequence[P], found: Sequence[P]) -> list[P]:
    """Places that are held once others were found: each takes the place of the one that has moved there, of no other."""
    kept = list(held)
    for place in found:
        i = place_before(place, kept)
        if i is not None:
            del kept[i]
    return [*kept, *found]


def cut_before(place: tuple[float, ...], cuts: Sequence[Cut]) -> Cut | None:
    """What was learnt where this place has come from."""
    i = place_before(place, [cut.place for cut in cuts])
    return None if i is None else cuts[i]

"""Damping ratio of the yaw mode over the envelope: where it is least, and cuts that hold it from round to round.

The ratio -Re(s)/|s| of an eigenvalue has the gradient of the eigenvalue, ds/dp = w (dA/dp) v with w v = 1, exactly.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import casadi as ca
import numpy as np

from ..stability.worst import top_of, tops_of
from ..stability.yaw_mode import yaw_mode, yaw_modes
from .cuts import Cut, Place, about, cut_before, held_with
from .problem import DesignProblem

__all__ = ["DampingHold", "DampingPoint", "least_damping"]

SPEEDS = 40
"""Of the first look, at each load."""

NEAR = 1.3
"""Dips of the damping ratio below this multiple of the least are held from the start."""

REFINED = 2.0
"""Dips are refined where the first look shows less than this multiple of the least, or of what is required."""

LEARNING_STEP = 1e-5
"""Step below which the difference of two gradients shows their rounding and no curvature."""


@dataclass(frozen=True)
class DampingPoint:
    """Damping ratio of the yaw mode at a speed [m/s], a load [N] and a factor on the damping."""

    speed: float
    load: float
    ratio: float
    damping: float = 1.0

    @property
    def place(self) -> tuple[float, float, float]:
        """Speed, load, factor on the damping."""
        return self.speed, self.load, self.damping


def least_damping(problem: DesignProblem, design: Mapping[str, float]) -> list[DampingPoint]:
    """Dips of the damping ratio of the yaw mode over the speed at each damping, the least first.

    A yaw that does not oscillate has none.

    Parameters
    ----------
    problem : DesignProblem
    design : mapping of str to float
        Design variables by name [SI].
    """
    damper = problem.study.damper
    found = [
        replace(point, damping=factor)
        for factor in damper.dampings()
        for point in _dips(problem, damper.with_damping(design, factor))
    ]
    return sorted(found, key=lambda point: point.ratio)


def _dips(problem: DesignProblem, design: Mapping[str, float]) -> list[DampingPoint]:
    gear, envelope, required = problem.model.at(design), problem.study.envelope, problem.study.required.damping_ratio or 0.0
    low, high, found = envelope.speed.min, envelope.speed.max, list[DampingPoint]()
    speeds = np.unique(np.clip(np.geomspace(low, high, SPEEDS), low, high))
    for load in envelope.loads:

        def undamped(V: np.ndarray, load: float = load) -> np.ndarray:
            s = yaw_modes(gear, V, load)
            return np.where(np.isnan(s), -1.0, s.real / np.abs(s))

        heights = undamped(speeds)
        for i in tops_of(heights):
            left, right = speeds[max(i - 1, 0)], speeds[min(i + 1, len(speeds) - 1)]
            speed, ratio = float(speeds[i]), -float(heights[i])
            if left < right and ratio <= REFINED * max(-float(heights.max()), required):
                speed = top_of(undamped, left, right)
                ratio = -float(undamped(np.array([speed]))[0])
            found.append(DampingPoint(speed, load, ratio))
    return found


class DampingHold:
    """Where the damping ratio is held, from round to round.

    Parameters
    ----------
    problem : DesignProblem
        Of a study that asks for a damping ratio.
    most : int
        Points that a program has room for.
    """

    def __init__(self, problem: DesignProblem, most: int):
        self._problem, self._most = problem, most
        model = problem.model
        design, speed, load = ca.SX.sym("design", len(problem.design_names)), ca.SX.sym("V"), ca.SX.sym("F_z")
        A = model.state_matrix(design, speed, load, ca.DM(problem.data))
        self._slopes = ca.Function("slopes", [design, speed, load], [A, ca.densify(ca.jacobian(ca.vec(A), design))])
        self._angle, self._rate = (model.state_names.index(name) for name in ("yaw_angle", "yaw_rate"))
        self._held, self._last = list[Place](), list[Cut]()

    @property
    def required(self) -> float:
        """Least damping ratio."""
        ratio = self._problem.study.required.damping_ratio
        assert ratio is not None
        return ratio

    def worst(self, design: Mapping[str, float]) -> list[DampingPoint]:
        """Dips of the damping ratio; the low ones are held from now on."""
        dips = least_damping(self._problem, design)
        low = [p.place for p in dips if p.ratio <= NEAR * max(dips[0].ratio, self.required)][: self._most]
        self._held = held_with(self._held, low)[-self._most :]
        return dips

    def cuts(self, design: Mapping[str, float]) -> list[Cut]:
        """1 - ratio/required at the held points about `design`: at most 0 is required."""
        numbers = []
        for place in self._held:
            speed, load, factor = place
            scaled = self._problem.study.damper.with_damping(design, factor)
            values = np.array([scaled[name] for name in self._problem.design_names])
            A, slopes = (found.full() for found in self._slopes(values, speed, load))
            s, v, w = yaw_mode(A, self._angle, self._rate)
            if np.isnan(s):  # nothing oscillates: met, with room
                numbers.append((place, math.exp(-1), np.zeros(values.size)))
                continue
            n = len(A)
            ds = np.array([w @ column.reshape(n, n, order="F") @ v for column in slopes.T]) * values
            ratio = -s.real / abs(s)
            slope = -ds.real / abs(s) + s.real * (s.conjugate() * ds).real / abs(s) ** 3
            numbers.append((place, math.exp(1 - ratio / self.required), -slope / self.required))
        before = [cut_before(n[0], self._last) for n in numbers]
        self._last = about(self._problem, design, numbers, before, LEARNING_STEP)
        return self._last

"""Motions with their tangents: states, their sensitivities to the design, and peaks of outputs with derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import casadi as ca
import numpy as np
from scipy.interpolate import CubicHermiteSpline

from ..expressions.dae import DAE, eliminate
from .integrators import Solution

__all__ = ["TangentMotion", "output_functions", "weights_at_peak"]


@dataclass(frozen=True)
class TangentMotion:
    """States (n, m) by name and their sensitivities to ln(design variables) (n, d, m) at m times."""

    state_names: tuple[str, ...]
    time: np.ndarray
    x: np.ndarray
    S: np.ndarray

    def state(self, name: str) -> np.ndarray:
        """(m,) values of one state."""
        found: np.ndarray = self.x[self.state_names.index(name)]
        return found

    def with_more(self, start: float, duration: float, found: Solution) -> TangentMotion:
        """With a stretch that begins where this ends."""
        time = start + np.linspace(0, duration, found.x.shape[1])[1:]
        return TangentMotion(
            self.state_names,
            np.append(self.time, time),
            np.hstack([self.x, found.x[:, 1:]]),
            np.concatenate([self.S, found.sensitivities[:, :, 1:]], axis=2),
        )

    def log_slopes(self, moment: float) -> np.ndarray:
        """d ln|yaw|/d ln(design variable) at a time."""
        i = min(max(int(np.searchsorted(self.time, moment)) - 1, 0), self.time.size - 2)
        pair = slice(i, i + 2)
        rows = [self.state_names.index(name) for name in ("yaw_angle", "yaw_rate")]
        values, rates = (np.vstack([self.x[k, pair], self.S[k, :, pair].reshape(-1, 2)]) for k in rows)
        near = CubicHermiteSpline(self.time[pair], values, rates, axis=1)(moment)
        return near[1:] / near[0]

    def log_rate(self, moment: float) -> float:
        """d ln|yaw|/dt [1/s]."""
        spline = CubicHermiteSpline(self.time, self.state("yaw_angle"), self.state("yaw_rate"))
        return float(spline(moment, 1) / spline(moment))


def output_functions(dae: DAE, names: Sequence[str]) -> tuple[ca.Function, ca.Function]:
    """Outputs or states by name, and their d/d ln(design variable) given the sensitivities of the states."""
    model = eliminate(dae)
    outputs = ca.vertcat(*(model.x[model.index(name)] if name in model.state_names else model.outputs[name] for name in names))
    outputs = ca.substitute(outputs, model.yaw_torque, 0)
    inputs = [model.design, model.speed, model.load, model.data]
    S = ca.SX.sym("S", model.x.numel(), model.design.numel())
    slopes = ca.jacobian(outputs, model.x) @ S + ca.jacobian(outputs, model.design) @ ca.diag(model.design)
    return (
        ca.Function("outputs", [model.x, *inputs], [outputs]),
        ca.Function("output_slopes", [model.x, S, *inputs], [ca.densify(slopes)]),
    )


def weights_at_peak(values: np.ndarray) -> np.ndarray:
    """Weights of five even samples that interpolate where their parabola through the three highest peaks."""
    nodes, top = np.arange(5.0), int(np.clip(values.argmax(), 1, 3))
    left, middle, right = values[top - 1 : top + 2]
    bend = left - 2 * middle + right
    u = top + (0.5 * (left - right) / bend if bend else 0.0)
    return np.array([np.prod((u - np.delete(nodes, i)) / (nodes[i] - np.delete(nodes, i))) for i in range(5)])

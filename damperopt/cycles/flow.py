"""The equations of motion at many points at once, with their slopes, for any values of a study's numbers."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca
import numpy as np

from ..dynamics import build
from ..expressions.buffered import Buffered
from ..expressions.dae import DAE
from ..study.study import Study
from ..symbols import data_values, symbolic
from .elements import Closed

__all__ = ["Flow", "Slopes"]


@dataclass(frozen=True)
class Slopes:
    """The flow at k points.

    Attributes
    ----------
    rates : ndarray
        (k, n) x', to first order as if the unknowns z were solved.
    by_state : ndarray
        (k, n, n)
    by_parameter : ndarray
        (k, n) along the direction that was asked for.
    unknowns : tuple of ndarray
        Newton step of z (k, m), its slopes over x (k, m, n) and along the direction (k, m).
    """

    rates: np.ndarray
    by_state: np.ndarray
    by_parameter: np.ndarray
    unknowns: tuple[np.ndarray, np.ndarray, np.ndarray]


class Flow:
    """x' = f(x, z, parameters), 0 = g(x, z, parameters) of a study, built once for any values of its numbers.

    Parameters
    ----------
    study : Study
    dae : DAE or None
        Its equations; None: joints closed (`Closed`).
    modes : casadi.SX or None
        Symbols of the corners' modes in them; `with_modes` gives them values.

    Attributes
    ----------
    names : tuple of str
        Of the parameters: design variables, ``speed``, ``vertical_load``, numbers of the study by key path.
    mirror : ndarray
        (n,) +-1: the mirrored motion is mirror * x.
    """

    def __init__(self, study: Study, dae: DAE | None = None, modes: ca.SX | None = None):
        dae = build(symbolic(study), Closed()) if dae is None else dae
        self.study, self.states, self.units = study, dae.states, dae.units
        self.state_names, self.n, self.m = dae.state_names, dae.x.numel(), dae.z.numel()
        self.names = (*dae.design_names, "speed", "vertical_load", *dae.data_names)
        self.design_names = dae.design_names
        self.mirror = np.array([1.0 if state.even else -1.0 for state in dae.states])
        self._data = np.array(data_values(study))
        self._parameters = dae.design.numel() + 2 + dae.data.numel()
        parameters = ca.vertcat(dae.design, dae.speed, dae.load, dae.data, ca.SX(0, 1) if modes is None else modes)
        self.modes = np.ones(parameters.numel() - self._parameters)
        f, g = (ca.substitute(e, dae.yaw_torque, 0) for e in (dae.ode, dae.alg))
        self._slopes = _Stacked(_slopes(dae.x, dae.z, parameters, f, g), 2)
        outputs = {name: ca.substitute(ca.SX(value), dae.yaw_torque, 0) for name, value in dae.outputs.items()}
        self.output_names = (*dae.state_names, *outputs)
        shown = ca.densify(ca.vertcat(dae.x, *outputs.values()))
        self._outputs = _Stacked(ca.Function("outputs", [dae.x, dae.z, parameters], [shown]), 1)
        guess = ca.densify(ca.substitute(dae.first_guess(), dae.yaw_torque, 0))
        self._guess = _Stacked(ca.Function("guess", [dae.x, parameters], [guess]), 1)

    @property
    def mirrored(self) -> Flow:
        """Equations of the mirrored motion: the same, where no mode of a joint is held."""
        return self

    def with_modes(self, modes: np.ndarray) -> Flow:
        """The same equations with values (s,) of the modes."""
        other = copy.copy(self)
        other.modes = modes
        return other

    def _all(self, parameters: np.ndarray) -> np.ndarray:
        return np.concatenate([parameters, self.modes])

    def index(self, name: str) -> int:
        """Position of a state."""
        return self.state_names.index(name)

    def values(self, design: Mapping[str, float], speed: float, load: float) -> np.ndarray:
        """Parameters of the study with a design at a speed [m/s] and a load [N], in the order of `names`."""
        return np.concatenate([[design[name] for name in self.design_names], [speed, load], self._data])

    def along(self, name: str) -> np.ndarray:
        """Direction of a parameter, for `slopes`."""
        direction = np.zeros(self._parameters)
        direction[self.names.index(name)] = 1.0
        return direction

    def slopes(self, x: np.ndarray, z: np.ndarray, parameters: np.ndarray, direction: np.ndarray) -> Slopes:
        """Rates and slopes at k points: x (k, n), z (k, m)."""
        k, n, m = len(x), self.n, self.m
        f, A, b, step, z_x, z_p = self._slopes(k, [x, z], [self._all(parameters), np.concatenate([direction, 0 * self.modes])])
        A, z_x = A.reshape(k, n, n).transpose(0, 2, 1), z_x.reshape(k, n, m).transpose(0, 2, 1)
        return Slopes(f.reshape(k, n), A, b.reshape(k, n), (step.reshape(k, m), z_x, z_p.reshape(k, m)))

    def unknowns(self, x: np.ndarray, parameters: np.ndarray) -> np.ndarray:
        """First guess of z (k, m) at x (k, n)."""
        return self._guess(len(x), [x], [self._all(parameters)])[0].reshape(len(x), self.m)

    def outputs(self, x: np.ndarray, z: np.ndarray, parameters: np.ndarray) -> np.ndarray:
        """(k, q) states and outputs by `output_names`."""
        return self._outputs(len(x), [x, z], [self._all(parameters)])[0].reshape(len(x), -1)

    def state_matrix(self, parameters: np.ndarray) -> np.ndarray:
        """(n, n) at rest."""
        x = np.zeros((1, self.n))
        return self.slopes(x, self.unknowns(x, parameters), parameters, np.zeros(self._parameters)).by_state[0]


def _slopes(x: ca.SX, z: ca.SX, parameters: ca.SX, f: ca.SX, g: ca.SX) -> ca.Function:
    """f - f_z g_z^-1 g, its total slopes, and the Newton step of z with its slopes."""
    n, m = x.numel(), z.numel()
    direction = ca.SX.sym("direction", parameters.numel())
    A, b = ca.jacobian(f, x), ca.jtimes(f, parameters, direction)
    step, z_x, z_p = ca.SX(m, 1), ca.SX(m, n), ca.SX(m, 1)
    if m:
        inverse, f_z = -ca.inv_minor(ca.jacobian(g, z)), ca.jacobian(f, z)
        step, z_x = inverse @ g, inverse @ ca.jacobian(g, x)
        z_p = inverse @ ca.jtimes(g, parameters, direction)
        f, A, b = f + f_z @ step, A + f_z @ z_x, b + f_z @ z_p
    outputs = [ca.densify(e) for e in (f, A, b, step, z_x, z_p)]
    return ca.Function("slopes", [x, z, parameters, direction], outputs, {"cse": True})


class _Stacked:
    """A CasADi function over k points at once: the first `varied` arguments have a row for each, the others are shared."""

    def __init__(self, function: ca.Function, varied: int):
        self._function, self._varied = function, varied
        self._kept: dict[int, Buffered] = {}

    def __call__(self, k: int, rows: list[np.ndarray], shared: list[np.ndarray]) -> list[np.ndarray]:
        """Outputs as flat arrays, point after point, column by column."""
        if k not in self._kept:
            others = list(range(self._varied, self._function.n_in()))
            self._kept[k] = Buffered(self._function.map("stacked", "serial", k, others, []))
        at = self._kept[k]
        for array, values in zip(at.given, [*rows, *shared], strict=True):
            array[:] = values.ravel()
        return [array.copy() for array in at()]

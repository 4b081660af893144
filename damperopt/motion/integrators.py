"""Integrators of the smooth model: CasADi's explicit Runge-Kutta pair, CVODES and IDAS, with design sensitivities.

IDAS takes the differential-algebraic system as it is; the other two take it with its algebraic unknowns eliminated. The
sensitivities S = dx/d ln(d) follow S' = f_x S + f_d d and are integrated, and held to the tolerance, with the states.
"""

from __future__ import annotations

import contextlib
import shutil
import tempfile
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any

import casadi as ca
import numpy as np

from .. import interrupts
from ..expressions.dae import DAE, eliminate

__all__ = ["ENGINES", "Integrator", "best_engine", "has_compiler"]

ENGINES = ("erk", "cvodes", "idas")

IDAS_FLOOR, LEAST_IDAS = 3e-12, 1e-12
"""Relative tolerance below which IDAS no longer finds a first step, with algebraic unknowns and without."""


FLAGS = ["-O1", "-march=native"]
"""Of the compiler: -O3 takes as much longer as it gains over some hundred motions with derivatives."""


@cache
def has_compiler() -> bool:
    """Whether a C compiler is at hand, as just-in-time compilation needs."""
    return shutil.which("gcc") is not None


def best_engine() -> str:
    """The fastest engine at equal error: ``erk`` with a compiler, else ``cvodes`` (`benchmarks/transients.py`)."""
    return "erk" if has_compiler() else "cvodes"


@dataclass(frozen=True)
class Solution:
    """States on the output grid.

    Attributes
    ----------
    x : ndarray
        (n, m + 1) states at the m + 1 times, the start included.
    sensitivities : ndarray
        (n, d, m + 1) dx/d ln(design); empty (d = 0) if not asked for.
    z : ndarray
        (k, m + 1) algebraic unknowns; empty with eliminated ones.
    """

    x: np.ndarray
    sensitivities: np.ndarray
    z: np.ndarray


class Integrator:
    """Integrator of one model over a number of equal output steps.

    Parameters
    ----------
    dae : DAE
        With smooth elements.
    data : sequence of float
        Numbers of the study, for calls that give none.
    steps : int
        Output steps of one call.
    engine : str
        ``erk`` (Runge-Kutta 5(4)), ``cvodes`` (Adams) or ``idas``.
    tolerance : float
        Relative, per step; absolute 1/100 of it.
    sensitivities : bool
        Integrate dx/d ln(design) too.
    compiled : bool or None
        Translate the model with gcc; None: where gcc is found and the engine profits.
    clock : SX or None
        Symbol among the data that is the time, from `start` of a call on [s].

    Raises
    ------
    RuntimeError
        Of CasADi, where compilation fails.
    """

    def __init__(
        self,
        dae: DAE,
        data: Sequence[float],
        steps: int,
        engine: str = "erk",
        tolerance: float = 1e-8,
        sensitivities: bool = False,
        compiled: bool | None = None,
        clock: ca.SX | None = None,
    ):
        self.steps, self.engine = steps, engine
        model = dae if engine == "idas" else eliminate(dae)
        self._n, self._m = model.x.numel(), model.z.numel()
        self._d = dae.design.numel() if sensitivities else 0
        duration, time, start, torque, unbalance, wheel_rate = (
            ca.SX.sym(name) for name in ("duration", "time", "start", "torque", "unbalance", "wheel_rate")
        )
        external = torque + unbalance * wheel_rate**2 * ca.sin(wheel_rate * (start + duration * time))
        self._data = np.array(data)
        parameters = ca.vertcat(
            model.design, model.speed, model.load, duration, start, torque, unbalance, wheel_rate, model.data
        )
        x, z, ode, alg = _with_sensitivities(model) if self._d else (model.x, model.z, model.ode, model.alg)
        if clock is not None:
            ode, alg = (ca.substitute(e, clock, start + duration * time) for e in (ode, alg))
        problem = {"x": x, "p": parameters, "t": time}
        problem["ode"] = ca.cse(duration * ca.substitute(ode, model.yaw_torque, external))
        if self._m:
            problem |= {"z": z, "alg": alg}
            self._guess = ca.Function("guess", [model.x, parameters], [model.first_guess()])
        if compiled is None:
            compiled = engine == "erk" and has_compiler()
        self._size, self._algebraic = x.numel(), z.numel()
        grid = np.linspace(0, 1, steps + 1).tolist()
        self._function = _create(engine, problem, grid, _options(engine, tolerance, self._m), compiled)

    def __call__(
        self,
        x0: np.ndarray,
        design: Sequence[float],
        speed: float,
        load: float,
        duration: float,
        start: float = 0.0,
        sensitivities0: np.ndarray | None = None,
        torque: float = 0.0,
        unbalance: float = 0.0,
        wheel_rate: float = 0.0,
        data: np.ndarray | None = None,
    ) -> Solution:
        """Integrate from `x0` over `duration` [s].

        Parameters
        ----------
        x0 : ndarray
            (n,) states.
        design : sequence of float
            Design variables [SI].
        speed, load : float
            [m/s], [N]
        duration, start : float
            Length and start of the interval [s].
        sensitivities0 : ndarray or None
            (n, d) at the start; None: zero.
        torque, unbalance, wheel_rate : float
            Constant yaw torque [N m], unbalance moment [kg m^2] and wheel speed [rad/s].
        data : ndarray or None
            Numbers of the study.

        Returns
        -------
        Solution

        Raises
        ------
        FloatingPointError
            If the integrator cannot go on, or the solution overflows.
        """
        more = [speed, load, duration, start, torque, unbalance, wheel_rate]
        p = np.concatenate([design, more, self._data if data is None else data])
        full = np.zeros(self._size)
        full[: self._n] = x0
        if sensitivities0 is not None:
            full[self._n :] = sensitivities0.ravel(order="F")
        arguments: dict[str, Any] = {"x0": full, "p": p}
        if self._m:
            z0 = np.zeros(self._algebraic)
            z0[: self._m] = self._guess(x0, p).full().ravel()
            arguments["z0"] = z0
        try:
            result = self._function(**arguments)
        except NotImplementedError:
            interrupts.check()  # a Ctrl-C while CasADi looks for the overload of a call comes out as a wrong type
            raise
        except RuntimeError as error:
            raise FloatingPointError(f"{self.engine} cannot go on") from error
        columns = result["xf"].full()
        if not np.isfinite(columns).all():
            raise FloatingPointError(f"{self.engine}: the motion overflows")
        S = columns[self._n :].reshape(self._d, self._n, self.steps + 1).transpose(1, 0, 2)
        z = result["zf"].full()[: self._m] if self._m else np.zeros((0, self.steps + 1))
        return Solution(columns[: self._n], S, z)


def _with_sensitivities(model: DAE) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX]:
    """States, unknowns and equations with the sensitivities to ln(design) behind them, column by column."""
    n, m, d = model.x.numel(), model.z.numel(), model.design.numel()
    S, R, scale = ca.SX.sym("S", n, d), ca.SX.sym("R", m, d), ca.diag(model.design)
    f, g = model.ode, model.alg

    def total(e: ca.SX) -> ca.SX:
        slope = ca.jacobian(e, model.x) @ S + ca.jacobian(e, model.design) @ scale
        return slope + ca.jacobian(e, model.z) @ R if m else slope

    x, ode = ca.vertcat(model.x, ca.vec(S)), ca.vertcat(f, ca.vec(total(f)))
    if not m:
        return x, model.z, ode, model.alg
    return x, ca.vertcat(model.z, ca.vec(R)), ode, ca.vertcat(g, ca.vec(total(g)))


def _options(engine: str, tolerance: float, unknowns: int) -> dict[str, Any]:
    if engine == "erk":
        return {"reltol": tolerance, "abstol": tolerance / 100, "max_num_steps": 200_000}
    # multistep methods accumulate error: at equal error they need a tighter tolerance
    floor = IDAS_FLOOR if unknowns else LEAST_IDAS
    relative = max(tolerance / 100, floor if engine == "idas" else 0.0)
    tight: dict[str, Any] = {"reltol": relative, "abstol": relative / 100, "max_num_steps": 20_000}
    tight |= {"disable_internal_warnings": True}  # what they print is raised as well
    if engine == "cvodes":
        return tight | {"linear_multistep_method": "adams", "nonlinear_solver_iteration": "functional"}
    return tight


def _create(engine: str, problem: dict[str, ca.SX], grid: list[float], options: dict[str, Any], compiled: bool) -> ca.Function:
    if compiled:
        inputs, outputs = ([name for name in names if name in problem] for names in (ca.dyn_in(), ca.dyn_out()))
        equations = ca.Function("equations", problem, inputs, outputs)
        try:
            return _compiled(engine, equations.serialize(), tuple(grid), tuple(options.items()))
        except (RuntimeError, OSError) as error:
            warnings.warn(f"the model could not be compiled and will run about ten times slower: {error}", stacklevel=3)
    return ca.integrator("motion", engine, problem, 0, grid, options)


@lru_cache(maxsize=64)
def _compiled(engine: str, equations: str, grid: tuple[float, ...], options: tuple[tuple[str, Any], ...]) -> ca.Function:
    """Studies that differ in their numbers alone have the same equations: they are translated once in a process."""
    function = ca.Function.deserialize(equations)
    symbols = function.sx_in()
    problem = dict(zip(function.name_in() + function.name_out(), symbols + function.call(symbols), strict=True))
    files = {"cleanup": False, "flags": FLAGS, "verbose": False}  # removed with their folder
    jit = {"jit": True, "jit_cleanup": False, "compiler": "shell", "jit_options": files}
    with tempfile.TemporaryDirectory(prefix="damperopt-") as folder, contextlib.chdir(folder):
        return ca.integrator("motion", engine, problem, 0, list(grid), dict(options) | jit)

"""IPOPT on the design problem: one local solution at given stability points, with multipliers and KKT residual."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar

import casadi as ca
import numpy as np

from ..motion.decay import DecayAnalysis, decay_analysis
from .cuts import Cut
from .problem import DesignProblem
from .program import HurwitzProgram, Instance, Program

__all__ = ["LocalSolution", "NlpSolver", "raise_if_interrupted"]

T = TypeVar("T")

_OPTIONS: dict[str, Any] = {
    "print_time": False,
    "show_eval_warnings": False,  # a trial step that overflows is shortened by IPOPT; its status tells if none helps
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "ipopt.max_iter": 300,
    # relaxed bounds on a Hurwitz determinant are worth 1e-3 in the spectral abscissa
    "ipopt.bound_relax_factor": 0.0,
    "ipopt.nlp_scaling_method": "none",  # the rows are scaled by their meaning already
    "ipopt.honor_original_bounds": "yes",
}


@dataclass(frozen=True)
class LocalSolution:
    """A local solution of the program, or the point where IPOPT gave up.

    Attributes
    ----------
    converged : bool
    status : str
        IPOPT's word.
    design : dict
        Design variables [SI].
    objective : float
        Mass [kg]; the price of the relaxation for the elastic program.
    extra : ndarray
        Variables of the program beyond those of the design.
    x : ndarray
        Scaled variables.
    row_multipliers, bound_multipliers : ndarray
        Of the strength and geometry rows (>= 0) and of the bounds of the scaled variables (positive at an upper bound).
    cuts : tuple of Cut
        Decay cuts of the solution.
    cut_multipliers : ndarray
        (m,) of the decay cuts.
    peaks : tuple of Cut
        Models of simulated peaks, and
    peak_gradient : ndarray
        (k,) derivative of the optimal objective with respect to the logarithm of each.
    data_gradient : ndarray
        Derivative of the optimal objective with respect to the study's numbers, by the envelope theorem (its Lagrangian's).
    load_limit_gradient : float
        The same with respect to the load of the limit event.
    point_gradient : ndarray
        (m, 2) the same with respect to the speeds and loads of `points`.
    kkt_residual : float
        Largest of |grad L|, complementarity and violation, recomputed from the derivatives (not IPOPT's own figure).
    points : tuple of (speed, load)
        Stability points of the solution.
    form : str
        Name of the program.
    iterations : int
    """

    converged: bool
    status: str
    design: dict[str, float]
    objective: float
    extra: np.ndarray
    x: np.ndarray
    row_multipliers: np.ndarray
    bound_multipliers: np.ndarray
    cuts: tuple[Cut, ...]
    cut_multipliers: np.ndarray
    peaks: tuple[Cut, ...]
    peak_gradient: np.ndarray
    data_gradient: np.ndarray
    load_limit_gradient: float
    point_gradient: np.ndarray
    kkt_residual: float
    points: tuple[tuple[float, float], ...]
    form: str
    iterations: int


class NlpSolver:
    """IPOPT for one design problem; programs with 4, 8, 16, ... slots are built when needed and kept.

    Parameters
    ----------
    problem : DesignProblem
    """

    def __init__(self, problem: DesignProblem):
        self.problem = problem
        self._built: dict[tuple[type[Program], int], _Built] = {}
        self._remembered: dict[tuple[float, ...], Any] = {}

    @cached_property
    def decay(self) -> DecayAnalysis:
        """Simulations of the study's gear, for studies with a decay requirement."""
        return decay_analysis(self.problem.study)

    def remembered(self, design: Mapping[str, float], work: Callable[[], T]) -> T:
        """What `work` returns; not done again for a design that it was done for, to four digits."""
        key = tuple(float(f"{design[name]:.4e}") for name in self.problem.design_names)
        if key not in self._remembered:
            self._remembered[key] = work()
        found: T = self._remembered[key]
        return found

    def solve(
        self,
        design: Mapping[str, float],
        points: Sequence[tuple[float, float]],
        form: type[Program] = HurwitzProgram,
        cuts: Sequence[Cut] = (),
        peaks: Sequence[Cut] = (),
        **options: Any,
    ) -> LocalSolution:
        """Local solution from `design` with stability imposed at `points` and decay by `cuts`.

        Parameters
        ----------
        design : mapping
            Start, design variables by name [SI].
        points : sequence of (speed, load)
        form : type
            Program class.
        cuts : sequence of Cut
        peaks : sequence of Cut
            Simulated peaks that size the parts; none: as estimated.
        **options : object
            Passed to `Program.instance`.

        Returns
        -------
        LocalSolution
        """
        built = self._program(form, len(points))
        it = built.program.instance(design, points, cuts=cuts, peaks=peaks, **options)
        result = built.solver(x0=it.x0, p=it.p, lbx=it.lbx, ubx=it.ubx, lbg=it.lbg, ubg=it.ubg)
        stats = built.solver.stats()
        raise_if_interrupted(stats)
        x, g, lam_g, lam_x = (result[key].full().ravel() for key in ("x", "g", "lam_g", "lam_x"))
        rows = len(self.problem.constraints)
        variables, data = len(self.problem.variables), len(self.problem.data)
        # parameters: data, load limit, speeds, loads and rates of the slots; with simulated peaks a switch and their models,
        # of which the value comes first (see Program)
        n = len(self.problem.design_names)
        by_parameter = built.parameter_gradient(x, it.p, lam_g).full().ravel()
        violation = max(np.max(g - it.ubg), np.max(it.lbg - g), 0.0)
        return LocalSolution(
            converged=bool(stats["success"]) and violation <= 1e-6,
            status=stats["return_status"],
            design=self.problem.unscaled(x[:variables]),
            objective=float(result["f"]),
            extra=x[variables:],
            x=x[:variables],
            row_multipliers=lam_g[:rows],
            bound_multipliers=lam_x[:variables],
            cuts=tuple(cuts),
            cut_multipliers=lam_g[rows : rows + len(cuts)],
            peaks=tuple(peaks),
            peak_gradient=by_parameter[data + 1 + 3 * built.slots + 1 :][:: 1 + n + n * n][: len(peaks)],
            data_gradient=by_parameter[:data],
            load_limit_gradient=float(by_parameter[data]),
            point_gradient=by_parameter[data + 1 : data + 1 + 2 * built.slots].reshape(2, -1)[:, : len(points)].T,
            kkt_residual=_kkt_residual(built, it, x, g, lam_g, lam_x),
            points=tuple(points),
            form=form.__name__,
            iterations=int(stats["iter_count"]),
        )

    def _program(self, form: type[Program], points: int) -> _Built:
        slots = max(4, 1 << (points - 1).bit_length())
        if (form, slots) not in self._built:
            program = form(self.problem, slots)
            nlp = program.nlp
            options = {**_OPTIONS, "ipopt.tol": self.problem.study.solver.tolerance}
            inputs, multipliers = [nlp["x"], nlp["p"]], ca.SX.sym("multipliers", nlp["g"].shape[0])
            lagrangian = nlp["f"] + ca.dot(multipliers, nlp["g"])
            self._built[form, slots] = _Built(
                program,
                ca.nlpsol("design", "ipopt", nlp, options),
                ca.Function("stationarity", [*inputs, multipliers], [ca.gradient(lagrangian, nlp["x"])]),
                ca.Function("parameter_gradient", [*inputs, multipliers], [ca.gradient(lagrangian, nlp["p"])]),
                slots,
            )
        return self._built[form, slots]


def raise_if_interrupted(stats: Mapping[str, Any]) -> None:
    """Pass on a Ctrl-C that IPOPT has taken for a request to stop this one solution."""
    if stats["return_status"] == "User_Requested_Stop":
        raise KeyboardInterrupt


@dataclass(frozen=True)
class _Built:
    program: Program
    solver: ca.Function
    stationarity: ca.Function
    parameter_gradient: ca.Function
    slots: int


def _kkt_residual(built: _Built, it: Instance, x: np.ndarray, g: np.ndarray, lam_g: np.ndarray, lam_x: np.ndarray) -> float:
    """Largest of |grad L|, violation and complementarity, from the derivatives and not from IPOPT's own figures."""
    free = it.ubx > it.lbx
    stationarity = (built.stationarity(x, it.p, lam_g).full().ravel() + lam_x)[free]
    slack = np.concatenate([np.minimum(it.ubg - g, g - it.lbg), np.minimum(it.ubx - x, x - it.lbx)[free]])
    multipliers = np.concatenate([lam_g, lam_x[free]])
    limited = np.isfinite(slack)
    # rows are logarithmic ratios or metres: one that is met by 1 is met; a limit of many kilometres would magnify a multiplier's rounding
    complementarity = np.abs(multipliers[limited] * np.minimum(slack[limited], 1.0))
    return float(max(np.abs(stationarity).max(), complementarity.max(initial=0.0), (-slack[limited]).max(initial=0.0)))

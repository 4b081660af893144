"""IPOPT on the design problem: one local solution at given stability points, with multipliers and KKT residual."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar

import casadi as ca
import numpy as np

from ..motion.decay import DecayAnalysis
from ..motion.measure import PEAKS
from .cuts import CONSTANT, Cut
from .parameters import Instance
from .problem import DesignProblem
from .program import HurwitzProgram, Program

__all__ = ["Gradient", "LocalSolution", "Multipliers", "NlpSolver", "raise_if_interrupted"]

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


FEWEST_SLOTS = 4

VIOLATION = 1e-6
"""Excess of a row up to which a solution that IPOPT calls one is taken for one."""


@dataclass(frozen=True)
class Multipliers:
    """Of the constraints of a solution.

    Attributes
    ----------
    rows : ndarray
        Of the strength and geometry rows, >= 0.
    bounds : ndarray
        Of the bounds of the scaled variables, positive at an upper bound.
    cuts, damping : ndarray
        (m,) of the cuts of decay and of damping ratio.
    """

    rows: np.ndarray
    bounds: np.ndarray
    cuts: np.ndarray
    damping: np.ndarray


@dataclass(frozen=True)
class Gradient:
    """Derivative of the optimal objective, by the envelope theorem that of the Lagrangian.

    Attributes
    ----------
    data : ndarray
        With respect to the study's numbers.
    load_limit : float
        To the load of the limit event.
    points : ndarray
        (m, 2) to the speeds and loads of the stability points.
    peaks : ndarray
        (k,) to the logarithm of each simulated peak.
    """

    data: np.ndarray
    load_limit: float
    points: np.ndarray
    peaks: np.ndarray


@dataclass(frozen=True)
class LocalSolution:
    """A local solution of the program, or the point where IPOPT gave up.

    Attributes
    ----------
    form : str
        Name of the program, and
    points, cuts, peaks : tuple
        what it was given: stability points (speed, load, damping factor), decay cuts, and models of simulated peaks.
    converged : bool
    status : str
        IPOPT's word.
    design : dict
        Design variables [SI].
    x : ndarray
        Scaled variables.
    objective : float
        Mass [kg]; the price of the relaxation for the elastic program.
    excess : float
        By how much ln(decay ratio) exceeds the cuts.
    margin : float or None
        What is left of the margin [1/s], of an elastic program.
    multipliers : Multipliers
    gradient : Gradient
    kkt_residual : float
        Largest of |grad L|, complementarity and violation, recomputed from the derivatives (not IPOPT's own figure).
    """

    form: str
    points: tuple[tuple[float, ...], ...]
    cuts: tuple[Cut, ...]
    peaks: tuple[Cut, ...]
    converged: bool
    status: str
    design: dict[str, float]
    x: np.ndarray
    objective: float
    excess: float
    margin: float | None
    multipliers: Multipliers
    gradient: Gradient
    kkt_residual: float


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
        return DecayAnalysis(self.problem.study, self.problem.model)

    def simulated_factors(self, design: Mapping[str, float]) -> np.ndarray | None:
        """Simulated over estimated peaks of the limit event of a design; None where a torque is the limit event."""
        if self.problem.study.required.limit_event != "simulated":
            return None
        peaks, _ = self.decay.largest_peaks(design)
        return self.problem.factors_of(design, dict(zip(PEAKS, peaks.tolist(), strict=True)))

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
        points: Sequence[tuple[float, ...]],
        form: type[Program] = HurwitzProgram,
        cuts: Sequence[Cut] = (),
        peaks: Sequence[Cut] = (),
        damping_cuts: Sequence[Cut] = (),
        **options: Any,
    ) -> LocalSolution:
        """Local solution from `design` with stability imposed at `points` and decay by `cuts`.

        Parameters
        ----------
        design : mapping
            Start, design variables by name [SI].
        points : sequence of (speed, load, damping factor)
        form : type
            Program class.
        cuts : sequence of Cut
        peaks : sequence of Cut
            Simulated peaks that size the parts; none: as estimated.
        damping_cuts : sequence of Cut
        **options : object
            Passed to `Program.instance`.

        Returns
        -------
        LocalSolution
        """
        built = self._program(form, len(points))
        it = built.program.instance(design, points, cuts=cuts, peaks=peaks, damping_cuts=damping_cuts, **options)
        result = built.solver(x0=it.x0, p=it.p, lbx=it.lbx, ubx=it.ubx, lbg=it.lbg, ubg=it.ubg)
        stats = built.solver.stats()
        raise_if_interrupted(stats)
        x, g, lam_g, lam_x = (result[key].full().ravel() for key in ("x", "g", "lam_g", "lam_x"))
        variables, rows = built.program.variables, built.program.rows
        by_parameter = built.parameter_gradient(x, it.p, lam_g).full().ravel()
        violation = max(np.max(g - it.ubg), np.max(it.lbg - g), 0.0)
        scaled, margin = variables.part(x, "design"), variables.part(x, "margin")
        return LocalSolution(
            form=form.__name__,
            points=tuple(points),
            cuts=tuple(cuts),
            peaks=tuple(peaks),
            converged=bool(stats["success"]) and violation <= VIOLATION,
            status=stats["return_status"],
            design=self.problem.unscaled(scaled.tolist()),
            x=scaled,
            objective=float(result["f"]),
            excess=float(variables.part(x, "excess").sum()),
            margin=float(margin[0]) if margin.size else None,
            multipliers=Multipliers(
                rows=rows.part(lam_g, "strength"),
                bounds=variables.part(lam_x, "design"),
                cuts=rows.part(lam_g, "decay")[: len(cuts)],
                damping=rows.part(lam_g, "damping")[: len(damping_cuts)],
            ),
            gradient=_gradient(built.program, by_parameter, len(points), len(peaks)),
            kkt_residual=_kkt_residual(built, it, x, g, lam_g, lam_x),
        )

    def _program(self, form: type[Program], points: int) -> _Built:
        slots = max(FEWEST_SLOTS, 1 << (points - 1).bit_length())
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


def _gradient(program: Program, by_parameter: np.ndarray, points: int, peaks: int) -> Gradient:
    def part(name: str) -> np.ndarray:
        return program.parameters.part(by_parameter, name)

    coefficients = part("peaks").reshape(-1, len(PEAKS), order="F") if peaks else np.zeros((1, 0))
    return Gradient(
        data=part("data"),
        load_limit=float(part("load_limit")[0]),
        points=np.column_stack([part("speeds"), part("loads")])[:points],
        peaks=coefficients[CONSTANT],
    )


def _kkt_residual(built: _Built, it: Instance, x: np.ndarray, g: np.ndarray, lam_g: np.ndarray, lam_x: np.ndarray) -> float:
    """Largest of |grad L|, violation and complementarity, from the derivatives and not from IPOPT's own figures."""
    free = it.ubx > it.lbx
    stationarity = (built.stationarity(x, it.p, lam_g).full().ravel() + lam_x)[free]
    slack = np.concatenate([np.minimum(it.ubg - g, g - it.lbg), np.minimum(it.ubx - x, x - it.lbx)[free]])
    multipliers = np.concatenate([lam_g, lam_x[free]])
    limited = np.isfinite(slack)
    # rows are logarithmic ratios or metres; the slack of a far limit, in kilometres, would magnify a multiplier's rounding
    complementarity = np.abs(multipliers[limited] * np.minimum(slack[limited], 1.0))
    return float(max(np.abs(stationarity).max(), complementarity.max(initial=0.0), (-slack[limited]).max(initial=0.0)))

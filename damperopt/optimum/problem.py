"""The design problem: variables, mass and constraints of one layout and material, as symbols and as plain functions.

`program` makes nonlinear programs of it; the plain functions serve reports, tests and any other optimiser.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import Any

import casadi as ca
import numpy as np

from ..dynamics import build
from ..linkages.elastic import elastic_linkage
from ..motion.measure import PEAKS
from ..objectives import sized_layout
from ..ports.linkage import Linkage
from ..ports.sizing import Size
from ..quantities.named import DesignVariable
from ..results import OperatingPoint
from ..stability.fail_safe import FailSafe
from ..stability.linear import LinearModel
from ..stability.over_damping import worst_over_damping
from ..stability.screening import Screening
from ..strength.limit_event import peaks_of
from ..study.study import Study
from ..symbols import data_names, data_values, symbolic
from .constraints import Constraint, geometry, strength
from .rational import searched_study

__all__ = ["DesignProblem", "ScaledVariable"]

ESTIMATED = np.ones(len(PEAKS))
"""Factors of a limit event that is not simulated."""


@dataclass(frozen=True)
class ScaledVariable:
    """A variable of the program: x = log(value), or the value itself where `logarithmic` is False."""

    name: str
    start: float
    lower: float
    upper: float
    logarithmic: bool

    def scale(self, value: float) -> float:
        return math.log(value) if self.logarithmic else value

    def unscale(self, x: float) -> float:
        """Value of the scaled `x`, never outside the bounds by rounding."""
        return min(max(math.exp(x) if self.logarithmic else x, self.lower), self.upper)


class DesignProblem:
    """Lightest design of one layout and material.

    Parameters
    ----------
    study : Study
        With one of the layouts that can be optimised.
    walls : mapping of str to (float, float)
        Sections of the mass model whose walls are open, as that of ``link_section``, and between what: they are then chosen
        with the sizes. The plain functions below take them at their least.

    Attributes
    ----------
    variables : tuple of ScaledVariable
        Design variables, then the sizes of parts that are chosen with them.
    constraints : tuple of Constraint
        Strength and geometry, in the order of `rows`.
    units : dict of str to str
        SI units of the variables.
    has_one_damping, plain : bool
        Whether one viscous number stands for the damper, and whether it acts on the gear without states of its own, as strongly
        at every load.
    model, search_model : LinearModel
        Of the study, and of the rational one that the program holds in its place where the tyre has a delay.
    fail_safe, fail_safe_search : FailSafe or None
        The same with the actuator off, where there is one.
    shifted_matrix : casadi.Function
        (design, data, speed, load) -> A + (margin + reserve) 1, stable iff the margin holds.
    """

    def __init__(self, study: Study, walls: Mapping[str, tuple[float, float]] = MappingProxyType({})):
        self.study, searched = study, searched_study(study)
        self.model = LinearModel(study)
        self.search_model = self.model if searched is study else LinearModel(searched)
        self.fail_safe = self.fail_safe_search = None if study.damper.actuator is None else FailSafe(study)
        if self.fail_safe is not None and searched is not study:
            self.fail_safe_search = FailSafe(searched)
        self.design_names = study.variable_names
        self.data = np.array(data_values(study))
        self.data_names = data_names(study)
        self.load_limit = max(study.envelope.loads)

        symbols, open_walls = symbolic(searched), {key: ca.SX.sym(key) for key in walls}
        dae = build(symbols)
        design = {name: dae.design[i] for i, name in enumerate(self.design_names)}
        load, factors = ca.SX.sym("load_limit"), ca.SX.sym("factors", len(PEAKS))
        made = _with_walls(symbols.study, open_walls)
        link = elastic_linkage(made, design)
        sized = sized_layout(made, design, link, load, [factors[i] for i in range(len(PEAKS))])
        parts = sized.masses
        rows = strength(made, design, sized, _softness(made, design, link, load)) + geometry(made, design, link, sized)
        self.constraints: tuple[Constraint, ...] = tuple(rows)
        own_sizes = [size for size in sized.sizes if size.name not in design]
        own_sizes += [_wall_size(key, symbol, *walls[key]) for key, symbol in open_walls.items()]
        self.size_names = tuple(size.name for size in own_sizes)
        self.units = {v.name: v.unit for v in study.variables} | {size.name: size.unit for size in own_sizes}
        self.part_names = tuple(parts)
        self.constraint_names = tuple(c.name for c in self.constraints)
        own = ca.vertcat(ca.SX(0, 1), *(size.symbol for size in own_sizes))
        inputs = [dae.design, own, symbols.data, load, factors]
        self._mass = ca.Function("mass", inputs, [ca.vertcat(*parts.values())])
        self._rows = ca.Function("rows", inputs, [ca.vertcat(*(c.row for c in self.constraints))])
        self._values = ca.Function("values", inputs, [ca.vertcat(*(ca.horzcat(c.value, c.limit) for c in self.constraints))])
        without_sizes = [*inputs[:1], *inputs[2:]]
        least = [ca.mmax(ca.vertcat(*(value for value, _ in size.least.values()))) for size in own_sizes]
        self._least = ca.Function("least", without_sizes, [ca.vertcat(ca.SX(0, 1), *least)])
        self._event = ca.Function("event", without_sizes, [ca.vertcat(*peaks_of(sized.event))])
        damping = symbols.study.damper.damping({**design, **link.as_printed})
        self.has_one_damping = damping is not None
        rigid = dae.x.numel() == len(study.gear.states()) + len(searched.tyre.states)
        self.plain = self.has_one_damping and rigid and self.fail_safe is None and study.gear.strut is None
        damping = ca.SX.nan() if damping is None else damping * link.damper_lever**2
        self._yaw = ca.Function("yaw", [dae.design, symbols.data], [link.torsional_stiffness, damping])

        margin = symbols.study.requirements.stability_margin + study.solver.margin_reserve
        shifted = self.search_model.state_matrix(dae.design, dae.speed, dae.load, symbols.data)
        shifted += margin * ca.SX.eye(dae.x.numel())
        self.shifted_matrix = ca.Function("shifted", [dae.design, symbols.data, dae.speed, dae.load], [shifted])
        own_variables = [ScaledVariable(size.name, size.start, size.lower, size.upper, True) for size in own_sizes]
        self.variables = (*map(self._variable, self.study.variables), *own_variables)

    def _variable(self, declared: DesignVariable) -> ScaledVariable:
        given = self.study.variable(declared.name)
        return ScaledVariable(declared.name, given.start, given.min, given.max, declared.logarithmic)

    def mass_and_rows(
        self, design: ca.SX, sizes: ca.SX, data: ca.SX, load_limit: ca.SX, factors: Any = ESTIMATED
    ) -> tuple[ca.SX, ca.SX]:
        """Total mass [kg] and the strength and geometry rows (<= 0) as expressions."""
        inputs = [design, sizes, data, load_limit, factors]
        return ca.sum1(self._mass(*inputs)), self._rows(*inputs)

    def estimated_peaks(self, design: ca.SX, data: ca.SX, load_limit: ca.SX) -> ca.SX:
        """(5,) `measure.PEAKS` of the limit event before any simulation, as expressions."""
        return self._event(design, data, load_limit, ESTIMATED)

    def stiffness_and_damping(self, design: ca.SX, data: ca.SX) -> tuple[ca.SX, ca.SX]:
        """Torsional stiffness [N m/rad] and damping [N m s/rad] as expressions."""
        k_psi, c_psi = self._yaw(design, data)
        return k_psi, c_psi

    def physical(self, x: ca.SX) -> ca.SX:
        """Design variables and sizes of parts [SI] of scaled variables."""
        return ca.vertcat(*(ca.exp(x[i]) if v.logarithmic else x[i] for i, v in enumerate(self.variables)))

    @cached_property
    def screening(self) -> Screening:
        """The gear with any stiffness and damping, built when it is first asked for."""
        return Screening(searched_study(self.study))

    def worst_points(self, design: Mapping[str, float], enough: float = np.inf) -> list[OperatingPoint]:
        """Local maxima of the spectral abscissa of a design over envelope and dampings, as `worst_over_damping` has them; with
        an actuator also where it is off, as `FailSafe` has them."""
        found = worst_over_damping(self.model, self.study, design, enough)
        if self.fail_safe is not None:
            found += self.fail_safe.worst_points(design, enough)
        return sorted(found, key=lambda point: -point.abscissa)

    def abscissae(self, design: Mapping[str, float], points: np.ndarray) -> np.ndarray:
        """Spectral abscissa of a design at points (m, 3) of speed, load and factor on the damping, (m,) [1/s]."""
        return self._exact(design, points) + self.less(points)

    def less(self, points: np.ndarray) -> np.ndarray:
        """What margins at points (m, 3) are larger than that of the study, (m,) [1/s]: where an actuator is off."""
        return np.where(points[:, 2] < 0, 0.0 if self.fail_safe is None else self.fail_safe.less, 0.0)

    def _exact(self, design: Mapping[str, float], points: np.ndarray) -> np.ndarray:
        return self._at(self.model, self.fail_safe, design, points, lambda gear, V, F: gear.abscissa(V, F))

    def matrices(self, design: Mapping[str, float], points: np.ndarray) -> np.ndarray:
        """State matrices of the rational model at such points, (m, n, n)."""
        models = self.search_model, self.fail_safe_search
        return self._at(*models, design, points, lambda gear, V, F: gear.matrices(V, F))

    def _at(
        self,
        model: LinearModel,
        fail_safe: FailSafe | None,
        design: Mapping[str, float],
        points: np.ndarray,
        ask: Callable[..., Any],
    ) -> np.ndarray:
        """Of the gears with each factor, asked at their points together; below 0 with the actuator off."""
        found: list[Any] = [None] * len(points)
        for factor in dict.fromkeys(points[:, 2]):
            where = np.flatnonzero(points[:, 2] == factor)
            on = model if fail_safe is None or factor > 0 else fail_safe.model
            gear = on.at(self.study.damper.with_damping(design, abs(float(factor))))
            for i, value in zip(where, ask(gear, points[where, 0], points[where, 1]), strict=True):
                found[i] = value
        return np.array(found)

    def corrections(self, design: Mapping[str, float], points: np.ndarray) -> np.ndarray:
        """What the exact abscissa of a design has beyond that of the rational model that the program holds, (m,) [1/s]."""
        if self.search_model is self.model:
            return np.zeros(len(points))
        models = self.search_model, self.fail_safe_search
        return self._exact(design, points) - self._at(*models, design, points, lambda gear, V, F: gear.abscissa(V, F))

    # plain functions of a design, for reports, tests and other optimisers. `factors` are simulated over estimated peaks of
    # the limit event, of `factors_of`; left out, a torque must be the limit event. None of them simulates.

    def mass(self, design: Mapping[str, float], factors: np.ndarray | None = None) -> float:
        """Total mass of a design with the lightest admissible rod [kg]."""
        return float(sum(self.parts(design, factors).values()))

    def parts(self, design: Mapping[str, float], factors: np.ndarray | None = None) -> dict[str, float]:
        """Mass by part [kg]."""
        return dict(zip(self.part_names, self._call(self._mass, design, factors), strict=True))

    def rows(self, design: Mapping[str, float], factors: np.ndarray | None = None) -> dict[str, float]:
        """Strength and geometry rows, <= 0 where met (logarithmic ratios, or metres); the rod limits are met by sizing."""
        return dict(zip(self.constraint_names, self._call(self._rows, design, factors), strict=True))

    def values(self, design: Mapping[str, float], factors: np.ndarray | None = None) -> dict[str, tuple[float, float]]:
        """Value and limit of each strength and geometry constraint [SI]."""
        pairs = np.reshape(self._call(self._values, design, factors), (2, -1)).T
        return {name: (float(v), float(lim)) for name, (v, lim) in zip(self.constraint_names, pairs, strict=True)}

    def yaw_numbers(self, design: Mapping[str, float]) -> dict[str, float]:
        """Effective torsional stiffness of a design, and its damping where one number says it."""
        stiffness, damping = self._yaw(self._vector(design), self.data)
        numbers = {"torsional_stiffness": float(stiffness)}
        return numbers | ({"torsional_damping": float(damping)} if self.has_one_damping else {})

    def limit_event(self, design: Mapping[str, float], factors: np.ndarray | None = None) -> dict[str, float]:
        """Peaks of the limit event by name [SI], in the order of `measure.PEAKS`."""
        peaks = self._event(self._vector(design), self.data, self.load_limit, self._checked(factors))
        return dict(zip(PEAKS, peaks.full().ravel().tolist(), strict=True))

    def factors_of(self, design: Mapping[str, float], peaks: Mapping[str, float]) -> np.ndarray:
        """(5,) given over estimated peaks of the limit event of a design.

        Parameters
        ----------
        design : mapping
            Design variables by name [SI].
        peaks : mapping
            By the names of `measure.PEAKS` [SI], as simulated, or as a result holds them in `limit_event`.

        Returns
        -------
        ndarray
        """
        estimated = self._event(self._vector(design), self.data, self.load_limit, ESTIMATED).full().ravel()
        return np.array([peaks[name] for name in PEAKS]) / estimated

    def least_sizes(self, design: Mapping[str, float], factors: np.ndarray | None = None) -> dict[str, float]:
        """Least size of each part that meets all its limits, such as the rod diameter [SI]."""
        least = self._least(self._vector(design), self.data, self.load_limit, self._checked(factors))
        return dict(zip(self.size_names, least.full().ravel().tolist(), strict=True))

    def over_designs(self, designs: np.ndarray, factors: np.ndarray = ESTIMATED) -> dict[str, np.ndarray]:
        """Everything that needs no speed, for many designs at once.

        Parameters
        ----------
        designs : ndarray
            (m, n) design variables in the order of `design_names` [SI].
        factors : ndarray
            Of `factors_of`, the same for all; left out: the peaks as estimated.

        Returns
        -------
        dict
            ``mass`` (m,) [kg], ``rows`` (m, c) as `rows`, ``torsional_stiffness`` and ``torsional_damping`` (m,).
        """
        columns, data, load = designs.T, ca.DM(self.data), self.load_limit
        sizes = self._least(columns, data, load, factors).full()
        stiffness, damping = self._yaw(columns, data)
        return {
            "mass": self._mass(columns, sizes, data, load, factors).full().sum(axis=0),
            "rows": self._rows(columns, sizes, data, load, factors).full().T,
            "torsional_stiffness": stiffness.full().ravel(),
            "torsional_damping": damping.full().ravel(),
        }

    def _vector(self, design: Mapping[str, float]) -> np.ndarray:
        return np.array([design[name] for name in self.design_names])

    def _checked(self, factors: np.ndarray | None) -> np.ndarray:
        if factors is None and self.study.required.limit_event == "simulated":
            raise ValueError("this design is sized by simulated peaks: pass factors, of NlpSolver.simulated_factors")
        return ESTIMATED if factors is None else factors

    def _call(self, function: ca.Function, design: Mapping[str, float], factors: np.ndarray | None) -> list[float]:
        sizes = list(self.least_sizes(design, factors).values())
        result = function(self._vector(design), sizes, self.data, self.load_limit, self._checked(factors))
        return result.full().ravel(order="F").tolist()

    # the scaled variables

    def scaled(self, design: Mapping[str, float]) -> np.ndarray:
        """Scaled variables of a design, its sizes a little above their limits (estimated, if they are simulated)."""
        least = self._least(self._vector(design), self.data, self.load_limit, ESTIMATED).full().ravel()
        full = {**design, **dict(zip(self.size_names, 1.02 * least, strict=True))}
        return np.array([v.scale(full[v.name]) for v in self.variables])

    def unscaled(self, x: Sequence[float]) -> dict[str, float]:
        """Design of scaled variables (the sizes of parts left out)."""
        return {v.name: v.unscale(float(xi)) for v, xi in zip(self.variables, x, strict=True) if v.name in self.design_names}

    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Bounds of the scaled variables."""
        return (
            np.array([v.scale(v.lower) for v in self.variables]),
            np.array([v.scale(v.upper) for v in self.variables]),
        )


def _with_walls(study: Any, walls: Mapping[str, ca.SX]) -> Any:
    """The symbolic study with symbols of their own for the walls of some sections over their outer diameters."""
    sections = {key: getattr(study.mass, key).model_copy(update={"thickness_ratio": wall}) for key, wall in walls.items()}
    return study.model_copy(update={"mass": study.mass.model_copy(update=sections)})


def _wall_size(section: str, wall: ca.SX, least: float, most: float) -> Size:
    return Size(f"{section} wall", "1", wall, {"least": (least, ())}, least, least, most)


def _softness(study: Any, design: Mapping[str, ca.SX], linkage: Linkage, load: ca.SX) -> Any:
    """Stroke of the damper under a torque at the largest load over that with the shock strut fully out, s'/k_psi of both."""
    if study.gear.strut is None or study.damper.ROTARY:
        return 1
    pressed = elastic_linkage(study, design, study.gear.stroke(load))
    return pressed.damper_lever / pressed.torsional_stiffness * linkage.torsional_stiffness / linkage.damper_lever

"""Nonlinear programs of a design problem: for least mass, and for the least relaxation under which a design exists.

Each comes with two ways to say "stable with the margin at these speeds and loads":

* Hurwitz: the Lienard-Chipart conditions of the shifted characteristic polynomial. It finds the best basin most often, but
  where two modes sit on the margin at once the last Hurwitz determinant, the product of their two dampings, has no gradient
  and the program no constraint qualification.
* Factors: the shifted polynomial equals a product of factors s^2 + b s + c and s + r with b, c, r >= 0. Regular at such
  corners, but it stops where a real root passes from one factor to another.

Stability is imposed at slots, each a speed, a load and a factor on the damping as parameters, so that one program serves every
round of the exchange; slots without a point impose nothing.

Decay is imposed by cuts: ln(decay ratio) at one speed and load with its gradient, both from an integrator, and the curvature
that earlier gradients show, as a function of the scaled variables about the design where it was simulated. The exchange
renews them until the solution is that design, so that the multipliers are those of the decay itself. Simulated peaks that
size the parts are modelled in the same way.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, Protocol

import casadi as ca
import numpy as np

from ..motion.measure import PEAKS
from ..stability.hurwitz import characteristic_polynomial
from .conditions import ConditionNumbers, Conditions, HurwitzConditions, Slots, StableFactors
from .cuts import Cut, monomials
from .parameters import Blocks, Instance, Limits, instance_of
from .problem import ESTIMATED, DesignProblem

__all__ = [
    "CUTS",
    "ElasticFactorProgram",
    "ElasticHurwitzProgram",
    "FactorProgram",
    "HurwitzProgram",
    "Program",
    "has_models",
    "price",
    "relaxable",
]

Points = Sequence[tuple[float, ...]]
"""Speed, load, and a factor on the damping; left out, 1."""

CUTS = 12
"""Decay cuts that a program has room for."""

NEVER = -1e3
"""ln(decay ratio) of a cut that is not used."""

EXCESS_PRICE = 1e3
"""kg per unit of ln(decay ratio) by which cuts may be exceeded: far above any multiplier, so that it is 0 where it can be."""

SLOWEST_ROOT = 1e-3
"""Added to the magnitudes of roots [1/s] whose mean scales time, so that a root at rest does not."""

RATIO_PRICE, LENGTH_PRICE = 1.0, 10.0
"""Price of a relaxation: of a unit of a logarithmic ratio, and of a metre."""

LEAST_MARGIN = 0.1
"""Margin [1/s] whose loss costs 1 where less than that is required."""

SLACK = 1e-3
"""By how much the slacks of an elastic program start above what the start needs."""


class Program(Protocol):
    """A program with a fixed number of slots.

    Attributes
    ----------
    nlp : dict
        x, p, f, g for `casadi.nlpsol`.
    variables : Blocks
        Of x: ``design``, scaled; ``excess`` of the cuts, with a decay requirement; ``stability``, of the conditions; an
        elastic program has ``slack`` and ``margin`` too.
    rows : Blocks
        Of g: ``strength`` and geometry; ``decay``; ``damping`` of the yaw mode; ``stability``.
    parameters : Blocks
        Of p: ``data``, ``load_limit``; ``speeds``, ``loads``, ``rates``, ``corrections`` and ``factors`` on the damping of the
        slots; with simulated peaks
        ``simulated``, a switch, and ``peaks``, their models; with a decay requirement ``cuts``; with a damping ratio
        ``damping_cuts``; ``stability``.
    """

    nlp: dict[str, ca.SX]
    variables: Blocks
    rows: Blocks
    parameters: Blocks

    def __init__(self, problem: DesignProblem, slots: int): ...

    def instance(self, design: Mapping[str, float], points: Points, **options: Any) -> Instance: ...


def has_models(problem: DesignProblem) -> bool:
    """Whether something is held by models about a design."""
    required = problem.study.required
    return required.decay is not None or required.damping_ratio is not None


def relaxable(problem: DesignProblem) -> tuple[str, ...]:
    """Names of the constraints that an elastic program can relax: strength and geometry rows, decay, margin."""
    decay = ("decay_ratio",) if problem.study.required.decay is not None else ()
    return (*problem.constraint_names, *decay, "stability_margin")


def price(problem: DesignProblem, slacks: Mapping[str, Any], lost_margin: Any) -> Any:
    """What a relaxation costs: strength and geometry slacks by name, missing ones for nothing, and the margin lost [1/s]."""
    prices = {c.name: RATIO_PRICE if c.ratio else LENGTH_PRICE for c in problem.constraints}
    required = max(problem.study.required.stability_margin, LEAST_MARGIN)
    return sum(prices.get(name, 1.0) * slack for name, slack in slacks.items()) + lost_margin / required


class _Common:
    """Variables, parameters, mass, strength, geometry and decay rows, and the shifted polynomial at every slot."""

    def __init__(self, problem: DesignProblem, slots: int, margin: ca.SX | None = None):
        self.problem, self._slots = problem, slots
        self.x = ca.SX.sym("x", len(problem.variables))
        physical = problem.physical(self.x)
        n = len(problem.design_names)
        design, sizes = physical[:n], physical[n:]
        data, load_limit = ca.SX.sym("data", len(problem.data)), ca.SX.sym("load_limit")
        V, F_z, factor, rate = (ca.SX.sym(name, slots) for name in ("V", "F_z", "factor", "rate"))
        corrections = ca.SX.sym("corrections", slots)
        self.parameters = {"data": data, "load_limit": load_limit, "speeds": V, "loads": F_z, "rates": rate}
        self.parameters |= {"corrections": corrections, "factors": factor}
        factors: Any = ESTIMATED
        known = monomials(self.x[: len(problem.design_names)])
        if problem.study.required.limit_event == "simulated":
            peaks, simulated = ca.SX.sym("peaks", known.numel(), len(PEAKS)), ca.SX.sym("simulated")
            estimated = problem.estimated_peaks(design, data, load_limit)
            factors = ca.exp(simulated * (peaks.T @ known - ca.log(estimated)))
            self.parameters |= {"simulated": simulated, "peaks": peaks}
        self.mass, self.strength = problem.mass_and_rows(design, sizes, data, load_limit, factors)
        self.decay, self.damping, self.excess = ca.SX(0, 1), ca.SX(0, 1), ca.SX(0, 1)
        if has_models(problem):
            self.excess = ca.SX.sym("excess")
        if problem.study.required.damping_ratio is not None:
            damping_cuts = ca.SX.sym("damping_cuts", known.numel(), CUTS)
            self.damping = damping_cuts.T @ known - np.log1p(-problem.study.solver.decay_reserve)
            self.parameters |= {"damping_cuts": damping_cuts}
        if problem.study.required.decay is not None:
            cuts = ca.SX.sym("cuts", known.numel(), CUTS)
            ratio = data[problem.data_names.index("requirements.decay.ratio")]
            limit = ca.log(ratio) + np.log1p(-problem.study.solver.decay_reserve)
            self.decay = cuts.T @ known - limit
            self.parameters |= {"cuts": cuts}
        less = _less(problem, data)
        if margin is not None:
            data = ca.vertcat(data)  # a copy: the parameter keeps its place, the model sees the variable
            data[problem.data_names.index("requirements.stability_margin")] = margin
        polynomial = _polynomial(problem)

        def named(values: ca.SX) -> dict[str, ca.SX]:
            return {name: values[i] for i, name in enumerate(problem.design_names)}

        def in_slot(i: int) -> list[ca.SX]:
            of_slot = problem.study.damper.with_damping(named(design), ca.fabs(factor[i]))
            correction = corrections[i] + less * (factor[i] < 0)
            return [ca.vertcat(*of_slot.values()), _powered(problem, data, factor[i]), V[i], F_z[i], correction, rate[i]]

        slots_in = (in_slot(i) for i in range(slots))
        self.slots = Slots([[1.0, *ca.vertsplit(polynomial(*given))] for given in slots_in], rate)

    def numbers(
        self,
        design: Mapping[str, float],
        points: Points,
        cuts: Sequence[Cut] = (),
        peaks: Sequence[Cut] = (),
        damping_cuts: Sequence[Cut] = (),
        margin: float | None = None,
    ) -> tuple[dict[str, Any], np.ndarray, np.ndarray]:
        """Parameters by block; per slot the roots at `design`, shifted by the margin, and the rate that scales them to 1."""
        problem = self.problem
        filled = _columns([*points, *[points[-1]] * (self._slots - len(points))])
        V, F_z, factor = filled.T
        shift = problem.study.solver.margin_reserve
        shift += problem.study.required.stability_margin if margin is None else margin
        corrections = problem.corrections(design, filled)
        shifts = shift + corrections + problem.less(filled)
        roots = np.linalg.eigvals(problem.matrices(design, filled)) + shifts[:, None]
        rates = np.exp(np.log(np.abs(roots) + SLOWEST_ROOT).mean(axis=1))
        values = {"data": problem.data, "load_limit": problem.load_limit, "speeds": V, "loads": F_z, "rates": rates}
        values |= {"corrections": corrections, "factors": factor}
        n = len(problem.design_names)
        if "peaks" in self.parameters:
            models = [peak.about_zero() for peak in peaks] or [Cut.constant(0.0, n).about_zero()] * len(PEAKS)
            values |= {"simulated": float(bool(peaks)), "peaks": np.concatenate(models)}
        for name, given in (("cuts", cuts), ("damping_cuts", damping_cuts)):
            if name in self.parameters:
                unused = Cut.constant(NEVER, n).about_zero()
                columns = [cut.about_zero() for cut in given]
                values[name] = np.concatenate([*columns, *[unused] * (CUTS - len(columns))])
        return values, roots, rates

    def box(self, design: Mapping[str, float], radius: float) -> Limits:
        """Scaled variables of a design and their bounds, no design variable further than `radius` from it."""
        lower, upper = self.problem.bounds()
        x0 = np.clip(self.problem.scaled(design), lower, upper)
        around = np.append(np.full(x0.size - 1, radius), np.inf)  # the rod follows the design
        return Limits(np.maximum(lower, x0 - around), np.minimum(upper, x0 + around), x0)


def _less(problem: DesignProblem, data: ca.SX) -> ca.SX:
    """What the margin with an actuator off is larger than the other [1/s], as a function of the data."""
    if problem.fail_safe is None:
        return ca.SX(0)
    name = "requirements.fail_safe_margin"
    own = data[problem.data_names.index(name)] if name in problem.data_names else 0
    return own - data[problem.data_names.index("requirements.stability_margin")]


def _powered(problem: DesignProblem, data: ca.SX, factor: ca.SX) -> ca.SX:
    """Data without the gains of an actuator that is off."""
    gains = [i for i, name in enumerate(problem.data_names) if name.startswith("damper.control.gains.")]
    if problem.fail_safe is None or not gains:
        return data
    data = ca.vertcat(data)
    data[gains] = data[gains] * (factor > 0)
    return data


def _columns(points: Points) -> np.ndarray:
    """(m, 3) speeds, loads and factors on the damping."""
    return np.array([(*point, 1.0)[:3] for point in points])


def _polynomial(problem: DesignProblem) -> ca.Function:
    """(design, data, speed, load, correction, rate) -> a_1, ..., a_n of the shifted polynomial, time scaled by the rate."""
    inputs = [ca.SX.sym("design", len(problem.design_names)), ca.SX.sym("data", len(problem.data))]
    inputs += [ca.SX.sym(name) for name in ("speed", "load", "correction", "rate")]
    A = problem.shifted_matrix(*inputs[:4])
    scaled = (A + inputs[4] * ca.SX.eye(A.shape[0])) / inputs[5]
    return ca.Function("polynomial", inputs, [ca.vertcat(*characteristic_polynomial(scaled)[1:])])


class _Program:
    """What programs share: the common parts, conditions of stability, and the blocks of their vectors."""

    stability_type: ClassVar[type[Conditions]]
    variables: Blocks
    rows: Blocks

    def __init__(self, problem: DesignProblem, slots: int, margin: ca.SX | None = None):
        self._common = _Common(problem, slots, margin)
        self._stability = self.stability_type(self._common.slots)
        self.parameters = Blocks(**self._common.parameters, stability=self._stability.parameters)

    def _nlp(self, f: ca.SX) -> dict[str, ca.SX]:
        return {"x": self.variables.expression, "p": self.parameters.expression, "f": f, "g": self.rows.expression}

    def _instance(self, variables: Mapping[str, Limits], values: Mapping[str, Any], conditions: ConditionNumbers) -> Instance:
        own, met = {"excess": Limits(0.0, np.inf, 0.0), "stability": conditions.variables}, Limits(-np.inf, 0.0)
        rows = {"strength": met, "decay": met, "damping": met, "stability": conditions.rows}
        values = {**values, "stability": conditions.parameters}
        return instance_of(self.variables, self.rows, self.parameters, {**own, **variables}, rows, values)


class _MassProgram(_Program):
    """Least mass under the strength and geometry rows and the stability conditions.

    Parameters
    ----------
    problem : DesignProblem
    slots : int
        Number of (speed, load) points it has room for.
    """

    def __init__(self, problem: DesignProblem, slots: int):
        super().__init__(problem, slots)
        common, excess = self._common, ca.sum1(self._common.excess)
        self.variables = Blocks(design=common.x, excess=common.excess, stability=self._stability.variables)
        self.rows = Blocks(
            strength=common.strength,
            decay=common.decay - excess,
            damping=common.damping - excess,
            stability=self._stability.rows,
        )
        self.nlp = self._nlp(common.mass + EXCESS_PRICE * excess)

    def instance(
        self,
        design: Mapping[str, float],
        points: Points,
        cuts: Sequence[Cut] = (),
        peaks: Sequence[Cut] = (),
        damping_cuts: Sequence[Cut] = (),
        radius: float = np.inf,
        **options: Any,
    ) -> Instance:
        """The program at `points`, started and scaled at `design`, no design variable further than `radius` from there."""
        values, roots, rates = self._common.numbers(design, points, cuts, peaks, damping_cuts)
        conditions = self._stability.numbers(roots, rates, len(points))
        return self._instance({"design": self._common.box(design, radius)}, values, conditions)


class HurwitzProgram(_MassProgram):
    """Least mass; stability by Lienard-Chipart conditions."""

    stability_type = HurwitzConditions


class FactorProgram(_MassProgram):
    """Least mass; stability by factors."""

    stability_type = StableFactors


class _ElasticProgram(_Program):
    """Least relaxation under which a design exists: strength and geometry rows and the margin may give way.

    The objective is the sum of the slacks: logarithmic ratios, lengths over 0.1 m, and the loss of margin over the margin
    (or 0.1 1/s if that is larger). Which of them may move is set at each instance.

    Parameters
    ----------
    problem : DesignProblem
    slots : int
        Number of (speed, load) points it has room for.
    """

    def __init__(self, problem: DesignProblem, slots: int):
        margin = ca.SX.sym("margin")
        super().__init__(problem, slots, margin)
        common, conditions = self._common, self._stability
        self._required = problem.study.required.stability_margin
        self._names = relaxable(problem)
        slack, excess = ca.SX.sym("slack", len(self._names) - 1), ca.sum1(common.excess)
        strength = common.strength.numel()
        self.variables = Blocks(
            design=common.x, excess=common.excess, slack=slack, margin=margin, stability=conditions.variables
        )
        self.rows = Blocks(
            strength=common.strength - slack[:strength],
            decay=common.decay - ca.sum1(slack[strength:]) - excess,
            damping=common.damping - excess,
            stability=conditions.rows,
        )
        by_name = {name: slack[i] for i, name in enumerate(self._names[:-1])}
        self.nlp = self._nlp(price(problem, by_name, self._required - margin) + EXCESS_PRICE * excess)

    def instance(
        self,
        design: Mapping[str, float],
        points: Points,
        cuts: Sequence[Cut] = (),
        peaks: Sequence[Cut] = (),
        damping_cuts: Sequence[Cut] = (),
        radius: float = np.inf,
        **options: Any,
    ) -> Instance:
        """The program at `points`, started at `design`; the constraints named in the option `relaxed` may give way."""
        problem = self._common.problem
        may_move = np.array([name in options["relaxed"] for name in self._names])
        needed = np.zeros(len(self._names) - 1)
        exceeded = list(problem.rows(design, _factors(problem, design, peaks)).values())
        needed[: len(exceeded)] = np.maximum(exceeded, 0.0)
        abscissa = float(problem.abscissae(design, _columns(points)).max())
        kept = min(self._required, -abscissa - 2 * problem.study.solver.margin_reserve)
        slack, margin = np.where(may_move[:-1], needed + SLACK, 0.0), kept if may_move[-1] else self._required
        values, roots, rates = self._common.numbers(design, points, cuts, peaks, damping_cuts, margin)
        variables = {
            "design": self._common.box(design, radius),
            "slack": Limits(0.0, np.where(may_move[:-1], np.inf, 0.0), slack),
            "margin": Limits(-np.inf if may_move[-1] else self._required, self._required, margin),
        }
        return self._instance(variables, values, self._stability.numbers(roots, rates, len(points)))


def _factors(problem: DesignProblem, design: Mapping[str, float], peaks: Sequence[Cut]) -> np.ndarray:
    """Of the limit event, from the models of its peaks; as estimated where there are none."""
    if not peaks:
        return ESTIMATED
    x = problem.scaled(design)[: len(problem.design_names)]
    return problem.factors_of(design, {name: float(np.exp(peak.at(x))) for name, peak in zip(PEAKS, peaks, strict=True)})


class ElasticHurwitzProgram(_ElasticProgram):
    """Least relaxation; stability by Lienard-Chipart conditions."""

    stability_type = HurwitzConditions


class ElasticFactorProgram(_ElasticProgram):
    """Least relaxation; stability by factors."""

    stability_type = StableFactors

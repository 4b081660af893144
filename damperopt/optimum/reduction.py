"""The design problem as a lower bound sees it: mass and requirements of the variables, and the few numbers of its dynamics.

Between the gear and its damper stands, about the yaw axis, K in front of [k parallel (c in series with k_s)]: a Zener element

    Z(s) = (k0 + kappa s)/(1 + tau s),
    k0 = K k/(K + k),  tau = c (1/k_s + 1/(K + k)),  kappa = c K (k + k_s)/(k_s (K + k)),

so that the characteristic function of the whole gear is (1 + tau s) D0(s) + (k0 + kappa s) D1(s), with D0 and D1 of the gear
alone. With rigid parts kappa is c and tau is 0. Three numbers, or two, carry all linear dynamics.

Let go from the torque T, the damper carries T (1 + k/K) n at most, where n hangs on the three numbers alone: the force is a
variable here, so that no motion is integrated.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np

from ..linkages.base import TorqueLinks
from ..linkages.elastic import elastic_linkage
from ..objectives import SizedLayout, member_sizes
from ..ports.linkage import Linkage
from ..strength.limit_event import limit_event
from ..study.study import Study
from .constraints import geometry, strength

__all__ = ["FORCE", "Reduction", "yaw_numbers"]

FORCE = "damper_force"
"""Variable of an elastic chain [N]."""

RELEASE = "release"
"""Row of it, to which ln n is added."""

MOST_FORCE = 1e9
"""[N]; beyond any damper."""


def yaw_numbers(linkage: Linkage, damping: Any) -> dict[str, Any]:
    """k0, kappa and, of an elastic chain, tau about the yaw axis; expressions.

    Parameters
    ----------
    linkage : Linkage
    damping : Expr
        c_lambda along the damper [N s/m].

    Returns
    -------
    dict
        ``stiffness`` [N m/rad], ``damping`` [N m s/rad], ``lag`` [s].
    """
    k, c = linkage.torsional_stiffness, damping * linkage.damper_lever**2
    soft_front = 0 if linkage.links is None else 1 / (linkage.links * linkage.reach**2)
    soft_behind = 0 if linkage.series is None else 1 / (linkage.series * linkage.damper_lever**2)
    if linkage.links is None and linkage.series is None:
        return {"stiffness": k, "damping": c}
    # 1/K + 1/k, and so on, as sums of positive terms
    stiffness = k / (1 + k * soft_front)
    lag = c * (soft_behind + soft_front / (1 + k * soft_front))
    return {"stiffness": stiffness, "damping": c * (1 + k * soft_behind) / (1 + k * soft_front), "lag": lag}


class Reduction:
    """Mass, requirements and yaw numbers of a study as functions of one vector.

    Parameters
    ----------
    study : Study
        Whose limit event is a torque.

    Attributes
    ----------
    names : tuple of str
        Of the variables.
    logarithmic : tuple of bool
    low, high : ndarray
        (n,) bounds, of logarithms where they are.
    mass : casadi.Function
    whole : casadi.Function
        Of one vector: the mass [kg], `rows`, ratios of positive quantities that are 1 at most, and the numbers.
    rows, numbers : tuple of str
        The latter of `yaw_numbers`; none where the damper is not one viscous number.
    torque : float
        Limit torque [N m].
    """

    def __init__(self, study: Study):
        self.study, load = study, max(study.envelope.loads)
        free = {v.name: ca.SX.sym(v.name) for v in study.variables}
        bounds = {v.name: (study.variable(v.name).min, study.variable(v.name).max) for v in study.variables}
        design, rows = dict(free), dict[str, Any]()
        if isinstance(study.damper, TorqueLinks):
            design, rows = _in_parts_of_the_reach(free, bounds)
        linkage = elastic_linkage(study, design)
        event = limit_event(study, linkage, design, load, [1.0] * 5)
        damping = study.damper.damping({**design, **linkage.as_printed})
        numbers = {} if damping is None else yaw_numbers(linkage, damping)
        self.torque, chain = float(event.torque), "lag" in numbers and study.damper.has_sized_parts()
        if chain:
            free[FORCE], bounds[FORCE] = ca.SX.sym(FORCE), (1.0, MOST_FORCE)
            event = replace(event, damper_force=free[FORCE])
        made: Any = study.damper.parts(event, study.mass)
        masses = {**study.damper.masses(design, event, study), **made.masses}
        sizes = (*member_sizes(study, design, event), *made.sizes)
        sized = SizedLayout(event, masses, sizes, made.length, made.capacities)
        for size in sizes:
            if size.name not in design:
                free[size.name], bounds[size.name] = size.symbol, (size.lower, size.upper)
        x, self.names = ca.vertcat(*free.values()), tuple(free)
        plain = {v.name for v in study.variables if not v.logarithmic}
        self.logarithmic = tuple(name not in plain for name in free)
        ends = np.array([bounds[name] for name in free])
        self.low, self.high = (np.where(self.logarithmic, np.log(end), end) for end in ends.T)
        constraints = strength(study, design, sized) + geometry(study, design, linkage, sized)
        for c in constraints:
            smaller, larger = (c.limit, c.value) if c.at_least else (c.value, c.limit)
            if c.name == "tyre_clearance":  # a difference that may be negative: h + a - R_w >= d is h >= R_w + d - a
                larger = free["height_part"] * free["reach"]
                smaller = study.gear.wheel_radius + study.required.tyre_clearance - study.mass.lower_lug_height
                if smaller <= 0:
                    continue
            rows[c.name] = smaller / larger
        if chain:
            front = 0 if linkage.links is None else linkage.torsional_stiffness / (linkage.links * linkage.reach**2)
            released = self.torque * (1 + front) / (linkage.damper_lever * free[FORCE])
            rows[RELEASE] = released
        self.rows, self.numbers = tuple(rows), tuple(numbers)
        self.whole = ca.Function("whole", [x], [ca.vertcat(sum(masses.values()), *rows.values(), *numbers.values())])


class _Angle:
    """Of a torque link to the strut's axis, as reach and height over its length."""

    def __init__(self, reach: ca.SX, height: ca.SX, length: ca.SX):
        self._sin, self._cos = reach / length, height / length

    def sin(self) -> ca.SX:
        return self._sin

    def cos(self) -> ca.SX:
        return self._cos


def _in_parts_of_the_reach(
    free: dict[str, ca.SX], bounds: dict[str, tuple[float, float]]
) -> tuple[dict[str, Any], dict[str, ca.SX]]:
    """Reach of the apex, and height and side distance in parts of it, in the place of L, gamma and b; their bounds as ratios.

    What is a root of a sum of squares of lengths hangs on the parts alone, but for a power of the reach.
    """
    (shortest, longest), (least, most) = bounds.pop("L"), bounds.pop("gamma")
    del free["L"], free["gamma"]
    reach, part = free["reach"], free["height_part"] = ca.SX.sym("reach"), ca.SX.sym("height_part")
    bounds["reach"] = shortest * math.sin(least), longest * math.sin(most)
    bounds["height_part"] = 1 / math.tan(most), 1 / math.tan(least)
    height = part * reach
    L = ca.sqrt(reach**2 + height**2)
    rows, design = {"L_min": shortest / L, "L_max": L / longest}, {}
    if "b" in free:
        nearest, furthest = bounds.pop("b")
        del free["b"]
        free["side_part"] = ca.SX.sym("side_part")
        bounds["side_part"] = nearest / bounds["reach"][1], furthest / bounds["reach"][0]
        b = design["b"] = free["side_part"] * reach
        rows |= {"b_min": nearest / b, "b_max": b / furthest}
    return {**free, **design, "L": L, "gamma": _Angle(reach, height, L)}, rows

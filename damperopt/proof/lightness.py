"""Mass and requirements of a study as the check of a lower bound writes them: ratios of positive quantities that are 1 at most.

Variables are those of the design and the sizes of parts, but for torque links: the reach of the apex ell, h/ell and b/ell
stand for L = ell sqrt(1 + (h/ell)^2), gamma and b. Of an elastic chain the force in the damper is a variable too: let go
from the torque T it is T (1 + k/K) n/lever at least, with n of the yaw numbers alone. Leaving out a requirement makes a
bound smaller, not wrong.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np

from ..expressions.calculus import cos
from ..linkages.base import TorqueLinks
from ..linkages.elastic import elastic_linkage
from ..ports.linkage import Linkage, Member
from ..ports.sizing import LimitEvent, Sized
from ..strength.buckling import least_lateral_inertia
from ..strength.limit_event import limit_event
from ..strength.materials import allowable_stress
from ..strength.members import allowables, distance, fatigue_ratio, least_sections, root_stress
from ..study.study import Study
from .intervals import Interval, logarithm
from .let_go import peak_at_least

__all__ = ["Lightness"]

FORCES = 1.0, 1e9
"""Between which a variable force is looked for [N]; one above weighs more than any gear."""


class Lightness:
    """The study as functions of one vector.

    Parameters
    ----------
    study : Study
        Whose limit event is a torque.

    Attributes
    ----------
    names : tuple of str
    logarithmic : tuple of bool
    low, high : ndarray
        (n,) of a box that holds every design: logarithms where they are.
    function : casadi.Function
        Mass [kg], the ratios, and the yaw numbers.
    rows, numbers : tuple of str
    torque, inertia : float
        Limit torque [N m], yaw inertia [kg m^2].
    coldest : float
        Factor on the damping with which the force is reckoned, over that of the yaw numbers.
    """

    def __init__(self, study: Study):
        self._study = study
        free, bounds, made, rows = self._variables()
        linkage = elastic_linkage(study, made)
        event = limit_event(study, linkage, made, max(study.envelope.loads), (1.0, 1.0, 1.0, 1.0, 1.0))
        self.torque, self.inertia = float(event.torque), float(study.gear.yaw_inertia)
        low, high = study.damper.damping_factors()
        factor = min(max(1.0, low), high)
        self.factor, self.coldest = factor, high / factor
        numbers = self._numbers(linkage, made, factor)
        if len(numbers) == 3 and study.damper.has_sized_parts():
            free["damper_force"], bounds["damper_force"] = ca.SX.sym("damper_force"), FORCES
            event = replace(event, damper_force=free["damper_force"])
            K = None if linkage.links is None else linkage.links * linkage.reach**2
            share = 1 if K is None else 1 + linkage.torsional_stiffness / K
            rows["release"] = self.torque * share / (linkage.damper_lever * event.damper_force)
        damper: Sized = study.damper.parts(event, study.mass)
        for size in damper.sizes:
            if size.name not in made:
                free[size.name], bounds[size.name] = size.symbol, (size.lower, size.upper)
        mass = sum(study.damper.masses(made, event, study).values()) + sum(damper.masses.values())
        rows |= self._strength(made, event, damper) | self._geometry(made, linkage, event, damper)
        x = ca.vertcat(*free.values())
        self.names, self.rows, self.numbers = tuple(free), tuple(rows), tuple(numbers)
        plain = {v.name for v in study.variables if not v.logarithmic}
        self.logarithmic = tuple(name not in plain for name in free)
        self.low, self.high = self._box(bounds)
        self.function = ca.Function("lightness", [x], [ca.vertcat(mass, *rows.values(), *numbers.values())])

    def vector(self, numbers: Mapping[str, float]) -> np.ndarray:
        """The variables of a design, from design variables, sizes and forces by name."""
        known = dict(numbers)
        if isinstance(self._study.damper, TorqueLinks):
            L, gamma = known["L"], known["gamma"]
            known["reach"] = L * math.sin(gamma)
            known["height_part"] = 1 / math.tan(gamma)
            known["side_part"] = known.get("b", 0.0) / known["reach"]
        return np.array([known[name] for name in self.names])

    def peak(self, low: np.ndarray, high: np.ndarray) -> float:
        """ln of a lower bound of what the damper carries, in parts of the limit torque, on a box of ln of the yaw numbers."""
        cold = np.array([0.0, 1.0, 1.0]) * math.log(self.coldest)
        return peak_at_least(tuple(low + cold), tuple(high + cold), self.inertia)

    def _variables(self) -> tuple[dict[str, Any], dict[str, Any], dict[str, Any], dict[str, Any]]:
        """Symbols, their bounds, what the components see, and bounds that became ratios."""
        study = self._study
        given: dict[str, Any] = {v.name: study.variable(v.name) for v in study.variables}
        if not isinstance(study.damper, TorqueLinks):
            alone = {name: ca.SX.sym(name) for name in given}
            return alone, {name: (v.min, v.max) for name, v in given.items()}, dict(alone), {}
        bounds: dict[str, Any] = {n: (v.min, v.max) for n, v in given.items() if n not in ("L", "gamma", "b")}
        L, gamma, b = given["L"], given["gamma"], given.get("b")
        bounds["reach"] = L.min * math.sin(gamma.min), L.max * math.sin(gamma.max)
        bounds["height_part"] = 1 / math.tan(gamma.max), 1 / math.tan(gamma.min)
        if b is not None:
            bounds["side_part"] = b.min / bounds["reach"][1], b.max / bounds["reach"][0]
        free: dict[str, Any] = {name: ca.SX.sym(name) for name in bounds}
        ell = free["reach"]
        h = free["height_part"] * ell
        length = ca.sqrt(ell**2 + h**2)
        made = {**free, "L": length, "gamma": _Inclined(ell / length, h / length)}
        rows: dict[str, Any] = {"L_min": L.min / length, "L_max": length / L.max}
        if b is not None:
            made["b"] = free["side_part"] * ell
            rows |= {"b_min": b.min / made["b"], "b_max": made["b"] / b.max}
        return free, bounds, made, rows

    def _box(self, bounds: Mapping[str, tuple[float, float]]) -> tuple[np.ndarray, np.ndarray]:
        """A little wider than the bounds: their own rounding is a unit of the last place."""
        ends = []
        for name, log in zip(self.names, self.logarithmic, strict=True):
            low, high = bounds[name]
            given = Interval(low * (1 - 1e-14), high * (1 + 1e-14))
            ends.append(logarithm(given) if log else given)
        return np.array([float(e.low) for e in ends]), np.array([float(e.high) for e in ends])

    def _numbers(self, linkage: Linkage, made: Mapping[str, Any], factor: float) -> dict[str, Any]:
        """k0, kappa and tau; see `proof.yaw`. Empty: the damper is not one viscous number."""
        damping = self._study.damper.damping({**made, **linkage.as_printed})
        if damping is None or self._study.damper.ROTARY:
            return {}
        k, c = linkage.torsional_stiffness, factor * damping * linkage.damper_lever**2
        K = None if linkage.links is None else linkage.links * linkage.reach**2
        k_s = None if linkage.series is None else linkage.series * linkage.damper_lever**2
        if K is None and k_s is None:
            return {"stiffness": k, "damping": c}
        gives_front = 0 if K is None else k / K
        gives_behind = 0 if k_s is None else k / k_s
        loss = c / (1 + gives_front)
        lag = (0 if k_s is None else c / k_s) + (0 if K is None else loss / K)
        return {"stiffness": k / (1 + gives_front), "damping": loss * (1 + gives_behind), "lag": lag}

    def _strength(self, made: Mapping[str, Any], event: LimitEvent, damper: Sized) -> dict[str, Any]:
        study, rows = self._study, dict[str, Any]()
        sized: set[str] = set()
        for member in study.damper.members(made):
            if member.kind in ("arm", "beam"):
                rows |= self._arm(member, event)
            if member.variable and member.variable not in sized:
                sized.add(member.variable)
                own = made[member.variable]
                rows |= {f"{member.kind}_{k}": least / own for k, least in least_sections(member, event, study).items()}
        for size in damper.sizes:
            rows |= {name: least / size.symbol for name, (least, _) in size.least.items()}
        rows |= {capacity.name: capacity.asked / capacity.has for capacity in damper.capacities}
        if not study.damper.ROTARY:
            stroke = event.stroke if event.service_stroke is None else event.service_stroke
            required = study.required
            rows["working_stroke"] = required.stroke_ratio * required.apex_clearance / stroke
        return rows

    def _arm(self, member: Member, event: LimitEvent) -> dict[str, Any]:
        study, name = self._study, member.kind
        stress, section = root_stress(member, event, study), getattr(study.mass, member.section)
        if not study.damper.has_sized_parts():
            rows = {f"{name}_stress": stress / allowable_stress(study.material, event.safety_factor, event.ultimate_factor)}
            fatigue, strength, slope = (
                study.required.fatigue,
                study.material.fatigue_strength_coefficient,
                study.material.fatigue_exponent,
            )
            if strength is not None and slope is not None:
                endured = strength * (2 * fatigue.cycles) ** slope
                rows[f"{name}_fatigue"] = fatigue.stress_fraction * stress / endured
            return rows
        rows = {f"{name}_{k}": stress / allowed for k, allowed in allowables(study.material, event, section).items()}
        lever = distance(member.start, member.end) if member.bending_length is None else member.bending_length
        moment = event.ultimate_factor * getattr(event, member.load) * lever
        if (tipped := least_lateral_inertia(section, study.material, moment, lever)) is not None:
            rows[f"{name}_lateral"] = tipped / member.inertia
        if (ratio := fatigue_ratio(member, stress, event, study)) is not None:
            rows[f"{name}_fatigue"] = ratio
        return rows

    def _geometry(self, made: Mapping[str, Any], linkage: Linkage, event: LimitEvent, damper: Sized) -> dict[str, Any]:
        study, required, rows = self._study, self._study.required, dict[str, Any]()
        if study.damper.ROTARY:
            return rows
        rows |= {"reach_min": required.reach.min / linkage.reach, "reach_max": linkage.reach / required.reach.max}
        elastic, stop = study.damper.has_sized_parts(), study.damper.stop
        if isinstance(study.damper, TorqueLinks):
            height = made["L"] * cos(made["gamma"])
            lugs, least = required.lug_distance, study.gear.wheel_radius + required.tyre_clearance
            rows |= {"lug_distance_min": lugs.min / (2 * height), "lug_distance_max": 2 * height / lugs.max}
            if least > study.mass.lower_lug_height:
                rows["tyre_clearance"] = (least - study.mass.lower_lug_height) / height
            if elastic and (most := study.damper.links.hinge_width_max) is not None:
                rows["hinge_width"] = study.damper.links.width(made["L"]) / most
        if linkage.damper_length is not None and damper.length is not None:
            rows["damper_length"] = damper.length / linkage.damper_length
        elif elastic and damper.length is not None:
            rows["apex_room"] = damper.length / required.apex_room
        if elastic and stop is not None:
            rows["end_stop"] = event.stroke / stop.stroke
        return rows


class _Inclined:
    """An angle by its sine and cosine."""

    def __init__(self, sine: ca.SX, cosine: ca.SX):
        self._sine, self._cosine = sine, cosine

    def sin(self) -> ca.SX:
        return self._sine

    def cos(self) -> ca.SX:
        return self._cosine

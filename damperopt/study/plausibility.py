"""Numbers that are possible but not usual: said beside an answer, never refused."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ..results import ConstraintResult, DesignResult
from .study import Study

__all__ = ["Answer", "Implausible", "implausible", "implausible_answer", "implausible_masses"]

GRAVITY = 9.81

_YAW = (5.0, 60.0)
"""Frequencies of shimmy in yaw [Hz]."""

_DECIDES = 0.1
"""Per cent of mass for a per cent of a limit, beyond which the limit decides the mass."""

_ROUNDING = 1e-6
"""Of an optimum that lies on its limit."""


@dataclass(frozen=True)
class Implausible:
    """A number outside its usual range.

    Attributes
    ----------
    key : str
        Key path of the study that it belongs to.
    what : str
        What it is, in words.
    value : float
        [`unit`]
    unit : str
    usual : tuple of float
        Ends of the usual range [`unit`]; an end may be infinite.
    """

    key: str
    what: str
    value: float
    unit: str
    usual: tuple[float, float]

    def __str__(self) -> str:
        unit = "" if self.unit == "1" else f" {self.unit}"
        low, high = self.usual
        usual = f"{low:.3g} to {high:.3g}"
        if math.isinf(high):
            usual = f"at least {low:.3g}"
        if low == -math.inf:
            usual = f"at most {high:.3g}"
        return f"{self.key}: {self.what} is {self.value:.3g}{unit}; usual: {usual}{unit}"


@dataclass(frozen=True)
class Answer:
    """Numbers of a design that a practitioner looks at first; what is None is not looked at.

    Attributes
    ----------
    parts : mapping of str to float
        Mass by part [kg].
    damper_mass, damper_force : float or None
        Of the damper [kg], and its largest force [N].
    rod_diameter : float or None
        [m]
    working_stroke : float or None
        To one side, under the service torque [m].
    yaw_frequencies : sequence of float
        Of the yaw mode at the speeds and loads of the envelope [Hz].
    limits : sequence of ConstraintResult
        Constraints with their shadow prices.
    """

    parts: Mapping[str, float] = field(default_factory=dict)
    damper_mass: float | None = None
    damper_force: float | None = None
    rod_diameter: float | None = None
    working_stroke: float | None = None
    yaw_frequencies: Sequence[float] = ()
    limits: Sequence[ConstraintResult] = ()

    @classmethod
    def of(cls, result: DesignResult, yaw_frequencies: Sequence[float] = ()) -> Answer:
        """Of a result; the frequencies of the yaw mode come beside it."""
        parts = {} if result.mass is None else result.mass.parts
        stroke = next((c.value for c in result.constraints if c.name == "working_stroke"), None)
        rod = (result.derived | result.design).get("rod_diameter")
        damper = parts.get("damper"), result.limit_event.get("damper_force"), rod
        return cls(parts, *damper, stroke, yaw_frequencies, result.constraints)


def implausible_answer(study: Study, answer: Answer) -> list[Implausible]:
    """What a practitioner would not believe of a design, by number.

    Parameters
    ----------
    study : Study
    answer : Answer

    Returns
    -------
    list of Implausible
        The yaw mode outside 5 to 60 Hz; a damper below 1 kg for more than 5 kN; a rod below 12 mm; a stroke below ten times
        the apex clearance; a part below 2 % of the whole; a limit of the layout that decides the mass.
    """
    numbers = [*_of_yaw_mode(answer), *_of_damper(study, answer), *_of_shares(answer), *_of_limits(study, answer)]
    return [number for number in numbers if not number.usual[0] <= number.value <= number.usual[1]]


def _of_yaw_mode(answer: Answer) -> Iterator[Implausible]:
    if answer.yaw_frequencies:
        for which, frequency in (("least", min(answer.yaw_frequencies)), ("largest", max(answer.yaw_frequencies))):
            yield Implausible("design", f"the {which} frequency of the yaw mode", frequency, "Hz", _YAW)


def _of_damper(study: Study, answer: Answer) -> Iterator[Implausible]:
    mass, force = answer.damper_mass, answer.damper_force
    if mass is not None and force is not None and force > 5e3:
        yield Implausible("mass", f"the mass of a damper for {force / 1e3:.3g} kN", mass, "kg", (1.0, math.inf))
    if answer.rod_diameter is not None:
        thin = (12.0 * (1 - _ROUNDING), math.inf)
        yield Implausible("mass.least_rod_diameter", "the damper's rod", 1e3 * answer.rod_diameter, "mm", thin)
    if answer.working_stroke is not None and study.requirements is not None:
        clearances = answer.working_stroke / study.requirements.apex_clearance
        what = "the working stroke over the clearance of the apex"
        yield Implausible("requirements.stroke_ratio", what, clearances, "1", (10.0 * (1 - _ROUNDING), math.inf))


def _of_shares(answer: Answer) -> Iterator[Implausible]:
    total = sum(answer.parts.values())
    for part, mass in answer.parts.items():
        yield Implausible("mass", f"the share of the part '{part}'", 100 * mass / total, "%", (2.0, math.inf))


def _of_limits(study: Study, answer: Answer) -> Iterator[Implausible]:
    total = sum(answer.parts.values())
    for limit in answer.limits:
        if limit.kind not in ("geometry", "bound") or not limit.active or not total:
            continue
        unlisted = [key for key in limit.relaxed_by if _at_default(study, key)]
        left = f", with {' and '.join(unlisted)} at the default" if unlisted else ""
        what = (
            f"the limit '{limit.name}' ({limit.limit:.4g} {limit.unit}) has a price of {limit.shadow_price:+.3g} kg per "
            f"{limit.unit}{left}: per cent of mass for a per cent of it"
        )
        key = next(iter((*unlisted, *limit.relaxed_by)), "design")
        yield Implausible(key, what, abs(limit.shadow_price * limit.limit) / total, "1", (-math.inf, _DECIDES))


def _at_default(study: Study, path: str) -> bool:
    """Whether a number of the study is what it is without being given."""
    *blocks, leaf = path.split(".")
    record: Any = study
    for key in blocks:
        record = getattr(record, key, None)
    declared = getattr(type(record), "model_fields", {}).get(leaf)
    return declared is not None and not declared.is_required() and getattr(record, leaf) == declared.default


def implausible(study: Study, design: Mapping[str, float] | None = None) -> list[Implausible]:
    """Numbers of a study, and of a design, that no gear in service has.

    Parameters
    ----------
    study : Study
    design : mapping of str to float or None
        Design variables by name [SI]; None: the stiffness in yaw is judged only where the study gives it.

    Returns
    -------
    list of Implausible
        Empty for a usual gear. The ranges are wide; what is outside is a typing error, a lab model, or a set of published data
        that is not a real part.
    """
    numbers = [*_of_tyre(study), *_of_gear(study), *_of_frequencies(study, design), *_of_parts(study)]
    return [number for number in numbers if not number.usual[0] <= number.value <= number.usual[1]]


def implausible_masses(parts: Mapping[str, float]) -> list[Implausible]:
    """Parts that weigh a hundred times all others together.

    Parameters
    ----------
    parts : mapping of str to float
        Mass by part [kg].

    Returns
    -------
    list of Implausible
    """
    total = sum(parts.values())
    heavy = [(part, mass, 100 * (total - mass)) for part, mass in parts.items() if 0 < 100 * (total - mass) < mass]
    return [Implausible("mass", f"the part '{part}'", mass, "kg", (0.0, most)) for part, mass, most in heavy]


def _of_tyre(study: Study) -> Iterator[Implausible]:
    tyre, radius = study.tyre, study.gear.wheel_radius
    on_wheels = {(own, of.pressure): of for load in study.envelope.loads for own, of in study.on_wheels(load)}
    numbers = (
        (load, *of.linear(load, of.pressure)) for (load, _), of in sorted(on_wheels.items(), key=lambda item: item[0][0])
    )
    at_loads = [[math.nan if x is None else float(x) for x in row] for row in numbers]  # a line may do without sigma
    seen: set[tuple[float, ...]] = set()
    if own := tyre.radius():
        yield Implausible("gear.wheel_radius", "the radius of the wheel", radius, "m", (0.8 * own, 1.02 * own))
    for load, side, moment, sigma, a in at_loads:
        data = tuple(round(value, 9) for value in (side / load, moment / load, sigma, a))
        if data in seen:  # the same at every load
            continue
        seen.add(data)
        where = f"at {load / 1e3:.4g} kN"
        yield Implausible("tyre", f"the slope of the side force, per radian and load, {where}", side / load, "1", (1.0, 30.0))
        if side:
            yield Implausible("tyre", f"the pneumatic trail {where}", moment / side, "m", (0.0, 2 * a))
        if tyre.contact.RELAXES:
            yield Implausible("tyre.relaxation_length", f"the relaxation length {where}", sigma, "m", (0.5 * a, 10 * a))
        yield Implausible("tyre.half_contact_length", f"the half contact length {where}", a, "m", (0.05 * radius, radius))


def _of_gear(study: Study) -> Iterator[Implausible]:
    gear = study.gear
    radius = gear.wheel_radius
    yield Implausible("gear.caster_length", "the offset of the axle", gear.caster_length, "m", (-radius, 2 * radius))
    yield Implausible("gear.rake_angle", "the rake", math.degrees(gear.rake_angle), "deg", (-20.0, 20.0))
    carried = max(study.envelope.loads) / GRAVITY
    yield Implausible(
        "gear.yaw_inertia",
        "what swivels, as a mass at the radius of the wheel",
        gear.yaw_inertia / radius**2,
        "kg",
        (carried / 1000, carried),
    )


def _of_frequencies(study: Study, design: Mapping[str, float] | None) -> Iterator[Implausible]:
    gear, usual = study.gear, _YAW
    lateral = getattr(gear, "lateral", None)
    if lateral is not None and lateral.stiffness:
        frequency = math.sqrt(lateral.stiffness / lateral.inertia) / (2 * math.pi)
        yield Implausible("gear.lateral", "the frequency of lateral bending, without the tyre", frequency, "Hz", usual)
    if design is None and study.variables:
        return
    stiffness = study.damper.linkage(dict(design or {}), study.material.youngs_modulus).torsional_stiffness
    if not float(stiffness):  # free castering
        return
    frequency = math.sqrt(max(float(stiffness), 0.0) / gear.yaw_inertia) / (2 * math.pi)
    yield Implausible(
        "gear.yaw_inertia", "the frequency of yaw against the stiffness of the damper, without the tyre", frequency, "Hz", usual
    )


def _of_parts(study: Study) -> Iterator[Implausible]:
    for key, material in (("material", study.material), ("mass.damper_material", study.mass.damper_material)):
        yield Implausible(key, "Young's modulus", material.youngs_modulus / 1e9, "GPa", (10.0, 500.0))
        yield Implausible(key, "the density", material.density, "kg/m^3", (1000.0, 20000.0))
    yield Implausible("mass.working_pressure", "the peak pressure", study.mass.working_pressure / 1e6, "MPa", (2.0, 80.0))

"""Numbers that are possible but not usual: said beside an answer, never refused."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from .study import Study

__all__ = ["Implausible", "implausible", "implausible_masses"]

GRAVITY = 9.81


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
        Ends of the usual range [`unit`].
    """

    key: str
    what: str
    value: float
    unit: str
    usual: tuple[float, float]

    def __str__(self) -> str:
        unit = "" if self.unit == "1" else f" {self.unit}"
        low, high = self.usual
        return f"{self.key}: {self.what} is {self.value:.3g}{unit}; usual: {low:.3g} to {high:.3g}{unit}"


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
    numbers = ((load, *tyre.linear(load, tyre.pressure)) for load in study.envelope.loads)
    at_loads = [[math.nan if x is None else float(x) for x in row] for row in numbers]  # a line may do without sigma
    seen: set[tuple[float, ...]] = set()
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
    gear, usual = study.gear, (5.0, 60.0)
    lateral = getattr(gear, "lateral", None)
    if lateral is not None and lateral.stiffness:
        frequency = math.sqrt(lateral.stiffness / lateral.inertia) / (2 * math.pi)
        yield Implausible("gear.lateral", "the frequency of lateral bending, without the tyre", frequency, "Hz", usual)
    if design is None and study.variables:
        return
    stiffness = study.damper.linkage(dict(design or {}), study.material.youngs_modulus).torsional_stiffness
    frequency = math.sqrt(max(float(stiffness), 0.0) / gear.yaw_inertia) / (2 * math.pi)
    yield Implausible(
        "gear.yaw_inertia", "the frequency of yaw against the stiffness of the damper, without the tyre", frequency, "Hz", usual
    )


def _of_parts(study: Study) -> Iterator[Implausible]:
    for key, material in (("material", study.material), ("mass.damper_material", study.mass.damper_material)):
        yield Implausible(key, "Young's modulus", material.youngs_modulus / 1e9, "GPa", (10.0, 500.0))
        yield Implausible(key, "the density", material.density, "kg/m^3", (1000.0, 20000.0))
    yield Implausible("mass.working_pressure", "the peak pressure", study.mass.working_pressure / 1e6, "MPa", (2.0, 80.0))

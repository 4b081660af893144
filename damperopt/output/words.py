"""Sentences and table rows of a report."""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from dataclasses import dataclass

from ..answers.bound import bound_words
from ..quantities.record import LoadRange
from ..quantities.shown import as_written, shown
from ..quantities.shown import scale as scale_of
from ..results import Certificate, DesignResult
from ..stability.critical import CriticalSpeed
from ..study.components import unit_of_name
from ..study.study import Study
from .facts import BEYOND, LeastDamping

__all__ = [
    "Line",
    "answer",
    "asked",
    "assumptions",
    "beyond",
    "bound",
    "certificate",
    "constraint_rows",
    "damping_rows",
    "decided_by",
    "design_rows",
    "input_words",
    "layout_words",
    "number",
    "place",
    "times",
    "verification",
]

DERIVED = {
    "rod_diameter": "diameter of the damper's rod",
    "torsional_stiffness": "stiffness about the strut axis",
    "torsional_damping": "damping about the strut axis",
}
"""What follows from a whole design; what a component chooses, it declares with its meaning."""

OVER_TEMPERATURE = "damping with the oil at this temperature"

KINDS = {"strength": "strength", "geometry": "geometry", "decay": "decay", "stability": "stability margin", "bound": "bounds"}

BALLS = "enclosures of the characteristic function with the tyre's delay over boxes of frequency, speed and load"

NAMES = {"lower_lug_height": "height of the lower torque-link hinge above the axle"}
"""Keys that do not say what they are."""


@dataclass(frozen=True)
class Line:
    """A row of a table."""

    cells: tuple[str, ...]
    strong: bool = False


def asked(study: Study) -> list[str]:
    """What was asked, a sentence each.

    Parameters
    ----------
    study : Study
    """
    required, envelope = study.required, study.envelope
    speeds = _range((envelope.speed.min, envelope.speed.max), "m/s", True)
    loads = _range(envelope.loads, "N", isinstance(envelope.vertical_load, LoadRange))
    found = [
        f"The lightest {study.damper.topology} layout in {study.material.name}, geometry {study.damper.geometry}. "
        f"{study.damper.topology}: {layout_words(study)}",
        f"Every mode decays at least as exp(-{required.stability_margin:g} t) at every speed from {speeds}, at {loads}.",
    ]
    if required.damping_ratio is not None:
        found.append(f"The yaw mode has at least {100 * required.damping_ratio:.3g}\u00a0% of critical damping at all of them.")
    low, high = study.damper.damping_factors()
    if (low, high) != (1.0, 1.0):
        found.append(f"All requirements hold for every damping from {low:.6g} to {high:.6g} times that of the design.")
    if required.decay is not None:
        found.append(
            f"After a disturbance the yaw angle falls to {required.decay.ratio:.3g} within {required.decay.cycles} cycles, "
            "at every speed, by the nonlinear model."
        )
    return found


def assumptions(study: Study, result: DesignResult) -> list[str]:
    """What the numbers of a page take for granted, a sentence each.

    Parameters
    ----------
    study : Study
    result : DesignResult
    """
    tyre, loads, model = study.tyre, study.loads, study.mass
    largest, bulk = (" ".join(shown(*number)) for number in ((max(study.envelope.loads), "N"), (model.bulk_modulus, "Pa")))
    found = [
        "Rigid airframe, constant vertical load, straight rolling at constant speed.",
        f"Tyre: law {tyre.law} on the contact line {tyre.contact.contact}.",
    ]
    found += [
        f"loads.{key} is not given; {largest}, the largest vertical load of the envelope, stands in its place."
        for key in ("landing_vertical", "static_reaction")
        if getattr(loads, key) is None
    ]
    if study.damper.has_sized_parts():
        found.append(
            f"Bulk modulus of the oil {bulk}, {model.damper_fixed_mass:g} kg of the damper that no size changes, and the "
            "proportions of eyes and pins (mass.lug) are typical where the study does not give them."
        )
        found += _held(study)
    found += [f"{words[:1].upper()}{words[1:]}." for words in result.rests_on]
    return [*found, "Mass and strength follow the sizing rules of the study page: estimates for comparison, no stress report."]


def _held(study: Study) -> list[str]:
    """Where the strut holds the beams of hinges."""
    links = getattr(study.damper, "links", None)
    if links is None or not any(member.is_beam for member in study.damper.members(study.start)):
        return []
    if links.strut_width is None:
        return ["Beams of hinges are held on the axis of the strut, on the safe side (damper.links.strut_width)."]
    return [f"Beams of hinges are held at the sides of a strut {number(links.strut_width, 'm')} wide, which does not give way."]


def _range(values: Sequence[float], unit: str, ends: bool) -> str:
    """Numbers in the unit in which they were asked, or the ends of their range."""
    texts, name = as_written(values, unit)
    return f"{(' to ' if ends else ', ').join(texts)} {name}"


def place(speed: float | None, load: float | None) -> str:
    """A speed and a load."""
    found = [f"{speed:.4g} m/s"] if speed is not None else []
    return ", ".join(found + ([] if load is None else [" ".join(shown(load, "N"))]))


def number(value: float, unit: str) -> str:
    """A number with its unit."""
    return " ".join(shown(value, unit)).strip()


def input_words(key: str) -> str:
    """Key path of an input, with what it means where the key does not say it."""
    words = NAMES.get(key.rpartition(".")[2])
    return key if words is None else f"{key} ({words})"


def layout_words(study: Study) -> str:
    """What the layout of a study is, as its kind says it."""
    return (inspect.getdoc(study.damper.LAYOUT) or "").partition("\n")[0]


def times(factor: float) -> str:
    """Where the damping is not that of the design."""
    return "" if factor == 1 else f", {factor:.4g} times the damping"


def answer(result: DesignResult) -> str:
    """The answer in one sentence."""
    if result.mass is None:
        return f"No design: {result.message}"
    return f"{result.mass.total:.3f} kg: {result.topology} layout in {result.material}."


def design_rows(study: Study, result: DesignResult) -> list[Line]:
    """Design and derived numbers: meaning, symbol, value, unit, and the bound where it lies on one.

    Parameters
    ----------
    study : Study
    result : DesignResult
    """
    lines, meanings = [], DERIVED | {variable.name: variable.meaning for variable in study.variables}
    meanings |= {name: OVER_TEMPERATURE for name in result.derived if name.startswith(f"{study.damper.VISCOUS}_at_")}
    for name, value in (result.design | result.derived).items():
        variable = getattr(study.design, name, None)
        bounds = "" if variable is None else _at_bound(value, variable.min, variable.max)
        lines.append(
            Line((meanings.get(name) or name, name, *shown(value, unit_of_name(name, result.units)), bounds), bool(bounds))
        )
    return lines


def _at_bound(value: float, low: float, high: float) -> str:
    if high - low <= 1e-9 * abs(high):
        return "fixed"
    near = 1e-4 * (high - low)
    return "at its lower bound" if value - low < near else "at its upper bound" if high - value < near else ""


def constraint_rows(result: DesignResult) -> list[Line]:
    """Each requirement: name, value, limit, and what its limit costs."""
    lines = []
    for c in result.constraints:
        value, unit = shown(c.value, c.unit)
        limit, _ = shown(c.limit, c.unit)
        price = f"{c.shadow_price / scale_of(c.unit)[1]:+.3g} kg per {unit or 'unit'}" if c.active else ""
        lines.append(Line((c.name.replace("_", " "), value, f"{c.sense} {limit}", unit, price), c.active))
    return lines


def decided_by(result: DesignResult) -> str:
    """Which requirement decides the mass, in a sentence."""
    if not result.decided_by:
        return ""
    parts = [f"{KINDS.get(kind, kind)} {weight:.2g}\u00a0%" for kind, weight in result.decided_by.items()]
    return f"If the limits of one kind were eased by 1\u00a0%, the mass would fall by: {', '.join(parts)}."


def damping_rows(found: Sequence[LeastDamping]) -> list[Line]:
    """Least damping of the modes: mode, per cent of critical, frequency, where."""
    return [Line((m.mode, f"{100 * m.ratio:.3g}", f"{m.frequency:.3g}", place(m.speed, m.load))) for m in found]


def beyond(study: Study, found: CriticalSpeed | None) -> str:
    """What comes after the envelope, in a sentence."""
    high = study.envelope.speed.max
    if found is None:
        return f"No critical speed from there to {_range([BEYOND * high], 'm/s', False)}."
    kind = f"shimmy at {found.frequency:.3g} Hz" if found.kind == "hopf" else "divergence"
    return (
        f"The first critical speed beyond the envelope: {place(found.speed, found.load)} ({kind}), "
        f"{100 * (found.speed / high - 1):.3g} % above it."
    )


def certificate(result: DesignResult) -> str:
    """The proof in words; with an actuator both."""
    if result.certificate is None:
        return "Nothing was proved."
    words = _proof_in_words(result.certificate)
    return words if result.fail_safe is None else f"{words} With the actuator off: {_proof_in_words(result.fail_safe)}"


def _proof_in_words(proof: Certificate) -> str:
    method = {
        "sturm": "the coefficients of the characteristic polynomial are exact polynomials of the speed, and exact root counts "
        "(Sturm) show that none of the stability conditions changes sign",
        "bernstein": "exact Bernstein bounds over rectangles of speed and load",
        "bernstein, damping": "exact Bernstein bounds over rectangles of speed and damping, load by load",
        "balls, damping": "enclosures of the characteristic function with the tyre's delay over boxes of frequency, speed and "
        "damping, load by load",
        "balls, rectangle": BALLS,
        "balls": BALLS,
    }.get(proof.method, proof.method)
    speeds = _range(proof.speed, "m/s", True)
    loads = _range(proof.loads, "N", proof.over_a_range)
    where = f"margin {proof.margin:g} 1/s, every real speed from {speeds}, {loads}"
    if proof.damping is not None:
        where += f", every damping from {proof.damping[0]:.6g} to {proof.damping[1]:.6g} times that of the design"
    reason = f"{proof.reason[:1].upper()}{proof.reason[1:]}."
    if not proof.proved:
        return f"NOT proved: {where}. {reason}"
    arithmetic = (
        "ball arithmetic, rounding enclosed" if proof.method.startswith("balls") else "rational arithmetic, without rounding"
    )
    return f"Proved in {arithmetic}: {where}. How: {method}. {reason}"


def bound(result: DesignResult) -> str:
    """The lower bound on the mass, in words."""
    return "No lower bound on the mass." if result.bound is None else bound_words(result.bound)


def verification(result: DesignResult) -> list[str]:
    """Checks that share no code with the optimiser, a sentence each."""
    found = []
    check, decay = result.verification, result.decay
    if check is not None:
        found.append(
            f"Eigenvalues on {check.grid_speeds} speeds by {check.grid_loads} loads: worst {check.worst.abscissa:.6g} 1/s at "
            f"{place(check.worst.speed, check.worst.load)}{times(check.worst.damping)}."
        )
        found.append(f"{check.agreeing_starts} of {len(result.starts)} starts end here; KKT residual {check.kkt_residual:.1g}.")
    if decay is not None:
        kept = "kept" if decay.passed else "NOT kept"
        found.append(
            f"Decay {kept}: {decay.ratio:.4f} of the first amplitude after {decay.cycles} cycles at {decay.speed:.4g} m/s"
            f"{times(decay.damping)}, the worst of {decay.simulations} event-exact simulations; required {decay.limit:.4f}."
        )
    return found

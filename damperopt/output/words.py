"""Sentences and table rows of a report."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..quantities.record import LoadRange
from ..results import UNITS, DesignResult
from ..study.study import Study

__all__ = ["Line", "answer", "asked", "certificate", "constraint_rows", "decided_by", "design_rows", "verification"]

MEANINGS = {
    "c_lambda": "damping coefficient of the damper",
    "k_lambda": "stiffness of the damper's spring",
    "I_arm": "second moment of area of the bending arm",
    "L": "length of the torque links",
    "gamma": "angle of the links from the strut axis",
    "b": "side distance of arm or damper",
    "rod_diameter": "diameter of the damper's rod",
    "torsional_stiffness": "stiffness about the strut axis",
    "torsional_damping": "damping about the strut axis",
}
LAYOUTS = {"boeing": "Boeing (damper and spring at the apex)", "utas": "UTAS (bending arm and damper)", "arreaza": "new design"}
KINDS = {"strength": "strength", "geometry": "geometry", "decay": "decay", "stability": "stability margin", "bound": "bounds"}
SHOWN = {"m": ("mm", 1e3), "m^4": ("mm⁴", 1e12), "rad": ("deg", 57.29577951308232), "Pa": ("MPa", 1e-6), "N/m": ("kN/m", 1e-3)}


@dataclass(frozen=True)
class Line:
    """A row of a table."""

    cells: tuple[str, ...]
    strong: bool = False


def _number(value: float, unit: str) -> tuple[str, str]:
    """Value and unit as engineers write them."""
    shown, factor = SHOWN.get(unit, (unit, 1.0))
    return f"{value * factor:,.5g}".replace(",", " ") if abs(value * factor) < 1e5 else f"{value * factor:.4g}", shown


def asked(study: Study) -> list[str]:
    """What was asked, a sentence each.

    Parameters
    ----------
    study : Study
    """
    required, speed = study.required, study.envelope.speed
    loads = _loads(study.envelope.loads, isinstance(study.envelope.vertical_load, LoadRange))
    found = [
        f"The lightest {LAYOUTS[study.damper.topology]} in {study.material.name}, geometry {study.damper.geometry}, "
        f"order {study.gear.order}.",
        f"Every mode decays at least as exp(-{required.stability_margin:g} t) at every speed from {speed.min:g} to "
        f"{speed.max:g} m/s, at {loads} kN.",
    ]
    if required.decay is not None:
        found.append(
            f"After a disturbance the yaw angle falls to {required.decay.ratio:.3g} within {required.decay.cycles} cycles, "
            "at every speed, by the nonlinear model."
        )
    return found


def _loads(loads: Sequence[float], ends: bool) -> str:
    """Loads in kN, or the ends of their range."""
    return (" to " if ends else ", ").join(f"{load / 1e3:g}" for load in loads)


def answer(result: DesignResult) -> str:
    """The answer in one sentence."""
    if result.mass is None:
        return f"No design: {result.message}"
    return f"{result.mass.total:.3f} kg: {LAYOUTS[result.topology]} in {result.material}."


def design_rows(study: Study, result: DesignResult) -> list[Line]:
    """Design and derived numbers: meaning, symbol, value, unit, and the bound where it lies on one.

    Parameters
    ----------
    study : Study
    result : DesignResult
    """
    lines = []
    for name, value in (result.design | result.derived).items():
        variable = getattr(study.design, name, None)
        bounds = "" if variable is None else _at_bound(value, variable.min, variable.max)
        lines.append(Line((MEANINGS.get(name, name), name, *_number(value, UNITS[name]), bounds), name in result.design))
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
        value, unit = _number(c.value, c.unit)
        limit, _ = _number(c.limit, c.unit)
        factor = SHOWN.get(c.unit, ("", 1.0))[1]
        price = f"{c.shadow_price / factor:+.3g} kg per {unit if unit != '1' else 'unit'}" if c.active else ""
        lines.append(
            Line((c.name.replace("_", " "), value, f"{c.sense} {limit}", unit if unit != "1" else "", price), c.active)
        )
    return lines


def decided_by(result: DesignResult) -> str:
    """Which requirement decides the mass, in a sentence."""
    if not result.decided_by:
        return ""
    parts = [f"{KINDS.get(kind, kind)} {weight:.2g} %" for kind, weight in result.decided_by.items()]
    return f"If the limits of one kind were eased by 1 %, the mass would fall by: {', '.join(parts)}."


def certificate(result: DesignResult) -> str:
    """The proof in words."""
    proof = result.certificate
    if proof is None:
        return "Nothing was proved."
    method = {
        "sturm": "the coefficients of the characteristic polynomial are exact polynomials of the speed, and exact root counts "
        "(Sturm) show that none of the stability conditions changes sign",
        "bernstein": "exact Bernstein bounds over rectangles of speed and load",
    }[proof.method]
    loads = _loads(proof.loads, proof.method == "bernstein")
    where = f"margin {proof.margin:g} 1/s, every real speed from {proof.speed[0]:g} to {proof.speed[1]:g} m/s, {loads} kN"
    reason = f"{proof.reason[:1].upper()}{proof.reason[1:]}."
    if not proof.proved:
        return f"NOT proved: {where}. {reason}"
    return f"Proved in rational arithmetic, without rounding: {where}. How: {method}. {reason}"


def verification(result: DesignResult) -> list[str]:
    """Checks that share no code with the optimiser, a sentence each."""
    found = []
    check, decay = result.verification, result.decay
    if check is not None:
        found.append(
            f"Eigenvalues on {check.grid_speeds} speeds by {check.grid_loads} loads: worst {check.worst.abscissa:.6g} 1/s at "
            f"{check.worst.speed:.4g} m/s, {check.worst.load / 1e3:g} kN."
        )
        found.append(f"{check.agreeing_starts} of {len(result.starts)} starts end here; KKT residual {check.kkt_residual:.1g}.")
    if decay is not None:
        kept = "kept" if decay.passed else "NOT kept"
        found.append(
            f"Decay {kept}: {decay.ratio:.4f} of the first amplitude after {decay.cycles} cycles at {decay.speed:.4g} m/s, "
            f"the worst of {decay.simulations} event-exact simulations; required {decay.limit:.4f}."
        )
    return found

"""What a result says of itself: what its proof covers, what its numbers rest on, what nobody would believe of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..results import DesignResult
from ..stability.gear import LinearGear
from ..stability.wavelength import contact_line_words, shortest_wavelength
from ..stability.yaw_mode import yaw_modes
from ..strength.fatigue import Basquin, words_of
from ..strength.materials import words_about
from ..study.cavitation import cavitation
from ..study.plausibility import Answer, implausible, implausible_answer, implausible_masses
from ..study.scope import covers, leaves_out
from ..study.study import Study
from .left_out import left_out_by_number

__all__ = ["rests_on", "said_of", "yaw_frequencies"]

SPEEDS, LOADS = 60, 5
"""At which the yaw mode is looked at; of a list of loads each one."""


def said_of(study: Study, result: DesignResult, gear: LinearGear) -> dict[str, Any]:
    """Fields of a result that say in words what its numbers are.

    Parameters
    ----------
    study : Study
    result : DesignResult
        With design, masses, constraints and certificate.
    gear : LinearGear
        With this design.

    Returns
    -------
    dict
        By the names of the fields.
    """
    proof = result.certificate
    answer = Answer.of(result, yaw_frequencies(study, gear))
    flags = (*implausible_answer(study, answer), *implausible_masses(answer.parts), *implausible(study, result.design))
    shown = result.decay.peaks.get("damper_force", 0.0) if result.decay is not None else 0.0
    boils = cavitation(study, result.design, max(shown, result.limit_event.get("damper_force", 0.0)))
    return {
        "verdict": "undecided" if proof is None else proof.found,
        "witness": {} if proof is None or proof.counterexample is None else _witness(study, gear, *proof.counterexample),
        "covers": tuple(covers(study)),
        "leaves_out": (*_contact_line(study, gear), *left_out_by_number(study, result.design), *leaves_out(study)),
        "rests_on": rests_on(study, result.design),
        "implausible": (*map(str, flags), *filter(None, [boils])),
    }


def _contact_line(study: Study, gear: LinearGear) -> tuple[str, ...]:
    """What a contact line that is not the exact one means at the shortest wave of the envelope."""
    return contact_line_words(study, shortest_wavelength(study, gear)) if study.tyre.contact.least_wave() else ()


def _witness(study: Study, gear: LinearGear, speed: float, load: float) -> dict[str, float]:
    """Point of the envelope, and the frequency at which the gear moves there [rad/s]."""
    stroke = {} if study.gear.strut is None else {"stroke": float(study.gear.stroke(load))}
    return {"speed": speed, "load": load, **stroke, "frequency": abs(float(gear.roots([speed], [load], 1)[0, 0].imag))}


def yaw_frequencies(study: Study, gear: LinearGear) -> list[float]:
    """Frequencies of the yaw mode over the envelope [Hz]; where the yaw does not oscillate there is none."""
    envelope = study.envelope
    speeds = np.geomspace(envelope.speed.min, envelope.speed.max, SPEEDS)
    roots = np.concatenate([yaw_modes(gear, speeds, np.full(SPEEDS, load)) for load in envelope.samples(LOADS)])
    return [float(s.imag) / (2 * np.pi) for s in roots if np.isfinite(s.imag)]


def rests_on(study: Study, design: Mapping[str, float]) -> tuple[str, ...]:
    """What kind of numbers strength and life of a design rest on: bases of the materials, factors, spectrum.

    Parameters
    ----------
    study : Study
    design : mapping of str to float
        Design variables by name [SI].
    """
    required = study.required
    found = [words.removesuffix(".") for words in words_about((study.material, study.mass.damper_material))]
    factors = required.limit_factor, required.ultimate_factor
    found.append(f"factors: {factors[0]:g} on yield at limit load, {factors[1]:g} from limit to ultimate load")
    if study.damper.has_sized_parts() and Basquin.of(study.material) is not None:
        found.append(words_of(required.fatigue.spectrum))
    return tuple(found)

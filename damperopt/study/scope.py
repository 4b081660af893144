"""What an answer about stability covers, and what it leaves out: one set of words for every path."""

from __future__ import annotations

from typing import Any

from ..quantities.temperature import ZERO_CELSIUS
from .study import Study

__all__ = ["covers", "leaves_out", "place_words"]


def covers(study: Study) -> list[str]:
    """What a certificate is a proof of, and what of the study it leaves out.

    Parameters
    ----------
    study : Study

    Returns
    -------
    list of str
        Sentences.
    """
    damper = study.damper
    linkage = "" if damper.ROTARY else f", {_chain(damper)}"
    found = [
        "The certificate covers the linear gear about straight rolling: small motions, joints in contact (no freeplay, no end "
        f"stop reached), no friction{linkage}, the tyre on its contact line {study.tyre.contact.contact}{_delay(study)}."
    ]
    found += _uncertain(study) + _stroke(study)
    found += _controlled(damper)
    if words := study.tyre.origin():
        found.append(words)
    left = [("freeplay", damper.play), ("end stop", damper.stop), ("friction", study.gear.friction)]
    if names := [name for name, value in left if value is not None]:
        found.append(
            f"The study has {' and '.join(names)}, which the certificate does not cover: a limit cycle can remain; "
            "damperopt simulate shows it."
        )
    if study.requirements is not None and study.requirements.limit_event == "simulated":
        found.append(
            "The parts are sized by the simulated motions alone: no load of ground handling remains (limit_event simulated)."
        )
    return found


def _controlled(damper: Any) -> list[str]:
    """What of a control is covered."""
    if damper.control is None:
        return []
    if damper.actuator is None:
        return [
            "The law of damper.control commands a current, which the certificate does not hold: it is of the damper without."
        ]
    lag = "" if damper.control.lag is None else f" and the lag of {1e3 * damper.control.lag:g} ms"
    return [
        f"It holds the actuator with its gains at every speed{lag}, as long as it does not saturate; a second certificate is "
        "of the gear with the actuator off."
    ]


def _stroke(study: Study) -> list[str]:
    """At which strokes of the shock strut it holds, where the study has one."""
    if study.gear.strut is None:
        return []
    light, heavy = min(study.envelope.loads), max(study.envelope.loads)
    ends = [f"{1e3 * study.gear.stroke(load):.4g} mm at {load / 1e3:.4g} kN" for load in dict.fromkeys((light, heavy))]
    words = f"At each load the shock strut stands in balance ({' to '.join(ends)}), and links, height and stiffness follow it"
    return [f"{words}; its motion is no part of the gear (quasi-static). Parts are sized with it fully out."]


def place_words(study: Study, point: tuple[float, float]) -> str:
    """A speed [m/s] and a load [N], with the stroke of a shock strut in balance."""
    stroke = "" if study.gear.strut is None else f", stroke {1e3 * float(study.gear.stroke(point[1])):.4g} mm"
    return f"{point[0]:.6g} m/s, {point[1] / 1e3:.6g} kN{stroke}"


def _uncertain(study: Study) -> list[str]:
    """What of the damping is covered, where it is uncertain."""
    damper = study.damper
    low, high = damper.damping_factors()
    if (low, high) == (1.0, 1.0):
        return []
    words = f"It covers every damping from {low:.6g} to {high:.6g} times that of the design"
    if damper.damping_range is None:
        span = damper.oil.span
        words += (
            f", which oil from {span.min - ZERO_CELSIUS:.4g} to {span.max - ZERO_CELSIUS:.4g} degC makes of it (Walther; "
            "laminar fraction and oil typical unless given); the compliance of the oil is that of the study throughout"
        )
    return [
        f"{words}. Decay is simulated at both ends and the middle of the interval, the damping ratio sampled; the damper is as "
        "strong as the largest damping asks."
    ]


def _chain(damper: Any) -> str:
    """What of the chain gives way, and what is taken as rigid."""
    given, parts = damper.given_compliance(), damper.elastic_parts()
    words = {"link": "torque links", "arm": "bending arm along itself", "support": "support", "damper": "oil column and rod"}
    sized = [words[part] for part in parts if damper.is_sized(part)]
    rigid = [
        words[part] for part in words if part not in given and not damper.is_sized(part) and part in ("link", "damper", *parts)
    ]
    found = [f"elastic by their sections: {', '.join(sized)}"] if sized else []
    found += [f"as stiff as the study says: {', '.join(words.get(p, p) for p in given)}"] if given else []
    return "; ".join(found + ([f"rigid: {', '.join(rigid)}"] if rigid else []))


def _delay(study: Study) -> str:
    return "" if study.tyre.contact.RATIONAL else ", with its exact delay"


def leaves_out(study: Study) -> tuple[str, ...]:
    """What eigenvalues and certificate of a study do not speak of, as its components say it.

    Parameters
    ----------
    study : Study

    Returns
    -------
    tuple of str
        A phrase for each; it says where the study has a number for it that only `simulate` uses.
    """
    parts = (study.damper, study.tyre, study.tyre.contact, study.gear)
    return tuple(words for part in parts for words in part.leaves_out())

"""What an answer about stability covers, and what it leaves out: one set of words for every path."""

from __future__ import annotations

from .study import Study

__all__ = ["covers", "leaves_out"]


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
    damper, start = study.damper, study.start
    links = "rigid torque links" if damper.links(start) is None else "torque links as stiff as the study says"
    series = "a damper without compliance" if damper.series(start) is None else "the damper's compliance in series"
    linkage = "" if damper.ROTARY else f", {links}, {series}"
    found = [
        "The certificate covers the linear gear about straight rolling: small motions, joints in contact (no freeplay, no end "
        f"stop reached), no friction{linkage}, the tyre on its contact line {study.tyre.contact.contact}{_delay(study)}."
    ]
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
    return (*study.damper.leaves_out(), *study.tyre.contact.leaves_out(), *study.gear.leaves_out())

"""What an answer about stability covers, and what it leaves out: one set of words for every path."""

from __future__ import annotations

from .study import Study

__all__ = ["covers", "leaves_out"]


def covers(study: Study) -> tuple[str, ...]:
    """What eigenvalues and certificate of a study speak of.

    Parameters
    ----------
    study : Study

    Returns
    -------
    tuple of str
        Phrases for one sentence.
    """
    elastic = []
    if study.damper.link_stiffness is not None:
        elastic.append("torque links elastic")
    if study.damper.series_stiffness is not None:
        elastic.append("damper elastic in series")
    return ("small motions", "every joint in contact", "no dry friction", *elastic)


def leaves_out(study: Study) -> tuple[str, ...]:
    """What eigenvalues and certificate of a study do not speak of.

    Parameters
    ----------
    study : Study

    Returns
    -------
    tuple of str
        A phrase for each; it says where the study has a number for it that only `simulate` uses.
    """
    damper, links = study.damper, study.damper.topology != "rotational"
    notes = []
    if links and damper.link_stiffness is None:
        notes.append("flexibility of the torque links (damper.link_stiffness)")
    if links and damper.series_stiffness is None:
        notes.append("damper compliance in series (damper.series_stiffness)")
    if damper.freeplay is not None:
        notes.append(f"the freeplay of {1e3 * damper.freeplay.gap:g} mm, taken as closed: simulate shows its limit cycle")
    else:
        notes.append("freeplay (damper.freeplay)")
    if damper.end_stop is not None:
        notes.append(f"the end stop at {1e3 * damper.end_stop.stroke:g} mm, which small motions do not meet")
    else:
        notes.append("end stops (damper.end_stop)")
    if study.gear.friction is not None:
        notes.append("the dry friction of the strut: simulate has it")
    else:
        notes.append("dry friction (gear.friction)")
    notes.append("contact memory of the tyre at short wavelengths")
    notes.append("motion of the shock strut: its stroke is frozen")
    return tuple(notes)

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
    if study.damper.links(study.start) is not None:
        elastic.append("torque links elastic")
    if study.damper.series(study.start) is not None:
        elastic.append("damper elastic in series")
    return ("small motions", "every joint in contact", "no dry friction", *elastic)


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

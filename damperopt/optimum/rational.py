"""The rational model in the place of a tyre with a delay, and how the search makes up for the difference.

A program holds conditions on polynomials, and a delay has none. In its place stands the contact line that the tyre's own names
for a search (a Pade approximation of a low order). At each point that a program holds, what the exact abscissa of the last
design has beyond that of the rational model is added to the margin asked for, so that at a design that stays where it is the
exact margin is met. Its multipliers use the rational model's slopes.
"""

from __future__ import annotations

from ..study.study import Study

__all__ = ["STILL_CORRECTION", "searched_study"]

STILL_CORRECTION = 1e-7
"""Change of the objective, relative, from round to round below which corrections no longer move a design."""


def searched_study(study: Study) -> Study:
    """The study that a program is made of: itself, or with a rational contact line in the place of one with a delay.

    Parameters
    ----------
    study : Study

    Returns
    -------
    Study
    """
    line = study.tyre.contact.realisation("search")
    return study if line is study.tyre.contact else study.replace(tyre__contact=line.model_dump())

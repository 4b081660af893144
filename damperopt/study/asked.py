"""Bounds and starts of the sizes that a study leaves out: around what strength asks at the starts of the others."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from ..strength.limit_event import limit_event
from ..strength.sizes import member_sizes
from .variables import Variable

__all__ = ["asked_sizes", "variables_left_out"]

START, LEAST, MOST = 1.5, 0.1, 100.0
"""Of a size over what strength asks of it: where the search begins, and between what it is free."""

PASSES = 3
"""Until sizes that hang on each other, as a rod on its stroke, are known."""


def asked_sizes(study: Any, design: dict[str, float]) -> dict[str, float]:
    """Size of each elastic part that strength asks for.

    Parameters
    ----------
    study : Study
    design : dict
        Design variables by name, sizes left out [SI].

    Returns
    -------
    dict
        By name [SI]. The damper is taken to carry as much as the limit torque at its lever, whatever its damping.
    """
    damper, load = study.damper, max(study.envelope.loads)
    names = [variable.name for variable in damper.variables() if variable.name not in design]
    link = damper.linkage(design, study.material.youngs_modulus)
    sizes = dict.fromkeys(names, 1.0)
    for _ in range(PASSES if names else 0):
        full = {**design, **sizes}
        event = limit_event(study, link, full, load)
        event = replace(event, damper_force=event.torque / link.damper_lever, design=full)
        own = damper.parts(event, study.mass)
        known = (*member_sizes(study, full, event), *(own.sizes if own else ()))
        asked = {size.name: max(float(least) for least, _ in size.least.values()) for size in known}
        sizes = {name: asked.get(name, 1.0) for name in names}
    return sizes


def variables_left_out(study: Any, starts: dict[str, float]) -> dict[str, Variable]:
    """Variables that a study does not bound itself.

    Parameters
    ----------
    study : Study
    starts : dict
        Of the variables that it does bound [SI].
    """
    return {
        name: Variable(start=START * size, min=LEAST * size, max=MOST * size)
        for name, size in asked_sizes(study, starts).items()
        if name not in starts
    }

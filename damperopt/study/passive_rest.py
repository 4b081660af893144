"""The study without its actuator, of which a proof of its own speaks."""

from __future__ import annotations

from .study import Study

__all__ = ["passive_rest"]


def passive_rest(study: Study) -> Study | None:
    """The study without its actuator, with the margin that it must keep then; None where it has none.

    Parameters
    ----------
    study : Study

    Returns
    -------
    Study or None
    """
    if study.damper.actuator is None:
        return None
    bare = study.without_control()
    if study.requirements is None:
        return bare
    changes = {"stability_margin": study.fail_safe_margin, "fail_safe_margin": None, "decay": None, "damping_ratio": None}
    return bare.replace(requirements=bare.required.model_copy(update=changes | {"limit_event": "torque"}).model_dump())

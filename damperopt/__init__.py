"""Lightest shimmy damper for a landing gear, proved stable at every speed of its envelope.

>>> import damperopt
>>> study = damperopt.load("configs/minimal.yaml")
>>> result = damperopt.optimise(study)
>>> result.status
'solved'
"""

from __future__ import annotations

import warnings
from importlib import import_module
from typing import Any

_HOME = {
    "Certificate": "results",
    "CertificateError": "errors",
    "ConfigError": "errors",
    "DamperoptError": "errors",
    "DesignResult": "results",
    "Disturbance": "study.disturbances",
    "History": "study.history",
    "OutputError": "errors",
    "Study": "study.study",
    "certify": "proof.certify",
    "chart": "charts.chart",
    "check_decay": "proof.check",
    "check_grid": "proof.check",
    "combinations": "design",
    "components": "study.components",
    "critical_speeds": "stability.critical",
    "filled_map": "charts.maps",
    "frozen_along": "motion.history",
    "gain_schedule": "stability.gain_schedule",
    "joint_boundary": "charts.explicit",
    "json_schema": "study.config",
    "least_breakout": "motion.breakout",
    "linear_gear": "stability.linear",
    "load": "study.config",
    "load_result": "results",
    "loads": "study.config",
    "motion_of": "motion.trajectory",
    "optimise": "design",
    "optimise_each": "design",
    "rank": "design",
    "read_history": "study.history",
    "simulate": "motion.simulate",
    "simulate_along": "motion.history",
    "simulate_exactly": "motion.exact",
    "spectral_abscissa": "stability.linear",
    "track_modes": "stability.modes",
    "worst_points": "stability.worst",
}
"""Module of each public name; it is imported when the name is used."""

_MOVED = {
    "Axis": "charts.plane",
    "DecayAnalysis": "motion.decay",
    "DesignProblem": "optimum.problem",
    "ExactSimulator": "motion.exact",
    "FilledMap": "charts.maps",
    "GridCheck": "proof.check",
    "LinearGear": "stability.linear",
    "ModeTable": "stability.modes",
    "Motion": "motion.trajectory",
    "Plane": "charts.plane",
    "Simulator": "motion.simulate",
    "StabilityChart": "charts.chart",
    "StabilityMap": "charts.maps",
    "Trajectory": "motion.trajectory",
}
"""Names that were public in 0.1 and are now reached by their room."""

_ROOMS = ("figures", "sweep")
"""Rooms with a public list of their own."""

__all__ = sorted(_HOME)  # one list, not two


def __getattr__(name: str) -> Any:
    """Public names are imported when they are used; a name of version 0.1 says where it has moved to."""
    if name == "__version__":
        from importlib.metadata import version

        return version("damperopt")
    if name in _ROOMS:
        return import_module(f".{name}", __name__)
    if name in _HOME:
        return getattr(import_module(f".{_HOME[name]}", __name__), name)
    if name in _MOVED:
        message = f"damperopt.{name} is now damperopt.{_MOVED[name]}.{name}; the old name goes with the next version"
        warnings.warn(message, DeprecationWarning, stacklevel=2)
        return getattr(import_module(f".{_MOVED[name]}", __name__), name)
    if name == "plots":
        message = "damperopt.plots is now damperopt.figures; the old name goes with the next version"
        warnings.warn(message, DeprecationWarning, stacklevel=2)
        return import_module(".figures", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*__all__, "__version__", *_ROOMS]

"""Lightest shimmy damper for a landing gear, proved stable at every speed of its envelope.

>>> import damperopt
>>> study = damperopt.load("configs/minimal.yaml")
>>> result = damperopt.optimise(study)
>>> result.status
'solved'
"""

from importlib import import_module

from .certify import certify
from .chart import StabilityChart, chart
from .config import json_schema, load, loads
from .critical import critical_speeds
from .decay import DecayAnalysis
from .design import combinations, optimise, optimise_each, rank
from .disturbances import Disturbance
from .errors import CertificateError, ConfigError, DamperoptError, OutputError
from .events import ExactSimulator, simulate_exactly
from .joint import joint_boundary
from .maps import FilledMap, StabilityMap, filled_map
from .modes import ModeTable, track_modes
from .plane import Axis, Plane
from .problem import DesignProblem
from .results import Certificate, DesignResult, load_result
from .simulate import Simulator, simulate
from .specs import Study
from .stability import LinearGear, linear_gear, spectral_abscissa
from .trajectory import Motion, Trajectory, motion_of
from .verify import GridCheck, check_decay, check_grid
from .worst import worst_points


def __getattr__(name: str) -> object:
    """`damperopt.plots` is imported when it is used: matplotlib takes its time."""
    if name == "plots":
        return import_module(".plots", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


__all__ = [
    "Axis",
    "Certificate",
    "CertificateError",
    "ConfigError",
    "DamperoptError",
    "DecayAnalysis",
    "DesignProblem",
    "DesignResult",
    "Disturbance",
    "ExactSimulator",
    "FilledMap",
    "GridCheck",
    "LinearGear",
    "ModeTable",
    "Motion",
    "OutputError",
    "Plane",
    "Simulator",
    "StabilityChart",
    "StabilityMap",
    "Study",
    "Trajectory",
    "certify",
    "chart",
    "check_decay",
    "check_grid",
    "combinations",
    "critical_speeds",
    "filled_map",
    "joint_boundary",
    "json_schema",
    "linear_gear",
    "load",
    "load_result",
    "loads",
    "motion_of",
    "optimise",
    "optimise_each",
    "rank",
    "simulate",
    "simulate_exactly",
    "spectral_abscissa",
    "track_modes",
    "worst_points",
]

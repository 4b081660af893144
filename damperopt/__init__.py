"""Lightest shimmy damper for a landing gear, proved stable at every speed of its envelope.

>>> import damperopt
>>> study = damperopt.load("configs/minimal.yaml")
>>> result = damperopt.optimise(study)
>>> result.status
'solved'
"""

from .certify import certify
from .config import json_schema, load, loads
from .critical import critical_speeds
from .design import combinations, optimise, optimise_each, rank
from .errors import CertificateError, ConfigError, DamperoptError, OutputError
from .modes import ModeTable, track_modes
from .problem import DesignProblem
from .results import Certificate, DesignResult, load_result
from .specs import Study
from .stability import LinearGear, linear_gear, spectral_abscissa
from .verify import GridCheck, check_grid
from .worst import worst_points

__all__ = [
    "Certificate",
    "CertificateError",
    "ConfigError",
    "DamperoptError",
    "DesignProblem",
    "DesignResult",
    "GridCheck",
    "LinearGear",
    "ModeTable",
    "OutputError",
    "Study",
    "certify",
    "check_grid",
    "combinations",
    "critical_speeds",
    "json_schema",
    "linear_gear",
    "load",
    "load_result",
    "loads",
    "optimise",
    "optimise_each",
    "rank",
    "spectral_abscissa",
    "track_modes",
    "worst_points",
]

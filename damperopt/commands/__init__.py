"""Commands of the command line, a file each."""

from .analyse import analyse
from .breakout import breakout
from .chart import chart
from .components import components
from .cycles import cycles
from .export import export
from .frequency import frequency
from .gains import gains
from .optimise import optimise
from .report import report
from .simulate import simulate
from .studies import init, schema, validate
from .sweep import sweep
from .thesis import thesis
from .tyre import tyre
from .verify import verify

__all__ = [
    "analyse",
    "breakout",
    "chart",
    "components",
    "cycles",
    "export",
    "frequency",
    "gains",
    "init",
    "optimise",
    "report",
    "schema",
    "simulate",
    "sweep",
    "thesis",
    "tyre",
    "validate",
    "verify",
]

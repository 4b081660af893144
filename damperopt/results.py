"""Records of an answer: plain data that can be written to JSON and read back."""

from __future__ import annotations

import json
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, ValidationError

from .errors import ConfigError

__all__ = [
    "SCHEMA_VERSION",
    "UNITS",
    "Certificate",
    "ConstraintResult",
    "DecayCheck",
    "DesignResult",
    "Infeasibility",
    "LocalOptimum",
    "MassResult",
    "OperatingPoint",
    "Provenance",
    "Relaxation",
    "Sensitivity",
    "StartResult",
    "Verification",
    "load_result",
]

SCHEMA_VERSION = 1

UNITS = {
    "c_lambda": "N s/m",
    "k_lambda": "N/m",
    "I_arm": "m^4",
    "L": "m",
    "gamma": "rad",
    "b": "m",
    "rod_diameter": "m",
    "torsional_stiffness": "N m/rad",
    "torsional_damping": "N m s/rad",
}
"""SI unit of each number of `DesignResult.design` and `DesignResult.derived`."""


@dataclass(frozen=True)
class OperatingPoint:
    """A speed [m/s] and a vertical load [N], with the spectral abscissa there [1/s]."""

    speed: float
    load: float
    abscissa: float


@dataclass(frozen=True)
class Certificate:
    """Outcome of `certify`.

    Attributes
    ----------
    proved : bool
        True: every speed and load of the envelope has a spectral abscissa below -margin.
    margin : float
        The margin that was tested [1/s].
    speed : tuple of float
        Speed range [m/s].
    loads : tuple of float
        The loads, or the ends of the range [N].
    method : str
        ``sturm`` or ``bernstein``.
    counterexample : tuple of float or None
        (speed [m/s], load [N]) where the margin is missed or not strictly met, if not proved; None also where a load range
        could not be decided.
    reason : str
        One sentence.
    boxes : int
        Rectangles examined (``bernstein``).
    """

    proved: bool
    margin: float
    speed: tuple[float, float]
    loads: tuple[float, ...]
    method: str
    counterexample: tuple[float, float] | None
    reason: str
    boxes: int = 0


@dataclass(frozen=True)
class DecayCheck:
    """Decay of a design over the envelope.

    Attributes
    ----------
    passed : bool
        The ratio is not exceeded anywhere that was looked at.
    limit : float
        Required ratio.
    cycles : int
        Cycles that are counted.
    speed, load, ratio : float
        Where it is largest [m/s], [N], by the exact simulation, and how large.
    optimised : float
        Largest ratio by the smooth simulation that the optimiser used.
    simulations : int
        Exact simulations that were made.
    peaks : dict of str to float
        Largest magnitudes that they show [SI].
    engine : str
        Integrator of the optimiser, and whether a missing C compiler decided that.
    """

    passed: bool
    limit: float
    cycles: int
    speed: float
    load: float
    ratio: float
    optimised: float
    simulations: int
    peaks: dict[str, float]
    engine: str = ""


class _Record(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class MassResult(_Record):
    """Mass [kg]: total and by part, fittings included."""

    total: float
    parts: dict[str, float]


class ConstraintResult(_Record):
    """One constraint at the optimum.

    `multiplier` is the solver's, >= 0, per unit of the scaled row; `shadow_price` is d mass/d limit [kg per `unit`].
    """

    name: str
    kind: Literal["stability", "decay", "strength", "geometry", "bound"] = "geometry"
    value: float
    limit: float
    sense: Literal["<=", ">="]
    unit: str
    active: bool
    multiplier: float
    shadow_price: float
    relaxed_by: tuple[str, ...] = ()


class Verification(_Record):
    """Checks that do not share the optimiser's code.

    `worst` is the largest spectral abscissa on the grid of `grid_speeds` by `grid_loads` points; `kkt_residual` was
    recomputed from derivatives; `agreeing_starts` starts ended within 0.01 % of the best mass.
    """

    passed: bool
    grid_passed: bool
    grid_speeds: int
    grid_loads: int
    worst: OperatingPoint
    kkt_residual: float
    agreeing_starts: int


class StartResult(_Record):
    """What became of one start: solved or not, mass [kg], rounds of the exchange, program that succeeded."""

    index: int
    solved: bool
    status: str
    mass: float | None
    rounds: int
    form: str
    design: dict[str, float]


class LocalOptimum(_Record):
    """A local optimum and how many starts ended there."""

    mass: float
    starts: int
    design: dict[str, float]


class Sensitivity(_Record):
    """d mass/d input [kg per `unit`], and the change of mass in per cent for one per cent of the input."""

    input: str
    value: float
    unit: str
    derivative: float
    elasticity: float


class Relaxation(_Record):
    """A constraint that gives way: its limit, the limit that would do, and the inputs that move it."""

    name: str
    limit: float
    needed: float
    unit: str
    inputs: tuple[str, ...]
    speed: float | None = None
    load: float | None = None


class Infeasibility(_Record):
    """Why there is no design: the smallest set of shortfalls, and each relaxation that alone would be enough."""

    shortfalls: tuple[Relaxation, ...]
    alone_enough: tuple[Relaxation, ...]


class Provenance(_Record):
    """Where a result comes from. Times in seconds."""

    damperopt: str
    python: str
    packages: dict[str, str]
    config_file: str | None
    config_sha256: str
    git_commit: str | None
    seed: int
    started: str
    wall_time: float


class DesignResult(_Record):
    """Answer to one study.

    `status`: ``solved`` (and verified), ``infeasible`` (no design meets the requirements) or ``failed`` (the solver or the
    verification did not succeed); `message` says it in words. Design variables and derived numbers are in SI, see `UNITS`.
    `limit_event` holds the peaks that size the parts [SI]. `decided_by` says what the mass hangs on: per cent of mass for one
    per cent of the limits of each kind of constraint.
    """

    schema_version: Literal[1] = 1
    status: Literal["solved", "infeasible", "failed"]
    message: str
    study: str
    topology: str
    geometry: str
    material: str
    stability_margin: float
    design: dict[str, float] = {}
    derived: dict[str, float] = {}
    limit_event: dict[str, float] = {}
    mass: MassResult | None = None
    stability: OperatingPoint | None = None
    constraints: tuple[ConstraintResult, ...] = ()
    not_checked: tuple[str, ...] = ()
    certificate: Certificate | None = None
    verification: Verification | None = None
    decay: DecayCheck | None = None
    decided_by: dict[str, float] = {}
    infeasibility: Infeasibility | None = None
    sensitivities: tuple[Sensitivity, ...] = ()
    starts: tuple[StartResult, ...] = ()
    local_optima: tuple[LocalOptimum, ...] = ()
    provenance: Provenance | None = None
    config: dict[str, Any] = {}

    @property
    def exit_code(self) -> int:
        """0 solved and verified, 3 infeasible, 4 solver or verification failure."""
        return {"solved": 0, "infeasible": 3, "failed": 4}[self.status]

    def __str__(self) -> str:
        """Verdict, mass and design in one line; `to_json` has the rest."""
        layout = f"{self.study}: {self.status}, {self.topology} ({self.geometry}), {self.material}"
        if self.mass is None:
            return f"{layout}: {self.message}"
        design = ", ".join(f"{name} {value:.5g} {UNITS[name]}" for name, value in self.design.items())
        return f"{layout}: {self.mass.total:.3f} kg; {design}"

    def _repr_html_(self) -> str:
        """The answer as notebooks show it."""
        mass = "" if self.mass is None else f": <b>{self.mass.total:.3f} kg</b>"
        title = f"{escape(self.status)}{mass}, {escape(self.topology)} ({escape(self.geometry)}), {escape(self.material)}"
        rows = [(name, f"{value:.5g}", UNITS[name]) for name, value in (self.design | self.derived).items()]
        rows += [(f"mass of {part}", f"{value:.3f}", "kg") for part, value in (self.mass.parts if self.mass else {}).items()]
        cells = "".join(f"<tr><th>{escape(name)}</th><td>{value}</td><td>{unit}</td></tr>" for name, value, unit in rows)
        return f"<p>{title}</p><p>{escape(self.message)}</p><table>{cells}</table>"

    def to_json(self) -> str:
        """JSON text; floats keep every digit."""
        return json.dumps(self.model_dump(mode="json"), indent=2, allow_nan=False) + "\n"


def load_result(path: str | Path) -> DesignResult:
    """Read a ``result.json``.

    Parameters
    ----------
    path : str or Path
        The file, or the run folder that holds it.

    Returns
    -------
    DesignResult

    Raises
    ------
    ConfigError
        If it is no result of this schema version.
    """
    path = Path(path)
    file = path / "result.json" if path.is_dir() else path
    try:
        return DesignResult.model_validate_json(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigError(f"{file}: cannot be read: {error.strerror}; allowed: a result.json of 'optimise'") from error
    except (ValidationError, UnicodeDecodeError) as error:
        first = error.errors()[0] if isinstance(error, ValidationError) else {"loc": (), "msg": "not UTF-8 text"}
        key = ".".join(str(step) for step in first["loc"]) or "(file)"
        raise ConfigError(
            f"{file}:1: {key}: {first['msg']}; allowed: a result.json of 'optimise', schema version {SCHEMA_VERSION}"
        ) from None

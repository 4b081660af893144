"""Records of an answer: plain data that can be written to JSON and read back."""

from __future__ import annotations

import json
from html import escape
from pathlib import Path
from typing import Any, Literal, Self

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator
from pydantic_core import PydanticCustomError

from .answers.bound import MassBound
from .answers.loads import LoadRow, MarginRow
from .answers.older import completed
from .answers.search import Infeasibility, LocalOptimum, Relaxation, Sensitivity, StartResult
from .answers.stock import StockCandidate, StockResult
from .answers.verdicts import FINITE, Certificate, DecayCheck, LimitCycleCheck, OperatingPoint, Verdict
from .errors import ConfigError
from .reading import MOST_RESULT_BYTES, printable, text_of

__all__ = [
    "SCHEMA_VERSION",
    "Certificate",
    "ConstraintResult",
    "DecayCheck",
    "DesignResult",
    "Infeasibility",
    "LimitCycleCheck",
    "LoadRow",
    "LocalOptimum",
    "MarginRow",
    "MassBound",
    "MassResult",
    "OperatingPoint",
    "Provenance",
    "Relaxation",
    "Sensitivity",
    "StartResult",
    "StockCandidate",
    "StockResult",
    "Verification",
    "load_result",
]

SCHEMA_VERSION = 2
"""That is written; version 1 is read."""

SUM_TOLERANCE = 1e-9
"""Relative difference of a total from the sum of its parts that is rounding."""


class _Record(BaseModel):
    model_config = ConfigDict(frozen=True, **FINITE)


def _impossible(what: str, found: Any) -> PydanticCustomError:
    """Error of a result that `optimise` cannot have written."""
    return PydanticCustomError("impossible", "{what}: found {found}", {"what": what, "found": str(found)[:80]})


class MassResult(_Record):
    """Mass [kg]: total and by part, fittings included."""

    total: float
    parts: dict[str, float]

    @model_validator(mode="after")
    def _adds_up(self) -> Self:
        added = sum(self.parts.values())
        if not all(part >= 0 for part in self.parts.values()):
            raise _impossible("a part of negative mass", min(self.parts.values()))
        if abs(added - self.total) > SUM_TOLERANCE * self.total:
            raise _impossible("a total mass that is not the sum of its parts", f"{self.total:.9g}, parts {added:.9g}")
        return self


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
    verification did not succeed); `message` says it in words. Design variables and derived numbers are in SI, their
    units in `units`.
    `limit_event` holds the peaks that size the parts [SI]. `decided_by` says what the mass hangs on: per cent of mass for one
    per cent of the limits of each kind of constraint.
    `verdict` is that of the certificate, `covers` and `leaves_out` say what it is about and what it is not; `witness` has the
    coordinates of a point that refutes it by name [SI]. `rests_on` says what kind of numbers strength and life rest on,
    `implausible` what a practitioner would not believe, `completed` what a file of an older version did not hold. `fail_safe`
    is the certificate of the gear with its actuator off, where it has one.
    """

    schema_version: Literal[2] = 2
    status: Literal["solved", "infeasible", "failed"]
    message: str
    study: str
    topology: str
    geometry: str
    material: str
    stability_margin: float
    design: dict[str, float] = {}
    derived: dict[str, float] = {}
    units: dict[str, str] = {}
    limit_event: dict[str, float] = {}
    mass: MassResult | None = None
    stability: OperatingPoint | None = None
    constraints: tuple[ConstraintResult, ...] = ()
    loads: tuple[LoadRow, ...] = ()
    margins: tuple[MarginRow, ...] = ()
    implausible: tuple[str, ...] = ()
    rests_on: tuple[str, ...] = ()
    not_checked: tuple[str, ...] = ()
    verdict: Verdict = "undecided"
    witness: dict[str, float] = {}
    covers: tuple[str, ...] = ()
    leaves_out: tuple[str, ...] = ()
    completed: tuple[str, ...] = ()
    certificate: Certificate | None = None
    fail_safe: Certificate | None = None
    verification: Verification | None = None
    decay: DecayCheck | None = None
    limit_cycle: LimitCycleCheck | None = None
    bound: MassBound | None = None
    decided_by: dict[str, float] = {}
    infeasibility: Infeasibility | None = None
    sensitivities: tuple[Sensitivity, ...] = ()
    stock: StockResult | None = None
    starts: tuple[StartResult, ...] = ()
    local_optima: tuple[LocalOptimum, ...] = ()
    provenance: Provenance | None = None
    config: dict[str, Any] = {}

    @model_validator(mode="before")
    @classmethod
    def _of_an_older_version(cls, data: Any) -> Any:
        return completed(data) if isinstance(data, dict) and data.get("schema_version") == 1 else data

    @model_validator(mode="after")
    def _possible(self) -> Self:
        found: Verdict = "undecided" if self.certificate is None else self.certificate.found
        if self.verdict != found:
            raise _impossible(f"a verdict that is not that of the certificate, {found}", self.verdict)
        if self.status == "solved":
            self._is_proved()
        if self.status == "infeasible" and (self.mass is not None or self.infeasibility is None):
            raise _impossible("status infeasible with a mass, or without what is missing", self.status)
        least = min((*self.design.values(), *self.derived.values()), default=1.0)
        if self.mass is not None and least <= 0:
            raise _impossible("a design with a value that is not positive", least)
        return self

    def _is_proved(self) -> None:
        """What a solved result holds."""
        names = ("mass", "stability", "certificate", "verification", "design")
        if missing := [name for name in names if not getattr(self, name)]:
            raise _impossible("status solved without", ", ".join(missing))
        proof, check, decay = self.certificate, self.verification, self.decay
        assert proof is not None
        assert check is not None
        if (
            proof.found != "proved"
            or not proof.proved
            or proof.counterexample is not None
            or proof.margin < self.stability_margin
        ):
            raise _impossible("status solved without a certificate that proves its margin", proof.reason)
        if self.fail_safe is not None and (self.fail_safe.found != "proved" or not self.fail_safe.proved):
            raise _impossible("status solved without a proof for the actuator off", self.fail_safe.reason)
        decayed = decay is None or (decay.passed and decay.ratio <= decay.limit)
        if not (check.passed and check.grid_passed and decayed):
            raise _impossible("status solved with a check that has not passed", self.message)
        for worst in (self.stability, check.worst):
            if worst is not None and worst.abscissa > -self.stability_margin * (1 - SUM_TOLERANCE):
                raise _impossible("status solved with a spectral abscissa beyond the margin", f"{worst.abscissa:.6g} 1/s")

    @property
    def exit_code(self) -> int:
        """0 solved and verified, 3 infeasible, 4 solver or verification failure."""
        return {"solved": 0, "infeasible": 3, "failed": 4}[self.status]

    def __str__(self) -> str:
        """Verdict, mass and design in one line; `to_json` has the rest."""
        layout = f"{self.study}: {self.status}, {self.topology} ({self.geometry}), {self.material}"
        if self.mass is None:
            return f"{layout}: {self.message}"
        design = ", ".join(f"{name} {value:.5g} {self.units.get(name, '')}".rstrip() for name, value in self.design.items())
        return f"{layout}: {self.mass.total:.3f} kg; {design}"

    def _repr_html_(self) -> str:
        """The answer as notebooks show it."""
        mass = "" if self.mass is None else f": <b>{self.mass.total:.3f} kg</b>"
        title = f"{escape(self.status)}{mass}, {escape(self.topology)} ({escape(self.geometry)}), {escape(self.material)}"
        rows = [(name, f"{value:.5g}", self.units.get(name, "")) for name, value in (self.design | self.derived).items()]
        rows += [(f"mass of {part}", f"{value:.3f}", "kg") for part, value in (self.mass.parts if self.mass else {}).items()]
        cells = "".join(f"<tr><th>{escape(name)}</th><td>{value}</td><td>{unit}</td></tr>" for name, value, unit in rows)
        return f"<p>{title}</p><p>{escape(self.message)}</p><table>{cells}</table>"

    def to_json(self) -> str:
        """JSON text; floats keep every digit. The tree of the bound has a file of its own."""
        data = self.model_dump(mode="json")
        if data["bound"]:
            data["bound"]["certificate"] = None
        return json.dumps(data, indent=2, allow_nan=False) + "\n"


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
    file = path / "result.json" if _is_folder(path) else path
    try:
        return DesignResult.model_validate_json(text_of(file, "a result.json of 'optimise'", MOST_RESULT_BYTES))
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(printable(step) for step in first["loc"]) or "(file)"
        raise ConfigError(
            f"{printable(file)}:1: {key}: {printable(first['msg'])}; "
            f"allowed: a result.json of 'optimise', schema version 1 or {SCHEMA_VERSION}"
        ) from None


def _is_folder(path: Path) -> bool:
    try:
        return path.is_dir()
    except (ValueError, OSError):  # a zero byte in the path, a name too long: refused where it is read
        return False

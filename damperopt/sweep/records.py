"""What became of the points of a sweep, in memory and on disk; a file that cannot be read is as one that is missing."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator

from ..errors import OutputError
from ..provenance import program
from .grid import Sweep

__all__ = ["PointRecord", "lost", "store", "stored_records"]

ANSWERS = ("solved", "infeasible", "stable", "margin missed", "unstable")


@dataclass(frozen=True)
class PointRecord:
    """What became of a point.

    Attributes
    ----------
    index : int
    status : str
        ``solved``, ``infeasible``, ``failed`` (optimise); ``stable``, ``margin missed`` (stable, but not by the margin),
        ``unstable`` (analyse); ``invalid``: the values make no study; ``error``: the work raised, or another program
        answered; ``crashed``: it took its process along.
    message : str
    numbers : dict
        By name [SI].
    modes : dict or None
        Speeds [m/s] and eigenvalues [1/s].
    result : dict or None
        The whole `DesignResult` as plain data.
    seconds : float
    program : str
        Version and source of the damperopt that found them.
    """

    index: int
    status: str
    message: str
    numbers: dict[str, float]
    modes: dict[str, Any] | None
    result: dict[str, Any] | None
    seconds: float
    program: str

    @property
    def good(self) -> bool:
        """Whether the point has an answer, be it that there is no design."""
        return self.status in ANSWERS


class _Modes(BaseModel):
    speed: list[float]
    load: float
    names: list[str]
    real: list[list[float]]
    imag: list[list[float]]

    @model_validator(mode="after")
    def _rectangular(self) -> _Modes:
        for table in (self.real, self.imag):
            if len(table) != len(self.speed) or any(len(row) != len(self.names) for row in table):
                raise ValueError("rows and columns do not fit")
        return self


class _Design(BaseModel):
    """What other points use of a result."""

    topology: str
    design: dict[str, float]


class _Stored(BaseModel):
    """A record's file."""

    model_config = ConfigDict(extra="forbid", strict=True)

    key: str
    index: int
    status: Literal["solved", "infeasible", "stable", "margin missed", "unstable", "invalid", "failed", "error", "crashed"]
    message: str
    numbers: dict[str, float]
    modes: _Modes | None
    result: dict[str, Any] | None
    seconds: float
    program: str

    @model_validator(mode="after")
    def _with_a_design(self) -> _Stored:
        if self.status in ("solved", "infeasible"):
            _Design.model_validate(self.result, strict=True)
        return self


def _file(folder: Path, index: int) -> Path:
    return folder / "points" / f"{index:06d}.json"


def stored_records(sweep: Sweep, folder: Path) -> dict[int, PointRecord]:
    """Answers that an earlier run left in a folder, by index; those to other questions and failures are not among them.

    Parameters
    ----------
    sweep : Sweep
    folder : Path

    Returns
    -------
    dict
    """
    try:
        names = sorted(os.listdir(folder / "points"))
    except OSError:
        return {}
    found = {}
    for name in names:
        stem, _, end = name.partition(".")
        if end != "json" or not stem.isascii() or not stem.isdigit():
            continue
        index = int(stem)
        if index < len(sweep.points) and (record := _read(sweep, folder, index)) is not None:
            found[index] = record
    return found


def _read(sweep: Sweep, folder: Path, index: int) -> PointRecord | None:
    """The answer to a point's question in its file, if it holds one."""
    try:
        stored = _Stored.model_validate_json(_file(folder, index).read_bytes())
    except (OSError, ValidationError):
        return None
    if stored.index != index or stored.key != sweep.key(sweep.points[index]):
        return None
    record = PointRecord(**stored.model_dump(exclude={"key"}))
    return record if record.good or record.status == "invalid" else None


def lost(status: str, message: str) -> dict[str, Any]:
    """Answer of a point that has none."""
    nothing: dict[str, Any] = {"numbers": {}, "modes": None, "result": None}
    return {"status": status, "message": message, **nothing, "seconds": 0.0, "program": program()}


def store(folder: Path, key: str, record: PointRecord) -> None:
    """Write a record so that it is whole or absent.

    Parameters
    ----------
    folder : Path
        Of the sweep, with a folder ``points``.
    key : str
        Of the question.
    record : PointRecord

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    file = _file(folder, record.index)
    unfinished = file.with_suffix(".part")
    try:
        unfinished.write_text(json.dumps({"key": key, **vars(record)}), encoding="utf-8")
        os.replace(unfinished, file)
    except OSError as error:
        if not file.parent.exists():
            raise OutputError(f"{folder}: was removed while the sweep ran; nothing is kept") from error
        raise OutputError(f"{file}: cannot be written: {error.strerror}; finished points are kept") from error

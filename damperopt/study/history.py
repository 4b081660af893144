"""What an aircraft does while its gear may shimmy: speed, load and stroke over time, from a CSV file."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Annotated, Self

from pydantic import ValidationError, model_validator

from ..errors import ConfigError
from ..quantities.record import Distance, Force, Record, Speed, refuse
from ..quantities.units import Quantity
from ..reading import printable
from .rows import row_of, rows_of

__all__ = ["History", "Moment", "read_history"]

MOST_ROWS = 20_000

MOST_PROBLEMS = 30

Instant = Annotated[float, Quantity("s", example="1 s")]
External = Annotated[float, Quantity("N m", example="500 N m")]


class Moment(Record):
    """One row of a history."""

    time: Instant
    """[s]"""
    speed: Speed
    """V [m/s]."""
    load: Force
    """F_z on the gear [N]."""
    stroke: Distance | None = None
    """x_s of the shock strut from fully out [m]; left out: in balance with the load."""
    yaw_torque: External | None = None
    """External, about the strut axis [N m]; left out: none."""


class History(Record):
    """Speed, load, and if given stroke and yaw torque, at times between which they go in straight lines."""

    moments: tuple[Moment, ...]
    """In the order of their times."""

    @model_validator(mode="after")
    def _in_order(self) -> Self:
        if len(self.moments) < 2:
            raise refuse("moments", f"{len(self.moments)} rows", "two, or more")
        for position, (one, other) in enumerate(pairwise(self.moments), 1):
            if not other.time > one.time:
                found = f"{other.time:.9g} s after {one.time:.9g} s"
                raise refuse(f"moments.{position}.time", found, "times that rise")
        for key in ("stroke", "yaw_torque"):
            given = [getattr(moment, key) is not None for moment in self.moments]
            if any(given) and not all(given):
                raise refuse(f"moments.{given.index(False)}.{key}", "missing", "a value at every time, or at none")
        return self

    def column(self, name: str) -> list[float] | None:
        """Values of a column [SI]; None where it was left out."""
        values = [getattr(moment, name) for moment in self.moments]
        return None if values[0] is None else values


def read_history(path: str | Path) -> History:
    """A history of a CSV file.

    Parameters
    ----------
    path : str or Path
        First a header with time, speed and load, and if wanted stroke and yaw_torque, each with its unit, such as
        ``time [s], speed [kt], load [kN]``; lines that begin with # are remarks.

    Returns
    -------
    History

    Raises
    ------
    ConfigError
        With one message per problem, each ``file:line: column: what; allowed: ...``.
    """
    file = printable(path)
    first, units, rows = rows_of(path, Moment, MOST_ROWS)
    if len(rows) < 2:
        raise ConfigError(f"{file}:{first}: {len(rows)} rows; allowed: two below the header, or more")
    moments: list[Moment] = []
    problems: list[str] = []
    for position, row in rows:
        try:
            moments.append(_moment(row, units, f"{file}:{position}"))
        except ConfigError as error:
            problems += error.problems
        if len(problems) >= MOST_PROBLEMS:
            break
    if problems:
        raise ConfigError(problems)
    try:
        return History(moments=tuple(moments))
    except ValidationError as error:
        problem = error.errors(include_url=False)[0]
        _, position, key = problem["ctx"]["key"].split(".")
        raise ConfigError(f"{file}:{rows[int(position)][0]}: {key}: {problem['msg']}") from None


def _moment(line: str, units: dict[str, str], where: str) -> Moment:
    try:
        return Moment.model_validate(row_of(line, units, where))
    except ValidationError as error:
        raise ConfigError([f"{where}: {e['loc'][0]}: {e['msg']}" for e in error.errors(include_url=False)]) from None

"""What can be bought or made: stock sizes of a study, and a catalogue of dampers from a CSV file with units in its header."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import AfterValidator, BeforeValidator, GetJsonSchemaHandler, ValidationError, ValidationInfo, model_validator
from pydantic_core import CoreSchema

from ..dampers.bought import CatalogueDamper
from ..errors import ConfigError
from ..quantities.record import Length, Record, refuse
from ..reading import printable, quoted
from .rows import row_of, rows_of

__all__ = ["CATALOGUE", "Available", "CatalogueDamper", "read_catalogue"]

MOST_ROWS = 10_000


class Available(Record):
    """Sizes that exist; after the continuous optimum the lightest design of these is sought."""

    tube_diameters: list[Length] = []  # noqa: RUF012  # frozen, and copied by pydantic
    """Outer diameters of tubes [m]; left out: any."""
    walls: list[Length] = []  # noqa: RUF012
    """Walls of tubes [m]; each goes with each diameter that it leaves a bore."""
    bores: list[Length] = []  # noqa: RUF012
    """Bores of cylinders [m]; left out: any."""

    @model_validator(mode="after")
    def _sizes(self) -> Self:
        for key in type(self).model_fields:
            sizes = getattr(self, key)
            for position, size in enumerate(sizes):
                if size in sizes[:position]:
                    raise refuse(f"{key}.{position}", f"{size:g} m twice", "different sizes")
        if bool(self.tube_diameters) != bool(self.walls):
            given, other = ("tube_diameters", "walls") if self.tube_diameters else ("walls", "tube_diameters")
            raise refuse(given, f"without {other}", "both, or neither")
        if self.walls and 2 * min(self.walls) >= max(self.tube_diameters):
            raise refuse("walls", "no wall leaves a bore in any diameter", "a wall below half a diameter")
        if not (self.walls or self.bores):
            raise refuse("", "no sizes", "tube_diameters and walls, bores, or all three")
        return self


class _RowsOrFile:
    """JSON Schema of rows, or of the path of a file that has them."""

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"anyOf": [{"type": "string", "minLength": 1}, handler(schema)]}


def _from_file(found: Any, info: ValidationInfo) -> Any:
    """A path, seen from the folder of the study, as the rows of its file."""
    if not isinstance(found, str):
        return found
    folder = (info.context or {}).get("folder", ".")
    try:
        return read_catalogue(Path(folder) / found)
    except ConfigError as error:
        first, *rest = error.problems
        what, _, allowed = first.partition("; allowed: ")
        more = f" (and {len(rest)} more)" if rest else ""
        raise refuse("", what + more, allowed) from None


def _each_once(rows: list[CatalogueDamper]) -> list[CatalogueDamper]:
    names = [row.name for row in rows]
    for position, name in enumerate(names):
        if name in names[:position]:
            raise refuse(f"{position}.name", f"{quoted(name)} twice", "each damper once")
    if not rows:
        raise refuse("", "no dampers", "one row, or more")
    return rows


CATALOGUE: Any = Annotated[list[CatalogueDamper], BeforeValidator(_from_file), AfterValidator(_each_once), _RowsOrFile()]
"""Field of a study: rows, or the path of a CSV file that has them."""


def read_catalogue(path: str | Path) -> list[CatalogueDamper]:
    """Dampers of a CSV file.

    Parameters
    ----------
    path : str or Path
        First a header such as ``name, c [N s/m], stroke [mm], ...`` with every field of `CatalogueDamper`, in any order; lines
        that begin with # are remarks.

    Returns
    -------
    list of CatalogueDamper

    Raises
    ------
    ConfigError
        With one message per problem, each ``file:line: column: what; allowed: ...``.
    """
    file = printable(path)
    first, units, rows = rows_of(path, CatalogueDamper, MOST_ROWS)
    if not rows:
        raise ConfigError(f"{file}:{first}: no dampers; allowed: one row below the header, or more")
    dampers: list[CatalogueDamper] = []
    problems: list[str] = []
    seen: dict[str, int] = {}
    for position, row in rows:
        try:
            damper = _row(row, units, f"{file}:{position}")
            if damper.name in seen:
                found = f"{quoted(damper.name)} stands on line {seen[damper.name]} too"
                raise ConfigError(f"{file}:{position}: name: {found}; allowed: each damper once")
            seen[damper.name] = position
            dampers.append(damper)
        except ConfigError as error:
            problems += error.problems
    if problems:
        raise ConfigError(problems)
    return dampers


def _row(line: str, units: dict[str, str], where: str) -> CatalogueDamper:
    try:
        return CatalogueDamper.model_validate(row_of(line, units, where))
    except ValidationError as error:
        raise ConfigError([f"{where}: {e['loc'][0]}: {e['msg']}" for e in error.errors(include_url=False)]) from None

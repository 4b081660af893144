"""CSV files with units in their header: ``speed [kt]``; a column for each field of a record, in any order."""

from __future__ import annotations

import csv
import re
from pathlib import Path

from pydantic import BaseModel

from ..errors import ConfigError
from ..quantities.record import quantity_of
from ..quantities.units import number
from ..reading import printable, quoted, text_of

__all__ = ["row_of", "rows_of"]


BYTE_ORDER_MARK = "\ufeff"
"""With which spreadsheets begin a file."""

BYTES_OF_A_ROW = 400
"""At most, on average."""


def rows_of(path: str | Path, model: type[BaseModel], most: int) -> tuple[int, dict[str, str], list[tuple[int, str]]]:
    """Header and rows of a file; lines that begin with # are remarks.

    Parameters
    ----------
    path : str or Path
    model : type
        Record whose fields are the columns.
    most : int
        Rows that are allowed.

    Returns
    -------
    tuple
        Line of the header, unit of each column in their order (empty for text), and (line, text) of each row.

    Raises
    ------
    ConfigError
        With ``file:line: column: what; allowed: ...``.
    """
    file = printable(path)
    text = text_of(path, "a readable CSV file", BYTES_OF_A_ROW * most).removeprefix(BYTE_ORDER_MARK)
    lines = [
        (position, line)
        for position, line in enumerate(text.split("\n"), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not lines:
        raise ConfigError(f"{file}:1: no header; allowed: {_header(model)}")
    (first, header), *rows = lines
    units = _columns(header, f"{file}:{first}", model)
    if len(rows) > most:
        raise ConfigError(f"{file}:{first}: {len(rows)} rows; allowed: at most {most}")
    return first, units, rows


def row_of(line: str, units: dict[str, str], where: str) -> dict[str, str]:
    """Numbers of a row with their units, and its text, by column; `ConfigError` where one is no number."""
    cells = _cells(line)
    if len(cells) != len(units):
        raise ConfigError(f"{where}: {len(cells)} cells; allowed: {len(units)}, as the header has")
    block: dict[str, str] = {}
    problems = []
    for (key, unit), cell in zip(units.items(), cells, strict=True):
        if unit and number(cell) is None:
            problems.append(f"{where}: {key}: {quoted(cell)} is no number; allowed: a number, in {unit} as the header says")
        block[key] = f"{cell} {unit}" if unit else cell
    if problems:
        raise ConfigError(problems)
    return block


def _header(model: type[BaseModel]) -> str:
    fields = model.model_fields
    quantities = {key: quantity_of(field.annotation, field.metadata) for key, field in fields.items()}
    words = {key: f"{key} [{q.unit}]" if q else key for key, q in quantities.items()}
    optional = [words[key] for key, field in fields.items() if not field.is_required()]
    needed = ", ".join(words[key] for key, field in fields.items() if field.is_required())
    return f"the header {needed}" + (f", and if wanted {', '.join(optional)}" if optional else "")


def _cells(line: str) -> list[str]:
    return [cell.strip() for cell in next(csv.reader([line], skipinitialspace=True))]


def _columns(header: str, where: str, model: type[BaseModel]) -> dict[str, str]:
    """Unit of each column, in their order; empty for text."""
    units: dict[str, str] = {}
    for cell in _cells(header):
        match = re.fullmatch(r"(\w+)\s*(?:\[(.+)\])?", cell)
        key, unit = (match[1], match[2] or "") if match else (cell, "")
        field = model.model_fields.get(key)
        if field is None or key in units:
            what = "stands twice" if key in units else "is no column"
            raise ConfigError(f"{where}: {quoted(cell)} {what}; allowed: {_header(model)}")
        quantity = quantity_of(field.annotation, field.metadata)
        if quantity is not None and not unit:
            raise ConfigError(f"{where}: {key}: no unit; allowed: {key} [{quantity.unit}], or another unit of that dimension")
        if quantity is None and unit:
            raise ConfigError(f"{where}: {key}: a unit; allowed: {key} alone")
        units[key] = unit
    if missing := [key for key, field in model.model_fields.items() if field.is_required() and key not in units]:
        raise ConfigError(f"{where}: {missing[0]}: missing column; allowed: {_header(model)}")
    return units

"""Reports."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import OutputError
from .shared import all_or_nothing, out

__all__ = ["report"]


def report(folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of an optimisation.")]) -> None:
    """Write report.html, one file for a design review, into the folder of an optimisation."""
    from ..output import write_report

    try:
        with all_or_nothing():
            page = write_report(folder)
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written: {error.strerror}") from error
    out.print(f"Open {page}", soft_wrap=True, markup=False)

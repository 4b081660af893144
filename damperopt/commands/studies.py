"""Study files: check, start, schema."""

from __future__ import annotations

import json
import sys
from importlib.resources import files as packaged
from pathlib import Path
from typing import Annotated

import typer

from ..errors import ConfigError, OutputError
from .shared import out

__all__ = ["init", "schema", "validate"]


def init(path: Annotated[Path, typer.Argument(help="File to write.")] = Path("study.yaml")) -> None:
    """Write a commented starter study."""
    text = packaged("damperopt").joinpath("starter.yaml").read_text(encoding="utf-8")
    try:
        with open(path, "x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        raise OutputError(f"{path}: exists already; choose another name") from None
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror}; choose another place") from error
    out.print(f"{path} written; next: damperopt optimise {path}", soft_wrap=True, markup=False)


def schema() -> None:
    """Print the JSON Schema of a study, for editors."""
    from ..study import config

    sys.stdout.write(json.dumps(config.json_schema(), indent=2) + "\n")


def validate(files: Annotated[list[Path], typer.Argument(metavar="CONFIG...", help="Studies to check.")]) -> None:
    """Check one study or more; exit code 2 and one message per problem if something is wrong."""
    from ..study import config

    problems: list[str] = []
    for file in files:
        try:
            study = config.load(file)
        except ConfigError as error:
            problems += error.problems
        else:
            out.print(
                f"{file}: valid ({study.name}, {study.damper.topology}, order {study.gear.order})", markup=False, soft_wrap=True
            )
    if problems:
        raise ConfigError(problems)

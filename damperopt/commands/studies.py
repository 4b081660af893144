"""Study files: check, start, schema."""

from __future__ import annotations

import json
import re
import shlex
import sys
from importlib.resources import files as packaged
from pathlib import Path
from typing import Annotated

import typer

from ..errors import ConfigError, OutputError
from ..reading import printable
from .shared import err, out

__all__ = ["init", "schema", "validate"]


STARTERS = {
    "main": "main gear with yaw, bending and torque links; every key with its default",
    "caster": "free-castering nose wheel of a light aircraft, held by friction",
    "steered": "nose gear with a steering collar and a rotary vane damper",
    "twin": "main gear with two wheels on an axle",
    "tail": "tail wheel on a leaf spring, with friction that begins elastically",
    "mr": "nose gear with a magnetorheological damper",
    "imported": "structure as matrices from a finite-element model",
}
"""Studies that ``init`` writes, by name; those of `configs/`, but for the first."""

KINDS = {
    "yaw": "caster",
    "yaw_bending": "main",
    "spinning_wheel": "main",
    "yaw_bending_offset": "main",
    "seventh": "steered",
    "twin_independent": "twin",
    "yaw_translation": "tail",
}
"""The starter that is nearest to a kind of gear, where it is not called the same."""

MODELINE = "# yaml-language-server: $schema=damperopt.schema.json\n"


def init(
    path: Annotated[Path, typer.Argument(help="File to write.")] = Path("study.yaml"),
    gear: Annotated[str, typer.Option(help=f"Ready-made gear: {', '.join(STARTERS)}.")] = "main",
) -> None:
    """Write a commented starter study."""
    text = _starter(gear, path)
    try:
        with open(path, "x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        raise OutputError(f"{printable(path)}: exists already; choose another name") from None
    except OSError as error:
        raise OutputError(f"{printable(path)}: cannot be written: {error.strerror}; choose another place") from error
    next_command = re.search(r"damperopt (\w+) ", text)
    assert next_command is not None, "a starter says what is done with it"
    words = f"{printable(path)} written; next: damperopt {next_command[1]} {printable(path)}"
    out.print(words, soft_wrap=True, markup=False)


def _starter(gear: str, path: Path) -> str:
    """Text of a starter by its name or its kind of gear, in which it calls itself by its path."""
    name = KINDS.get(gear, gear)
    if name not in STARTERS:
        listed = "\n".join(f"  {name:9} {words}" for name, words in STARTERS.items())
        raise ConfigError(f"--gear: found '{printable(gear)}'; allowed:\n{listed}\nor a kind of gear: {', '.join(KINDS)}")
    text = packaged("damperopt").joinpath("starters", f"{name}.yaml").read_text(encoding="utf-8")
    text = re.sub(r"configs/\w+\.yaml|THIS_FILE", lambda _: shlex.quote(printable(path)), text)
    return text if text.startswith(MODELINE) else MODELINE + text


def schema(sweep: Annotated[bool, typer.Option("--sweep", help="Of a sweep instead of a study.")] = False) -> None:
    """Print the JSON Schema of a study or a sweep, for editors."""
    from ..study import config
    from ..study.schema import json_schema

    if sweep:
        from ..sweep.spec import SweepSpec

    found = json_schema(SweepSpec) if sweep else config.json_schema()
    sys.stdout.write(json.dumps(found, indent=2) + "\n")


def validate(files: Annotated[list[Path], typer.Argument(metavar="CONFIG...", help="Studies and sweeps to check.")]) -> None:
    """Check studies and sweeps; exit code 2 and one message per problem if something is wrong.

    Numbers that are possible but not usual come back as warnings, with the usual range.
    """
    from ..study import config

    problems: list[str] = []
    for file in files:
        try:
            text = config.text_of(file)
            words, warnings = _of_sweep(file) if config.is_sweep(text, str(file)) else _of_study(text, file)
        except ConfigError as error:
            problems += error.problems
            continue
        out.print(f"{printable(file)}: valid ({words})", markup=False, soft_wrap=True)
        for warning in warnings:
            err.print(f"{printable(file)}: not usual: {warning}", markup=False, soft_wrap=True)
    if problems:
        raise ConfigError(problems)


def _of_study(text: str, file: Path) -> tuple[str, list[str]]:
    """A study in words, and what is not usual about it."""
    from ..study.cavitation import cavitation
    from ..study.config import loads
    from ..study.plausibility import implausible

    study = loads(text, str(file))
    bounds = [study.variable(name) for name in study.variable_names]
    fixed = study.start if all(variable.min == variable.max for variable in bounds) else None
    words = [str(number) for number in implausible(study, fixed)]
    if fixed is not None:
        words += filter(None, [cavitation(study, fixed)])
    return f"{study.name}, {study.damper.topology}, {study.gear.kind}", words


def _of_sweep(file: Path) -> tuple[str, list[str]]:
    """A sweep in words; what is not usual about its base is said there."""
    from ..sweep.spec import load_sweep  # SciPy's distributions with it: not for every command

    sweep = load_sweep(file)
    return f"sweep {sweep.name}, {len(sweep.points)} points to {sweep.run}", []

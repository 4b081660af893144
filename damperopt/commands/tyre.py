"""A tyre by itself: of a study, of a property file, or of a size."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import ConfigError
from ..reading import quoted
from .shared import OutputOption, out

if TYPE_CHECKING:
    from ..tyres.property_file import PropertyFile

__all__ = ["tyre"]

ROWS = 25
"""Loads of the table that is written."""


def tyre(
    file: Annotated[Path | None, typer.Argument(metavar="CONFIG|FILE.tir", help="Study, or property file.")] = None,
    size: Annotated[str, typer.Option(help="Diameter x width in inches, such as 49x17: an estimate by TR R-64.")] = "",
    kind: Annotated[str, typer.Option("--type", help="VII or III; with --size.")] = "",
    rated_pressure: Annotated[str, typer.Option(help="Such as 170psi; with --size.")] = "",
    pressure: Annotated[str, typer.Option(help="Of inflation. [default: that of the study or file, or the rated one]")] = "",
    half_contact_length: Annotated[str, typer.Option(help="Which a property file lacks, such as 0.2m.")] = "",
    relaxation_length: Annotated[str, typer.Option(help="Instead of that of the file or estimate.")] = "",
    loads: Annotated[str, typer.Option(metavar="LOW:HIGH", help="Of one wheel, such as 20kN:200kN.")] = "",
    as_yaml: Annotated[bool, typer.Option("--yaml", help="Print the block of a study instead.")] = False,
    output: OutputOption = None,
) -> None:
    """Table, curves and study block of a tyre: contact and relaxation length, stiffnesses and trail over load."""
    from ..output.folder import run_folder, write_run
    from ..output.gallery import write_tyre_files
    from ..tyres.curves import tyre_curves
    from . import summary

    keys = {
        "pressure": _length_or_pressure(pressure, "--pressure"),
        "half_contact_length": _length_or_pressure(half_contact_length, "--half-contact-length"),
        "relaxation_length": _length_or_pressure(relaxation_length, "--relaxation-length"),
    }
    given = {key: value for key, value in keys.items() if value is not None}
    found, envelope, read = _asked(file, size, kind, rated_pressure, given)
    if as_yaml:
        sys.stdout.write(_block(found))
        return
    name = size or (file.stem if file else "")
    record = tyre_curves(found, _loads(loads, found, envelope), f"{name}: {found.law}")
    folder = run_folder(output, f"{name}-tyre")
    summary.show_tyre(out, record, found, read)
    write_run(folder, lambda place: write_tyre_files(place, record))
    out.print(f"\nResults in {folder}", soft_wrap=True, markup=False)


def _length_or_pressure(text: str, option: str) -> float | None:
    from ..quantities.record import Length, Pressure
    from .arguments import quantity

    return quantity(text, Pressure if option == "--pressure" else Length, option) if text else None


def _asked(
    file: Path | None, size: str, kind: str, rated: str, given: dict[str, float]
) -> tuple[Any, tuple[float, ...], PropertyFile | None]:
    """The tyre, the loads on a wheel of its envelope, and what was read of a property file."""
    from ..quantities.record import Pressure
    from ..study import config
    from ..tyres.property_file import block_of_file
    from .arguments import quantity

    if (file is None) == (not size) or (bool(kind or rated) and not size):
        what = "a study or a property file, or --size with --type and --rated-pressure"
        raise ConfigError(f"tyre: found {'both' if file and size else 'neither'}; allowed: {what}")
    if size:
        if not (kind and rated):
            raise ConfigError(f"--size: found no {'--type' if not kind else '--rated-pressure'}; allowed: both, with the size")
        pressure = quantity(rated, Pressure, "--rated-pressure")
        return _made({"size": size, "type": kind, "rated_pressure": pressure, **given}), (), None
    assert file is not None
    if file.suffix.lower() == ".tir":
        block, read = block_of_file({"file": file.name, **given}, file.parent, str(file))
        return _made(block), (), read
    study = config.load(file)
    changed = study.replace(**{f"tyre__{key}": value for key, value in given.items()}) if given else study
    on_wheels = {load for own in changed.envelope.samples(ROWS) for load in changed.wheel_loads(own)}
    return changed.tyre, tuple(sorted(on_wheels)), None


def _made(block: dict[str, Any]) -> Any:
    """A tyre without a study. Where nobody gives a half contact length, it and what hangs on it are NaN."""
    from pydantic import TypeAdapter, ValidationError

    from ..study.components import TYRE

    lacking = "half_contact_length" not in block and "size" not in block
    try:
        found = TypeAdapter(TYRE).validate_python({**block, **({"half_contact_length": 0.1} if lacking else {})})
    except ValidationError as error:
        raise ConfigError([_in_words(problem) for problem in error.errors(include_url=False)]) from None
    return found.model_copy(update={"half_contact_length": math.nan}) if lacking else found


def _in_words(problem: Any) -> str:
    steps = [str(step) for step in problem["loc"] if not str(step).startswith("<")]
    return f"tyre.{'.'.join([*steps, *filter(None, [problem.get('ctx', {}).get('key')])])}: {problem['msg']}"


def _loads(text: str, found: Any, envelope: tuple[float, ...]) -> list[float]:
    """Ascending loads: of the option, or of what the tyre is made for and the envelope, or about the envelope alone."""
    import numpy as np

    about = (0.25 * max(envelope), 1.25 * max(envelope)) if envelope else None
    ends: tuple[float, float] | None = _ends(text) if text else found.loads() or about
    if ends is None:
        raise ConfigError("--loads: missing; allowed: LOW:HIGH, such as 20kN:200kN: this tyre is one for any load")
    asked = () if text else envelope
    return [float(load) for load in np.unique([*np.linspace(*ends, ROWS), *asked])]


def _ends(text: str) -> tuple[float, float]:
    from ..quantities.record import Force
    from .arguments import quantity

    low, colon, high = text.partition(":")
    allowed = "LOW:HIGH, LOW below HIGH, such as 20kN:200kN"
    if not colon:
        raise ConfigError(f"--loads: found {quoted(text)}; allowed: {allowed}")
    ends = quantity(low, Force, "--loads"), quantity(high, Force, "--loads")
    if not ends[0] < ends[1]:
        raise ConfigError(f"--loads: found {quoted(text)}; allowed: {allowed}")
    return ends


def _block(found: Any) -> str:
    """The tyre as a study has it; what is as without saying is left out."""
    import yaml

    data = found.model_dump(mode="json", exclude_none=True, exclude_defaults=True)
    data = {"law": found.law, **data}
    note = ""
    if data.get("half_contact_length", 0) is None:
        del data["half_contact_length"]
        note = "# half_contact_length: to be added, the file does not have it\n"
    return note + yaml.safe_dump({"tyre": data}, sort_keys=False, allow_unicode=True)

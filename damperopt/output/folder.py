"""Run folders: results are written beside their place and moved into it when complete."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import nullcontext
from datetime import datetime
from itertools import count
from pathlib import Path

from .. import interrupts
from ..errors import Interrupted, OutputError
from .staging import Claim, claim, occupied

__all__ = ["run_folder", "write_run"]

LONGEST_STEM = 180
"""Bytes of a study's name in that of its folder, which takes date and number more: file systems allow 255."""


_claims: dict[Path, Claim] = {}
"""Folders that `run_folder` has given out and `write_run` has not filled yet."""


def run_folder(output: Path | None, name: str) -> Path:
    """Folder of a run, claimed for this process; its parent is made and proved writable before any work is done.

    Parameters
    ----------
    output : Path or None
        The folder to make; None: ``runs/NAME-DATE-TIME``.
    name : str
        Name of the study.

    Returns
    -------
    Path

    Raises
    ------
    OutputError
        If it exists and is not empty, cannot be written, or another run is going to fill it.
    """
    interrupts.begin()
    try:
        if output is None:
            return _first_free(name)
        if occupied(output):
            raise OutputError(f"{output}: exists already and is not an empty folder; choose another with -o, or remove it")
        if not _claimed(output):
            raise OutputError(f"{output}: another run is at work for this folder; choose another with -o")
    except OSError as error:
        raise OutputError(f"{output or 'runs'}: cannot be written: {error.strerror}; choose another folder with -o") from error
    return output


def _first_free(name: str) -> Path:
    stem = "".join(c if c.isalnum() else "-" for c in name.lower()).strip("-") or "run"
    short = stem.encode()[:LONGEST_STEM].decode(errors="ignore")
    base = Path("runs") / f"{short}-{datetime.now():%Y%m%d-%H%M%S}"
    for number in count(1):
        folder = base if number == 1 else base.with_name(f"{base.name}-{number}")
        if not folder.exists() and _claimed(folder):
            return folder
    raise AssertionError("numbers do not end")


def _claimed(folder: Path) -> bool:
    found = claim(folder)
    if found is not None:
        _claims[folder] = found
    return found is not None


def write_run(folder: Path, write: Callable[[Path], None], *, hold: bool = True) -> None:
    """Fill a folder atomically.

    Parameters
    ----------
    folder : Path
        Of `run_folder`.
    write : callable
        Writes everything into the folder it is given; if it raises, nothing remains.
    hold : bool
        Whether an interrupt waits until the folder is whole; not where `write` does the work itself.

    Raises
    ------
    OutputError
        If the disk refuses.
    Interrupted
        After the folder is whole.
    """
    try:
        found = _claims.pop(folder, None) or claim(folder)
        if found is None:
            raise OutputError(f"{folder}: another run is at work for this folder; choose another with -o")
        came: list[int] = []
        try:
            found.staging.mkdir(parents=True, exist_ok=True)  # somebody may have tidied up meanwhile
            with (
                interrupts.held("interrupted: writing the results; once more to drop them")
                if hold
                else nullcontext(came) as came
            ):
                write(found.staging)
                place = found.finish()
        finally:
            found.release()
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written: {error.strerror}; choose another folder with -o") from error
    if place != folder:
        raise OutputError(f"{folder}: appeared while the run was at work; the results are in {place}")
    if came:
        raise Interrupted(f"interrupted; the results are whole in {folder}")

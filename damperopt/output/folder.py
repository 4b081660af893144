"""Run folders: results are written beside their place and moved into it when complete."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Callable
from datetime import datetime
from pathlib import Path

from ..errors import OutputError

__all__ = ["run_folder", "write_run"]


def run_folder(output: Path | None, name: str) -> Path:
    """Folder of a run that does not exist yet; its parent is made and proved writable before any work is done.

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
        If it exists and is not empty, or cannot be written.
    """
    if output is None:
        stem = "".join(c if c.isalnum() else "-" for c in name.lower()).strip("-") or "run"
        base = Path("runs") / f"{stem}-{datetime.now():%Y%m%d-%H%M%S}"
        output, suffix = base, 1
        while output.exists():
            suffix += 1
            output = base.with_name(f"{base.name}-{suffix}")
    if output.exists() and (not output.is_dir() or any(output.iterdir())):
        raise OutputError(f"{output}: exists already and is not an empty folder; choose another with -o, or remove it")
    try:
        output.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=output.parent, prefix=".damperopt-"):
            pass
    except OSError as error:
        raise OutputError(f"{output}: cannot be written: {error.strerror}; choose another folder with -o") from error
    return output


def write_run(folder: Path, write: Callable[[Path], None]) -> None:
    """Fill a folder atomically.

    Parameters
    ----------
    folder : Path
        Of `run_folder`.
    write : callable
        Writes everything into the folder it is given; if it raises, nothing remains.

    Raises
    ------
    OutputError
        If the disk refuses.
    """
    try:
        staging = Path(tempfile.mkdtemp(dir=folder.parent, prefix=".damperopt-"))
        try:
            write(staging)
            os.chmod(staging, 0o755)  # mkdtemp makes it private
            if folder.exists():
                folder.rmdir()
            os.replace(staging, folder)
        except BaseException:
            shutil.rmtree(staging, ignore_errors=True)
            raise
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written: {error.strerror}; choose another folder with -o") from error

"""Folder of a sweep: it belongs to one sweep file and is worked on by one process; points, dataset, table, figure."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

from .. import interrupts
from ..errors import OutputError
from ..figures import style as plots
from ..figures.sweep import sweep_figure
from ..sweep import PointRecord, Sweep, dataset, table
from .staging import PREFIX, lock, staged, sweep_up, unlock

__all__ = ["claimed", "write_results"]

OWN = {"points", "sweep.json", "sweep.json.part", "sweep.nc", "sweep.csv", "sweep.png", "sweep.svg"}


@contextmanager
def claimed(folder: Path, file: Path) -> Iterator[None]:
    """The folder of a sweep, made if need be, for this process alone; one in which nothing was kept is removed again.

    Parameters
    ----------
    folder : Path
    file : Path
        The sweep's.

    Raises
    ------
    OutputError
        If it belongs to another sweep, holds something else, cannot be written, or another process is at work in it.
    """
    interrupts.begin()
    try:
        _look(folder, file)
        folder.mkdir(parents=True, exist_ok=True)
        descriptor = lock(folder)
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written: {error.strerror}; choose another folder with -o") from error
    if descriptor is None:
        raise OutputError(f"{folder}: another sweep is at work there; wait for it, or choose another folder with -o")
    try:
        _look(folder, file)  # another may have come first
        sweep_up(folder)
        for unfinished in (folder / "points").glob("*.part"):
            unfinished.unlink(missing_ok=True)
        _mark(folder, file)
        yield
        _mark(folder, file)  # results stay with the name of their sweep, whatever was tidied up meanwhile
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written: {error.strerror}; choose another folder with -o") from error
    finally:
        unlock(descriptor)


def _look(folder: Path, file: Path) -> None:
    """Refuse a folder that is not this sweep's; a marker that cannot be read counts as none."""
    if not folder.exists():
        return
    try:
        theirs = json.loads((folder / "sweep.json").read_text(encoding="utf-8"))["file"]
    except (OSError, ValueError, TypeError, KeyError, RecursionError):
        theirs = None
    if isinstance(theirs, str):
        if theirs != str(file.resolve()):
            raise OutputError(f"{folder}: holds the sweep of {theirs}; choose another folder with -o")
        return
    if not folder.is_dir() or any(not e.name.startswith(PREFIX) and e.name not in OWN for e in folder.iterdir()):
        raise OutputError(f"{folder}: exists already and holds no sweep; choose another with -o, or remove it")


def _mark(folder: Path, file: Path) -> None:
    unfinished = folder / "sweep.json.part"
    unfinished.write_text(json.dumps({"file": str(file.resolve())}) + "\n", encoding="utf-8")
    os.replace(unfinished, folder / "sweep.json")


def write_results(folder: Path, sweep: Sweep, records: Mapping[int, PointRecord], provenance: Mapping[str, str]) -> str:
    """Dataset and table, then the figure, each whole or as it was.

    Parameters
    ----------
    folder : Path
    sweep : Sweep
    records : mapping
    provenance : mapping

    Returns
    -------
    str
        Why there is no figure; empty: there is one.

    Raises
    ------
    OutputError
        If the disk refuses, or the folder is gone.
    """
    if not (folder / "points").is_dir():
        raise OutputError(f"{folder}: was removed while the sweep ran; nothing is kept")
    found = dataset(sweep, records, provenance)
    try:
        with staged(folder) as staging:
            found.to_netcdf(staging / "sweep.nc", engine="scipy")
            table(found).to_csv(staging / "sweep.csv")
        for old in ("sweep.png", "sweep.svg"):  # an old figure beside new numbers would be believed
            with suppress(FileNotFoundError):
                (folder / old).unlink()
        with staged(folder) as staging:
            try:
                plots.save(sweep_figure(sweep, records), staging, "sweep")
            except OSError:
                raise
            except Exception as error:  # whatever a figure stumbles over, the numbers are written
                return f"no figure could be drawn ({type(error).__name__}: {error})"
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written: {error.strerror}; finished points are kept") from error
    return ""

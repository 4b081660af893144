"""Folders that are being filled: claimed by one process, moved to their place when whole, swept up when their process is gone.

The claim on a folder is its staging folder ``.damperopt-...``, which the process locks for as long as it lives; one that nobody
locks is left over from a process that was killed.
"""

from __future__ import annotations

import atexit
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path

try:
    import fcntl
except ImportError:  # Windows: no locks; what was left over stays
    fcntl = None  # type: ignore[assignment]  # the only way to say that a module is missing

__all__ = ["PREFIX", "Claim", "claim", "lock", "occupied", "staged", "sweep_up", "unlock"]

PREFIX = ".damperopt-"


@dataclass
class Claim:
    """A folder to be, and where it is filled.

    Attributes
    ----------
    folder : Path
    staging : Path
        Beside the folder, or inside where the folder exists already.
    descriptor : int or None
        Of the lock.
    made : list of Path
        Parents that were made for it, the innermost first.
    """

    folder: Path
    staging: Path
    descriptor: int | None
    made: list[Path] = field(default_factory=list)

    def finish(self) -> Path:
        """Move what was filled to its place; where something appeared there meanwhile, to a free place beside it."""
        place = self.folder
        if self.staging.parent == self.folder:
            for entry in sorted(self.staging.iterdir()):
                os.replace(entry, self.folder / entry.name)
            self.staging.rmdir()
        else:
            number = 1
            while place.exists():
                number += 1
                place = self.folder.with_name(f"{self.folder.name}-{number}")
            os.replace(self.staging, place)
        self.made.clear()
        return place

    def release(self) -> None:
        """Remove what is left: the staging folder, and parents that were made in vain."""
        shutil.rmtree(self.staging, ignore_errors=True)
        for parent in self.made:
            with suppress(OSError):
                parent.rmdir()
        unlock(self.descriptor)
        atexit.unregister(self.release)


def claim(folder: Path) -> Claim | None:
    """Claim a folder that is to be filled; None: another process fills it.

    Parameters
    ----------
    folder : Path
        New, or existing and not `occupied`.

    Returns
    -------
    Claim or None

    Raises
    ------
    OSError
        If its place cannot be written.
    """
    place = folder if folder.is_dir() else folder.parent
    made = []
    for parent in (place, *place.parents):
        if parent.exists():
            break
        made.append(parent)
    place.mkdir(parents=True, exist_ok=True)
    sweep_up(place)
    staging = place / f"{PREFIX}{sha256(os.fsencode(folder.name)).hexdigest()[:16]}"
    try:
        staging.mkdir()
    except FileExistsError:
        return None
    try:
        descriptor = lock(staging)
    except FileNotFoundError:  # swept up by another process before the lock
        return claim(folder)
    found = Claim(folder, staging, descriptor, made)
    atexit.register(found.release)
    return found


def occupied(folder: Path) -> bool:
    """Whether a path is a file, or a folder with anything in it but staging folders."""
    if not folder.exists():
        return False
    return not folder.is_dir() or any(not entry.name.startswith(PREFIX) for entry in folder.iterdir())


def lock(folder: Path) -> int | None:
    """Lock a folder for this process.

    Parameters
    ----------
    folder : Path

    Returns
    -------
    int or None
        Descriptor for `unlock`; -1 where the system has no locks; None: another process has it.

    Raises
    ------
    OSError
        If the folder is gone.
    """
    if fcntl is None:
        return -1
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(descriptor)
        return None
    except OSError:  # a file system without locks
        os.close(descriptor)
        return -1
    try:
        same = os.path.samestat(os.fstat(descriptor), os.stat(folder))
    except FileNotFoundError:
        same = False
    if not same:
        os.close(descriptor)
        raise FileNotFoundError(2, "removed", str(folder))
    return descriptor


def unlock(descriptor: int | None) -> None:
    """Give a lock back."""
    if descriptor is not None and descriptor >= 0:
        with suppress(OSError):
            os.close(descriptor)


def sweep_up(place: Path) -> None:
    """Remove staging folders whose process is gone."""
    if fcntl is None:
        return
    for staging in place.glob(f"{PREFIX}*"):
        with suppress(OSError):
            descriptor = lock(staging)
            if descriptor is not None and descriptor >= 0:
                shutil.rmtree(staging, ignore_errors=True)
                unlock(descriptor)


@contextmanager
def staged(folder: Path) -> Iterator[Path]:
    """A folder whose files go into an existing one when all of them are whole.

    Parameters
    ----------
    folder : Path

    Yields
    ------
    Path

    Raises
    ------
    OSError
        If it cannot be written.
    """
    found = claim(folder)
    if found is None:
        raise BlockingIOError(11, "another run is writing there", str(folder))
    try:
        yield found.staging
        found.finish()
    finally:
        found.release()

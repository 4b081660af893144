"""Where a result comes from: versions, the config's hash, the commit, the time."""

from __future__ import annotations

import platform
import subprocess
from functools import cache
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from .results import Provenance
from .study.study import Study

__all__ = ["own_version", "program", "program_parts", "provenance_of"]

PACKAGES = ("casadi", "numpy", "scipy", "python-flint", "pydantic")
"""Whose versions may change a number."""


def own_version() -> str:
    """Version of damperopt."""
    try:
        return version("damperopt")
    except PackageNotFoundError:  # run from a checkout that is not installed
        return "unknown"


@cache
def program() -> str:
    """Version and source of this program in one word: what two processes must share for their numbers to be of one kind."""
    digest = sha256()
    root = Path(__file__).parent
    for file in sorted(root.rglob("*.py")):
        digest.update(file.relative_to(root).as_posix().encode() + b"\0" + file.read_bytes())
    return f"{own_version()}+{digest.hexdigest()[:16]}"


def program_parts() -> dict[str, str]:
    """The program with what it stands on, by name: `program`, Python, and the packages that may change a number."""
    python = ".".join(platform.python_version_tuple()[:2])
    return {"damperopt": program(), "python": python} | {name: version(name) for name in PACKAGES}


def provenance_of(study: Study, config_file: str | Path | None, started: str, wall_time: float) -> Provenance:
    """Provenance of a result.

    Parameters
    ----------
    study : Study
    config_file : str, Path or None
        Hashed as it is; without a file the study's JSON is.
    started : str
        ISO time.
    wall_time : float
        [s]

    Returns
    -------
    Provenance
    """
    packages = {name: version(name) for name in PACKAGES}
    text = Path(config_file).read_bytes() if config_file and Path(config_file).is_file() else study.model_dump_json().encode()
    return Provenance(
        damperopt=own_version(),
        python=platform.python_version(),
        packages=packages,
        config_file=str(config_file) if config_file else None,
        config_sha256=sha256(text).hexdigest(),
        git_commit=_git_commit(Path(config_file).parent if config_file else Path.cwd()),
        seed=study.solver.seed,
        started=started,
        wall_time=wall_time,
    )


def _git_commit(folder: Path) -> str | None:
    try:
        run = subprocess.run(["git", "rev-parse", "HEAD"], cwd=folder, capture_output=True, text=True, timeout=5)
    except (OSError, subprocess.TimeoutExpired):
        return None
    return run.stdout.strip() if run.returncode == 0 else None

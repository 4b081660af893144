"""Checksums of the files of a run: one altered digit is found without knowing what it means."""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path

__all__ = ["BOUND_FILE", "SUMS_FILE", "altered", "write_sums"]

BOUND_FILE = "bound.json"
"""Tree of boxes that a lower bound on mass rests on."""

SUMS_FILE = "SHA256SUMS"
"""As ``sha256sum --check`` reads it."""

SUMMED = ("config.yaml", "result.json", BOUND_FILE, "modes.csv")


def write_sums(folder: Path) -> None:
    """Sums of the files that results stand in."""
    lines = [f"{_sum(folder / name)}  {name}\n" for name in SUMMED if (folder / name).is_file()]
    (folder / SUMS_FILE).write_text("".join(lines), encoding="ascii")


def altered(folder: Path) -> list[str]:
    """What does not agree with the sums, in words."""
    file, found = folder / SUMS_FILE, []
    if not file.is_file():
        return [f"{SUMS_FILE} is missing: nothing says whether the files are as they were written"]
    listed: dict[str, str] = {}
    for line in file.read_text(encoding="utf-8", errors="replace").splitlines():
        digest, _, name = line.partition("  ")
        listed[name] = digest
    for name in SUMMED:
        there = (folder / name).is_file()
        if there and name not in listed:
            found.append(f"{name} has no sum")
        elif name in listed and (not there or _sum(folder / name) != listed[name]):
            found.append(f"{name} is {'not what was written' if there else 'missing'}")
    return found + [f"{SUMS_FILE} names '{name[:60]}', which is no result" for name in listed if name not in SUMMED]


def _sum(file: Path) -> str:
    return sha256(file.read_bytes()).hexdigest()

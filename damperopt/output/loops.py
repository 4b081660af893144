"""Files of a loop: margins over speed, and its loci over frequency, as CSV and figures."""

from __future__ import annotations

import csv
from collections.abc import Callable, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from ..stability.loop import Break
from ..stability.margins_of_loop import Locus, LoopMargins, OverSpeed

__all__ = ["write_loops"]

UNITS = {"phase": "rad", "disk": "1", "gain_down": "1", "gain_up": "1", "unstable": "1", "abscissa": "1/s"}
"""Of margins; the others are frequencies."""


def write_loops(place: Path, over: OverSpeed, loci: Sequence[tuple[float, Locus]], where: Break) -> None:
    """Margins over speed as ``margins.csv``, each locus as ``loop-SPEED.csv``; then the figures.

    Parameters
    ----------
    place : Path
        Folder.
    over : OverSpeed
    loci : sequence of tuple
        Speed [m/s] and what was found there.
    where : {'tyre', 'damper'}
    """
    from ..figures import save_each

    _write_margins(place / "margins.csv", over)
    drawings: dict[str, Callable[[], Any]] = {"margins": _drawing("loop_margins", over, where)}
    for speed, locus in loci:
        name = f"loop-{speed:.6g}"
        _write_locus(place / f"{name}.csv", locus)
        drawings[name] = _drawing("loop_loci", locus, where, speed, over.load)
    save_each(drawings, place)


def _drawing(name: str, *arguments: Any) -> Callable[[], Any]:
    def drawn() -> Any:
        from .. import figures

        return getattr(figures, name)(*arguments)

    return drawn


def _write_margins(path: Path, over: OverSpeed) -> None:
    names = [field.name for field in fields(LoopMargins)]
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["speed [m/s]", "load [N]", *(f"{name} [{UNITS.get(name, 'rad/s')}]" for name in names)])
        for speed, margins in zip(over.speeds, over.margins, strict=True):
            values = (getattr(margins, name) for name in names)
            writer.writerow([f"{speed:.9g}", f"{over.load:.9g}", *("" if np.isnan(v) else f"{v:.9g}" for v in values)])


def _write_locus(path: Path, locus: Locus) -> None:
    """det(1 + L) and each locus, real and imaginary parts, over frequency."""
    columns = {"det(1 + L)": locus.difference} | {f"locus {i + 1}": l for i, l in enumerate(locus.loci.T)}
    header = ["frequency [rad/s]", *(f"{name} {part} [1]" for name in columns for part in ("real", "imaginary"))]
    parts = (part for values in columns.values() for part in (values.real, values.imag))
    table = np.column_stack([locus.frequencies, *parts])
    np.savetxt(path, table, fmt="%.9e", delimiter=",", header=",".join(header), comments="", encoding="utf-8")

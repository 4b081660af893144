"""Matrices of a structure from a file: NumPy's .npz, or a folder with a .csv for each."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from pydantic_core import PydanticCustomError

from ..quantities.record import refuse
from ..quantities.units import Quantity

__all__ = ["NEEDED", "OPTIONAL", "read", "refuse_wrong"]

NEEDED = ("M", "C", "K", "H_eta", "H_theta")
OPTIONAL = ("G", "K_g", "K_D", "B_F", "B_M", "H_d", "names")
SQUARE = ("M", "C", "K", "G", "K_g", "K_D")

UNITS = {"length": "m", "force": "N", "time": "s"}

LARGEST = 60
"""Coordinates at most: a gear is condensed before."""

NOTHING = 1e-9
"""Relative to the largest entry, or eigenvalue: what rounding of a file leaves of symmetry, and of zero."""


def read(path: Path) -> dict[str, Any]:
    """Matrices and rows by name, in N, m and s.

    Parameters
    ----------
    path : Path
        A .npz file with M, C, K, H_eta, H_theta, optionally G, K_g, K_D, B_F, B_M, H_d, names, and the text ``units``, such as
        ``length=mm, force=N, time=s``; or a folder with a .csv file for each, with these units in its first line, behind a #.

    Returns
    -------
    dict
        Nested lists of floats; ``names`` of str. Coordinates stay in units of their own: energies are converted.
    """
    arrays, units = _npz(path) if path.suffix == ".npz" else _folder(path)
    if unknown := sorted(arrays.keys() - {*NEEDED, *OPTIONAL}):
        raise refuse("file", f"{path.name} holds '{unknown[0]}'", ", ".join((*NEEDED, *OPTIONAL, "units")))
    if missing := [name for name in NEEDED if name not in arrays]:
        raise refuse("file", f"{path.name} lacks {missing[0]}", f"all of {', '.join(NEEDED)}")
    for name, array in arrays.items():
        if name != "names" and not np.isfinite(array).all():
            raise refuse("file", f"{name} of {path.name} is not finite everywhere", "finite numbers")
    L, F, T = _factors(path, units)
    energy = F * L
    factor = {"M": energy * T**2, "C": energy * T, "K": energy, "G": F * T**2, "K_g": L, "K_D": L, "H_eta": L, "B_F": L}
    found: dict[str, Any] = {
        name: (factor.get(name, 1.0) * value).tolist() for name, value in arrays.items() if name != "names"
    }
    if "names" in arrays:
        found["names"] = [str(name) for name in arrays["names"]]
    return found


def _npz(path: Path) -> tuple[dict[str, Any], str]:
    try:
        with np.load(path, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
    except (OSError, ValueError, EOFError) as error:
        raise refuse("file", f"{path} cannot be read: {error}", "a .npz file of numbers, or a folder of .csv files") from None
    units = str(arrays.pop("units", ""))
    return {name: a if name == "names" else _numbers(path.name, name, a) for name, a in arrays.items()}, units


def _numbers(file: str, name: str, array: Any) -> Any:
    if array.dtype.kind not in "iuf":
        raise refuse("file", f"{name} of {file} holds no real numbers", "an array of floats")
    return np.asarray(array, float)


def _folder(path: Path) -> tuple[dict[str, Any], str]:
    files = sorted(path.glob("*.csv")) if path.is_dir() else []
    if not files:
        raise refuse("file", f"{path} is no .npz file and no folder of .csv files", "either of them")
    arrays: dict[str, Any] = {}
    headers = {}
    for file in files:
        lines = file.read_text(encoding="utf-8-sig").strip().splitlines()
        head, rows = (lines[0].lstrip("# "), lines[1:]) if lines and lines[0].startswith("#") else ("", lines)
        cells = [[cell.strip() for cell in row.split(",")] for row in rows if row.strip()]
        if file.stem == "names":
            arrays["names"] = [cell for row in cells for cell in row]
            continue
        headers[file.name] = head
        try:
            array = np.array([[float(cell) for cell in row] for row in cells])
        except ValueError:
            raise refuse("file", f"{file.name} is no table of numbers", "rows of numbers with commas between") from None
        arrays[file.stem] = array if file.stem in SQUARE else array.ravel()
    if len(set(headers.values())) > 1:
        one, other = sorted(set(headers.values()))[:2]
        raise refuse("file", f"the units of {path.name} differ: '{one}' and '{other}'", "the same first line in every file")
    return arrays, next(iter(headers.values()), "")


def _factors(path: Path, text: str) -> tuple[float, float, float]:
    """Length, force and time unit in m, N, s."""
    allowed = "such as 'length=mm, force=N, time=s'"
    given = dict(part.replace(" ", "").split("=", 1) for part in text.split(",") if "=" in part)
    if given.keys() != UNITS.keys():
        raise refuse("file", f"{path.name} says '{text}' as its units" if text else f"{path.name} states no units", allowed)
    factors = []
    for what, unit in UNITS.items():
        try:
            factors.append(Quantity(unit, above=0)(f"1 {given[what]}"))
        except PydanticCustomError:
            raise refuse("file", f"{path.name} gives '{given[what]}' as its unit of {what}", allowed) from None
    return factors[0], factors[1], factors[2]


def refuse_wrong(data: Mapping[str, Any]) -> None:
    """Shapes, symmetry and definiteness of matrices by name; raises what a record raises."""
    arrays: dict[str, Any] = {}
    for name, value in data.items():
        if value is not None and name != "names":
            if name in SQUARE and len({len(row) for row in value}) != 1:
                raise refuse(name, "rows of different lengths, or none", "a square matrix")
            arrays[name] = np.array(value)
    n = len(arrays["M"])
    if n > LARGEST:
        raise refuse("M", f"{n} coordinates", f"at most {LARGEST}: condense the structure")
    for name, array in arrays.items():
        shape = (n, n) if name in SQUARE else (n,)
        if array.shape != shape:
            raise refuse(name, f"the shape {array.shape}", f"{shape}, as M has {n} rows")
    for name, sign in (("M", 1), ("C", 1), ("K", 1), ("G", -1)):
        if name in arrays and np.abs(arrays[name] - sign * arrays[name].T).max() > NOTHING * np.abs(arrays[name]).max():
            raise refuse(name, "not " + ("symmetric" if sign == 1 else "antisymmetric"), f"{name} = {'-' * (sign < 0)}{name}'")
    for name, least, words in (
        ("M", NOTHING, "positive definite"),
        ("C", -NOTHING, "no negative"),
        ("K", -NOTHING, "no negative"),
    ):
        values = np.linalg.eigvalsh(arrays[name])
        if not values[0] > least * np.abs(values).max() - (name != "M") * 1e-300:
            wanted = words if name == "M" else f"{words} eigenvalue"
            raise refuse(name, f"the eigenvalue {values[0]:.3g} beside {values[-1]:.3g}", wanted)
    for name in ("H_eta", "H_theta"):
        if not arrays[name].any():
            raise refuse(name, "nothing but zeros", "a row that moves with the coordinates")

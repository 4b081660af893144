"""State-space matrices as a file of NumPy or of MATLAB."""

from __future__ import annotations

import os
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from .. import interrupts
from ..errors import OutputError
from ..quantities.named import Output
from ..stability.state_space import StateSpace

__all__ = ["FORMATS", "write_state_space"]

FORMATS = (".npz", ".mat")


def write_state_space(path: Path, record: StateSpace) -> None:
    """Write matrices, names and units; the file is there as a whole or not at all.

    Parameters
    ----------
    path : Path
        Ends with ``.npz`` (speeds and loads are the first two axes) or ``.mat`` (the last two, as MATLAB's arrays of models).
    record : StateSpace

    Raises
    ------
    OutputError
        If it exists or cannot be written.
    """
    write = _write_mat if path.suffix.lower() == ".mat" else _write_npz
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        if path.exists():
            raise OutputError(f"{path}: exists already; choose another with --to, or remove it")
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            write(part, _arrays(record))
            interrupts.check()
            os.link(part, path)  # never over a file that came meanwhile
        finally:
            part.unlink(missing_ok=True)
    except FileExistsError:
        raise OutputError(f"{path}: exists already; choose another with --to, or remove it") from None
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror}; choose another with --to") from error


def _named(name: str, declared: tuple[Output, ...]) -> dict[str, list[str]]:
    return {f"{name}_names": [o.name for o in declared], f"{name}_units": [o.unit for o in declared]}


def _arrays(record: StateSpace) -> dict[str, Any]:
    """By name: arrays, whose first two axes are speed and load, lists of names, and text."""
    found: dict[str, Any] = {name: getattr(record, name) for name in ("A", "B", "C", "D")}
    found |= {"speeds": record.speeds, "speeds_unit": "m/s", "loads": record.loads, "loads_unit": "N"}
    found |= _named("state", record.states) | _named("input", record.inputs) | _named("output", record.outputs)
    found |= {"design_names": list(record.design), "design_values": np.array(list(record.design.values()), float)}
    found |= {"contact": record.contact, "made_by": f"damperopt {version('damperopt')}"}
    if record.delay is not None:
        d = record.delay
        found |= {"delay_A_0": d.A_0, "delay_b": d.b, "delay_footprint": d.footprint, "delay_s": d.delay}
        found |= {"delay_field_error": d.field_error, "delay_footprint_names": list(d.footprint_names)}
        found |= _named("delay_state", d.states)
    return found


def _write_npz(path: Path, arrays: dict[str, Any]) -> None:
    with open(path, "wb") as file:
        np.savez_compressed(file, allow_pickle=False, **{name: np.array(value) for name, value in arrays.items()})


def _write_mat(path: Path, arrays: dict[str, Any]) -> None:
    from scipy.io import savemat

    as_mat: Callable[[Any], Any] = lambda value: (  # noqa: E731
        np.moveaxis(value, (0, 1), (-2, -1))
        if isinstance(value, np.ndarray) and value.ndim > 2
        else np.array(value, dtype=object)[:, None]
        if isinstance(value, list)
        else value
    )
    with open(path, "wb") as file:
        savemat(file, {name: as_mat(value) for name, value in arrays.items()}, do_compression=True)

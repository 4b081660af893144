"""Records of a sweep as an xarray Dataset."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..study.components import declared_units
from .grid import Sweep
from .records import PointRecord

if TYPE_CHECKING:
    import pandas
    import xarray

__all__ = ["dataset", "table"]

UNITS = {
    "mass": "kg",
    "abscissa": "1/s",
    "worst_speed": "m/s",
    "worst_load": "N",
    "lowest_critical_speed": "m/s",
    "highest_critical_speed": "m/s",
    "contact_lengths_per_wave": "1",
    "decay_ratio": "1",
    "seconds": "s",
}


def dataset(sweep: Sweep, records: Mapping[int, PointRecord], provenance: Mapping[str, str] | None = None) -> xarray.Dataset:
    """A dimension for each key of the grid and one for samples; missing numbers are NaN, missing words empty.

    Parameters
    ----------
    sweep : Sweep
    records : mapping
        By index; points without a record are missing.
    provenance : mapping or None
        For the attributes.

    Returns
    -------
    xarray.Dataset
        Names of dimensions and coordinates are the key paths with ``_`` for the dots. ``eigenvalue_real`` and
        ``eigenvalue_imag`` [1/s] have the dimensions ``speed_index`` and ``mode`` more, ``eigenvalue_speed`` [m/s] the former.
    """
    import xarray

    sampled = sweep.count > 1 or bool(sweep.sampled)
    dims = (*map(_name, sweep.axes), *(("sample",) if sampled else ()))
    shape = (*(len(values) for values in sweep.axes.values()), *((sweep.count,) if sampled else ()))
    names = list(dict.fromkeys(name for record in records.values() for name in record.numbers))

    def grid(values: list[Any]) -> np.ndarray:
        return np.array(values).reshape(shape)

    def attributes(name: str) -> dict[str, str]:
        if name in UNITS or name.startswith("mass_"):
            return {"units": UNITS.get(name, "kg")}
        return {"units": declared_units().get(name, "1")}

    rows = [records.get(index) for index in range(len(sweep.points))]
    variables: dict[str, Any] = {
        name: (dims, grid([r.numbers.get(name, np.nan) if r else np.nan for r in rows]), attributes(name)) for name in names
    }
    variables["status"] = (dims, grid([r.status if r else "missing" for r in rows]))
    variables["message"] = (dims, grid([r.message if r else "" for r in rows]))
    variables["seconds"] = (dims, grid([r.seconds if r else np.nan for r in rows]), attributes("seconds"))
    variables |= _eigenvalues(rows, dims, shape)
    coordinates: dict[str, Any] = {
        _name(key): (_name(key), list(values), {"units": sweep.units.get(key, ""), "key": key})
        for key, values in sweep.axes.items()
    }
    for key in sweep.sampled:
        coordinates[_name(key)] = ("sample", sweep.points.draws[key], {"units": sweep.units[key], "key": key})
    return xarray.Dataset(variables, coordinates, {"name": sweep.name, "run": sweep.run, **(provenance or {})})


def table(found: xarray.Dataset) -> pandas.DataFrame:
    """A dataset's numbers without eigenvalues, a row for each point; units stand behind the names, in brackets.

    Parameters
    ----------
    found : xarray.Dataset
        Of `dataset`.

    Returns
    -------
    pandas.DataFrame
    """
    rows = found.drop_vars([name for name in found.data_vars if str(name).startswith("eigenvalue_")]).to_dataframe()

    def header(name: Any) -> str:
        unit = found[name].attrs.get("units", "") if name in found.variables else ""
        return f"{name} [{unit}]" if unit not in ("", "1") else str(name)

    rows.index = rows.index.set_names([header(name) for name in rows.index.names])
    return rows.rename(columns={name: header(name) for name in rows.columns})


def _name(key: str) -> str:
    return key.replace(".", "_")


def _eigenvalues(rows: list[PointRecord | None], dims: tuple[str, ...], shape: tuple[int, ...]) -> dict[str, Any]:
    found = [row.modes for row in rows if row and row.modes]
    if not found:
        return {}
    speeds, modes = max(len(m["speed"]) for m in found), max(len(m["names"]) for m in found)
    speed = np.full((len(rows), speeds), np.nan)
    values = np.full((2, len(rows), speeds, modes), np.nan)
    for k, row in enumerate(rows):
        if row and row.modes:
            n, m = len(row.modes["speed"]), len(row.modes["names"])
            speed[k, :n] = row.modes["speed"]
            values[0, k, :n, :m], values[1, k, :n, :m] = row.modes["real"], row.modes["imag"]
    inner = (*dims, "speed_index", "mode")
    return {
        "eigenvalue_speed": ((*dims, "speed_index"), speed.reshape(*shape, speeds), {"units": "m/s"}),
        "eigenvalue_real": (inner, values[0].reshape(*shape, speeds, modes), {"units": "1/s"}),
        "eigenvalue_imag": (inner, values[1].reshape(*shape, speeds, modes), {"units": "1/s"}),
    }

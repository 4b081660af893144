"""A tyre as a table over load, and its force and moment over slip: what `damperopt tyre` shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import ConfigError
from ..expressions.corners import Smooth
from .path_response import PathResponse, path_response

__all__ = ["Column", "TyreCurves", "tyre_curves"]

SLIPS = 121
"""Of a curve, from 0 to the end of the slip range."""
MOST_CURVES = 5
"""Loads at which curves are drawn."""


@dataclass(frozen=True)
class Column:
    """A column of the table: unit, meaning, values (m,) [SI], NaN where a number is missing."""

    unit: str
    meaning: str
    values: np.ndarray


@dataclass(frozen=True)
class TyreCurves:
    """A tyre over load and slip.

    Attributes
    ----------
    name : str
        Of the tyre, for titles.
    loads : ndarray
        (m,) of one wheel [N].
    table : mapping of str to Column
        Of the linear tyre, and what else the law knows.
    slips : ndarray
        (n,) slip angles [rad].
    drawn : ndarray
        (k,) loads of the curves [N].
    force, moment : ndarray
        (k, n) side force [N] and aligning moment [N m].
    response : PathResponse or None
        Over path frequency at the middle one of the loads.
    """

    name: str
    loads: np.ndarray
    table: Mapping[str, Column]
    slips: np.ndarray
    drawn: np.ndarray
    force: np.ndarray
    moment: np.ndarray
    response: PathResponse | None = None


def tyre_curves(tyre: Any, loads: Sequence[float], name: str) -> TyreCurves:
    """Table and curves of a tyre.

    Parameters
    ----------
    tyre : Tyre
    loads : sequence of float
        Of one wheel [N], ascending; those that the tyre has no data for are left out.
    name : str

    Raises
    ------
    ConfigError
        If none is left.
    """
    pressure = tyre.pressure
    kept = [load for load in loads if not tyre.beyond(load, pressure)]
    if not kept:
        ends = f"{loads[0] / 1e3:.6g}"
        raise ConfigError(f"loads: {ends} kN {tyre.beyond(loads[0], pressure)}; allowed: loads that the tyre has data for")
    rows = [tuple(tyre.linear(load, pressure)) for load in kept]
    small = np.array([[np.nan if value is None else float(value) for value in row] for row in rows])  # sigma may be missing
    others = [tyre.others(load, pressure) for load in kept]
    table = _linear_columns(np.array(kept), *small.T)
    for output in tyre.TABLE:
        table[output.name] = Column(output.unit, output.meaning, np.array([float(row[output.name]) for row in others]))
    slips = np.linspace(0, tyre.slip_range, SLIPS)
    drawn = np.array(kept)[np.unique(np.linspace(0, len(kept) - 1, MOST_CURVES).round().astype(int))]
    force = [[float(tyre.force(float(alpha), load, pressure)) for alpha in slips] for load in drawn]
    moment = [[float(tyre.moment(float(alpha), load, pressure, Smooth())) for alpha in slips] for load in drawn]
    curves = np.array(force), np.array(moment)
    return TyreCurves(name, np.array(kept), table, slips, drawn, *curves, path_response(tyre, kept[len(kept) // 2]))


def _linear_columns(F_z: np.ndarray, C_F: np.ndarray, C_M: np.ndarray, sigma: np.ndarray, a: np.ndarray) -> dict[str, Column]:
    """Columns of every tyre; the carcass stiffness is that of the string with this cornering stiffness."""
    with np.errstate(divide="ignore", invalid="ignore"):
        trail = np.where(C_F > 0, C_M / C_F, np.nan)
    return {
        "half_contact_length": Column("m", "a", a),
        "relaxation_length": Column("m", "sigma", sigma),
        "cornering_stiffness": Column("N/rad", "C_F, slope of the side force", C_F),
        "aligning_stiffness": Column("N m/rad", "C_M, slope of the aligning moment", C_M),
        "pneumatic_trail": Column("m", "C_M/C_F", trail),
        "cornering_coefficient": Column("1/rad", "C_F/F_z", C_F / F_z),
        "carcass_stiffness": Column(
            "N/m^2", "c_c = C_F/(2 (a + sigma)^2), of a string with this C_F", C_F / (2 * (a + sigma) ** 2)
        ),
    }

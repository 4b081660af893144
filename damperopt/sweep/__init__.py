"""Sweeps: one study over grids, lists or samples of any of its keys."""

from __future__ import annotations

from .dataset import dataset, table
from .grid import Point, Points, Sweep
from .points import run_point
from .records import PointRecord, stored_records
from .run import run_sweep
from .spec import load_sweep, sweep_of

__all__ = [
    "Point",
    "PointRecord",
    "Points",
    "Sweep",
    "dataset",
    "load_sweep",
    "run_point",
    "run_sweep",
    "stored_records",
    "sweep_of",
    "table",
]

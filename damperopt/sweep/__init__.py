"""Sweeps: one study over grids, lists or samples of any of its keys."""

from __future__ import annotations

from .dataset import dataset
from .points import run_point
from .run import PointRecord, run_sweep, stored_records
from .spec import Point, Sweep, load_sweep, sweep_of

__all__ = [
    "Point",
    "PointRecord",
    "Sweep",
    "dataset",
    "load_sweep",
    "run_point",
    "run_sweep",
    "stored_records",
    "sweep_of",
]

"""Runs a sweep over any executor of `concurrent.futures`; finished points are on disk at once."""

from __future__ import annotations

import json
import os
from collections import deque
from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import OutputError
from ..workers import cores, process_pool
from .points import run_point
from .spec import Point, Sweep

__all__ = ["PointRecord", "run_sweep", "stored_records"]

Pool = Callable[[], AbstractContextManager[Executor]]


@dataclass(frozen=True)
class PointRecord:
    """What became of a point.

    Attributes
    ----------
    index : int
    status : str
        ``solved``, ``infeasible``, ``failed`` (optimise); ``stable``, ``unstable`` (analyse); ``invalid``: the values make no
        study; ``error``: the work raised; ``crashed``: it took its process along.
    message : str
    numbers : dict
        By name [SI].
    modes : dict or None
        Speeds [m/s] and eigenvalues [1/s].
    result : dict or None
        The whole `DesignResult` as plain data.
    seconds : float
    """

    index: int
    status: str
    message: str
    numbers: dict[str, float]
    modes: dict[str, Any] | None
    result: dict[str, Any] | None
    seconds: float

    @property
    def good(self) -> bool:
        """Whether the point has an answer, be it that there is no design."""
        return self.status in ("solved", "infeasible", "stable", "unstable")


def _file(folder: Path, index: int) -> Path:
    return folder / "points" / f"{index:06d}.json"


def stored_records(sweep: Sweep, folder: Path) -> dict[int, PointRecord]:
    """Answers that an earlier run left in a folder, by index; those to other questions and failures are not among them.

    Parameters
    ----------
    sweep : Sweep
    folder : Path

    Returns
    -------
    dict
    """
    found = {}
    for point in sweep.points:
        try:
            data = json.loads(_file(folder, point.index).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            continue
        if isinstance(data, dict) and data.pop("key", None) == sweep.key(point):
            record = PointRecord(**data)
            if record.good or record.status == "invalid":
                found[point.index] = record
    return found


def run_sweep(
    sweep: Sweep,
    folder: str | Path,
    pool: Pool | None = None,
    in_flight: int | None = None,
    on_done: Callable[[PointRecord], Any] = lambda record: None,
) -> dict[int, PointRecord]:
    """Run what is missing of a sweep.

    A worker that dies takes the points in flight along; they are run again, one at a time, and a point that kills its worker
    once more is recorded as ``crashed``.

    Parameters
    ----------
    sweep : Sweep
    folder : str or Path
        With the points of an earlier run, or none.
    pool : callable or None
        Gives an executor in a context: a cluster, for example; None: processes on this machine.
    in_flight : int or None
        Points submitted at a time; None: one for each processor here.
    on_done : callable
        Called with each record when it is on disk.

    Returns
    -------
    dict
        All records by index.

    Raises
    ------
    OutputError
        If a record cannot be written.
    """
    folder, in_flight = Path(folder), in_flight or cores()
    pool = pool or partial(process_pool, in_flight)
    records = stored_records(sweep, folder)
    waiting: deque[Point] = deque()
    for point in sweep.points:
        if point.index in records:
            continue
        if point.study is None:
            records[point.index] = _store(folder, sweep, point, _lost("invalid", point.problem), on_done)
        else:
            waiting.append(point)
    suspects: deque[Point] = deque()
    while waiting or suspects:
        queue, limit = (suspects, 1) if suspects else (waiting, in_flight)
        running: dict[Future, Point] = {}
        try:
            with pool() as executor:
                while queue or running:
                    while queue and len(running) < limit:
                        point = queue.popleft()
                        running[_submit(executor, sweep, point, records)] = point
                    for future in wait(running, return_when=FIRST_COMPLETED).done:
                        answer = _answer(future)  # raises BrokenExecutor with the point still among the running
                        point = running.pop(future)
                        records[point.index] = _store(folder, sweep, point, answer, on_done)
        except BrokenExecutor:
            if queue is suspects:
                (point,) = running.values()
                words = "its worker process died, twice"
                records[point.index] = _store(folder, sweep, point, _lost("crashed", words), on_done)
            else:
                suspects.extend(running.values())
    return records


def _submit(executor: Executor, sweep: Sweep, point: Point, records: dict[int, PointRecord]) -> Future:
    assert point.study is not None
    start = _neighbour(sweep, point, records) if sweep.warm_start else None
    return executor.submit(run_point, point.study.model_dump_json(), sweep.run, sweep.eigenvalue_speeds, start)


def _answer(future: Future) -> dict[str, Any]:
    """Of a point; a cluster says with an exception of its own that it gave a task up."""
    try:
        return future.result()
    except BrokenExecutor:
        raise
    except Exception as error:
        return _lost("crashed", f"{type(error).__name__}: {error}")


def _neighbour(sweep: Sweep, point: Point, records: dict[int, PointRecord]) -> dict[str, float] | None:
    """Design of the nearest finished point of the same layout: steps along numbers count by their span, names as one each."""
    assert point.study is not None
    layout = point.study.damper.topology
    solved = [r for r in records.values() if r.status == "solved" and r.result and r.result["topology"] == layout]
    if not solved:
        return None
    spans = {
        key: np.ptp([float(p.values[key]) for p in sweep.points]) or 1.0
        for key, value in point.values.items()
        if isinstance(value, float)
    }

    def distance(other: Point) -> float:
        return sum(
            abs(float(value) - float(other.values[key])) / spans[key] if key in spans else float(value != other.values[key])
            for key, value in point.values.items()
        )

    nearest = min(solved, key=lambda record: distance(sweep.points[record.index]))
    assert nearest.result is not None
    return nearest.result["design"]


def _lost(status: str, message: str) -> dict[str, Any]:
    return {"status": status, "message": message, "numbers": {}, "modes": None, "result": None, "seconds": 0.0}


def _store(
    folder: Path, sweep: Sweep, point: Point, answer: dict[str, Any], on_done: Callable[[PointRecord], Any]
) -> PointRecord:
    """Write a record so that it is whole or absent."""
    record = PointRecord(index=point.index, **answer)
    file = _file(folder, point.index)
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        unfinished = file.with_suffix(".part")
        unfinished.write_text(json.dumps({"key": sweep.key(point), **vars(record)}), encoding="utf-8")
        os.replace(unfinished, file)
    except OSError as error:
        raise OutputError(f"{file}: cannot be written: {error.strerror}; finished points are kept") from error
    on_done(record)
    return record


def counts(records: Iterable[PointRecord]) -> dict[str, int]:
    """Points by status."""
    found: dict[str, int] = {}
    for record in records:
        found[record.status] = found.get(record.status, 0) + 1
    return found

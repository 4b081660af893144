"""Runs a sweep over any executor of `concurrent.futures`; finished points are on disk at once."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from contextlib import AbstractContextManager
from functools import partial
from pathlib import Path
from typing import Any

from .. import interrupts
from ..errors import DamperoptError
from ..provenance import program
from ..workers import SchedulerLost, cores, process_pool
from .grid import Point, Sweep
from .points import run_point
from .records import PointRecord, lost, store, stored_records

__all__ = ["PointRecord", "counts", "run_sweep", "stored_records"]

Pool = Callable[[], AbstractContextManager[Executor]]

A_LOOK = 1.0
"""Seconds between two looks at what may have happened besides a point."""


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
    work = _Work(sweep, folder, on_done)
    try:
        work.all_of_it(pool or partial(process_pool, in_flight), in_flight)
    except SchedulerLost as error:
        kept = sum(record.good for record in work.records.values())
        raise SchedulerLost(f"{error}; {kept} of {len(sweep.points)} points are kept in {folder}") from error
    return work.records


class _Work:
    """What is done, at work and still to do."""

    def __init__(self, sweep: Sweep, folder: Path, on_done: Callable[[PointRecord], Any]):
        self._sweep, self._folder, self._on_done = sweep, folder, on_done
        (folder / "points").mkdir(parents=True, exist_ok=True)
        self.records = stored_records(sweep, folder)
        self._missing = self._points()
        self._running: dict[Future, Point] = {}
        self._suspects: deque[Point] = deque()  # their worker died; each is tried once more, by itself

    def _points(self) -> Iterator[Point]:
        """Those that are still to be asked; one that makes no study is recorded on the way."""
        for index in range(len(self._sweep.points)):
            if index in self.records:
                continue
            point = self._sweep.points[index]
            if point.study is None:
                self._store(point, lost("invalid", point.problem))
                continue
            yield point

    def all_of_it(self, pool: Pool, in_flight: int) -> None:
        """Ask all points, with a new pool whenever one is broken."""
        whole = False
        while not whole or self._suspects:
            alone = bool(self._suspects)
            try:
                with pool() as executor:
                    self._ask(executor, alone, 1 if alone else in_flight)
                whole = whole or not alone
            except BrokenExecutor:
                self._broken(alone)

    def _ask(self, executor: Executor, alone: bool, limit: int) -> None:
        look = getattr(executor, "check", lambda: None)  # a cluster can be lost without a word
        try:
            while True:
                self._submit(executor, alone, limit)
                if not self._running:
                    return
                done = wait(self._running, A_LOOK, FIRST_COMPLETED).done
                interrupts.check()
                look()
                for future in done:
                    answer = _answer(future, look)  # a broken pool: with the point still among the running
                    self._store(self._running[future], answer)
                    del self._running[future]
        except KeyboardInterrupt:
            with interrupts.held():
                for future, point in self._running.items():
                    if future.done() and not future.cancelled() and future.exception() is None:
                        self._store(point, _answer(future, look))
            raise

    def _submit(self, executor: Executor, alone: bool, limit: int) -> None:
        while len(self._running) < limit:
            point = (self._suspects.popleft() if self._suspects else None) if alone else next(self._missing, None)
            if point is None:
                return
            assert point.study is not None
            warm = self._sweep.warm_start and self._sweep.run == "optimise"
            start = _neighbour(self._sweep, point, self.records) if warm else None
            question = (point.study.model_dump_json(), self._sweep.run, self._sweep.eigenvalue_speeds, start)
            try:
                self._running[executor.submit(run_point, *question)] = point
            except BaseException:
                self._running[Future()] = point  # not forgotten
                raise

    def _broken(self, alone: bool) -> None:
        points = list(self._running.values())
        self._running.clear()
        if not alone:
            self._suspects.extend(points)
            return
        for point in points:
            self._store(point, lost("crashed", "its worker process died, twice"))

    def _store(self, point: Point, answer: dict[str, Any]) -> None:
        record = PointRecord(index=point.index, **answer)
        store(self._folder, self._sweep.key(point), record)
        self.records[point.index] = record
        self._on_done(record)


def _answer(future: Future, look: Callable[[], Any]) -> dict[str, Any]:
    """Of a point; a cluster says with an exception of its own that it gave a task up, or that it is no more."""
    try:
        answer = future.result()
    except (BrokenExecutor, DamperoptError):
        raise
    except BaseException as error:  # a cancelled task among them
        if isinstance(error, (KeyboardInterrupt, SystemExit)):
            raise
        look()
        return lost("crashed", f"{type(error).__name__}: {error}")
    theirs = answer.get("program", "another version") if isinstance(answer, dict) else "another program"
    if theirs != program():
        return lost("error", f"answered by damperopt {theirs}, this is {program()}; not believed")
    return answer


def _neighbour(sweep: Sweep, point: Point, records: dict[int, PointRecord]) -> dict[str, float] | None:
    """Design of the nearest finished point of the same layout: steps along numbers count by their span, names as one each."""
    assert point.study is not None
    layout = point.study.damper.topology
    solved = [r for r in records.values() if r.status == "solved" and r.result and r.result["topology"] == layout]
    if not solved:
        return None
    spans = sweep.spans

    def distance(other: Point) -> float:
        return sum(
            abs(float(value) - float(other.values[key])) / spans[key] if key in spans else float(value != other.values[key])
            for key, value in point.values.items()
        )

    nearest = min(solved, key=lambda record: distance(sweep.points[record.index]))
    assert nearest.result is not None
    return nearest.result["design"]


def counts(records: Iterable[PointRecord]) -> dict[str, int]:
    """Points by status."""
    found: dict[str, int] = {}
    for record in records:
        found[record.status] = found.get(record.status, 0) + 1
    return found

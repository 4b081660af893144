"""Sweeps."""

from __future__ import annotations

import time
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape

from .. import interrupts
from ..errors import Interrupted
from .shared import bar, err, out

if TYPE_CHECKING:
    from ..sweep import PointRecord, Sweep
    from ..sweep.run import Pool

__all__ = ["sweep"]


def sweep(
    file: Annotated[Path, typer.Argument(metavar="SWEEP", help="What is varied, a YAML file.")],
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="DIR", help="Folder, new or of this sweep. [default: runs/SWEEP]")
    ] = None,
    workers: Annotated[int | None, typer.Option(min=1, help="Processes, or points in flight. [default: one per core]")] = None,
    scheduler: Annotated[
        str, typer.Option(metavar="tcp://HOST:PORT", help="A running Dask cluster; needs damperopt[cluster].")
    ] = "",
) -> None:
    """Optimise or analyse a study over grids, lists or samples of its keys; the same command goes on after an interrupt.

    Exit code 0: every point has an answer; 2: bad input; 4: a point failed, or the scheduler is lost; 130 or 143: interrupted,
    finished points are kept.
    """
    from ..output.sweeps import claimed, write_results
    from ..provenance import program_parts
    from ..sweep import load_sweep
    from ..sweep.run import counts
    from ..workers import check_cluster, cluster, cluster_size, cores, process_pool

    todo = load_sweep(file)
    folder = output or Path("runs") / file.stem
    if scheduler:
        check_cluster(scheduler, program_parts)
    pool = partial(cluster, scheduler) if scheduler else partial(process_pool, workers or cores())
    in_flight = workers or (cluster_size(scheduler) if scheduler else cores())
    with claimed(folder, file):
        _say_what_makes_no_study(todo)
        records, provenance = _run(todo, file, folder, pool, in_flight)
        with interrupts.held("interrupted: writing the results; once more to leave them unwritten") as came:
            if lacking := write_results(folder, todo, records, provenance):
                err.print(lacking, markup=False)
    for status, count in sorted(counts(records.values()).items()):
        out.print(f"{status}: {count}")
    bad = [record for record in records.values() if not record.good]
    for record in bad[:10]:
        err.print(f"point {record.index}, {todo.points[record.index].values}: {record.status}: {record.message}", markup=False)
    _say_what_it_rests_on(todo, records)
    out.print(f"\nResults in {folder}", soft_wrap=True, markup=False)
    if came:
        raise Interrupted(f"interrupted; the results are whole in {folder}")
    raise typer.Exit(4 if bad else 0)


def _say_what_makes_no_study(todo: Sweep) -> None:
    probes = todo.probes()
    empty = [point for point in probes if point.study is None]
    if empty:
        of = f"{len(probes)} points" if len(probes) == len(todo.points) else f"{len(probes)} points that were tried"
        err.print(f"{len(empty)} of {of} make no study, the first: {empty[0].problem}", markup=False)


def _say_what_it_rests_on(todo: Sweep, records: dict[int, PointRecord]) -> None:
    """At how many points the waves are too short for the contact line of the base, where that is not the exact one."""
    line = todo.points.base.tyre.contact
    waves = [
        record.numbers["contact_lengths_per_wave"]
        for record in records.values()
        if "contact_lengths_per_wave" in record.numbers
    ]
    short = [wave for wave in waves if wave < line.least_wave()]
    if short:
        out.print(
            f"Rests on: the contact line {line.contact} stands for the exact one (tyre.contact memory), and may not hold for "
            f"{len(short)} of {len(waves)} points: a wave of {min(short):.3g} contact lengths is the shortest, below "
            f"{line.least_wave():.3g} it is doubtful",
            soft_wrap=True,
            markup=False,
        )


def _run(todo: Sweep, file: Path, folder: Path, pool: Pool, in_flight: int) -> tuple[dict[int, PointRecord], dict[str, str]]:
    """Records of all points, and where they come from."""
    from ..provenance import program, provenance_of
    from ..sweep import run_sweep, stored_records

    clock, started = time.perf_counter(), datetime.now(UTC).isoformat(timespec="seconds")
    known, total = len(stored_records(todo, folder)), len(todo.points)
    if known:
        out.print(f"{known} of {total} points are in {folder} already.", soft_wrap=True, markup=False)
    done = set[int]()
    try:
        with bar() as shown:
            task = shown.add_task(escape(todo.name), total=total, completed=known)

            def on_done(record: PointRecord) -> None:
                done.add(record.index)
                shown.update(task, completed=known + len(done), description=escape(f"{todo.name}: last {record.status}"))

            records = run_sweep(todo, folder, pool, in_flight, on_done)
    except KeyboardInterrupt:
        interrupts.answered()
        raise Interrupted(
            f"interrupted: {known + len(done)} of {total} points are in {folder}; the same command goes on"
        ) from None
    source = provenance_of(todo.points.base, file, started, time.perf_counter() - clock)
    provenance = {key: str(value) for key, value in source.model_dump().items() if value is not None}
    return records, provenance | {"program": program()}

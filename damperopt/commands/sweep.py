"""Sweeps."""

from __future__ import annotations

import json
import os
import tempfile
import time
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from ..errors import Interrupted, OutputError
from ..figures import style as plots
from ..figures.sweep import sweep_figure
from ..provenance import provenance_of
from ..sweep import PointRecord, Sweep, dataset, load_sweep, run_sweep, stored_records
from ..sweep.run import counts
from ..workers import cluster, cluster_size, cores, process_pool
from .shared import bar, err, out

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

    Exit code 0: every point has an answer; 2: bad input; 4: a point failed; 130: interrupted, finished points are kept.
    """
    todo = load_sweep(file)
    folder = output or Path("runs") / file.stem
    pool = partial(cluster, scheduler) if scheduler else partial(process_pool, workers or cores())
    in_flight = workers or (cluster_size(scheduler) if scheduler else cores())
    clock, started = time.perf_counter(), datetime.now(UTC).isoformat(timespec="seconds")
    _claim(folder, file)
    if empty := [point for point in todo.points if point.study is None]:
        err.print(f"{len(empty)} of {len(todo.points)} points make no study, the first: {empty[0].problem}", markup=False)
    known = len(stored_records(todo, folder))
    if known:
        out.print(f"{known} of {len(todo.points)} points are in {folder} already.", soft_wrap=True)
    try:
        with bar() as shown:
            task = shown.add_task(todo.name, total=len(todo.points), completed=known)

            def on_done(record: PointRecord) -> None:
                shown.update(task, advance=1, description=f"{todo.name}: last {record.status}")

            records = run_sweep(todo, folder, pool, in_flight, on_done)
    except KeyboardInterrupt:
        stored = len(stored_records(todo, folder))
        raise Interrupted(
            f"interrupted: {stored} of {len(todo.points)} points are in {folder}; the same command goes on"
        ) from None
    source = provenance_of(next(p.study for p in todo.points if p.study), file, started, time.perf_counter() - clock)
    provenance = {key: str(value) for key, value in source.model_dump().items() if value is not None}
    try:
        _write_results(folder, todo, records, provenance)
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written: {error.strerror}; finished points are kept") from error
    for status, count in sorted(counts(records.values()).items()):
        out.print(f"{status}: {count}")
    bad = [record for record in records.values() if not record.good]
    for record in bad[:10]:
        err.print(f"point {record.index}, {todo.points[record.index].values}: {record.status}: {record.message}", markup=False)
    out.print(f"\nResults in {folder}", soft_wrap=True)
    raise typer.Exit(4 if bad else 0)


def _claim(folder: Path, file: Path) -> None:
    """Make the folder of a sweep, or see that it is one of this file."""
    marker = folder / "sweep.json"
    if marker.exists():
        try:
            theirs = json.loads(marker.read_text(encoding="utf-8"))["file"]
        except (OSError, ValueError, TypeError, KeyError):
            raise OutputError(f"{marker}: does not name the sweep of its folder; choose another folder with -o") from None
        if theirs != str(file.resolve()):
            raise OutputError(f"{folder}: holds the sweep of {theirs}; choose another folder with -o")
        return
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise OutputError(f"{folder}: exists already and holds no sweep; choose another with -o, or remove it")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        marker.write_text(json.dumps({"file": str(file.resolve())}) + "\n", encoding="utf-8")
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written: {error.strerror}; choose another folder with -o") from error


def _write_results(folder: Path, sweep: Sweep, records: dict[int, PointRecord], provenance: dict[str, str]) -> None:
    """Dataset, table and figure, each whole or as it was."""
    found = dataset(sweep, records, provenance)
    with tempfile.TemporaryDirectory(dir=folder, prefix=".damperopt-") as name:
        staging = Path(name)
        found.to_netcdf(staging / "sweep.nc", engine="scipy")
        plain = found.drop_vars([n for n in found.data_vars if str(n).startswith("eigenvalue_")])
        plain.to_dataframe().to_csv(staging / "sweep.csv")
        plots.save(sweep_figure(sweep, records), staging, "sweep")
        for file in sorted(staging.iterdir()):
            os.replace(file, folder / file.name)

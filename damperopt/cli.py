"""Command line: reads a study, calls the pipeline, shows and stores the answer; errors become exit codes."""

from __future__ import annotations

import json
import os
import shutil
import signal
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from . import config, summary
from .arguments import axis_range, choices, disturbance_of, quantity, speed_grid, values_of
from .certify import certify
from .chart import chart as trace_chart
from .critical import critical_speeds
from .design import combinations, optimise_each, rank
from .errors import ConfigError, DamperoptError, Interrupted, OutputError
from .events import ExactSimulator
from .integrators import ENGINES
from .maps import filled_map
from .materials import MATERIALS
from .modes import track_modes
from .output import run_folder, write_modes, write_motion, write_ranking, write_run, write_trajectory
from .plane import Plane
from .records import Force, Rate, Speed, Time
from .results import DesignResult, load_result
from .run_files import draw_modes, write_chart_files, write_design
from .simulate import Simulator
from .specs import Study
from .stability import linear_gear
from .thesis import thesis_gear, write_thesis
from .trajectory import motion_of
from .variables import DESIGN_VARIABLES, TOPOLOGIES
from .worst import worst_points

__all__ = ["app", "main"]

FEW_STARTS = 24

app = typer.Typer(
    name="damperopt",
    help="Lightest shimmy damper for a landing gear, proved stable at every speed of its envelope.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
# no emoji: 5:100:1 is a range of speeds
out, err = Console(highlight=False, emoji=False), Console(stderr=True, highlight=False, emoji=False)

ConfigArgument = Annotated[Path, typer.Argument(metavar="CONFIG", help="Study, a YAML file.")]
OutputOption = Annotated[
    Path | None, typer.Option("-o", "--output", metavar="DIR", help="New folder for the results. [default: runs/NAME-DATE]")
]
DesignOption = Annotated[
    Path | None, typer.Option(help="result.json of 'optimise', or its folder. [default: the starts of the study]")
]


_interrupts: list[int] = []
"""Ctrl-C that was pressed: now and then a library swallows the exception, and its answer must not pass for a whole one."""


def _interrupt(number: int, frame: Any) -> None:
    _interrupts.append(number)
    raise KeyboardInterrupt


def main() -> None:
    """Entry point of the command ``damperopt``."""
    signal.signal(signal.SIGINT, _interrupt)
    try:
        app()
    except DamperoptError as error:
        err.print(str(error), markup=False, soft_wrap=True)
        sys.exit(error.exit_code)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)


def _show_version(wanted: bool) -> None:
    if wanted:
        out.print(f"damperopt {version('damperopt')}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    pass


@app.command()
def optimise(
    file: ConfigArgument,
    topology: Annotated[str, typer.Option(help=f"{', '.join(TOPOLOGIES)}, a comma list of them, or all.")] = "",
    material: Annotated[str, typer.Option(help="A material of the library, a comma list, or all.")] = "",
    output: OutputOption = None,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes. [default: one per core; one alone for few starts]")
    ] = None,
    figures: Annotated[bool, typer.Option(help="Draw the figures.")] = True,
) -> None:
    """Find the lightest damper that is stable with the margin over the whole envelope, and prove it.

    Exit code 0: solved and verified; 2: bad input; 3: infeasible; 4: solver or verification failure.
    """
    study = config.load(file)
    topologies = choices(topology, TOPOLOGIES, "--topology")
    materials = choices(material, tuple(MATERIALS), "--material")
    studies = combinations(study, topologies, materials)
    folder = run_folder(output, file.stem)

    results: list[DesignResult] = []
    interrupted = False
    with _progress() as report:
        try:
            for result in optimise_each(studies, workers=workers or _workers(studies), progress=report, config_file=file):
                results.append(result)
        except KeyboardInterrupt:
            if not results:
                raise Interrupted("interrupted; nothing was finished, nothing was written") from None
            interrupted = True

    ordered = rank(results)
    by_combination = {(str(s.damper.topology), s.material.name): s for s in studies}

    def write(place: Path) -> None:
        shutil.copyfile(file, place / "config.yaml")
        if len(studies) == 1:
            write_design(place, studies[0], ordered[0], figures)
            return
        write_ranking(place / "ranking.csv", ordered)
        for position, result in enumerate(ordered, 1):
            own = place / f"{position:02d}-{result.topology}-{result.material.replace(' ', '-')}"
            own.mkdir()
            write_design(own, by_combination[result.topology, result.material], result, figures and position == 1)

    write_run(folder, write)  # before anything is shown: a closed pipe must not cost the results
    if len(studies) == 1:
        summary.show_design(out, ordered[0])
    else:
        summary.show_ranking(out, ordered)
    out.print(f"\nResults in {folder}", soft_wrap=True)
    if interrupted:
        err.print(f"interrupted: {len(results)} of {len(studies)} combinations were finished and are stored")
        raise typer.Exit(Interrupted.exit_code)
    codes = {result.exit_code for result in results}
    raise typer.Exit(4 if 4 in codes else 0 if 0 in codes else 3)


@app.command()
def analyse(
    file: ConfigArgument,
    design: DesignOption = None,
    speeds: Annotated[str, typer.Option(metavar="MIN:MAX:STEP", help="Speeds of the table in m/s. [default: envelope]")] = "",
    output: OutputOption = None,
) -> None:
    """Modes over speed, critical speeds and the exact certificate of a given design."""
    study = config.load(file)
    values = None
    if design is not None:
        study, values = _with_design(study, load_result(design), file, design)
    grid = speed_grid(speeds, study)
    folder = run_folder(output, f"{file.stem}-analysis")
    gear = linear_gear(study, values)
    tables = [track_modes(gear, grid, load) for load in study.envelope.loads]
    margin = study.required.stability_margin if study.requirements else 0.0
    low, high = float(grid[0]), float(grid[-1])
    if values is None:
        values = study.start
    summary.show_analysis(
        out,
        study,
        values,
        critical=[c for load in study.envelope.loads for c in critical_speeds(gear, load, low, high)],
        worst=worst_points(gear, study.envelope)[0],
        certificates=[certify(study, values, level) for level in dict.fromkeys((0.0, margin))],
    )

    def write(place: Path) -> None:
        write_modes(place / "modes.csv", tables)
        draw_modes(place, tables, margin)

    write_run(folder, write)
    out.print(f"\nResults in {folder}", soft_wrap=True)


@app.command()
def simulate(
    file: ConfigArgument,
    speed: Annotated[str, typer.Option(help="Speed in m/s, such as 40, or '120 kt'.")],
    design: DesignOption = None,
    load: Annotated[str, typer.Option(help="Vertical load [N]. [default: the largest of the envelope]")] = "",
    release: Annotated[list[str] | None, typer.Option(metavar="NAME=VALUE", help="yaw, bending or string let go.")] = None,
    kick: Annotated[list[str] | None, typer.Option(metavar="NAME=VALUE", help="yaw or bending rate at the start.")] = None,
    step: Annotated[list[str] | None, typer.Option(metavar="torque=VALUE", help="Yaw torque from the start.")] = None,
    unbalance: Annotated[list[str] | None, typer.Option(metavar="moment=VALUE", help="Rotating unbalance.")] = None,
    duration: Annotated[str, typer.Option(help="Time to simulate in s.")] = "3",
    engine: Annotated[str, typer.Option(help=f"{', '.join(ENGINES)}, exact (corners as events), or auto.")] = "auto",
    output: OutputOption = None,
) -> None:
    """Motion after a disturbance: trajectories, cycles, decay, and whether it settles, cycles or diverges.

    Exit code 0 also where the motion diverges: that is an answer. 2: the question is not well posed.
    """
    study = config.load(file)
    values = None
    if design is not None:
        study, values = _with_design(study, load_result(design), file, design)
    given = {"release": release or [], "kick": kick or [], "step": step or [], "unbalance": unbalance or []}
    required = study.requirements.decay if study.requirements else None
    if any(given.values()):
        disturbance = disturbance_of(given)
    elif required is not None:
        disturbance = required.disturbance
    else:
        disturbance = disturbance_of({"release": ["yaw=1deg"]})
    at_speed, at_load = quantity(speed, Speed, "--speed"), quantity(load, Force, "--load") if load else None
    seconds = quantity(duration, Time, "--duration")
    folder = run_folder(output, f"{file.stem}-simulation")
    if engine not in ("auto", "exact", *ENGINES):
        raise ConfigError(f"--engine: found '{engine}'; allowed: auto, exact, {', '.join(ENGINES)}")
    run = ExactSimulator(study, values) if engine == "exact" else Simulator(study, values, engine)
    try:
        motion = run(at_speed, at_load, disturbance, seconds)
    except (KeyboardInterrupt, SystemError):  # the latter where a wrapped library was interrupted between two calls
        if not _interrupts:
            raise
    if _interrupts:
        raise Interrupted("interrupted; nothing was written")
    found = motion_of(motion, required.cycles if required else 3)

    def write(place: Path) -> None:
        from . import plots  # matplotlib takes longer to import than a motion takes to find

        write_trajectory(place / "trajectory.csv", motion)
        write_motion(place / "motion.json", motion, found, disturbance, values or study.start)
        plots.save(plots.trajectory(motion, found), place, "trajectory")

    write_run(folder, write)
    summary.show_motion(out, motion, found, required.cycles if required else 3)
    out.print(f"\nResults in {folder}", soft_wrap=True)


@app.command()
def chart(
    file: ConfigArgument,
    x: Annotated[str, typer.Option(metavar="NAME=LOW:HIGH", help="Horizontal axis, such as c_lambda=0:2e5.")],
    y: Annotated[str, typer.Option(metavar="NAME=LOW:HIGH", help="Vertical axis, such as I_arm=0:1e-5.")],
    vary: Annotated[str, typer.Option(metavar="NAME=VALUE,...", help="A family of curves, such as speed=40,80,160.")] = "",
    margin: Annotated[str, typer.Option(help="Stability margin in 1/s.")] = "0",
    design: Annotated[
        Path | None, typer.Option(help="result.json of 'optimise', or its folder, marked. [default: the starts of the study]")
    ] = None,
    speed: Annotated[str, typer.Option(help="Where it is not varied. [default: the largest of the envelope]")] = "",
    load: Annotated[str, typer.Option(help="Where it is not varied. [default: the largest of the envelope]")] = "",
    fill: Annotated[str, typer.Option("--map", metavar="abscissa|damping", help="Fill the plane with it.")] = "",
    tolerance: Annotated[float, typer.Option(help="Of the curves, in parts of the ranges.")] = 1e-5,
    cells: Annotated[int, typer.Option(help="Coarse cells along an axis: what is smaller may be missed.")] = 48,
    output: OutputOption = None,
) -> None:
    """Stability chart of two quantities: the boundary traced to a tolerance, its type and frequency."""
    study = config.load(file)
    values = None
    if design is not None:
        study, values = _with_design(study, load_result(design), file, design)
    if fill not in ("", "abscissa", "damping") or (fill and vary):
        raise ConfigError(
            f"--map: found '{fill}'{' with --vary' if vary else ''}; allowed: abscissa or damping, without --vary"
        )
    folder = run_folder(output, f"{file.stem}-chart")
    record = trace_chart(
        study,
        axis_range(x, study, "--x"),
        axis_range(y, study, "--y"),
        vary=values_of(vary, study, "--vary") if vary else None,
        margin=quantity(margin, Rate, "--margin"),
        design=values,
        speed=quantity(speed, Speed, "--speed") if speed else None,
        load=quantity(load, Force, "--load") if load else None,
        cells=cells,
        tolerance=tolerance,
    )
    filled = None
    if fill:
        plane = Plane(study, record.x, record.y, record.design, record.speed, record.load, record.margin)
        filled = filled_map(plane, fill)  # type: ignore[arg-type]  # one of the two, checked above
    write_run(folder, lambda place: write_chart_files(place, record, filled))
    summary.show_chart(out, record)
    out.print(f"\nResults in {folder}", soft_wrap=True)


@app.command()
def thesis(output: OutputOption = None) -> None:
    """Draw the stability charts of C. Arreaza's thesis, and put what its text says of them to the numbers."""
    study = thesis_gear()
    folder = run_folder(output, "thesis")
    write_run(folder, lambda place: summary.show_claims(out, write_thesis(place, study)))
    out.print(f"\nOpen {folder / 'index.html'}", soft_wrap=True)


@app.command()
def validate(files: Annotated[list[Path], typer.Argument(metavar="CONFIG...", help="Studies to check.")]) -> None:
    """Check one study or more; exit code 2 and one message per problem if something is wrong."""
    problems: list[str] = []
    for file in files:
        try:
            study = config.load(file)
        except ConfigError as error:
            problems += error.problems
        else:
            out.print(
                f"{file}: valid ({study.name}, {study.damper.topology}, order {study.gear.order})", markup=False, soft_wrap=True
            )
    if problems:
        raise ConfigError(problems)


@app.command()
def init(path: Annotated[Path, typer.Argument(help="File to write.")] = Path("study.yaml")) -> None:
    """Write a commented starter study."""
    text = files("damperopt").joinpath("starter.yaml").read_text(encoding="utf-8")
    try:
        with open(path, "x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        raise OutputError(f"{path}: exists already; choose another name") from None
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror}; choose another place") from error
    out.print(f"{path} written; next: damperopt optimise {path}", soft_wrap=True, markup=False)


@app.command()
def schema() -> None:
    """Print the JSON Schema of a study, for editors."""
    sys.stdout.write(json.dumps(config.json_schema(), indent=2) + "\n")


def _with_design(study: Study, result: DesignResult, file: Path, source: Path) -> tuple[Study, dict[str, float]]:
    """The study with the layout and material that the result was made for, and its design."""
    names = DESIGN_VARIABLES.get(result.topology, ())
    if set(result.design) != set(names) or not all(0 < value < np.inf for value in result.design.values()):
        raise ConfigError(
            f"{source}:1: design: found {result.design or 'none'} (status {result.status}); "
            f"allowed: a result with positive {', '.join(names) or 'design variables'}"
        )
    changes = {
        "damper__topology": result.topology,
        "damper__geometry": result.geometry,
        "material": result.config.get("material", study.material.name),
    }
    out.print(
        f"Layout ({result.topology}, {result.geometry}) and material ({result.material}) are those of {source}; "
        f"all else is that of {file}.",
        soft_wrap=True,
        markup=False,
    )
    try:
        return study.replace(**changes), result.design
    except ConfigError as error:
        raise ConfigError([f"{file}: does not go with {source}: {problem}" for problem in error.problems]) from None


def _workers(studies: Sequence[Study]) -> int:
    """One process per core, or one alone for few starts: new processes take as long to start as 20 starts to solve."""
    if sum(study.solver.starts for study in studies) <= FEW_STARTS:
        return 1
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def _progress() -> Iterator:
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), TimeRemainingColumn())
    with Progress(*columns, console=err, transient=True) as bar:
        task = bar.add_task("starting", total=None)

        def report(done: int, total: int, study: Study) -> None:
            bar.update(task, completed=done, total=total, description=f"{study.damper.topology}, {study.material.name}")

        yield report

"""Limit cycles over any number of a study."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from ..errors import ConfigError
from .shared import ConfigArgument, DesignOption, OutputOption, all_or_nothing, bar, out, study_and_design

__all__ = ["cycles"]

MOST_POINTS = 1000
"""Speeds of a threshold, each with some ten motions."""


def cycles(
    file: ConfigArgument,
    over: Annotated[
        str, typer.Option(metavar="NAME[=LOW:HIGH]", help="speed, vertical_load or any key, such as c_lambda=1e3:1e5.")
    ] = "speed",
    design: DesignOption = None,
    begin: Annotated[str, typer.Option("--from", metavar="hopf|simulation", help="Where branches begin.")] = "hopf",
    speed: Annotated[str, typer.Option(help="Where it is not varied. [default: the largest of the envelope]")] = "",
    load: Annotated[str, typer.Option(help="Where it is not varied. [default: the largest of the envelope]")] = "",
    threshold: Annotated[
        str, typer.Option(metavar="release|kick", help="Instead: the largest one that still dies, over speed.")
    ] = "",
    second: Annotated[
        str, typer.Option("--map", metavar="NAME=LOW:HIGH", help="Instead: the largest stable cycle over two quantities.")
    ] = "",
    points: Annotated[int, typer.Option(help="Speeds of a threshold, rows of a map.")] = 9,
    at_most: Annotated[
        str, typer.Option(metavar="ANGLE", help="Exit code 3 if a stable cycle of more yaw is found, or a branch is lost.")
    ] = "",
    output: OutputOption = None,
) -> None:
    """Limit cycles: branches with stability, folds, amplitude and frequency, from Hopf points or from motions.

    Exit code 0 also where the gear shimmies: that is an answer. 2: the question is not well posed; 3: --at-most is not kept.
    """
    from ..charts.plane import Axis
    from ..cycles.amplitude_map import unknown
    from ..cycles.branches import Question, from_hopf_points
    from ..cycles.motions import from_motions
    from ..output.cycles import write_branches, write_cycle
    from ..output.folder import run_folder, write_run
    from ..quantities.record import Force, Speed
    from ..quantities.units import Quantity
    from ..results import load_result
    from .arguments import axis_range, quantity
    from .cycle_words import kept, show_cycles

    study, values = study_and_design(file, design)
    if begin not in ("hopf", "simulation"):
        raise ConfigError(f"--from: found '{begin}'; allowed: hopf or simulation")
    name, low, high = axis_range(over, study, "--over") if "=" in over else (over, None, None)
    question = Question.of(
        study,
        values,
        name,
        low,
        high,
        quantity(speed, Speed, "--speed") if speed else None,
        quantity(load, Force, "--load") if load else None,
    )
    if not 2 <= points <= MOST_POINTS:
        raise ConfigError(f"--points: found {points}; allowed: 2 to {MOST_POINTS}")
    angle = Annotated[float, Quantity("rad", above=0, below=1.0, example="0.1 deg")]
    limit = quantity(at_most, angle, "--at-most") if at_most else None
    if second:
        if threshold or begin != "hopf":
            raise ConfigError(f"--map: found with {'--threshold' if threshold else '--from simulation'}; allowed: neither")
        axis = Axis.of(study, *axis_range(second, study, "--map"))
        if axis.name == question.axis.name:
            raise ConfigError(f"--map: found {axis.name}, which --over varies; allowed: another quantity")
        _map(question, axis, points, output, f"{file.stem}-cycle-map")
        return
    if threshold:
        _threshold(question, threshold, points, output, f"{file.stem}-threshold")
        return
    folder = run_folder(output, f"{file.stem}-cycles")
    with all_or_nothing(), bar() as shown:
        task = shown.add_task("orbits", total=None)

        def report(orbit: Any) -> None:
            shown.update(task, advance=1)

        if begin == "hopf":
            branches, left = from_hopf_points(question, report), list[str]()
        else:
            branches, left = from_motions(question, report)
    sized = load_result(design).limit_event if design is not None else {}
    show_cycles(out, question, branches, begin, sized, left)

    def write(place: Path) -> None:
        write_branches(place, branches, asked(question, begin))
        if branches:
            from .. import figures  # matplotlib takes longer to import than a branch to find

            write_cycle(
                place / "largest-cycle.csv", max((b.largest() for b in branches), key=lambda o: o.amplitudes["yaw_angle"])
            )
            figures.save_each({"cycles": lambda: figures.cycles(branches, study.name)}, place)

    write_run(folder, write)
    out.print(f"\nResults in {folder}", soft_wrap=True, markup=False)
    if limit is not None and not kept(out, branches, limit, unknown(question, branches, begin, left)):
        raise typer.Exit(3)


def _map(question: Any, second: Any, points: int, output: Path | None, name: str) -> None:
    """The largest stable cycle over two quantities."""
    from ..cycles.amplitude_map import amplitude_map
    from ..output.cycles import write_map
    from ..output.folder import run_folder, write_run
    from .cycle_words import show_map

    folder = run_folder(output, name)
    with all_or_nothing(), bar() as shown:
        task = shown.add_task("branches", total=points)

        def report(row: int) -> None:
            shown.update(task, advance=1)

        found = amplitude_map(question, second, points, report)
    show_map(out, found)

    def write(place: Path) -> None:
        from .. import figures

        write_map(place / "cycle-map.csv", found)
        figures.save_each({"cycle-map": lambda: figures.cycle_map(found, question.study.name)}, place)

    write_run(folder, write)
    out.print(f"\nResults in {folder}", soft_wrap=True, markup=False)


def _threshold(question: Any, kind: str, points: int, output: Path | None, name: str) -> None:
    """The largest release or kick that still dies, over speed."""
    from ..cycles.edge import SIZES, Kicker, threshold
    from ..motion.exact import ExactSimulator
    from ..output.cycles import write_threshold
    from ..output.folder import run_folder, write_run
    from .cycle_words import show_threshold

    axis = question.axis
    if kind not in SIZES:
        raise ConfigError(f"--threshold: found '{kind}'; allowed: {' or '.join(SIZES)}")
    if axis.name != "speed":
        raise ConfigError(f"--over: found {axis.name} with --threshold; allowed: speed")
    kicker = Kicker(ExactSimulator(question.study, question.design), kind)
    folder = run_folder(output, name)
    with all_or_nothing(), bar() as shown:
        task = shown.add_task("speeds", total=points)

        def report(found: Any) -> None:
            shown.update(task, advance=1)

        speeds = [axis.low + (axis.high - axis.low) * k / (points - 1) for k in range(points)]
        found = threshold(kicker, speeds, question.load, report)
    show_threshold(out, kicker, found)

    def write(place: Path) -> None:
        from .. import figures

        write_threshold(place, found, kicker, asked(question, kind))
        figures.save_each({"threshold": lambda: figures.threshold(found, kicker.kind, kicker.unit, question.study.name)}, place)

    write_run(folder, write)
    out.print(f"\nResults in {folder}", soft_wrap=True, markup=False)


def asked(question: Any, begin: str) -> dict[str, Any]:
    """The question as data."""
    axis = question.axis
    held = {"speed": question.speed, "vertical_load": question.load}
    held.pop(axis.name, None)
    varied = {"over": axis.name, "unit": axis.unit, "low": axis.low, "high": axis.high, "from": begin}
    return {"study": question.study.name, **varied, **held, "design": dict(question.design)}

"""Find the lightest damper."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Annotated

import typer

from ..errors import Interrupted, Unfinished
from .shared import ConfigArgument, OutputOption, err, out, progress, workers_for

__all__ = ["optimise"]


def optimise(
    file: ConfigArgument,
    topology: Annotated[str, typer.Option(help="A layout of 'damperopt components', a comma list, or all.")] = "",
    material: Annotated[str, typer.Option(help="A material of the library, a comma list, or all.")] = "",
    output: OutputOption = None,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes. [default: one per core; one alone for few starts]")
    ] = None,
    figures: Annotated[bool, typer.Option(help="Draw the figures and write the report.")] = True,
) -> None:
    """Find the lightest damper that is stable with the margin over the whole envelope, and prove it.

    Exit code 0: solved and verified; 2: bad input; 3: infeasible; 4: solver or verification failure.
    """
    from ..answers.sums import write_sums
    from ..design import combinations, optimise_each, rank
    from ..optimum.stock import of_chosen_sizes
    from ..output import write_report
    from ..output.folder import run_folder, write_run
    from ..output.gallery import write_design
    from ..output.tables import write_ranking
    from ..results import DesignResult
    from ..strength.materials import MATERIALS
    from ..study import config
    from ..study.components import optimisable
    from .arguments import choices
    from .design_summary import show_design, show_ranking

    study = config.load(file)
    topologies = choices(topology, optimisable(), "--topology")
    materials = choices(material, tuple(MATERIALS), "--material")
    studies = combinations(study, topologies, materials)
    folder = run_folder(output, file.stem)

    results: list[DesignResult] = []
    interrupted = False
    with progress() as report:
        try:
            for result in optimise_each(studies, workers=workers or workers_for(studies), progress=report, config_file=file):
                results.append(result)
        except KeyboardInterrupt as stopped:
            if isinstance(stopped, Unfinished):
                results.append(stopped.result)
            if not results:
                raise Interrupted("interrupted; nothing was finished, nothing was written") from None
            interrupted = True

    ordered = rank(results)
    by_combination = {(str(s.damper.topology), s.material.name): s for s in studies}
    answered = [of_chosen_sizes(by_combination[r.topology, r.material], r) for r in ordered]

    def write(place: Path) -> None:
        shutil.copyfile(file, place / "config.yaml")
        for named in config.files_of(file):
            copy = place / named
            if place.resolve() in copy.resolve().parents:  # and not one that is named from above or by its whole path
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(file.parent / named, copy)
        if len(studies) == 1:
            write_design(place, answered[0], ordered[0], figures)
            write_sums(place)
            if figures:
                write_report(place)
            return
        write_ranking(place / "ranking.csv", ordered)
        (place / "result.json").write_text(ordered[0].to_json(), encoding="utf-8")  # the best, for analyse --design
        for position, result in enumerate(ordered, 1):
            own = place / f"{position:02d}-{result.topology}-{result.material.replace(' ', '-')}"
            own.mkdir()
            write_design(own, answered[position - 1], result, figures and position == 1)
            write_sums(own)
        if figures:
            write_report(place)

    write_run(folder, write)  # before anything is shown: a closed pipe must not cost the results
    if len(studies) == 1:
        show_design(out, ordered[0], answered[0])
    else:
        show_ranking(out, ordered)
    out.print(f"\nResults in {folder}", soft_wrap=True, markup=False)
    if interrupted:
        searched = (
            ""
            if all(result.stock is None or result.stock.finished for result in results)
            else ("; of the last, sizes that exist were not searched to the end")
        )
        err.print(f"interrupted: {len(results)} of {len(studies)} combinations were finished and are stored{searched}")
        raise typer.Exit(Interrupted.exit_code)
    codes = {result.exit_code for result in results}
    raise typer.Exit(4 if 4 in codes else 0 if 0 in codes else 3)

"""Stability of a given design."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .shared import ConfigArgument, DesignOption, OutputOption, out, study_and_design

__all__ = ["analyse"]


def analyse(
    file: ConfigArgument,
    design: DesignOption = None,
    speeds: Annotated[str, typer.Option(metavar="MIN:MAX:STEP", help="Speeds of the table in m/s. [default: envelope]")] = "",
    require_stable: Annotated[
        bool, typer.Option("--require-stable", help="Exit code 3 if stability is not proved over the whole envelope.")
    ] = False,
    output: OutputOption = None,
) -> None:
    """Modes over speed, critical speeds and the exact certificate of a given design.

    Exit code 0 also where the gear is unstable: that is an answer; 2: bad input; 3: not proved stable, with --require-stable.
    """
    from ..cycles.criticality import NormalForm
    from ..optimum.left_out import left_out_by_number
    from ..output.cycles import write_critical
    from ..output.folder import run_folder, write_run
    from ..output.gallery import draw_modes
    from ..output.tables import write_modes
    from ..proof.certify import certify
    from ..stability.critical import critical_speeds, marginal_throughout
    from ..stability.linear import LinearModel
    from ..stability.modes import track_modes
    from ..stability.over_damping import worst_over_damping
    from ..stability.wavelength import shortest_wavelength
    from ..study.passive_rest import passive_rest
    from . import summary
    from .arguments import speed_grid

    study, values = study_and_design(file, design)
    grid = speed_grid(speeds, study)
    folder = run_folder(output, f"{file.stem}-analysis")
    model = LinearModel(study)
    values = study.start if values is None else values
    gear = model.at(values)
    tables = [track_modes(gear, grid, load) for load in study.envelope.loads]
    margin = study.required.stability_margin if study.requirements else 0.0
    envelope = study.envelope.speed
    low, high = min(float(grid[0]), envelope.min), max(float(grid[-1]), envelope.max)
    certificates = [certify(study, values, level, model) for level in dict.fromkeys((0.0, margin))]
    rest = passive_rest(study)
    off = [] if rest is None else [certify(rest, values, level) for level in dict.fromkeys((0.0, study.fail_safe_margin))]
    critical = [c for load in study.envelope.loads for c in critical_speeds(gear, load, low, high)]
    crossed = [c for c in critical if c.kind == "hopf" and not c.touching]
    form = NormalForm(study) if crossed else None
    criticality = [form.at(values, c) for c in crossed if form is not None]
    summary.show_analysis(
        out,
        study,
        values,
        critical=critical,
        worst=worst_over_damping(model, study, values)[0],
        certificates=certificates,
        fail_safe=off,
        searched=(low, high),
        wave=shortest_wavelength(study, gear),
        marginal=any(marginal_throughout(gear, load, low, high) for load in study.envelope.loads),
        left_out=left_out_by_number(study, values),
        criticality=criticality,
    )

    def write(place: Path) -> None:
        write_modes(place / "modes.csv", tables)
        write_critical(place / "critical-speeds.csv", critical, criticality)
        draw_modes(place, tables, margin)

    write_run(folder, write)
    out.print(f"\nResults in {folder}", soft_wrap=True, markup=False)
    if require_stable and not certificates[0].proved:
        raise typer.Exit(3)

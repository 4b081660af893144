"""Stability charts."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from ..errors import ConfigError
from .shared import ConfigArgument, OutputOption, all_or_nothing, out, study_and_design

__all__ = ["chart"]


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
    from ..charts.chart import chart as trace_chart
    from ..charts.maps import filled_map
    from ..charts.plane import Plane
    from ..charts.waves import boundary_wavelength
    from ..optimum.left_out import left_out_by_number
    from ..output.folder import run_folder, write_run
    from ..output.gallery import write_chart_files
    from ..quantities.record import Force, Rate, Speed
    from . import summary
    from .arguments import axis_range, quantity, values_of

    study, values = study_and_design(file, design)
    if fill not in ("", "abscissa", "damping") or (fill and vary):
        raise ConfigError(
            f"--map: found '{fill}'{' with --vary' if vary else ''}; allowed: abscissa or damping, without --vary"
        )
    filled = neutral = None
    draw = partial(
        trace_chart,
        study,
        axis_range(x, study, "--x"),
        axis_range(y, study, "--y"),
        vary=values_of(vary, study, "--vary") if vary else None,
        design=values,
        speed=quantity(speed, Speed, "--speed") if speed else None,
        load=quantity(load, Force, "--load") if load else None,
        cells=cells,
        tolerance=tolerance,
    )
    at_margin = quantity(margin, Rate, "--margin")
    with all_or_nothing():
        # what is wrong with the question is found here: a wrong one leaves no folder; a folder given is looked at first
        folder = run_folder(output, f"{file.stem}-chart") if output else None
        record = draw(margin=at_margin)
        folder = folder or run_folder(None, f"{file.stem}-chart")
        if record.margin > 0:
            neutral = draw(margin=0.0)
        if fill:
            plane = Plane(study, record.x, record.y, record.design, record.speed, record.load, record.margin)
            filled = filled_map(plane, fill)  # type: ignore[arg-type]  # one of the two, checked above
        write_run(folder, lambda place: write_chart_files(place, record, filled, neutral))
    summary.show_chart(out, record, left_out_by_number(study, study.start if values is None else values))
    summary.show_contact_line(out, study, boundary_wavelength(study, record))
    out.print(f"\nResults in {folder}", soft_wrap=True, markup=False)

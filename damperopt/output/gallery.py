"""Files of a run: what each command puts into its folder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ..charts.chart import StabilityChart, chart
from ..charts.maps import FilledMap
from ..motion.decay import decay_analysis
from ..motion.simulate import Simulator
from ..results import DesignResult
from ..stability.linear import linear_gear
from ..stability.modes import ModeTable, track_modes
from ..study.study import Study
from .folder import write_chart, write_chart_json, write_modes

__all__ = ["design_chart", "design_figures", "draw_modes", "write_chart_files", "write_design"]


def write_design(place: Path, study: Study, result: DesignResult, figures: bool) -> None:
    """Result, modes and figures of a design.

    Parameters
    ----------
    place : Path
        Folder.
    study : Study
    result : DesignResult
    figures : bool
    """
    (place / "result.json").write_text(result.to_json(), encoding="utf-8")
    worst = result.stability
    if worst is None:
        return
    low, high = study.envelope.speed.min, study.envelope.speed.max
    grid = np.unique(np.linspace(low, high, 400))
    after = linear_gear(study, result.design)
    tables = [track_modes(after, grid, load) for load in study.envelope.loads]
    write_modes(place / "modes.csv", tables)
    if figures:
        from ..figures import style as plots  # matplotlib takes longer to import than a design takes to find

        for name, draw in design_figures(study, result).items():
            plots.save(draw(), place, name)


def design_figures(study: Study, result: DesignResult) -> dict[str, Callable[[], Any]]:
    """What draws each figure of a design, by name; empty without a design.

    Parameters
    ----------
    study : Study
    result : DesignResult
    """
    from ..figures import chart as chart_plot
    from ..figures import style as plots
    from ..figures.linkage import linkage
    from ..optimum.region import feasible_region

    worst = result.stability
    if worst is None:
        return {}

    def modes() -> Any:
        grid = np.unique(np.linspace(study.envelope.speed.min, study.envelope.speed.max, 400))
        before, after = (
            track_modes(gear, grid, worst.load) for gear in (linear_gear(study), linear_gear(study, result.design))
        )
        return plots.modes_before_after(before, after, result.stability_margin)

    found: dict[str, Callable[[], Any]] = {
        "linkage": lambda: linkage(study.damper, result.design),
        "mass": lambda: plots.mass_by_part(result),
        "modes": modes,
        "chart": lambda: chart_plot.chart(
            design_chart(study, result, result.stability_margin), neutral=design_chart(study, result, 0.0)
        ),
        "region": lambda: plots.region(feasible_region(study, result.design, [(worst.speed, worst.load)])),
        "tornado": lambda: plots.tornado(result),
    }
    if result.decay is not None:
        found["decay"] = lambda: _decay_figure(study, result)
    return found


def design_chart(study: Study, result: DesignResult, margin: float) -> StabilityChart:
    """Stability chart of damping and spring about the design, for the ends and the middle of the envelope's speeds.

    Parameters
    ----------
    study : Study
    result : DesignResult
        With a design.
    margin : float
        [1/s]

    Returns
    -------
    StabilityChart
    """
    assert result.stability is not None
    damping, spring = study.variable_names[0], study.damper.SPRING
    c, k = result.design[damping], result.design[spring]
    low, high = study.envelope.speed.min, study.envelope.speed.max
    speeds = sorted({low, float(np.sqrt(low * high)), high})
    return chart(
        study,
        (damping, 0.0, 2.5 * c),
        (spring, 0.0, 2.5 * k),
        vary=("speed", speeds),
        margin=margin,
        design=result.design,
        load=result.stability.load,
    )


def _decay_figure(study: Study, result: DesignResult) -> Any:
    from ..figures import style as plots

    required, check = study.required.decay, result.decay
    assert required is not None
    assert check is not None
    analysis = decay_analysis(study)
    low, high = study.envelope.speed.min, study.envelope.speed.max
    speeds = np.unique(np.append(np.geomspace(low, high, 40), check.speed))
    ratios = [analysis.at(result.design, float(speed), check.load).ratio for speed in speeds]
    duration = 1.8 * analysis.at(result.design, check.speed, check.load).time
    motion = Simulator(study, result.design, "cvodes")(check.speed, check.load, required.disturbance, duration)
    return plots.decay(motion, check, speeds, np.array(ratios))


def draw_modes(place: Path, tables: list[ModeTable], margin: float) -> None:
    """Figures of modes over speed, one for each load.

    Parameters
    ----------
    place : Path
        Folder.
    tables : list of ModeTable
    margin : float
        [1/s]
    """
    from ..figures import style as plots

    for table in tables:
        suffix = "" if len(tables) == 1 else f"-{table.load / 1e3:g}kN"
        plots.save(
            plots.modes_over_speed(table, margin, f"Modes over speed at {table.load / 1e3:g} kN"), place, f"modes{suffix}"
        )


def write_chart_files(
    place: Path, record: StabilityChart, filled: FilledMap | None = None, neutral: StabilityChart | None = None
) -> None:
    """Curves as CSV and JSON, and the figure.

    Parameters
    ----------
    place : Path
        Folder.
    record : StabilityChart
    filled : FilledMap or None
    neutral : StabilityChart or None
        The same without margin, in the figure only.
    """
    from ..figures import style as plots
    from ..figures.chart import chart as draw

    write_chart(place / "chart.csv", record)
    write_chart_json(place / "chart.json", record)
    if filled is not None:
        np.savez_compressed(place / "map.npz", x=filled.x, y=filled.y, values=filled.values, quantity=np.array(filled.quantity))
    plots.save(draw(record, filled, neutral=neutral), place, "chart")

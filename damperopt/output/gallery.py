"""Which figures a design has: what is computed for each, and what draws it; and the files that hold them."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ..answers.sums import BOUND_FILE
from ..charts.chart import StabilityChart, chart
from ..charts.maps import FilledMap
from ..linkages.assembly import layouts
from ..linkages.elastic import elastic_linkage
from ..motion.decay import DecayAnalysis
from ..motion.simulate import Simulator
from ..motion.trajectory import Trajectory
from ..optimum.region import FeasibleRegion, feasible_region
from ..quantities.shown import written
from ..results import DesignResult
from ..stability.linear import LinearModel
from ..stability.modes import ModeTable, track_modes
from ..study.study import Study
from ..tyres.curves import TyreCurves
from .tables import write_chart, write_chart_json, write_modes, write_response, write_tyre

__all__ = [
    "Answer",
    "DesignFigure",
    "design_chart",
    "draw_modes",
    "figures_of",
    "write_chart_files",
    "write_design",
    "write_tyre_files",
]

SPEEDS = 400
"""Speeds of a table and a figure of modes."""

CELLS, DRAWN = 32, 3e-4
"""Of a stability chart that is drawn: where its search begins, and less than a dot, in parts of the axes."""


@dataclass(frozen=True)
class Answer:
    """A design with the study that it answers, and the linear model that both are looked at with; the model is built once."""

    study: Study
    result: DesignResult
    model: LinearModel

    @classmethod
    def of(cls, study: Study, result: DesignResult) -> Answer:
        """The answer of a result that holds a design."""
        return cls(study, result, LinearModel(study))

    @property
    def speeds(self) -> np.ndarray:
        """(m,) of the envelope [m/s]."""
        return np.unique(np.linspace(self.study.envelope.speed.min, self.study.envelope.speed.max, SPEEDS))

    @cached_property
    def modes(self) -> list[ModeTable]:
        """Modes of the design over these speeds at each load."""
        gear = self.model.at(self.result.design)
        return [track_modes(gear, self.speeds, load) for load in self.study.envelope.loads]

    @property
    def worst(self) -> tuple[float, float]:
        """Speed [m/s] and load [N] of the largest spectral abscissa."""
        assert self.result.stability is not None
        return self.result.stability.speed, self.result.stability.load


@dataclass(frozen=True)
class DesignFigure:
    """A figure of a design.

    Attributes
    ----------
    name : str
        Of its file.
    title, text : str
        Heading and caption in a report.
    compute : callable
        Answer -> what is drawn.
    draw : callable
        (answer, what was computed) -> matplotlib Figure; computes nothing.
    """

    name: str
    title: str
    text: str
    compute: Callable[[Answer], Any]
    draw: Callable[[Answer, Any], Any]

    def drawn(self, answer: Answer) -> Any:
        """Computed and drawn."""
        return self.draw(answer, self.compute(answer))


def figures_of(result: DesignResult) -> tuple[DesignFigure, ...]:
    """Figures that a result has; none without a design.

    Parameters
    ----------
    result : DesignResult
    """
    if result.stability is None or result.mass is None:
        return ()
    absent = {"decay"} if result.decay is None else set()
    absent |= (
        {"linkage", "chart", "region"} if layouts()[result.topology].ROTARY else set()
    )  # no members, and no spring to vary
    absent |= set() if any(s.value != 0 for s in result.sensitivities) else {"tornado"}
    return tuple(figure for figure in _FIGURES if figure.name not in absent)


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
    spring = study.damper.SPRING or study.variable_names[1]
    damping = next(name for name in study.variable_names if name != spring)  # of a bought damper a length of the layout
    c, k = result.design[damping], result.design[spring]
    low, high = study.envelope.speed.min, study.envelope.speed.max
    speeds = sorted({low, float(np.sqrt(low * high)), high})
    chain = elastic_linkage(study, result.design)
    rigid = chain.links is None and chain.series is None
    least = 0.0 if rigid else c / 100  # without damping a node in series has no equation
    return chart(
        study,
        (damping, *((least, 2.5 * c) if study.damper.KIND.VARIABLES else (0.7 * c, 1.3 * c))),
        (spring, 0.0, 2.5 * k),
        vary=("speed", speeds),
        margin=margin,
        design=result.design,
        load=result.stability.load,
        cells=CELLS,
        tolerance=DRAWN,
    )


# what each figure shows


def _modes(answer: Answer) -> tuple[ModeTable, ModeTable]:
    load = answer.worst[1]
    before, after = (answer.model.at(design) for design in (answer.study.start, answer.result.design))
    tables = {table.load: table for table in answer.modes}  # the worst load of a range may lie within it
    return track_modes(before, answer.speeds, load), tables.get(load) or track_modes(after, answer.speeds, load)


def _charts(answer: Answer) -> tuple[StabilityChart, StabilityChart | None]:
    margin = answer.result.stability_margin
    neutral = design_chart(answer.study, answer.result, 0.0) if margin > 0 else None
    return design_chart(answer.study, answer.result, margin), neutral


def _region(answer: Answer) -> FeasibleRegion:
    return feasible_region(answer.study, answer.result.design, [answer.worst], limit_event=answer.result.limit_event)


def _decay(answer: Answer) -> tuple[Trajectory, np.ndarray, np.ndarray]:
    """The worst motion, and the decay ratio over speed."""
    study, design = answer.study, answer.result.design
    required, check = study.required.decay, answer.result.decay
    assert required is not None
    assert check is not None
    analysis = DecayAnalysis(study)
    low, high = study.envelope.speed.min, study.envelope.speed.max
    speeds = np.unique(np.append(np.geomspace(low, high, 40), check.speed))
    ratios = [analysis.at(design, float(speed), check.load).ratio for speed in speeds]
    duration = 1.8 * analysis.at(design, check.speed, check.load).time
    motion = Simulator(study, design, "cvodes")(check.speed, check.load, required.disturbance, duration)
    return motion, speeds, np.array(ratios)


# what draws it; matplotlib takes longer to import than a design takes to find, so it comes with the first figure


def _draw_linkage(answer: Answer, _: None) -> Any:
    from ..figures.linkage import linkage

    return linkage(answer.study.damper, answer.result.design)


def _draw_mass(answer: Answer, _: None) -> Any:
    from .. import figures

    return figures.mass_by_part(answer.result)


def _draw_modes(answer: Answer, tables: tuple[ModeTable, ModeTable]) -> Any:
    from .. import figures

    return figures.modes_before_after(*tables, answer.result.stability_margin)


def _draw_chart(answer: Answer, charts: tuple[StabilityChart, StabilityChart | None]) -> Any:
    from ..figures.chart import chart as draw

    return draw(charts[0], neutral=charts[1])


def _draw_region(answer: Answer, region: FeasibleRegion) -> Any:
    from .. import figures

    return figures.region(region)


def _draw_tornado(answer: Answer, _: None) -> Any:
    from .. import figures

    return figures.tornado(answer.result)


def _draw_decay(answer: Answer, shown: tuple[Trajectory, np.ndarray, np.ndarray]) -> Any:
    from .. import figures

    motion, speeds, ratios = shown
    return figures.decay(motion, answer.result.decay, speeds, ratios)


def _nothing(answer: Answer) -> None:
    """The result holds all that is drawn."""


_FIGURES = (
    DesignFigure(
        "linkage",
        "The linkage, to scale",
        "The parts at rest from the side, from above and from behind.",
        _nothing,
        _draw_linkage,
    ),
    DesignFigure("mass", "Mass by part", "Fittings included.", _nothing, _draw_mass),
    DesignFigure(
        "modes",
        "Modes over speed",
        "Decay rate and frequency of each mode, before (the start) and after; the margin is dashed.",
        _modes,
        _draw_modes,
    ),
    DesignFigure(
        "chart",
        "Stability chart",
        "Where the margin is kept over damping and spring, at three speeds; the star is the design.",
        _charts,
        _draw_chart,
    ),
    DesignFigure(
        "region",
        "What bounds the design",
        "Limits and lines of equal mass in the same plane, at the worst speed; without the damping ratio, and "
        "without the decay of elastic parts.",
        _region,
        _draw_region,
    ),
    DesignFigure("decay", "Decay", "The worst motion, and the amplitude that is left over speed.", _decay, _draw_decay),
    DesignFigure(
        "tornado",
        "What the mass depends on",
        "First derivatives at the optimum, from its multipliers.",
        _nothing,
        _draw_tornado,
    ),
)


# files: what is known is written before anything is drawn, and a figure that fails costs nothing but itself


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
    if result.bound is not None and result.bound.certificate is not None:
        (place / BOUND_FILE).write_text(json.dumps(result.bound.certificate, allow_nan=False) + "\n", encoding="utf-8")
    if result.stability is None:
        return
    answer = Answer.of(study, result)
    write_modes(place / "modes.csv", answer.modes)
    if figures:
        _save({figure.name: _drawing(figure, answer) for figure in figures_of(result)}, place)


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
    several = len(tables) > 1
    _save({f"modes-{table.load / 1e3:g}kN" if several else "modes": _drawing_of(table, margin) for table in tables}, place)


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

    def drawn() -> Any:
        from ..figures.chart import chart as draw

        return draw(record, filled, neutral=neutral)

    write_chart(place / "chart.csv", record)
    write_chart_json(place / "chart.json", record)
    if filled is not None:
        np.savez_compressed(place / "map.npz", x=filled.x, y=filled.y, values=filled.values, quantity=np.array(filled.quantity))
    _save({"chart": drawn}, place)


def write_tyre_files(place: Path, record: TyreCurves) -> None:
    """Tables of a tyre as CSV, and its figures.

    Parameters
    ----------
    place : Path
        Folder.
    record : TyreCurves
    """

    def drawing(name: str) -> Callable[[], Any]:
        def drawn() -> Any:
            from .. import figures

            return getattr(figures, name)(record)

        return drawn

    write_tyre(place, record)
    figures = {"slip": drawing("tyre_over_slip"), "load": drawing("tyre_over_load")}
    if record.response is not None:
        write_response(place / "tyre-response.csv", record.response)
        figures["response"] = drawing("tyre_over_path")
    _save(figures, place)


def _drawing(figure: DesignFigure, answer: Answer) -> Callable[[], Any]:
    return lambda: figure.drawn(answer)


def _drawing_of(table: ModeTable, margin: float) -> Callable[[], Any]:
    def drawn() -> Any:
        from .. import figures

        return figures.modes_over_speed(table, margin, f"Modes over speed at {written(load=table.load)}")

    return drawn


def _save(drawings: dict[str, Callable[[], Any]], place: Path) -> None:
    from .. import figures

    figures.save_each(drawings, place)

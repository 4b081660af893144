"""All figures of the thesis in one folder with one page, and the claims of its text judged."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ...charts.chart import StabilityChart
from ...study.study import Study
from .charts import FIGURES, FORMS, ThesisFigure, misprints, trace_figure
from .claims import CHART_CLAIMS, Claim, Verdict
from .response_claims import RESPONSE_CLAIMS
from .responses import RESPONSES, Response, ThesisResponse, respond

__all__ = ["RESPONSE_FORMS", "Row", "judge", "panels", "write_thesis"]

RESPONSE_FORMS = ("published", "spatial")
"""Geometries in which responses are drawn: printed formulas, and the linkage in space that stands for the multibody model."""

STRUT = "strut"
"""The form of Thota's gear: stiffness and damping of the strut itself, no layout."""

MISPRINTED = ("3.5", "3.12", "3.23")
"""Figures that show what each misprint does."""

SCARCELY = 0.05
"""Part of the plane below which a chart says nothing."""

REMEMBERS = (
    "With contact memory: without it (planar) it may hold. At 40 m/s a large part of the plane then needs little damping or "
    "none, and comparisons turn on what is left."
)
"""Why a claim differs in the form `memory`, where no other reason is known."""

CLAIMS = {**CHART_CLAIMS, **RESPONSE_CLAIMS}

Shown = StabilityChart | Sequence[Response]


@dataclass(frozen=True)
class Row:
    """A claim about a figure in one form, with its verdict and, where it differs, the reason."""

    figure: str
    form: str
    claim: str
    verdict: Verdict
    why: str


@dataclass(frozen=True)
class _Section:
    """What the page says of one figure."""

    number: str
    words: str
    images: Mapping[str, str]
    claims: Mapping[str, Sequence[Row]]
    misprints: Mapping[str, float]


def judge(figure: str, form: str, claim: Claim, *shown: Shown) -> Row:
    """Put a claim to the figure, and to the one that it is compared with.

    Parameters
    ----------
    figure, form : str
    claim : Claim
    *shown : StabilityChart or sequence of Response
        The figure's, then the other's if there is one.

    Returns
    -------
    Row
    """
    if any(isinstance(one, StabilityChart) and _stable_part(one) < SCARCELY for one in shown):
        verdict = Verdict(False, "next to nothing is stable")
        return Row(figure, form, claim.text, verdict, "The misprinted coefficients (erratum 5) are those of an unstable gear.")
    verdict = claim.holds(*shown)
    reason = claim.why_not or (REMEMBERS if form == "memory" else "")
    return Row(figure, form, claim.text, verdict, "" if verdict.agrees else reason)


def _stable_part(record: StabilityChart) -> float:
    """Of the plane, for the most stable family."""
    x, y = (np.linspace(a.low, a.high, 41)[1::2] for a in (record.x, record.y))
    X, Y = np.meshgrid(x, y)
    return max(float(record.stable(X, Y, k).mean()) for k in range(len(record.families)))


def panels() -> list[tuple[ThesisFigure | ThesisResponse, str]]:
    """Every figure in each form that it is drawn in, in the order of the page."""
    charts = [(figure, form) for figure in FIGURES for form in FORMS]
    return charts + [
        (figure, form) for figure in RESPONSES for form in (RESPONSE_FORMS if figure.topology != "rotational" else (STRUT,))
    ]


def write_thesis(
    place: Path, study: Study, pool: Executor | None = None, on_panel: Callable[[str], Any] = lambda number: None
) -> list[Row]:
    """Draw all figures into a folder with a page `index.html` and the table `claims.csv`.

    Parameters
    ----------
    place : Path
        Folder, which exists.
    study : Study
        The thesis' main gear.
    pool : Executor or None
        That draws the figures; None: this process.
    on_panel : callable
        Called with the number of a figure when one of its panels is drawn.

    Returns
    -------
    list of Row
        In the order of the page.
    """
    drawn: dict[str, dict[str, Shown]] = {}
    todo = panels()
    for (figure, form), shown in zip(todo, (pool.map if pool else map)(partial(_panel, place, study), todo), strict=True):
        drawn.setdefault(figure.number, {})[form] = shown
        on_panel(figure.number)
    sections = [
        _Section(
            figure.number,
            _words(figure),
            {form: f"{_name(figure, form)}.png" for form in drawn[figure.number]},
            {claim.text: _rows(figure.number, claim, drawn) for claim in CLAIMS.get(figure.number, ())},
            misprints(figure, study) if isinstance(figure, ThesisFigure) and figure.number in MISPRINTED else {},
        )
        for figure in (*FIGURES, *RESPONSES)
    ]
    rows = [row for section in sections for rows in section.claims.values() for row in rows]
    _write_page(place / "index.html", sections, rows)
    _write_table(place / "claims.csv", rows)
    return rows


def _panel(place: Path, study: Study, todo: tuple[ThesisFigure | ThesisResponse, str]) -> Shown:
    from ...figures import save_each
    from ...figures.chart import chart as draw
    from .drawing import response

    figure, form = todo
    if isinstance(figure, ThesisResponse):
        found = respond(figure, study, form)
        save_each({_name(figure, form): lambda: response(figure, found)}, place)
        return found
    record = trace_figure(figure, study, form)
    save_each({_name(figure, form): lambda: draw(record)}, place)
    return record


def _name(figure: ThesisFigure | ThesisResponse, form: str) -> str:
    return f"figure-{figure.number}-{form}"


def _rows(number: str, claim: Claim, drawn: Mapping[str, Mapping[str, Shown]]) -> list[Row]:
    """A row for each form of the figure."""
    others = [drawn[claim.against]] if claim.against else []
    return [judge(number, form, claim, *(shown[form] for shown in (drawn[number], *others))) for form in drawn[number]]


def _words(figure: ThesisFigure | ThesisResponse) -> str:
    if isinstance(figure, ThesisResponse):
        return f"{figure.topology}: response at {figure.speed:g} m/s, {figure.load / 1e3:g} kN"
    varied = "" if figure.vary is None else f", {figure.vary[0].split('.')[-1].replace('_', ' ')} varied"
    speed = "" if "speed" in (figure.x[0], (figure.vary or ("",))[0]) else f", {figure.speed:g} m/s"
    return f"{figure.topology}: {figure.y[0]} over {figure.x[0]}{varied}{speed}"


def _write_page(path: Path, sections: Sequence[_Section], rows: Sequence[Row]) -> None:
    import jinja2

    forms = list(dict.fromkeys(row.form for row in rows))
    counts = {form: [row.verdict.agrees for row in rows if row.form == form] for form in forms}
    template = Path(__file__).with_name("page.html").read_text(encoding="utf-8")
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    path.write_text(environment.from_string(template).render(sections=sections, counts=counts), encoding="utf-8")


def _write_table(path: Path, rows: Sequence[Row]) -> None:
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["figure", "form", "claim", "agrees", "numbers", "why_not"])
        for row in rows:
            writer.writerow([row.figure, row.form, row.claim, row.verdict.agrees, row.verdict.numbers, row.why])

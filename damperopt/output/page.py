"""The page of a report: one HTML file that needs nothing else."""

from __future__ import annotations

import base64
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import yaml

from ..answers.stock import candidate_cells, stock_words
from ..errors import ConfigError
from ..optimum.left_out import left_out_by_number
from ..results import DesignResult, load_result
from ..study.scope import covers, leaves_out
from ..study.study import Study
from . import facts, margins, words
from .gallery import Answer, DesignFigure, figures_of

__all__ = ["report_of", "write_report"]


def report_of(results: Sequence[DesignResult], folder: Path | None = None) -> str:
    """HTML of a report on the first of some results, ranked, with a table of all.

    Parameters
    ----------
    results : sequence of DesignResult
        At least one, best first.
    folder : Path or None
        With the figures as SVG; what is not there is drawn.

    Returns
    -------
    str

    Raises
    ------
    ConfigError
        If a result does not hold the study that it answers.
    """
    import jinja2

    best = results[0]
    study = _study_of(best)
    answer = Answer.of(study, best) if best.stability is not None else None
    template = Path(__file__).with_name("report.html").read_text(encoding="utf-8")
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    environment.filters["input_words"] = words.input_words
    return environment.from_string(template).render(
        result=best,
        results=results,
        words=words,
        stock_words=stock_words,
        candidate_cells=candidate_cells,
        asked=words.asked(study),
        covers=best.covers or covers(study),
        leaves_out=_leaves_out(study, best),
        design=words.design_rows(study, best),
        constraints=words.constraint_rows(best),
        loads=margins.load_cases(best),
        peaks=margins.peak_rows(study, best),
        critical=margins.critical_margins(best),
        unchecked=margins.unchecked(best),
        by_case=margins.margins_by_case(best),
        parts=margins.parts_list(best, facts.sizes(study, best)) if answer else [],
        damping=words.damping_rows(facts.least_damping(answer.modes)) if answer else [],
        beyond=words.beyond(study, facts.next_critical_speed(study, answer.model.at(best.design))) if answer else "",
        figures=[(figure, _embedded(figure, answer, folder)) for figure in figures_of(best)] if answer else [],
        assumptions=words.assumptions(study, best),
        config=yaml.safe_dump(_without_nothing(best.config), sort_keys=False, allow_unicode=True),
    )


def _study_of(result: DesignResult) -> Study:
    """The study that a result answers; refused where the two do not belong together."""
    try:
        study = Study.model_validate(_without_nothing(result.config))  # version 0.1 wrote empty keys of all layouts
    except ValueError:
        raise ConfigError(f"{result.study}: the result does not hold its study; allowed: a result.json of 'optimise'") from None
    pairs: list[tuple[str, Any, Any]] = [
        ("study", result.study, study.name),
        ("topology", result.topology, study.damper.topology),
        ("geometry", result.geometry, study.damper.geometry),
        ("material", result.material, study.material.name),
        ("stability_margin", result.stability_margin, study.required.stability_margin),
    ]
    if result.design:
        pairs.append(("design", sorted(result.design), sorted(study.start)))
    if result.mass is not None:
        pairs.append(("decay", result.decay is not None, study.required.decay is not None))
    if result.certificate is not None:
        pairs.append(("certificate.speed", result.certificate.speed, (study.envelope.speed.min, study.envelope.speed.max)))
        factors = study.damper.damping_factors()
        pairs.append(("certificate.damping", result.certificate.damping, None if factors == (1.0, 1.0) else factors))
        pairs.append(("certificate.loads", result.certificate.loads, tuple(study.envelope.loads)))
    for key, found, wanted in pairs:
        if found != wanted:
            raise ConfigError(
                f"result.json: {key}: found {str(found)[:80]}; allowed: {str(wanted)[:80]}, as its own study says "
                "(the file was changed after 'optimise' wrote it)"
            )
    return study


def _leaves_out(study: Study, result: DesignResult) -> tuple[str, ...]:
    """What the proof is not about; of a result that does not hold it, by the study."""
    if result.leaves_out or not result.design:
        return result.leaves_out
    return (*left_out_by_number(study, result.design), *leaves_out(study))


def write_report(folder: str | Path) -> Path:
    """Write ``report.html`` into the folder of an optimisation.

    Parameters
    ----------
    folder : str or Path
        With ``result.json``, or with a folder for each combination.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ConfigError
        If the folder holds no result.
    """
    folder = Path(folder)
    single = folder / "result.json"  # of a ranking the best, beside the folders of all
    files = sorted(folder.glob("[0-9]*/result.json")) or [single]
    if not files[0].is_file():
        raise ConfigError(f"{folder}: holds no result.json; allowed: a folder of 'damperopt optimise'")
    text = report_of([load_result(file) for file in files], files[0].parent)
    page = folder / "report.html"
    unfinished = folder / ".report.part"
    unfinished.write_text(text, encoding="utf-8")
    unfinished.replace(page)
    return page


def _embedded(figure: DesignFigure, answer: Answer, folder: Path | None) -> str:
    """A figure as a data address; empty where it cannot be drawn."""
    stored = folder / f"{figure.name}.svg" if folder else None
    if stored is not None and stored.is_file():
        svg = stored.read_bytes()
    else:
        from ..figures import save_each

        with tempfile.TemporaryDirectory(prefix="damperopt-") as place:
            if save_each({figure.name: lambda: figure.drawn(answer)}, Path(place)):
                return ""
            svg = (Path(place) / f"{figure.name}.svg").read_bytes()
    return "data:image/svg+xml;base64," + base64.b64encode(svg).decode()


def _without_nothing(block: Any) -> Any:
    if not isinstance(block, dict):
        return block
    return {key: _without_nothing(value) for key, value in block.items() if value is not None}

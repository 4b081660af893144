"""The page of a report: one HTML file that needs nothing else."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from io import StringIO
from pathlib import Path
from typing import Any

import yaml

from ..errors import ConfigError
from ..results import DesignResult, load_result
from ..study.study import Study
from . import words
from .gallery import design_figures

__all__ = ["report_of", "write_report"]

CAPTIONS = {
    "linkage": ("The linkage, to scale", "Side and top view of the parts at rest."),
    "mass": ("Mass by part", "Fittings included."),
    "modes": (
        "Modes over speed",
        "Decay rate and frequency of each mode, before (the start) and after; the margin is dashed.",
    ),
    "chart": (
        "Stability chart",
        "Where the margin is kept over damping and spring, at three speeds; the star is the design.",
    ),
    "region": ("What bounds the design", "Limits and lines of equal mass in the same plane, at the worst speed."),
    "decay": ("Decay", "The worst motion, and the amplitude that is left over speed."),
    "tornado": ("What the mass depends on", "First derivatives at the optimum, from its multipliers."),
}

ASSUMPTIONS = (
    "Rigid airframe, constant vertical load, straight rolling at constant speed, one wheel.",
    "Mass and strength follow the sizing rules of the study page; they are estimates for comparison, not a stress report.",
    "The tyre is a stretched string, or its straight-tangent approximation, with the constants of the study.",
)


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
    try:
        study = Study.model_validate(best.config)
    except ValueError:
        raise ConfigError(f"{best.study}: the result does not hold its study; allowed: a result.json of 'optimise'") from None
    template = Path(__file__).with_name("report.html").read_text(encoding="utf-8")
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    return environment.from_string(template).render(
        result=best,
        results=results,
        words=words,
        asked=words.asked(study),
        design=words.design_rows(study, best),
        constraints=words.constraint_rows(best),
        figures=[(name, *CAPTIONS[name], _embedded(name, draw, folder)) for name, draw in design_figures(study, best).items()],
        assumptions=ASSUMPTIONS,
        config=yaml.safe_dump(_without_nothing(best.config), sort_keys=False, allow_unicode=True),
    )


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
    single = folder / "result.json"
    files = [single] if single.is_file() else sorted(folder.glob("[0-9]*/result.json"))
    if not files:
        raise ConfigError(f"{folder}: holds no result.json; allowed: a folder of 'damperopt optimise'")
    text = report_of([load_result(file) for file in files], files[0].parent)
    page = folder / "report.html"
    unfinished = folder / ".report.part"
    unfinished.write_text(text, encoding="utf-8")
    unfinished.replace(page)
    return page


def _embedded(name: str, draw: Any, folder: Path | None) -> str:
    """A figure as a data address."""
    stored = folder / f"{name}.svg" if folder else None
    if stored is not None and stored.is_file():
        svg = stored.read_text(encoding="utf-8")
    else:
        import matplotlib.pyplot as plt

        buffer, figure = StringIO(), draw()
        figure.savefig(buffer, format="svg", metadata={"Date": None})
        plt.close(figure)
        svg = buffer.getvalue()
    return "data:image/svg+xml;base64," + base64.b64encode(svg.encode()).decode()


def _without_nothing(block: Any) -> Any:
    if not isinstance(block, dict):
        return block
    return {key: _without_nothing(value) for key, value in block.items() if value is not None}

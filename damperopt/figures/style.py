"""The style that figures share, and how they are written."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib
import matplotlib.pyplot as plt
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG

from ..study.components import design_variables

__all__ = ["COLOURS", "STYLE", "plain", "quantity_words", "save", "save_each", "styled"]

logger = logging.getLogger("damperopt")

COLOURS = {"torsional": "#0b6e99", "lateral": "#c2571a", "string": "#6b6b6b"}
"""Of the modes of a gear; others take `OTHERS`."""

OTHERS = ("#7a5195", "#2f6b3a", "#b36b00", "#a11d33")
STYLE: Any = {
    "font.size": 10,
    "axes.grid": True,
    "grid.alpha": 0.25,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "figure.constrained_layout.use": True,
    "svg.hashsalt": "damperopt",
}
BLOCKS = ("gear", "tyre", "damper", "material", "requirements", "mass", "envelope")
"""Blocks of a study that say nothing of what their keys are."""

PNG_DPI = 150
LONGEST = 60
"""Characters of a name in a figure."""


@contextmanager
def styled() -> Iterator[None]:
    """Figures in the package's style; unlike `rc_context` it leaves alone what a notebook's backend sets."""
    before = {key: matplotlib.rcParams[key] for key in STYLE}
    matplotlib.rcParams.update(STYLE)
    try:
        yield
    finally:
        matplotlib.rcParams.update(before)


def plain(text: str) -> str:
    r"""Text of a user as a figure may show it: no formula, no control character, not too long.

    Parameters
    ----------
    text : str

    Returns
    -------
    str

    Examples
    --------
    >>> print(plain("cost $x_$ and $y$"))
    cost \$x_\$ and \$y\$
    """
    shown = "".join(c if c.isprintable() else " " for c in text).encode("utf-8", "replace").decode("utf-8").strip()
    if len(shown) > LONGEST:
        shown = shown[: LONGEST - 1] + "…"
    return (" " * shown.startswith("_") + shown).replace("$", r"\$")  # a label that starts with _ is hidden


def quantity_words(name: str) -> str:
    """A design variable or key path as the label of an axis: ``gear.lateral.stiffness`` is Lateral stiffness."""
    variable = design_variables().get(name)
    if variable is not None:
        words = variable.meaning or variable.name
        return f"{plain(words[:1].upper() + words[1:])} {variable.symbol}".strip()
    blocks, _, last = name.rpartition(".")
    block = blocks.rpartition(".")[2]
    says_enough = not block or (block in BLOCKS and "_" in last)
    return plain((last if says_enough else f"{block} {last}").replace("_", " ")).capitalize()


def save(figure: Any, folder: Path, name: str) -> list[Path]:
    """Write a figure as PNG and SVG and close it; returns both paths."""
    paths = [folder / f"{name}.png", folder / f"{name}.svg"]
    usual = figure.dpi
    try:
        figure.dpi = PNG_DPI  # the layout is found once and each file drawn once; `savefig` does both for each, twice
        FigureCanvasAgg(figure).print_png(paths[0])
        figure.dpi = usual
        figure.set_layout_engine("none")
        FigureCanvasSVG(figure).print_svg(paths[1], metadata={"Date": None})
    except Exception:  # whatever it was: half of a figure is none
        for path in paths:
            path.unlink(missing_ok=True)
        raise
    finally:
        plt.close(figure)
    return paths


def save_each(figures: Mapping[str, Callable[[], Any]], folder: Path) -> list[str]:
    """Draw and write figures; one that fails is a warning and costs nothing else.

    Parameters
    ----------
    figures : mapping of str to callable
        What draws each, by the name of its file.
    folder : Path

    Returns
    -------
    list of str
        Names of those that failed; why is logged as a warning, which without any set-up is a line on the error stream.
    """
    failed = []
    for name, draw in figures.items():
        try:
            save(draw(), folder, name)
        except Exception as error:  # whatever a drawing library raises: the data is worth more than its picture
            reason = " ".join(str(error).split())[:200]
            logger.warning("warning: the figure '%s' was not drawn: %s: %s", name, type(error).__name__, reason)
            failed.append(name)
    return failed

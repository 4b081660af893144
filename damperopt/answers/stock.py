"""Rows of a result on sizes that exist: what was chosen, what it costs, and what became of the others."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

from pydantic import ConfigDict

__all__ = ["StockCandidate", "StockResult", "candidate_cells", "stock_words"]

_FINITE = ConfigDict(allow_inf_nan=False, extra="forbid")


@dataclass(frozen=True)
class StockCandidate:
    """One choice of sizes, or several that were judged together.

    Attributes
    ----------
    parts : dict of str to str
        What each part is made of; a range where several sizes were judged together.
    combinations : int
        Choices that it stands for.
    outcome : str
        ``chosen``; ``heavier``; ``no design`` was found with it; ``not proved``: the optimum with it failed a check.
    mass : float or None
        Of its optimum [kg]; of several choices their bound.
    why : str
        Why it is out, in words.
    """

    __pydantic_config__: ClassVar[ConfigDict] = _FINITE

    parts: dict[str, str]
    combinations: int
    outcome: Literal["chosen", "heavier", "no design", "not proved"]
    mass: float | None = None
    why: str = ""


@dataclass(frozen=True)
class StockResult:
    """The search for the lightest design of sizes that exist.

    Attributes
    ----------
    continuous_mass : float or None
        Of the optimum with any size [kg]; None: there is none.
    price : float or None
        Mass of the chosen design over it [kg].
    chosen : dict of str to str
        What each part is made of; empty where nothing was found.
    changes : dict
        Of the study, by key path: what makes it that of the chosen sizes.
    candidates : tuple of StockCandidate
        The lightest first, those without a design last; together all combinations.
    combinations, solved : int
        Choices that the lists allow, and optima that were computed to decide between them.
    finished : bool
        False: interrupted, or given up.
    leaves_out : tuple of str
        What the search does not do, in words.
    """

    __pydantic_config__: ClassVar[ConfigDict] = _FINITE

    continuous_mass: float | None
    price: float | None
    chosen: dict[str, str]
    changes: dict[str, Any]
    candidates: tuple[StockCandidate, ...]
    combinations: int
    solved: int
    finished: bool
    leaves_out: tuple[str, ...] = field(default=())


def stock_words(stock: StockResult) -> str:
    """What was chosen, what it costs, and how far that is known, in sentences."""
    made = ", ".join(f"{part} {size}" for part, size in stock.chosen.items())
    found = f"Made of {made}" if made else "Nothing was chosen"
    if stock.price is not None:
        found += f": {stock.price:+.3f} kg beside the optimum of any size, {stock.continuous_mass:.3f} kg"
    judged = f"{stock.combinations} combinations judged by {stock.solved} optima"
    judged += "" if stock.finished else ", and not to the end"
    return f"{found}. {'; '.join((judged, *stock.leaves_out))}."


def candidate_cells(row: StockCandidate) -> tuple[str, str, str]:
    """Sizes, mass [kg], and why it is out."""
    sizes = ", ".join(f"{part} {size}" for part, size in row.parts.items())
    several = row.mass is not None and row.combinations > 1
    mass = "" if row.mass is None else f"{'>= ' if several else ''}{row.mass:.3f}"
    return sizes, mass, f"{row.outcome}: {row.why}" if row.why else row.outcome

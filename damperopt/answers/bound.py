"""A lower bound on the mass, and what it rests on: plain data of a result."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

from pydantic import ConfigDict

__all__ = ["MassBound", "bound_words"]


@dataclass(frozen=True)
class MassBound:
    """No design of the study that meets `proved` is lighter than this.

    Attributes
    ----------
    mass : float or None
        The bound [kg]; None: there is none, and `why` says why.
    gap : float or None
        Of the design that was found over the bound, in parts of the design's mass.
    covers : str
        What the bound is about, in one sentence.
    proved : tuple of str
        Requirements that it rests on.
    unused : tuple of str
        Requirements that it does not use: with them the least mass is this or more.
    heavier, shimmies : int
        Boxes in which every design is heavier, and in which every gear shimmies.
    finished : bool
        False: time was up before the gap that was asked for.
    why : str
        Why there is no bound.
    """

    __pydantic_config__: ClassVar[ConfigDict] = ConfigDict(allow_inf_nan=False, extra="forbid")

    mass: float | None = None
    gap: float | None = None
    covers: str = ""
    proved: tuple[str, ...] = ()
    unused: tuple[str, ...] = ()
    heavier: int = 0
    shimmies: int = 0
    finished: bool = True
    why: str = ""
    certificate: dict[str, Any] | None = field(default=None, repr=False, compare=False)
    """The tree, in a file of its own: `proof.optimality.check_bound` says its form."""


def bound_words(bound: MassBound) -> str:
    """The bound, the gap, and how they were obtained."""
    if bound.mass is None or bound.gap is None:
        return f"No lower bound on the mass: {bound.why}."
    words = f"No design is lighter than {bound.mass:.4g} kg ({100 * bound.gap:.2g} % below this one): {bound.covers}. "
    words += (
        f"{bound.heavier} boxes of designs weighed and {bound.shimmies} shown to shimmy, each checked with intervals and balls"
    )
    if bound.unused:
        words += f"; not used: {', '.join(bound.unused)}"
    return words + ("." if bound.finished else "; the search ended by time (solver.bound_seconds).")

"""Forms that a value takes while lines are laid about it, and the rule of each operation by name."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import casadi as ca
import numpy as np

from .intervals import Interval, of
from .lines import Line

__all__ = ["RULES", "Atom", "Piece", "Power", "Truth", "joined", "positive", "product"]


@dataclass(frozen=True)
class Atom:
    below: Line
    above: Line
    range: Interval
    at: np.ndarray
    """About its value at the place: where tangents are taken, no more."""


@dataclass(frozen=True)
class Truth:
    """Where a condition holds, and where it does not; neither: on a part of the box."""

    yes: Any
    no: Any


@dataclass(frozen=True)
class Piece:
    when: Truth
    value: Any


@dataclass(frozen=True)
class Power:
    """sign times e^(constant + sum of coefficient times atom).

    On boxes `open` the sign is not known, and nothing that follows holds but for a square: its logarithm is 2 `most` at most.
    `terms`: of a difference, which has lines of its own whatever its sign.
    """

    sign: int
    constant: Interval
    atoms: tuple[tuple[Any, Atom], ...]
    open: Any = False
    most: Any = None
    terms: tuple[Power, Power] | None = None


def product(c: Any, factor: float) -> Any:
    """A coefficient times a number."""
    return c * factor if isinstance(c, Interval) else of(c) * factor


def joined(first: tuple[tuple[Any, Atom], ...], second: tuple[tuple[Any, Atom], ...]) -> tuple[tuple[Any, Atom], ...]:
    """Coefficients of one atom added, so that what cancels does."""
    found = list(first)
    for c, atom in second:
        for i, (own, known) in enumerate(found):
            if known is atom:
                found[i] = (of(own) + c, atom)
                break
        else:
            found.append((c, atom))
    return tuple(found)


def positive(u: Power) -> Power:
    """The magnitude."""
    return replace(u, sign=1, terms=None)


RULES = {
    ca.OP_ASSIGN: "same",
    ca.OP_ADD: "plus",
    ca.OP_SUB: "minus",
    ca.OP_MUL: "times",
    ca.OP_DIV: "over",
    ca.OP_NEG: "negative",
    ca.OP_INV: "inverse",
    ca.OP_SQ: "square",
    ca.OP_TWICE: "twice",
    ca.OP_SQRT: "root",
    ca.OP_POW: "power",
    ca.OP_CONSTPOW: "power",
    ca.OP_LOG: "logarithm",
    ca.OP_EXP: "exponential",
    ca.OP_FABS: "magnitude",
    ca.OP_ASINH: "arsinh",
    ca.OP_FMAX: "larger",
    ca.OP_LT: "less",
    ca.OP_LE: "less",
    ca.OP_NOT: "is_not",
    ca.OP_IF_ELSE_ZERO: "if_else_zero",
}

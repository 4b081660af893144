"""Forms that a value takes while it is bounded, and the rule of each operation by name."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import casadi as ca

from .affine import Bounded

__all__ = ["METHODS", "OF_FLOATS", "Log", "Piece", "Truth"]


@dataclass(frozen=True)
class Log:
    """sign e^u with u = constant + sum of coefficient times atom.

    On boxes `open` the sign is not known, and nothing that follows holds but for a square: `most` is what u is at most there.
    A difference keeps its two `terms`: in itself, not in its logarithm, it has bounds whatever its sign.
    """

    sign: int
    constant: Any
    atoms: dict[int, tuple[Any, Bounded]]
    open: Any = False
    most: Any = None
    terms: tuple[Log, Log] | None = None

    def scaled(self, factor: Any, sign: int | None = None) -> Log:
        atoms = {key: (c * factor, atom) for key, (c, atom) in self.atoms.items()}
        return Log(self.sign if sign is None else sign, self.constant * factor, atoms, self.open)

    def plus(self, other: Log) -> Log:
        """Of a product."""
        atoms = dict(self.atoms)
        for key, (c, atom) in other.atoms.items():
            atoms[key] = (atoms[key][0] + c if key in atoms else c, atom)
        return Log(self.sign * other.sign, self.constant + other.constant, atoms, self.open | other.open)


@dataclass(frozen=True)
class Truth:
    """Where a condition holds, and where it does not; neither: on a part of the box."""

    yes: Any
    no: Any


@dataclass(frozen=True)
class Piece:
    """A value where a condition holds, else 0."""

    when: Truth
    value: Any


METHODS = {
    ca.OP_ASSIGN: "assign",
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
    ca.OP_SIN: "sine",
    ca.OP_COS: "cosine",
    ca.OP_FMAX: "larger",
    ca.OP_LT: "less",
    ca.OP_LE: "less",
    ca.OP_NOT: "is_not",
    ca.OP_IF_ELSE_ZERO: "if_else_zero",
}

OF_FLOATS: dict[int, Callable[..., float]] = {
    ca.OP_ADD: lambda a, b: a + b,
    ca.OP_SUB: lambda a, b: a - b,
    ca.OP_MUL: lambda a, b: a * b,
    ca.OP_DIV: lambda a, b: a / b,
    ca.OP_NEG: lambda a: -a,
    ca.OP_INV: lambda a: 1 / a,
    ca.OP_SQ: lambda a: a * a,
    ca.OP_SQRT: math.sqrt,
    ca.OP_POW: pow,
    ca.OP_CONSTPOW: pow,
    ca.OP_LT: lambda a, b: a < b,
    ca.OP_LE: lambda a, b: a <= b,
    ca.OP_NOT: lambda a: not a,
    ca.OP_IF_ELSE_ZERO: lambda a, b: b if a else 0.0,
}

"""Vectors of a program in named blocks, and the numbers that make one problem of it.

Variables, parameters and rows each are one vector to IPOPT. Which number stands where is known here alone: programs fill
the vectors, and solutions are read, by the names of the blocks.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca
import numpy as np

__all__ = ["Blocks", "Instance", "Limits", "instance_of"]


class Blocks:
    """A vector of named blocks.

    Parameters
    ----------
    **blocks : casadi.SX
        In their order; a matrix stands column by column, an empty one is allowed.

    Attributes
    ----------
    expression : casadi.SX
        The whole vector.
    """

    def __init__(self, **blocks: ca.SX):
        self.expression = ca.vertcat(ca.SX(0, 1), *(ca.vec(block) for block in blocks.values()))
        self._slices, begin = dict[str, slice](), 0
        for name, block in blocks.items():
            self._slices[name] = slice(begin, begin + block.numel())
            begin += block.numel()

    def size(self, name: str) -> int:
        """Numbers in a block; 0 if there is no such block."""
        place = self._slices.get(name, slice(0, 0))
        return int(place.stop - place.start)

    def part(self, vector: np.ndarray, name: str) -> np.ndarray:
        """One block of such a vector of numbers; empty if there is no such block."""
        return vector[self._slices.get(name, slice(0, 0))]

    def vector(self, **parts: np.ndarray) -> np.ndarray:
        """The vector of these blocks; each a scalar for all its numbers, or as many numbers as it has."""
        found = np.full(self.expression.numel(), np.nan)
        for name, place in self._slices.items():
            found[place] = parts.pop(name)
        if parts:
            raise KeyError(f"no block named {', '.join(parts)}; there are {', '.join(self._slices)}")
        return found


@dataclass(frozen=True)
class Limits:
    """Numbers of one block: where it starts and between what it lies; rows have no start."""

    lower: np.ndarray | float
    upper: np.ndarray | float
    start: np.ndarray | float = np.nan


@dataclass(frozen=True)
class Instance:
    """Numbers that turn a program into one problem: start, bounds and parameters."""

    x0: np.ndarray
    lbx: np.ndarray
    ubx: np.ndarray
    lbg: np.ndarray
    ubg: np.ndarray
    p: np.ndarray


def instance_of(
    variables: Blocks,
    rows: Blocks,
    parameters: Blocks,
    of_variables: Mapping[str, Limits],
    of_rows: Mapping[str, Limits],
    values: Mapping[str, np.ndarray],
) -> Instance:
    """The problem of a program whose vectors have these blocks.

    Parameters
    ----------
    variables, rows, parameters : Blocks
        Of the program.
    of_variables, of_rows : mapping of str to Limits
        By block.
    values : mapping of str to ndarray
        Parameters by block.

    Returns
    -------
    Instance
    """

    def each(blocks: Blocks, limits: Mapping[str, Limits], end: str) -> np.ndarray:
        return blocks.vector(**{name: getattr(limit, end) for name, limit in limits.items()})

    return Instance(
        x0=each(variables, of_variables, "start"),
        lbx=each(variables, of_variables, "lower"),
        ubx=each(variables, of_variables, "upper"),
        lbg=each(rows, of_rows, "lower"),
        ubg=each(rows, of_rows, "upper"),
        p=parameters.vector(**values),
    )

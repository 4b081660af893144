"""Uncertain damping in a proof: the factor on the design's damping as one more variable, in which the equations are linear.

A damper that moves with the gear enters with c; one that is in series with a compliance has the state d, d' = F/c, and enters
with 1/c, in one row. Which of the two holds is found out, and shown at further points as declared powers are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import flint

from ..errors import CertificateError
from ..stability.family import Powers
from .parts import parts_in_powers
from .rationals import decimal

__all__ = ["Interval", "Linear", "over_damping"]

Q: TypeAlias = flint.fmpq


@dataclass(frozen=True)
class Interval:
    """Least and largest factor on the damping, the decimals that they are written as."""

    factors: tuple[float, float]

    @classmethod
    def of(cls, study: Any) -> Interval | None:
        """That of a study; None where its damping is certain."""
        low, high = study.damper.damping_factors()
        return None if low == high == 1 else cls((low, high))


@dataclass(frozen=True)
class Linear:
    """The quantity in which the equations are linear.

    Attributes
    ----------
    inverse : bool
        Whether it is one over the factor, or the factor itself.
    interval : Interval
    """

    inverse: bool
    interval: Interval

    @property
    def ends(self) -> tuple[Q, Q]:
        """Of its range, ascending."""
        low, high = (self.linear_in(decimal(factor)) for factor in self.interval.factors)
        return (high, low) if self.inverse else (low, high)

    def linear_in(self, factor: Q) -> Q:
        """Its value at a factor."""
        return 1 / factor if self.inverse else factor

    def factor(self, value: Any) -> Any:
        """The factor at a value, exact or as a float; a float is kept within the interval."""
        found = 1 / value if self.inverse else value
        low, high = self.interval.factors
        return min(max(found, low), high) if isinstance(found, float) else found


def over_damping(
    matrix: Callable[[Q, Q], flint.fmpq_mat], speed_powers: Sequence[int], speeds: tuple[Q, Q], interval: Interval
) -> tuple[Linear, dict[tuple[int, int], flint.fmpq_mat]]:
    """Matrices of V^i g^j, j = 0 and 1, and what g is.

    Parameters
    ----------
    matrix : callable
        (V, factor) -> matrix.
    speed_powers : sequence of int
        Declared powers of V.
    speeds : tuple of fmpq
        Ends of the envelope.
    interval : Interval

    Raises
    ------
    CertificateError
        If the matrix is linear neither in the factor nor in its inverse.
    """
    powers = Powers(tuple(speed_powers), (0, 1))
    for linear in (Linear(True, interval), Linear(False, interval)):
        try:
            return linear, parts_in_powers(lambda V, g, by=linear: matrix(V, by.factor(g)), powers, speeds, linear.ends)  # type: ignore[misc]
        except CertificateError:
            continue
    raise CertificateError(
        "the equations are linear neither in the damping nor in its inverse: no certificate over an interval"
    )

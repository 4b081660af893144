"""A matrix of speed and load as exact coefficients of the powers that its components declare."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TypeAlias

import flint

from ..errors import CertificateError
from ..stability.family import Powers, coefficients

__all__ = ["inverse_of_powers", "parts_in_powers", "samples"]

Q: TypeAlias = flint.fmpq


def parts_in_powers(
    matrix: Callable[[Q, Q], flint.fmpq_mat], powers: Powers, speeds: tuple[Q, Q], loads: Sequence[Q]
) -> dict[tuple[int, int], flint.fmpq_mat]:
    """Matrices of V^i F^j, from samples; other points show whether that is all.

    Parameters
    ----------
    matrix : callable
        (V, F) -> matrix.
    powers : Powers
        Declared ones; without powers of the load, the parts are those at the one load given.
    speeds, loads : sequence of fmpq
        Ends of the envelope.

    Returns
    -------
    dict
        (i, j) -> matrix.

    Raises
    ------
    CertificateError
        If other powers occur.
    """
    low, high = speeds
    at_speeds = samples(powers.speed, speeds)
    V_0 = at_speeds[len(powers.speed) // 2]
    F_powers: tuple[int, ...] = (0,)
    at_loads = list(loads)[:1]
    if powers.load is not None:
        F_0 = _power_of_two(float(loads[-1]))
        F_powers, at_loads = powers.load, [F_0 / Q(2) ** k for k in range(len(powers.load))]
    by_speed, by_load = inverse_of_powers(powers.speed, speeds), _inverse(at_loads, F_powers)
    sampled = [coefficients([matrix(V, F) for V in at_speeds], by_speed) for F in at_loads]
    parts = {
        (i, j): part
        for i, samples in zip(powers.speed, zip(*sampled, strict=True), strict=True)
        for j, part in zip(F_powers, coefficients(list(samples), by_load), strict=True)
    }
    for V, F in {(low, loads[0]), (high, loads[-1]), (V_0 * Q(7, 5), (loads[0] + loads[-1] * 3) / 4)}:
        found = matrix(V, F)
        rebuilt = sum((part * (V**i * F**j) for (i, j), part in parts.items()), found - found)
        if rebuilt != found:
            raise CertificateError(
                f"the state matrix is no combination of the powers {list(powers.speed)} of V and {list(F_powers)} of "
                "F_z that its components declare: no certificate for this model"
            )
    return parts


def samples(powers: Sequence[int], speeds: tuple[Q, Q]) -> list[Q]:
    """Speeds in the envelope, as many as powers; powers of two, which keep the numbers short."""
    V_0 = _power_of_two(math.sqrt(float(speeds[0]) * float(speeds[1])))
    return [V_0 * Q(2) ** (k - len(powers) // 2) for k in range(len(powers))]


def inverse_of_powers(powers: Sequence[int], speeds: tuple[Q, Q]) -> list[list[Q]]:
    """Inverse of the matrix of powers of `samples`, as rows: what makes coefficients of values there."""
    return _inverse(samples(powers, speeds), powers)


def _power_of_two(value: float) -> Q:
    """The power of two next below a positive number."""
    return Q(2) ** math.floor(math.log2(value))


def _inverse(points: Sequence[Q], powers: Sequence[int]) -> list[list[Q]]:
    """Inverse of the matrix of powers at points, as rows."""
    inverse = flint.fmpq_mat([[point**i for i in powers] for point in points]).inv()
    return [[inverse[i, k] for k in range(len(points))] for i in range(len(points))]

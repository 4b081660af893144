"""Floquet multipliers of an orbit: what a cycle makes of a small disturbance, through all corners on the way."""

from __future__ import annotations

import numpy as np

from .newton import Corrected

__all__ = ["CRITICAL", "multipliers", "shape"]

CRITICAL = 1.0
"""Modulus beyond which a disturbance grows."""


def multipliers(found: Corrected, events: bool) -> np.ndarray:
    """Multipliers of the whole cycle, the largest first, without the one of 1 that a shift in time has.

    Parameters
    ----------
    found : Corrected
        A solved orbit.
    events : bool
        Whether its legs end at events. A disturbed motion meets a corner earlier or later: the duration of each leg gives way
        so that its end stays on the corner, which is what saltation matrices say.

    Returns
    -------
    ndarray
        (n - 1,) complex.
    """
    path = found.path
    n, S = path.legs[0].flow.n, path.closing
    before = np.eye(n)
    for k, leg in enumerate(found.legs):
        by_start, by_duration = leg.end[:, :n] @ before, leg.end[:, n]
        if events:
            gradient = found.gradients[k] if k < len(found.legs) - 1 else found.gradients[-1] * S
            by_start = by_start - np.outer(by_duration, gradient @ by_start) / (gradient @ by_duration)
        before = by_start
    values = np.linalg.eigvals(S[:, None] * before).astype(complex)
    # with events one is 0, as all motions end on the corner; else one is 1, a shift in time
    values = np.delete(values, np.abs(values - (0.0 if events else 1.0)).argmin())
    values = values ** (1 + path.half)
    return values[np.argsort(-np.abs(values), kind="stable")]


def shape(multiplier: complex) -> str:
    """What happens where this multiplier leaves the unit circle."""
    if abs(multiplier.imag) > 1e-3 * abs(multiplier):
        return "Neimark-Sacker"
    return "fold or loss of symmetry" if multiplier.real > 0 else "period doubling"

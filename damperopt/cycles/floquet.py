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
    # all motions end on the last corner, where one multiplier is 0; without corners one is 1, along the orbit
    taken = found.gradients[-1] if events else S * found.legs[-1].end[:, n]
    scales = np.sqrt((path.states**2).mean(axis=0))
    scales = np.where(scales > 0, scales, 1.0)
    taken = taken * scales if events else taken / scales
    across = np.linalg.svd(taken[None])[2][1:].T
    values = np.linalg.eigvals(across.T @ (S[:, None] * before * scales / scales[:, None]) @ across)
    values = values.astype(complex) ** (1 + path.half)
    return values[np.argsort(-np.abs(values), kind="stable")]


def shape(multiplier: complex) -> str:
    """What happens where this multiplier leaves the unit circle."""
    if abs(multiplier.imag) > 1e-3 * abs(multiplier):
        return "Neimark-Sacker"
    return "fold or loss of symmetry" if multiplier.real > 0 else "period doubling"

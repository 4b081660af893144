"""Least peak of the damper's torque over a box of stiffness, damping and lag, when the gear is let go from a static torque.

Of the Zener element k0 parallel to (k_M in series with c_M), k_M = kappa/tau - k0, c_M = k_M tau, in parts of the torque T:

    I psi'' = m - k0 psi,   m' = -k_M psi' - m/tau,   psi(0) = 1/k0,  psi'(0) = m(0) = 0,

and the damper carries (1 + k/K) T max m. At any one time m is at most its peak: over a box at least its value in the middle
less what its slopes make of the box.
"""

from __future__ import annotations

import numpy as np

__all__ = ["least_peak"]

TIMES, PERIODS = 48, 0.7
"""At which the peak is looked for, and what part of a period of the stiff gear they reach."""

LARGEST = 50.0
"""Logarithm of a number beyond which nothing is computed."""

STEP = 1e-4
"""Of logarithms, for slopes."""

BENT, BENDS = 1.25, 4.0
"""Factor on the slopes, for what they change over the box, and how it grows with the box."""

MOST = 0.3
"""Width of a logarithm beyond which nothing is known."""

PROGRAM = 1e-3
"""Relative: how far the closed form that sizes parts may lie below the exact peak."""


def least_peak(numbers: np.ndarray, inertia: float) -> tuple[np.ndarray, np.ndarray]:
    """ln of a lower bound of max m over boxes, and the time at which it is reached.

    Parameters
    ----------
    numbers : ndarray
        (m, 3, 2) ends of ln k0, ln kappa, ln tau.
    inertia : float
        [kg m^2]

    Returns
    -------
    tuple of ndarray
        (m,) -inf where the box is too large to tell; (m,) [s]
    """
    sized = np.isfinite(numbers).all(axis=(1, 2)) & (np.abs(numbers).max(axis=(1, 2)) < LARGEST)
    numbers = np.where(sized[:, None, None], numbers, 0.0)
    middle, radius = numbers.mean(axis=2), np.diff(numbers, axis=2)[..., 0] / 2
    k0, kappa, tau = np.exp(middle).T
    end = PERIODS * 2 * np.pi * np.sqrt(inertia / np.maximum(kappa / tau, k0))
    times = end[:, None] * np.linspace(0, 1, TIMES + 1)[1:]
    values = _torque(middle, times, inertia)
    best = values.argmax(axis=1)
    at = times[np.arange(len(times)), best]
    peak = values[np.arange(len(times)), best]
    least, widest = peak.copy(), 2 * radius.max(axis=1)
    for i in range(3):
        moved = middle.copy()
        moved[:, i] += STEP
        slope = (_torque(moved, at[:, None], inertia)[:, 0] - peak) / STEP
        least -= (BENT + BENDS * widest) * np.abs(slope) * radius[:, i]
    known = (least > 0) & (kappa / tau > k0) & (widest < MOST) & sized
    return np.where(known, np.log(np.where(known, least, 1.0)) + np.log1p(-PROGRAM), -np.inf), at


def _torque(numbers: np.ndarray, times: np.ndarray, inertia: float) -> np.ndarray:
    """m at times (m, t)."""
    k0, kappa, tau = np.exp(numbers).T
    A = np.zeros((len(numbers), 3, 3))
    A[:, 0, 1], A[:, 1, 0], A[:, 1, 2] = 1.0, -k0 / inertia, 1 / inertia
    A[:, 2, 1], A[:, 2, 2] = -(kappa / tau - k0), -1 / tau
    roots, modes = np.linalg.eig(A)
    start = np.zeros((len(numbers), 3, 1), dtype=complex)
    start[:, 0, 0] = 1 / k0
    parts = np.linalg.solve(modes, start)[..., 0] * modes[:, 2, :]
    return (parts[:, None, :] * np.exp(roots[:, None, :] * times[..., None])).sum(axis=2).real

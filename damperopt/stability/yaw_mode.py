"""The yaw mode of a gear: the oscillation in which the piston takes the largest part."""

from __future__ import annotations

from typing import Any

import numpy as np

from .gear import LinearGear

__all__ = ["yaw_mode", "yaw_modes"]


def yaw_mode(A: np.ndarray, angle: int, rate: int) -> tuple[complex, np.ndarray, np.ndarray]:
    """Eigenvalue of the yaw mode with its right and left eigenvectors.

    Parameters
    ----------
    A : ndarray
        (n, n) state matrix.
    angle, rate : int
        Positions of the yaw angle and its rate.

    Returns
    -------
    tuple
        s, v, w with A v = s v, w A = s w and w v = 1; s is nan where nothing oscillates.
    """
    roots, right = np.linalg.eig(A)
    left = np.linalg.inv(right)
    # participation of both states of yaw, which no unit of a state changes, in that of all: where two real roots meet and part
    # as a pair, all of them grow without bound
    shares = np.abs(right.T * left)
    part = (shares[:, angle] + shares[:, rate]) / shares.sum(axis=1)
    part[roots.imag <= 0] = -1.0
    i = int(part.argmax())
    s = complex(roots[i]) if part[i] >= 0 else complex(np.nan, np.nan)
    return s, right[:, i], left[i]


def yaw_modes(gear: LinearGear, speeds: Any, loads: Any) -> np.ndarray:
    """Eigenvalues of the yaw mode.

    Parameters
    ----------
    gear : LinearGear
    speeds, loads : array_like
        (m,) or scalar [m/s], [N].

    Returns
    -------
    ndarray
        (m,) [1/s]; nan where the yaw does not oscillate.

    Examples
    --------
    >>> import damperopt
    >>> gear = damperopt.linear_gear(damperopt.load("configs/nose_gear_thota.yaml"))
    >>> s = yaw_modes(gear, [40.0], 150e3)[0]
    >>> f"{s:.2f}"
    '1.32+70.87j'
    """
    roots, shares = gear.modes(speeds, loads, 1)  # the last may be the lower half of a pair
    names = [state.name for state in gear.principal]
    part = shares[:, names.index("yaw_angle")] + shares[:, names.index("yaw_rate")]
    # a line with memory has roots of its own without end; those of the gear are the rightmost, as many as without it
    last = np.sort(roots.real, axis=1)[:, -min(len(names), roots.shape[1])][:, None]
    part[(roots.imag <= 0) | (roots.real < last - 1e-9 * np.abs(last))] = -1.0
    top = part.argmax(axis=1)[:, None]
    found = np.take_along_axis(roots, top, axis=1)[:, 0]
    found[np.take_along_axis(part, top, axis=1)[:, 0] < 0] = complex(np.nan, np.nan)
    return found

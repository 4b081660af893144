"""Modes of a gear over speed: eigenvalues followed from speed to speed and named by what moves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from .stability import LinearGear

__all__ = ["ModeTable", "track_modes"]

FINE = 400


@dataclass(frozen=True)
class ModeTable:
    """Modes over speed at one load.

    Attributes
    ----------
    speeds : ndarray
        (m,) [m/s]
    load : float
        [N]
    names : tuple of str
        (n,) ``torsional``, ``lateral`` or ``string`` of each followed eigenvalue; a conjugate pair has one name.
    eigenvalues : ndarray
        (m, n) complex [1/s].
    """

    speeds: np.ndarray
    load: float
    names: tuple[str, ...]
    eigenvalues: np.ndarray

    @property
    def frequency(self) -> np.ndarray:
        """Damped frequency |Im|/(2 pi) [Hz], (m, n)."""
        return np.abs(self.eigenvalues.imag) / (2 * np.pi)

    @property
    def damping_ratio(self) -> np.ndarray:
        """-Re/|s|, (m, n); 1 for a decaying real root, -1 for a growing one."""
        return -self.eigenvalues.real / np.maximum(np.abs(self.eigenvalues), 1e-300)

    @property
    def abscissa(self) -> np.ndarray:
        """Spectral abscissa [1/s], (m,)."""
        return self.eigenvalues.real.max(axis=1)

    def upper_half(self) -> list[tuple[int, int]]:
        """(speed index, mode index) of every eigenvalue but the conjugates with a negative imaginary part."""
        keep = self.eigenvalues.imag >= -1e-9 * (1 + np.abs(self.eigenvalues))
        return [(i, j) for i, j in np.argwhere(keep).tolist()]


def track_modes(gear: LinearGear, speeds: np.ndarray, load: float) -> ModeTable:
    """Follow the eigenvalues over speed.

    Parameters
    ----------
    gear : LinearGear
    speeds : ndarray
        (m,) ascending [m/s].
    load : float
        Vertical load [N].

    Returns
    -------
    ModeTable

    Notes
    -----
    Between the given speeds others are added so that a mode moves little from one to the next; neighbours are matched by
    the least total distance to the linear extrapolation. Names come from participation factors (left times right
    eigenvector), summed over the speeds, so a mode keeps its name where two modes exchange their shapes.
    """
    speeds = np.asarray(speeds, float)
    between = np.geomspace(speeds[0], speeds[-1], FINE) if len(speeds) > 1 else speeds
    fine = np.unique(np.concatenate([speeds, np.clip(between, speeds[0], speeds[-1])]))
    values, right = np.linalg.eig(gear.matrices(fine, load))
    participation = np.abs(np.linalg.inv(right).transpose(0, 2, 1) * right)
    participation /= participation.sum(axis=1, keepdims=True)

    order = [np.argsort(values[0].imag + 1e-6 * values[0].real)]
    followed = [values[0][order[0]]]
    for k in range(1, len(fine)):
        guess = followed[-1]
        if k > 1:
            guess = guess + (followed[-1] - followed[-2]) * (fine[k] - fine[k - 1]) / (fine[k - 1] - fine[k - 2])
        _, match = linear_sum_assignment(np.abs(guess[:, None] - values[k][None, :]))
        order.append(match)
        followed.append(values[k][match])
    shares = np.mean([participation[k][:, order[k]] for k in range(len(fine))], axis=0)
    rows = np.searchsorted(fine, speeds)
    return ModeTable(speeds, load, _names(gear.state_names, shares), np.array(followed)[rows])


def _names(state_names: tuple[str, ...], shares: np.ndarray) -> tuple[str, ...]:
    """Name of each mode: the degree of freedom that takes part most, each as often as it has states."""
    freedom = {"yaw": "torsional", "bending": "lateral", "string": "string"}
    of_state = [freedom[name.split("_")[0]] for name in state_names]
    freedoms = list(dict.fromkeys(of_state))
    together = np.array([sum(shares[i] for i, f in enumerate(of_state) if f == name) for name in freedoms])
    rows = [freedoms.index(name) for name in of_state]
    _, chosen = linear_sum_assignment(-together[rows].T)
    return tuple(of_state[i] for i in chosen)

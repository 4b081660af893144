"""Modes of a gear over speed: eigenvalues followed from speed to speed and named by what moves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from ..quantities.named import State
from .gear import LinearGear

__all__ = ["ModeTable", "followed", "track_modes"]

FINE = 400
"""Speeds between the ends along which modes are followed, beside those asked for."""

MODES = {"yaw": "torsional", "bending": "lateral"}
"""What the field calls the modes of these degrees of freedom; others have the name of theirs."""

LONGEST_REACH = 3.0
"""Longest extrapolation, in steps of the last one: beyond, rounding errors would steer it."""


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
        (n,) ``torsional``, ``lateral``, ``string``, ``damper`` or another degree of freedom, of each followed eigenvalue; a
        conjugate pair has one name.
    eigenvalues : ndarray
        (m, n) complex [1/s].
    """

    speeds: np.ndarray
    load: float
    names: tuple[str, ...]
    eigenvalues: np.ndarray

    @property
    def frequency(self) -> np.ndarray:
        """Damped frequency abs(Im)/(2 pi) [Hz], (m, n)."""
        return np.abs(self.eigenvalues.imag) / (2 * np.pi)

    @property
    def damping_ratio(self) -> np.ndarray:
        """-Re/abs(s), (m, n); 1 for a decaying real root, -1 for a growing one."""
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
    between = np.clip(np.geomspace(speeds[0], speeds[-1], FINE), speeds[0], speeds[-1]) if len(speeds) > 1 else speeds
    fine = np.unique(np.concatenate([speeds, between]))
    values, participation = gear.modes(fine, load)
    columns, order = followed(fine, values, len(gear.principal))
    # named over the speeds between alone, so that the speeds asked for do not tip the balance
    own = np.searchsorted(fine, between)
    shares = np.mean([participation[k][:, order[k]] for k in own], axis=0)
    names = _names(gear.principal, shares, columns[own])
    more = _overtaking(fine, values, columns)
    eigenvalues = np.column_stack([columns, *more])
    return ModeTable(speeds, load, names + ("contact line",) * len(more), eigenvalues[np.searchsorted(fine, speeds)])


def followed(speeds: np.ndarray, values: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Some of the eigenvalues followed over speed.

    Parameters
    ----------
    speeds : ndarray
        (m,) ascending [m/s].
    values : ndarray
        (m, k) eigenvalues at each, in any order.
    count : int
        How many are followed.

    Returns
    -------
    tuple of ndarray
        (m, count) eigenvalues, each column one that is followed, and which of `values` they are at each speed.

    Notes
    -----
    Where there are more than are followed, those of a delay, the fastest speed begins: there the others lie far to the left.
    """
    if values.shape[1] > count:
        columns, order = _along(speeds[::-1], values[::-1], np.argsort(-values[-1].real)[:count])
        return columns[::-1], order[::-1]
    return _along(speeds, values, np.argsort(values[0].imag + 1e-6 * values[0].real))


def _along(speeds: np.ndarray, values: np.ndarray, first: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues followed from those of numbers `first` at the first speed on, and their numbers."""
    order = [first]
    followed = [values[0][first]]
    for k in range(1, len(speeds)):
        guess = followed[-1]
        ratio = (speeds[k] - speeds[k - 1]) / (speeds[k - 1] - speeds[k - 2]) if k > 1 else np.inf
        if ratio < LONGEST_REACH:
            guess = guess + (followed[-1] - followed[-2]) * ratio
        _, match = linear_sum_assignment(np.abs(guess[:, None] - values[k][None, :]))
        order.append(match)
        followed.append(values[k][match])
    return np.array(followed), np.array(order)


def _overtaking(speeds: np.ndarray, values: np.ndarray, columns: np.ndarray) -> list[np.ndarray]:
    """Eigenvalues (m,) that lie right of all that are followed at some speed, followed too, both of a pair."""
    more: list[np.ndarray] = []
    while len(more) < values.shape[1] - columns.shape[1]:
        beyond = values.real.max(axis=1) - np.column_stack([columns, *more]).real.max(axis=1)
        at = int(beyond.argmax())
        if beyond[at] <= 1e-9 * (1 + np.abs(values[at]).max()):
            break
        top = values[at].real.max()
        first = np.flatnonzero(values[at].real >= top - 1e-9 * (1 + abs(top)))
        after, _ = _along(speeds[at:], values[at:], first)
        before, _ = _along(speeds[at::-1], values[at::-1], first)
        more += list(np.vstack([before[:0:-1], after]).T)
    return more


def _names(states: tuple[State, ...], shares: np.ndarray, followed: np.ndarray) -> tuple[str, ...]:
    """Name of each mode: the degree of freedom that takes part most, each as often as it has states.

    Conjugate pairs choose first, among the degrees of freedom with two states, so that both roots have one name; the real
    roots share what is left.
    """
    of_state = [MODES.get(state.freedom, state.freedom) for state in states]
    freedoms = list(dict.fromkeys(of_state))
    together = np.array([sum(shares[i] for i, f in enumerate(of_state) if f == name) for name in freedoms])

    names: dict[int, str] = {}
    pairs = _conjugate_pairs(followed)
    double = [i for i, name in enumerate(freedoms) if of_state.count(name) == 2]
    worth = np.array([[together[i, j] + together[i, k] for i in double] for j, k in pairs]).reshape(len(pairs), len(double))
    for row, column in zip(*linear_sum_assignment(-worth), strict=True):
        names |= dict.fromkeys(pairs[row], freedoms[double[column]])
    left = list(of_state)
    for name in names.values():
        left.remove(name)
    single = [j for j in range(len(of_state)) if j not in names]
    worth = np.array([[together[freedoms.index(name), j] for name in left] for j in single]).reshape(len(single), len(left))
    for row, column in zip(*linear_sum_assignment(-worth), strict=True):
        names[single[row]] = left[column]
    return tuple(names[j] for j in range(len(of_state)))


def _conjugate_pairs(followed: np.ndarray) -> list[tuple[int, int]]:
    """Pairs of columns that are conjugate, and not real, at most speeds."""
    n = followed.shape[1]
    size = 1e-9 * (1 + np.abs(followed))
    pairs: list[tuple[int, int]] = []
    for j in range(n):
        for k in range(j + 1, n):
            conjugate = (np.abs(followed[:, j] - followed[:, k].conj()) < size[:, j]) & (
                np.abs(followed[:, j].imag) > size[:, j]
            )
            if conjugate.mean() > 0.5:
                pairs.append((j, k))
    return pairs

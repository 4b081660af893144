"""One gear with one design as a linear model: state matrices, eigenvalues, spectral abscissa at any speed and load."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..quantities.named import State
from .family import Powers

__all__ = ["LinearGear", "parts", "spectral_abscissa"]


@dataclass(frozen=True)
class LinearGear:
    """State matrices of one gear with one design.

    Attributes
    ----------
    matrices : callable
        (speeds, loads), each (m,) or scalar [m/s], [N] -> (m, n, n) state matrices.
    states : tuple of State
        Declarations of the n states.
    powers : Powers
        Powers of speed and load in the matrices.
    """

    matrices: Callable[[Any, Any], np.ndarray]
    states: tuple[State, ...]
    powers: Powers = field(default_factory=Powers)

    @property
    def state_names(self) -> tuple[str, ...]:
        """Names of the states."""
        return tuple(state.name for state in self.states)

    def index(self, name: str) -> int:
        """Position of a state."""
        return self.state_names.index(name)

    def visible(self, speed: float, load: float) -> tuple[np.ndarray, tuple[str, ...]]:
        """State matrix [1/s] at one speed and load without hidden states, which set no time scale, and names of the rest."""
        kept = [i for i, state in enumerate(self.states) if not state.hidden]
        return self.matrices(speed, load)[0][np.ix_(kept, kept)], tuple(self.states[i].name for i in kept)

    def roots(self, speeds: Any, loads: Any, count: int | None = None) -> np.ndarray:
        """Eigenvalues [1/s], (m, count), from right to left; all n, if no count is given."""
        found = np.linalg.eigvals(self.matrices(speeds, loads)).astype(complex)
        return np.take_along_axis(found, np.argsort(-found.real, axis=1), axis=1)[:, :count]

    @property
    def principal(self) -> tuple[State, ...]:
        """Declarations of the states that modes are named by: all of them."""
        return self.states

    def modes(self, speeds: Any, loads: Any, spare: int = 0) -> tuple[np.ndarray, np.ndarray]:
        """Eigenvalues (m, k) [1/s], and how each principal state takes part in them (left times right vector), (m, n, k).

        There are as many as principal states; with a delay, which has roots without end, and `spare` is how many more.
        """
        values, right = np.linalg.eig(self.matrices(speeds, loads))
        # pinv, since a defective matrix (coincident roots) has no inverse of its eigenvectors
        return values, parts(np.linalg.pinv(right).transpose(0, 2, 1) * right)

    def abscissa(self, speeds: Any, loads: Any) -> np.ndarray:
        """Spectral abscissa [1/s], (m,)."""
        return spectral_abscissa(self.matrices(speeds, loads))


def parts(shares: np.ndarray) -> np.ndarray:
    """Magnitudes of numbers (m, n, k), divided by their sums over n."""
    sizes = np.abs(shares)
    return sizes / np.maximum(sizes.sum(axis=1, keepdims=True), 1e-300)


def spectral_abscissa(A: np.ndarray) -> np.ndarray:
    """Largest real part of the eigenvalues of stacked matrices.

    Parameters
    ----------
    A : ndarray
        (..., n, n) [1/s]

    Returns
    -------
    ndarray
        (...) [1/s]

    Examples
    --------
    >>> float(spectral_abscissa(np.array([[0.0, 1.0], [-4.0, -0.6]])).round(6))
    -0.3
    """
    return np.linalg.eigvals(A).real.max(axis=-1)

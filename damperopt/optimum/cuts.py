"""Quadratic models of the decay ratio and of peaks about one design: what the program knows of the transients."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

__all__ = ["Cut"]


@dataclass(frozen=True)
class Cut:
    """ln(decay ratio), or ln(peak), at one speed and load about one design.

    Attributes
    ----------
    speed, load : float
        [m/s], [N]
    value : float
        At the centre.
    gradient, centre : ndarray
        (n,) with respect to the scaled design variables, and where it was taken.
    curvature : ndarray
        (n, n) approximate second derivatives.
    """

    speed: float
    load: float
    value: float
    gradient: np.ndarray
    centre: np.ndarray
    curvature: np.ndarray

    def at(self, x: np.ndarray) -> float:
        """Its value at scaled design variables."""
        step = x - self.centre
        return float(self.value + self.gradient @ step + step @ self.curvature @ step / 2)

    def about_zero(self) -> np.ndarray:
        """Value, gradient and curvature of the same function at x = 0, in one vector."""
        linear = self.gradient - self.curvature @ self.centre
        return np.concatenate([[self.at(0 * self.centre)], linear, self.curvature.ravel()])

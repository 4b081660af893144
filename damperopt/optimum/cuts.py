"""Quadratic models of the decay ratio and of peaks about one design: what the program knows of the transients."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

__all__ = ["CONSTANT", "Cut", "monomials"]

CONSTANT = 0
"""Which of `monomials` is 1: its coefficient is the value at x = 0."""


def monomials(x: Any) -> Any:
    """1, x and x_i x_j/2 of an expression, in the order of `Cut.about_zero`."""
    return ca.vertcat(1, x, ca.vec(x @ x.T) / 2)


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

    @classmethod
    def constant(cls, value: float, variables: int) -> Cut:
        """The same everywhere, as of no speed and load."""
        nothing = np.zeros(variables)
        return cls(np.nan, np.nan, value, nothing, nothing, np.zeros((variables, variables)))

    def at(self, x: np.ndarray) -> float:
        """Its value at scaled design variables."""
        step = x - self.centre
        return float(self.value + self.gradient @ step + step @ self.curvature @ step / 2)

    def about_zero(self) -> np.ndarray:
        """Value, gradient and curvature of the same function at x = 0: coefficients of `monomials`, in one vector."""
        linear = self.gradient - self.curvature @ self.centre
        return np.concatenate([[self.at(0 * self.centre)], linear, self.curvature.ravel()])

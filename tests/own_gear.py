"""A gear with its damper in plain numbers: string tyre led by its foremost point, and the chain by its compliance."""

from __future__ import annotations

import math
from typing import Any

import numpy as np


def state_matrix(V: float, gear: dict[str, float], chain: tuple[float, float, float], c: float, k_own: float) -> np.ndarray:
    """State matrix of psi, psi', delta, delta', y, d (without the lateral mode: psi, psi', y, d).

    Parameters
    ----------
    V : float
        [m/s]
    gear : dict
        I_z, e, F_z, C_Fa, C_Ma, a, sigma, kappa; of the lateral mode I_x, k_d, c_d, l_g. No rake.
    chain : tuple of float
        (c11, c12, c22): psi = c11 T - c12 F, e = c12 T - c22 F.
    c, k_own : float
        Of the damper [N s/m], and in series with it [N/m]: e = d + F/k_own, F = c d'.
    """
    c11, c12, c22 = chain
    soft = c22 + 1 / k_own - c12**2 / c11  # of the damper where the piston is held
    F_psi, F_d = c12 / c11 / soft, -1 / soft
    T_psi, T_d = 1 / c11 + c12 / c11 * F_psi, c12 / c11 * F_d
    g = gear
    lateral = "I_x" in g
    n = 6 if lateral else 4
    y, d = n - 2, n - 1
    A = np.zeros((n, n))
    A[0, 1] = 1
    A[1, 0], A[1, d] = -T_psi / g["I_z"], -T_d / g["I_z"]
    A[1, 1] = -g.get("kappa", 0.0) / V / g["I_z"]
    A[1, y] = -(g["e"] * g["C_Fa"] + g["C_Ma"]) / g["sigma"] / g["I_z"]
    A[y, 0], A[y, 1], A[y, y] = V, g["e"] - g["a"], -V / g["sigma"]
    A[d, 0], A[d, d] = F_psi / c, F_d / c
    if lateral:
        A[2, 3] = 1
        A[3, 0], A[3, 2], A[3, 3] = g["F_z"] * g["e"] / g["I_x"], -g["k_d"] / g["I_x"], -g["c_d"] / g["I_x"]
        A[3, y] = -g["l_g"] * g["C_Fa"] / g["sigma"] / g["I_x"]
        A[y, 3] = g["l_g"]
    return A


def damper_stiffness(
    design: dict[str, float], E: float = 207e9, beta: float = 1e9, dead: float = 0.02, length: float = 0.12
) -> float:
    """Both oil chambers at mid-stroke, 2 beta A/(s + dead), and the rod, E A/(2 s + length), in series [N/m]."""
    s = design["s_damper"]
    oil = 2 * beta * design["A_piston"] / (s + dead)
    rod = E * math.pi / 4 * design["rod_diameter"] ** 2 / (2 * s + length)
    return 1 / (1 / oil + 1 / rod)


def worst(matrices: Any) -> tuple[float, float]:
    """Largest real part, and least damping ratio of the mode in which the yaw takes the largest part."""
    abscissa, ratio = -math.inf, math.inf
    for A in matrices:
        roots, right = np.linalg.eig(A)
        left = np.linalg.inv(right)
        abscissa = max(abscissa, roots.real.max())
        share = [abs(right[0, i] * left[i, 0]) + abs(right[1, i] * left[i, 1]) for i in range(roots.size)]
        swings = [i for i in range(roots.size) if roots[i].imag > 1e-9]
        if swings:
            yaw = roots[max(swings, key=share.__getitem__)]
            ratio = min(ratio, -yaw.real / abs(yaw))
    return abscissa, ratio

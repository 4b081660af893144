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


def feet_on_beam(E: float, I: Any, L: Any, w: Any, across: Any) -> Any:
    """Of a unit force at the apex of two legs: feet bend and push the halves of a tube, wall a tenth, clamped in its middle."""
    q, halves = L / w, (across / w + 1 / 2, across / w - 1 / 2)
    A = np.sqrt(I * 16 * np.pi * 0.09 / (1 + 0.8**2))
    return sum(q**2 * (w / 2) ** 3 / (3 * E * I) + y**2 * (w / 2) / (E * A) for y in halves)


def chain_by_hand(
    topology: str, d: dict[str, Any], E: float, forms: tuple[str, str, str], arm_area: Any = None
) -> tuple[Any, Any, Any]:
    """(c11, c12, c22) by Castigliano's theorem, hinges half as wide as the links are long; floats or arrays.

    Energy of a unit lateral force at the apex and a force S of the damper; the same as `frame.compliance` but for the small
    parts that each leaves out.
    """
    links, support, root = forms
    L, ell = d["L"], d["L"] * np.sin(d["gamma"])
    w = L / 2
    leg = np.sqrt(L**2 + w**2 / 4)
    front = 3 / 5 * L**3 / (E * d["I_link"]) if links == "cantilever" else 2 * leg**3 / (E * d["A_link"] * w**2)
    if links == "a_frame":
        front = front + feet_on_beam(E, d["I_hinge"], L, w, 0.0)
    if topology == "boeing":
        k = d["k_lambda"]
        return (2 * front + 1 / k) / ell**2, 1 / k / ell, 1 / k + 0 * ell
    b, EI = d["b"], E * d["I_arm"]
    if topology == "arreaza":
        bent = L**3 / (3 * EI)
        if support == "a_frame":
            legs = [np.sqrt(L**2 + (b + y) ** 2) for y in (w / 2, -w / 2)]
            held = (legs[0] ** 3 + legs[1] ** 3) / (E * d["A_support"] * w**2) + feet_on_beam(E, d["I_foot"], L, w, b)
        elif root == "hinge_line":
            held = (3 / 5 * L**3 + L**2 * b) / (E * d["I_support"])
        else:
            held = 3 / 5 * np.sqrt(ell**2 + b**2) * ell**2 / (E * d["I_support"])
        return (front + bent) / ell**2, bent / ell, bent + held
    # V arm shear, N push of the arm; F lateral force at the apex, S damper: V = (F - 2 S b/l) L/l, N = S + V b/L
    l = np.sqrt(L**2 + b**2)
    V, N = (L / l, -2 * b * L / l**2), (b / l, 1 - 2 * b**2 / l**2)  # by F and by S
    q = (0.0, L / l)

    def energy(i: int, j: int) -> Any:
        """Twice that of the unit loads i and j together: arm, near half of the hinge line, far half, push."""
        near = V[i] * V[j] * l**2 * b + (V[i] * q[j] + V[j] * q[i]) * l * b**2 / 2 + q[i] * q[j] * b**3 / 3
        return (V[i] * V[j] * l**3 / 3 + near + q[i] * q[j] * b**3 / 3) / EI + N[i] * N[j] * l / (E * arm_area)

    return (front + energy(0, 0)) / ell**2, -energy(0, 1) / ell, energy(1, 1)


def state_matrices(speeds: np.ndarray, gear: dict[str, float], chain: Any, c: np.ndarray, k_own: np.ndarray) -> np.ndarray:
    """`state_matrix` of m designs at k speeds, (m, k, n, n)."""
    one = state_matrix(1.0, gear, (1.0, 0.5, 1.0), 1.0, 1.0)  # shape, and all that has neither speed nor design in it
    A = np.tile(one, (len(c), len(speeds), 1, 1))
    y, d = len(one) - 2, len(one) - 1
    c11, c12, c22 = chain
    soft = c22 + 1 / k_own - c12**2 / c11
    F_psi, F_d = c12 / c11 / soft, -1 / soft
    A[..., 1, 0] = -((1 / c11 + c12 / c11 * F_psi) / gear["I_z"])[:, None]
    A[..., 1, d] = -(c12 / c11 * F_d / gear["I_z"])[:, None]
    A[..., 1, 1] = -gear.get("kappa", 0.0) / speeds / gear["I_z"]
    A[..., y, 0], A[..., y, y] = speeds, -speeds / gear["sigma"]
    A[..., d, 0], A[..., d, d] = (F_psi / c)[:, None], (F_d / c)[:, None]
    return A


def least_of(A: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Largest real part, and least damping ratio of the yaw mode, of each design."""
    roots, right = np.linalg.eig(A)
    left = np.linalg.inv(right)
    share = np.abs(right[..., 0, :] * left[..., :, 0]) + np.abs(right[..., 1, :] * left[..., :, 1])
    share[roots.imag <= 1e-9] = -1.0
    yaw = np.take_along_axis(roots, share.argmax(-1)[..., None], -1)[..., 0]
    ratio = np.where(share.max(-1) > 0, -yaw.real / np.abs(yaw), np.inf)
    return roots.real.max(axis=(-1, -2)), ratio.min(axis=-1)


def released_force(T: float, inertia: float, chain: tuple[float, float, float], c: float, k_own: float) -> float:
    """Largest force of the damper after the chain is let go from the static torque T [N]: two modes and a root, summed."""
    c11, c12, c22 = chain
    soft = c22 + 1 / k_own - c12**2 / c11
    F_psi, F_d = c12 / c11 / soft, -1 / soft
    A = np.array(
        [[0, 1, 0], [-(1 / c11 + c12 / c11 * F_psi) / inertia, 0, -c12 / c11 * F_d / inertia], [F_psi / c, 0, F_d / c]]
    )
    roots, right = np.linalg.eig(A)
    parts = np.linalg.solve(right, np.array([c11 * T, 0, c12 * T])) * (np.array([F_psi, 0, F_d]) @ right)
    times = np.linspace(0, math.tau * math.sqrt(inertia * c11), 4001)
    return float(np.abs((np.exp(np.outer(times, roots)) @ parts).real).max())

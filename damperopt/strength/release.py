"""The largest force in the damper of an elastic chain that is let go from a static torque.

Yaw inertia I, stiffness K in front (of the links), k of spring or arm, and beside it the damping c with the stiffness k_s in
series; all about the yaw axis. Held by the torque T the dashpot is at rest; let go, three states move:

    I psi'' = -T_l,   T_l = K (psi - psi_l) = k psi_l + F,   F = k_s (psi_l - d) = c d'.

The motion is linear: steps of a rational approximation of the matrix exponential, good for stiff chains too, and between two
steps the cubic through force and rate. Compared with c psi_lim sqrt(k/I), the peak without any damping, it stays finite as c
grows: a damper cannot carry much more than the torque that was let go.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..expressions.calculus import Expr, sqrt, where

__all__ = ["peak_damper_torque"]

STEPS, PERIODS = 24, 0.6
"""Steps, and periods of the chain that they follow: the first peak is the largest."""

RIGID = 1e7
"""Stiffness of a rigid front over that of the spring."""

Vector = Sequence[Expr]
Matrix = Sequence[Vector]


def peak_damper_torque(torque: Expr, inertia: Expr, front: Expr, k: Expr, c: Expr, series: Expr) -> Expr:
    """Largest torque that the damper carries after the release [N m].

    Parameters
    ----------
    torque : Expr
        T, static [N m].
    inertia : Expr
        I [kg m^2].
    front, series : Expr
        K and k_s [N m/rad]; None: rigid, but not both.
    k, c : Expr
        [N m/rad], [N m s/rad]

    Returns
    -------
    Expr
    """
    # in units of T: torques; of T/k: angles p, p_l, d; of 1/omega: time
    kappa = RIGID if front is None else front / k
    z = c * sqrt(kappa / (1 + kappa) / (k * inertia))
    added = z if series is None else series / k * z**2 / ((series / k) ** 2 + z**2)  # by the damper, at that frequency
    omega = sqrt(k / inertia * (1 + added) * kappa / (kappa + 1 + added))
    zeta, mass = c * omega / k, inertia * omega**2 / k
    if series is None:  # the third state is p_l itself
        through, force = [kappa, 0.0, -kappa], [kappa, 0.0, -(kappa + 1)]
    else:
        sigma = series / k
        total = kappa + 1 + sigma
        through = [kappa * (1 + sigma) / total, 0.0, -kappa * sigma / total]
        force = [sigma * kappa / total, 0.0, -sigma * (kappa + 1) / total]
    motion = [[0.0, 1.0, 0.0], [-t / mass for t in through], [f / zeta for f in force]]
    h = 2 * math.pi * PERIODS / STEPS
    advance = _exponential([[h * entry for entry in row] for row in motion])
    states: list[Vector] = [[1 + 1 / kappa, 0.0, 1.0]]
    for _ in range(STEPS):
        states.append([_dot(row, states[-1]) for row in advance])
    slope = [-h * _dot(force, column) for column in zip(*motion, strict=True)]
    values, rates = [-_dot(force, x) for x in states], [_dot(slope, x) for x in states]
    peak: Expr = 0.0
    for v0, v1, r0, r1 in zip(values, values[1:], rates, rates[1:], strict=False):
        top = _top(v0, v1, r0, r1)
        peak = where(top > peak, top, peak)
    return torque * peak


def _top(v0: Expr, v1: Expr, r0: Expr, r1: Expr) -> Expr:
    """Largest value of the cubic with these values and slopes at 0 and 1, where it turns down between them; else 0."""
    turns = (r0 > 0) * (r1 <= 0)
    a, b = 2 * (v0 - v1) + r0 + r1, 3 * (v1 - v0) - 2 * r0 - r1
    a, b, r0 = where(turns, a, 0.0), where(turns, b, -1.0), where(turns, r0, 1.0)
    u = r0 / (sqrt(b**2 - 3 * a * r0) - b)
    return where(turns, v0 + u * (r0 + u * (b + u * a)), 0.0)


def _exponential(z: Matrix) -> Matrix:
    """exp(z) of a 3 x 3 matrix, (1 + 2z/5 + z^2/20)/(1 - 3z/5 + 3z^2/20 - z^3/60): what decays fast is damped out."""
    z2 = _product(z, z)
    z3 = _product(z2, z)
    one = [[float(i == j) for j in range(3)] for i in range(3)]
    above = _combined((1, one), (2 / 5, z), (1 / 20, z2))
    below = _combined((1, one), (-3 / 5, z), (3 / 20, z2), (-1 / 60, z3))
    return _product(_inverse(below), above)


def _dot(x: Sequence[Expr], y: Sequence[Expr]) -> Expr:
    return sum(a * b for a, b in zip(x, y, strict=True))


def _product(x: Matrix, y: Matrix) -> Matrix:
    columns = list(zip(*y, strict=True))
    return [[_dot(row, column) for column in columns] for row in x]


def _combined(*terms: tuple[float, Matrix]) -> Matrix:
    return [[sum(weight * matrix[i][j] for weight, matrix in terms) for j in range(3)] for i in range(3)]


def _inverse(m: Matrix) -> Matrix:
    def minor(i: int, j: int) -> Expr:
        (a, b), (c, d) = ([m[p % 3][q % 3] for q in (j + 1, j + 2)] for p in (i + 1, i + 2))
        return a * d - b * c

    determinant = _dot(m[0], [minor(0, j) for j in range(3)])
    return [[minor(j, i) / determinant for j in range(3)] for i in range(3)]

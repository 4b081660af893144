"""Characteristic coefficients of chapter 3, letter by letter as the thesis prints them, and what each of them lost.

The functions take any numbers: fractions, arrays or symbols. Where (3-16) to (3-20) and (3-33) to (3-36) write c_delta and
k_delta for the damper's damping and stiffness, c_lambda and k_lambda are read; c_y and k_y are lateral damping and stiffness.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np

from ...charts.plane import Plane

__all__ = ["COEFFICIENTS", "MISPRINTS", "PrintedPlane", "PrintedTreadMoment"]

Terms: TypeAlias = dict[str, dict[int, Any]]


def boeing(p: Any) -> list[Any]:
    """(3-15) to (3-20): [a_0, ..., a_5]."""
    ell2 = p.L**2 * p.sin_gamma**2
    trail = p.e * p.C_F - p.C_M
    a_1 = (p.I_z * p.V**2 - p.kappa * p.sigma + p.c_lambda * ell2 * p.V * p.sigma) / (p.I_z * p.sigma * p.V)
    a_2 = (
        p.I_z * (p.k_y * p.sigma + p.C_F * p.F_z * p.l_g**2)
        + p.I_x * (p.c_lambda * ell2 * p.V - p.kappa)
        + p.F_z * p.I_x * (p.e - p.a) * trail
    ) / (p.I_x * p.I_z * p.sigma)
    a_3 = (
        p.k_y * (p.I_z * p.V**2 - p.kappa * p.sigma)
        - p.C_F * p.F_z * p.kappa * p.l_g**2
        + p.F_z * p.I_x * p.V**2 * trail
        + ell2 * (p.I_x * p.k_lambda * p.V + p.c_lambda * (p.k_y * p.sigma + p.C_F * p.F_z * p.l_g**2))
    ) / (p.I_x * p.I_z * p.sigma * p.V)
    a_4 = (
        trail * (p.F_z**2 * p.e * p.l_g + p.F_z * p.k_y * (p.e - p.a))
        - p.k_y * p.kappa
        + ell2 * (p.k_y * (p.c_lambda * p.V + p.k_lambda) + p.C_F * p.F_z * p.k_lambda * p.l_g**2)
    ) / (p.I_x * p.I_z * p.sigma)
    a_5 = p.k_y * p.V * (p.k_lambda * ell2 + p.F_z * trail) / (p.I_x * p.I_z * p.sigma)
    return [1 + 0 * a_1, a_1, a_2, a_3, a_4, a_5]


def _boeing_misprints(p: Any) -> Terms:
    """Yaw stiffness in (3-17), a speed in (3-18), the relaxation length in (3-19)."""
    ell2 = p.L**2 * p.sin_gamma**2
    bracket = p.I_x * p.k_lambda * p.V + p.c_lambda * (p.k_y * p.sigma + p.C_F * p.F_z * p.l_g**2)
    return {
        "(3-17)": {2: p.k_lambda * ell2 / p.I_z},
        "(3-18)": {3: (p.V - 1) * ell2 * bracket / (p.I_x * p.I_z * p.sigma * p.V)},
        "(3-19)": {4: (p.sigma - 1) * p.k_y * p.k_lambda * ell2 / (p.I_x * p.I_z * p.sigma)},
    }


def utas(p: Any) -> list[Any]:
    """(3-32) to (3-37): [a_0, ..., a_5]."""
    ell = p.L * p.sin_gamma
    trail = p.e * p.C_F - p.C_M
    string = p.k_y * p.sigma + p.C_F * p.F_z * p.l_g**2
    a_0 = p.I_z * p.I_x * p.V * p.sigma
    a_1 = p.I_x * (p.I_z * p.V**2 - p.kappa * p.sigma + p.c_lambda * ell**2 * p.V * p.b * p.sigma / (10 * p.R))
    a_2 = (
        p.V * (p.I_z * p.k_y * p.sigma - p.I_x * p.kappa)
        + p.V * p.F_z * p.I_x * (p.e - p.a) * trail
        + p.C_F * p.F_z * p.I_z * p.V * p.l_g**2
        + p.V * ell * (p.c_lambda * ell * p.V / (10 * p.R) + 2 * p.E * p.I_arm * p.sigma * p.sin_alpha / p.R**2)
    )
    a_3 = (
        p.k_y * (p.I_z * p.V**2 - p.kappa * p.sigma)
        - p.C_F * p.F_z * p.kappa * p.l_g**2
        + p.F_z * p.I_x * p.V**2 * trail
        + 2 * p.E * p.I_x * p.I_arm * p.L * p.V**2 * p.sin_alpha * p.sin_gamma / (10 * p.R)
        + p.c_lambda * p.L**2 * p.V * p.b * p.sin_gamma**2 / (10 * p.R) * string
    )
    a_4 = (
        p.F_z * p.V * trail * (p.k_y * (p.e - p.a) + p.F_z * p.e * p.l_g)
        - p.k_y * p.V * p.kappa
        + p.c_lambda * p.k_y * p.L**2 * p.V**2 * p.b * p.sin_gamma**2 / (10 * p.R)
        + 2 * p.E * p.I_arm * p.L * p.V * p.sin_gamma * p.sin_alpha / p.R**2 * string
    )
    a_5 = p.F_z * p.k_y * p.V**2 * trail + 2 * p.E * p.I_arm * p.L * p.V**2 * p.sin_gamma * p.sin_alpha / p.R**2
    return [a_0, a_1, a_2, a_3, a_4, a_5]


def _utas_misprints(p: Any) -> Terms:
    """I_x and b in (3-34), R^2 for 10 R in (3-35), k_y in (3-37)."""
    ell = p.L * p.sin_gamma
    arm = 2 * p.E * p.I_arm * ell * p.sin_alpha
    damper = p.c_lambda * ell**2 * p.V / (10 * p.R)
    return {
        "(3-34)": {2: p.V * ((p.I_x * p.b - 1) * damper + (p.I_x - 1) * arm * p.sigma / p.R**2)},
        "(3-35)": {3: p.I_x * p.V**2 * arm * (1 / p.R**2 - 1 / (10 * p.R))},
        "(3-37)": {5: (p.k_y - 1) * p.V**2 * arm / p.R**2},
    }


def new_design(p: Any) -> list[Any]:
    """(3-47) to (3-52): [a_0, ..., a_5]; the capital C_lambda of (3-50) is read as c_lambda."""
    ell2 = p.L**2 * p.sin_gamma**2
    trail = p.C_F * p.e - p.C_M
    yaw_damping = p.c_lambda * ell2 * p.V - p.kappa
    arm = 2 * p.E * p.I_arm * p.V / ell2
    a_0 = p.I_x * p.I_z * p.V * p.sigma
    a_1 = (
        p.I_x * p.I_z * p.V**2
        - p.I_x * p.kappa * p.sigma
        + p.c_lambda * ell2 * p.I_x * p.V * p.sigma
        + p.c_y * p.I_z * p.V * p.sigma
    )
    a_2 = (
        (p.I_x * p.V + p.c_y * p.sigma) * yaw_damping
        + p.c_y * p.I_z * p.V**2
        + p.I_z * p.V * (p.c_y * p.V + p.k_y * p.sigma)
        + 2 * p.I_x * p.E * p.I_arm * p.V * p.sigma / ell2
        + p.C_F * p.F_z * p.I_z * p.V * p.l_g**2
        + p.F_z * p.I_x * p.V * trail * (p.e - p.a)
    )
    a_3 = (
        (p.c_y * p.V + p.k_y * p.sigma) * yaw_damping
        + p.I_z * p.k_y * p.V**2
        + p.l_g**2 * p.F_z * (-p.C_F * p.kappa + p.c_lambda * ell2 * p.V)
        + arm * (p.I_x * p.V + p.c_y * p.sigma)
        + p.F_z * p.I_x * p.V**2 * trail
        + p.c_y * p.F_z * p.V * (p.C_F * p.e**2 + p.C_M * p.a)
        - p.c_y * p.F_z * p.V * (p.C_M * p.e + p.C_F * p.a * p.e)
    )
    a_4 = (
        p.k_y * p.V * yaw_damping
        + arm * (p.c_y * p.V + p.k_y * p.sigma + p.l_g**2 * p.C_F * p.F_z)
        + trail * (p.c_y * p.F_z * p.V**2 + p.F_z * p.k_y * p.V * (p.e - p.a))
    )
    a_5 = arm * p.V * p.k_y + p.F_z * p.V**2 * p.k_y * trail
    return [a_0, a_1, a_2, a_3, a_4, a_5]


def _new_design_misprints(p: Any) -> Terms:
    """A term too many in (3-49), C_F in (3-50), the coupling by the load in (3-51); in all 2EI/ell^2 for 2EI/ell of (3-42)."""
    ell = p.L * p.sin_gamma
    k_psi = 2 * p.E * p.I_arm / ell * (1 - 1 / ell)
    return {
        "(3-49)": {2: -p.c_y * p.I_z * p.V**2},
        "(3-50)": {3: (p.C_F - 1) * p.l_g**2 * p.F_z * p.c_lambda * ell**2 * p.V},
        "(3-51)": {4: p.F_z**2 * p.V * p.e * p.l_g * (p.e * p.C_F - p.C_M)},
        "stiffness": {
            2: p.I_x * p.V * p.sigma * k_psi,
            3: p.V * (p.I_x * p.V + p.c_y * p.sigma) * k_psi,
            4: p.V * (p.c_y * p.V + p.k_y * p.sigma + p.l_g**2 * p.C_F * p.F_z) * k_psi,
            5: p.V**2 * p.k_y * k_psi,
        },
    }


COEFFICIENTS = {"boeing": boeing, "utas": utas, "arreaza": new_design}
"""Printed coefficients, by layout."""

MISPRINTS = {"boeing": _boeing_misprints, "utas": _utas_misprints, "arreaza": _new_design_misprints}
"""What is to be added to coefficient i so that it is that of the thesis' own matrix (3-5), by layout and misprint."""


class PrintedTreadMoment(Plane):
    """The gear of matrix (3-5): the tread-width moment has the printed sign, which feeds a vibration (erratum 1)."""

    @cached_property
    def _values(self) -> dict[str, float]:
        values = super()._values
        return values | {"tyre.tread_width_moment": -values["tyre.tread_width_moment"]}


@dataclass(frozen=True)
class PrintedPlane(Plane):
    """The gear of the printed coefficients: companion matrices in place of state matrices.

    Parameters
    ----------
    right : frozenset of str
        Misprints that are put right; the others stay.
    """

    right: frozenset[str] = frozenset()

    def matrices(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Companion matrices (m, 5, 5) at fractions u, v (m,) of the ranges."""
        layout = self.study.damper.topology
        p = _Symbols(self._values | {self.x.name: self.x.at(u), self.y.name: self.y.at(v)}, layout)
        a = COEFFICIENTS[layout](p)
        for name, terms in MISPRINTS[layout](p).items():
            if name in self.right:
                a = [a_i + terms.get(i, 0) for i, a_i in enumerate(a)]
        w = np.broadcast_to(np.abs(a[5] / a[0]) ** (1 / 5), u.shape)  # roots in units of w: entries of one size
        companion = np.zeros((u.size, 5, 5))
        companion[:, 0, :] = -np.stack([a_i / a[0] / w**i for i, a_i in enumerate(a)][1:], axis=-1)
        companion[:, 1:, :-1] = np.eye(4)
        return w[:, None, None] * companion


class _Symbols:
    """Symbols of chapter 3 for the numbers of a study; both signs of the aligning moment are those of Table 0.1 and (3-5)."""

    def __init__(self, values: dict[str, Any], layout: str):
        self.V, self.F_z = values["speed"], values["vertical_load"]
        self.I_z, self.e = values["gear.yaw_inertia"], values["gear.caster_length"]
        self.I_x, self.k_y = values["gear.lateral.inertia"], values["gear.lateral.stiffness"]
        self.c_y, self.l_g = values["gear.lateral.damping"], values["gear.lateral.height"]
        self.a, self.sigma = values["tyre.half_contact_length"], values["tyre.relaxation_length"]
        self.C_F, self.C_M = 7 * values["tyre.cornering_coefficient"], -values["tyre.aligning_coefficient"]
        self.kappa, self.E = values["tyre.tread_width_moment"], values["material.youngs_modulus"]
        self.L, self.sin_gamma, self.c_lambda = values["L"], np.sin(values["gamma"]), values["c_lambda"]
        if layout == "boeing":
            self.k_lambda = values["k_lambda"]
        else:
            self.I_arm = values["I_arm"]
        if layout == "utas":
            self.b, ell = values["b"], self.L * self.sin_gamma
            self.R = np.hypot(ell, self.b)
            self.sin_alpha = ell / self.R

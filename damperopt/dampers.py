"""Damper layouts: from the design variables to stiffness and damping about the yaw axis, by virtual work.

Every layout is a pair of lengths that depend on the yaw angle psi: the deflection eps(psi) of the spring or arm tip,
and the length change s(psi) of the damper. With a spring of stiffness k_eps and a damper c_lambda, virtual work gives

    torque = -k_eps eps(psi) eps'(psi) - c_lambda s'(psi)^2 psi'.

Geometry `planar` is the linkage seen from the top: eps is that of an apex moving purely sideways by ell sin(psi), with
ell = L sin(gamma), the damper length of UTAS that of an apex on the circle of radius ell; the two agree at psi = 0.
Geometry `published` keeps those lengths for strokes and stresses, but takes stiffness and damping as printed in the
thesis, (3-11), (3-12), (3-26), (3-30), (3-42), (3-45), known errors included; see the errata in the documentation.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import casadi as ca

__all__ = ["Linkage", "linkage"]


@dataclass(frozen=True)
class Linkage:
    """A damper layout about its rest position; expressions in the design variables.

    Attributes
    ----------
    torsional_stiffness, torsional_damping : SX
        k_psi [N m/rad] and c_psi [N m s/rad] at psi = 0.
    spring_lever, damper_lever : SX
        d eps/d psi and ds/d psi at psi = 0 [m/rad].
    torque : callable
        (psi, psi') -> restoring torque of the linkage on the gear [N m].
    reach : SX
        Horizontal distance of the apex from the strut axis, L sin(gamma) [m].
    arm_length : SX or None
        Length of the bending arm that enters its bending, as seen from the top [m].
    damper_length : SX or None
        Pin-to-pin length of the damper [m]; None where the layout does not limit it.
    """

    torsional_stiffness: Any
    torsional_damping: Any
    spring_lever: Any
    damper_lever: Any
    torque: Any
    reach: Any
    arm_length: Any = None
    damper_length: Any = None


def linkage(damper: Any, design: Mapping[str, Any], youngs_modulus: Any) -> Linkage:
    """The linkage of a layout.

    Parameters
    ----------
    damper : Damper
        Topology and geometry level; stiffness and damping for ``rotational``.
    design : mapping
        c_lambda [N s/m], L [m], gamma [rad], with k_lambda [N/m] for Boeing, I_arm [m^4] and b [m] for the others.
    youngs_modulus : SX
        E of the bending arm [Pa].

    Returns
    -------
    Linkage
    """
    if damper.topology == "rotational":
        k_psi, c_psi = damper.torsional_stiffness, damper.torsional_damping
        return Linkage(k_psi, c_psi, 1, 1, lambda psi, rate: -k_psi * psi - c_psi * rate, 0)
    layout = {"boeing": _boeing, "utas": _utas, "arreaza": _arreaza}[damper.topology]
    planar, printed = layout(design, youngs_modulus)
    if damper.geometry == "planar":
        return planar
    k_psi, c_psi = printed
    return Linkage(
        k_psi,
        c_psi,
        planar.spring_lever,
        planar.damper_lever,
        lambda psi, rate: -k_psi * psi - c_psi * rate,
        planar.reach,
        planar.arm_length,
        planar.damper_length,
    )


def _by_virtual_work(spring_stiffness, c_lambda, eps, s, reach, arm_length=None, damper_length=None) -> Linkage:
    psi = ca.SX.sym("psi")
    eps_psi, s_psi = ca.jacobian(eps(psi), psi), ca.jacobian(s(psi), psi)

    def torque(angle: Any, rate: Any) -> Any:
        stiff = ca.substitute(eps(psi) * eps_psi, psi, angle)
        damped = ca.substitute(s_psi**2, psi, angle)
        return -spring_stiffness * stiff - c_lambda * damped * rate

    spring_lever, damper_lever = ca.substitute(eps_psi, psi, 0), ca.substitute(s_psi, psi, 0)
    return Linkage(
        spring_stiffness * spring_lever**2,
        c_lambda * damper_lever**2,
        spring_lever,
        damper_lever,
        torque,
        reach,
        arm_length,
        damper_length,
    )


def _boeing(design: Mapping[str, Any], E: Any) -> tuple[Linkage, tuple[Any, Any]]:
    # thesis (3-9) .. (3-12): ell reach; spring and damper both act on the apex gap
    c_lambda, k_lambda = design["c_lambda"], design["k_lambda"]
    ell = design["L"] * ca.sin(design["gamma"])

    def gap(psi):
        return ell * ca.sin(psi)

    printed = k_lambda * ell**2, c_lambda * ell**2
    return _by_virtual_work(k_lambda, c_lambda, gap, gap, ell), printed


def _utas(design: Mapping[str, Any], E: Any) -> tuple[Linkage, tuple[Any, Any]]:
    # thesis (3-23) .. (3-30): R length of arm and damper from the top, alpha the arm's angle at the apex
    c_lambda, I_arm, b = design["c_lambda"], design["I_arm"], design["b"]
    ell = design["L"] * ca.sin(design["gamma"])
    R = ca.sqrt(ell**2 + b**2)
    sin_alpha = ell / R

    def arm_tip(psi):
        return ell * sin_alpha * ca.sin(psi)

    def damper(psi):
        return -ca.sqrt(ell**2 + b**2 - 2 * ell * b * ca.sin(psi))

    printed = 2 * E * I_arm * ell * sin_alpha / R**2, c_lambda * ell**2 * b / (10 * R)
    return _by_virtual_work(3 * E * I_arm / R**3, c_lambda, arm_tip, damper, ell, R, R), printed


def _arreaza(design: Mapping[str, Any], E: Any) -> tuple[Linkage, tuple[Any, Any]]:
    # thesis (3-40) .. (3-45): arm along the reach, damper of pin-to-pin length b across it at the apex
    c_lambda, I_arm, b = design["c_lambda"], design["I_arm"], design["b"]
    ell = design["L"] * ca.sin(design["gamma"])

    def apex(psi):
        return ell * ca.sin(psi)

    printed = 2 * E * I_arm / ell, c_lambda * ell**2
    return _by_virtual_work(3 * E * I_arm / ell**3, c_lambda, apex, apex, ell, ell, b), printed

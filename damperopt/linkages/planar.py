"""Damper layouts: the lengths that a yaw angle changes, and the stiffness and damping that act along them.

Every layout is a pair of lengths that depend on the yaw angle psi: the deflection eps(psi) of the spring or arm tip,
and the stroke s(psi) of the damper. With a spring of stiffness k_eps and a damper c_lambda, virtual work gives

    torque = -k_eps eps(psi) eps'(psi) - c_lambda s'(psi)^2 psi'.

Geometry `planar` is the linkage seen from the top: eps is that of an apex moving purely sideways by ell sin(psi), with
ell = L sin(gamma), the damper length of UTAS that of an apex on the circle of radius ell; the two agree at psi = 0.
Geometry `spatial` is the linkage itself, see `spatial`. Geometry `published` keeps the planar levers at rest for strokes
and stresses, but takes stiffness and damping as printed in the thesis, (3-11), (3-12), (3-26), (3-30), (3-42), (3-45),
known errors included; see the errata in the documentation.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import casadi as ca

from .base import Linkage, Position
from .spatial import spatial

__all__ = ["linkage"]


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
        return _straight(damper.torsional_stiffness, damper.torsional_damping, 1, 1, 0)
    if damper.geometry == "spatial":
        return spatial(damper.topology, design, youngs_modulus)
    layout = {"boeing": _boeing, "utas": _utas, "arreaza": _arreaza}[damper.topology]
    planar, (k_psi, c_psi) = layout(design, youngs_modulus)
    if damper.geometry == "planar":
        return planar
    spring, lever = planar.spring_lever, planar.damper_lever
    lengths = planar.reach, planar.arm_length, planar.damper_length
    return _straight(k_psi / spring**2, c_psi / lever**2, spring, lever, *lengths)


def _straight(stiffness, damping, spring_lever, damper_lever, *lengths) -> Linkage:
    """Constant levers."""

    def at(psi: Any) -> Position:
        return Position(spring_lever * psi, spring_lever, damper_lever * psi, damper_lever)

    return Linkage(stiffness, damping, at, spring_lever, damper_lever, *lengths)


def _from_lengths(stiffness, damping, eps, s, *lengths) -> Linkage:
    """Levers as derivatives of the lengths eps(psi), s(psi)."""
    psi = ca.SX.sym("psi")
    expressions = [eps(psi), ca.jacobian(eps(psi), psi), s(psi) - s(0), ca.jacobian(s(psi), psi)]

    def at(angle: Any) -> Position:
        return Position(*(ca.substitute(expression, psi, angle) for expression in expressions))

    rest = at(0)
    return Linkage(stiffness, damping, at, rest.spring_lever, rest.damper_lever, *lengths)


def _boeing(design: Mapping[str, Any], E: Any) -> tuple[Linkage, tuple[Any, Any]]:
    # thesis (3-9) .. (3-12): ell reach; spring and damper both act on the apex gap
    c_lambda, k_lambda = design["c_lambda"], design["k_lambda"]
    ell = design["L"] * ca.sin(design["gamma"])

    def gap(psi):
        return ell * ca.sin(psi)

    printed = k_lambda * ell**2, c_lambda * ell**2
    return _from_lengths(k_lambda, c_lambda, gap, gap, ell), printed


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
    return _from_lengths(3 * E * I_arm / R**3, c_lambda, arm_tip, damper, ell, R, R), printed


def _arreaza(design: Mapping[str, Any], E: Any) -> tuple[Linkage, tuple[Any, Any]]:
    # thesis (3-40) .. (3-45): arm along the reach, damper of pin-to-pin length b across it at the apex
    c_lambda, I_arm, b = design["c_lambda"], design["I_arm"], design["b"]
    ell = design["L"] * ca.sin(design["gamma"])

    def apex(psi):
        return ell * ca.sin(psi)

    printed = 2 * E * I_arm / ell, c_lambda * ell**2
    return _from_lengths(3 * E * I_arm / ell**3, c_lambda, apex, apex, ell, ell, b), printed

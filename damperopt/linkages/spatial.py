"""The linkage in space: torque link, bending arm and damper as a closed loop with three algebraic unknowns.

Frame: z up the strut axis, x aft, y lateral, origin at the height of the apex at rest; h = L cos(gamma). The lower link
turns on the piston about an axis at height -h that yaws with it, so the apex is P = (q cos(psi), q sin(psi), z) with
q^2 + (z + h)^2 = L^2. The upper assembly turns on the fixed strut about the y axis at height +h; in its own plane, where
u^2 = x^2 + (z - h)^2 is measured from the hinge line, the bending arm is an inextensible cantilever from (0, y_root) to
the apex: its tip moves by eps across and, by foreshortening, 3 eps^2/(5 l_arm) back along itself.

The unknowns are (eps, q, z). Levers follow from the implicit function theorem on the three equations.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import casadi as ca

from .base import Linkage, Position

__all__ = ["FORESHORTENING", "spatial"]

FORESHORTENING = 3 / 5
"""Tip retreat of a cantilever loaded at its tip, in units of eps^2/length: half the integral of the squared slope."""


def spatial(topology: str, design: Mapping[str, Any], youngs_modulus: Any) -> Linkage:
    """Spatial linkage of a layout.

    Parameters
    ----------
    topology : str
        ``boeing``: two stiff links, spring and damper along y in the apex gap. ``utas``: arm rooted at y = b on the upper
        hinge line, damper from (0, -b, h) to the apex. ``arreaza``: arm rooted at y = 0, damper from (ell, -b, 0), on a
        rigid support, to the apex; at rest it is perpendicular to the links.
    design : mapping
        Design variables by name [SI].
    youngs_modulus : SX
        E of the bending arm [Pa].

    Returns
    -------
    Linkage
        With unknowns deflection eps [m], q [m] and apex height z [m].
    """
    # theory page, spatial linkage: ell reach, h half the lug distance, l_arm unflexed arm
    L, gamma, c_lambda, b = design["L"], design["gamma"], design["c_lambda"], design.get("b", 0)
    ell, h = L * ca.sin(gamma), L * ca.cos(gamma)
    y_root = b if topology == "utas" else 0
    l_arm = ca.sqrt(L**2 + y_root**2) if topology == "utas" else L
    foreshortening = 0 if topology == "boeing" else FORESHORTENING

    eps, q, z, psi = (ca.SX.sym(name) for name in ("arm_deflection", "apex_reach", "apex_height", "psi"))
    unknowns = ca.vertcat(eps, q, z)
    x, y = q * ca.cos(psi), q * ca.sin(psi)
    along = l_arm - foreshortening * eps**2 / l_arm
    u_tip, y_tip = (along * L + eps * y_root) / l_arm, y_root + (eps * L - along * y_root) / l_arm
    closure = ca.vertcat(q**2 + (z + h) ** 2 - L**2, x**2 + (z - h) ** 2 - u_tip**2, y - y_tip)
    s = {
        "boeing": lambda: eps,
        "utas": lambda: ca.sqrt(x**2 + (y + b) ** 2 + (z - h) ** 2),
        "arreaza": lambda: ca.sqrt((x - ell) ** 2 + (y + b) ** 2 + z**2),
    }[topology]()

    rates = -ca.inv_minor(ca.jacobian(closure, unknowns)) @ ca.jacobian(closure, psi)
    damper_lever = ca.jacobian(s, psi) + ca.jacobian(s, unknowns) @ rates
    damper_length: Any = {"boeing": 0, "utas": l_arm, "arreaza": b}[topology]
    expressions = [eps, rates[0], s - damper_length, damper_lever]

    def at(angle: Any) -> Position:
        return Position(*(ca.substitute(expression, psi, angle) for expression in expressions))

    return Linkage(
        stiffness=design["k_lambda"] if topology == "boeing" else 3 * youngs_modulus * design["I_arm"] / l_arm**3,
        damping=c_lambda,
        at=at,
        spring_lever=ell * l_arm / L,
        damper_lever=2 * b * ell / l_arm if topology == "utas" else ell,
        reach=ell,
        arm_length=None if topology == "boeing" else l_arm,
        damper_length=None if topology == "boeing" else damper_length,
        unknowns=unknowns,
        rest=ca.vertcat(0, ell, 0),
        closure=lambda angle: ca.substitute(closure, psi, angle),
    )

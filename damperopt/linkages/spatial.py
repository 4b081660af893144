"""The linkage in space: torque link, bending arm and damper as a closed loop with three algebraic unknowns.

Frame: z up the strut axis, x aft, y lateral, origin at the height of the apex at rest; h = L cos(gamma). The lower link
turns on the piston about an axis at height -h that yaws with it, so the apex is P = (q cos(psi), q sin(psi), z) with
q^2 + (z + h)^2 = L^2. The upper assembly turns on the fixed strut about the y axis at height +h; in its own plane, where
u^2 = x^2 + (z - h)^2 is measured from the hinge line, the bending arm is an inextensible cantilever from (0, y_root) to
the apex: its tip moves by eps across and, by foreshortening, 3 eps^2/(5 l_arm) back along itself.

At a given yaw angle the unknowns are (eps, q, z); levers follow from the implicit function theorem on the three equations. At
a given eps all is explicit, tan(psi) = y/x with

    z = (L^2 - y^2 - u^2)/(4 h),   x^2 = u^2 - (z - h)^2,

and so eps is the coordinate of a linkage whose links are elastic.
"""

from __future__ import annotations

from collections.abc import Mapping

from ..expressions.calculus import Expr, atan, cos, implicit_slopes, is_symbol, partial, sin, sqrt, symbol, value_at
from ..ports.linkage import Linkage, Path, Point, Position
from .base import reach_and_height

__all__ = ["FORESHORTENING", "closed_loop"]

FORESHORTENING = 3 / 5
"""Tip retreat of a cantilever loaded at its tip, in units of eps^2/length: half the integral of the squared slope."""


def closed_loop(
    design: Mapping[str, Expr],
    stiffness: Expr,
    *,
    stroke: Expr = 0,
    y_root: Expr = 0,
    root_retreat: Expr = 0,
    arm_length: Expr = None,
    damper_end: Point | None = None,
    damper_length: Expr = None,
    spring_lever: Expr = None,
    damper_lever: Expr = None,
) -> Linkage:
    """Closed loop of a layout with torque links.

    Parameters
    ----------
    design : mapping of str to Expr
        With L and gamma [SI].
    stiffness : Expr
        Of the spring or arm at the apex [N/m].
    stroke : Expr
        Of the shock strut [m].
    y_root : Expr
        Of the arm on the upper hinge line [m].
    root_retreat : Expr
        Of the arm's root from the apex over the deflection, where an elastic hinge line lets it.
    arm_length : Expr or None
        Unflexed arm [m]; None: a stiff upper link, and spring and damper in the gap at the apex.
    damper_end : Point or None
        Where the damper is fixed to the strut [m]; None: it acts along the deflection.
    damper_length : Expr
        Of the damper at rest [m].
    spring_lever, damper_lever : Expr
        d eps/d psi and ds/d psi at rest [m/rad], which the equations have in closed form.

    Returns
    -------
    Linkage
        With unknowns deflection eps [m], q [m] and apex height z [m].
    """
    # theory page, spatial linkage: ell reach, h half the lug distance, l_arm unflexed arm
    L, (ell, h) = design["L"], reach_and_height(design, stroke)
    foreshortening, l_arm = (0, L) if arm_length is None else (FORESHORTENING, arm_length)
    eps, q, z, psi = (symbol(name) for name in ("arm_deflection", "apex_reach", "apex_height", "psi"))
    x, y = q * cos(psi), q * sin(psi)
    along = l_arm - foreshortening * eps**2 / l_arm
    u_tip = (along * L + eps * y_root) / l_arm - root_retreat * eps
    y_tip = y_root + (eps * L - along * y_root) / l_arm
    closure = (q**2 + (z + h) ** 2 - L**2, x**2 + (z - h) ** 2 - u_tip**2, y - y_tip)
    unknowns = (eps, q, z)
    s = eps if damper_end is None else sqrt(sum(_square(a, b) for a, b in zip((x, y, z), damper_end, strict=True)))

    rates = implicit_slopes(closure, unknowns, psi)
    lever = partial(s, psi) + sum(partial(s, u) * rate for u, rate in zip(unknowns, rates, strict=True))
    rest_length = 0 if damper_length is None else damper_length
    expressions = [eps, rates[0], s - rest_length, lever]

    def at(angle: Expr) -> Position:
        return Position(*(value_at(expression, psi, angle) for expression in expressions))

    height = (L**2 - y_tip**2 - u_tip**2) / (4 * h)
    tip = sqrt(u_tip**2 - (height - h) ** 2), y_tip, height
    angle = atan(tip[1] / tip[0])
    length = eps if damper_end is None else sqrt(sum(_square(a, b) for a, b in zip(tip, damper_end, strict=True)))
    explicit = [angle, partial(angle, eps), eps, 1, length - rest_length, partial(length, eps)]

    def path(deflection: Expr) -> Path:
        return Path(*(value_at(expression, eps, deflection) for expression in explicit))

    return Linkage(
        stiffness=stiffness,
        at=at,
        spring_lever=spring_lever,
        damper_lever=damper_lever,
        reach=ell,
        arm_length=arm_length,
        damper_length=damper_length,
        unknowns=unknowns,
        rest=(0, ell, 0),
        closure=lambda angle: tuple(value_at(equation, psi, angle) for equation in closure),
        path=path,
        coordinate="apex_deflection",
    )


def _square(a: Expr, b: Expr) -> Expr:
    return a**2 if not is_symbol(b) and isinstance(b, (int, float)) and b == 0 else (a - b) ** 2

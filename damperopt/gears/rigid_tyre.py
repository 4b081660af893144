"""The gear on a rigid tyre in closed form: a wheel whose contact point does not slip sideways, for teaching and as a test.

No kind of gear: the side force is a force of constraint here, not the answer of a tyre to a motion, and takes a degree of
freedom away. A study comes as near as it wishes with a stiff tyre of a short contact and relaxation length.
"""

from __future__ import annotations

from ..expressions.calculus import Expr
from .yaw_bending import YawBending

__all__ = ["rigid_polynomial"]


def rigid_polynomial(
    gear: YawBending, stiffness: Expr, damping: Expr, speed: Expr, load: Expr = 0
) -> tuple[Expr, Expr, Expr, Expr]:
    """Characteristic polynomial of yaw and bending with e psi' + V psi + l_g delta' = 0 and without aligning moment.

    With the constraint force F_y taken out of both equations of motion, c_psi + kappa/V standing for the damping,

        (I_x e + l_g^2 I_z/e) s^3 + (I_x V + c_delta e + l_g^2 c_psi/e) s^2
        + (c_delta V + k_delta e + l_g^2 k_psi/e + F_z e l_g) s + k_delta V.

    Undamped and unloaded it is stable at every speed, or at none: where k_psi/I_z is above k_delta/I_x, for e > 0.

    Parameters
    ----------
    gear : YawBending
        Without rake, with a caster other than 0.
    stiffness, damping : Expr
        k_psi [N m/rad], c_psi [N m s/rad].
    speed, load : Expr
        V [m/s], F_z [N].

    Returns
    -------
    tuple of Expr
        Coefficients of s^3, s^2, s, 1.

    Examples
    --------
    >>> lateral = dict(inertia=600, stiffness=6.1e6, damping=300, height=2.5)
    >>> gear = YawBending(kind="yaw_bending", yaw_inertia=100, caster_length=0.12, wheel_radius=0.36, lateral=lateral)
    >>> [round(float(a), 3) for a in rigid_polynomial(gear, 3.8e5, 300, 40, 150e3)]
    [5280.333, 39661.0, 20580666.667, 244000000.0]
    """
    if gear.rake_angle != 0 or gear.caster_length == 0:
        raise ValueError("a rigid tyre in closed form needs a caster, and no rake")
    # I inertia, c damping, k stiffness of yaw (z) and bending (x); e caster, l height, V speed
    strut, e, V = gear.lateral, gear.caster_length, speed
    I_z, I_x, k_x, c_x, l = gear.yaw_inertia, strut.inertia, strut.stiffness, strut.damping, strut.height
    cubic, square = I_x * e + l**2 * I_z / e, I_x * V + c_x * e + l**2 * damping / e
    return cubic, square, c_x * V + k_x * e + l**2 * stiffness / e + load * e * l, k_x * V

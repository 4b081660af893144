"""Tyre laws: side force and aligning moment of a stretched string whose leading point is deflected by y.

The slip angle is alpha = atan(y/sigma); M_z > 0 restores a positive yaw. Sources: thesis (2-3)..(2-12), (4-8).
"""

from __future__ import annotations

import math
from typing import Any

import casadi as ca

from ..expressions.corners import Elements

__all__ = [
    "aligning_moment",
    "peak_aligning_moment",
    "peak_side_force",
    "side_force",
    "slip_angle",
    "straight_tangent_stiffnesses",
]


def side_force(tyre: Any, deflection: Any, load: Any) -> Any:
    """Side force of the tyre on the wheel.

    Parameters
    ----------
    tyre : StringTyre, LinearTyre or StraightTangentTyre
    deflection : SX
        String deflection y at the leading contact point [m].
    load : SX
        Vertical load F_z [N].

    Returns
    -------
    SX
        F_y [N]; thesis (2-10) for the nonlinear law, (2-4) for the straight tangent.
    """
    if tyre.law == "straight_tangent":
        return straight_tangent_stiffnesses(tyre)[0] * deflection / tyre.relaxation_length
    slip = slip_angle(tyre, deflection)
    if tyre.law == "linear":
        return tyre.cornering_slope * slip * load
    X = ca.atan(7 * ca.tan(slip))
    return tyre.cornering_coefficient * X * ca.cos(0.95 * X) * load


def slip_angle(tyre: Any, deflection: Any) -> Any:
    """Slip angle alpha = atan(y/sigma) [rad]."""
    return ca.atan(deflection / tyre.relaxation_length)


def aligning_moment(tyre: Any, deflection: Any, load: Any, elements: Elements) -> Any:
    """Self-aligning moment about the vertical.

    Parameters
    ----------
    tyre : StringTyre, LinearTyre or StraightTangentTyre
    deflection : SX
        String deflection y at the leading contact point [m].
    load : SX
        Vertical load F_z [N].
    elements : Elements
        Version of the corner at the slip limit.

    Returns
    -------
    SX
        M_z [N m], positive against positive yaw; thesis (4-8), zero beyond the slip limit.
    """
    if tyre.law == "straight_tangent":
        return straight_tangent_stiffnesses(tyre)[1] * deflection / tyre.relaxation_length
    slip = slip_angle(tyre, deflection)
    if tyre.law == "linear":
        return tyre.aligning_coefficient * slip * load
    limit = tyre.aligning_slip_limit
    moment = tyre.aligning_coefficient * limit / math.pi * ca.sin(math.pi * slip / limit) * load
    return elements.within("slip limit", slip, limit) * moment


def straight_tangent_stiffnesses(tyre: Any) -> tuple[Any, Any]:
    """Cornering stiffness [N/rad] and aligning stiffness [N m/rad] of a straight-tangent tyre.

    From string data: 2 c_c (sigma + a)^2 and 2 c_c a (sigma (sigma + a) + a^2/3), where c_c is the lateral carcass stiffness
    per length, a the half contact length and sigma = sqrt(S/c_c) the relaxation length under string tension S.
    Source: Pacejka, Tyre and Vehicle Dynamics, ch. 5.
    """
    c_c, sigma, a = tyre.carcass_stiffness, tyre.relaxation_length, tyre.half_contact_length
    if c_c is None:
        return tyre.cornering_stiffness, tyre.aligning_stiffness
    return 2 * c_c * (sigma + a) ** 2, 2 * c_c * a * (sigma * (sigma + a) + a**2 / 3)


# X cos(0.95 X) is largest where 0.95 X tan(0.95 X) = 1, at 0.95 X = 0.860333589...
_PEAK_ARGUMENT = 0.8603335890193798 / 0.95
_PEAK_SHAPE = _PEAK_ARGUMENT * math.cos(0.95 * _PEAK_ARGUMENT)


def peak_side_force(tyre: Any, load: Any) -> Any:
    """Largest side force [N] of the nonlinear law at vertical load `load` [N]."""
    return tyre.cornering_coefficient * _PEAK_SHAPE * load


def peak_aligning_moment(tyre: Any, load: Any) -> Any:
    """Largest aligning moment [N m] of the nonlinear law at vertical load `load` [N], at half the slip limit."""
    return ca.fabs(tyre.aligning_coefficient) * tyre.aligning_slip_limit / math.pi * load

"""Torque of a damper on the gear: the linkage with everything that stands in series or in parallel with it.

From the gear to the damper: yaw psi, apex freeplay, torque links of stiffness k_t (at the apex, laterally; thesis (3-14)),
the linkage at its own angle psi_l with spring or arm, end stop and damper, and in series with the damper the stiffness k_s
of oil column, rod and brackets. Damper law F = c v + c_2 v |v|. Torques by virtual work.

The nodes between are massless, so that each either follows from a first-order equation (psi_l where the damper is rigidly
attached, the dashpot's own stroke where it is not) or is an algebraic unknown (psi_l with both compliances).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import casadi as ca

from ..expressions.corners import Elements
from .base import Linkage

__all__ = ["DamperTorque", "damper_torque"]


@dataclass
class DamperTorque:
    """Torque on the gear [N m] and the states and unknowns that it needs; expressions.

    Attributes
    ----------
    torque : SX
        On the gear, against positive yaw where negative.
    states, rates : dict of str to SX
        More states and their derivatives.
    unknowns, rest, residuals : list of SX
        Algebraic unknowns, their values at rest, equations = 0.
    outputs : dict of str to SX
        Strokes [m], forces [N], speeds [m/s].
    """

    torque: Any = 0
    states: dict[str, ca.SX] = field(default_factory=dict)
    rates: dict[str, Any] = field(default_factory=dict)
    unknowns: list[ca.SX] = field(default_factory=list)
    rest: list[Any] = field(default_factory=list)
    residuals: list[Any] = field(default_factory=list)
    outputs: dict[str, Any] = field(default_factory=dict)


def damper_torque(damper: Any, link: Linkage, elements: Elements, psi: Any, psi_t: Any) -> DamperTorque:
    """Torque of `link`, with the joints and compliances of `damper`, on a gear at yaw `psi` and yaw rate `psi_t`.

    Parameters
    ----------
    damper : Damper
        Floats or symbols.
    link : Linkage
    elements : Elements
        Version of the nonlinear elements.
    psi, psi_t : SX
        [rad], [rad/s]

    Returns
    -------
    DamperTorque
    """
    # k_t, k_s series stiffnesses, s stroke, F_d damper force, v its speed, psi_l angle of the linkage
    k_t, k_s = damper.link_stiffness, damper.series_stiffness
    result = DamperTorque()
    driving, engaged = psi, 1
    if k_t is not None:
        driving = ca.SX.sym("link_angle")
    elif damper.freeplay is not None:
        driving, engaged = _beyond_gap(damper.freeplay, link, elements, psi)
    position = link.at(driving)
    s, lever = position.stroke, position.damper_lever
    F_spring, F_stop = link.stiffness * position.deflection, _stop_force(damper.end_stop, elements, s)
    elastic = F_spring * position.spring_lever + F_stop * lever

    if k_t is not None:
        twist = psi - driving
        if damper.freeplay is not None:
            twist, _ = _beyond_gap(damper.freeplay, link, elements, twist)
        through = k_t * link.reach**2 * twist
        result.torque = -through

    if k_s is not None:
        own = ca.SX.sym("dashpot_stroke")
        F_d = k_s * (s - own)
        v = _speed(damper.orifice, link.damping, elements, F_d)
        result.states["dashpot_stroke"], result.rates["dashpot_stroke"] = own, v
        if k_t is not None:
            result.unknowns, result.rest = [driving], [0]
            # in units of an angle, as the unknown is
            result.residuals = [(through - elastic - F_d * lever) / (k_t * link.reach**2)]
        else:
            result.torque = -engaged * (elastic + F_d * lever)
    elif k_t is not None:
        F_d = (through - elastic) / lever
        v = _speed(damper.orifice, link.damping, elements, F_d)
        result.states["link_angle"], result.rates["link_angle"] = driving, v / lever
    else:
        v = engaged * lever * psi_t
        F_d = _force(damper.orifice, link.damping, elements, v)
        result.torque = -engaged * (elastic + F_d * lever)

    result.unknowns.insert(0, link.unknowns)
    result.rest.insert(0, link.rest)
    result.residuals.insert(0, link.closure(driving))
    result.outputs = {
        "damper_stroke": s,
        "damper_speed": v,
        "damper_force": F_d,
        "spring_deflection": position.deflection,
        "spring_force": F_spring,
        "stop_force": F_stop,
    }
    return result


def _beyond_gap(freeplay: Any, link: Linkage, elements: Elements, angle: Any) -> tuple[Any, Any]:
    half_width = freeplay.gap / link.reach
    return elements.gap("freeplay", angle, half_width, freeplay.smoothing * half_width)


def _stop_force(stop: Any, elements: Elements, stroke: Any) -> Any:
    if stop is None or stop.stiffness is None:
        return 0
    return stop.stiffness * elements.contact("end stop", stroke, stop.stroke, stop.smoothing * stop.stroke)


def _force(orifice: Any, c: Any, elements: Elements, v: Any) -> Any:
    if orifice is None:
        return c * v
    return c * v + orifice.coefficient * v * elements.magnitude(v, orifice.smoothing)


def _speed(orifice: Any, c: Any, elements: Elements, F: Any) -> Any:
    """Inverse of the damper law: the positive root of c_2 v^2 + c v = |F|, in the form that also holds for c_2 = 0."""
    if orifice is None:
        return F / c
    magnitude = elements.magnitude(F, c * orifice.smoothing)
    return 2 * F / (c + ca.sqrt(c**2 + 4 * orifice.coefficient * magnitude))

"""Landing gear, tyre and damper as one differential-algebraic system.

Axes and signs. z up the strut axis, x aft, y lateral. Yaw psi is the rotation of the piston about the strut axis;
the caster (mechanical trail) e is positive when the contact point lies behind the axis; a positive string deflection y
comes from positive yaw at speed. A positive side force F_y and a positive aligning moment M_z turn the wheel back to
psi = 0, so both enter the yaw equation with a minus sign, as does the tread-width moment kappa psi'/V. The lateral
bending angle delta moves the wheel by l_g sin(delta). Source: Thota, Krauskopf & Lowenberg (2009); thesis (2-14),
(3-3), (3-4), with the sign errata of the theory page.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import casadi as ca

from .expressions.corners import Elements, Linear
from .expressions.dae import DAE
from .linkages.planar import linkage
from .linkages.torque import DamperTorque, damper_torque
from .strength.sections import section_modulus
from .study.variables import DESIGN_VARIABLES
from .symbols import SymbolicStudy
from .tyres.string import aligning_moment, side_force, slip_angle

__all__ = ["build", "effective_caster"]

YAW_STATES = ("yaw_angle", "yaw_rate")
LATERAL_STATES = ("bending_angle", "bending_rate")


def effective_caster(gear: Any) -> Any:
    """Effective caster with rake, e cos(phi) + (R_w + e sin(phi)) tan(phi) [m]; thesis (4-5)."""
    e, phi, R_w = gear.caster_length, gear.rake_angle, gear.wheel_radius
    return e * ca.cos(phi) + (R_w + e * ca.sin(phi)) * ca.tan(phi)


def build(symbols: SymbolicStudy, elements: Elements | None = None) -> DAE:
    """The equations of motion of a study.

    Parameters
    ----------
    symbols : SymbolicStudy
    elements : Elements or None
        Version of the nonlinear elements; None: `Linear`, joints in contact and no friction, as for stability.

    Returns
    -------
    DAE
        Order 3: states yaw_angle [rad], yaw_rate [rad/s], string_deflection [m]. Order 5: bending_angle [rad] and
        bending_rate [rad/s] stand before string_deflection. Compliances add dashpot_stroke [m] or link_angle [rad] at the
        end. Algebraic unknowns: those of the spatial linkage, and link_angle with both compliances.
    """
    study, elements = symbols.study, elements or Linear()
    design_names = DESIGN_VARIABLES[study.damper.topology]
    design = {name: ca.SX.sym(name) for name in design_names}
    speed, load, yaw_torque = ca.SX.sym("speed"), ca.SX.sym("load"), ca.SX.sym("yaw_torque")

    state_names = (*YAW_STATES, *(LATERAL_STATES if study.gear.order == 5 else ()), "string_deflection")
    x = {name: ca.SX.sym(name) for name in state_names}
    link = linkage(study.damper, design, study.material.youngs_modulus)
    damper = damper_torque(study.damper, link, elements, x["yaw_angle"], x["yaw_rate"])
    motion = _equations(study.gear, study.tyre, elements, damper, x, speed, load, yaw_torque)
    outputs = damper.outputs | motion.outputs
    if "I_arm" in design:
        moment = outputs["spring_force"] * link.arm_length
        outputs["arm_stress"] = moment / section_modulus(study.mass.arm_section, design["I_arm"])
    return DAE(
        x=ca.vertcat(*x.values(), *damper.states.values()),
        z=ca.vertcat(*damper.unknowns),
        design=ca.vertcat(ca.SX(0, 1), *design.values()),
        data=symbols.data,
        speed=speed,
        load=load,
        yaw_torque=yaw_torque,
        ode=ca.vertcat(motion.ode, *damper.rates.values()),
        alg=ca.vertcat(*damper.residuals),
        rest=ca.vertcat(*damper.rest),
        state_names=(*state_names, *damper.states),
        design_names=design_names,
        data_names=symbols.names,
        outputs=outputs,
    )


@dataclass(frozen=True)
class _Motion:
    ode: Any
    outputs: dict[str, Any] = field(default_factory=dict)


def _equations(
    gear: Any,
    tyre: Any,
    elements: Elements,
    damper: DamperTorque,
    x: dict[str, Any],
    V: Any,
    F_z: Any,
    yaw_torque: Any,
) -> _Motion:
    # theory page, section 2: psi yaw, delta lateral bending, y string deflection, phi rake, e caster, a half contact
    # length, sigma relaxation length, kappa tread-width moment
    psi, psi_t, y = x["yaw_angle"], x["yaw_rate"], x["string_deflection"]
    phi, a, sigma = gear.rake_angle, tyre.half_contact_length, tyre.relaxation_length
    e_eff = effective_caster(gear)
    theta = psi * ca.cos(phi)
    F_y, M_z = side_force(tyre, y, F_z), aligning_moment(tyre, y, F_z, elements)
    M_kappa = tyre.tread_width_moment * ca.cos(phi) * psi_t / V
    M_load = F_z * ca.sin(phi) * e_eff * ca.sin(theta)

    # damper.torque acts on the piston: -T_damper of the page
    torque = damper.torque - e_eff * F_y - M_z - M_kappa + M_load + yaw_torque
    psi_tt = torque / gear.yaw_inertia
    if gear.friction is not None:
        psi_tt -= gear.friction.torque * elements.sign("friction", psi_t, gear.friction.smoothing) / gear.yaw_inertia
    y_t = V * ca.sin(theta) + (e_eff - a) * psi_t * ca.cos(theta) * ca.cos(phi) - V / sigma * y * ca.cos(theta)
    outputs = {
        "linkage_torque": damper.torque,
        "torque_without_friction": torque,
        "slip_angle": slip_angle(tyre, y),
        "side_force": F_y,
        "aligning_moment": M_z,
    }
    if gear.order == 3:
        return _Motion(ca.vertcat(psi_t, psi_tt, y_t), outputs)

    strut, l_g = gear.lateral, gear.lateral.height
    delta, delta_t = x["bending_angle"], x["bending_rate"]
    bending = -strut.stiffness * delta - strut.damping * delta_t
    bending += -l_g * F_y * ca.cos(theta) * ca.cos(phi) * ca.cos(delta) + F_z * e_eff * ca.sin(theta)
    ode = ca.vertcat(psi_t, psi_tt, delta_t, bending / strut.inertia, y_t + l_g * delta_t * ca.cos(delta))
    return _Motion(ode, outputs | {"lateral_displacement": l_g * ca.sin(delta)})

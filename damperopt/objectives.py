"""Mass of a damper layout, part by part, sized by the limit event.

The limit event is a yaw torque, not an imposed angle: T_lim gives the static yaw psi_lim = T_lim/k_psi and the peak
rate psi_lim sqrt(k_psi/I_z). Or it is what simulated motions show: the same estimates, made from the yaw angle of a release or
a kick, times factors from simulation. Everything is closed form in the design variables but for the rod diameter, which must
satisfy two limits and is therefore a variable of its own (its mass grows with it, so the larger limit is met exactly).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import casadi as ca

from .dynamics import effective_caster
from .linkages.base import Linkage
from .strength.sections import area, area_for_modulus, section_modulus
from .tyres.string import peak_aligning_moment, peak_side_force

__all__ = ["LimitEvent", "allowable_stress", "arm_stress", "bore", "limit_event", "mass_parts", "rod_diameters", "rod_length"]


@dataclass(frozen=True)
class LimitEvent:
    """Loads of the limit event; expressions.

    Attributes
    ----------
    torque : SX
        Yaw torque T_lim [N m].
    yaw, yaw_rate : SX
        Static yaw angle [rad] and peak yaw rate [rad/s].
    stroke, damper_force : SX
        Peak damper stroke to one side [m] and peak damper force [N].
    apex_force : SX
        Lateral force at the apex of the torque links [N].
    arm_moment : SX
        Root bending moment of the bending arm [N m]; 0 without an arm.
    spring_force : SX
        Force of the spring or arm tip [N].
    spring_energy : SX
        Energy that the spring stores [J].
    """

    torque: Any
    yaw: Any
    yaw_rate: Any
    stroke: Any
    damper_force: Any
    apex_force: Any
    arm_moment: Any
    spring_force: Any
    spring_energy: Any

    @property
    def peaks(self) -> Any:
        """What a simulation can show instead, in the order of `decay.PEAKS`."""
        return ca.vertcat(self.torque, self.yaw, self.stroke, self.damper_force, self.spring_force)


def limit_event(study: Any, linkage: Linkage, c_lambda: Any, load: Any, factors: Any) -> LimitEvent:
    """Loads of the limit event at vertical load `load` [N].

    Parameters
    ----------
    study : Study
        Floats or symbols.
    linkage : Linkage
    c_lambda : SX
        Damping of the damper [N s/m].
    load : SX
        The largest vertical load of the envelope [N].
    factors : SX
        (5,) on torque, yaw, stroke, damper force and spring force: simulated over estimated peaks, or 1.

    Returns
    -------
    LimitEvent
    """
    torque = study.requirements.limit_torque
    if study.requirements.limit_event == "simulated":
        torque = linkage.torsional_stiffness * _disturbed_yaw(study, linkage)
    elif torque is None:
        side_share = ca.fabs(effective_caster(study.gear)) * peak_side_force(study.tyre, load)
        torque = study.requirements.limit_torque_factor * (peak_aligning_moment(study.tyre, load) + side_share)
    yaw = torque / linkage.torsional_stiffness
    yaw_rate = yaw * ca.sqrt(linkage.torsional_stiffness / study.gear.yaw_inertia)
    spring_force, force = factors[4] * torque / linkage.spring_lever, c_lambda * linkage.damper_lever * yaw_rate
    return LimitEvent(
        torque=factors[0] * torque,
        yaw=factors[1] * yaw,
        yaw_rate=yaw_rate,
        stroke=factors[2] * linkage.damper_lever * yaw,
        damper_force=factors[3] * force,
        apex_force=factors[0] * torque / linkage.reach,
        arm_moment=0 if linkage.arm_length is None else spring_force * linkage.arm_length,
        spring_force=spring_force,
        spring_energy=factors[1] * factors[4] * torque * yaw / 2,
    )


def _disturbed_yaw(study: Any, linkage: Linkage) -> Any:
    """Yaw angle of the release, or to which the kick leads without any damping."""
    decay = study.requirements.decay
    if decay.release is not None:
        return ca.fabs(decay.release.yaw_angle)
    return ca.fabs(decay.kick.yaw_rate) / ca.sqrt(linkage.torsional_stiffness / study.gear.yaw_inertia)


def allowable_stress(material: Any, safety_factor: Any) -> Any:
    """Allowable stress at the limit event [Pa]: yield over the safety factor, or E times the design strain."""
    if material.design_strain is not None:
        return material.youngs_modulus * material.design_strain
    return material.yield_strength / safety_factor


def rod_length(study: Any, event: LimitEvent) -> Any:
    """Length of cylinder and rod, two strokes and the dead length [m]."""
    return 2 * event.stroke + study.mass.dead_length


def rod_diameters(study: Any, event: LimitEvent) -> dict[str, Any]:
    """Least rod diameter [m]: against yield, against Euler buckling (pinned, full length), and to be made at all."""
    steel, F = study.mass.damper_material, event.damper_force
    allowable = allowable_stress(steel, study.requirements.safety_factor)
    buckling = 64 * study.mass.rod_buckling_factor * F * rod_length(study, event) ** 2
    return {
        "rod_yield": ca.sqrt(4 * F / (math.pi * allowable)),
        "rod_buckling": (buckling / (math.pi**3 * steel.youngs_modulus)) ** 0.25,
        "rod_minimum": study.mass.least_rod_diameter,
    }


def bore(study: Any, event: LimitEvent, rod_diameter: Any) -> Any:
    """Bore of the cylinder [m]: an annulus F_max/p_max around the rod."""
    return ca.sqrt(4 * event.damper_force / (math.pi * study.mass.working_pressure) + rod_diameter**2)


def mass_parts(study: Any, design: Mapping[str, Any], linkage: Linkage, event: LimitEvent, rod_diameter: Any) -> dict[str, Any]:
    """Mass by part.

    Parameters
    ----------
    study : Study
        Floats or symbols.
    design : mapping
        Design variables by name.
    linkage : Linkage
    event : LimitEvent
    rod_diameter : SX
        [m]

    Returns
    -------
    dict
        Part name -> mass [kg], fittings included: torque links, damper, and by layout spring (Boeing), bending arm,
        support arm (new design).
    """
    topology, model, rho = study.damper.topology, study.mass, study.material.density
    allowable = allowable_stress(study.material, study.requirements.safety_factor)
    with_fittings = 1 + model.link_fittings_fraction

    def cantilever(section: Any, force: Any, length: Any) -> Any:
        return model.cantilever_taper * rho * length * area_for_modulus(section, force * length / allowable) * with_fittings

    links = 2 if topology == "boeing" else 1
    parts = {"torque links": links * cantilever(model.link_section, event.apex_force, design["L"])}
    if topology == "boeing":
        parts["spring"] = _spring_mass(study, event)
    else:
        true_length = design["L"] if topology == "arreaza" else ca.sqrt(design["L"] ** 2 + design["b"] ** 2)
        parts["bending arm"] = rho * true_length * area(model.arm_section, design["I_arm"]) * with_fittings
    parts["damper"] = _damper_mass(study, event, rod_diameter)
    if topology == "arreaza":
        parts["support arm"] = cantilever(model.support_section, event.damper_force, design["b"])
    return parts


def arm_stress(study: Any, design: Mapping[str, Any], event: LimitEvent) -> Any:
    """Root bending stress of the arm at the limit event [Pa] (3 E eps h_f/R^2)."""
    return event.arm_moment / section_modulus(study.mass.arm_section, design["I_arm"])


def _spring_mass(study: Any, event: LimitEvent) -> Any:
    # Belleville stack: energy over eta sigma^2/(2 E) per volume
    steel = study.mass.damper_material
    sigma = allowable_stress(steel, study.requirements.safety_factor)
    return steel.density * event.spring_energy / (study.mass.spring_utilisation * sigma**2 / (2 * steel.youngs_modulus))


def _damper_mass(study: Any, event: LimitEvent, rod_diameter: Any) -> Any:
    # through-rod hydraulic damper: D bore, t wall of a thin cylinder p D/(2 sigma) plus an allowance for wear and
    # threads, caps as clamped plates plus the same
    model, steel = study.mass, study.mass.damper_material
    sigma = allowable_stress(steel, study.requirements.safety_factor)
    p, length = model.working_pressure, rod_length(study, event)
    D = bore(study, event, rod_diameter)
    t = model.wall_allowance + p * D / (2 * sigma)
    cap = model.wall_allowance + D / 2 * ca.sqrt(0.75 * p / sigma)
    cylinder = math.pi * (D + t) * t * length
    rod = math.pi / 4 * rod_diameter**2 * length
    caps = 2 * math.pi / 4 * (D + 2 * t) ** 2 * cap
    oil = model.oil_density * event.damper_force / p * length
    return steel.density * (cylinder + rod + caps) * (1 + model.damper_fittings_fraction) + oil

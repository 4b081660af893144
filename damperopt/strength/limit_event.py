"""Loads of the limit event, which sizes the parts.

The limit event is a yaw torque, not an imposed angle: T_lim gives the static yaw, and let go it gives the peak of the damper
force: of the elastic chain, see `release`, or of a rigid one c (T_lim/k_psi) sqrt(k_psi/I_z), which takes no damping into
account. Or it is what simulated motions show: the same estimates, made from the yaw angle of a release or a kick, times factors
from simulation.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ..expressions.calculus import Expr, absolute, sqrt
from ..ports.linkage import Linkage
from ..ports.sizing import LimitEvent
from .fatigue import FlightStresses
from .release import peak_damper_torque

__all__ = ["flight_shares", "limit_event", "peaks_of"]

UNSTATED = 1 / 3, 3
"""Decay ratio and cycles of a landing transient for which nothing is required."""


def limit_event(
    study: Any, linkage: Linkage, design: Mapping[str, Expr], load: Expr, factors: Sequence[Expr] = (1, 1, 1, 1, 1)
) -> LimitEvent:
    """Loads of the limit event at vertical load `load` [N].

    Parameters
    ----------
    study : Study
        Floats or symbols.
    linkage : Linkage
    design : mapping of str to Expr
        Design variables by name [SI].
    load : Expr
        The largest vertical load of the envelope [N].
    factors : sequence of Expr
        (5,) on torque, yaw, stroke, damper force and spring force: simulated over estimated peaks, or 1.

    Returns
    -------
    LimitEvent
    """
    required = study.requirements
    if required.limit_event == "simulated":
        torque = linkage.torsional_stiffness * _disturbed_yaw(required.decay, study, linkage)
    else:
        torque = study.loads.limit_torque(study, load=load)
    k_psi, elastic = linkage.torsional_stiffness, study.damper.has_sized_parts()
    yaw = torque / k_psi  # of the linkage, behind the links
    yaw_rate = yaw * sqrt(k_psi / study.gear.yaw_inertia)
    spring_force = factors[4] * torque / linkage.spring_lever
    force = _damper_force(study, linkage, design, torque, yaw_rate)
    twist = torque / (linkage.links * linkage.reach**2) if elastic and linkage.links is not None else 0
    return LimitEvent(
        torque=factors[0] * torque,
        yaw=factors[1] * (yaw + twist),
        yaw_rate=yaw_rate,
        stroke=factors[2] * linkage.damper_lever * yaw,
        damper_force=factors[3] * force,
        apex_force=factors[0] * torque / linkage.reach,
        arm_moment=0 if linkage.arm_length is None else spring_force * linkage.arm_length,
        spring_force=spring_force,
        spring_energy=factors[1] * factors[4] * torque * yaw / 2,
        safety_factor=required.limit_factor,
        ultimate_factor=required.ultimate_factor,
        service_stroke=linkage.damper_lever * study.loads.service_torque(study, load) / k_psi if elastic else None,
        flight=flight_shares(study, linkage, torque, load) if elastic else None,
        design=design,
    )


def _damper_force(study: Any, linkage: Linkage, design: Mapping[str, Expr], torque: Expr, yaw_rate: Expr) -> Expr:
    """Largest force in the damper [N]; where its damping is uncertain that of the largest, with cold oil."""
    damper, (_, coldest) = study.damper, study.damper.damping_factors()
    if coldest != 1:
        design = damper.with_damping(design, coldest)
    printed = damper.with_damping(linkage.as_printed, coldest)
    damping = damper.damping({**design, **printed})
    if damper.has_sized_parts() and damping is not None:
        return damper.peak_force(design, _released(torque, study, linkage, damping) / damping)
    return damper.peak_force(design, linkage.damper_lever * yaw_rate)


def _released(torque: Expr, study: Any, linkage: Linkage, damping: Expr) -> Expr:
    """Force of a viscous damper after the release of the elastic chain [N]."""
    lever = linkage.damper_lever
    front = None if linkage.links is None else linkage.links * linkage.reach**2
    series = None if linkage.series is None else linkage.series * lever**2
    k, c = linkage.torsional_stiffness, damping * lever**2
    if front is None and series is None:
        return damping * lever * torque / sqrt(k * study.gear.yaw_inertia)
    return peak_damper_torque(torque, study.gear.yaw_inertia, front, k, c, series) / lever


def peaks_of(event: LimitEvent) -> tuple[Expr, ...]:
    """What a simulation can show instead, in the order of `motion.measure.PEAKS`."""
    return event.torque, event.yaw, event.stroke, event.damper_force, event.spring_force


def flight_shares(study: Any, linkage: Linkage, torque: Expr, load: Expr) -> FlightStresses:
    """Torques of a flight over the limit torque: of a turn, of a tow, of the first peak of the transient of landing.

    A tow without towing loads is a turn. The transient is that of the decay requirement, which also says how it dies out;
    without one it begins at the tyre's own peak and dies out to a third within three cycles.

    Parameters
    ----------
    study : Study
    linkage : Linkage
    torque : Expr
        Limit torque [N m].
    load : Expr
        Largest vertical load [N].
    """
    required = study.requirements
    # a case that is switched off sizes nothing at its limit load, but the gear turns and is towed all the same
    rows = {row.name: row for row in study.loads.table(study, load=load) if row.loads is not None}
    spectrum, decay = required.fatigue.spectrum, required.decay
    turning = rows["turning"].limit_torque() if "turning" in rows else 0.0
    towing = rows["towing"].limit_torque() if "towing" in rows else turning
    if decay is None:
        peaks = study.tyre.peaks(load, study.tyre.pressure)
        landing = 0.0 if peaks is None else peaks.aligning_moment + absolute(study.gear.lever()) * peaks.side_force
        per_cycle = UNSTATED[0] ** (1 / UNSTATED[1])
    else:
        landing = linkage.torsional_stiffness * _disturbed_yaw(decay, study, linkage)
        per_cycle = decay.ratio ** (1 / decay.cycles)
    return FlightStresses(
        spectrum.turn_share * turning / torque, spectrum.tow_share * towing / torque, landing / torque, per_cycle
    )


def _disturbed_yaw(decay: Any, study: Any, linkage: Linkage) -> Expr:
    """Yaw angle of the release, or to which the kick leads without any damping."""
    if decay.release is not None:
        return absolute(decay.release.yaw_angle)
    return absolute(decay.kick.yaw_rate) / sqrt(linkage.torsional_stiffness / study.gear.yaw_inertia)

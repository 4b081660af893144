"""Landing gear, tyre and damper as one differential-algebraic system.

Axes and signs. z up the strut axis, x aft, y lateral. Yaw psi is the rotation of the piston about the strut axis;
the caster e (offset of the axle) is positive when the axle lies behind the axis; a positive string deflection y
comes from positive yaw at speed. A positive side force F_y and a positive aligning moment M_z turn the wheel back to
psi = 0, so both enter the yaw equation with a minus sign, as does the tread-width moment kappa psi'/V. The lateral
bending angle delta moves the wheel by l_g sin(delta). Source: Thota, Krauskopf & Lowenberg (2009); thesis (2-14),
(3-3), (3-4), with the sign errata of the theory page.

The equations themselves stand with the components: `gears` (motion of the strut), `tyres` (contact with the ground),
`linkages` and `dampers` (torque on the piston). Here they are joined: the gear moves its wheels, the ground answers, the
damper answers, and the gear moves on.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import casadi as ca

from .dampers.base import Context
from .dampers.control import ACTUATOR, CONTROL_OUTPUTS, Control
from .errors import ConfigError
from .expressions.calculus import Expr, absolute, partial
from .expressions.corners import Corners, Linear
from .expressions.dae import DAE, NEWTON_STEPS
from .linkages.elastic import elastic_linkage
from .linkages.torque import CHAIN_STATES, OUTPUTS, ROTARY_OUTPUTS, Changes, damper_torque
from .ports.linkage import Linkage
from .ports.motion import Torque
from .ports.wheel import Wheel
from .quantities.named import Output, State
from .strength.members import root_stress_of_force
from .symbols import SymbolicStudy

__all__ = ["Ride", "build"]

STROKE = Output("strut_stroke", "m", "of the shock strut from fully out")
"""What a gear with a shock strut shows."""

SIDES = {1: ("",), 2: ("_left", "_right")}
"""Suffixes of the names of tyre states by the number of wheels."""


@dataclass(frozen=True)
class Ride:
    """What changes during a motion beside its states; symbols.

    Attributes
    ----------
    load_rate : Expr
        Of the vertical load [N/s].
    stroke, stroke_rate : Expr
        Of the shock strut [m], [m/s]; without one they have no part in it.
    """

    load_rate: Expr
    stroke: Expr
    stroke_rate: Expr


def build(symbols: SymbolicStudy, corners: Corners | None = None, ride: Ride | None = None) -> DAE:
    """The equations of motion of a study.

    Parameters
    ----------
    symbols : SymbolicStudy
    corners : Corners or None
        Version of the nonlinear elements; None: `Linear`, joints in contact and no friction, as for stability.
    ride : Ride or None
        Rates of load and stroke along a history; None: both are constant. Its symbols are free in the equations.

    Returns
    -------
    DAE
        States of the gear, of its tyres, and of the damper with its compliances (`dashpot_stroke` [m], `link_angle` [rad]), in
        this order. Algebraic unknowns: those of the spatial linkage, and what has no equation of its own between them.
    """
    study, corners = symbols.study, corners or Linear()
    tyre, damper, strut = study.tyre, study.damper, study.gear.strut
    design = {variable.name: ca.SX.sym(variable.name) for variable in study.damper.variables()}
    speed, load, yaw_torque = ca.SX.sym("speed"), ca.SX.sym("load"), ca.SX.sym("yaw_torque")
    stroke = study.gear.stroke(load) if ride is None or strut is None else ride.stroke
    gear = study.gear.at(load, stroke, 0 if ride is None else ride.stroke_rate)
    changes = () if ride is None else ((load, ride.load_rate), (ride.stroke, ride.stroke_rate))

    x = {state.name: ca.SX.sym(state.name) for state in gear.states()}
    wheels = gear.wheels(x, speed, load)
    if ride is not None:
        wheels = tuple(_moving(wheel, changes) for wheel in wheels)
    tyre_states = [_of_wheel(tyre.states, i, len(wheels)) for i in range(len(wheels))]
    strings = [[ca.SX.sym(state.name) for state in states] for states in tyre_states]
    contacts = [tyre.on_ground(wheel, string, corners) for wheel, string in zip(wheels, strings, strict=True)]
    link = elastic_linkage(study, design, stroke, None if strut is None else strut.torsion(load, stroke))
    attachment = gear.attachments(x)["damper"]
    measured = x | {state.name: own for state, own in zip(tyre_states[0], strings[0], strict=True)}
    context = Context(load, speed, axle=absolute(gear.caster_length), wanted=_wanted(damper, link, measured, speed))
    torque = damper_torque(damper, link, design, corners, attachment, context, changes)
    if damper.actuator is not None:
        torque = _with_actuator(torque, damper.actuator, measured, speed, corners)
    motion = gear.rates(x, contacts, torque, yaw_torque, corners)

    states = [
        *gear.states(),
        *(state for own in tyre_states for state in own),
        *_chain(torque.states, (*damper.STATES, ACTUATOR)),
    ]
    rates = [motion.rates[state.name] for state in gear.states()]
    rates += [rate for contact in contacts for rate in contact.rates]
    rates += [torque.rates[name] for name in torque.states]
    outputs = dict(torque.outputs) | dict(motion.outputs)
    declared = [*gear.OUTPUTS, *(ROTARY_OUTPUTS if damper.ROTARY else OUTPUTS), *damper.KIND.OUTPUTS, *CONTROL_OUTPUTS]
    units = {output.name: output.unit for output in declared}
    for i, contact in enumerate(contacts):
        outputs |= {_named(name, i, len(wheels)): value for name, value in contact.outputs.items()}
        units |= {_named(output.name, i, len(wheels)): output.unit for output in tyre.OUTPUTS}
    if strut is not None:
        outputs[STROKE.name], units[STROKE.name] = ca.SX(stroke), STROKE.unit
    for member in damper.members(design, stroke):
        if member.kind == "arm":
            units["arm_stress"] = "Pa"
            outputs["arm_stress"] = root_stress_of_force(member, torque.outputs["spring_force"], study)
    values = [*x.values(), *(value for string in strings for value in string), *torque.states.values()]
    names = [state.name for state in states]
    if twice := [name for name in names if names.count(name) > 1]:
        raise ConfigError(f"state '{twice[0]}' is declared twice by the components of this study; allowed: each name once")
    if unnamed := outputs.keys() - units.keys():
        raise ConfigError(f"output '{min(unnamed)}' is declared by no component; allowed: outputs that one names with its unit")
    return DAE(
        x=ca.vertcat(*values),
        z=ca.vertcat(ca.SX(0, 1), *torque.unknowns),
        design=ca.vertcat(ca.SX(0, 1), *design.values()),
        data=symbols.data,
        speed=speed,
        load=load,
        yaw_torque=yaw_torque,
        ode=ca.vertcat(*rates),
        alg=ca.vertcat(ca.SX(0, 1), *torque.residuals),
        rest=ca.vertcat(ca.SX(0, 1), *torque.rest),
        states=tuple(states),
        design_names=tuple(design),
        data_names=symbols.names,
        outputs=outputs,
        output_units={name: units[name] for name in outputs},
        relaxed=ca.vertcat(*(torque.relaxed.get(state.name, symbol) for state, symbol in zip(states, values, strict=True))),
        newton_steps=torque.newton_steps or NEWTON_STEPS,
    )


def _wanted(damper: Any, link: Linkage, measured: Mapping[str, Expr], speed: Expr) -> Expr | None:
    """Force against the stroke whose torque on the gear, at rest, is what a law that commands the damper wants."""
    if not (damper.COMMANDED and damper.control):
        return None
    return -damper.control.wanted(measured, speed) / link.damper_lever


def _with_actuator(torque: Torque, actuator: Control, measured: Mapping[str, Expr], speed: Expr, corners: Corners) -> Torque:
    """The torque of linkage and damper with that of an actuator beside them."""
    own = ca.SX.sym(ACTUATOR.name)
    u, rate = actuator.torque(measured, own, speed, corners)
    with_it = replace(torque, torque=torque.torque + u, outputs={**torque.outputs, "control_torque": u})
    if rate is None:
        return with_it
    states, rates = {**torque.states, ACTUATOR.name: own}, {**torque.rates, ACTUATOR.name: rate}
    held = {**torque.relaxed, ACTUATOR.name: own + actuator.lag * rate}
    return replace(with_it, states=states, rates=rates, relaxed=held)


def _moving(wheel: Wheel, changes: Changes) -> Wheel:
    """A wheel that load and stroke move too."""

    def rate(expression: Expr) -> Expr:
        return sum(partial(expression, of) * by for of, by in changes)

    return replace(
        wheel,
        lateral_rate=wheel.lateral_rate + rate(wheel.lateral),
        swivel_rate=wheel.swivel_rate + rate(wheel.swivel),
        load_rate=rate(wheel.load),
    )


def _of_wheel(states: Sequence[State], wheel: int, wheels: int) -> list[State]:
    """States of one wheel's tyre, by names of their own where there are several wheels."""
    return [
        State(_named(s.name, wheel, wheels), s.unit, s.freedom, s.twin and _named(s.twin, wheel, wheels), s.hidden, s.even)
        for s in states
    ]


def _named(name: str, wheel: int, wheels: int) -> str:
    return name + SIDES.get(wheels, tuple(f"_{i + 1}" for i in range(wheels)))[wheel]


def _chain(names: Any, own: Sequence[State]) -> list[State]:
    """Declarations of the states between gear and damper, in the order in which they are met."""
    declared = {state.name: state for state in (*CHAIN_STATES, *own)}
    return [declared[name] for name in names]

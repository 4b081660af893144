"""What every chain from the gear to the damper keeps: the states that its compliance asks for, and energy."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from damperopt import Study
from damperopt.dampers.base import Context
from damperopt.dynamics import build
from damperopt.expressions.corners import Smooth
from damperopt.linkages.elastic import elastic_linkage
from damperopt.linkages.torque import CHAIN_STATES, damper_torque
from damperopt.ports.motion import Attachment
from damperopt.symbols import symbolic


def states_of_the_chain(study: Study) -> set[str]:
    """Those that the chain has beside the gear, the tyre and the damper; they are none, or one, as its compliance asks."""
    found = {state.name for state in build(symbolic(study)).states} & {state.name for state in CHAIN_STATES}
    link = elastic_linkage(study, study.start)
    behind = "dashpot_angle" if study.damper.ROTARY else "dashpot_stroke"
    expected = {link.coordinate} if link.links is not None else {behind} if link.series is not None else set()
    if not study.damper.FEELS_RATE:  # what it holds stands where forces balance
        expected = set()
    assert found == expected, f"the chain has the states {found}, its compliance asks for {expected}"
    return found


def energy_is_kept(study: Study, yaw: float = 0.02, frequency: float = 8.0) -> None:
    """Turned aside and back, and held until it is at rest, a chain has taken the work that its damper turned to heat."""
    if study.damper.STATES or study.damper.damping(study.start) is None:
        return  # what has states of its own stores energy, and friction holds a chain away from rest
    chain = _Chain(study)
    period, w = 1 / frequency, 2 * np.pi * frequency

    def turned(t: float) -> tuple[float, float]:
        if t >= period:
            return 0.0, 0.0
        return yaw * (1 - np.cos(w * t)) ** 2 / 4, yaw * w * np.sin(w * t) * (1 - np.cos(w * t)) / 2

    def rates(t: float, x: np.ndarray) -> np.ndarray:
        states, torque, heat = chain(x[:-2], *turned(t))
        return np.array([*states, -torque * turned(t)[1], heat])

    def slopes(t: float, x: np.ndarray) -> np.ndarray:
        steps = 1e-9 * np.eye(x.size)[: x.size - 2]  # nothing hangs on the work and the heat so far
        columns = [(rates(t, x + step) - rates(t, x - step)) / 2e-9 for step in steps]
        return np.array([*columns, np.zeros(x.size), np.zeros(x.size)]).T

    def away(t: float, x: np.ndarray) -> float:
        """From rest, where the rounding of a closed loop is all that still moves."""
        return float(np.abs(x[:-2] - chain.relaxed).max(initial=not chain.relaxed.size)) - 1e-9 if t > period else 1.0

    away.terminal, away.direction = True, -1  # type: ignore[attr-defined]
    x0 = np.array([*chain.relaxed, 0.0, 0.0])
    scale = np.array([*(1e-6 for _ in chain.relaxed), 1.0, 1.0])
    x = x0
    # a turn that starts from rest is not stepped over; what comes to rest may be
    for end, step in (((0.0, period), period / 20), ((period, 400 * period), np.inf)):
        motion = solve_ivp(rates, end, x, "Radau", max_step=step, events=away, rtol=1e-9, atol=1e-9 * scale, jac=slopes)
        assert motion.success, motion.message
        x = motion.y[:, -1]
    assert np.abs(x[:-2] - chain.relaxed).max(initial=0) < 1e-6, "held still, the chain does not come to rest"
    taken, heat = x[-2:]
    assert heat > 0, "nothing is turned to heat"
    assert taken == pytest.approx(heat, rel=1e-6), "work is lost or won"


class _Chain:
    """Rates of the states of a chain that is turned by hand, its torque, and the power of its damper."""

    def __init__(self, study: Study):
        damper, design = study.damper, study.start
        angle, rate = ca.SX.sym("angle"), ca.SX.sym("rate")
        made = damper_torque(damper, elastic_linkage(study, design), design, Smooth(), Attachment(angle, rate), Context())
        x, z = ca.vertcat(ca.SX(0, 1), *made.states.values()), ca.vertcat(ca.SX(0, 1), *made.unknowns)
        force, speed = (made.outputs[name] for name in (POWER[damper.ROTARY]))
        found = [ca.vertcat(ca.SX(0, 1), *made.rates.values()), made.torque, force * speed]
        self._function = ca.Function("chain", [x, angle, rate, z], [ca.SX(value) for value in found])
        self._z = np.array([float(value) for value in made.rest])
        self._root = None
        if self._z.size:
            residuals = ca.Function("closed", [z, ca.vertcat(x, angle, rate)], [ca.vertcat(*made.residuals)])
            self._root = ca.rootfinder("root", "newton", residuals, {"abstol": 1e-13})
        held = [ca.SX(made.relaxed.get(name, 0)) for name in made.states]
        self.relaxed = np.array([float(ca.evalf(ca.substitute(value, angle, 0))) for value in held])

    def __call__(self, x: np.ndarray, angle: float, rate: float) -> tuple[np.ndarray, float, float]:
        if self._root is not None:
            self._z = self._root(self._z, [*x, angle, rate]).full().ravel()
        states, torque, power = self._function(x, angle, rate, self._z)
        return states.full().ravel(), float(torque), float(power)


POWER = {False: ("damper_force", "damper_speed"), True: ("damper_torque", "damper_rate")}
"""Outputs of a linear damper, and of a rotary one."""

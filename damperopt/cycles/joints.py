"""A gear with gaps, stops and friction: its equations in every mode of its joints, and the events between them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import casadi as ca
import numpy as np

from ..dynamics import build
from ..expressions.dae import DAE
from ..motion.grip import grip_of, one_friction
from ..study.study import Study
from ..symbols import symbolic
from .elements import Events
from .flow import Flow
from .newton import Condition

__all__ = ["Event", "Jointed", "JointedFlow", "Signs"]

CLOSED_STEPS = 3
"""Of Newton's method for the unknowns at an event."""


@dataclass(frozen=True)
class Event:
    """The end of a leg.

    Attributes
    ----------
    row : int
        Which value vanishes: argument of a corner, the rate of the friction, or what it can hold beyond what drives it.
    """

    row: int


@dataclass(frozen=True)
class Signs:
    """Values at k points: arguments of the corners (k, s), rate (k,) and reserve of the friction to both sides (k, 2)."""

    corners: np.ndarray
    rate: np.ndarray
    reserve: np.ndarray


class JointedFlow(Flow):
    """The equations in one set of modes; `sticks` where friction holds."""

    owner: Jointed
    sticks: bool = False

    @property
    def mirrored(self) -> Flow:
        """With the modes that the mirrored motion has."""
        return self.owner.flow(-self.modes[self.owner.partners], self.sticks)


class Jointed:
    """Equations of a study with its joints as they are.

    Parameters
    ----------
    study : Study

    Attributes
    ----------
    names : tuple of str
        Of the corners with a mode each; that of the friction comes last, where there is one.
    rubs : bool
        Whether there is friction.
    """

    def __init__(self, study: Study):
        corners = Events()
        dae, friction = one_friction(build(symbolic(study), corners), corners)
        self.study, self.names, self.rubs = study, tuple(corners.switches), friction is not None
        modes = ca.vertcat(ca.SX(0, 1), *(switch.mode for switch in corners.switches.values()))
        if friction is not None:
            modes = ca.vertcat(modes, friction.mode)
        self.partners = np.array([self._partner(name) for name in self.names] + [len(self.names)] * self.rubs, int)
        grip = grip_of(dae, friction)
        self._flows = {False: self._made(dae, modes)}
        if friction is not None:
            holding = ca.substitute(dae.ode, friction.mode, grip[1] / grip[2])
            outputs = {name: ca.substitute(ca.SX(e), friction.mode, grip[1] / grip[2]) for name, e in dae.outputs.items()}
            self._flows[True] = self._made(replace(dae, ode=holding, outputs=outputs), modes)
        arguments = [switch.argument for switch in corners.switches.values()]
        values = ca.vertcat(ca.SX(0, 1), *arguments, grip[0], grip[2] - grip[1], grip[2] + grip[1])
        self._values = _event_function(dae, modes, ca.substitute(values, dae.yaw_torque, 0))

    def _partner(self, name: str) -> int:
        """The corner that a mirrored motion meets in the place of this one."""
        other = name[:-1] + {"+": "-", "-": "+"}[name[-1]]
        return self.names.index(other)

    def _made(self, dae: DAE, modes: ca.SX) -> JointedFlow:
        flow = JointedFlow(self.study, dae, modes)
        flow.owner = self
        return flow

    def flow(self, modes: np.ndarray, sticks: bool = False) -> JointedFlow:
        """The equations with the modes (s,) of all corners."""
        found = self._flows[sticks].with_modes(modes)
        assert isinstance(found, JointedFlow)
        found.sticks = sticks
        return found

    @property
    def any(self) -> JointedFlow:
        """The equations in some set of modes: for names and sizes."""
        return self.flow(np.ones(len(self.partners)))

    @property
    def rate_row(self) -> int:
        """Row of the friction's rate among the values of events; the reserve against + and - follow it."""
        return len(self.names)

    def mirrored_row(self, row: int) -> int:
        """The row that vanishes at the mirrored event."""
        if row < self.rate_row:
            return int(self.partners[row])
        return {0: row, 1: row + 1, 2: row - 1}[row - self.rate_row]

    def signs(self, flow: Flow, x: np.ndarray, parameters: np.ndarray) -> Signs:
        """Values at states x (k, n) in the modes of a flow."""
        rows = np.array([self._evaluated(flow, point, parameters, np.zeros_like(parameters))[0] for point in x])
        s = self.rate_row
        return Signs(rows[:, :s], rows[:, s], rows[:, s + 1 :])

    def condition(self, flow: Flow, row: int) -> Condition:
        """That a value of `signs` vanishes in the modes of a flow."""

        def at(x: np.ndarray, parameters: np.ndarray, direction: np.ndarray) -> tuple[float, np.ndarray, float]:
            values, gradients, slopes = self._evaluated(flow, x, parameters, direction)
            return float(values[row]), gradients[row], float(slopes[row])

        return at

    def _evaluated(
        self, flow: Flow, x: np.ndarray, parameters: np.ndarray, direction: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        z = flow.unknowns(x[None], parameters)
        for _ in range(CLOSED_STEPS if flow.m else 0):
            z = z + flow.slopes(x[None], z, parameters, 0 * direction).unknowns[0]
        values, gradients, slopes = self._values(x, z.ravel(), np.concatenate([parameters, flow.modes]), direction)
        return values.full().ravel(), gradients.full(), slopes.full().ravel()


def _event_function(dae: DAE, modes: ca.SX, values: ca.SX) -> ca.Function:
    """(x, z, parameters and modes, direction) -> values, their total gradients over x and slopes along the direction."""
    parameters = ca.vertcat(dae.design, dae.speed, dae.load, dae.data)
    direction = ca.SX.sym("direction", parameters.numel())
    gradients, slopes = ca.jacobian(values, dae.x), ca.jtimes(values, parameters, direction)
    if dae.z.numel():
        g = ca.substitute(dae.alg, dae.yaw_torque, 0)
        by_z = -ca.jacobian(values, dae.z) @ ca.inv_minor(ca.jacobian(g, dae.z))
        gradients, slopes = gradients + by_z @ ca.jacobian(g, dae.x), slopes + by_z @ ca.jtimes(g, parameters, direction)
    inputs = [dae.x, dae.z, ca.vertcat(parameters, modes), direction]
    return ca.Function("events", inputs, [ca.densify(e) for e in (values, gradients, slopes)])

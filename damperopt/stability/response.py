"""The structure of a gear between its wheels and the ground: inputs F_y, M_z and outputs eta, theta of each wheel.

x' = A x + B u, y = C x with u = (F_y, M_z) and y = (eta, theta), wheel after wheel. All that is no tyre is in it, the moment
of the tread width too. The tyre closes the loop, u = T(lambda/V) y, so that the gear has its eigenvalues where
det(lambda - A) det(1 - T C (lambda - A)^-1 B) vanishes, for any line of contact. Force and moment act where the gear says,
which with rake is not where eta and theta are measured: B is not the transpose of C.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar

import casadi as ca
import numpy as np

from ..dynamics import build
from ..expressions.calculus import Expr
from ..expressions.corners import Corners
from ..ports.wheel import Contact, Wheel
from ..quantities.named import Output, State
from ..study.study import Study
from ..symbols import data_values, symbolic
from ..tyres.base import Linear
from ..tyres.string import Footprint, StringLine
from .family import united

__all__ = ["FOOTPRINT", "Structure"]

FOOTPRINT = tuple(
    f"{field.name}[{k}]" if field.name in ("force", "moment") else field.name
    for field in fields(Footprint)
    for k in range(3 if field.name in ("force", "moment") else 1)
)
"""Names of the numbers of a `Footprint` in a row."""


class _Pushed:
    """In the place of a tyre: force and moment are inputs, position and swivel of the wheel outputs."""

    OUTPUTS: ClassVar[tuple[Output, ...]] = ()
    states: ClassVar[tuple[State, ...]] = ()

    def __init__(self, tyre: Any):
        self.tyre = tyre
        self.inputs: list[ca.SX] = []
        self.wheels: list[Wheel] = []

    def on_ground(self, wheel: Wheel, states: Sequence[Expr], corners: Corners) -> Contact:
        """Contact of one wheel."""
        F, M = (ca.SX.sym(f"{name}_{len(self.wheels)}") for name in ("F_y", "M_z"))
        self.inputs += [F, M]
        self.wheels.append(wheel)
        M_kappa = self.tyre.tread_width_moment * wheel.swivel_rate / wheel.speed
        own = self.tyre.of_wheel(wheel)
        linear = Linear(*own.linear(wheel.load, own.pressure))
        K_y = self.tyre.contact.side_stiffness(linear)
        return Contact((), F, M + M_kappa, deflection=None if K_y is None else F / K_y, wheel=wheel)


@dataclass(frozen=True)
class Blocks:
    """Matrices of a structure at m points: A (m, n, n), B (m, n, 2 w), C (m, 2 w, n) for w wheels."""

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray

    def transfer(self, s: np.ndarray) -> np.ndarray:
        """C (s - A)^-1 B at one s [1/s] for each point, (m, 2 w, 2 w)."""
        n = self.A.shape[1]
        return self.C @ np.linalg.solve(s[:, None, None] * np.eye(n) - self.A, self.B.astype(complex))


class Structure:
    """Structure of a study's gear, built once.

    Parameters
    ----------
    study : Study

    Attributes
    ----------
    states : tuple of State
        Of gear and damper.
    wheels : int
    system : casadi.Function
        (design, speed, load, data) -> [[A, B], [C, 0]].
    footprint : casadi.Function or None
        (load, data) -> (w, 12) numbers of each wheel's `Footprint`, by `FOOTPRINT`; None for tyres of another kind.
    powers : Powers
        Of speed and load in the system.
    """

    def __init__(self, study: Study):
        symbols = symbolic(study)
        tyre = _Pushed(symbols.study.tyre)
        blocks = {key: getattr(symbols.study, key) for key in Study.model_fields} | {"tyre": tyre}
        dae = build(replace(symbols, study=Study.model_construct(**blocks)))
        self.states, self.wheels = dae.states, len(tyre.wheels)
        shown = ca.vertcat(*(value for wheel in tyre.wheels for value in (wheel.lateral, wheel.swivel)))
        v, f = ca.vertcat(dae.x, *tyre.inputs), ca.vertcat(dae.ode, shown)
        at_rest = ca.vertcat(v, dae.z), ca.vertcat(ca.SX.zeros(v.shape), dae.rest)
        f_v, f_z, g_v, g_z = (
            ca.substitute(ca.jacobian(e, of), *at_rest) for e, of in itertools.product((f, dae.alg), (v, dae.z))
        )
        system = ca.densify(f_v - f_z @ ca.inv_minor(g_z) @ g_v if dae.z.numel() else f_v)
        self.system = ca.Function("system", [dae.design, dae.speed, dae.load, dae.data], [system])
        parts = study.gear, study.damper, study.damper.actuator, _ground(study)
        self.design_names, self.powers = dae.design_names, united(*parts)
        self._data = ca.DM(data_values(study))
        self.footprint = None
        line: Any = symbols.study.tyre.contact
        if isinstance(line, StringLine):
            rows = [_numbers(line, tyre.tyre, wheel) for wheel in tyre.wheels]
            self.footprint = ca.Function("footprint", [dae.load, dae.data], [ca.densify(ca.vertcat(*rows))])

    def at(self, design: Any, speeds: np.ndarray, loads: np.ndarray, data: Any = None) -> Blocks:
        """Blocks at m points.

        Parameters
        ----------
        design : array_like
            (d,) or (d, m) design variables [SI].
        speeds, loads : ndarray
            (m,) [m/s], [N].
        data : array_like or None
            (k, m) numbers of the study; None: its own.

        Returns
        -------
        Blocks
        """
        n, m = len(self.states), speeds.size
        values = ca.DM(design) if np.ndim(design) == 2 else ca.repmat(ca.DM(design), 1, m)
        data = self._data if data is None else ca.DM(data)
        whole = self.system(values, speeds.reshape(1, -1), loads.reshape(1, -1), data).full()
        whole = whole.reshape(len(whole), m, len(whole)).transpose(1, 0, 2)
        return Blocks(whole[:, :n, :n], whole[:, :n, n:], whole[:, n:, :n])

    def footprints(self, loads: np.ndarray, data: Any = None) -> np.ndarray:
        """Numbers of each wheel's footprint at loads (m,) [N], (m, w, 12); of other data (k, m), if given."""
        assert self.footprint is not None
        found = self.footprint(loads.reshape(1, -1), self._data if data is None else ca.DM(data)).full()
        return found.reshape(self.wheels, loads.size, len(FOOTPRINT)).transpose(1, 0, 2)


def _numbers(line: StringLine, tyre: Any, wheel: Wheel) -> ca.SX:
    own = tyre.of_wheel(wheel)
    part = line.footprint(Linear(*own.linear(wheel.load, own.pressure)))
    values = (getattr(part, field.name) for field in fields(part))
    return ca.horzcat(*(ca.SX(x) for value in values for x in (value if isinstance(value, tuple) else (value,))))


class _TreadWidth:
    """What the moment of the tread width, kappa theta'/V, brings in."""

    SPEED_POWERS: ClassVar = (-1, 0)
    LOAD_POWERS: ClassVar[tuple[int, ...] | None] = (0,)


class _Deflected(_TreadWidth):
    """The same, and the tyre's stiffness at its load in a denominator."""

    LOAD_POWERS: ClassVar = None


def _ground(study: Study) -> type[_TreadWidth]:
    drag = getattr(study.gear, "drag", None)
    return _Deflected if drag is not None and drag.lateral_stiffness is None else _TreadWidth

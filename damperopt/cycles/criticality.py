"""Whether the limit cycles of a critical speed begin soft or hard: the first Lyapunov coefficient.

Near a Hopf point the amplitude |w| of the critical pair obeys |w|' = |w| (Re lambda + Re(c_1) |w|^2) with
c_1 = (<p, C(q, q, q*)> - 2 <p, B(q, A^-1 B(q, q*))> + <p, B(q*, (2 i omega - A)^-1 B(q, q))>)/2, where A q = i omega q,
A^T p = -i omega p, <p, q> = 1, and B and C are second and third derivatives. Source: Kuznetsov (2004), (5.39).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import product
from typing import Literal

import casadi as ca
import numpy as np

from ..dynamics import build
from ..expressions.dae import eliminate
from ..stability.critical import CriticalSpeed
from ..study.study import Study
from ..symbols import data_values, symbolic
from .elements import Closed

__all__ = ["Criticality", "NormalForm"]

DEGENERATE = 1e-6
"""|Re c_1| over omega, per square radian of yaw, below which it counts as zero: a law without curvature."""


@dataclass(frozen=True)
class Criticality:
    """How limit cycles begin at a critical speed.

    Attributes
    ----------
    speed, load : float
        [m/s], [N]
    coefficient : float
        Change of the growth rate by the square of the amplitude of the leading state, Re(c_1)/4 [1/s per its unit squared].
    leading : str
        ``yaw_angle``, or another state where the mode has no yaw.
    kind : str
        ``supercritical``: a small stable cycle grows on the unstable side; ``subcritical``: an unstable one on the stable side;
        ``degenerate``: neither, to this order.
    stable_below : bool
        Whether the stable side is that of lower speeds.
    """

    speed: float
    load: float
    coefficient: float
    leading: str
    kind: Literal["supercritical", "subcritical", "degenerate"]
    stable_below: bool


class NormalForm:
    """Derivatives of a study's equations at rest, joints closed, to the third.

    Parameters
    ----------
    study : Study
    """

    def __init__(self, study: Study):
        dae = eliminate(build(symbolic(study), Closed()))
        self._states, self._data = dae.states, np.array(data_values(study))
        self._design_names = dae.design_names
        u, v, w = (ca.SX.sym(name, dae.x.numel()) for name in "uvw")
        parameters = ca.vertcat(dae.design, dae.speed, dae.load, dae.data)
        f = ca.substitute(dae.ode, dae.yaw_torque, 0)
        second = ca.jtimes(ca.jtimes(f, dae.x, u), dae.x, v)
        third = ca.jtimes(second, dae.x, w)
        at_rest = dae.x, ca.SX.zeros(dae.x.shape)
        A, B, C = (ca.densify(ca.substitute(e, *at_rest)) for e in (ca.jacobian(f, dae.x), second, third))
        self._A = ca.Function("A", [parameters], [A])
        self._B = ca.Function("B", [parameters, u, v], [B])
        self._C = ca.Function("C", [parameters, u, v, w], [C])

    def at(self, design: Mapping[str, float], critical: CriticalSpeed) -> Criticality:
        """Criticality of a design at a critical speed of the kind ``hopf``."""
        given = [design[name] for name in self._design_names]
        parameters = np.concatenate([given, [critical.speed, critical.load], self._data])
        c_1, leading, frequency = self.coefficient(parameters, 2 * np.pi * critical.frequency)
        kind: Literal["supercritical", "subcritical", "degenerate"] = "supercritical" if c_1 < 0 else "subcritical"
        if abs(c_1) <= DEGENERATE * frequency:
            kind = "degenerate"
        return Criticality(critical.speed, critical.load, c_1 / 4, leading, kind, critical.destabilising)

    def coefficient(self, parameters: np.ndarray, near: float) -> tuple[float, str, float]:
        """Re(c_1), the state that is 1 in q, and omega [rad/s] of the eigenvalue next to i `near`."""
        A = self._A(parameters).full()
        values, vectors = np.linalg.eig(A)
        k = int(np.abs(values - 1j * near).argmin())
        omega, q = float(values[k].imag), vectors[:, k]
        names = [state.name for state in self._states]
        lead = names.index("yaw_angle")
        if abs(q[lead]) < 1e-6 * np.linalg.norm(q):
            lead = int(np.abs(q).argmax())
        q = q / q[lead]
        left_values, left = np.linalg.eig(A.T)
        p = left[:, np.abs(left_values - values[k]).argmin()]
        p = p / (p @ q)  # without conjugates: p A = lambda p

        def B(a: np.ndarray, b: np.ndarray) -> np.ndarray:
            return _complex(lambda *real: self._B(parameters, *real), a, b)

        n = len(q)
        of_mean = np.linalg.solve(A, B(q, q.conj()))
        of_double = np.linalg.solve(2j * omega * np.eye(n) - A, B(q, q))
        cubic = _complex(lambda *real: self._C(parameters, *real), q, q, q.conj())
        c_1 = p @ (cubic - 2 * B(q, of_mean) + B(q.conj(), of_double)) / 2
        return float(c_1.real), names[lead], omega


def _complex(form: Callable[..., ca.DM], *vectors: np.ndarray) -> np.ndarray:
    """A multilinear form of real vectors at complex ones."""
    total: np.ndarray = np.zeros(len(vectors[0]), complex)
    for parts in product((0, 1), repeat=len(vectors)):
        real = [vector.imag if part else vector.real for vector, part in zip(vectors, parts, strict=True)]
        total = total + 1j ** sum(parts) * form(*real).full().ravel()
    return total

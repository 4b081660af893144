"""Many designs at once: whether each keeps the margin at a few speeds, without a single eigenvalue.

Stiffness and damping of a damper enter det(s 1 - A) in one place, as k_psi + s c_psi, and so linearly: three matrices per
speed give the characteristic polynomial of every design. Used to draw feasible regions and to choose starting points.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import casadi as ca
import numpy as np

from ..study.envelope import Envelope
from ..study.study import Study
from ..symbols import data_names, data_values
from .hurwitz import characteristic_polynomial, lienard_chipart, shifted
from .linear import LinearModel, spectral_abscissa

__all__ = ["SPEEDS", "Screening", "worst_abscissae_of"]

SPEEDS = 24
"""Speeds at each load at which conditions are looked at; eigenvalues, which cost more, at a third of them."""

DECAY_SPEEDS, PER_CYCLE = 5, 14
"""A look at decay, to choose starts: speeds, and times in a cycle of the slowest mode."""

STIFFNESS, DAMPING = 1e5, 1e3
"""Of the second and third matrix; any numbers of the right size [N m/rad], [N m s/rad]."""

CREEPING = 1.0
"""Rate [rad/s] below which a mode is a creep and sets no time scale."""

OVERFLOW = 50.0
"""Exponent that a growing motion reaches at most at the end."""


class Screening:
    """The gear of a study with any stiffness and damping about the strut axis in the place of its damper; built once.

    Parameters
    ----------
    study : Study
        Its damper has no part in it, nor has an actuator.
    """

    def __init__(self, study: Study):
        bare = study.replace(
            damper={"topology": "rotational", "torsional_stiffness": 0.0, "torsional_damping": 0.0},
            **({"requirements__fail_safe_margin": None} if study.requirements else {}),
            **({"gear__strut__torsional_stiffness": None} if study.gear.strut else {}),  # in the place of what is asked
        )
        self._study, self._model = study, LinearModel(bare)
        self._data = dict(zip(data_names(bare), data_values(bare), strict=True))

    def least_conditions(self, k_psi: np.ndarray, c_psi: np.ndarray, more: Sequence[tuple[float, float]] = ()) -> np.ndarray:
        """Least stability condition of each (k_psi, c_psi) over a few points of the envelope.

        Parameters
        ----------
        k_psi, c_psi : ndarray
            (m,) torsional stiffness [N m/rad] and damping [N m s/rad].
        more : sequence of (speed, load)
            Points to look at besides 24 speeds at each load [m/s], [N].

        Returns
        -------
        ndarray
            (m,) least Lienard-Chipart condition, each scaled by its median size; > 0 where the margin holds at the points.
        """
        margin = self._study.required.stability_margin
        V, F_z = _points(self._study.envelope, SPEEDS, more)
        base, per_k, per_c = (_polynomial(A) for A in self._affine_matrices(V, F_z))
        per_k, per_c = per_k - base, per_c - base
        least = np.full(k_psi.size, np.inf)
        for j in range(V.size):
            a = [base[i, j] + per_k[i, j] * k_psi / STIFFNESS + per_c[i, j] * c_psi / DAMPING for i in range(len(base))]
            for condition in lienard_chipart(shifted(a, margin)).values():
                least = np.minimum(least, condition / max(np.median(np.abs(condition)), 1e-300))
        return least

    def worst_abscissae(
        self, k_psi: np.ndarray, c_psi: np.ndarray, more: Sequence[tuple[float, float]] = (), speeds: int = SPEEDS // 3
    ) -> np.ndarray:
        """Largest spectral abscissa of each (k_psi, c_psi) over a few points of the envelope.

        Parameters
        ----------
        k_psi, c_psi : ndarray
            (m,) torsional stiffness [N m/rad] and damping [N m s/rad].
        more : sequence of (speed, load)
            Points to look at besides [m/s], [N].
        speeds : int
            Looked at, at each load.

        Returns
        -------
        ndarray
            (m,) [1/s]
        """
        worst = np.full(k_psi.size, -np.inf)
        for A in self._matrices(k_psi, c_psi, speeds, more):
            worst = np.maximum(worst, spectral_abscissa(A))
        return worst

    def linear_decay(self, k_psi: np.ndarray, c_psi: np.ndarray, per_cycle: int = PER_CYCLE) -> np.ndarray:
        """Largest decay ratio of each (k_psi, c_psi) over a few points of the envelope, by modal superposition.

        Parameters
        ----------
        k_psi, c_psi : ndarray
            (m,) torsional stiffness [N m/rad] and damping [N m s/rad].
        per_cycle : int
            Times in a cycle of the slowest mode: many for an even curve, few to compare designs.

        Returns
        -------
        ndarray
            (m,) of the linear gear; infinite where it grows. The study has a decay requirement.
        """
        required, names = self._study.required.decay, self._model.state_names
        assert required is not None
        angle, rate = names.index("yaw_angle"), names.index("yaw_rate")
        x0 = np.array(required.disturbance.start(names))
        cycles = np.linspace(0, required.cycles + 1.5, int(per_cycle * (required.cycles + 1.5)))
        stride = math.isqrt(cycles.size)  # exp(s t) = exp(s t_far) exp(s t_near): a root of the exponentials is enough
        far, near = np.arange(-(-cycles.size // stride)) * stride * cycles[1], np.arange(stride) * cycles[1]
        worst = np.zeros(k_psi.size)
        for A in self._matrices(k_psi, c_psi, DECAY_SPEEDS):
            roots, modes = np.linalg.eig(A)
            start = np.broadcast_to(x0 + 0j, (k_psi.size, x0.size))[..., None]
            parts = np.linalg.solve(modes, start)[..., 0] * modes[:, angle, :]
            slowest = np.where(np.abs(roots.imag) > CREEPING, np.abs(roots.imag), np.inf).min(axis=1)
            alone = np.sqrt(np.maximum(-A[:, rate, angle], CREEPING**2))
            period = 2 * np.pi / np.minimum(slowest, alone)
            exponent = period[:, None] * roots
            exponent = np.minimum(exponent.real, OVERFLOW / cycles[-1]) + 1j * exponent.imag  # of one cycle
            blocks = parts[:, None, :] * np.exp(exponent[:, None, :] * far[:, None])
            psi = (blocks @ np.exp(exponent[:, :, None] * near)).real.reshape(len(A), -1)[:, : cycles.size]
            passed = np.cumsum(psi[:, 1:] * psi[:, :-1] < 0, axis=1) >= 2 * required.cycles
            later = np.abs(np.where(passed | (cycles[1:] > 2 * required.cycles), psi[:, 1:], 0.0)).max(axis=1)
            worst = np.maximum(worst, later / np.abs(psi[:, : 2 * per_cycle]).max(axis=1))
        return worst

    def _matrices(
        self, k_psi: np.ndarray, c_psi: np.ndarray, speeds: int, more: Sequence[tuple[float, float]] = ()
    ) -> Iterator[np.ndarray]:
        """State matrices (m, n, n) of every (k_psi, c_psi), point by point of the envelope."""
        base, per_k, per_c = self._affine_matrices(*_points(self._study.envelope, speeds, more))
        for at_rest, with_k, with_c in zip(base, per_k, per_c, strict=True):
            A = at_rest + np.multiply.outer(k_psi / STIFFNESS, with_k - at_rest)
            A += np.multiply.outer(c_psi / DAMPING, with_c - at_rest)
            yield A

    def _affine_matrices(self, V: np.ndarray, F_z: np.ndarray) -> list[np.ndarray]:
        """State matrices without damper, with the stiffness `STIFFNESS` alone, and with the damping `DAMPING` alone."""
        n, found = len(self._model.state_names), []
        for k_psi, c_psi in ((0.0, 0.0), (STIFFNESS, 0.0), (0.0, DAMPING)):
            numbers = self._data | {"damper.torsional_stiffness": k_psi, "damper.torsional_damping": c_psi}
            data = ca.repmat(ca.DM(list(numbers.values())), 1, V.size)
            A = self._model.state_matrix(ca.DM(0, V.size), V.reshape(1, -1), F_z.reshape(1, -1), data)
            found.append(A.full().reshape(n, V.size, n).transpose(1, 0, 2))
        return found


def worst_abscissae_of(
    model: LinearModel, study: Study, designs: np.ndarray, more: Sequence[tuple[float, float]] = ()
) -> np.ndarray:
    """Largest spectral abscissa of designs over a few points of the envelope, for models of any kind.

    Parameters
    ----------
    model : LinearModel
        Of the study.
    study : Study
    designs : ndarray
        (m, n) design variables [SI].
    more : sequence of (speed, load)
        Points to look at besides a few speeds at each load [m/s], [N].

    Returns
    -------
    ndarray
        (m,) [1/s]
    """
    worst = np.full(len(designs), -np.inf)
    n, data = len(model.state_names), ca.repmat(ca.DM(data_values(study)), 1, len(designs))
    for V, F_z in zip(*_points(study.envelope, SPEEDS // 3, more), strict=True):
        A = model.state_matrix(designs.T, float(V), float(F_z), data).full().reshape(n, len(designs), n)
        worst = np.maximum(worst, spectral_abscissa(A.transpose(1, 0, 2)))
    return worst


def _points(envelope: Envelope, speeds: int, more: Sequence[tuple[float, float]] = ()) -> tuple[np.ndarray, np.ndarray]:
    grid = np.unique(np.geomspace(envelope.speed.min, envelope.speed.max, speeds))
    V, F_z = np.array([(V, F_z) for F_z in envelope.loads for V in grid] + list(more)).T
    return V, F_z


def _polynomial(A: np.ndarray) -> np.ndarray:
    """Coefficients of det(s 1 - A) of stacked matrices, (n + 1, m)."""
    return np.array([np.broadcast_to(a_i, len(A)) for a_i in characteristic_polynomial(A)])

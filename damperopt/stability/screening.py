"""Many designs at once: whether each keeps the margin at a few speeds, without a single eigenvalue.

Stiffness and damping of a damper enter det(s 1 - A) in one place, as k_psi + s c_psi, and so linearly: three matrices per
speed give the characteristic polynomial of every design. Used to draw feasible regions and to choose starting points.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import casadi as ca
import numpy as np

from ..study.study import Study
from ..symbols import data_values
from .hurwitz import characteristic_polynomial, lienard_chipart, shifted
from .linear import LinearModel, linear_gear, spectral_abscissa

__all__ = ["least_conditions", "linear_decay", "worst_abscissae", "worst_abscissae_of"]

SPEEDS = 24
DECAY_SPEEDS, PER_CYCLE = 5, 14  # a look at decay, to choose starts
STIFFNESS, DAMPING = 1e5, 1e3  # of the second and third matrix; any numbers of the right size


def least_conditions(
    study: Study, k_psi: np.ndarray, c_psi: np.ndarray, more: Sequence[tuple[float, float]] = ()
) -> np.ndarray:
    """Least stability condition of each (k_psi, c_psi) over a few points of the envelope.

    Parameters
    ----------
    study : Study
    k_psi, c_psi : ndarray
        (m,) torsional stiffness [N m/rad] and damping [N m s/rad].
    more : sequence of (speed, load)
        Points to look at besides 24 speeds at each load [m/s], [N].

    Returns
    -------
    ndarray
        (m,) least Lienard-Chipart condition, each scaled by its median size; > 0 where the margin holds at the points.
    """
    margin = study.required.stability_margin
    V, F_z = _points(study, SPEEDS, more)
    base, per_k, per_c = (_polynomial(A) for A in _affine_matrices(study, V, F_z))
    per_k, per_c = per_k - base, per_c - base
    least = np.full(k_psi.size, np.inf)
    for j in range(V.size):
        a = [base[i, j] + per_k[i, j] * k_psi / STIFFNESS + per_c[i, j] * c_psi / DAMPING for i in range(len(base))]
        for condition in lienard_chipart(shifted(a, margin)).values():
            least = np.minimum(least, condition / max(np.median(np.abs(condition)), 1e-300))
    return least


def worst_abscissae(study: Study, k_psi: np.ndarray, c_psi: np.ndarray) -> np.ndarray:
    """Largest spectral abscissa of each (k_psi, c_psi) over a few points of the envelope.

    Parameters
    ----------
    study : Study
    k_psi, c_psi : ndarray
        (m,) torsional stiffness [N m/rad] and damping [N m s/rad].

    Returns
    -------
    ndarray
        (m,) [1/s]
    """
    V, F_z = _points(study, SPEEDS // 3)
    base, per_k, per_c = _affine_matrices(study, V, F_z)
    worst = np.full(k_psi.size, -np.inf)
    for j in range(V.size):
        A = base[j] + np.multiply.outer(k_psi / STIFFNESS, per_k[j] - base[j])
        A += np.multiply.outer(c_psi / DAMPING, per_c[j] - base[j])
        worst = np.maximum(worst, spectral_abscissa(A))
    return worst


def worst_abscissae_of(study: Study, designs: np.ndarray, more: Sequence[tuple[float, float]] = ()) -> np.ndarray:
    """Largest spectral abscissa of designs over a few points of the envelope, for models of any kind.

    Parameters
    ----------
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
    model, worst = LinearModel(study), np.full(len(designs), -np.inf)
    n, data = len(model.state_names), ca.repmat(ca.DM(data_values(study)), 1, len(designs))
    for V, F_z in zip(*_points(study, SPEEDS // 3, more), strict=True):
        A = model.state_matrix(designs.T, float(V), float(F_z), data).full().reshape(n, len(designs), n)
        worst = np.maximum(worst, spectral_abscissa(A.transpose(1, 0, 2)))
    return worst


def linear_decay(study: Study, k_psi: np.ndarray, c_psi: np.ndarray, per_cycle: int = PER_CYCLE) -> np.ndarray:
    """Largest decay ratio of each (k_psi, c_psi) over a few points of the envelope, by modal superposition.

    Parameters
    ----------
    study : Study
        With a decay requirement.
    k_psi, c_psi : ndarray
        (m,) torsional stiffness [N m/rad] and damping [N m s/rad].
    per_cycle : int
        Times in a cycle of the slowest mode: many for an even curve, few to compare designs.

    Returns
    -------
    ndarray
        (m,) of the linear gear; infinite where it grows.
    """
    required = study.required.decay
    assert required is not None
    V, F_z = _points(study, DECAY_SPEEDS)
    base, per_k, per_c = _affine_matrices(study, V, F_z)
    x0 = np.array(required.disturbance.start(linear_gear(study.replace(damper=_damper(0.0, 0.0))).state_names))
    cycles = np.linspace(0, required.cycles + 1.5, int(per_cycle * (required.cycles + 1.5)))
    worst = np.zeros(k_psi.size)
    for j in range(V.size):
        A = base[j] + np.multiply.outer(k_psi / STIFFNESS, per_k[j] - base[j])
        A += np.multiply.outer(c_psi / DAMPING, per_c[j] - base[j])
        roots, modes = np.linalg.eig(A)
        parts = np.linalg.solve(modes, np.broadcast_to(x0 + 0j, (k_psi.size, x0.size))[..., None])[..., 0] * modes[:, 0, :]
        slowest = np.where(np.abs(roots.imag) > 1.0, np.abs(roots.imag), np.inf).min(axis=1)
        period = 2 * np.pi / np.minimum(slowest, np.sqrt(np.maximum(-A[:, 1, 0], 1.0)))
        exponent = roots[:, :, None] * (period[:, None] * cycles)[:, None, :]
        psi = np.einsum("mi,mit->mt", parts, np.exp(np.minimum(exponent.real, 50.0) + 1j * exponent.imag)).real
        passed = np.cumsum(psi[:, 1:] * psi[:, :-1] < 0, axis=1) >= 2 * required.cycles
        later = np.abs(np.where(passed | (cycles[1:] > 2 * required.cycles), psi[:, 1:], 0.0)).max(axis=1)
        worst = np.maximum(worst, later / np.abs(psi[:, : 2 * per_cycle]).max(axis=1))
    return worst


def _damper(k_psi: float, c_psi: float) -> dict[str, Any]:
    return {"topology": "rotational", "torsional_stiffness": k_psi, "torsional_damping": c_psi}


def _points(study: Study, speeds: int, more: Sequence[tuple[float, float]] = ()) -> tuple[np.ndarray, np.ndarray]:
    envelope = study.envelope
    grid = np.unique(np.geomspace(envelope.speed.min, envelope.speed.max, speeds))
    V, F_z = np.array([(V, F_z) for F_z in envelope.loads for V in grid] + list(more)).T
    return V, F_z


def _affine_matrices(study: Study, V: np.ndarray, F_z: np.ndarray) -> list[np.ndarray]:
    """State matrices without damper, with the stiffness `STIFFNESS` alone, and with the damping `DAMPING` alone."""
    dampers = (_damper(k, c) for k, c in ((0.0, 0.0), (STIFFNESS, 0.0), (0.0, DAMPING)))
    return [linear_gear(study.replace(damper=damper)).matrices(V, F_z) for damper in dampers]


def _polynomial(A: np.ndarray) -> np.ndarray:
    """Coefficients of det(s 1 - A) of stacked matrices, (n + 1, m)."""
    return np.array([np.broadcast_to(a_i, len(A)) for a_i in characteristic_polynomial(A)])

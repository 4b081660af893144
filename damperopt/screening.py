"""Many designs at once: whether each keeps the margin at a few speeds, without a single eigenvalue.

Stiffness and damping of a damper enter det(s 1 - A) in one place, as k_psi + s c_psi, and so linearly: three matrices per
speed give the characteristic polynomial of every design. Used to draw feasible regions and to choose starting points.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .hurwitz import characteristic_polynomial, lienard_chipart, shifted
from .specs import Damper, Study
from .stability import linear_gear

__all__ = ["least_conditions"]

SPEEDS = 24
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
    envelope, margin = study.envelope, study.required.stability_margin
    speeds = np.unique(np.geomspace(envelope.speed.min, envelope.speed.max, SPEEDS))
    points = [(V, F_z) for F_z in envelope.loads for V in speeds] + list(more)
    V, F_z = np.array(points).T

    def polynomial(stiffness: float, damping: float) -> np.ndarray:
        plain = Damper(topology="rotational", torsional_stiffness=stiffness, torsional_damping=damping)
        A = linear_gear(study.replace(damper=plain)).matrices(V, F_z)
        n = A.shape[-1]
        a = characteristic_polynomial(A, np.eye(n), lambda M: np.trace(M, axis1=1, axis2=2)[:, None, None], n)
        return np.array([np.broadcast_to(np.ravel(a_i), V.shape) for a_i in a])

    base = polynomial(0.0, 0.0)
    per_k, per_c = (polynomial(STIFFNESS, 0.0) - base) / STIFFNESS, (polynomial(0.0, DAMPING) - base) / DAMPING
    least = np.full(k_psi.size, np.inf)
    for j in range(V.size):
        a = [base[i, j] + per_k[i, j] * k_psi + per_c[i, j] * c_psi for i in range(len(base))]
        for condition in lienard_chipart(shifted(a, margin)).values():
            least = np.minimum(least, condition / np.median(np.abs(condition)))
    return least

"""Boxes of stiffness, damping and lag about the yaw axis on which a gear cannot be stable.

At a speed and a load D(s) = (1 + tau s) D0(s) + (k0 + kappa s) D1(s) is affine in the three numbers: over a box its values
at one s fill a zonotope. Where 0 lies outside of it all along the line Re s = -margin, no root crosses the line within the
box; if one lies to the right of it in the middle, one does everywhere. Looked at here at a few points of the envelope and
at samples of the line: a search.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca
import numpy as np

from ..stability.linear import LinearModel
from ..stability.response import Structure
from ..study.study import Study
from ..symbols import data_names, data_values
from ..tyres.string import transit
from .rational import searched_study

__all__ = ["Contour", "Exclusion"]

SPEEDS = 14
"""At each load."""

FREQUENCIES = 480
"""Samples of the line."""

PROBE = 1e6
"""Stiffness [N m/rad] with which D1 is found."""

WIDER = 1.02
"""Factor on the size of a zonotope, for what lies between two samples."""

AWAY, FURTHER = (0.35, 1.0), (1.3, 3.0)
"""Distances of a contour from the roots that it surrounds, in parts of the way that they move; and how far one reaches that
shall hold all roots, in parts of theirs."""

SAMPLES, CLOSER, NEAREST = 60, 4, 12
"""Of each side of a contour; rounds of samples that stand four times closer, and about how many of the last."""

LEAST_SLACK = 0.03
"""Relative distance from 0 below which a proof is not tried: it would take too many pieces."""


@dataclass(frozen=True)
class Contour:
    """A rectangle -margin <= Re s <= right, low <= Im s <= high around a root at every corner of a box."""

    right: float
    low: float
    high: float


class Exclusion:
    """The gear of a study about its yaw axis, at points of its envelope.

    Parameters
    ----------
    study : Study

    Attributes
    ----------
    points : ndarray
        (p, 2) speeds and loads.
    """

    def __init__(self, study: Study):
        self._margin = study.required.stability_margin
        speed = study.envelope.speed
        speeds = np.unique(np.clip(np.geomspace(speed.min, speed.max, SPEEDS), speed.min, speed.max))
        self.points = np.array([(V, F) for F in study.envelope.loads for V in speeds])
        self._polynomials = self._rational(_bare(searched_study(study)))
        fastest = 2 * np.abs(np.array([np.roots(p) for p in self._polynomials[0]])).max() + 1e3
        self._s = -self._margin + 1j * np.concatenate([[0.0], np.geomspace(1e-2, fastest, FREQUENCIES)])
        delayed = not study.tyre.contact.RATIONAL
        self._exact = self._with_delay(_bare(study)) if delayed else None
        D0, D1 = self.parts(np.broadcast_to(self._s, (len(self.points), self._s.size)), np.arange(len(self.points)))
        self._ratio = D0 / D1

    def _rational(self, bare: Study) -> tuple[np.ndarray, np.ndarray]:
        """D0 and D1 as polynomials, (p, n + 1)."""
        model, V, F = LinearModel(bare), *self.points.T
        n, found = len(model.state_names), []
        for data in _probed(bare):
            A = model.state_matrix(ca.DM(0, V.size), V.reshape(1, -1), F.reshape(1, -1), ca.repmat(ca.DM(data), 1, V.size))
            found.append(np.array([np.poly(a) for a in A.full().reshape(n, V.size, n).transpose(1, 0, 2)]))
        return found[0], (found[1] - found[0]) / PROBE

    def _with_delay(self, bare: Study) -> tuple[list, np.ndarray]:
        structure, (V, F) = Structure(bare), self.points.T
        blocks = [structure.at([], V, F, np.repeat(np.reshape(data, (-1, 1)), V.size, axis=1)) for data in _probed(bare)]
        return blocks, structure.footprints(F)

    def parts(self, s: np.ndarray, which: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """D0 and D1 at s (m, w) of points `which` (m,); with contact memory both over a factor that has no zero there."""
        if self._exact is None:
            D0, D1 = (_horner(p[which], s) for p in self._polynomials)
            return D0, D1
        blocks, footprints = self._exact
        V, found = self.points[which, 0], []
        T = _of_tyres(footprints[which], s / V[:, None])
        for block in blocks:
            A, B, C = (getattr(block, name)[which][:, None] for name in "ABC")
            n = A.shape[-1]
            found.append(np.linalg.det(s[..., None, None] * np.eye(n) - A - B @ T @ C))
        return found[0], (found[1] - found[0]) / PROBE

    def where(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Of boxes (m, 3) of k0, kappa, tau the point at which no gear of the box keeps the margin, (m,); -1: none is seen."""
        found = np.full(len(low), -1)
        middle, radius = (low + high) / 2, (high - low) / 2 * WIDER
        s, worst = self._s, self._abscissae(middle)
        for p in np.argsort(-worst.max(axis=0)):
            asked = np.flatnonzero((found < 0) & (worst[:, p] > -self._margin))
            if not asked.size:
                continue
            G = self._ratio[p]
            moves = np.array([np.ones_like(s), s, s * G])
            free = _free(G + middle[asked] @ moves, moves, radius[asked])
            found[asked[free.all(axis=1)]] = p
        return found

    def _abscissae(self, q: np.ndarray) -> np.ndarray:
        """Largest real part of the roots at every point of the envelope, (m, p); of the rational model."""
        polynomials = self._at(q[:, None], np.arange(len(self.points)))
        return _roots(polynomials).real.max(axis=-1)

    def _at(self, q: np.ndarray, which: np.ndarray) -> np.ndarray:
        """Polynomials of D with the numbers q (..., 3), (..., n + 2)."""
        D0, D1 = (p[which] for p in self._polynomials)
        up, here = [(0, 0)] * (D0.ndim - 1) + [(0, 1)], [(0, 0)] * (D0.ndim - 1) + [(1, 0)]
        k0, kappa, tau = (q[..., i, None] for i in range(3))
        return np.pad(D0, here) + tau * np.pad(D0, up) + k0 * np.pad(D1, here) + kappa * np.pad(D1, up)

    def contours(self, low: np.ndarray, high: np.ndarray, point: int) -> list[Contour]:
        """Around the root that leaves the margin at every corner of a box (3,), (3,), the nearest first."""
        corners = np.array([[(low, high)[(i >> j) & 1][j] for j in range(3)] for i in range(8)])
        places = np.concatenate([[(low + high) / 2], corners])
        roots = _roots(self._at(places, np.full(9, point)))
        upper = roots[0][roots[0].imag >= -1e-9]
        start = upper[upper.real.argmax()]
        found = np.take_along_axis(roots, np.abs(roots - start).argmin(axis=1)[:, None], axis=1)[:, 0]
        furthest = np.abs(found).max()
        made = [self._around(found, away) for away in AWAY]
        made += [Contour(float(f * furthest + 1), float(-f * furthest - 1), float(f * furthest + 1)) for f in FURTHER]
        return [one for one in made if self._clear(one, low, high, point)]

    def _clear(self, contour: Contour, low: np.ndarray, high: np.ndarray, point: int) -> bool:
        """Whether D keeps off 0 along a contour, for all gears of a box; looked at closer and closer where it comes near."""
        left, right = -self._margin, contour.right
        corners = np.array(
            [left + 1j * contour.low, right + 1j * contour.low, right + 1j * contour.high, left + 1j * contour.high]
        )
        t = np.linspace(0, 4, 4 * SAMPLES + 1)
        middle, radius = (low + high) / 2, (high - low) / 2 * WIDER
        step = t[1]
        for _ in range(CLOSER):
            side = t.astype(int) % 4
            s = corners[side] + (t % 1) * (corners[(side + 1) % 4] - corners[side])
            D0, D1 = (part[0] for part in self.parts(s[None], np.array([point])))
            moves = np.array([D1, s * D1, s * D0])
            slack = _slack(D0 + middle @ moves, moves, radius[None])[0]
            if (slack <= LEAST_SLACK).any():
                return False
            near = t[np.argsort(slack)[:NEAREST]]
            step = step / 4
            t = np.unique(np.clip(near[:, None] + step * np.arange(-5, 6), 0, 4 - 1e-12))
        return True

    def _around(self, roots: np.ndarray, away: float) -> Contour:
        """A rectangle at some distance from roots at the corners."""
        gap = away * max(np.ptp(roots.imag), np.ptp(roots.real), 0.02 * np.abs(roots).max())
        right, low, high = roots.real.max() + gap, roots.imag.min() - gap, roots.imag.max() + gap
        if np.abs(roots.imag).min() < gap:  # a real root, or a pair about to be one
            high = np.abs(roots.imag).max() + max(gap, 1.0)
            right, low = right + 1.0, -high
        return Contour(float(right), float(low), float(high))


def _free(centre: np.ndarray, moves: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """Whether 0 lies outside of zonotopes: centres (m, w), moves (3, w), radii (m, 3); (m, w)."""
    return _slack(centre, moves, radius) > 0


def _slack(centre: np.ndarray, moves: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """By how much 0 lies outside, in parts of the distance of the centre."""
    centre = np.atleast_2d(centre)
    size = np.maximum(np.abs(centre), 1e-300)
    slack = 1 - radius @ np.abs(moves) / size
    for g in moves:  # beside a line along an edge
        normal = -1j * g.conj() / np.maximum(np.abs(g), 1e-300)
        slack = np.maximum(slack, (np.abs((centre * normal).real) - radius @ np.abs((moves * normal).real)) / size)
    return slack


def _bare(study: Study) -> Study:
    """With nothing about the yaw axis but what the probe puts there."""
    return study.replace(damper={"topology": "rotational", "torsional_stiffness": 0.0, "torsional_damping": 0.0})


def _probed(bare: Study) -> list[list[float]]:
    """Numbers of the study without stiffness, and with that of the probe."""
    data: Mapping[str, float] = dict(zip(data_names(bare), data_values(bare), strict=True))
    return [list({**data, "damper.torsional_stiffness": k}.values()) for k in (0.0, PROBE)]


def _horner(polynomials: np.ndarray, s: np.ndarray) -> np.ndarray:
    value = np.zeros_like(s)
    for coefficient in polynomials.T:
        value = value * s + coefficient[:, None]
    return value


def _roots(polynomials: np.ndarray) -> np.ndarray:
    """Roots of stacked polynomials (..., n + 1) of degree n or n - 1; those of a leading coefficient 0 lie far to the left."""
    lead = polynomials[..., 0]
    scale = np.where(lead == 0, 1e-12 * np.abs(polynomials[..., 1]), lead)
    n = polynomials.shape[-1] - 1
    companion = np.zeros((*polynomials.shape[:-1], n, n))
    companion[..., 0, :] = -polynomials[..., 1:] / scale[..., None]
    companion[..., np.arange(1, n), np.arange(n - 1)] = 1.0
    return np.linalg.eigvals(companion)


def _of_tyres(footprints: np.ndarray, s: np.ndarray) -> np.ndarray:
    """(F_y, M_z) of each wheel from (eta, theta), (m, w, 2 k, 2 k), at s (m, w) per length of path."""
    wheels = footprints.shape[1]
    T = np.zeros((*s.shape, 2 * wheels, 2 * wheels), dtype=complex)
    for k in range(wheels):
        row = footprints[:, k, :, None]
        side, swivel, turn, softness, reach, length = (row[:, 6 + i] for i in range(6))
        E, phi1, chi = transit(s * length)
        by_theta, by_eta = reach / (softness + s), softness / (softness + s)
        f = row[:, 0] + row[:, 1] * E + row[:, 2] * phi1
        moment = row[:, 3] + row[:, 4] * E + row[:, 5] * chi
        T[..., 2 * k, 2 * k], T[..., 2 * k, 2 * k + 1] = f * by_eta - side, f * by_theta - swivel
        T[..., 2 * k + 1, 2 * k], T[..., 2 * k + 1, 2 * k + 1] = -moment * by_eta, turn - moment * by_theta
    return T

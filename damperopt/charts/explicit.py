"""The boundary in a plane of two quantities that act at one joint: an explicit curve, for any number of states.

Stiffness and damping of a joint enter the state matrix through one vector of forces b: A(u, v) = A_0 + b (u p + v q)'. With
the receptances g_p = p'(s - A_0)^-1 b and g_q the characteristic equation is u g_p(s) + v g_q(s) = 1; for stiffness and damping
about one axis this is k + s c = -1/G(s). With a delay A_0 hangs on s, and all else stays. At s = -margin + i w it is two linear
equations for u and v, at s = -margin one: a straight line. Of these curves (the D-decomposition of Neimark) the boundary is
what has no eigenvalue further to the right.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.linalg import matrix_balance

from ..stability.delay import DelayGear, Frozen
from ..stability.linear import linear_gear
from ..study.study import Study
from .plane import Plane
from .tracing import Polyline

__all__ = ["Joint", "boundary", "joint_boundary", "joint_of"]

AFFINE = 1e-10
"""Part of the largest entry by which a matrix may differ from the affine one."""

SAMPLES, SLOWEST = 600, 1e-6
"""Frequencies to begin with, in even ratios, and the lowest in parts of the highest."""

AROUND = np.tan(np.linspace(-1.5, 1.5, 31))
"""Frequencies about a resonance, in units of its half width."""

ROUNDS, LONGEST, ROOM = 40, 0.05, 0.02
"""Halvings of a step in frequency at most; the longest chord, and the room about the plane, in fractions of the ranges."""

BISECTIONS, EDGE = 50, 1e-10
"""For the end of a piece; and how near an edge of the plane an end is on it but for rounding."""

JOIN = 30
"""Tolerances between two ends of boundary that meet at a corner, at most."""


@dataclass(frozen=True)
class Joint:
    """A_0 (n, n), b (n,), p (n,), q (n,) of A(u, v) = A_0 + b (u p + v q)', u and v in fractions of the ranges."""

    A_0: np.ndarray
    b: np.ndarray
    p: np.ndarray
    q: np.ndarray

    def receptances(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """g_p, g_q (m,) at s (m,)."""
        n = len(self.b)
        x = np.linalg.solve(s[:, None, None] * np.eye(n) - self.A_0, self.b[:, None].astype(complex))[:, :, 0]
        return x @ self.p, x @ self.q

    def at(self, margin: float, w: np.ndarray) -> np.ndarray:
        """(m, 2) places with the eigenvalue -margin + i w, w (m,) > 0 [rad/s]; far away where there is none."""
        g_p, g_q = self.receptances(-margin + 1j * w)
        area = (g_p * g_q.conj()).imag  # twice that between the receptances: 0 where they are in phase
        with np.errstate(divide="ignore", invalid="ignore"):
            places = np.column_stack([-g_q.imag / area, g_p.imag / area])
        return np.nan_to_num(places, nan=1e9, posinf=1e9, neginf=-1e9)


@dataclass(frozen=True)
class DelayJoint(Joint):
    """A joint of a gear whose tyre has a delay: A_0 hangs on s too, as `frozen`, at one place, says."""

    frozen: Frozen

    def receptances(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """g_p, g_q (m,) at s (m,)."""
        A, _ = self.frozen.at(s[None].astype(complex))
        x = np.linalg.solve(s[:, None, None] * np.eye(len(self.b)) - A[0], self.b[:, None].astype(complex))[:, :, 0]
        return x @ self.p, x @ self.q


def joint_of(plane: Plane) -> Joint | None:
    """The joint at which both quantities of a plane act, or None if they do not.

    Parameters
    ----------
    plane : Plane

    Returns
    -------
    Joint or None
    """
    u, v = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.37, 0.61]]).T
    frozen = plane.frozen(u, v) if plane.delayed else None
    A = plane.matrices(u, v) if frozen is None else frozen.A_0
    if not np.isfinite(A).all() or (frozen is not None and not frozen.alike()):
        return None
    P, Q = A[1] - A[0], A[2] - A[0]
    expected = A[0] + u[:, None, None] * P + v[:, None, None] * Q
    forces, sizes, directions = np.linalg.svd(np.hstack([P, Q]))
    n, largest = len(P), np.abs(A).max()
    if np.abs(A - expected).max() > AFFINE * largest or sizes[1] > AFFINE * sizes[0] or sizes[0] == 0:
        return None
    parts = A[0], sizes[0] * forces[:, 0], directions[0, :n], directions[0, n:]
    return Joint(*parts) if frozen is None else DelayJoint(*parts, frozen.taken(np.arange(1)))


def boundary(plane: Plane, joint: Joint, tolerance: float) -> list[Polyline] | None:
    """The boundary of the plane's margin from its explicit curves.

    Parameters
    ----------
    plane : Plane
    joint : Joint
        Of `joint_of`.
    tolerance : float
        Distance between chords and curve, in fractions of the ranges.

    Returns
    -------
    list of Polyline or None
        With their frequencies; None where the pieces do not join: tangent curves, more than two modes at one point.
    """
    pieces = [*_hopf_pieces(plane, joint, tolerance), *_divergence_pieces(plane, joint)]
    return _joined(pieces, tolerance)


@dataclass
class _Piece:
    """Points (m, 2) of the boundary in order, their frequency [rad/s], and behind which of them corners lie."""

    points: np.ndarray
    w: np.ndarray
    corners: tuple[int, ...] = ()

    def turned(self) -> _Piece:
        return _Piece(self.points[::-1], self.w[::-1], tuple(len(self.w) - 2 - k for k in self.corners))

    def followed_by(self, other: _Piece) -> _Piece:
        behind = len(self.w)
        corners = (*self.corners, behind - 1, *(behind + k for k in other.corners))
        return _Piece(np.vstack([self.points, other.points]), np.append(self.w, other.w), corners)


def _frequencies(plane: Plane) -> np.ndarray:
    """Even ratios up to what no eigenvalue of the plane exceeds, and more about each resonance at its corners.

    The norm of a balanced matrix bounds its eigenvalues and is convex: largest at a corner of the plane.
    """
    corners = plane.matrices(*np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]).T)
    _, scales = matrix_balance(corners[-1], permute=False, separate=True)
    scale = scales[0]
    highest = max(np.linalg.norm(A / scale[:, None] * scale, 2) for A in corners)
    roots = np.linalg.eigvals(corners).ravel()
    resonances = (roots.imag[:, None] + np.abs(roots.real + plane.margin)[:, None] * AROUND).ravel()
    w = np.concatenate([np.geomspace(SLOWEST * highest, highest, SAMPLES), resonances])
    return np.unique(w[(w >= SLOWEST * highest) & (w <= highest)])


def _hopf_pieces(plane: Plane, joint: Joint, tolerance: float) -> list[_Piece]:
    w = _frequencies(plane)
    places = joint.at(plane.margin, w)
    for _ in range(ROUNDS):
        near = _crosses_box(places[:-1], places[1:])
        middle = (w[:-1] + w[1:]) / 2
        between = joint.at(plane.margin, middle[near])
        a, b = places[:-1][near], places[1:][near]
        rough = (_off_chord(between, a, b) > tolerance / 2) | (np.linalg.norm(b - a, axis=1) > LONGEST)
        if not rough.any():
            break
        w = np.concatenate([w, middle[near][rough]])
        places = np.concatenate([places, between[rough]])
        order = np.argsort(w)
        w, places = w[order], places[order]

    def shown(at: np.ndarray) -> np.ndarray:
        """Whether the place of each frequency lies in the plane and on its boundary."""
        found = joint.at(plane.margin, at)
        inside = _inside(found)
        inside[inside] = _rightmost(plane, found[inside], at[inside])
        return inside

    return [_Piece(_snapped(joint.at(plane.margin, part)), part) for part in _true_parts(w, shown(w), shown)]


def _divergence_pieces(plane: Plane, joint: Joint) -> list[_Piece]:
    """Parts of the straight line of a real eigenvalue at -margin."""
    beside = np.finfo(float).eps * np.abs(joint.A_0).max()  # the joint without its quantities may have just this eigenvalue
    g_p, g_q = (g.real[0] for g in joint.receptances(np.array([beside - plane.margin + 0j])))
    ends = []
    for fixed in (0.0, 1.0):
        if g_q != 0:
            ends.append((fixed, (1 - fixed * g_p) / g_q))
        if g_p != 0:
            ends.append(((1 - fixed * g_q) / g_p, fixed))
    on_edge = np.array([end for end in ends if min(end) >= -1e-12 and max(end) <= 1 + 1e-12]).reshape(-1, 2)
    if len(on_edge) < 2:
        return []
    start = on_edge[0]
    end = on_edge[np.linalg.norm(on_edge - start, axis=1).argmax()]
    if np.allclose(start, end) or (np.isclose(start, end) & ((start == 0) | (start == 1))).any():  # a corner, or an edge
        return []

    def at(t: np.ndarray) -> np.ndarray:
        return start + t[:, None] * (end - start)

    def shown(t: np.ndarray) -> np.ndarray:
        return _rightmost(plane, np.clip(at(t), 0, 1), np.zeros(t.size))

    t = np.linspace(0, 1, SAMPLES)
    parts = _true_parts(t, shown(t), shown)
    return [_Piece(_snapped(at(part[[0, -1]])), np.zeros(2)) for part in parts]


def _rightmost(plane: Plane, places: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Whether no eigenvalue lies right of the one at -margin + i w, or of that pair: (m,) for places (m, 2) and w (m,)."""
    if not len(places):
        return np.zeros(0, bool)
    plane.tally.add(len(places))
    roots = plane.roots(*places.T).astype(complex)
    rows = np.arange(len(roots))
    roots[rows, np.abs(roots - (-plane.margin + 1j * w)[:, None]).argmin(axis=1)] = -np.inf
    pairs = rows[w > 0]
    roots[pairs, np.abs(roots[pairs] - (-plane.margin - 1j * w[pairs])[:, None]).argmin(axis=1)] = -np.inf
    return roots.real.max(axis=1) < -plane.margin


def _true_parts(t: np.ndarray, true: np.ndarray, test: Callable[[np.ndarray], np.ndarray]) -> list[np.ndarray]:
    """Runs of parameters (m,) for which a test holds, each to where it ends, by bisection."""
    changes = np.flatnonzero(true[1:] != true[:-1])
    holds, fails = (np.where(true[changes] == side, t[changes], t[changes + 1]) for side in (True, False))
    for _ in range(BISECTIONS if len(changes) else 0):
        middle = (holds + fails) / 2
        kept = test(middle)
        holds, fails = np.where(kept, middle, holds), np.where(kept, fails, middle)
    bounds = [0, *(changes + 1), len(t)]
    parts = []
    for k, (i, j) in enumerate(pairwise(bounds)):
        if true[i]:
            before, after = holds[k - 1 : k] if k > 0 else t[:0], holds[k : k + 1]
            parts.append(np.unique(np.concatenate([before, t[i:j], after])))
    return [part for part in parts if len(part) > 1]


def _inside(places: np.ndarray) -> np.ndarray:
    return np.asarray(((places >= 0) & (places <= 1)).all(axis=1))


def _crosses_box(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Whether chords (m, 2) to (m, 2) may meet the plane with some room about it."""
    low, high = np.minimum(a, b), np.maximum(a, b)
    return np.asarray(((high >= -ROOM) & (low <= 1 + ROOM)).all(axis=1))


def _off_chord(points: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Distance (m,) of points from the lines through a and b."""
    run = b - a
    length = np.maximum(np.linalg.norm(run, axis=1), 1e-300)
    return np.abs(run[:, 0] * (points - a)[:, 1] - run[:, 1] * (points - a)[:, 0]) / length


def _snapped(places: np.ndarray) -> np.ndarray:
    """Places with coordinates that are on an edge but for rounding put there."""
    for edge in (0.0, 1.0):
        places[np.abs(places - edge) < EDGE] = edge
    return places


def _on_edge(place: np.ndarray) -> bool:
    return bool(((place == 0) | (place == 1)).any())


def _joined(pieces: list[_Piece], tolerance: float) -> list[Polyline] | None:
    """Pieces put together at their ends inside the plane; None if an end is left over."""
    lines = []
    left = list(pieces)
    while left:
        line = left.pop()
        for _ in range(2):  # forwards, then from its other end
            while not _on_edge(line.points[-1]):
                end = line.points[-1]
                reach = [min(np.linalg.norm(p.points[k] - end) for k in (0, -1)) for p in left]
                closes = np.linalg.norm(line.points[0] - end)
                if closes < JOIN * tolerance and len(line.points) > 3 and all(closes <= r for r in reach):
                    line = line.followed_by(_Piece(line.points[:1], line.w[:1]))
                    break
                if not reach or min(reach) > JOIN * tolerance:
                    return None
                other = left.pop(int(np.argmin(reach)))
                if np.linalg.norm(other.points[-1] - end) < np.linalg.norm(other.points[0] - end):
                    other = other.turned()
                line = line.followed_by(other)
            if np.array_equal(line.points[0], line.points[-1]):
                break
            line = line.turned()
        lines.append(Polyline(line.points, line.w / (2 * np.pi), np.array(sorted(line.corners), int)))
    return lines


def joint_boundary(
    study: Study, speed: float, load: float, frequencies: np.ndarray, margin: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and damping where the damper acts, at which the gear has the eigenvalue -margin + i w: an explicit curve.

    With G(s) the receptance of the gear without damper there (for most gears yaw angle over yaw torque), the characteristic
    equation with k + s c at this joint is k + s c = -1/G(s), for any number of states.

    Parameters
    ----------
    study : Study
        Its damper has no part in it.
    speed, load : float
        [m/s], [N]
    frequencies : ndarray
        (m,) w/(2 pi) > 0 [Hz].
    margin : float
        [1/s]

    Returns
    -------
    tuple of ndarray
        (m,) torsional stiffness [N m/rad] and damping [N m s/rad].
    """

    def gear_with(stiffness: float, damping: float) -> tuple[np.ndarray, Frozen | None]:
        free = {"topology": "rotational", "torsional_stiffness": stiffness, "torsional_damping": damping}
        gear = linear_gear(study.replace(damper=free))
        if isinstance(gear, DelayGear):
            frozen = gear.frozen(np.array([speed]), np.array([load]))
            return np.asarray(frozen.A_0[0]), frozen
        return np.asarray(gear.matrices(speed, load)[0]), None

    (A, frozen), inertia = gear_with(0.0, 0.0), study.gear.yaw_inertia
    # in units of the matrix' own entries, so that no digits are lost
    units = inertia * np.abs(A).max(), inertia * np.abs(A).max() ** 0.5
    change = np.hstack([(gear_with(units[0], 0.0)[0] - A) / units[0], (gear_with(0.0, units[1])[0] - A) / units[1]])
    forces, sizes, directions = np.linalg.svd(change)
    parts = A, sizes[0] * forces[:, 0], directions[0, : len(A)], directions[0, len(A) :]
    joint = Joint(*parts) if frozen is None else DelayJoint(*parts, frozen)
    k_psi, c_psi = joint.at(margin, 2 * np.pi * np.asarray(frequencies, float)).T
    return k_psi, c_psi

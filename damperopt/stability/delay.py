"""Gears on a tyre whose contact line remembers: exact eigenvalues of the linear model with the delay.

With the foremost contact point q1 of each wheel as a state, the linear gear is lambda x = A x + b(lambda) q1: an ordinary state
matrix but for the columns of the q1, which hold E = exp(-2 a lambda/V) and what follows from it (`tyres.string`). So
D(lambda) = det(lambda - A(lambda)) has no poles, its leading term is lambda^n with n the states of the structure and one per
wheel, and E multiplies lower powers alone (a retarded system).

Eigenvalues: with the contact line as a field of Legendre polynomials they are those of a matrix; each that counts is then a
start of Newton's method on D itself, D'/D = trace((lambda - A)^-1 (1 - A')).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from ..quantities.named import State
from ..tyres.string import transit
from .gear import LinearGear, parts
from .response import FOOTPRINT, Blocks, Structure

__all__ = ["DelayGear", "Frozen", "delay_gear", "frozen_of", "rightmost"]

F, M = (FOOTPRINT.index(f"{name}[0]") for name in ("force", "moment"))
SIDE, SWIVEL, TURN, SOFTNESS, REACH, LENGTH = range(6, 12)

ORDERS = (8, 12, 16, 24, 32, 48, 64, 96, 128)
"""Of the contact line as a field; the least is taken that holds 2 a w/V for the fastest motion w, and `BEYOND` more."""

BEYOND, MOST = 6, 32
"""Motions with more than `MOST` need no field: what the line remembers of them is small against its stiffness, by about
2/(2 a w/V), and the structure on that stiffness alone gives the starts, from `OVERLAP` of the field's order on."""

OVERLAP = 0.7

NEWTON_STEPS, CONVERGED = 12, 1e-13
"""Of Newton's method; the last step relative to the root."""

FAR, ALONE = 1e-2, 0.1
"""Relative distance from its start, of a field and of the stiffness alone, from which on Newton's method found another root."""


SPARE = 4
"""Roots that are looked at over speed besides the principal ones."""


@dataclass(frozen=True)
class Frozen:
    """A(lambda) = A_0 + sum over wheels of (f b_F - m b_M) e' at p points, f and m of `transit`.

    Attributes
    ----------
    A_0 : ndarray
        (p, n, n) with f = m = 0.
    b : ndarray
        (p, 2 w, n) columns b_F, -b_M of each wheel in turn.
    numbers : ndarray
        (p, w, 12) by `FOOTPRINT`.
    speeds : ndarray
        (p,) [m/s]
    """

    A_0: np.ndarray
    b: np.ndarray
    numbers: np.ndarray
    speeds: np.ndarray

    @classmethod
    def of(cls, blocks: Blocks, numbers: np.ndarray, speeds: np.ndarray) -> Frozen:
        """Loop of a structure and its tyres, closed but for what the contact lines remember."""
        n, w = blocks.A.shape[1], numbers.shape[1]
        A_0 = np.zeros((len(speeds), n + w, n + w))
        b = np.zeros((len(speeds), 2 * w, n + w))
        A_0[:, :n, :n] = blocks.A
        for i in range(w):
            side, swivel, turn, softness, reach = (numbers[:, i, k, None] for k in range(SIDE, LENGTH))
            B_F, B_M, eta, theta = blocks.B[:, :, 2 * i], blocks.B[:, :, 2 * i + 1], blocks.C[:, 2 * i], blocks.C[:, 2 * i + 1]
            A_0[:, :n, :n] += B_F[:, :, None] * -(side * eta + swivel * theta)[:, None]
            A_0[:, :n, :n] += B_M[:, :, None] * (turn * theta)[:, None]
            A_0[:, n + i, :n] = speeds[:, None] * (softness * eta + reach * theta)
            A_0[:, n + i, n + i] = -speeds * softness[:, 0]
            b[:, 2 * i, :n], b[:, 2 * i + 1, :n] = B_F, -B_M
        return cls(A_0, b, numbers, speeds)

    @property
    def wheels(self) -> int:
        """Of the gear."""
        return self.numbers.shape[1]

    def taken(self, which: np.ndarray) -> Frozen:
        """At some of the points."""
        return Frozen(self.A_0[which], self.b[which], self.numbers[which], self.speeds[which])

    def alike(self) -> bool:
        """Whether columns, tyre and speed are the same at all points."""
        return all(bool((part == part[:1]).all()) for part in (self.b, self.numbers, self.speeds))

    def at(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """A(lambda) and its derivative at s (p, k) [1/s], (p, k, n, n) each."""
        n, w = self.A_0.shape[1], self.wheels
        A = np.broadcast_to(self.A_0[:, None].astype(complex), (*s.shape, n, n)).copy()
        slope = np.zeros_like(A)
        for i in range(w):
            numbers = self.numbers[:, i, :, None]
            per = numbers[:, LENGTH] / self.speeds[:, None]
            z = s * per
            E, phi1, chi = transit(z)
            phi1_z, chi_z = _slopes(z, E, phi1, chi)
            for k, value, by_z in ((0, phi1, phi1_z), (1, chi, chi_z)):
                first = F if k == 0 else M
                weight = numbers[:, first] + numbers[:, first + 1] * E + numbers[:, first + 2] * value
                change = (numbers[:, first + 2] * by_z - numbers[:, first + 1] * E) * per
                column = self.b[:, None, 2 * i + k]
                A[..., n - w + i] += weight[..., None] * column
                slope[..., n - w + i] += change[..., None] * column
        return A, slope

    def fields(self, order: int) -> np.ndarray:
        """Matrices with the contact lines as fields of an order, (p, n + w order, n + w order)."""
        n, w, p = self.A_0.shape[1], self.wheels, len(self.speeds)
        transport, rear = _line(order)
        whole = np.zeros((p, n + w * order, n + w * order))
        whole[:, :n, :n] = self.A_0
        for i in range(w):
            q, own = n - w + i, slice(n + i * order, n + (i + 1) * order)
            force, moment = (self.numbers[:, i, first : first + 3, None] for first in (F, M))
            b_F, b_M = self.b[:, 2 * i], self.b[:, 2 * i + 1]
            # E q1 = q1 + u2, phi1 q1 = q1 + c_0, chi q1 = c_1/3
            whole[:, :n, q] += force.sum(axis=1) * b_F + moment[:, :2].sum(axis=1) * b_M
            mean, first = np.eye(order)[:2]
            by_line = force[:, 1] * rear + force[:, 2] * mean, moment[:, 1] * rear + moment[:, 2] * first / 3
            whole[:, :n, own] += b_F[:, :, None] * by_line[0][:, None] + b_M[:, :, None] * by_line[1][:, None]
            whole[:, own, own] = (2 * self.speeds / self.numbers[:, i, LENGTH])[:, None, None] * transport
            whole[:, own.start, :n] = -self.A_0[:, q]
        return whole


@cache
def _line(order: int) -> tuple[np.ndarray, np.ndarray]:
    """The field u = sum of c_k P_k, u = 0 in front: c' = (V/a) T c of its transport, and the row of u at the rear end."""
    j, k = np.indices((order, order))
    transport = (2 * j + 1.0) * (((k > j) & ((k - j) % 2 == 1)) * 1.0 - ((order - j) % 2 == 1))
    ends = (-1.0) ** np.arange(order + 1)
    return transport, ends[:-1] - ends[-1]


def _slopes(z: np.ndarray, E: np.ndarray, phi1: np.ndarray, chi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives (E - phi1)/z of phi1 and (phi1 - E - 2 chi)/z of chi, by series near 0."""
    near = np.abs(z) < 1e-3
    away = np.where(near, 1.0, z)
    by_phi1 = np.where(near, -1 / 2 + z / 3 - z**2 / 8, (E - phi1) / away)
    by_chi = np.where(near, 1 / 6 - z / 6 + 3 * z**2 / 40, (phi1 - E - 2 * chi) / away)
    return by_phi1, by_chi


@dataclass(frozen=True)
class DelayGear(LinearGear):
    """A gear with one design on a tyre with a delay; eigenvalues are exact, `matrices` those of the line as a field.

    Attributes
    ----------
    frozen : callable
        (speeds, loads), (m,) each -> Frozen.
    named : tuple of State
        States of the structure and the foremost contact points.
    """

    frozen: Callable[[np.ndarray, np.ndarray], Frozen] = None  # type: ignore[assignment]  # after fields with defaults
    named: tuple[State, ...] = ()

    def abscissa(self, speeds: Any, loads: Any) -> np.ndarray:
        """Spectral abscissa [1/s], (m,), of the exact gear."""
        return self.roots(speeds, loads, 1).real.max(axis=1)

    def roots(self, speeds: Any, loads: Any, count: int | None = None) -> np.ndarray:
        """The rightmost eigenvalues of the exact gear.

        Parameters
        ----------
        speeds, loads : array_like
            (m,) or scalar [m/s], [N].
        count : int or None
            How many; None: as many as there are principal states.

        Returns
        -------
        ndarray
            (m, count) complex [1/s], from right to left.
        """
        V, F_z = np.broadcast_arrays(np.atleast_1d(np.asarray(speeds, float)), np.asarray(loads, float))
        return rightmost(self.frozen(V, F_z), len(self.named) if count is None else count)

    def field_error(self, speed: float, load: float) -> float:
        """How far, relative, `matrices` miss exact eigenvalues: the rightmost, and those that oscillate."""
        exact = self.roots(speed, load)[0]
        found = np.linalg.eigvals(self.matrices(speed, load)[0])
        near = np.abs(exact[:, None] - found).min(axis=1) / (1 + np.abs(exact))
        counted = exact.real > -np.abs(exact.imag)  # what decays within a part of its turn needs no resolution
        counted[0] = True
        return float(near[counted].max())

    @property
    def principal(self) -> tuple[State, ...]:
        """Of the structure and the foremost contact points: as many as there are roots when the delay vanishes."""
        return self.named

    def modes(self, speeds: Any, loads: Any, spare: int = SPARE) -> tuple[np.ndarray, np.ndarray]:
        """The rightmost eigenvalues (m, k) [1/s], `spare` more than principal states, and their states' parts (m, n, k)."""
        V, F_z = np.broadcast_arrays(np.atleast_1d(np.asarray(speeds, float)), np.asarray(loads, float))
        values = self.roots(V, F_z, len(self.named) + spare)
        A, _ = self.frozen(V, F_z).at(values)
        n = A.shape[-1]
        near = (values + 1e-10 * (1 + np.abs(values)))[..., None, None] * np.eye(n) - A
        start = np.linspace(1, 2, n)[:, None] + 0j  # one step of inverse iteration from any vector
        right, left = (np.linalg.solve(matrix, start)[..., 0] for matrix in (near, near.swapaxes(-1, -2)))
        return values, parts((left * right).swapaxes(1, 2))


def delay_gear(
    structure: Structure, design: Mapping[str, float], matrices: Callable[[Any, Any], np.ndarray], states: tuple[State, ...]
) -> DelayGear:
    """Gear of a structure with a design on tyres with a delay.

    Parameters
    ----------
    structure : Structure
    design : mapping
        Design variables by name [SI].
    matrices : callable
        Of the gear with the contact line as a field, as transients have it.
    states : tuple of State
        Of these.

    Returns
    -------
    DelayGear
    """
    name = "contact_path" if structure.wheels == 1 else "contact_path_{}"
    paths = tuple(State(name.format(i + 1), "m", "string") for i in range(structure.wheels))

    values = [design[name] for name in structure.design_names]

    def frozen(speeds: np.ndarray, loads: np.ndarray) -> Frozen:
        return frozen_of(structure, values, speeds, loads)

    return DelayGear(matrices, states, structure.powers, frozen, (*structure.states, *paths))


def frozen_of(structure: Structure, design: Any, speeds: np.ndarray, loads: np.ndarray, data: Any = None) -> Frozen:
    """Frozen gear at m points.

    Parameters
    ----------
    structure : Structure
    design : array_like
        (d,) or (d, m) design variables [SI].
    speeds, loads : ndarray
        (m,) [m/s], [N].
    data : array_like or None
        (k, m) numbers of the study; None: its own.

    Returns
    -------
    Frozen
    """
    return Frozen.of(structure.at(design, speeds, loads, data), structure.footprints(loads, data), speeds)


def rightmost(model: Frozen, count: int) -> np.ndarray:
    """The rightmost exact eigenvalues (p, count) [1/s] of a frozen gear at its points, from right to left."""
    found = np.empty((len(model.speeds), count), complex)
    order = _orders(model)
    while (pending := order > 0).any():
        for n in np.unique(order[pending]).tolist():
            at = np.flatnonzero(order == n)
            found[at], fine = _rightmost(model.taken(at), n, count)
            order[at] = 0
            if n < ORDERS[-1]:
                order[at[~fine]] = ORDERS[ORDERS.index(n) + 1]
    return found


def _orders(model: Frozen) -> np.ndarray:
    """Order of the field at each point."""
    rolling = model.at(np.zeros((len(model.speeds), 1), complex))[0][:, 0].real
    roots = np.linalg.eigvals(np.stack([rolling, model.A_0]))
    # what decays within a part of its turn needs no resolution
    fastest = np.where(roots.real > -np.abs(roots.imag), np.abs(roots), 0.0).max(axis=(0, 2))
    return np.array(ORDERS)[np.searchsorted(ORDERS, np.minimum(fastest * _delay(model) + BEYOND, MOST))]


def _delay(model: Frozen) -> np.ndarray:
    """2 a/V at each point, of the longest contact line [s]."""
    return np.asarray(model.numbers[:, :, LENGTH].max(axis=1) / model.speeds)


def _rightmost(model: Frozen, order: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The rightmost roots (p, count), and at which points (p,) the field was fine enough to be sure of them."""
    starts = np.linalg.eigvals(model.fields(order)).astype(complex)
    resolved = np.abs(starts) * _delay(model)[:, None] <= order
    # what the field resolves comes first, from right to left
    found = np.take_along_axis(starts, np.lexsort((-starts.real, ~resolved)), axis=1)[:, :count]
    sure = (resolved.sum(axis=1) >= count) | (order == ORDERS[-1])  # elsewhere a finer field will tell
    starts, resolved, model = found[sure], np.arange(count) < resolved[sure].sum(axis=1)[:, None], model.taken(sure)
    roots, converged = _newton(model, starts)
    met = converged & resolved & (np.abs(roots - starts) <= FAR * (1e-9 + np.abs(starts)))
    kept, all_met = np.where(met, roots, starts), met.all(axis=1)
    if order >= MOST:
        beyond, none_missed = _beyond(model, order, kept)
        kept, all_met = np.column_stack([kept, beyond]), all_met & none_missed
    found[sure] = np.take_along_axis(kept, np.argsort(-kept.real, axis=1), axis=1)[:, :count]
    sure[sure] = all_met
    return found, sure


def _beyond(model: Frozen, order: int, known: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Roots (p, n) too fast for a field, those that are none or `known` far to the left; and where all were found."""
    starts = np.linalg.eigvals(model.A_0).astype(complex)
    turns = np.abs(starts) * _delay(model)[:, None]
    fast = (turns >= OVERLAP * order) & (starts.real > -np.abs(starts.imag))
    if not fast.any():
        return np.full(starts.shape, -np.inf + 0j), np.ones(len(starts), bool)
    roots, converged = _newton(model, starts)
    fine = converged & (np.abs(roots - starts) <= ALONE * np.abs(starts))
    again = (np.abs(roots[:, :, None] - known[:, None, :]) <= 1e-8 * np.abs(roots)[:, :, None]).any(axis=2)
    missed = fast & ~fine & (turns >= order)
    return np.where(fast & fine & ~again, roots, -np.inf + 0j), ~missed.any(axis=1)


def _newton(model: Frozen, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Roots (p, k) of D from starts (p, k), and where it has converged; a start far to the left may overflow, and has not."""
    n, done = model.A_0.shape[1], np.zeros(s.shape, bool)
    step = np.full(s.shape, np.inf, complex)
    for _ in range(NEWTON_STEPS):
        with np.errstate(all="ignore"):
            A, slope = model.at(s)
            shifted = s[..., None, None] * np.eye(n) - A
            try:
                ratio = np.trace(np.linalg.solve(shifted, np.eye(n) - slope), axis1=-2, axis2=-1)
            except np.linalg.LinAlgError:  # one is met exactly
                s = s + 1e-14 * (1 + np.abs(s))
                continue
            step = np.where(done, 0, 1 / ratio)
        s = np.where(np.isfinite(step), s - step, s)
        done |= np.abs(step) <= CONVERGED * (1 + np.abs(s))
        if done.all():
            break
    near = np.abs(step) <= 1e-9 * (1 + np.abs(s))  # a double root converges to the square root of rounding alone
    return s, done | near

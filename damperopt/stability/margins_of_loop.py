"""Nyquist's count and the margins of a loop: gain, phase and disk.

Z = P + N: closed poles right of the line Re s = shift are the open ones and the clockwise turns of det(1 + L) about 0, those of
its loci about -1 together. Loci are the eigenvalues of L: a common complex factor f on the loop brings the gear to its limit
where a locus is -1/f. Hence gains where a locus crosses the negative real axis, phases where it crosses the unit circle, and
the symmetric disk margin alpha = 2/max|S - T|, S - T = (1 - l)/(1 + l): gains from (2 - alpha)/(2 + alpha) to its inverse
are borne (from alpha = 2 on any gain), and phases of 2 atan(alpha/2), both at once [Seiler, Packard, Gahinet 2020].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import permutations

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from ..errors import ConfigError, DamperoptError
from ..quantities.shown import written
from .loop import Loop

__all__ = ["Locus", "LoopMargins", "OverSpeed", "locus_of", "margins_of", "margins_over_speed"]

DECADES, PER_DECADE = 3, 60
"""Of the frequencies beside those about the poles: below the slowest and above the fastest one."""

ABOUT_A_POLE = np.tan(np.linspace(-1.55, 1.55, 41))
"""Frequencies about a pole, in its decay rates."""

TURN, ROUNDS = np.pi / 8, 12
"""Largest step of the phase of det(1 + L), and how often steps are halved for it."""

ON_THE_LINE, SHIFT = 1e-9, 1e-6
"""Open poles that near the imaginary axis, in parts of the fastest pole, and how far right of it the contour passes then."""

FURTHER, MOST_WAVES = 3, 20_000
"""How far beyond the fastest pole a delay is resolved, and by how many frequencies at most."""

LEAST, MOST = 1e-6, 1e6
"""Factors that count: beyond, a locus is 0 or infinite within rounding."""

PEAKS = 4
"""Peaks of |S - T| that are refined."""


@dataclass(frozen=True)
class Locus:
    """Nyquist's loci of a loop and what their turns say.

    Attributes
    ----------
    frequencies : ndarray
        (k,) omega from 0 on [rad/s].
    loci : ndarray
        (k, r) eigenvalues of L(shift + j omega), each column one locus.
    difference : ndarray
        (k,) det(1 + L).
    shift : float
        Of the contour to the right [1/s]: above 0 where an open pole lies on the imaginary axis.
    open_unstable, turns : int
        P, and N, clockwise turns about -1.
    closed_unstable : int
        Eigenvalues of the gear right of the contour, counted.
    """

    frequencies: np.ndarray
    loci: np.ndarray
    difference: np.ndarray
    shift: float
    open_unstable: int
    turns: int
    closed_unstable: int

    @property
    def implied(self) -> int:
        """Z = P + N."""
        return self.open_unstable + self.turns


@dataclass(frozen=True)
class LoopMargins:
    """Margins of a common factor on a loop; NaN where the gear is unstable.

    Attributes
    ----------
    gain_down, gain_up : float
        Largest factor below 1 and least above 1 at the limit of stability; 0 and inf: there is none.
    phase : float
        Least turn at the limit [rad]; pi: there is none.
    disk : float
        alpha.
    gain_down_at, gain_up_at, phase_at, disk_at : float
        omega there [rad/s]; NaN: nowhere.
    unstable : int
        Poles of the gear in the right half plane.
    abscissa : float
        Largest real part of its poles [1/s].
    """

    gain_down: float
    gain_up: float
    phase: float
    disk: float
    gain_down_at: float
    gain_up_at: float
    phase_at: float
    disk_at: float
    unstable: int
    abscissa: float


@dataclass(frozen=True)
class OverSpeed:
    """Margins (m,) over speeds (m,) [m/s] at one load [N]."""

    speeds: np.ndarray
    load: float
    margins: tuple[LoopMargins, ...]

    @property
    def weakest(self) -> int:
        """Which speed is weakest: the most unstable one, or that of the least disk margin."""
        return int(np.argmin([-m.abscissa if m.unstable else m.disk for m in self.margins]))


def locus_of(loop: Loop) -> Locus:
    """Loci of a loop, fine enough to count their turns.

    Raises
    ------
    DamperoptError
        If the turns do not agree with the eigenvalues: no margin is given then.
    """
    poles = np.concatenate([loop.open_poles, loop.closed_poles])
    fastest = np.abs(poles).max(initial=1.0)
    on_line = np.abs(loop.open_poles.real) <= ON_THE_LINE * fastest
    shift = SHIFT * fastest if on_line.any() else 0.0

    def at(w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        L = loop.response(shift + 1j * w)
        return np.linalg.eigvals(L), np.linalg.det(np.eye(L.shape[1]) + L)

    w = np.unique(np.concatenate([_frequencies(poles - shift, fastest), _of_delay(loop, fastest)]))
    loci, difference = at(w)
    for _ in range(ROUNDS):
        wide = np.flatnonzero(np.abs(np.angle(difference[1:] / difference[:-1])) > TURN)
        if not wide.size:
            break
        between = (w[wide] + w[wide + 1]) / 2
        more, more_difference = at(between)
        w, loci = np.insert(w, wide + 1, between), np.insert(loci, wide + 1, more, axis=0)
        difference = np.insert(difference, wide + 1, more_difference)
    phase = np.angle(difference[1:] / difference[:-1]).sum()
    P, Z = (int((found.real > shift).sum()) for found in (loop.open_poles, loop.closed_poles))
    N = round(loop.degree / 2 - phase / np.pi)
    if P + N != Z:
        raise DamperoptError(
            f"loop at {written(loop.speed, loop.load)}: Nyquist's count gives {P} + {N} unstable poles, the eigenvalues {Z}: "
            "one of them lies on the limit within rounding; no margin is given"
        )
    return Locus(w, _in_order(loci), difference, shift, P, N, Z)


def _frequencies(poles: np.ndarray, fastest: float) -> np.ndarray:
    """0, a row of frequencies, and some about every pole: its phase turns there."""
    sizes = np.abs(poles)
    slowest = sizes[sizes > 1e-9 * fastest].min(initial=fastest)
    count = int(PER_DECADE * (np.log10(fastest / slowest) + 2 * DECADES))
    row = np.geomspace(slowest * 10.0**-DECADES, fastest * 10.0**DECADES, count)
    about = (np.abs(poles.imag)[:, None] + np.abs(poles.real)[:, None] * ABOUT_A_POLE).ravel()
    return np.unique(np.concatenate([[0.0], row, about[(about > 0) & (about < row[-1])]]))


def _of_delay(loop: Loop, fastest: float) -> np.ndarray:
    """Frequencies between which exp(-s delay) turns little, beyond the fastest pole."""
    count = FURTHER * fastest * loop.delay / TURN
    if count > MOST_WAVES:
        least = written(loop.speed * count / MOST_WAVES)
        raise ConfigError(
            f"loop at {written(loop.speed)}: the tyre remembers too many waves; allowed: speeds from about {least}"
        )
    return np.arange(1, int(count) + 1) * TURN / max(loop.delay, 1e-300)


def _in_order(loci: np.ndarray) -> np.ndarray:
    """Each column one locus, by the least way from frequency to frequency."""
    orders = np.array(list(permutations(range(loci.shape[1]))))
    ways = np.abs(loci[1:][:, orders] - loci[:-1, None]).sum(axis=2)
    found, order = loci.copy(), orders[0]
    # the step from one row to the next is known; the order of a row is that of the one before, stepped on
    for k, step in enumerate(orders[ways.argmin(axis=1)].tolist()):
        order = np.array(step)[order]
        found[k + 1] = loci[k + 1][order]
    return found


def margins_of(loop: Loop, locus: Locus | None = None) -> LoopMargins:
    """Margins of a loop.

    Parameters
    ----------
    loop : Loop
    locus : Locus or None
        Of it, if it is known.
    """
    found = locus or locus_of(loop)
    abscissa = float(loop.closed_poles.real.max())
    if found.closed_unstable:
        return LoopMargins(*(np.nan,) * 8, found.closed_unstable, abscissa)
    gains = _gains(loop, found)
    down = max((g for g in gains if g[0] < 1), default=(0.0, np.nan))
    up = min((g for g in gains if g[0] > 1), default=(np.inf, np.nan))
    turn = min(_turns(loop, found), default=(np.pi, np.nan))
    alpha, at = _disk(loop, found)
    return LoopMargins(down[0], up[0], turn[0], alpha, down[1], up[1], turn[1], at, 0, abscissa)


def _near(loop: Loop, shift: float, w: float, guess: complex) -> complex:
    """The locus at a frequency that is nearest to a guess."""
    loci = np.linalg.eigvals(loop.response(np.array([shift + 1j * w])))[0]
    return complex(loci[np.abs(loci - guess).argmin()])


def _met(loop: Loop, found: Locus, level: Callable[[complex], float], k: int, i: int) -> tuple[complex, float]:
    """Where a locus between two frequencies is at a level, and the frequency."""
    w, l = found.frequencies[k : k + 2], found.loci[k : k + 2, i]

    def at(x: float) -> complex:
        part = (x - w[0]) / (w[1] - w[0])
        return _near(loop, found.shift, x, l[0] + part * (l[1] - l[0]))

    ends = level(at(w[0])), level(at(w[1]))
    if ends[0] * ends[1] >= 0:  # it touches there, to rounding
        return complex(l[0]), float(w[0])
    x = float(brentq(lambda x: level(at(x)), *w, xtol=1e-12 * w[1], rtol=1e-13))
    return at(x), x


def _gains(loop: Loop, found: Locus) -> list[tuple[float, float]]:
    """Factors at which a locus meets -1, and their frequencies."""
    l = found.loci
    still = [x for x in l[0] if abs(x.imag) <= 1e-9 * abs(x) and x.real < 0]
    gains = [(float(-1 / x.real), 0.0) for x in still]
    crossed = (l[1:-1].imag * l[2:].imag < 0) & (np.minimum(l[1:-1].real, l[2:].real) < 0)
    counts = np.maximum(np.abs(l[1:-1]), np.abs(l[2:])) > 1 / MOST
    for k, i in np.argwhere(crossed & counts).tolist():
        value, w = _met(loop, found, lambda x: x.imag, k + 1, i)
        if value.real < 0:
            gains.append((float(-1 / value.real), w))
    return [gain for gain in gains if LEAST < gain[0] < MOST]


def _turns(loop: Loop, found: Locus) -> list[tuple[float, float]]:
    """Turns that bring a locus to -1, and their frequencies."""
    size = np.abs(found.loci) - 1
    turns = []
    for k, i in np.argwhere(size[:-1] * size[1:] < 0).tolist():
        value, w = _met(loop, found, lambda x: abs(x) - 1, k, i)
        turns.append((float(abs(np.angle(-value))), w))
    return turns


def _disk(loop: Loop, found: Locus) -> tuple[float, float]:
    """alpha, and where |S - T| is largest."""

    def size(w: float) -> float:
        l = np.linalg.eigvals(loop.response(np.array([found.shift + 1j * w])))
        return float(np.abs((1 - l) / (1 + l)).max())

    w, peaks = found.frequencies, np.abs((1 - found.loci) / (1 + found.loci)).max(axis=1)
    best = int(peaks.argmax())
    largest, at = float(peaks[best]), float(w[best])
    inner = np.flatnonzero((peaks[1:-1] >= peaks[:-2]) & (peaks[1:-1] >= peaks[2:])) + 1
    for k in inner[np.argsort(-peaks[inner])][:PEAKS].tolist():
        peak = minimize_scalar(
            lambda x: -size(x), bounds=(w[k - 1], w[k + 1]), method="bounded", options={"xatol": 1e-9 * w[k + 1]}
        )
        if -peak.fun > largest:
            largest, at = float(-peak.fun), float(peak.x)
    return 2 / largest, at


def margins_over_speed(at: Callable[[float, float], Loop], speeds: np.ndarray, load: float) -> OverSpeed:
    """Margins over speed, with the weakest speed between the given ones.

    Parameters
    ----------
    at : callable
        (speed, load) -> Loop, of `opened`.
    speeds : ndarray
        (m,) ascending [m/s].
    load : float
        [N]
    """
    margins = [margins_of(at(float(V), load)) for V in speeds]
    found = OverSpeed(speeds, load, tuple(margins))
    k = found.weakest
    if margins[k].unstable or len(speeds) < 3:
        return found
    bounds = speeds[max(k - 1, 0)], speeds[min(k + 1, len(speeds) - 1)]
    inner = minimize_scalar(
        lambda V: np.nan_to_num(margins_of(at(V, load)).disk),
        bounds=bounds,
        method="bounded",
        options={"xatol": 1e-4 * bounds[1]},
    )
    if inner.fun >= margins[k].disk:
        return found
    place = int(np.searchsorted(speeds, inner.x))
    margins.insert(place, margins_of(at(float(inner.x), load)))
    return OverSpeed(np.insert(speeds, place, inner.x), load, tuple(margins))

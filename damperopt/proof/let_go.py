"""Least peak of what the damper carries when an elastic chain is let go, over a box of its three numbers: proved.

In parts of the torque the Zener element k0 parallel to (k_M in series with c_M) of a gear of inertia I moves by

    psi' = v,  v' = (m - k0 psi)/I,  m' = -k_M v - m/tau,   k_M = kappa/tau - k0,   psi(0) = 1/k0,  v(0) = m(0) = 0.

m at one time is a lower bound of its peak. Over the box it is at least its value in the middle less, for each number, the
largest slope over the box times half the box; value and slopes from exponentials of matrices of balls.
"""

from __future__ import annotations

import itertools
import math

import flint

__all__ = ["peak_at_least"]

PROGRAM = 1e-3
"""Relative: how far the closed form that sizes parts may lie below the exact peak. Tested to 2e-6."""

BITS = 80

WIDE, MOST = 0.05, 0.31
"""Width of a logarithm beyond which a box is halved along it, and beyond which nothing is known."""

TIMES = 24


def peak_at_least(low: tuple[float, ...], high: tuple[float, ...], inertia: float) -> float:
    """ln of a lower bound of the peak over a box, -inf where nothing is known.

    Parameters
    ----------
    low, high : tuple of float
        (3,) ends of ln k0, ln kappa, ln tau.
    inertia : float
        I [kg m^2]
    """
    widths = [b - a for a, b in zip(low, high, strict=True)]
    if not all(map(math.isfinite, widths)) or max(widths) > MOST:
        return -math.inf
    halves = [((a, (a + b) / 2), ((a + b) / 2, b)) if b - a > WIDE else ((a, b),) for a, b in zip(low, high, strict=True)]
    return min(_of_box(parts, inertia) for parts in itertools.product(*halves))


def _of_box(ends: tuple[tuple[float, float], ...], inertia: float) -> float:
    low, high = zip(*ends, strict=True)
    middle = [(a + b) / 2 for a, b in ends]
    k0, kappa, tau = map(math.exp, middle)
    if kappa / tau <= k0:
        return -math.inf
    with flint.ctx.workprec(BITS):
        time = _best_time(middle, inertia, 0.7 * 2 * math.pi * math.sqrt(inertia * tau / kappa))
        value = _torque([flint.arb(x) for x in middle], inertia, time)[0]
        over = [flint.arb((a + b) / 2, (b - a) / 2 * (1 + 1e-12) + 1e-300) for a, b in zip(low, high, strict=True)]
        slopes = _torque(over, inertia, time)[1]
        least = value - sum((abs(s) * flint.arb(x.rad()) for s, x in zip(slopes, over, strict=True)), flint.arb(0))
        least = (least * (1 - flint.arb(PROGRAM))).lower()
        return float(least.log().lower()) if least > 0 else -math.inf


def _best_time(middle: list[float], inertia: float, end: float) -> float:
    """Where m is about largest: any time will do."""
    steps = [end * (i + 1) / TIMES for i in range(TIMES)]
    x = [flint.arb(value) for value in middle]
    h = end / TIMES
    advance, _ = _matrices(x, inertia)
    once = (advance * flint.arb(h)).exp()
    state = flint.arb_mat(3, 1, [1, 0, 0])
    values = []
    for _ in steps:
        state = once * state
        values.append(float(state[2, 0].mid()))
    return steps[max(range(TIMES), key=values.__getitem__)]


def _matrices(x: list[flint.arb], inertia: float) -> tuple[flint.arb_mat, list[flint.arb_mat]]:
    """Of the motion of (K psi, sqrt(K I) v, m), K about k0, and its derivatives to ln k0, ln kappa, ln tau."""
    k0, kappa, tau = (value.exp() for value in x)
    K = k0.mid()
    w, per, zero = (K / inertia).sqrt(), (K * inertia).sqrt(), flint.arb(0)
    own, stiff = k0 / K * w, kappa / tau / per
    A = flint.arb_mat(3, 3, [0, w, 0, -own, 0, w, 0, k0 / per - stiff, -1 / tau])
    by_k0 = flint.arb_mat(3, 3, [0, 0, 0, -own, 0, 0, 0, k0 / per, 0])
    by_kappa = flint.arb_mat(3, 3, [zero] * 7 + [-stiff, zero])
    by_tau = flint.arb_mat(3, 3, [zero] * 7 + [stiff, 1 / tau])
    return A, [by_k0, by_kappa, by_tau]


def _torque(x: list[flint.arb], inertia: float, time: float) -> tuple[flint.arb, list[flint.arb]]:
    """m at a time, and its derivatives to the three logarithms.

    exp of [[A, A'], [0, A]] t holds the derivative of exp(A t) in its corner.
    """
    A, changes = _matrices(x, inertia)
    t, start = flint.arb(time), x[0].exp().mid() / x[0].exp()
    value, slopes = flint.arb(0), []
    for i, change in enumerate(changes):
        rows = [[A[r, c] * t for c in range(3)] + [change[r, c] * t for c in range(3)] for r in range(3)]
        rows += [[flint.arb(0)] * 3 + [A[r, c] * t for c in range(3)] for r in range(3)]
        whole = flint.arb_mat(rows).exp()
        value = whole[2, 0] * start
        slope = whole[2, 3] * start
        slopes.append(slope - value if i == 0 else slope)  # psi(0) = 1/k0
    return value, slopes

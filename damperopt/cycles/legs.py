"""Orbits of a gear with joints as chains of legs, from event to event: out of motions, and checked for what they meet."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .collocation import STAGES, Leg, Path, tableau
from .flow import Flow
from .joints import Jointed, JointedFlow
from .newton import Condition, Metric

__all__ = ["Chain", "chain_of", "conditions", "meets_others", "period_of"]

INTERVALS = 24
"""Of a cycle, shared out to its legs by their durations, at least `FEWEST` to each."""

FEWEST = 3

STILL = 1e-6
"""Of its largest value: a rate of friction below which it sticks in a sampled motion."""

MIRRORED = 0.05
"""Of the largest size of a state: how far a half cycle may be off the mirrored other half to be taken for it."""

SHIFTED = 0.02
"""Of a cycle: how far from it an event may lie that is taken for its end."""

PASSED = 1e-7
"""Of the largest argument of a corner: how far it may lie on the wrong side."""


@dataclass(frozen=True)
class Chain:
    """A path whose legs end at events.

    Attributes
    ----------
    path : Path
    rows : tuple of int
        Which value of `Jointed.signs` vanishes at the end of each leg; the last one at the start of the orbit.
    """

    path: Path
    rows: tuple[int, ...]


def conditions(model: Jointed, chain: Chain, path: Path, metric: Metric) -> list[Condition]:
    """Events at the ends of the legs but the last, and at the start."""
    legs = path.legs
    ends = [model.condition(leg.flow, row) for leg, row in zip(legs[:-1], chain.rows[:-1], strict=True)]
    return [*ends, model.condition(legs[0].flow, chain.rows[-1])]


def chain_of(model: Jointed, time: np.ndarray, states: np.ndarray, parameters: np.ndarray, half: bool) -> Chain | None:
    """A cycle out of a motion; None where it shows none, or meets no corner.

    Parameters
    ----------
    model : Jointed
    time, states : ndarray
        (k,) even times [s] and (k, n) states, over some two cycles or more; the last ones are taken.
    parameters : ndarray
    half : bool
        Whether the mirrored motion of the model is one as well: then half a cycle is taken where the other half mirrors it.
    """
    period = period_of(model.any, states)
    if period is None:
        return None
    modes = _modes(model, states, parameters)
    changes = np.flatnonzero((modes[1:] != modes[:-1]).any(axis=1)) + 1
    changes = changes[changes >= 2]
    start = changes[changes <= len(time) - 1 - period][-1:]
    if not start.size:
        return None
    begin = int(start[0])
    mirror = model.any.mirror
    met = {int(c): _row(model, modes[c - 1], modes[c]) for c in changes}
    middle = _nearest(met, model.mirrored_row(met[begin]), begin + period // 2, period)
    sizes = np.abs(states).max(axis=0)
    half = half and bool((np.abs(states[middle] - mirror * states[begin])[sizes > 0] <= MIRRORED * sizes[sizes > 0]).all())
    end = middle if half else _nearest(met, met[begin], begin + period, period)
    inside = [int(c) for c in changes if begin < c < end - 1]
    bounds = [begin, *inside, end]
    legs, rows = [], []
    for a, b in pairwise(bounds):
        legs.append(_leg(model, time, states, parameters, modes[(a + b - 1) // 2], a, b, period))
    rows += [met[c] for c in (*inside, begin)]
    legs[0] = _started(legs[0], legs[-1], mirror if half else np.ones_like(mirror))
    return Chain(Path(tuple(legs), parameters, half), tuple(rows))


def meets_others(model: Jointed, path: Path) -> bool:
    """Whether a leg passes a corner before it ends."""
    for leg in path.legs:
        flow = leg.flow
        assert isinstance(flow, JointedFlow)
        x = leg.x.reshape(-1, flow.n)[:-1]
        signs = model.signs(flow, x, path.parameters)
        count = len(model.names)
        sizes = np.abs(signs.corners).max(axis=0, initial=0.0) + 1e-300
        if (signs.corners * flow.modes[:count] < -PASSED * sizes).any():
            return True
        if model.rubs and flow.sticks and (signs.reserve < -PASSED * np.abs(signs.reserve).max()).any():
            return True
        rate = signs.rate * flow.modes[-1] if model.rubs and not flow.sticks else np.zeros(1)
        if (rate < -PASSED * np.abs(rate).max()).any():
            return True
    return False


def _nearest(met: dict[int, int], row: int, target: int, period: int) -> int:
    """The event of a kind at which a cycle or half of it ends: where it began, once more."""
    found = min((c for c, other in met.items() if other == row), key=lambda c: abs(c - target), default=target)
    return found if abs(found - target) <= SHIFTED * period else target


def period_of(flow: Flow, states: np.ndarray) -> int | None:
    """Samples of a cycle, by the last two upward passages of the yaw angle through its mean."""
    yaw = states[:, flow.index("yaw_angle")]
    part = yaw[len(yaw) // 2 :]
    yaw = yaw - (part.max() + part.min()) / 2
    up = np.flatnonzero((yaw[:-1] < 0) & (yaw[1:] >= 0))
    up = up[up > 1]
    if len(up) < 2:
        return None
    exact = up + yaw[up] / (yaw[up] - yaw[up + 1])
    return round(exact[-1] - exact[-2])


def _modes(model: Jointed, states: np.ndarray, parameters: np.ndarray) -> np.ndarray:
    """(k, s + 1) modes of the corners and of the friction (0: it sticks); without friction the last column is 0."""
    signs = model.signs(model.any, states, parameters)
    corners = np.where(signs.corners < 0, -1.0, 1.0)
    rate = np.zeros(len(states))
    if model.rubs:
        still = np.abs(signs.rate) <= STILL * np.abs(signs.rate).max()
        rate = np.where(still, 0.0, np.sign(signs.rate))
    return np.column_stack([corners, rate])


def _row(model: Jointed, before: np.ndarray, after: np.ndarray) -> int:
    """Which value vanishes where modes change; where friction lets go, its reserve on that side."""
    changed = np.flatnonzero(before != after)
    first = int(changed[0])
    if first < model.rate_row:
        return first
    if before[first] == 0:
        return model.rate_row + (1 if after[first] > 0 else 2)
    return model.rate_row


def _leg(
    model: Jointed, time: np.ndarray, states: np.ndarray, parameters: np.ndarray, modes: np.ndarray, a: int, b: int, period: int
) -> Leg:
    count = len(model.names)
    sticks = bool(model.rubs and modes[-1] == 0)
    flow = model.flow(modes[: count + model.rubs] if not sticks else np.append(modes[:count], 0.0), sticks)
    N = max(FEWEST, int(np.ceil(INTERVALS * (b - a) / period)))
    c, _, _ = tableau()
    at = time[a] + (time[b] - time[a]) / N * (np.arange(N)[:, None] + c).ravel()
    x = np.column_stack([np.interp(at, time, column) for column in states.T])
    z = flow.unknowns(x, parameters)
    shape = (N, STAGES)
    return Leg(flow, float(time[b] - time[a]), states[a], x.reshape(*shape, -1), z.reshape(*shape, flow.m))


def _started(first: Leg, last: Leg, closing: np.ndarray) -> Leg:
    """The first leg, begun where the last one closes the orbit."""
    return Leg(first.flow, first.duration, closing * last.end, first.x, first.z)

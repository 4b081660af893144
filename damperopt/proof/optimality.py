"""The check of a lower bound on mass: the tree of a search walked again, from a root box that the study gives.

Every design of the study lies in the root, every cut covers its box, and so each design lies in a leaf. In a leaf
`shimmies` no gear keeps the margin at one speed and load, see `yaw`. In a leaf `heavier` lines below ln(mass) and below the
logarithms of ratios that may not exceed 1, taken at some places and added up with weights that are not negative, have a
least value on the box: no design in it that meets the requirements is lighter. The bound is the least over all leaves,
whatever the search has said.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import flint
import numpy as np

from ..study.study import Study
from .enclosures import lines
from .intervals import Interval, exponential, of
from .lightness import Lightness
from .lines import Line, Places
from .yaw import Contour, YawGear

__all__ = ["BoundCheck", "check_bound"]

FORMULAS = 1e-9
"""Relative: rounding of the mass formulas themselves, which floats evaluate."""

DEEPEST = 400
"""Cuts above a leaf."""


@dataclass(frozen=True)
class BoundCheck:
    """Outcome of `check_bound`.

    Attributes
    ----------
    bound : float or None
        No design is lighter [kg]; None: the tree proves nothing.
    heavier, shimmies : int
        Leaves of each kind.
    reason : str
        Why there is no bound; empty where there is one.
    failed : tuple of int
        Leaves that were not proved, by their place in the tree's order.
    used : tuple of str
        Requirements that the leaves rest on.
    """

    bound: float | None
    heavier: int = 0
    shimmies: int = 0
    reason: str = ""
    failed: tuple[int, ...] = ()
    used: tuple[str, ...] = ()


@dataclass
class _Leaf:
    position: int
    low: np.ndarray
    high: np.ndarray
    numbers: np.ndarray
    content: list[Any]


@dataclass
class _Rows:
    """Places of all leaves together, and which leaf each belongs to."""

    leaf: list[int] = field(default_factory=list)
    place: list[np.ndarray] = field(default_factory=list)
    weights: list[Mapping[str, float]] = field(default_factory=list)


def check_bound(study: Study, certificate: Mapping[str, Any]) -> BoundCheck:
    """Walk a tree from the root that the study gives.

    Parameters
    ----------
    study : Study
    certificate : mapping
        ``variables``, ``numbers``: names, as the search orders them; ``points``: speeds and loads; ``tree``: nodes in the order
        cut, below it, above it; of a leaf ``shimmies`` with a point and a contour, or ``heavier`` with places and weights.

    Returns
    -------
    BoundCheck
    """
    try:
        return _Check(study, certificate).outcome()
    except _Broken as broken:
        return BoundCheck(None, reason=str(broken))


class _Broken(Exception):
    """A certificate that is none."""


class _Check:
    def __init__(self, study: Study, certificate: Mapping[str, Any]):
        if study.gear.strut is not None:
            raise _Broken("the shock strut moves: requirements hang on its stroke, which these rows leave out")
        self._light = light = Lightness(study)
        self._study = study
        for key, own in (("variables", light.names), ("numbers", light.numbers)):
            if sorted(certificate.get(key) or []) != sorted(own):
                raise _Broken(f"{key} of the certificate are {certificate.get(key, 'missing')}, those of the study {list(own)}")
        self._order = [certificate["variables"].index(name) for name in light.names]
        self._number_order = [certificate["numbers"].index(name) for name in light.numbers]
        self._points = certificate.get("points") or []
        self._names = ("mass", *light.rows, *light.numbers)
        self._leaves = list(self._walked(certificate.get("tree") or []))

    def _walked(self, tree: Sequence[Any]) -> Iterator[_Leaf]:
        """Leaves with their boxes."""
        light, nodes, position = self._light, iter(tree), 0
        n, k = len(light.names), len(light.numbers)
        place_of = {c: i for i, c in enumerate(self._order)} | {n + c: n + i for i, c in enumerate(self._number_order)}
        unbounded = np.tile([-math.inf, math.inf], (k, 1))
        stack = [(light.low, light.high, unbounded, 0)]
        while stack:
            low, high, numbers, depth = stack.pop()
            node = next(nodes, None)
            if not isinstance(node, list) or not node or depth > DEEPEST:
                raise _Broken("the tree ends before it covers the root box")
            if node[0] != "cut":
                yield _Leaf(position, low, high, numbers, node)
                position += 1
                continue
            which, at = place_of.get(node[1]), float(node[2])
            if which is None or not math.isfinite(at):
                raise _Broken(f"a cut of variable {node[1]} at {node[2]}")
            below, above = [(low.copy(), high.copy(), numbers.copy(), depth + 1) for _ in range(2)]
            if which < n:
                below[1][which], above[0][which] = min(at, high[which]), max(at, low[which])
            else:
                below[2][which - n, 1] = min(at, numbers[which - n, 1])
                above[2][which - n, 0] = max(at, numbers[which - n, 0])
            stack += [above, below]
        if next(nodes, None) is not None:
            raise _Broken("the tree has more nodes than its cuts")

    def outcome(self) -> BoundCheck:
        """The least bound of all leaves."""
        heavier = [leaf for leaf in self._leaves if leaf.content[0] == "heavier"]
        others = [leaf for leaf in self._leaves if leaf.content[0] == "shimmies"]
        if len(heavier) + len(others) != len(self._leaves):
            raise _Broken("a leaf that is neither heavier nor shimmies")
        used = self._used(heavier)
        failed = [leaf.position for leaf, sound in zip(others, self._shimmying(others), strict=True) if not sound]
        bounds = self._weighed(heavier)
        failed += [leaf.position for leaf, bound in zip(heavier, bounds, strict=True) if not bound > -math.inf]
        if failed:
            words = f"{len(failed)} of {len(self._leaves)} leaves were not proved, the first is number {min(failed)}"
            return BoundCheck(None, len(heavier), len(others), words, tuple(sorted(failed)), used)
        least = min(bounds, default=math.inf)
        mass = math.exp(least) * (1 - FORMULAS) if least < 700 else math.inf
        return BoundCheck(mass, len(heavier), len(others), "", (), used)

    def _used(self, leaves: Sequence[_Leaf]) -> tuple[str, ...]:
        """Names that weights stand for; all must be known."""
        known = {"mass", *self._light.rows, *(f"{name}_{end}" for name in self._light.numbers for end in ("min", "max"))}
        named = {name for leaf in leaves for _, weights in leaf.content[1] for name in weights}
        if unknown := named - known:
            raise _Broken(f"a leaf rests on '{min(unknown)}', which this study does not require")
        return tuple(name for name in self._light.rows if name in named)

    # leaves in which every gear shimmies

    def _shimmying(self, leaves: Sequence[_Leaf]) -> list[bool]:
        if not leaves:
            return []
        self._tighten(leaves, self._lines(leaves, [(leaf.low + leaf.high) / 2 for leaf in leaves]))
        gear, found = YawGear(self._study), []
        for leaf in leaves:
            _, point, right, low, high = leaf.content
            speed, load = self._point(point)
            if (leaf.numbers[:, 0] > leaf.numbers[:, 1]).any():  # no design here has such numbers
                found.append(True)
                continue
            ends = exponential(Interval(leaf.numbers[:, 0], leaf.numbers[:, 1]))
            finite = np.isfinite(ends.high).all() and len(ends.low) in (2, 3)
            if not finite:
                found.append(False)
                continue
            box = [[flint.arb(float(x)) for x in end] + [flint.arb(0)] * (3 - len(end)) for end in (ends.low, ends.high)]
            contour = Contour(float(right), float(low), float(high))
            found.append(gear.shimmies(tuple(box[0]), tuple(box[1]), speed, load, contour))
        return found

    def _point(self, which: int) -> tuple[float, float]:
        """A speed and a load of the envelope."""
        try:
            speed, load = map(float, self._points[which])
        except (IndexError, TypeError, ValueError):
            raise _Broken(f"point {which} of the certificate") from None
        envelope = self._study.envelope
        within = envelope.loads[0] <= load <= envelope.loads[-1] if envelope.load_is_range else load in envelope.loads
        if not (envelope.speed.min <= speed <= envelope.speed.max and within):
            raise _Broken(f"a leaf rests on {speed:g} m/s, {load:g} N, which is not in the envelope")
        return speed, load

    # leaves in which every design is heavy

    def _lines(self, leaves: Sequence[_Leaf], places: Sequence[np.ndarray]) -> tuple[list[Line | None], list[Line | None], Any]:
        low, high = (np.array([getattr(leaf, end) for leaf in leaves]) for end in ("low", "high"))
        at = np.clip(np.array(places), low, high)
        where = Places(low, high, at)
        with np.errstate(all="ignore"):
            below, above = lines(self._light.function, where, self._light.logarithmic)
        return below, above, where

    def _tighten(self, leaves: Sequence[_Leaf], found: Any) -> None:
        """Yaw numbers by what they are on the box of the variables."""
        below, above, where = found
        for k in range(len(self._light.numbers)):
            at = 1 + len(self._light.rows) + k
            if below[at] is None or above[at] is None:
                continue
            least, most = where.range(below[at]).low, where.range(above[at]).high
            for i, leaf in enumerate(leaves):
                leaf.numbers = leaf.numbers.copy()
                leaf.numbers[k] = max(leaf.numbers[k, 0], least[i]), min(leaf.numbers[k, 1], most[i])

    def _weighed(self, leaves: Sequence[_Leaf]) -> list[float]:
        """Lower bounds of ln(mass)."""
        if not leaves:
            return []
        rows = _Rows()
        for i, leaf in enumerate(leaves):
            for place, weights in leaf.content[1]:
                ordered = np.array([float(place[c]) for c in self._order])
                if not np.isfinite(ordered).all() or not all(0 <= w < math.inf for w in weights.values()):
                    raise _Broken(f"leaf {leaf.position} has a weight that is negative, or a place that is no number")
                rows.leaf.append(i)
                rows.place.append(ordered)
                rows.weights.append(weights)
        below, above, where = self._lines([leaves[i] for i in rows.leaf], rows.place)
        own = [leaves[i] for i in rows.leaf]
        self._tighten(own, (below, above, where))
        return self._added(leaves, rows, below, above, where)

    def _added(self, leaves: Sequence[_Leaf], rows: _Rows, below: Any, above: Any, where: Places) -> list[float]:
        """Lines times their weights, at all places of a leaf together, and their least value on its box."""
        count, at = len(rows.leaf), {name: i for i, name in enumerate(self._names)}
        n = len(self._light.names)
        total = Line(of(np.zeros(count)), of(np.zeros((count, n))))
        sound = np.ones(count, dtype=bool)
        own = [leaves[i] for i in rows.leaf]
        peaks = self._peaks(leaves, rows)
        for name in dict.fromkeys(name for weights in rows.weights for name in weights):
            weight = np.array([weights.get(name, 0.0) for weights in rows.weights])
            number, _, end = name.rpartition("_")
            if number in self._light.numbers and end in ("min", "max"):
                k = self._light.numbers.index(number)
                line = below[at[number]] if end == "max" else above[at[number]]
                limit = np.array([leaf.numbers[k, 0 if end == "min" else 1] for leaf in own])
                if line is not None:
                    weight = np.where(np.isfinite(limit), weight, 0.0)
                    moved = line.raised(-of(np.nan_to_num(limit)))
                    line = moved if end == "max" else moved.reversed()
            else:
                line = below[at[name]]
                if name == "release" and line is not None:
                    weight = np.where(peaks > -math.inf, weight, 0.0)
                    line = line.raised(np.where(peaks > -math.inf, peaks, 0.0))
            if line is None:  # a requirement that is left out makes the bound smaller, not wrong
                sound &= (name != "mass") | (weight == 0)
                continue
            if name != "mass":
                weight = np.where(_finite(line), weight, 0.0)
            with np.errstate(all="ignore"):
                total = total.plus(_masked(line.times(weight), weight > 0))
        constant = total.constant - (total.slope * where.place).sum(axis=1)
        return [
            self._least(i, leaf, np.flatnonzero(np.array(rows.leaf) == i), rows, total, constant, sound)
            for i, leaf in enumerate(leaves)
        ]

    def _least(
        self, i: int, leaf: _Leaf, mine: np.ndarray, rows: _Rows, total: Line, constant: Interval, sound: np.ndarray
    ) -> float:
        """Least value over the box, for a weight 1 of the mass."""
        if not len(mine) or not sound[mine].all():
            return -math.inf
        slope, value, share = of(np.zeros(len(leaf.low))), of(0.0), of(0.0)
        for j in mine:
            slope, value = slope + total.slope[j], value + constant[j]
            share = share + rows.weights[j].get("mass", 0.0)
        ends = slope * Interval(leaf.low, leaf.high)
        least = value + ends.sum(axis=0)
        if not float(share.low) > 0 or not math.isfinite(float(least.low)):
            return -math.inf
        return float((least / share).low)

    def _peaks(self, leaves: Sequence[_Leaf], rows: _Rows) -> np.ndarray:
        """ln of the least peak of the damper for each place of a leaf that rests on it."""
        if "release" not in self._light.rows:
            return np.zeros(len(rows.leaf))
        known: dict[tuple[float, ...], float] = {}
        found = np.full(len(rows.leaf), -math.inf)
        for j, i in enumerate(rows.leaf):
            if rows.weights[j].get("release", 0.0) > 0:
                low, high = leaves[i].numbers.T
                key = (*low, *high)
                if key not in known:
                    known[key] = self._light.peak(low, high)
                found[j] = known[key]
        return found


def _finite(line: Line) -> np.ndarray:
    ends = line.constant.low, line.constant.high, line.slope.low.sum(axis=1), line.slope.high.sum(axis=1)
    return np.logical_and.reduce([np.isfinite(end) for end in ends])


def _masked(line: Line, kept: np.ndarray) -> Line:
    """0 where a line has no weight: what is not finite there does not count."""

    def of_kept(x: Interval) -> Interval:
        mask = kept.reshape(-1, *[1] * (x.low.ndim - 1))
        return Interval(np.where(mask, x.low, 0.0), np.where(mask, x.high, 0.0))

    return Line(of_kept(line.constant), of_kept(line.slope))

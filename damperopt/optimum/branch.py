"""Branch and bound for the least mass of a study: a tree of boxes, and why no design in a leaf is lighter than the bound.

A node is a box of the variables and a box of the yaw numbers. It is a leaf where no gear with such numbers keeps the margin
at some speed, or where mass and requirements, bounded by affine functions, weigh more than what is to be shown: multipliers
lambda >= 0 of a linear program make ln(mass) + sum lambda (ln smaller - ln larger) a lower bound of ln(mass) that anybody
can check. Otherwise it is cut in two. The lightest node is cut first, so that the bound of the whole tree rises until time
is up or the gap is closed.

Floats throughout: `proof` walks the tree again, from its root, with numbers of its own.
"""

from __future__ import annotations

import heapq
import itertools
import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias

import casadi as ca
import numpy as np

from ..study.study import Study
from .affine import Affine, Bounded, Boxes
from .cutting import Cuts, tame
from .exclusion import Contour, Exclusion
from .let_go import least_peak
from .reduction import RELEASE, Reduction
from .relaxation import relaxed

__all__ = ["Leaf", "Node", "Tree", "lower_bound"]

BATCH, NEAR = 96, 0.6
"""Nodes that are bounded together; how far their bounds may lie above the least, in parts of the way to the target."""

ROUNDS = 3
"""Times that affine bounds are taken, each at the last solution."""

OUTER = 1e-9
"""Relative, by which a box is made wider before its proof."""

Shimmies: TypeAlias = Callable[..., bool]

NO_PEAK = -50.0
"""ln of a peak of which nothing is known."""

UNKNOWN = -60.0, 60.0
"""ln of a number of which nothing is known."""

CUSHION = 4.0
"""ln by which ranges of yaw numbers that no cut has made are taken wider."""

NUMBER_WIDTH = 1e-3
"""Worth of a unit of ln(number) where no multiplier says what a cut would bring."""


@dataclass
class Leaf:
    """Why a node needs no cut: a contour at a point of the envelope, or multipliers at a reference point."""

    point: int | None = None
    contour: Contour | None = None
    terms: list[tuple[np.ndarray, dict[str, float]]] = field(default_factory=list)


@dataclass
class Node:
    """A box; a cut has two nodes below it, at a value of a variable or of a yaw number.

    `cuts` are the ends that cuts have given the yaw numbers, `numbers` what they are on the box of the variables besides.
    """

    low: np.ndarray
    high: np.ndarray
    cuts: np.ndarray
    numbers: np.ndarray
    bound: float = -math.inf
    leaf: Leaf = field(default_factory=Leaf)
    cut: tuple[int, float] | None = None
    below: tuple[Node, Node] | None = None
    spread: np.ndarray | None = None
    solution: np.ndarray | None = None


@dataclass(frozen=True)
class Tree:
    """Outcome of a search.

    Attributes
    ----------
    root : Node
    reduction : Reduction
    points : ndarray
        (p, 2) speeds and loads that contours stand at.
    bound : float
        On ln(mass), of the search.
    nodes : int
    finished : bool
        False: time was up before the gap was closed.
    """

    root: Node
    reduction: Reduction
    points: np.ndarray
    bound: float
    nodes: int
    finished: bool

    def certificate(self) -> dict[str, Any]:
        """What a check needs, as plain data: `proof.optimality.check_bound` says its form."""
        tree: list[list[Any]] = []
        stack = [self.root]
        while stack:
            node = stack.pop()
            leaf = node.leaf
            if node.below is not None:
                assert node.cut is not None
                tree.append(["cut", *node.cut])
                stack += reversed(node.below)
            elif leaf.contour is not None:
                tree.append(["shimmies", leaf.point, leaf.contour.right, leaf.contour.low, leaf.contour.high])
            else:
                tree.append(["heavier", [[place.tolist(), weights] for place, weights in leaf.terms]])
        names, numbers = list(self.reduction.names), list(self.reduction.numbers)
        return {"variables": names, "numbers": numbers, "points": self.points.tolist(), "tree": tree}


def lower_bound(study: Study, mass: float, gap: float, seconds: float, shimmies: Shimmies) -> Tree:
    """A tree that shows that no design of a study is lighter than a bound.

    Parameters
    ----------
    study : Study
    mass : float
        Of a design that is known [kg].
    gap : float
        Relative, at which the search ends.
    seconds : float
        Of processor time, at which it ends too.
    shimmies : callable
        (low, high, speed, load, (right, low, high)): whether every gear with k0, kappa, tau between the first two shimmies, by
        a proof along the sides of a rectangle; asked wherever samples say so.

    Returns
    -------
    Tree
    """
    search = _Search(study, shimmies)
    started, target = time.process_time(), math.log(mass) + math.log1p(-gap)
    unlimited = np.tile(UNKNOWN, (len(search.reduction.numbers), 1)).astype(float)
    root = Node(*search.box, unlimited, unlimited)
    search.tighten([root])
    search.bound([root])
    order, count = itertools.count(), 1
    queue = [(root.bound, next(order), root)]
    while queue and queue[0][0] < target and time.process_time() - started < seconds:
        lowest, taken = queue[0][0], list[Node]()
        while queue and len(taken) < BATCH // 2 and (not taken or queue[0][0] < lowest + NEAR * (target - lowest)):
            taken.append(heapq.heappop(queue)[2])
        halves = [half for node in taken for half in search.halves(node)]
        count += len(halves)
        search.tighten(halves)
        search.exclude(halves)
        search.bound([half for half in halves if half.leaf.point is None])
        for half in halves:
            if half.leaf.point is None:
                heapq.heappush(queue, (half.bound, next(order), half))
    bound = queue[0][0] if queue else math.inf
    points = np.zeros((0, 2)) if search.exclusion is None else search.exclusion.points
    return Tree(root, search.reduction, points, min(bound, math.log(mass)), count, bound >= target)


class _Search:
    """Bounds of boxes of one study."""

    def __init__(self, study: Study, shimmies: Shimmies):
        self._shimmies = shimmies
        self.reduction = reduction = Reduction(study)
        self.exclusion = Exclusion(study) if reduction.numbers else None
        self._inertia = study.gear.yaw_inertia
        self._log, self.box = reduction.logarithmic, (reduction.low, reduction.high)
        self._names = ("mass", *reduction.rows, *reduction.numbers)
        y = ca.SX.sym("y", len(reduction.names))
        x = ca.vertcat(*(ca.exp(y[i]) if log else y[i] for i, log in enumerate(self._log)))
        self._slopes = ca.Function("slopes", [y], [ca.densify(ca.jacobian(ca.log(reduction.whole(x)), y))])

    def halves(self, node: Node) -> tuple[Node, Node]:
        """Cut where it tells most."""
        assert node.spread is not None
        n, d = len(node.low), int(node.spread.argmax())
        if d < n:
            at = (node.low[d] + node.high[d]) / 2
            first, second = node.high.copy(), node.low.copy()
            first[d] = second[d] = at
            parts = replace(node, high=first), replace(node, low=second)
        else:
            at = node.numbers[d - n].mean()
            first, second = node.cuts.copy(), node.cuts.copy()
            first[d - n, 1] = second[d - n, 0] = at
            parts = replace(node, cuts=first), replace(node, cuts=second)
        node.cut, node.below = (d, float(at)), parts
        return node.below

    def exclude(self, nodes: list[Node]) -> None:
        """Mark those in which no gear keeps the margin."""
        nodes = [node for node in nodes if np.abs(node.numbers).max(initial=0.0) < UNKNOWN[1]]
        if self.exclusion is None or not nodes:
            return
        low, high = self._three(nodes)
        for node, p, a, b in zip(nodes, self.exclusion.where(low, high), low, high, strict=True):
            if p < 0:
                continue
            place = tuple(self.exclusion.points[p].tolist())
            ends = tuple((a * (1 - OUTER)).tolist()), tuple((b * (1 + OUTER)).tolist())
            for made in self.exclusion.contours(a, b, int(p)):
                if self._shimmies(*ends, *place, (made.right, made.low, made.high)):
                    node.leaf, node.bound = Leaf(point=int(p), contour=made), math.inf
                    break

    def _three(self, nodes: list[Node]) -> tuple[np.ndarray, np.ndarray]:
        """k0, kappa and tau of boxes, (m, 3)."""
        cuts, numbers = (np.array([getattr(node, name) for node in nodes]) for name in ("cuts", "numbers"))
        wider = numbers + np.array([-CUSHION, CUSHION])  # another bound of the same range may be less tight
        ends = np.exp(np.where(np.abs(cuts) < UNKNOWN[1], np.clip(cuts, wider[..., :1], wider[..., 1:]), wider))
        if ends.shape[1] == 2:
            ends = np.concatenate([ends, np.zeros((len(nodes), 1, 2))], axis=1)
        return ends[..., 0], ends[..., 1]

    def bound(self, nodes: list[Node]) -> None:
        """Multipliers, bound and where to cut, of each."""
        if not nodes:
            return
        low, high = (np.array([getattr(node, end) for node in nodes]) for end in ("low", "high"))
        numbers = np.array([node.numbers for node in nodes])
        middle, cuts = (low + high) / 2, Cuts(low, high)
        reference = np.array([m if node.solution is None else node.solution for node, m in zip(nodes, middle, strict=True)])
        reference = np.clip(reference, low, high)
        best = np.full(len(nodes), -np.inf)
        for _ in range(ROUNDS):
            cuts.add(self._rows(Boxes(low, high, reference), numbers), reference)
            solution, found, multipliers = cuts.solve()
            for i, node in enumerate(nodes):
                if found[i] > max(best[i], node.bound):  # else what the box above it rests on holds here too
                    node.leaf = Leaf(terms=cuts.terms(i))
            best = np.maximum(best, found)
            reference = np.clip(solution, low, high)
        spread = self._spread(Boxes(low, high, reference), numbers, multipliers)
        for i, node in enumerate(nodes):
            node.bound, node.solution, node.spread = max(node.bound, float(best[i])), reference[i], spread[i]

    def tighten(self, nodes: list[Node]) -> None:
        """Yaw numbers by what they are on the boxes of the variables."""
        low, high = (np.array([getattr(node, end) for node in nodes]) for end in ("low", "high"))
        known = self._relaxed(Boxes(low, high, (low + high) / 2))
        for i, node in enumerate(nodes):
            node.numbers = node.cuts.copy()
            for k, name in enumerate(self.reduction.numbers):
                if name in known:
                    ends = (known[name].low[i], known[name].high[i])
                    a, b = np.nan_to_num(ends, neginf=UNKNOWN[0], posinf=UNKNOWN[1])
                    node.numbers[k] = max(node.cuts[k, 0], a), max(min(node.cuts[k, 1], b), a)

    def _rows(self, boxes: Boxes, numbers: np.ndarray) -> dict[str, Affine]:
        """Affine lower bounds of ln(mass) and of what must not be positive, by name."""
        found = self._relaxed(boxes)
        rows = {name: bounded.below for name, bounded in found.items() if name not in self.reduction.numbers}
        for k, name in enumerate(self.reduction.numbers):
            if name not in found:
                continue
            rows[f"{name}_max"] = found[name].below + -numbers[:, k, 1]
            rows[f"{name}_min"] = found[name].above * -1.0 + numbers[:, k, 0]
        if RELEASE in rows:
            peak, _ = least_peak(numbers, self._inertia)
            rows[RELEASE] = rows[RELEASE] + np.maximum(peak, NO_PEAK)
        rows = {name: row if name == "mass" else tame(row) for name, row in rows.items()}
        return {name: row for name, row in rows.items() if name == "mass" or (boxes.most(row) > 0).any()}

    def _relaxed(self, boxes: Boxes) -> dict[str, Bounded]:
        """Of mass, rows and numbers those that have bounds on these boxes."""
        found = relaxed(self.reduction.whole, boxes, self._log)
        return {name: bounded for name, bounded in zip(self._names, found, strict=True) if bounded is not None}

    def _spread(self, boxes: Boxes, numbers: np.ndarray, multipliers: Mapping[str, np.ndarray]) -> np.ndarray:
        """What a cut of each variable and of each number promises, (m, n + k): what bounds lose at the solution, and where."""
        widths, none = boxes.high - boxes.low, np.zeros(len(boxes.low))
        m, n = widths.shape
        slopes = self._slopes(ca.DM(boxes.reference.T)).full().reshape(len(self._names), m, n)
        slope_of = dict(zip(self._names, np.nan_to_num(slopes), strict=True))
        by_variable = 1e-6 * widths
        known = self._relaxed(boxes)
        for name, found in known.items():
            for suffix, side in (("_min", found.above), ("_max", found.below), ("", found.below)):
                if f"{name}{suffix}" in multipliers:
                    lost = multipliers[f"{name}{suffix}"] * np.abs(side.value - found.at)
                    bent = np.abs(side.slope - slope_of[name]) * widths + 1e-12 * widths
                    by_variable += lost[:, None] * bent / np.maximum(bent.sum(axis=1), 1e-300)[:, None]
        if any(name not in known for name in self.reduction.numbers):
            by_variable += widths  # first smaller boxes, on which the numbers have bounds
        worth = np.array(
            [multipliers.get(f"{name}_max", none) + multipliers.get(f"{name}_min", none) for name in self.reduction.numbers]
        ).reshape(-1, len(none))
        by_number = (worth.T + NUMBER_WIDTH) * (numbers[..., 1] - numbers[..., 0])
        return np.concatenate([by_variable, by_number], axis=1)

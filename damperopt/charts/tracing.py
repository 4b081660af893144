"""Tracing the stability boundary in a plane: cells with a change of sign from coarse to fine, then points to a tolerance.

1. Signs on a coarse grid. Where the excess has a local extremum towards zero between grid points of one sign, a search looks
   for the other sign: islands and holes smaller than a cell.
2. Cells whose corners differ are split, a few times; a curve that leaves a cell across an edge pulls in the neighbour.
3. Every edge with a change of sign has its root found; the roots of a cell are joined.
4. Between two neighbours the boundary is sought on their bisector, again and again until it lies within the tolerance of the
   chord: many points at bends and corners, few where it is straight.

The cost grows with the length of the curves, but for the coarse grid.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize
from scipy.optimize.elementwise import find_root

__all__ = ["Polyline", "trace"]

Excess = Callable[[np.ndarray, np.ndarray], np.ndarray]
Cell = tuple[int, int]

EDGES = {
    "south": ((0, 0), (1, 0), (0, -1)),
    "east": ((1, 0), (1, 1), (1, 0)),
    "north": ((0, 1), (1, 1), (0, 1)),
    "west": ((0, 0), (0, 1), (-1, 0)),
}
"""Corners of each edge of a cell, and the step to the neighbour."""

ROOT = {"xatol": 1e-13, "xrtol": 1e-13}
SPLIT_ROUNDS = 18
WINDOW_CELLS = 24
NEARBY, SPIKES = (0.6, 0.15, 0.03), (2.0, 6.0, 20.0, 60.0)
"""Of a chord: how far from its middle the boundary is sought, first to both sides, then in the direction of a spike."""
SEARCHES = 40
"""Local searches for islands smaller than a cell, the most promising first."""


@dataclass(frozen=True)
class Polyline:
    """A piece of boundary.

    Attributes
    ----------
    points : ndarray
        (m, 2) in fractions of the ranges, in order; the first is the last where it is closed.
    frequency : ndarray or None
        (m,) of the eigenvalue that crosses [Hz], 0 where it is real; None where it is not known.
    corners : ndarray or None
        (k,) points behind which another eigenvalue crosses; None where that is not known.
    """

    points: np.ndarray
    frequency: np.ndarray | None = None
    corners: np.ndarray | None = None

    @property
    def closed(self) -> bool:
        return len(self.points) > 2 and bool(np.array_equal(self.points[0], self.points[-1]))


def trace(excess: Excess, cells: int = 48, splits: int = 2, tolerance: float = 1e-5) -> list[Polyline]:
    """Boundary between positive and negative excess in the unit square.

    Parameters
    ----------
    excess : callable
        (u, v) arrays -> values; continuous, not necessarily smooth.
    cells : int
        Cells of the coarse grid along each axis.
    splits : int
        Times that cells with a change of sign are halved.
    tolerance : float
        Largest distance between chords and boundary, in fractions of the ranges.

    Returns
    -------
    list of Polyline
    """
    grid = np.linspace(0, 1, cells + 1)
    values = excess(*np.meshgrid(grid, grid, indexing="ij"))
    fine = _Fine(excess, cells * 2**splits)
    fine.known.update({(i << splits, j << splits): values[i, j] for i in range(cells + 1) for j in range(cells + 1)})
    mixed = {(i, j) for i, j in zip(*np.nonzero(_mixed(values)), strict=True)}
    seeds = list(dict.fromkeys(_crossing_cell(excess, pair, fine.count) for pair in _hidden(excess, grid, values)))
    level = {(int(i), int(j)) for i, j in mixed}
    for split in range(1, splits + 1):
        step = 1 << (splits - split)
        children = {(2 * i + a, 2 * j + b) for i, j in level for a in (0, 1) for b in (0, 1)}
        level = fine.followed(children, step)
    within = [fine.followed({cell}, 1) for cell in seeds]
    lines = _joined(*fine.segments(sorted(level.union(*within))))
    found = [Polyline(_refined(excess, line, tolerance)) for line in lines]
    for (i, j), traced in zip(seeds, within, strict=True):
        if not traced:  # the island lies between the corners of one fine cell
            found += _enlarged(excess, np.array([i - 1.5, j - 1.5]) / fine.count, 4 / fine.count, tolerance)
    return found


def _enlarged(excess: Excess, corner: np.ndarray, width: float, tolerance: float) -> list[Polyline]:
    """Islands in a window that is smaller than the cells."""

    def inside(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        return excess(np.clip(corner[0] + width * u, 0, 1), np.clip(corner[1] + width * v, 0, 1))

    if width < tolerance:
        return []
    lines = trace(inside, WINDOW_CELLS, 1, min(tolerance / width, 0.01))
    return [Polyline(corner + width * line.points) for line in lines if line.closed]


class _Fine:
    """Values at the corners of a fine grid, computed where they are asked for."""

    def __init__(self, excess: Excess, count: int):
        self.excess, self.count = excess, count
        self.known: dict[Cell, float] = {}

    def fill(self, corners: Iterable[Cell]) -> None:
        """Compute those that are not known."""
        new = sorted(set(corners) - self.known.keys())
        if new:
            places = np.array(new) / self.count
            self.known.update(zip(new, self.excess(places[:, 0], places[:, 1]).tolist(), strict=True))

    def followed(self, cells: set[Cell], step: int) -> set[Cell]:
        """Cells of a size with a change of sign: those of `cells`, and all that the boundary enters from them."""
        found: set[Cell] = set()
        looked: set[Cell] = set()
        while cells:
            self.fill(((i + a) * step, (j + b) * step) for i, j in cells for a in (0, 1) for b in (0, 1))
            looked |= cells
            entered: set[Cell] = set()
            for i, j in cells:
                changing = [EDGES[name][2] for name in EDGES if self.changes((i, j), name, step)]
                if changing:
                    found.add((i, j))
                entered |= {(i + a, j + b) for a, b in changing}
            last = self.count // step - 1
            cells = {(i, j) for i, j in entered - looked if 0 <= i <= last and 0 <= j <= last}
        return found

    def changes(self, cell: Cell, edge: str, step: int = 1) -> bool:
        """Whether the sign changes along an edge of a cell."""
        (a, b), (c, d), _ = EDGES[edge]
        i, j = cell
        return (self.known[(i + a) * step, (j + b) * step] < 0) != (self.known[(i + c) * step, (j + d) * step] < 0)

    def segments(self, cells: list[Cell]) -> tuple[np.ndarray, list[tuple[int, int]]]:
        """Roots on the edges of cells, each once, and pairs of them that belong together."""
        numbers: dict[tuple[Cell, Cell], int] = {}
        pairs: list[tuple[int, int]] = []
        saddles: list[tuple[Cell, dict[str, int]]] = []
        for i, j in cells:
            crossed = {}
            for name, ((a, b), (c, d), _) in EDGES.items():
                if self.changes((i, j), name):
                    crossed[name] = numbers.setdefault(((i + a, j + b), (i + c, j + d)), len(numbers))
            if len(crossed) == 2:
                first, second = crossed.values()
                pairs.append((first, second))
            elif len(crossed) == 4:
                saddles.append(((i, j), crossed))
        if saddles:
            centres = (np.array([cell for cell, _ in saddles]) + 0.5) / self.count
            inside = self.excess(centres[:, 0], centres[:, 1]) < 0
            for (cell, crossed), negative in zip(saddles, inside, strict=True):
                if negative == (self.known[cell] < 0):  # the centre goes with the south-west corner
                    pairs += [(crossed["south"], crossed["east"]), (crossed["north"], crossed["west"])]
                else:
                    pairs += [(crossed["south"], crossed["west"]), (crossed["north"], crossed["east"])]
        if not numbers:
            return np.zeros((0, 2)), []
        ends = np.array(list(numbers)) / self.count
        return _roots(self.excess, ends[:, 0], ends[:, 1]), pairs


def _roots(excess: Excess, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Boundary points (m, 2) on segments whose ends have different signs."""

    def along(t: np.ndarray, k: np.ndarray) -> np.ndarray:
        k = k.astype(int)
        place = start[k] + t[..., None] * (end[k] - start[k])
        return excess(place[..., 0], place[..., 1])

    m = len(start)
    found = find_root(along, (np.zeros(m), np.ones(m)), args=(np.arange(m, dtype=float),), tolerances=ROOT)
    return start + found.x[:, None] * (end - start)


def _mixed(values: np.ndarray) -> np.ndarray:
    negative = values < 0
    corners = negative[:-1, :-1].astype(int) + negative[1:, :-1] + negative[:-1, 1:] + negative[1:, 1:]
    return (corners > 0) & (corners < 4)


def _hidden(excess: Excess, grid: np.ndarray, values: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Pairs of points of different sign, one off the grid: islands that the grid steps over."""
    padded = np.pad(np.abs(values), 1, constant_values=np.inf)
    count = len(grid)
    blocks = [padded[1 + a : 1 + a + count, 1 + b : 1 + b + count] for a in (-1, 0, 1) for b in (-1, 0, 1)]
    signs = np.pad(values < 0, 1, mode="edge")
    same = np.all(
        [signs[1 + a : 1 + a + count, 1 + b : 1 + b + count] == (values < 0) for a in (-1, 0, 1) for b in (-1, 0, 1)], axis=0
    )
    least = same & (np.abs(values) <= np.min(blocks, axis=0))
    places = sorted(zip(*np.nonzero(least), strict=True), key=lambda place: abs(values[place]))[:SEARCHES]
    h, found = grid[1], []
    for i, j in places:
        sign = 1.0 if values[i, j] >= 0 else -1.0
        start = np.array([grid[i], grid[j]])
        box = [(max(c - h, 0.0), min(c + h, 1.0)) for c in start]
        simplex = start + h / 3 * np.array([[0, 0], [1, 0.2], [-0.3, 1]]) * np.where(start + h > 1, -1, 1)
        best = minimize(
            lambda p, sign=sign: sign * float(excess(np.array([p[0]]), np.array([p[1]]))[0]),
            start,
            method="Nelder-Mead",
            bounds=box,
            options={"initial_simplex": simplex, "maxfev": 40, "xatol": 1e-3 * h, "fatol": 0.0},
        )
        if best.fun < 0:
            found.append((start, best.x))
    return found


def _crossing_cell(excess: Excess, pair: tuple[np.ndarray, np.ndarray], count: int) -> Cell:
    """Fine cell in which the boundary lies between two points."""
    place = _roots(excess, pair[0][None], pair[1][None])[0]
    i, j = np.clip((place * count).astype(int), 0, count - 1)
    return int(i), int(j)


def _joined(roots: np.ndarray, pairs: list[tuple[int, int]]) -> list[np.ndarray]:
    """Chains of points: open ones from their ends, then the closed ones."""
    neighbours: dict[int, list[int]] = {}
    for a, b in pairs:
        neighbours.setdefault(a, []).append(b)
        neighbours.setdefault(b, []).append(a)
    lines: list[np.ndarray] = []
    for begin in sorted(neighbours, key=lambda k: len(neighbours[k])):
        if not neighbours[begin]:
            continue
        chain, here = [begin], begin
        while neighbours[here]:
            following = neighbours[here].pop()
            neighbours[following].remove(here)
            chain.append(following)
            here = following
        lines.append(roots[chain])
    return lines


def _refined(excess: Excess, line: np.ndarray, tolerance: float) -> np.ndarray:
    """The chain with points between its points, until chords lie within the tolerance."""
    points, open_ = line, np.ones(len(line) - 1, bool)
    for _ in range(SPLIT_ROUNDS):
        at = np.flatnonzero(open_)
        at = at[np.linalg.norm(points[at + 1] - points[at], axis=1) > tolerance]
        open_[:] = False
        low, high, bracketed = _bisectors(excess, points[at], points[at + 1])
        at = at[bracketed]
        if not at.size:
            break
        found = _roots(excess, low[bracketed], high[bracketed])
        far = np.linalg.norm(found - (points[at] + points[at + 1]) / 2, axis=1) > tolerance
        open_[at] = far  # both halves of what was far are looked at again
        points = np.insert(points, at + 1, found, axis=0)
        open_ = np.insert(open_, at + 1, far)
    return points


def _bisectors(excess: Excess, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Ends (m, 2) of segments on the bisectors of chords between which the sign changes, and whether there are such.

    Where it does not nearby, the chord may cut off a spike: its middle lies inside, and the boundary on one side, further off.
    """
    middle, chord = (a + b) / 2, b - a
    normal = np.stack([-chord[:, 1], chord[:, 0]], axis=1)
    low, high, bracketed = middle.copy(), middle.copy(), np.zeros(len(a), bool)
    for reach in NEARBY:
        left = np.flatnonzero(~bracketed)
        if not left.size:
            break
        low[left], high[left] = (np.clip(middle[left] + sign * reach * normal[left], 0, 1) for sign in (-1, 1))
        bracketed[left] = (excess(*low[left].T) < 0) != (excess(*high[left].T) < 0)
    for reach in SPIKES:
        left = np.flatnonzero(~bracketed)
        if not left.size:
            break
        inside = excess(*middle[left].T) < 0
        ends = [np.clip(middle[left] + sign * reach * normal[left], 0, 1) for sign in (-1, 1)]
        changes = [(excess(*end.T) < 0) != inside for end in ends]
        one = changes[0] != changes[1]
        low[left[one]] = middle[left[one]]
        high[left[one]] = np.where(changes[0][one, None], ends[0][one], ends[1][one])
        bracketed[left[one]] = True
    return low, high, bracketed

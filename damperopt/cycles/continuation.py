"""Branches of limit cycles by pseudo-arclength continuation: through folds, to where they end."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from .. import interrupts
from .collocation import Path
from .floquet import shape
from .flow import Flow
from .newton import Condition, Corrected, Metric, NoOrbit, Phase, Tangent, corrected, phase, tangent
from .orbit import Orbit, orbit_of

__all__ = ["Along", "follow", "scales_of"]

FIRST, LARGEST, LEAST = 0.05, 0.25, 1e-5
"""Steps along the branch, in amplitudes and in `WIDTHS` of the range."""

WIDTHS = 20
"""Parts of the range of the parameter that count as one step of length 1."""

MOST = 1000
"""Orbits of a branch."""

CAUTIOUS = 0.3
"""Part of the way to rest by the tangent that a step may go: the branch is back at half of it, half a cycle later."""

AT_REST = 0.01
"""In `Along.scales`: size of an orbit at which its branch has come back to rest."""

FEW = 3
"""Iterations up to which the next step is longer."""


LITTLE = 1e-2
"""Of the largest state with the same unit: rounding of that one is larger than what counts of a smaller one."""


def scales_of(flow: Flow, sizes: np.ndarray) -> np.ndarray:
    """Sizes (n,) of the states of a motion, none below `LITTLE` of the largest with the same unit; 1 where none moves."""
    units = np.array([state.unit for state in flow.states])
    largest = np.array([sizes[units == unit].max() for unit in units])
    return np.where(largest > 0, np.maximum(sizes, LITTLE * largest), 1.0)


@dataclass(frozen=True)
class Along:
    """What is varied, and how.

    Attributes
    ----------
    flow : Flow
    name : str
        Of the parameter.
    low, high : float
        Its range [SI].
    scales : ndarray
        (n,) of the states, below which a difference is small.
    conditions : callable
        Conditions of a path at the ends of its legs, from the path and the metric.
    events : bool
        Whether legs end at events.
    changed : callable or None
        Whether an orbit is no longer the chain of legs that it was solved as.
    """

    flow: Flow
    name: str
    low: float
    high: float
    scales: np.ndarray
    conditions: Callable[[Path, Metric], Sequence[Condition | Phase]] = lambda path, metric: [phase(path, metric)]
    events: bool = False
    changed: Callable[[Path], bool] | None = None

    @property
    def direction(self) -> np.ndarray:
        """Of the parameter."""
        return self.flow.along(self.name)

    def value(self, path: Path) -> float:
        """Of the parameter on a path."""
        return float(path.parameters[self.flow.names.index(self.name)])

    def size(self, path: Path) -> float:
        """Of an orbit, in `scales`."""
        return float(np.sqrt(((path.states / self.scales) ** 2).mean()))

    def metric(self, path: Path) -> Metric:
        """Scales on a path: the sizes of its states, but not less than `scales`."""
        sizes = np.sqrt((path.states**2).mean(axis=0))
        sizes = scales_of(self.flow, sizes) if sizes.any() else sizes
        return Metric(np.maximum(sizes, self.scales), (self.high - self.low) / WIDTHS or 1.0)

    def solved(self, path: Path, along: Tangent | None, metric: Metric) -> Corrected:
        """The orbit near a path."""
        found = corrected(path, self.conditions(path, metric), self.direction, metric, along)
        if self.changed is not None and self.changed(found.path):
            raise NoOrbit
        return found

    def held(self, path: Path, value: float) -> Corrected:
        """The orbit near a path at a value of the parameter."""
        parameters = path.parameters + (value - self.value(path)) * self.direction
        return self.solved(replace(path, parameters=parameters), None, self.metric(path))

    def orbit(self, found: Corrected, label: str = "") -> Orbit:
        """What it shows."""
        return orbit_of(found, self.value(found.path), self.events, label)


def follow(
    along: Along, first: Corrected, ahead: Tangent, report: Callable[[Orbit], None] = lambda orbit: None
) -> tuple[list[Orbit], str, Corrected]:
    """Orbits from a first one on in a direction, how the branch ends, and the last of them that was a step.

    Parameters
    ----------
    along : Along
    first : Corrected
    ahead : Tangent
        On whose side to go.
    report : callable
        Called with each orbit.

    Returns
    -------
    tuple
        The orbits after the first, special points among them, and words; ``rest`` where the amplitude vanishes, ``range``
        at an end of the range, ``changed`` where the legs change.
    """
    orbits: list[Orbit] = []
    walk = _Walk(along, first, ahead)
    for orbit in walk.orbits():
        interrupts.check()
        report(orbit)
        orbits.append(orbit)
        if len(orbits) >= MOST:
            break
    return orbits, walk.end, walk.here


class _Walk:
    """Step after step along a branch; `here` is the last orbit that a step led to, `end` why there is no next one."""

    def __init__(self, along: Along, first: Corrected, ahead: Tangent):
        self._along, self.here, self._ahead = along, first, ahead
        self.end = "most"

    def orbits(self) -> Iterator[Orbit]:
        """After the first."""
        along, step, last = self._along, FIRST, self._along.orbit(self.here)
        while True:
            branch, (there, step) = self._step(step)
            if there is None:
                self.end = "lost" if along.changed is None else "changed"
                return
            if along.size(there.path) < AT_REST:
                self.end = "rest"
                return
            value = along.value(there.path)
            if not along.low <= value <= along.high:
                self.end = "range"
                yield from self._at_limit(branch, along.low if value < along.low else along.high)
                return
            orbit = along.orbit(there)
            yield from branch.special(step, there, last, orbit)
            self.here, self._ahead, last = there, branch.direction, orbit
            yield orbit
            if orbit.beyond:
                self.end = orbit.beyond
                return
            step = min(LARGEST, step * (2 if there.iterations <= FEW else 1 if there.iterations <= FEW + 2 else 0.5))

    def _step(self, step: float) -> tuple[_Step, tuple[Corrected | None, float]]:
        """The tangent here, and the orbit a step along it, shortened until there is one."""
        along, here = self._along, self.here
        metric = along.metric(here.path)
        direction = tangent(here, metric, self._ahead)
        branch = _Step(along, here, direction, metric)
        step = min(step, CAUTIOUS * _to_rest(here.path, direction, metric))
        while step >= LEAST:
            with suppress(NoOrbit):
                return branch, (branch.at(step), step)
            step /= 4
        return branch, (None, step)

    def _at_limit(self, branch: _Step, limit: float) -> Iterator[Orbit]:
        """The orbit at an end of the range."""
        if self._along.value(self.here.path) != limit:
            with suppress(NoOrbit):
                yield self._along.orbit(self._along.held(branch.near(limit), limit))


def _to_rest(path: Path, direction: Tangent, metric: Metric) -> float:
    """How far along a tangent the amplitude vanishes; inf where it grows."""
    change = np.concatenate([stages.reshape(-1, stages.shape[-1]) for stages in direction.stages])
    towards = float(np.sum(path.states * change / metric.states**2))
    return float(np.sum((path.states / metric.states) ** 2)) / -towards if towards < 0 else float("inf")


@dataclass(frozen=True)
class _Step:
    """From an orbit along the tangent of its branch."""

    along: Along
    here: Corrected
    direction: Tangent
    metric: Metric

    def at(self, s: float) -> Corrected:
        """The orbit at a distance."""
        return self.along.solved(
            self.direction.times(s).moves(self.here.path, self.along.direction), self.direction, self.metric
        )

    def near(self, value: float) -> Path:
        """The path where the tangent has a value of the parameter, no further than a step."""
        s = (value - self.along.value(self.here.path)) / self.direction.parameter if self.direction.parameter else 0.0
        return self.direction.times(float(np.clip(s, -LARGEST, LARGEST))).moves(self.here.path, self.along.direction)

    def slope(self, found: Corrected) -> float:
        """Of the parameter along the branch."""
        return tangent(found, self.metric, self.direction).parameter

    def special(self, step: float, there: Corrected, before: Orbit, after: Orbit) -> Iterator[Orbit]:
        """Folds, and where multipliers cross the unit circle, between here and a step ahead."""
        found = {}
        if self.direction.parameter * self.slope(there) < 0:
            found["fold"] = self._root(lambda c: self.slope(c), step)
        for number in range(min(before.unstable, after.unstable), max(before.unstable, after.unstable)):

            def excess(c: Corrected, number: int = number) -> float:
                return float(abs(self.along.orbit(c).multipliers[number])) - 1

            at = self._root(excess, step)
            if at is None:
                continue
            kind = shape(self.along.orbit(self.at(at)).multipliers[number])
            if kind.startswith("fold"):
                if "fold" in found:
                    continue
                kind = "loss of symmetry"
            found.setdefault(kind, at)
        for kind, at in sorted(((k, s) for k, s in found.items() if s is not None), key=lambda pair: pair[1]):
            yield self.along.orbit(self.at(at), kind)

    def _root(self, function: Callable[[Corrected], float], step: float) -> float | None:
        try:
            return float(brentq(lambda s: function(self.at(s)), 0.0, step, xtol=1e-7 * step, maxiter=40))
        except (ValueError, NoOrbit):  # none to be found: two close together, or rounding near a fold
            return None

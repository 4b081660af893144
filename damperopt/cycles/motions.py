"""Branches from motions: cycles that an exact simulation settles on, and those between motions that die and that grow."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import ConfigError
from ..motion.exact import ExactSimulator
from ..study.study import Study
from .branches import Question, end_in_words, errors_of, worded
from .collocation import STAGES, Leg, Path, tableau
from .continuation import Along, follow, scales_of
from .edge import Kicker, edge
from .elements import joints_of
from .flow import Flow
from .hopf import INTERVALS, is_odd
from .joints import Jointed
from .legs import Chain, chain_of, conditions, meets_others, period_of
from .newton import Corrected, NoOrbit, tangent
from .orbit import Branch, Orbit

__all__ = ["Seeder", "from_motions"]

VALUES = 3
"""Of what is varied, at which motions are looked at, ends included."""

RELEASES = (("yaw_angle", 2e-3), ("yaw_angle", 2e-2), ("yaw_angle", 0.15), ("bending_angle", 1e-2))
"""What the gear is let go from [rad]; the last one, where it bends, wakes the lateral mode."""

SETTLED = 1e-3
"""Relative change of the amplitude from stretch to stretch at which a motion is handed to Newton's method."""

PATIENCE = 60
"""Stretches of motion after which it is handed on, settled or not."""

GONE = 1e-3
"""Of its first amplitude: a motion that has died, and an orbit that is none."""

SAME = 0.02
"""Relative: amplitudes of one orbit, reached twice."""

NARROW = 1e-4
"""Relative width of the bracket between a motion that dies and one that does not."""

LITTLE = 0.05
"""Part of a cycle's sizes that counts as small along its branch."""

REBUILT = (1e-4, 1e-3, 5e-3)
"""Steps, in parts of the range, over the place where corners are met in another order."""

FINE, FINE_CYCLES = 6000, 2.6
"""Points at which a motion is cut at its corners, and the cycles that they cover."""

MOST_REBUILT = 40


@dataclass(frozen=True)
class Found:
    """A solved orbit with what it takes to go on from it."""

    along: Along
    corrected: Corrected
    orbit: Orbit


class Seeder:
    """Orbits of a question out of motions.

    Parameters
    ----------
    question : Question

    Attributes
    ----------
    left : list of str
        Motions that left the range of the model, in words.
    """

    def __init__(self, question: Question):
        self.question = question
        self.jointed = Jointed(question.study) if joints_of(question.study) else None
        self.flow = Flow(question.study) if self.jointed is None else self.jointed.any
        self.half = is_odd(self.flow, question.parameters(self.flow, question.axis.low))
        self.left: list[str] = []
        self._kept: tuple[tuple[str, ...], ExactSimulator] | None = None

    def worded(self, value: float) -> str:
        """A value of what is varied, with its unit."""
        return worded(value, self.question.axis.unit)

    def kicker(self, value: float) -> tuple[Kicker, float, float]:
        """Exact motions at a value of what is varied, and the speed [m/s] and load [N] there."""
        there = self.question.at(self.question.axis.name, value)
        return Kicker(self._simulator(there.study, there.design)), there.speed, there.load

    def _simulator(self, study: Study, design: Mapping[str, float]) -> ExactSimulator:
        key = (study.model_dump_json(), repr(dict(design)))
        if self._kept is None or self._kept[0] != key:
            self._kept = key, ExactSimulator(study, design)
        return self._kept[1]

    def settled(self, value: float, size: float, name: str = "yaw_angle") -> Found | None:
        """The cycle on which a release settles; None where it dies, leaves the model or does not settle."""
        kicker, speed, load = self.kicker(value)
        largest, before = np.full(self.flow.n, 1e-300), np.zeros(self.flow.n)
        for states, whole in kicker.stretches(speed, load, {"release": {name: size}}, PATIENCE):
            sizes = np.ptp(states, axis=0)
            largest = np.maximum(largest, sizes)
            moves = float((sizes / largest).max())
            if not whole:
                self.left.append(f"release of {name.replace('_', ' ')} {size:g} rad at {self.worded(value)}")
            if not whole or moves <= GONE:
                return None
            if (np.abs(sizes - before) / largest).max() <= SETTLED * moves:
                return self.solved(value, kicker.chunk(speed, load), states)
            before = sizes
        return self.solved(value, kicker.chunk(speed, load), states)

    def between(self, value: float) -> Found | None:
        """The unstable cycle between releases that die and that do not."""
        kicker, speed, load = self.kicker(value)
        try:
            found = edge(kicker, speed, load, close=NARROW)
        except ConfigError:
            return None
        if found.dies is None or found.not_dies is None:
            return None
        time = kicker.chunk(speed, load)
        for stretches in found.motions:
            for states in stretches:
                orbit = self.solved(value, time, states) if len(states) == len(time) else None
                if orbit is not None and not orbit.orbit.stable:
                    return orbit
        return None

    def solved(self, value: float, time: np.ndarray, states: np.ndarray) -> Found | None:
        """The orbit near a motion."""
        parameters = self.question.parameters(self.flow, value)
        sizes = np.abs(states).max(axis=0)
        if self.jointed is not None:
            time, states = self._finer(value, time, states)
            chain = chain_of(self.jointed, time, states, parameters, self.half)
            return None if chain is None else self.of_chain(chain, sizes, value)
        path = self._loop(time, states, parameters)
        return None if path is None else self._held(self._along(sizes), path, value)

    def _finer(self, value: float, time: np.ndarray, states: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """A motion carried on over some cycles at points so close that no two corners lie between neighbours."""
        period = period_of(self.flow, states)
        if period is None:
            return time, states
        kicker, speed, load = self.kicker(value)
        fine = np.linspace(0, FINE_CYCLES * time[period], FINE)
        rows = kicker.simulator.stretch(speed, load, kicker.disturbance(RELEASES[0][1]), fine, states[-1])
        return (fine, rows[:, : self.flow.n]) if len(rows) == FINE else (time, states)

    def of_chain(self, chain: Chain, sizes: np.ndarray, value: float) -> Found | None:
        """The orbit near a chain of legs."""
        model, axis = self.jointed, self.question.axis
        assert model is not None
        along = Along(
            self.flow,
            axis.name,
            axis.low,
            axis.high,
            LITTLE * scales_of(self.flow, sizes),
            lambda path, metric: conditions(model, chain, path, metric),
            True,
            lambda path: meets_others(model, path),
        )
        return self._held(along, chain.path, value)

    def _along(self, sizes: np.ndarray) -> Along:
        axis = self.question.axis
        return Along(self.flow, axis.name, axis.low, axis.high, LITTLE * scales_of(self.flow, sizes))

    def _held(self, along: Along, path: Path, value: float) -> Found | None:
        try:
            corrected = along.held(path, value)
        except NoOrbit:
            return None
        orbit = along.orbit(corrected)
        yaw = self.flow.index("yaw_angle")
        if orbit.beyond or not orbit.amplitudes["yaw_angle"] > GONE * np.abs(path.states[:, yaw]).max():
            return None
        return Found(along, corrected, orbit)

    def _loop(self, time: np.ndarray, states: np.ndarray, parameters: np.ndarray) -> Path | None:
        """One leg out of the last cycle of a motion."""
        period = period_of(self.flow, states)
        if period is None or period >= len(time):
            return None
        count = period // 2 if self.half else period
        begin = len(time) - 1 - period
        N, (c, _, _) = INTERVALS * (2 - self.half), tableau()
        at = time[begin] + (time[begin + count] - time[begin]) / N * (np.arange(N)[:, None] + c).ravel()
        x = np.column_stack([np.interp(at, time, column) for column in states.T])
        z = self.flow.unknowns(x, parameters).reshape(N, STAGES, self.flow.m)
        closing = self.flow.mirror if self.half else np.ones(self.flow.n)
        leg = Leg(self.flow, float(time[begin + count] - time[begin]), closing * x[-1], x.reshape(N, STAGES, -1), z)
        return Path((leg,), parameters, self.half)

    def rebuilt(self, found: Found, sign: float) -> Found | None:
        """Beyond the place where the legs of an orbit change: a little further, cut at the corners that it meets there."""
        model, axis, path = self.jointed, self.question.axis, found.corrected.path
        assert model is not None
        loose = Along(**{**found.along.__dict__, "changed": None})
        for part in REBUILT:
            value = found.orbit.parameter + sign * part * (axis.high - axis.low)
            if not axis.low <= value <= axis.high:
                return None
            try:
                beyond = loose.held(path, value).path
            except NoOrbit:
                continue
            time, states = _repeated(beyond)
            chain = chain_of(model, time, states, beyond.parameters, self.half)
            there = None if chain is None else self.of_chain(chain, np.abs(states).max(axis=0), value)
            if there is not None:
                return there
        return None


def _repeated(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Three cycles of an orbit at even times."""
    count = 3000
    cycle = np.arange(3 * count) / count * path.period
    half = path.period / (1 + path.half)
    states = np.empty((len(cycle), path.legs[0].flow.n))
    for k, t in enumerate(cycle):
        turns, within = divmod(t, half)
        side = path.closing if path.half and int(turns) % 2 else np.ones_like(path.closing)
        for leg in path.legs:
            if within <= leg.duration or leg is path.legs[-1]:
                states[k] = side * leg.at(np.array([min(within / leg.duration, 1.0)]))[0]
                break
            within -= leg.duration
    return cycle, states


def from_motions(
    question: Question, report: Callable[[Orbit], None] = lambda orbit: None, values: Sequence[float] | None = None
) -> tuple[list[Branch], list[str]]:
    """Branches through cycles that motions lead to, joints as they are; and motions that left the range of the model.

    Parameters
    ----------
    question : Question
    report : callable
        Called with each orbit.
    values : sequence of float or None
        Of what is varied, at which motions are looked at; None: `VALUES` over the range.

    Returns
    -------
    tuple
        Branches, and the motions that left, in words.
    """
    seeder, axis = Seeder(question), question.axis
    branches: list[Branch] = []
    for value in np.linspace(axis.low, axis.high, VALUES) if values is None else values:
        for found, words in _seeds(seeder, float(value), branches):
            branches.append(_through(seeder, found, f"{words} at {seeder.worded(float(value))}", report))
    return branches, seeder.left


def _seeds(seeder: Seeder, value: float, branches: Sequence[Branch]) -> Iterator[tuple[Found, str]]:
    all_live = True
    for name, size in RELEASES:
        if name not in seeder.flow.state_names:
            continue
        try:
            found = seeder.settled(value, size, name)
        except ConfigError:  # the release begins beyond the model
            continue
        all_live &= found is not None
        if found is not None and not _known(found, branches):
            yield found, f"motion after a release of {name.replace('_', ' ')} {size:g} rad"
    between = None if all_live else seeder.between(value)
    if between is not None and not _known(between, branches):
        yield between, "motion between releases that die and that do not"


def _known(found: Found, branches: Sequence[Branch]) -> bool:
    """Whether a branch passes through an orbit: between two neighbours of the parameter with its amplitude."""
    p, a = found.orbit.parameter, found.orbit.amplitudes["yaw_angle"]
    for branch in branches:
        for left, right in zip(branch.orbits, branch.orbits[1:], strict=False):
            low, high = sorted((left.parameter, right.parameter))
            sizes = sorted((left.amplitudes["yaw_angle"], right.amplitudes["yaw_angle"]))
            if low <= p <= high and sizes[0] * (1 - SAME) <= a <= sizes[1] * (1 + SAME):
                return True
    return False


def _through(seeder: Seeder, found: Found, words: str, report: Callable[[Orbit], None]) -> Branch:
    axis = seeder.question.axis
    sides = [_onward(seeder, found, sign, report) for sign in (-1.0, 1.0)]
    orbits = [*reversed(sides[0][0]), found.orbit, *sides[1][0]]
    ends = [end_in_words(part or [found.orbit], end, axis.unit) for part, end in sides]
    errors = errors_of(found.along, [found.orbit])
    return Branch(
        axis.name, axis.unit, tuple(orbits), f"{words}; backwards: {ends[0]}", f"onwards: {ends[1]}", "simulation", *errors
    )


def _onward(seeder: Seeder, found: Found, sign: float, report: Callable[[Orbit], None]) -> tuple[list[Orbit], str]:
    """Orbits to one side, through changes in the order in which corners are met."""
    orbits: list[Orbit] = []
    for _ in range(MOST_REBUILT):
        along, here = found.along, found.corrected
        metric = along.metric(here.path)
        ahead = tangent(here, metric, None).times(sign)
        more, end, last = follow(along, here, ahead, report)
        orbits += more
        if end != "changed":
            return orbits, end
        if more:
            values = [found.orbit, *more][-2:]
            sign = 1.0 if values[1].parameter > values[0].parameter else -1.0
        there = seeder.rebuilt(Found(along, last, orbits[-1] if orbits else found.orbit), sign)
        if there is None:
            return orbits, "changed"
        orbits.append(there.orbit)
        found = there
    return orbits, "changed"

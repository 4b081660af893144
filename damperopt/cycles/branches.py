"""Limit cycles of a study over any of its numbers: branches from Hopf points, and from motions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..charts.plane import Axis, quantity_name, unit_of_quantity
from ..errors import ConfigError
from ..quantities.shown import as_written
from ..stability.critical import critical_speeds
from ..stability.linear import LinearModel
from ..study.study import Study
from .collocation import Leg, Path, tableau
from .continuation import Along, follow, scales_of
from .flow import Flow
from .hopf import HopfPoint, first_orbit, hopf_points, is_odd
from .newton import NoOrbit, corrected, phase
from .orbit import Branch, Orbit

__all__ = ["Question", "end_in_words", "errors_of", "from_hopf_points", "refined", "worded"]

SMALL = 0.02
"""Yaw angle [rad] below which differences of orbits do not count along a branch from rest."""

FIRST = 0.02
"""First amplitude of a branch, in `SMALL`."""

SAME = 1e-3
"""Of the range: a Hopf point at which another branch has ended."""

LOOKED_AT = 5
"""Orbits of a branch whose intervals are halved."""

ENDS = {
    "range": "goes on beyond the range",
    "rest": "amplitude vanishes",
    "most": "goes on: the most orbits of a branch were reached",
    "lost": "lost: Newton's method finds no next orbit",
    "singular": "lost: the equations of the orbit are singular",
    "changed": "corners are met in another order from here on",
}


@dataclass(frozen=True)
class Question:
    """A study with a design, and the range of what is varied.

    Attributes
    ----------
    study : Study
    design : mapping of str to float
        [SI]
    axis : Axis
        What is varied, from where to where.
    speed, load : float
        Where they are not varied [m/s], [N].
    """

    study: Study
    design: Mapping[str, float]
    axis: Axis
    speed: float
    load: float

    @classmethod
    def of(
        cls,
        study: Study,
        design: Mapping[str, float] | None,
        over: str,
        low: float | None = None,
        high: float | None = None,
        speed: float | None = None,
        load: float | None = None,
    ) -> Question:
        """A question with what is left out taken from the study.

        Parameters
        ----------
        study : Study
        design : mapping or None
            None: the starts of the study.
        over : str
            ``speed``, ``vertical_load``, a design variable, or a key path of a number.
        low, high : float or None
            Range [SI]; None: the envelope's for speed and load.
        speed, load : float or None
            [m/s], [N]; None: the largest of the envelope.

        Raises
        ------
        ConfigError
            If there is no such quantity, or no range for it.
        """
        design, name = study.start if design is None else dict(design), quantity_name(study, over)
        LinearModel(study).at(design)  # refuses an incomplete design
        envelope = study.envelope
        ends = {"speed": (envelope.speed.min, envelope.speed.max), "vertical_load": (min(envelope.loads), max(envelope.loads))}
        if low is None or high is None:
            if name not in ends or ends[name][0] == ends[name][1]:
                unit = unit_of_quantity(study, name)
                raise ConfigError(f"--over: '{over}' has no range; allowed: {over}=LOW:HIGH in {unit}")
            low, high = ends[name]
        return cls(study, design, Axis.of(study, name, low, high), speed or envelope.speed.max, load or max(envelope.loads))

    def rest_is_stable(self, values: Sequence[float] | np.ndarray) -> np.ndarray:
        """Whether small motions die at values (m,) of what is varied, joints closed."""
        flow = Flow(self.study)
        A = np.array([flow.state_matrix(self.parameters(flow, float(value))) for value in values])
        found: np.ndarray = np.linalg.eigvals(A).real.max(axis=1) < 0
        return found

    def at(self, name: str, value: float) -> Question:
        """With another value of a quantity [SI]."""
        if name in self.design:
            return replace(self, design={**self.design, name: value})
        if name == "speed":
            return replace(self, speed=value)
        if name == "vertical_load":
            return replace(self, load=value)
        return replace(self, study=self.study.replace(**{name.replace(".", "__"): value}))

    def parameters(self, flow: Flow, value: float) -> np.ndarray:
        """Of a flow, at a value of what is varied."""
        given = flow.values(self.design, self.speed, self.load)
        given[flow.names.index(self.axis.name)] = value
        return given


def worded(value: float, unit: str) -> str:
    """A number with the unit that the field uses."""
    (number,), name = as_written([value], unit)
    return f"{number} {name}".strip()


def from_hopf_points(question: Question, report: Callable[[Orbit], None] = lambda orbit: None) -> list[Branch]:
    """Branches that begin at Hopf points, joints closed.

    Parameters
    ----------
    question : Question
    report : callable
        Called with each orbit.
    """
    flow, axis = Flow(question.study), question.axis
    parameters = question.parameters(flow, axis.low)
    points = hopf_points(flow, parameters, axis.name, axis.low, axis.high, _known(question))
    branches: list[Branch] = []
    closed: list[float] = []
    for point in points:
        if any(abs(point.parameter - value) <= SAME * (axis.high - axis.low) for value in closed):
            continue
        branch, end = _from(question, flow, point, report)
        branches.append(branch)
        if end == "rest":
            closed.append(branch.orbits[-1].parameter)
    return branches


def _known(question: Question) -> Iterable[float]:
    """Critical speeds, which a count of eigenvalues on a grid may miss."""
    axis = question.axis
    if axis.name != "speed":
        return []
    gear = LinearModel(question.study).at(question.design)
    return [critical.speed for critical in critical_speeds(gear, question.load, axis.low, axis.high)]


def _from(question: Question, flow: Flow, point: HopfPoint, report: Callable[[Orbit], None]) -> tuple[Branch, str]:
    axis = question.axis
    parameters = question.parameters(flow, point.parameter)
    path, growth = first_orbit(flow, point, parameters, is_odd(flow, parameters))
    along = Along(flow, axis.name, axis.low, axis.high, SMALL * scales_of(flow, np.abs(point.vector)))
    metric = along.metric(path)
    growth = growth.times(1 / np.sqrt(growth.along(growth, metric)))
    begin = growth.times(FIRST).moves(path, along.direction)
    try:
        first = corrected(begin, [phase(begin, metric)], along.direction, metric, growth)
    except NoOrbit:
        raise ConfigError(f"no limit cycle is found beside the Hopf point at {worded(point.parameter, axis.unit)}") from None
    orbits, end, _ = follow(along, first, growth, report)
    orbits = [along.orbit(first), *orbits]
    words = f"Hopf point at {worded(point.parameter, axis.unit)}, {point.frequency / (2 * np.pi):.4g} Hz"
    return Branch(
        axis.name, axis.unit, tuple(orbits), words, end_in_words(orbits, end, axis.unit), "hopf", *errors_of(along, orbits)
    ), end


def end_in_words(orbits: list[Orbit], end: str, unit: str) -> str:
    """How and where a branch ends."""
    return f"{ENDS.get(end, end)}, {worded(orbits[-1].parameter, unit)}"


def refined(path: Path) -> Path:
    """The same orbit with twice the intervals."""
    legs = []
    for leg in path.legs:
        N, m = 2 * len(leg.x), leg.x.shape[1]
        fractions = ((np.arange(N)[:, None] + tableau(m)[0]) / N).ravel()
        x = leg.at(fractions).reshape(N, m, leg.flow.n)
        z = np.repeat(leg.z[:, -1:], 2 * m, axis=1).reshape(N, m, leg.flow.m)
        legs.append(Leg(leg.flow, leg.duration, leg.start, x, z))
    return replace(path, legs=tuple(legs))


def errors_of(along: Along, orbits: list[Orbit]) -> tuple[float, float]:
    """Largest changes of some orbits, the largest among them, when their intervals are halved; inf if one is lost.

    Returns
    -------
    tuple of float
        Relative, of amplitude and period; of the modulus of the largest multiplier.
    """
    largest = max(orbits, key=lambda orbit: orbit.amplitudes["yaw_angle"])
    of_size, of_multiplier = 0.0, 0.0
    for orbit in [largest, *orbits[len(orbits) // (2 * LOOKED_AT) :: max(1, len(orbits) // LOOKED_AT)]]:
        if orbit.label or len(orbit.path.legs) != len(largest.path.legs):
            continue  # at a fold there is no orbit to either side
        try:
            finer = along.orbit(along.held(refined(orbit.path), orbit.parameter))
        except NoOrbit:
            return float("inf"), float("inf")
        changes = finer.amplitudes["yaw_angle"] / orbit.amplitudes["yaw_angle"] - 1, finer.period / orbit.period - 1
        of_size = max(of_size, *(float(abs(change)) for change in changes))
        before, after = (float(np.abs(o.multipliers).max()) for o in (orbit, finer))
        of_multiplier = max(of_multiplier, abs(after - before))
    return of_size, of_multiplier

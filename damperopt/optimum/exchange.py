"""A continuous envelope with few points: solve, find the worst speed and load, add it, repeat until none violates.

Stability first, as it asks for no simulation; then decay, from the design found: simulate it at its worst speeds, let the
program meet a quadratic model of the decay within a step, simulate again, until the step is nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..motion.decay import DecayPoint
from ..results import OperatingPoint
from ..stability.screening import linear_decay
from ..stability.worst import worst_points
from .cuts import Cut
from .problem import DesignProblem
from .program import CUTS, FactorProgram, HurwitzProgram, Program
from .solve import LocalSolution, NlpSolver

__all__ = [
    "DecayHold",
    "EnvelopeSolution",
    "best_local",
    "first_points",
    "held_again",
    "solve_envelope",
    "solve_with_decay",
]

MAX_ROUNDS = 30

DECAY_ROUNDS = 30

FIRST_RADIUS = 1.0
"""Longest first step of a scaled design variable with modelled decay: a factor of e."""

STILL = 1e-6
"""Step of the scaled variables that is nothing: the model of the decay ratio is then exact to its square."""

LEARNING_STEP, PEAK_LEARNING_STEP = 1e-5, 3e-3
"""Steps below which the difference of two gradients, of decay ratios or of peaks, shows their errors and no curvature."""

REFINED = 1e-2
"""Step of the scaled variables below which the worst speeds are looked for in earnest."""

SAME_SPEED = 0.05
"""Two worst speeds closer than this part of the larger are one that has moved."""

NEAR = 0.7
"""Peaks of the decay ratio above this part of the largest are held from the start."""


@dataclass(frozen=True)
class EnvelopeSolution:
    """A local optimum over the whole envelope.

    Attributes
    ----------
    solution : LocalSolution
        Of the last round.
    worst : tuple of OperatingPoint
        Local maxima of the spectral abscissa of its design, the worst first; empty if the last round failed.
    decay : tuple of DecayPoint
        Local maxima of its decay ratio over the speed, the worst first; empty where none is required.
    rounds : int
    solved : bool
        True when no point of the envelope violates the margin.
    """

    solution: LocalSolution
    worst: tuple[OperatingPoint, ...]
    rounds: int
    solved: bool
    decay: tuple[DecayPoint, ...] = ()


def first_points(solver: NlpSolver) -> list[tuple[float, float]]:
    """Both ends and the geometric middle of the speed range, at every load (or both ends of a load range)."""
    envelope = solver.problem.study.envelope
    low, high = envelope.speed.min, envelope.speed.max
    return [(V, F_z) for F_z in envelope.loads for V in dict.fromkeys((low, (low * high) ** 0.5, high))]


def solve_envelope(
    solver: NlpSolver,
    start: Mapping[str, float],
    points: Sequence[tuple[float, float]],
    form: type[Program] = HurwitzProgram,
) -> EnvelopeSolution:
    """Local optimum from `start`, exchanged until the margin holds at every speed and load.

    Parameters
    ----------
    solver : NlpSolver
    start : mapping
        Design variables by name [SI].
    points : sequence of (speed, load)
        Where stability is imposed in the first round.
    form : type
        `HurwitzProgram` or `FactorProgram`.

    Returns
    -------
    EnvelopeSolution
    """
    study = solver.problem.study
    allowed = -study.required.stability_margin - study.solver.margin_reserve / 2
    points, design, worst = list(points), dict(start), []
    for rounds in range(1, MAX_ROUNDS + 1):
        solution = solver.solve(design, points, form)
        if not solution.converged:
            return EnvelopeSolution(solution, (), rounds, False)
        worst = worst_points(solver.problem.model.at(solution.design), study.envelope, allowed)
        violating = [p for p in worst if p.abscissa > allowed]
        if not violating:
            return EnvelopeSolution(solution, tuple(worst), rounds, True)
        new = [(p.speed, p.load) for p in violating if not any(_close(p, q) for q in points)]
        if not new:  # the program holds the point already and cannot meet it more exactly
            break
        points += new
        design = solution.design
    return EnvelopeSolution(solution, tuple(worst), rounds, False)


def best_local(solver: NlpSolver, start: Mapping[str, float], points: Sequence[tuple[float, float]]) -> EnvelopeSolution:
    """Local optimum from `start` by the Hurwitz program; where that fails by the factor program, improved by the first.

    Parameters
    ----------
    solver : NlpSolver
    start : mapping
        Design variables by name [SI].
    points : sequence of (speed, load)
        Where stability is imposed in the first round.

    Returns
    -------
    EnvelopeSolution
        That meets the decay requirement too, if there is one.
    """
    if solver.problem.study.required.decay is None:
        return _best_stable(solver, start, points)
    if _decays_moderately(solver.problem, start):  # such a start may lie in a basin of its own
        direct = solve_with_decay(solver, start, points, HurwitzProgram)
        if direct.solved:
            return direct
    found = _best_stable(solver, start, points)
    return solver.remembered(found.solution.design, lambda: _best_decayed(solver, found)) if found.solved else found


def held_again(
    solver: NlpSolver,
    found: EnvelopeSolution,
    points: Sequence[tuple[float, float]] = (),
    decay_points: Sequence[tuple[float, float]] = (),
) -> EnvelopeSolution:
    """An optimum solved again with points that its exchange has missed.

    Parameters
    ----------
    solver : NlpSolver
    found : EnvelopeSolution
    points, decay_points : sequence of (speed, load)
        For stability and for decay [m/s], [N].

    Returns
    -------
    EnvelopeSolution
    """
    design, points = found.solution.design, [*found.solution.points, *points]
    if solver.problem.study.required.decay is None:
        return best_local(solver, design, points)
    form = FactorProgram if found.solution.form == FactorProgram.__name__ else HurwitzProgram
    return solve_with_decay(solver, design, points, form, decay_points)


def _best_stable(solver: NlpSolver, start: Mapping[str, float], points: Sequence[tuple[float, float]]) -> EnvelopeSolution:
    found = solve_envelope(solver, start, points, HurwitzProgram)
    if found.solved:
        return found
    found = solve_envelope(solver, start, points, FactorProgram)
    if not found.solved:
        return found
    again = solve_envelope(solver, found.solution.design, found.solution.points, HurwitzProgram)
    return again if again.solved and again.solution.objective < found.solution.objective else found


def _decays_moderately(problem: DesignProblem, design: Mapping[str, float]) -> bool:
    """Whether the linear gear decays, and not ten times as well as it must."""
    if not problem.has_one_damping:
        return True
    required, yaw = problem.study.required.decay, problem.yaw_numbers(design)
    assert required is not None
    k_psi, c_psi = (np.array([yaw[name]]) for name in ("torsional_stiffness", "torsional_damping"))
    return bool(0.1 * required.ratio < linear_decay(problem.study, k_psi, c_psi)[0] < 1)


def _best_decayed(solver: NlpSolver, found: EnvelopeSolution) -> EnvelopeSolution:
    points = list(found.solution.points)
    decayed = solve_with_decay(solver, found.solution.design, points, HurwitzProgram)
    return decayed if decayed.solved else solve_with_decay(solver, found.solution.design, points, FactorProgram)


class DecayHold:
    """Where the decay is held, from round to round.

    Parameters
    ----------
    solver : NlpSolver
        Of a study with a decay requirement.
    more : sequence of (speed, load)
        Held in any case [m/s], [N].
    """

    def __init__(self, solver: NlpSolver, more: Sequence[tuple[float, float]] = ()):
        self._problem, self._analysis = solver.problem, solver.decay
        self._always, self._held = list(more), list[tuple[float, float]]()
        self._last: list[Cut] = []
        self._last_peaks: list[Cut] = []

    def worst(self, design: Mapping[str, float], refined: bool) -> list[DecayPoint]:
        """Peaks of the decay ratio; the high ones are held from now on."""
        peaks = self._analysis.worst(design, refined)
        for peak in [p for p in peaks if p.ratio >= NEAR * peaks[0].ratio][:CUTS]:
            self._held = [held for held in self._held if not _moved((peak.speed, peak.load), held)]
            self._held = [*self._held, (peak.speed, peak.load)][len(self._always) - CUTS :]
        return peaks

    def cuts(self, design: Mapping[str, float]) -> list[Cut]:
        """Decay at the held points about `design`."""
        points = [self._analysis.at(design, *place, gradient=True) for place in (*self._always, *self._held)]
        numbers = [(p.speed, p.load, p.ratio, p.gradient) for p in points]
        # a speed that has moved keeps what was learnt
        before = [next((c for c in self._last if _moved(n[:2], (c.speed, c.load))), None) for n in numbers]
        self._last = self._about(design, numbers, before, LEARNING_STEP)
        return self._last

    def peaks(self, design: Mapping[str, float], refined: bool) -> list[Cut]:
        """Simulated peaks about `design`; empty where a torque is the limit event."""
        if self._problem.study.required.limit_event != "simulated":
            return []
        _, places = self._analysis.largest_peaks(design, refined)
        points = [self._analysis.at(design, *place, gradient=True) for place in places]
        numbers = [(p.speed, p.load, p.peaks[k], p.peak_gradients[k]) for k, p in enumerate(points)]
        before: Sequence[Cut | None] = self._last_peaks or [None] * len(points)
        self._last_peaks = self._about(design, numbers, before, PEAK_LEARNING_STEP)
        return self._last_peaks

    def _about(
        self,
        design: Mapping[str, float],
        numbers: Sequence[tuple[float, float, float, np.ndarray]],
        before: Sequence[Cut | None],
        learning_step: float,
    ) -> list[Cut]:
        """Cuts of (speed, load, value, d ln value/d ln design); curvature by symmetric rank-one updates of those before."""
        n = len(self._problem.design_names)
        x = self._problem.scaled(design)[:n]
        slopes = np.array([1.0 if v.logarithmic else 1 / design[v.name] for v in self._problem.variables[:n]])
        cuts = []
        for (speed, load, value, gradient), last in zip(numbers, before, strict=True):
            scaled = gradient * slopes
            cuts.append(Cut(speed, load, float(np.log(value)), scaled, x, _curvature(last, x, scaled, learning_step)))
        return cuts


def _curvature(last: Cut | None, x: np.ndarray, gradient: np.ndarray, learning_step: float) -> np.ndarray:
    if last is None:
        return np.zeros((x.size, x.size))
    step = x - last.centre
    surprise = gradient - last.gradient - last.curvature @ step
    along = surprise @ step
    if np.linalg.norm(step) < learning_step or abs(along) <= 1e-8 * np.linalg.norm(surprise) * np.linalg.norm(step):
        return last.curvature
    return last.curvature + np.outer(surprise, surprise) / along


def _moved(point: tuple[float, float], held: tuple[float, float]) -> bool:
    return point[1] == held[1] and abs(point[0] - held[0]) <= SAME_SPEED * max(point[0], held[0])


def solve_with_decay(
    solver: NlpSolver,
    start: Mapping[str, float],
    points: Sequence[tuple[float, float]],
    form: type[Program],
    decay_points: Sequence[tuple[float, float]] = (),
    **options: Any,
) -> EnvelopeSolution:
    """Local optimum that meets the decay requirement at every speed, from a design that meets the rest.

    Parameters
    ----------
    solver : NlpSolver
    start : mapping
        Design variables by name [SI].
    points : sequence of (speed, load)
        Where stability is imposed in the first round.
    form : type
        Program class.
    decay_points : sequence of (speed, load)
        Where decay is held besides the peaks that are found.
    **options : object
        Passed to `Program.instance`.

    Returns
    -------
    EnvelopeSolution
        Where the ratio cannot be reached, not solved, with the design of least ratio and its `decay`.
    """
    study = solver.problem.study
    required = study.required.decay
    assert required is not None
    allowed = -study.required.stability_margin - study.solver.margin_reserve / 2
    least_ratio = required.ratio * (1 - study.solver.decay_reserve / 2)
    hold, points, design, radius = DecayHold(solver, decay_points), list(points), dict(start), FIRST_RADIUS
    decay, looked = hold.worst(design, refined=False), True
    cuts, peaks = hold.cuts(design), hold.peaks(design, refined=False)
    for rounds in range(1, DECAY_ROUNDS + 1):
        solution = solver.solve(design, points, form, cuts, peaks=peaks, radius=radius, **options)
        if not solution.converged:
            if radius > 8:
                return EnvelopeSolution(solution, (), rounds, False)
            radius *= 4
            continue
        step = np.abs(solution.x - solver.problem.scaled(design))[: len(design)].max()
        design = solution.design
        worst = worst_points(solver.problem.model.at(design), study.envelope, allowed)
        violating = [(p.speed, p.load) for p in worst if p.abscissa > allowed and not any(_close(p, q) for q in points)]
        points += violating
        looked = step < REFINED or rounds % 4 == 0
        if looked:
            decay = hold.worst(design, refined=step < REFINED)
        before, cuts, peaks = cuts, hold.cuts(design), hold.peaks(design, refined=step < REFINED)
        if step < STILL and looked and not violating:
            met = worst[0].abscissa <= allowed and decay[0].ratio <= least_ratio
            if met or solution.extra[0] > STILL:  # all that the ratio can be lowered to
                return EnvelopeSolution(solution, tuple(worst), rounds, met, tuple(decay))
        at_same = {(c.speed, c.load): c for c in before}
        error = max(
            (abs(c.value - at_same[c.speed, c.load].at(c.centre)) for c in cuts if (c.speed, c.load) in at_same), default=1.0
        )
        radius = radius / 3 if error > 0.3 else min(2 * radius, FIRST_RADIUS) if error < 0.05 else radius
    return EnvelopeSolution(solution, (), rounds, False, tuple(decay))


def _close(point: OperatingPoint, used: tuple[float, float]) -> bool:
    return abs(point.speed - used[0]) <= 1e-9 * used[0] and abs(point.load - used[1]) <= 1e-9 * used[1]

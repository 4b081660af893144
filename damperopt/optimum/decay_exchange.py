"""The exchange for decay: simulate a design at its worst speeds, let the program meet a quadratic model of the decay within a
step, simulate again, until the step is nothing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..motion.decay import DecayPoint
from ..stability.worst import worst_points
from .cuts import Cut
from .exchange import EnvelopeSolution, allowed_abscissa, missed_points
from .program import CUTS, Program
from .solve import NlpSolver

__all__ = ["DecayHold", "solve_with_decay"]

DECAY_ROUNDS = 30

FIRST_RADIUS = 1.0
"""Longest first step of a scaled design variable with modelled decay: a factor of e."""

BAD_MODEL, GOOD_MODEL = 0.3, 0.05
"""Errors of ln(decay ratio) above which the next step is shortened, and below which it is lengthened."""

SHORTENED, LENGTHENED = 3.0, 2.0
"""Factors of the longest step from round to round."""

WIDENED, WIDEST = 4.0, 8.0
"""Factor of the longest step where the program finds no solution within it, and the longest that is still widened."""

LOOK_AGAIN = 4
"""Rounds after which the worst speeds are looked for even where the steps are long."""

STILL = 1e-6
"""Step of the scaled variables that is nothing: the model of the decay ratio is then exact to its square."""

LEARNING_STEP, PEAK_LEARNING_STEP = 1e-5, 3e-3
"""Steps below which the difference of two gradients, of decay ratios or of peaks, shows their errors and no curvature."""

ACROSS = 1e-8
"""Cosine between a step and what it shows of a gradient below which it shows no curvature along itself."""

REFINED = 1e-2
"""Step of the scaled variables below which the worst speeds are looked for in earnest."""

SAME_SPEED = 0.05
"""Two worst speeds closer than this part of the larger are one that has moved."""

NEAR = 0.7
"""Peaks of the decay ratio above this part of the largest are held from the start."""


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
    if np.linalg.norm(step) < learning_step or abs(along) <= ACROSS * np.linalg.norm(surprise) * np.linalg.norm(step):
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
    allowed = allowed_abscissa(study)
    least_ratio = required.ratio * (1 - study.solver.decay_reserve / 2)
    hold, points, design, radius = DecayHold(solver, decay_points), list(points), dict(start), FIRST_RADIUS
    decay, looked = hold.worst(design, refined=False), True
    cuts, peaks = hold.cuts(design), hold.peaks(design, refined=False)
    for rounds in range(1, DECAY_ROUNDS + 1):
        solution = solver.solve(design, points, form, cuts, peaks=peaks, radius=radius, **options)
        if not solution.converged:
            if radius > WIDEST:
                return EnvelopeSolution(solution, (), rounds, False)
            radius *= WIDENED
            continue
        step = np.abs(solution.x - solver.problem.scaled(design))[: len(design)].max()
        design = solution.design
        worst = worst_points(solver.problem.model.at(design), study.envelope, allowed)
        violating = missed_points(worst, allowed, points)
        points += violating
        looked = step < REFINED or rounds % LOOK_AGAIN == 0
        if looked:
            decay = hold.worst(design, refined=step < REFINED)
        before, cuts, peaks = cuts, hold.cuts(design), hold.peaks(design, refined=step < REFINED)
        if step < STILL and looked and not violating:
            met = worst[0].abscissa <= allowed and decay[0].ratio <= least_ratio
            if met or solution.excess > STILL:  # all that the ratio can be lowered to
                return EnvelopeSolution(solution, tuple(worst), rounds, met, tuple(decay))
        radius = _next_radius(radius, _model_error(before, cuts))
    return EnvelopeSolution(solution, (), rounds, False, tuple(decay))


def _model_error(before: Sequence[Cut], after: Sequence[Cut]) -> float:
    """Largest difference of ln(decay ratio) from what the models of the last round say; that of a bad one without any."""
    at_same = {(c.speed, c.load): c for c in before}
    errors = [abs(c.value - at_same[c.speed, c.load].at(c.centre)) for c in after if (c.speed, c.load) in at_same]
    return max(errors, default=1.0)


def _next_radius(radius: float, error: float) -> float:
    """Longest step of the next round: less where the models were bad, more where they were good."""
    if error > BAD_MODEL:
        return radius / SHORTENED
    return min(LENGTHENED * radius, FIRST_RADIUS) if error < GOOD_MODEL else radius

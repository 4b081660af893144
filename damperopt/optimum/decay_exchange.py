"""The exchange for decay: simulate a design at its worst speeds, let the program meet a quadratic model of the decay within a
step, simulate again, until the step is nothing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..motion.decay import DecayPoint
from .cuts import Cut, Place, about, cut_before, held_with
from .damping_exchange import DampingHold, DampingPoint
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

REFINED = 1e-2
"""Step of the scaled variables below which the worst speeds are looked for in earnest."""

NEAR = 0.7
"""Peaks of the decay ratio above this part of the largest are held from the start."""


class DecayHold:
    """Where the decay is held, from round to round.

    Parameters
    ----------
    solver : NlpSolver
        Of a study with a decay requirement.
    more : sequence of (speed, load, damping factor)
        Held in any case [m/s], [N].
    """

    def __init__(self, solver: NlpSolver, more: Sequence[tuple[float, ...]] = ()):
        self._problem, self._analysis = solver.problem, solver.decay
        self._always, self._held = list(more), list[Place]()
        self._last: list[Cut] = []
        self._last_peaks: list[Cut] = []

    def worst(self, design: Mapping[str, float], refined: bool) -> list[DecayPoint]:
        """Peaks of the decay ratio; the high ones are held from now on."""
        damper = self._problem.study.damper
        found = [
            replace(point, damping=factor)
            for factor in dict.fromkeys(damper.damping_factors())
            for point in self._analysis.worst(damper.with_damping(design, factor), refined)
        ]
        peaks = sorted(found, key=lambda point: -point.ratio)
        high = [p.place for p in peaks if p.ratio >= NEAR * peaks[0].ratio][:CUTS]
        self._held = held_with(self._held, high)[len(self._always) - CUTS :]
        return peaks

    def cuts(self, design: Mapping[str, float]) -> list[Cut]:
        """Decay at the held points about `design`."""
        damper, numbers = self._problem.study.damper, []
        for speed, load, factor in (*self._always, *self._held):
            p = self._analysis.at(damper.with_damping(design, factor), speed, load, gradient=True)
            numbers.append(((speed, load, factor), p.ratio, p.gradient))
        # a speed that has moved keeps what was learnt
        before = [cut_before(n[0], self._last) for n in numbers]
        self._last = about(self._problem, design, numbers, before, LEARNING_STEP)
        return self._last

    def peaks(self, design: Mapping[str, float], refined: bool) -> list[Cut]:
        """Simulated peaks about `design`; empty where a torque is the limit event."""
        if self._problem.study.required.limit_event != "simulated":
            return []
        _, places = self._analysis.largest_peaks(design, refined)
        points = [self._analysis.at(design, *place, gradient=True) for place in places]
        numbers = [((p.speed, p.load, 1.0), p.peaks[k], p.peak_gradients[k]) for k, p in enumerate(points)]
        before: Sequence[Cut | None] = self._last_peaks or [None] * len(points)
        self._last_peaks = about(self._problem, design, numbers, before, PEAK_LEARNING_STEP)
        return self._last_peaks


def solve_with_decay(
    solver: NlpSolver,
    start: Mapping[str, float],
    points: Sequence[tuple[float, ...]],
    form: type[Program],
    decay_points: Sequence[tuple[float, ...]] = (),
    **options: Any,
) -> EnvelopeSolution:
    """Local optimum that meets the decay requirement at every speed, from a design that meets the rest.

    Parameters
    ----------
    solver : NlpSolver
    start : mapping
        Design variables by name [SI].
    points : sequence of (speed, load, damping factor)
        Where stability is imposed in the first round.
    form : type
        Program class.
    decay_points : sequence of (speed, load, damping factor)
        Where decay is held besides the peaks that are found.
    **options : object
        Passed to `Program.instance`.

    Returns
    -------
    EnvelopeSolution
        Where the ratio cannot be reached, not solved, with the design of least ratio and its `decay`.
    """
    study = solver.problem.study
    allowed = allowed_abscissa(study)
    points, design, radius = list(points), dict(start), FIRST_RADIUS
    hold = _Holds(solver, decay_points)
    hold.look(design, refined=False, motions=True)
    cuts = hold.cuts(design, refined=False)
    for rounds in range(1, DECAY_ROUNDS + 1):
        solution = solver.solve(design, points, form, radius=radius, **cuts, **options)
        if not solution.converged:
            if radius > WIDEST:
                return EnvelopeSolution(solution, (), rounds, False)
            radius *= WIDENED
            continue
        step = np.abs(solution.x - solver.problem.scaled(design))[: len(design)].max()
        design = solution.design
        worst = solver.problem.worst_points(design, allowed)
        violating = missed_points(worst, allowed, points)
        points += violating
        looked = step < REFINED or rounds % LOOK_AGAIN == 0
        hold.look(design, refined=step < REFINED, motions=looked)
        before, cuts = cuts, hold.cuts(design, refined=step < REFINED)
        if step < STILL and looked and not violating:
            met = worst[0].abscissa <= allowed and hold.met()
            if met or solution.excess > STILL:  # all that the ratio can be lowered to
                return EnvelopeSolution(solution, tuple(worst), rounds, met, tuple(hold.decay), tuple(hold.damping))
        radius = _next_radius(radius, max(_model_error(before[kind], cuts[kind]) for kind in MODELLED))
    return EnvelopeSolution(solution, (), rounds, False, tuple(hold.decay), tuple(hold.damping))


MODELLED = ("cuts", "damping_cuts")
"""What the errors of models are looked for in."""


class _Holds:
    """Everything that is held by models about a design: decay and peaks of motions, damping ratio of the yaw mode."""

    def __init__(self, solver: NlpSolver, decay_points: Sequence[tuple[float, ...]]):
        self._study = solver.problem.study
        required = self._study.required
        self._motions = None if required.decay is None else DecayHold(solver, decay_points)
        self._mode = None if required.damping_ratio is None else DampingHold(solver.problem, CUTS)
        self.decay, self.damping = list[DecayPoint](), list[DampingPoint]()

    def look(self, design: Mapping[str, float], refined: bool, motions: bool) -> None:
        """Look for the worst speeds; those of motions, which take time, where asked for."""
        if self._motions and motions:
            self.decay = self._motions.worst(design, refined)
        if self._mode:
            self.damping = self._mode.worst(design)

    def cuts(self, design: Mapping[str, float], refined: bool) -> dict[str, list[Cut]]:
        """Models about a design, by the names of the options of `NlpSolver.solve`."""
        motions, mode = self._motions, self._mode
        return {
            "cuts": motions.cuts(design) if motions else [],
            "peaks": motions.peaks(design, refined) if motions else [],
            "damping_cuts": mode.cuts(design) if mode else [],
        }

    def met(self) -> bool:
        """Whether the worst that was found is good enough."""
        required, reserve = self._study.required, self._study.solver.decay_reserve / 2
        decays = required.decay is None or self.decay[0].ratio <= required.decay.ratio * (1 - reserve)
        return decays and (required.damping_ratio is None or self.damping[0].ratio >= required.damping_ratio * (1 + reserve))


def _model_error(before: Sequence[Cut], after: Sequence[Cut]) -> float:
    """Largest difference from what the models of the last round say; that of a bad one without any."""
    if not after:
        return 0.0
    pairs = ((c, cut_before(c.place, before)) for c in after)
    errors = [abs(cut.value - model.at(cut.centre)) for cut, model in pairs if model is not None]
    return max(errors, default=1.0)


def _next_radius(radius: float, error: float) -> float:
    """Longest step of the next round: less where the models were bad, more where they were good."""
    if error > BAD_MODEL:
        return radius / SHORTENED
    return min(LENGTHENED * radius, FIRST_RADIUS) if error < GOOD_MODEL else radius

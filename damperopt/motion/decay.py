"""Decay after a disturbance on the nonlinear model: the measure, its design derivatives, and its worst speeds."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import casadi as ca
import numpy as np
from scipy.optimize import minimize_scalar

from ..dynamics import build
from ..expressions.corners import Smooth
from ..expressions.dae import DAE
from ..stability.linear import LinearModel
from ..study.study import Study
from ..symbols import data_values, symbolic
from .integrators import Integrator, best_engine
from .measure import PEAKS, Decay, decay, fastest_rate, latest_count, loads_of
from .tangent import TangentMotion, output_functions, weights_at_peak

__all__ = ["DecayAnalysis", "DecayPoint"]

PER_CYCLE = 64
"""Output points in a cycle of the fastest mode: the cubic between them is good to 2e-7 of the amplitude."""

STRETCH_CYCLES = 4
"""Cycles of the fastest mode in one call of the integrator."""


MAX_STRETCHES = 80
"""Calls after which a motion that has not completed its cycles is judged as it is: its yaw creeps."""

CREPT = 0.9
"""Part of a motion after which its decay is judged where it has not completed its cycles."""

SETTLED = 1e-2
"""Part of the required ratio below which nothing more can matter."""

MORE_CYCLES = 2
"""Cycles that are looked at beyond those counted."""

HIGH = 0.5
"""Peaks of the decay ratio below this part of the largest are not refined."""

DIFFERENCE = 1e-4
"""Relative step of the differences with respect to the numbers of a study."""

REMEMBERED = 8
"""Designs whose motions are remembered: one with its dampings."""

DIVERGED = 100.0
"""Growth of the yaw angle at which a simulation is given up: the ratio is then this large, or larger."""


@dataclass(frozen=True)
class DecayPoint:
    """Decay at one speed [m/s] and load [N].

    `gradient` holds d ln(ratio)/d ln(design variable), empty if not asked for; `time` is when the ratio is read [s]; `peaks`
    are the largest magnitudes of `PEAKS` and `peak_gradients` (5, n) those of their logarithms, where they size the parts;
    `damping` is the factor on the design's damping.
    """

    speed: float
    load: float
    ratio: float
    gradient: np.ndarray
    time: float
    peaks: np.ndarray
    peak_gradients: np.ndarray
    damping: float = 1.0

    @property
    def place(self) -> tuple[float, float, float]:
        """Speed, load, factor on the damping."""
        return self.speed, self.load, self.damping


class DecayAnalysis:
    """Decay of a study's gear, for any design; its integrators are built with the first motion, and stay.

    The points of the last designs are remembered: the search for the worst and that for peaks look at the same speeds.

    Parameters
    ----------
    study : Study
        With a decay requirement.
    model : LinearModel or None
        Of the study, if it is at hand.
    """

    def __init__(self, study: Study, model: LinearModel | None = None):
        assert study.required.decay is not None
        self.study, self.requirement = study, study.required.decay
        self.model = LinearModel(study) if model is None else model
        self._dae: DAE = build(symbolic(study), Smooth())
        self._data = np.array(data_values(study))
        self._known: dict[tuple[float, ...], dict[tuple[float, float, bool], DecayPoint]] = {}
        at = [self._dae.design, self._dae.speed, self._dae.load, self._dae.data]
        slopes = ca.jacobian(self._dae.relaxed, self._dae.design) @ ca.diag(self._dae.design)
        self._start = ca.Function("start", [self._dae.x, *at], [self._dae.relaxed, ca.densify(slopes)])
        self._outputs, self._output_slopes = output_functions(self._dae, PEAKS)
        slopes = ca.jacobian(ca.vertcat(self._dae.ode, self._dae.alg), self._dae.data)
        self._moving = ca.DM(slopes.sparsity(), 1).full().any(axis=0)
        self._disturbance = f"requirements.decay.{'release' if self.requirement.release else 'kick'}"

    @property
    def engine(self) -> str:
        """Integrator in words."""
        chosen = self.study.solver.engine
        return {"erk": "erk", "cvodes": "cvodes (no C compiler here for erk)"}[best_engine()] if chosen == "auto" else chosen

    def _integrator(self, sensitivities: bool) -> Integrator:
        solver = self.study.solver
        engine = best_engine() if solver.engine == "auto" else solver.engine
        steps = PER_CYCLE * STRETCH_CYCLES
        return Integrator(self._dae, data_values(self.study), steps, engine, solver.integration_tolerance, sensitivities)

    @cached_property
    def _plain(self) -> Integrator:
        return self._integrator(False)

    @cached_property
    def _with_sensitivities(self) -> Integrator:
        return self._integrator(True)

    def at(
        self,
        design: Mapping[str, float],
        speed: float,
        load: float,
        gradient: bool = False,
        data: np.ndarray | None = None,
    ) -> DecayPoint:
        """Decay at one operating point.

        Parameters
        ----------
        design : mapping
            Design variables by name [SI].
        speed, load : float
            [m/s], [N]
        gradient : bool
            Its derivatives as well, from forward sensitivities.
        data : ndarray or None
            Numbers of the study, in the order of `data_names`; None: its own.

        Returns
        -------
        DecayPoint
        """
        if data is not None:
            return self._simulated(design, speed, load, gradient, data)
        of_design = tuple(design[name] for name in self._dae.design_names)
        if of_design not in self._known:
            self._known = dict([*self._known.items()][1 - REMEMBERED :]) | {of_design: {}}
        known, key = self._known[of_design], (float(speed), float(load), gradient)
        if key not in known:
            known[key] = self._simulated(design, speed, load, gradient, self._data)
        return known[key]

    def _simulated(
        self, design: Mapping[str, float], speed: float, load: float, gradient: bool, data: np.ndarray
    ) -> DecayPoint:
        values = [design[name] for name in self._dae.design_names]
        A = self._matrix(np.array(values), speed, load, data)
        latest = latest_count(A, self.requirement.cycles, self._shown)
        motion, answer = self._followed(values, speed, load, A, latest, gradient, data)
        peaks, peak_slopes = self._peaks_of(motion, values, speed, load, gradient, data)
        if answer is None:
            yaw = np.abs(motion.state("yaw_angle"))
            nothing = np.zeros(len(values) if gradient else 0)
            return DecayPoint(speed, load, DIVERGED if yaw[-1] > yaw[0] else 1.0, nothing, motion.time[-1], peaks, peak_slopes)
        slopes = motion.log_slopes(answer.last) - motion.log_slopes(answer.first) if gradient else np.zeros(0)
        if gradient and answer.last == latest:
            slopes += motion.log_rate(latest) * self._latest_slopes(values, speed, load, data)
        return DecayPoint(speed, load, answer.ratio, slopes, answer.last, peaks, peak_slopes)

    def _followed(
        self,
        values: list[float],
        speed: float,
        load: float,
        A: np.ndarray,
        latest: float,
        gradient: bool,
        data: np.ndarray,
    ) -> tuple[TangentMotion, Decay | None]:
        """The motion until its decay is decided; no decay where it diverges."""
        integrator = self._with_sensitivities if gradient else self._plain
        required, start = self.requirement, dict(zip(self._dae.data_names, data, strict=True))
        x0 = np.array([start.get(f"{self._disturbance}.{name}", 0.0) for name in self._dae.state_names])
        stretch = STRETCH_CYCLES * 2 * math.pi / fastest_rate(A)
        x, slopes = (found.full() for found in self._start(x0, values, speed, load, data))
        slopes = slopes if gradient else np.zeros((x0.size, 0))
        motion = TangentMotion(self._dae.state_names, np.zeros(1), x, slopes[:, :, None])
        for stretches in range(1, MAX_STRETCHES + 1):
            x, S, t = motion.x[:, -1], motion.S[:, :, -1] if gradient else None, motion.time[-1]
            try:
                motion = motion.with_more(t, stretch, integrator(x, values, speed, load, stretch, t, S, data=data))
            except FloatingPointError:
                return motion, None
            yaw, rate = motion.state("yaw_angle"), motion.state("yaw_rate")
            first = np.abs(yaw[: integrator.steps]).max()
            if abs(yaw[-1]) > DIVERGED * first:
                return motion, None
            last_stretch = np.abs(yaw[-integrator.steps :]).max()
            settled = stretches > 1 and last_stretch < SETTLED * required.ratio * first
            deadline = min(latest, motion.time[-1]) if settled else latest
            answer = decay(motion.time, yaw, rate, required.cycles, deadline)
            if answer is not None:
                cycle = (answer.last - answer.first) / required.cycles
                if settled or motion.time[-1] >= answer.last + MORE_CYCLES * cycle:
                    return motion, answer
        return motion, decay(motion.time, yaw, rate, required.cycles, CREPT * motion.time[-1])

    def _peaks_of(
        self, motion: TangentMotion, values: list[float], speed: float, load: float, gradient: bool, data: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Largest magnitudes of `PEAKS`, and their derivatives to ln(design variables); empty unless they size the parts."""
        if self.study.required.limit_event != "simulated":
            return np.zeros(0), np.zeros((0, 0))
        m, point = motion.time.size, (speed, load)
        columns = [ca.repmat(ca.DM(v), 1, m) for v in (values, data)]
        found = self._outputs(motion.x, columns[0], *point, columns[1]).full()
        peaks, slopes = np.zeros(len(PEAKS)), np.zeros((len(PEAKS), len(values) if gradient else 0))
        for k, row in enumerate(found):
            top = int(np.abs(row).argmax())
            near = slice(min(max(top - 2, 0), m - 5), min(max(top - 2, 0), m - 5) + 5)
            weights = np.eye(5)[top - near.start] if top == 0 else weights_at_peak(np.abs(row[near]))
            peaks[k] = np.abs(row[near]) @ weights
            if gradient:
                rows = [
                    self._output_slopes(motion.x[:, i], motion.S[:, :, i], values, *point, data)[k, :].full().ravel()
                    for i in range(near.start, near.stop)
                ]
                slopes[k] = np.sign(row[top]) * weights @ np.array(rows) / peaks[k]
        return peaks, slopes

    @property
    def _shown(self) -> tuple[str, ...]:
        """States that are not hidden: the others set no time scale."""
        return tuple(state.name for state in self._dae.states if not state.hidden)

    def _matrix(self, values: np.ndarray, speed: float, load: float, data: np.ndarray) -> np.ndarray:
        """State matrix of the states shown."""
        kept = [i for i, state in enumerate(self._dae.states) if not state.hidden]
        return self.model.state_matrix(ca.DM(values), speed, load, data).full()[np.ix_(kept, kept)]

    def _latest_slopes(self, values: list[float], speed: float, load: float, data: np.ndarray) -> np.ndarray:
        """d `latest_count`/d ln(design variable) [s], by central differences."""

        def latest(factors: np.ndarray) -> float:
            return latest_count(self._matrix(factors * values, speed, load, data), self.requirement.cycles, self._shown)

        steps = DIFFERENCE * np.eye(len(values))
        return np.array([(latest(1 + h) - latest(1 - h)) / (2 * DIFFERENCE) for h in steps])

    def data_gradient(self, design: Mapping[str, float], speed: float, load: float) -> dict[str, np.ndarray]:
        """d ln(ratio)/d number of the study, and those of the peaks if they size the parts, by central differences.

        Parameters
        ----------
        design : mapping
            Design variables by name [SI].
        speed, load : float
            [m/s], [N]

        Returns
        -------
        dict
            By key path; ``speed`` and ``load`` for the operating point. Numbers without effect are left out. Each (1,) or
            (6,): ratio, then `PEAKS`.
        """

        def difference(above: DecayPoint, below: DecayPoint, width: float) -> np.ndarray:
            return np.log(np.append(above.ratio, above.peaks) / np.append(below.ratio, below.peaks)) / width

        slopes, h = {}, DIFFERENCE
        for i, name in enumerate(self._dae.data_names):
            if not self._moving[i] and not name.startswith(self._disturbance):
                continue
            width = h * (abs(self._data[i]) or 1.0)
            up, down = self._data.copy(), self._data.copy()
            up[i] += width
            down[i] -= width
            above, below = (self.at(design, speed, load, data=data) for data in (up, down))
            slopes[name] = difference(above, below, 2 * width)
        above, below = (self.at(design, speed * (1 + sign * h), load) for sign in (1, -1))
        slopes["speed"] = difference(above, below, 2 * h * speed)
        above, below = (self.at(design, speed, load * (1 + sign * h)) for sign in (1, -1))
        slopes["load"] = difference(above, below, 2 * h * load)
        return slopes

    def worst(self, design: Mapping[str, float], refined: bool = True) -> list[DecayPoint]:
        """Local maxima of the decay ratio over the envelope, the largest first; no gradients.

        Parameters
        ----------
        design : mapping
            Design variables by name [SI].
        refined : bool
            Search between the speeds of the first look, `solver.decay_speeds` at each load, from each peak.

        Returns
        -------
        list of DecayPoint
            At the required speeds if there are such; else over the envelope, which is no proof.
        """
        points = []
        for load in loads_of(self.study):
            if self.requirement.speeds is not None:
                points += [self.at(design, speed, load) for speed in self.requirement.speeds]
            else:
                points += self._peaks(design, load, refined)
        return sorted(points, key=lambda point: -point.ratio)

    def largest_peaks(self, design: Mapping[str, float], refined: bool = True) -> tuple[np.ndarray, list[tuple[float, float]]]:
        """Largest magnitudes of `PEAKS` over the envelope, and where each is met.

        Parameters
        ----------
        design : mapping
            Design variables by name [SI].
        refined : bool
            Search between the speeds of the first look.

        Returns
        -------
        tuple
            (5,) peaks [SI], and five (speed, load) [m/s], [N].
        """
        speeds = self.requirement.speeds or self._first_look()
        looked = [self.at(design, speed, load) for load in loads_of(self.study) for speed in speeds]
        best = []
        for k in range(len(PEAKS)):
            top = int(np.argmax([point.peaks[k] for point in looked]))
            best.append(self._refined_peak(design, k, looked[top], speeds) if refined else looked[top])
        return np.array([point.peaks[k] for k, point in enumerate(best)]), [(p.speed, p.load) for p in best]

    def _refined_peak(self, design: Mapping[str, float], k: int, point: DecayPoint, speeds: list[float]) -> DecayPoint:
        """Where the k-th of `PEAKS` is largest between the neighbours of `point` among the speeds."""
        if self.requirement.speeds is not None or len(speeds) == 1:
            return point
        i = speeds.index(point.speed)

        def lower(speed: float) -> float:
            return -float(self.at(design, float(speed), point.load).peaks[k])

        bounds = speeds[max(i - 1, 0)], speeds[min(i + 1, len(speeds) - 1)]
        found = minimize_scalar(lower, bounds=bounds, method="bounded", options={"xatol": 1e-3 * speeds[-1], "maxiter": 8})
        other = self.at(design, float(found.x), point.load)
        return other if other.peaks[k] > point.peaks[k] else point

    def _first_look(self) -> list[float]:
        low, high = self.study.envelope.speed.min, self.study.envelope.speed.max
        return np.unique(np.clip(np.geomspace(low, high, self.study.solver.decay_speeds), low, high)).tolist()

    def _peaks(self, design: Mapping[str, float], load: float, refined: bool) -> list[DecayPoint]:
        speeds, high = self._first_look(), self.study.envelope.speed.max
        count = len(speeds)
        looked = [self.at(design, speed, load) for speed in speeds]
        heights = [point.ratio for point in looked]
        found = []
        for i, point in enumerate(looked):
            left, right = max(i - 1, 0), min(i + 1, count - 1)
            if heights[i] < max(heights[left], heights[right]):
                continue
            if not refined or count == 1 or heights[i] < HIGH * max(heights):
                found.append(point)
                continue
            best = minimize_scalar(
                lambda speed: -self.at(design, float(speed), load).ratio,
                bounds=(speeds[left], speeds[right]),
                method="bounded",
                options={"xatol": 1e-4 * high, "maxiter": 12},
            )
            found.append(max(point, self.at(design, float(best.x), load), key=lambda p: p.ratio))
        return found

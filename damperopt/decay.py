"""Decay after a disturbance on the nonlinear model: the measure, its design derivatives, and its worst speeds."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache

import casadi as ca
import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import minimize_scalar

from .dae import DAE
from .dynamics import build
from .elements import Smooth
from .integrators import Integrator, best_engine
from .specs import Study
from .stability import LinearModel
from .symbols import data_values, symbolic
from .trajectory import Decay, decay

__all__ = ["DecayAnalysis", "DecayPoint", "decay_analysis", "latest_count", "loads_of"]

PER_CYCLE = 64
"""Output points in a cycle of the fastest mode: the cubic between them is good to 2e-7 of the amplitude."""

STRETCH_CYCLES = 4
"""Cycles of the fastest mode in one call of the integrator."""

MAX_STRETCHES = 80
"""Calls after which a motion that has not completed its cycles is judged as it is: its yaw creeps."""

SETTLED = 1e-2
"""Part of the required ratio below which nothing more can matter."""

MORE_CYCLES = 2
"""Cycles that are looked at beyond those counted."""

DIFFERENCE = 1e-4
"""Relative step of the differences with respect to the numbers of a study."""

DIVERGED = 100.0
"""Growth of the yaw angle at which a simulation is given up: the ratio is then this large, or larger."""


@dataclass(frozen=True)
class DecayPoint:
    """Decay at one speed [m/s] and load [N].

    `gradient` holds d ln(ratio)/d ln(design variable), empty if not asked for; `time` is when the ratio is read [s].
    """

    speed: float
    load: float
    ratio: float
    gradient: np.ndarray
    time: float


def latest_count(state_matrix: np.ndarray, cycles: int) -> float:
    """Time [s] from which the decay is taken at the latest: twice m periods of the yaw mode with all else at rest."""
    stiffness = max(-state_matrix[1, 0], 1.0)
    return 2 * cycles * 2 * math.pi / math.sqrt(stiffness)


class DecayAnalysis:
    """Decay of a study's gear, for any design.

    Parameters
    ----------
    study : Study
        With a decay requirement.
    """

    def __init__(self, study: Study):
        assert study.required.decay is not None
        self.study, self.requirement = study, study.required.decay
        self.model = LinearModel(study)
        self._dae: DAE = build(symbolic(study), Smooth())
        self._data = np.array(data_values(study))
        slopes = ca.jacobian(ca.vertcat(self._dae.ode, self._dae.alg), self._dae.data)
        self._moving = ca.DM(slopes.sparsity(), 1).full().any(axis=0)
        self._disturbance = f"requirements.decay.{'release' if self.requirement.release else 'kick'}"

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
        integrator = self._with_sensitivities if gradient else self._plain
        values = [design[name] for name in self._dae.design_names]
        data = self._data if data is None else data
        start_of = dict(zip(self._dae.data_names, data, strict=True))
        x0 = np.array([start_of.get(f"{self._disturbance}.{name}", 0.0) for name in self._dae.state_names])
        A = self.model.state_matrix(ca.DM(values), speed, load, data).full()
        stretch = STRETCH_CYCLES * 2 * math.pi / max(np.abs(np.linalg.eigvals(A).imag).max(), 20.0)
        required, latest = self.requirement, latest_count(A, self.requirement.cycles)
        nothing = np.zeros(len(values) if gradient else 0)
        x, S, start = x0, None, 0.0
        parts: list[np.ndarray] = []
        for _ in range(MAX_STRETCHES):
            try:
                found = integrator(x, values, speed, load, stretch, start, S, data=data)
            except FloatingPointError:
                return DecayPoint(speed, load, DIVERGED, nothing, start)
            x, S = found.x[:, -1], found.sensitivities[:, :, -1] if gradient else None
            # yaw, its rate, and the sensitivities of both, row by row
            rows = np.vstack([found.x[:2], *(found.sensitivities[:2].reshape(-1, found.x.shape[1]))])
            parts.append(rows[:, 1 if parts else 0 :])
            start += stretch
            first = np.abs(parts[0][0]).max()
            if abs(x[0]) > DIVERGED * first:
                return DecayPoint(speed, load, DIVERGED, nothing, start)
            settled = np.abs(rows[0]).max() < SETTLED * required.ratio * first and len(parts) > 1
            history = np.hstack(parts)
            time = np.linspace(0, start, history.shape[1])
            answer = decay(time, history[0], history[1], required.cycles, min(latest, start) if settled else latest)
            if answer is None:
                continue
            if settled or start >= answer.last + MORE_CYCLES * (answer.last - answer.first) / required.cycles:
                slopes = _gradient(time, history, answer)
                if gradient and answer.last == latest:
                    slopes += _rate_at(time, history, latest) * self._latest_slopes(values, speed, load, data)
                return DecayPoint(speed, load, answer.ratio, slopes, answer.last)
        answer = decay(time, history[0], history[1], required.cycles, 0.9 * start)
        if answer is None:
            return DecayPoint(speed, load, 1.0, nothing, start)
        return DecayPoint(speed, load, answer.ratio, _gradient(time, history, answer), answer.last)

    def _latest_slopes(self, values: list[float], speed: float, load: float, data: np.ndarray) -> np.ndarray:
        """d `latest_count`/d ln(design variable) [s], by central differences."""

        def latest(factors: np.ndarray) -> float:
            A = self.model.state_matrix(ca.DM(factors * values), speed, load, data).full()
            return latest_count(A, self.requirement.cycles)

        steps = DIFFERENCE * np.eye(len(values))
        return np.array([(latest(1 + h) - latest(1 - h)) / (2 * DIFFERENCE) for h in steps])

    def data_gradient(self, design: Mapping[str, float], speed: float, load: float) -> dict[str, float]:
        """d ln(ratio)/d number of the study, by central differences.

        Parameters
        ----------
        design : mapping
            Design variables by name [SI].
        speed, load : float
            [m/s], [N]

        Returns
        -------
        dict
            By key path; ``speed`` and ``load`` for the operating point. Numbers without effect are left out.
        """

        slopes, h = {}, DIFFERENCE
        for i, name in enumerate(self._dae.data_names):
            if not self._moving[i] and not name.startswith(self._disturbance):
                continue
            width = h * (abs(self._data[i]) or 1.0)
            up, down = self._data.copy(), self._data.copy()
            up[i] += width
            down[i] -= width
            above, below = (self.at(design, speed, load, data=data) for data in (up, down))
            slopes[name] = math.log(above.ratio / below.ratio) / (2 * width)
        above, below = (self.at(design, speed * (1 + sign * h), load) for sign in (1, -1))
        slopes["speed"] = math.log(above.ratio / below.ratio) / (2 * h * speed)
        above, below = (self.at(design, speed, load * (1 + sign * h)) for sign in (1, -1))
        slopes["load"] = math.log(above.ratio / below.ratio) / (2 * h * load)
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

    def _peaks(self, design: Mapping[str, float], load: float, refined: bool) -> list[DecayPoint]:
        count = self.study.solver.decay_speeds
        low, high = self.study.envelope.speed.min, self.study.envelope.speed.max
        if low == high:
            return [self.at(design, low, load)]
        speeds = np.clip(np.geomspace(low, high, count), low, high)
        looked = [self.at(design, float(speed), load) for speed in speeds]
        heights = [point.ratio for point in looked]
        found = []
        for i, point in enumerate(looked):
            left, right = max(i - 1, 0), min(i + 1, count - 1)
            if heights[i] < max(heights[left], heights[right]):
                continue
            if not refined:
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


def decay_analysis(study: Study) -> DecayAnalysis:
    """The analysis of a study, kept with its compiled integrators: the same study is met several times on its way."""
    return _kept(study.model_dump_json())


@lru_cache(maxsize=8)
def _kept(study_json: str) -> DecayAnalysis:
    return DecayAnalysis(Study.model_validate_json(study_json))


def loads_of(study: Study) -> tuple[float, ...]:
    """Loads at which decay is looked at [N]: those of the list, or five over a range."""
    envelope = study.envelope
    if not envelope.load_is_range:
        return envelope.loads
    return tuple(np.linspace(envelope.loads[0], envelope.loads[1], 5).tolist())


def _rate_at(time: np.ndarray, history: np.ndarray, moment: float) -> float:
    """d ln|yaw|/dt [1/s]."""
    spline = CubicHermiteSpline(time, history[0], history[1])
    return float(spline(moment, 1) / spline(moment))


def _gradient(time: np.ndarray, history: np.ndarray, answer: Decay) -> np.ndarray:
    """d ln(ratio)/d ln(design) from the sensitivities at the two extrema, where the time itself has no effect."""
    d = (len(history) - 2) // 2
    # yaw and its sensitivities, and the rates of all of these
    values, rates = history[[0, *range(2, 2 + d)]], history[[1, *range(2 + d, 2 + 2 * d)]]

    def relative(moment: float) -> np.ndarray:
        i = slice(max(int(np.searchsorted(time, moment)) - 1, 0), None)
        near = CubicHermiteSpline(time[i][:2], values[:, i][:, :2], rates[:, i][:, :2], axis=1)(moment)
        return near[1:] / near[0]

    return relative(answer.last) - relative(answer.first)

"""Decay after a disturbance on the nonlinear model: the measure, its design derivatives, and its worst speeds."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import minimize_scalar

from .dae import DAE
from .dynamics import build
from .elements import Smooth
from .integrators import Integrator, best_engine
from .specs import Study
from .stability import LinearModel
from .symbols import data_values, symbolic
from .trajectory import Decay, decay, hermite

__all__ = ["DecayAnalysis", "DecayPoint", "latest_count", "loads_of"]

PER_CYCLE = 64
"""Output points in a cycle of the fastest mode: the cubic between them is good to 2e-7 of the amplitude."""

STRETCH_CYCLES = 4
"""Cycles of the fastest mode in one call of the integrator."""

MORE_CYCLES = 2
"""Cycles that are looked at beyond those counted."""

DIVERGED = 100.0
"""Growth of the yaw angle at which a simulation is given up: the ratio is then this large, or larger."""


@dataclass(frozen=True)
class DecayPoint:
    """Decay at one speed [m/s] and load [N].

    `gradient` holds d ln(ratio)/d ln(design variable), empty if not asked for.
    """

    speed: float
    load: float
    ratio: float
    gradient: np.ndarray


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
        self._x0 = np.array(self.requirement.disturbance.start(self._dae.state_names))

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

    def at(self, design: Mapping[str, float], speed: float, load: float, gradient: bool = False) -> DecayPoint:
        """Decay at one operating point.

        Parameters
        ----------
        design : mapping
            Design variables by name [SI].
        speed, load : float
            [m/s], [N]
        gradient : bool
            Its derivatives as well, from forward sensitivities.

        Returns
        -------
        DecayPoint
        """
        integrator = self._with_sensitivities if gradient else self._plain
        values = [design[name] for name in self._dae.design_names]
        A = self.model.at(design).matrices(speed, load)[0]
        stretch = STRETCH_CYCLES * 2 * math.pi / max(np.abs(np.linalg.eigvals(A).imag).max(), 20.0)
        cycles, latest = self.requirement.cycles, latest_count(A, self.requirement.cycles)
        x, S, start = self._x0, None, 0.0
        parts: list[np.ndarray] = []
        while True:
            try:
                found = integrator(x, values, speed, load, stretch, start, S)
            except FloatingPointError:
                return DecayPoint(speed, load, DIVERGED, np.zeros(len(values) if gradient else 0))
            x, S = found.x[:, -1], found.sensitivities[:, :, -1] if gradient else None
            # yaw, its rate, and the sensitivities of both, row by row
            rows = np.vstack([found.x[:2], *(found.sensitivities[:2].reshape(-1, found.x.shape[1]))])
            parts.append(rows[:, 1 if parts else 0 :])
            start += stretch
            history = np.hstack(parts)
            time = np.linspace(0, start, history.shape[1])
            first = np.abs(history[0, : PER_CYCLE * STRETCH_CYCLES]).max()
            if abs(x[0]) > DIVERGED * first:
                return DecayPoint(speed, load, DIVERGED, np.zeros(len(values) if gradient else 0))
            answer = decay(time, history[0], history[1], cycles, latest)
            settled = np.abs(rows[0]).max() < 1e-2 * self.requirement.ratio * first and start > latest
            if answer is not None and (settled or start >= answer.last + MORE_CYCLES * (answer.last - answer.first) / cycles):
                return DecayPoint(speed, load, answer.ratio, _gradient(time, history, answer))

    def worst(self, design: Mapping[str, float], speeds: int | None = None) -> list[DecayPoint]:
        """Local maxima of the decay ratio over the envelope, the largest first; no gradients.

        Parameters
        ----------
        design : mapping
            Design variables by name [SI].
        speeds : int or None
            Speeds of the first look at each load; None: `solver.decay_speeds`.

        Returns
        -------
        list of DecayPoint
            At the required speeds if there are such; else refined between the speeds of the first look, which is no proof.
        """
        points = []
        for load in loads_of(self.study):
            if self.requirement.speeds is not None:
                points += [self.at(design, speed, load) for speed in self.requirement.speeds]
            else:
                points += self._peaks(design, load, speeds or self.study.solver.decay_speeds)
        return sorted(points, key=lambda point: -point.ratio)

    def _peaks(self, design: Mapping[str, float], load: float, count: int) -> list[DecayPoint]:
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
            best = minimize_scalar(
                lambda speed: -self.at(design, float(speed), load).ratio,
                bounds=(speeds[left], speeds[right]),
                method="bounded",
                options={"xatol": 1e-4 * high, "maxiter": 12},
            )
            found.append(max(point, self.at(design, float(best.x), load), key=lambda p: p.ratio))
        return found


def loads_of(study: Study) -> tuple[float, ...]:
    """Loads at which decay is looked at [N]: those of the list, or five over a range."""
    envelope = study.envelope
    if not envelope.load_is_range:
        return envelope.loads
    return tuple(np.linspace(envelope.loads[0], envelope.loads[1], 5).tolist())


def _gradient(time: np.ndarray, history: np.ndarray, answer: Decay) -> np.ndarray:
    """d ln(ratio)/d ln(design) from the sensitivities at the two extrema, where the time itself has no effect."""
    d = (len(history) - 2) // 2

    def relative(moment: float) -> np.ndarray:
        i = min(int(np.searchsorted(time, moment, "right")) - 1, time.size - 2)
        h = time[i + 1] - time[i]
        value, rate = history[[0, *range(2, 2 + d)]], history[[1, *range(2 + d, 2 + 2 * d)]]
        at = hermite((moment - time[i]) / h, value[:, i], value[:, i + 1], h * rate[:, i], h * rate[:, i + 1])
        return at[1:] / at[0]

    return relative(answer.last) - relative(answer.first)

"""Gains over speed of least quadratic cost (LQR), for all states or for those that are measured, as polynomials of V.

The cost is the integral of sum (x_i/x_i0)^2 + (u/u_0)^2, with a size for each state that counts and one for the torque
(Bryson's rule), after a kick in yaw. With every state measured the gains are those of Riccati's equation; with some of them
the best of that form, by the descent of Anderson and Moore from the projection of the full ones: Levine & Athans, IEEE Trans.
Automatic Control 15 (1970) 44; Makila & Toivonen, IEEE Trans. Automatic Control 32 (1987) 658. Nothing is proved here: what
the fitted gains do is for `certify` to say.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_continuous_are, solve_continuous_lyapunov

from ..errors import ConfigError
from ..study.study import Study
from .linear import LinearModel

__all__ = ["GainSchedule", "gain_schedule", "measurable"]

SPEEDS = 24
"""At which gains are found before they are fitted."""

DIGITS = 6
"""Of the fitted coefficients: what a file shows is what is proved."""

STEPS, STILL = 400, 1e-10
"""Of the descent; relative change of the cost at which it ends."""

POWERS = ("constant", "linear", "quadratic", "cubic")


@dataclass(frozen=True)
class GainSchedule:
    """Gains over speed.

    Attributes
    ----------
    states : tuple of str
        That are measured.
    speeds : ndarray
        (m,) [m/s]
    gains : ndarray
        (m, k) in N m per SI unit of the state, as the cost has them.
    coefficients : ndarray
        (k, d + 1) of the powers of V, ascending.
    """

    states: tuple[str, ...]
    speeds: np.ndarray
    gains: np.ndarray
    coefficients: np.ndarray

    @property
    def fitted(self) -> np.ndarray:
        """(m, k) of the polynomials at the speeds."""
        return np.polynomial.polynomial.polyval(self.speeds, self.coefficients.T).T

    @property
    def errors(self) -> np.ndarray:
        """(k,) largest error of each polynomial over the largest gain of its state."""
        largest = np.abs(self.gains).max(axis=0)
        return np.abs(self.fitted - self.gains).max(axis=0) / np.where(largest > 0, largest, 1.0)

    @property
    def block(self) -> dict[str, dict[str, float]]:
        """Block ``damper.control.gains`` of a study."""
        rows = zip(self.states, self.coefficients.tolist(), strict=True)
        return {state: dict(zip(POWERS, row, strict=False)) for state, row in rows}


def measurable(study: Study) -> tuple[str, ...]:
    """States that a control can measure: those of the gear, and of a tyre whose contact line is rational."""
    tyre = study.tyre.states if study.tyre.contact.RATIONAL else ()
    return tuple(state.name for state in (*study.gear.states(), *tyre))


def gain_schedule(
    study: Study,
    sizes: Mapping[str, float],
    torque: float,
    *,
    measured: Sequence[str] | None = None,
    degree: int = 2,
    load: float | None = None,
    design: Mapping[str, float] | None = None,
    speeds: int = SPEEDS,
) -> GainSchedule:
    """Gains of least quadratic cost over the speeds of the envelope, fitted by polynomials.

    Parameters
    ----------
    study : Study
        A control that it has is left out; the actuator is taken without lag and limit.
    sizes : mapping of str to float
        What counts in the cost: the size x_i0 of a state at which it counts 1 [SI].
    torque : float
        u_0, the torque at which it counts 1 [N m].
    measured : sequence of str or None
        States that the law has; None: all that can be measured.
    degree : int
        Of the polynomials, 0 to 3.
    load : float or None
        [N]; None: the largest of the envelope.
    design : mapping or None
        Design variables [SI]; None: the starts of the study.
    speeds : int
        At which gains are found, spaced evenly.

    Returns
    -------
    GainSchedule

    Raises
    ------
    ConfigError
        If a name is no state that can be measured, a size is not positive, or no gains make the gear stable at a speed.
    """
    plant, names = _plant(study), measurable(study)
    measured = list(names if measured is None else dict.fromkeys(measured))
    for key, given in (("measured", measured), ("sizes", list(sizes))):
        if unknown := [name for name in given if name not in names]:
            raise ConfigError(f"{key}: '{unknown[0]}' is no state that can be measured; allowed: {', '.join(names)}")
        if not given:
            raise ConfigError(f"{key}: found none; allowed: one or more of {', '.join(names)}")
    for name, size in {**sizes, "torque": torque}.items():
        if not 0 < size < math.inf:
            raise ConfigError(f"sizes: found {size} for {name}; allowed: a positive number")
    if degree not in range(len(POWERS)):
        raise ConfigError(f"degree: found {degree}; allowed: 0 to {len(POWERS) - 1}")
    model = LinearModel(plant)
    gear = model.at(plant.start if design is None else design)
    low, high = study.envelope.speed.min, study.envelope.speed.max
    row = np.linspace(low, high, speeds if low < high else 1)
    A = gear.matrices(row, max(study.envelope.loads) if load is None else load)
    b = _input(plant, model, design)
    Q = np.diag([1 / sizes[name] ** 2 if name in sizes else 0.0 for name in model.state_names])
    C = np.eye(len(Q))[[model.state_names.index(name) for name in measured]]
    gains = np.array([_best(a, b, Q, 1 / torque**2, C, V) for V, a in zip(row, A, strict=True)])
    powers = np.polynomial.polynomial.polyvander(row / high, min(degree, len(row) - 1))
    scaled = np.linalg.lstsq(powers, gains, rcond=None)[0].T
    coefficients = scaled / high ** np.arange(scaled.shape[1])
    rounded = np.vectorize(lambda value: float(f"{value:.{DIGITS}g}"))(coefficients)
    return GainSchedule(tuple(measured), row, gains, rounded)


def _plant(study: Study) -> Study:
    """The gear without control, on a contact line that states stand for."""
    line = study.tyre.contact.realisation("search")
    bare = study.without_control()
    return bare if line is study.tyre.contact else bare.replace(tyre__contact=line.model_dump())


def _input(plant: Study, model: LinearModel, design: Mapping[str, float] | None) -> np.ndarray:
    """(n,) what a torque of the actuator does to the rates, by what a gain of 1 on the yaw angle takes off."""
    by_angle = plant.replace(damper__control={"gains": {"yaw_angle": {"constant": 1.0}}})
    point = plant.envelope.speed.max, max(plant.envelope.loads)
    A, with_gain = (m.at(plant.start if design is None else design).matrices(*point)[0] for m in (model, LinearModel(by_angle)))
    return (A - with_gain)[:, model.state_names.index("yaw_angle")]


def _best(A: np.ndarray, b: np.ndarray, Q: np.ndarray, R: float, C: np.ndarray, speed: float) -> np.ndarray:
    """(k,) gains on C x of least cost at one speed."""
    try:
        full = b @ solve_continuous_are(A, b[:, None], Q, [[R]]) / R
    except np.linalg.LinAlgError:
        raise ConfigError(
            f"no gains make the gear stable at {speed:g} m/s: a mode that the actuator does not reach, or a cost that does not "
            "see it; allowed: sizes of more states, or a gear that is stable without"
        ) from None
    if len(C) == len(A):
        return C @ full
    L = solve_continuous_lyapunov(A - np.outer(b, full), -np.outer(b, b))
    k = np.linalg.solve(C @ L @ C.T, C @ L @ full)
    cost = _cost(A, b, Q, R, k @ C)
    if not np.isfinite(cost):
        raise ConfigError(
            f"measured: found {len(C)} of {len(A)} states, from which no gains were found that keep it stable at "
            f"{speed:g} m/s; allowed: more of them, or all"
        )
    for _ in range(STEPS):
        closed = A - np.outer(b, k @ C)
        P = solve_continuous_lyapunov(closed.T, -(Q + R * np.outer(k @ C, k @ C)))
        L = solve_continuous_lyapunov(closed, -np.outer(b, b))
        towards, step = np.linalg.solve(C @ L @ C.T, C @ L @ P @ b) / R - k, 1.0
        while not (new := _cost(A, b, Q, R, (k + step * towards) @ C)) < cost and step > 1e-12:
            step /= 2
        if not cost - new > STILL * cost:
            break
        k, cost = k + step * towards, new
    return k


def _cost(A: np.ndarray, b: np.ndarray, Q: np.ndarray, R: float, row: np.ndarray) -> float:
    """Cost after a unit kick by the actuator; infinite where the closed loop is not stable."""
    closed = A - np.outer(b, row)
    if np.linalg.eigvals(closed).real.max() >= 0:
        return math.inf
    return float(b @ solve_continuous_lyapunov(closed.T, -(Q + R * np.outer(row, row))) @ b)

"""Proof of stability with contact memory: the exact line with its delay, over every speed and every load of an envelope.

Claim: no root of D(lambda) lies right of Re = -mu, for all speeds V and loads F_z. Steps, each with balls (Arb):

1. Far field: D is not 0 for |lambda| >= R, Re lambda >= -mu.
2. No crossing: D(-mu + i w) is not 0 on boxes that cover 0 <= w <= R and the envelope. So the number of roots to the right
   is the same all over it.
3. Count at one speed and load: N = n/2 - (change of the argument of D along w >= 0)/pi. The sum of the principal values over
   boxes without 0, each in a half plane, is exact; the far field gives the tail.

Where the damping is uncertain, it takes the place of F_z, at one load after the other. Where a box cannot be freed of 0, roots
are counted near it: N > 0 at one point is a proof that the margin is missed there. The verdict is else left open. Vehicle
speed and load are constants in each motion (frozen). No part of the optimiser is used.

A gear whose tyre has states alone is taken as a structure without wheels, where it is no polynomial in the load.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, TypeAlias

import flint
import numpy as np

from ..errors import ConfigError
from ..results import Certificate
from ..stability.linear import LinearGear, LinearModel
from ..study.scope import place_words
from ..study.study import Study
from .boxes import Box, Strips
from .damping import Interval
from .quasi import OverDamping, Quasipolynomial, UnlikeTyres
from .rationals import decimal
from .varying import structure_of

__all__ = ["certify_delay", "roots_to_the_right"]

Q: TypeAlias = flint.fmpq

BITS = 80
"""Of balls."""

MAX_BOXES, MAX_BOXES_OF_RECTANGLE = 12_000, 120_000
"""Boxes that are examined before the answer is left open."""

THINNEST = Q(1, 2**34)
"""Width of a box over its middle at which it is not cut again."""

FREQUENCIES, SPEEDS, LOADS = 4, 2.0, 1.5
"""Ratio of the ends of the first intervals of frequency, speed and load."""

LOOKED_AT = 48
"""Speeds at each load where eigenvalues hint at a point to count at; a hint proves nothing."""

ASIDE = (0.0, 1e-8, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2)
"""Relative distances from a box that keeps its 0 at which roots are counted."""


class _Open(Exception):
    """A box that could not be freed of 0."""

    def __init__(self, box: Box, boxes: int):
        super().__init__()
        self.box, self.boxes = box, boxes


def certify_delay(study: Study, design: Mapping[str, float], margin: float, model: LinearModel) -> Certificate:
    """Prove that a design keeps the stability margin with the exact delay of its tyre, or show where it does not.

    Parameters
    ----------
    study : Study
        On a contact line with a delay.
    design : mapping
        Design variables by name [SI].
    margin : float
        [1/s]
    model : LinearModel
        Of the study.

    Returns
    -------
    Certificate
    """
    try:
        return _certificate(study, design, margin, model)
    except UnlikeTyres as error:
        speed, words = (
            study.envelope.speed,
            f"not proved: {error}; eigenvalues are exact, and a line without delay can be proved",
        )
        return Certificate(False, margin, (speed.min, speed.max), study.envelope.loads, "balls", None, words, 0, "undecided")


def _certificate(study: Study, design: Mapping[str, float], margin: float, model: LinearModel) -> Certificate:
    with flint.ctx.workprec(BITS):
        interval = Interval.of(study)
        if interval is None:
            return _Proof(study, design, margin, model).certificate()
        whole, boxes = Quasipolynomial(study, structure_of(model), design), 0
        for load in study.envelope.loads:
            found = _OverDamping(study, design, margin, model, whole.over_damping(decimal(load)), interval).certificate()
            boxes += found.boxes
            if not found.proved:
                break
        return replace(found, boxes=boxes)


def roots_to_the_right(
    study: Study, design: Mapping[str, float], margin: float, speed: float, load: float, model: LinearModel
) -> int | None:
    """Number of roots right of Re = -margin at one speed and load, proved; None where one is on the line or too near.

    Parameters
    ----------
    study, design, margin, model
        As for `certify_delay`.
    speed, load : float
        [m/s], [N]

    Returns
    -------
    int or None
    """
    with flint.ctx.workprec(BITS):
        return _Proof(study, design, margin, model).count(decimal(speed), decimal(load))


class _Proof:
    """Strips of one design, and what has been looked at."""

    def __init__(
        self,
        study: Study,
        design: Mapping[str, float],
        margin: float,
        model: LinearModel,
        characteristic: Quasipolynomial | OverDamping | None = None,
    ):
        self._study = study
        self._envelope, self._margin, self._gear = study.envelope, margin, model.at(design)
        self._strips = Strips(characteristic or Quasipolynomial(study, structure_of(model), design), margin)
        self._boxes = 0
        speed, loads = study.envelope.speed, [decimal(F) for F in study.envelope.loads]
        self._speeds = decimal(speed.min), decimal(speed.max)
        self._spans = [(loads[0], loads[-1])] if study.envelope.load_is_range else [(F, F) for F in loads]

    def certificate(self) -> Certificate:
        """The three steps for every load or the range of them."""
        for V, F in self._hints():
            if self.count(V, F):
                return self._refuted(V, F)
        for span in self._spans:
            try:
                self._no_crossing(span)
                if self.count(self._speeds[0], span[0]):
                    return self._refuted(self._speeds[0], span[0])
            except _Open as left:
                return self._left_open(left.box)
        return self._outcome("proved", None, None, f"no root right of the line at one point, and {self._everywhere}")

    @property
    def _everywhere(self) -> str:
        if self._envelope.load_is_range:
            return "no root can cross anywhere in the rectangle of speeds and loads"
        return "no root can cross at any speed"

    def _hints(self) -> Iterator[tuple[Q, Q]]:
        """Points where eigenvalues lie furthest beyond the margin, if any do."""
        low, high = (float(V) for V in self._speeds)
        speeds = np.clip(np.geomspace(low, high, LOOKED_AT), low, high)
        ends = self._envelope.loads[0], self._envelope.loads[-1]
        for load in np.linspace(*ends, 5).tolist() if self._envelope.load_is_range else self._envelope.loads:
            found = self._looked_at(speeds, load)
            if found.max() > -self._margin:
                yield decimal(float(speeds[found.argmax()])), decimal(load)

    def _at(self, F: float) -> tuple[LinearGear, float]:
        """Gear and load that a value of the second variable stands for."""
        return self._gear, F

    def _looked_at(self, speeds: np.ndarray, F: float) -> np.ndarray:
        """Abscissae [1/s], or nothing but -inf where eigenvalues are out of reach: hints alone."""
        gear, load = self._at(F)
        try:
            return gear.abscissa(speeds, load)
        except ConfigError:
            return np.full(len(speeds), -np.inf)

    def _no_crossing(self, loads: tuple[Q, Q]) -> None:
        """Step 2, on the far field of step 1."""
        most = MAX_BOXES if loads[0] == loads[1] else MAX_BOXES_OF_RECTANGLE
        slabs = list(itertools.product(_intervals(loads, LOADS), _intervals(self._speeds, SPEEDS)))
        while slabs:
            F, V = slabs.pop()
            R = self._strips(V, F).radius()
            if R is None:  # numbers of the tyre have no bound on so wide a slab
                whole = Box((Q(0), Q(1)), V, F)
                cut = "V" if F[0] == F[1] else "F"
                low, high = getattr(whole, cut)
                if not high - low > THINNEST * high:
                    raise _Open(whole, self._boxes)
                slabs += [(half.F, half.V) for half in whole.halves(cut)]
                continue
            stack = [Box((low, high), V, F) for low, high in _bands(R)]
            while stack:
                box = stack.pop()
                self._boxes += 1
                found = self._strips(box.V, box.F).on(box.w)
                if found.free:
                    continue
                cut = max(found.weights, key=lambda name: found.weights[name])
                low, high = getattr(box, cut)
                if self._boxes > most or not high - low > THINNEST * (high + 1):
                    raise _Open(box, self._boxes)
                stack += box.halves(cut)

    def count(self, V: Q, F: Q) -> int | None:
        """Roots right of the line at one speed and load, step 3; None where a root is on it, or too near to tell."""
        strip = self._strips((V, V), (F, F))
        R = strip.radius()
        if R is None:
            return None
        stack, change = list(reversed(list(_bands(R)))), flint.arb(0)
        while stack:
            low, high = stack.pop()
            self._boxes += 1
            if strip.on((low, high)).free:
                change += (strip.at(high) / strip.at(low)).arg()
            elif high - low > THINNEST * (high + 1):
                middle = (low + high) / 2
                stack += [(middle, high), (low, middle)]
            else:
                return None
        roots = flint.arb(strip.degree) / 2 - (change + strip.beyond(R)) / flint.arb.pi()
        number = roots.unique_fmpz()
        return None if number is None else int(number)

    def _left_open(self, box: Box) -> Certificate:
        """Count to both sides of a box that keeps its 0: one root to the right refutes."""
        w, V, F = box.middle
        speeds = [V * (1 + Q(*step.as_integer_ratio()) * side) for step in ASIDE for side in (1, -1)]
        inside = [speed for speed in speeds if self._speeds[0] <= speed <= self._speeds[1]]
        beyond = self._looked_at(np.array([float(speed) for speed in inside]), float(F))
        for i in np.argsort(-beyond)[:3]:
            speed = decimal(float(inside[i]))
            if self._speeds[0] <= speed <= self._speeds[1] and self.count(speed, F):
                return self._refuted(speed, F)
        words = f"undecided near {self._place(V, F)}, {float(w):.6g} rad/s: a root lies on the line, or too near to tell"
        return self._outcome("undecided", None, float(w), words)

    def _refuted(self, V: Q, F: Q) -> Certificate:
        words, frequency = f"missed at {self._place(V, F)}: {self.count(V, F)} roots right of the line", None
        if np.isfinite(self._looked_at(np.array([float(V)]), float(F))[0]):
            gear, load = self._at(float(F))
            root = gear.roots(float(V), load, 1)[0, 0]
            words, frequency = f"{words}, near {root.real:.6g} +- {abs(root.imag):.6g}i 1/s", float(abs(root.imag))
        return self._outcome("refuted", (V, F), frequency, words)

    def _place(self, V: Q, F: Q) -> str:
        return place_words(self._study, (float(V), float(F)))

    def _outcome(self, verdict: Any, point: tuple[Q, Q] | None, frequency: float | None, reason: str) -> Certificate:
        envelope, place = self._envelope, None if point is None else (float(point[0]), float(point[1]))
        speeds = envelope.speed.min, envelope.speed.max
        proved, method = verdict == "proved", "balls, rectangle" if envelope.load_is_range else "balls"
        return Certificate(proved, self._margin, speeds, envelope.loads, method, place, reason, self._boxes, verdict, frequency)


class _OverDamping(_Proof):
    """The same at one load, over speeds and dampings."""

    def __init__(
        self,
        study: Study,
        design: Mapping[str, float],
        margin: float,
        model: LinearModel,
        characteristic: OverDamping,
        interval: Interval,
    ):
        super().__init__(study, design, margin, model, characteristic)
        self._linear, self._load, self._interval = characteristic.linear, float(characteristic.load), interval
        self._spans = [characteristic.linear.ends]
        self._model_at = lambda factor: model.at(study.damper.with_damping(design, factor))

    def _hints(self) -> Iterator[tuple[Q, Q]]:
        slow, fast = (float(V) for V in self._speeds)
        speeds = np.clip(np.geomspace(slow, fast, LOOKED_AT), slow, fast)
        low, high = self._interval.factors
        for factor in np.clip(np.geomspace(low, high, 5), low, high).tolist():
            g = self._linear.linear_in(decimal(factor))
            found = self._looked_at(speeds, float(g))
            if found.max() > -self._margin:
                yield decimal(float(speeds[found.argmax()])), g

    @property
    def _everywhere(self) -> str:
        return "no root can cross anywhere in the rectangle of speeds and dampings"

    def _at(self, F: float) -> tuple[LinearGear, float]:
        return self._model_at(self._linear.factor(float(F))), self._load

    def _place(self, V: Q, F: Q) -> str:
        return f"{place_words(self._study, (float(V), self._load))}, {float(self._linear.factor(F)):.6g} times the damping"

    def _outcome(self, verdict: Any, point: tuple[Q, Q] | None, frequency: float | None, reason: str) -> Certificate:
        factor, place = None, None
        if point is not None:
            factor, place = float(self._linear.factor(point[1])), (point[0], Q(*self._load.as_integer_ratio()))
        made = super()._outcome(verdict, place, frequency, reason)
        return replace(made, method="balls, damping", damping=self._interval.factors, damping_factor=factor)


def _intervals(ends: tuple[Q, Q], ratio: float) -> list[tuple[Q, Q]]:
    """Closed intervals with common ends that cover a range, none wider than a ratio."""
    low, high = ends
    if low == high:
        return [ends]
    count = max(1, math.ceil(math.log(float(high / low)) / math.log(ratio)))
    inner = [low * Q(*(float(high / low) ** (k / count)).as_integer_ratio()) for k in range(1, count)]
    return list(itertools.pairwise([low, *inner, high]))


def _bands(R: Q) -> Iterator[tuple[Q, Q]]:
    """[0, R] in intervals of even ratio, from the highest down."""
    high = R
    while high > 1:
        yield high / FREQUENCIES, high
        high /= FREQUENCIES
    yield Q(0), high

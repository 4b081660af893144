"""Fatigue of a metal part by a spectrum of flights: rainflow count, Goodman, Basquin, Miner with a scatter factor.

One cycle of amplitude s at mean zero does the damage 2 (s/sigma_f')^m, m = -1/b (Basquin, s = sigma_f' (2N)^b); a mean in
tension is turned into a larger amplitude (Goodman); damages add up (Miner), times a scatter factor on life, to 1 at the end
of the life. `counted` is that sum over a stress history. `of_decaying_sine` and `of_cycles` bound it in closed form, smooth in
the stress, for the optimiser: they take the cycles as fully reversed at their peak, which no cycle of these peaks exceeds
while the peak is below the ultimate strength.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
import rainflow

from ..expressions.calculus import Expr, where
from ..quantities.record import Fraction, Record
from ..quantities.units import Quantity
from .materials import ultimate_stress

__all__ = [
    "Basquin",
    "FlightStresses",
    "Spectrum",
    "counted",
    "goodman",
    "life_damage",
    "life_damage_counted",
    "of_cycles",
    "of_decaying_sine",
    "stress_margin",
    "words_of",
]

_Count = Annotated[float, Quantity("1", at_least=0, example="6")]


class Spectrum(Record):
    """What a flight brings to the parts, and how many flights. The defaults are typical, of no aircraft."""

    flights: Annotated[float, Quantity("1", at_least=1, example="20000")] = 20000.0
    """Flights of a life [1]."""
    turns: _Count = 6.0
    """Turns of taxiing in a flight [1]."""
    turn_share: Fraction = 0.5
    """Torque of such a turn over that of the limit load case of turning [1]."""
    tows: _Count = 1.0
    """Tows in a flight [1]."""
    tow_share: Fraction = 0.5
    """Torque of such a tow over that of the limit load case of towing, or of turning where that is off [1]."""
    landings: _Count = 1.0
    """Transients of landing in a flight, at the worst speed [1]."""
    scatter_factor: Annotated[float, Quantity("1", at_least=1, example="4")] = 4.0
    """On life; 3 to 5 are usual [1]."""


def words_of(spectrum: Spectrum) -> str:
    """The spectrum in a sentence, which says where it is the typical one."""
    named = (spectrum.turns, "turn"), (spectrum.tows, "tow"), (spectrum.landings, "landing transient")
    turns, tows, landings = (f"{count:g} {name}{'' if count == 1 else 's'}" for count, name in named)
    counts = f"{turns}, {tows} and {landings} a flight"
    given = "typical spectrum, of no aircraft" if spectrum == Spectrum() else "spectrum as given"
    return f"{given}: {spectrum.flights:g} flights with {counts}, scatter factor {spectrum.scatter_factor:g} on life"


@dataclass(frozen=True)
class Basquin:
    """Endurance of a metal; expressions.

    Attributes
    ----------
    coefficient : Expr
        sigma_f' [Pa].
    exponent : Expr
        b, negative [1].
    ultimate : Expr
        Ultimate strength [Pa].
    """

    coefficient: Expr
    exponent: Expr
    ultimate: Expr

    @classmethod
    def of(cls, material: Any) -> Basquin | None:
        """Of a material; None where it has no fatigue data."""
        if material.fatigue_exponent is None:
            return None
        return cls(material.fatigue_strength_coefficient, material.fatigue_exponent, ultimate_stress(material))


def goodman(amplitude: Expr, mean: Expr, ultimate: Expr) -> Expr:
    """Amplitude at mean zero that is as bad [Pa]; a mean in compression is not counted in favour.

    Parameters
    ----------
    amplitude, mean : Expr
        Of the cycle [Pa].
    ultimate : Expr
        Ultimate strength [Pa].
    """
    return amplitude / (1 - where(mean > 0, mean, 0.0) / ultimate)


def of_cycles(amplitude: Expr, cycles: Expr, law: Basquin) -> Expr:
    """Damage of a block of fully reversed cycles of one amplitude.

    Parameters
    ----------
    amplitude : Expr
        [Pa]
    cycles : Expr
    law : Basquin
    """
    if isinstance(amplitude, (int, float)) and amplitude == 0:
        return 0.0  # a power of nothing has no derivative to its exponent
    return 2 * cycles * (amplitude / law.coefficient) ** (-1 / law.exponent)


def of_decaying_sine(peak: Expr, decay: Expr, law: Basquin) -> Expr:
    """Bound of the damage of a decaying sine: all its cycles as fully reversed at their first peak.

    Parameters
    ----------
    peak : Expr
        Of the first cycle, below the ultimate strength [Pa].
    decay : Expr
        Amplitude after a cycle over that before it, below 1.
    law : Basquin

    Examples
    --------
    >>> steel = Basquin(1655e6, -0.076, 1172e6)
    >>> f"{of_decaying_sine(490e6, math.exp(-4.03 / 11), steel):.3e}"
    '2.235e-07'
    """
    return of_cycles(peak, 1, law) / (1 - decay ** (-1 / law.exponent))


def counted(history: Sequence[float], law: Basquin) -> float:
    """Damage of a stress history by rainflow count (ASTM E1049), half cycles as halves.

    Parameters
    ----------
    history : sequence of float
        Stresses at one fibre [Pa].
    law : Basquin

    Returns
    -------
    float
        Infinite where a mean reaches the ultimate strength.
    """
    damage = 0.0
    for span, mean, count, _, _ in rainflow.extract_cycles(history):
        if mean >= law.ultimate:
            return math.inf
        damage += float(of_cycles(goodman(span / 2, mean, law.ultimate), count, law))
    return damage


@dataclass(frozen=True)
class FlightStresses:
    """Peak stresses of a flight at one fibre; expressions.

    Attributes
    ----------
    turn, tow : Expr
        Of a turn and a tow of everyday [Pa].
    landing : Expr
        First peak of the transient of landing [Pa].
    decay : Expr
        Of that transient, amplitude after a cycle over that before it, below 1.
    """

    turn: Expr = 0.0
    tow: Expr = 0.0
    landing: Expr = 0.0
    decay: Expr = 0.5


def life_damage(stresses: FlightStresses, spectrum: Spectrum, law: Basquin) -> Expr:
    """Bound of the damage of a life, scatter factor included; at most 1 is required.

    Parameters
    ----------
    stresses : FlightStresses
    spectrum : Spectrum
    law : Basquin
    """
    flight = of_cycles(stresses.turn, spectrum.turns, law) + of_cycles(stresses.tow, spectrum.tows, law)
    flight = flight + spectrum.landings * of_decaying_sine(stresses.landing, stresses.decay, law)
    return spectrum.scatter_factor * spectrum.flights * flight


def life_damage_counted(stresses: FlightStresses, spectrum: Spectrum, law: Basquin, transient: Any = None) -> float:
    """The same by the count: one flight as a history of stress, counted, times flights and scatter factor.

    Parameters
    ----------
    stresses : FlightStresses
        Floats.
    spectrum : Spectrum
        Whole counts; parts of one are rounded up.
    law : Basquin
    transient : sequence of float or None
        Simulated stress of a landing [Pa], of its own peak; None: the decaying sine of the stresses.

    Returns
    -------
    float
    """
    history = [0.0]
    for _ in range(math.ceil(spectrum.landings)):
        history += list(_sine(stresses.landing, stresses.decay) if transient is None else transient)
    for peak, count in ((stresses.turn, spectrum.turns), (stresses.tow, spectrum.tows)):
        for turn in range(math.ceil(count)):  # to either side by turns
            history += [peak * (-1) ** turn, 0.0]
    return spectrum.scatter_factor * spectrum.flights * counted(history, law)


def _sine(peak: float, decay: float) -> np.ndarray:
    """Extrema of a cosine that decays, until they are a thousandth."""
    half_cycles = 2 * math.ceil(math.log(1e-3) / math.log(decay)) if decay > 0 else 1
    return peak * (-math.sqrt(decay)) ** np.arange(half_cycles + 1)


def stress_margin(damage: Expr, law: Basquin) -> Expr:
    """Margin of safety on stress [1]: all stresses times 1 + MS would make the damage 1.

    Parameters
    ----------
    damage : Expr
        Of a life, scatter factor included, above 0.
    law : Basquin
    """
    return damage**law.exponent - 1

"""Wavelength of the motion along the ground: how many contact lengths a string tyre sees of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..study.study import Study
from .gear import LinearGear

__all__ = ["Wavelength", "contact_length", "contact_line_words", "shortest_wavelength"]

SPEEDS = 60
"""Of the envelope, at which the modes are looked at."""


@dataclass(frozen=True)
class Wavelength:
    """The shortest wavelength 2 pi V/omega of the modes, in lengths of the contact line.

    Attributes
    ----------
    length : float
        [m]
    contact_lengths : float
        The same in lengths 2 a of the contact line.
    speed, load : float
        Where it occurs [m/s], [N].
    """

    length: float
    contact_lengths: float
    speed: float
    load: float


def shortest_wavelength(
    study: Study, gear: LinearGear, speeds: Sequence[float] | None = None, loads: Sequence[float] | None = None
) -> Wavelength | None:
    """The wavelength that is shortest in contact lengths, of all modes that do not die out within a part of their turn.

    Parameters
    ----------
    study : Study
        For the length of the contact line.
    gear : LinearGear
    speeds, loads : sequence of float or None
        (m,) [m/s], (k,) [N]; None: those of the envelope.

    Returns
    -------
    Wavelength or None
        None where nothing oscillates.
    """
    ends = study.envelope.speed
    V = np.geomspace(ends.min, ends.max, SPEEDS) if speeds is None else np.asarray(speeds, float)
    found = []
    for load in study.envelope.loads if loads is None else loads:
        roots = gear.roots(V, load)
        fastest = np.where(roots.real > -np.abs(roots.imag), np.abs(roots.imag), 0.0).max(axis=1)
        with np.errstate(divide="ignore"):
            lengths = np.where(fastest > 0, 2 * math.pi * V / fastest, np.inf)
        at = int(lengths.argmin())
        if np.isfinite(lengths[at]):
            length = float(lengths[at])
            found.append(Wavelength(length, length / contact_length(study, load), float(V[at]), float(load)))
    return min(found, key=lambda wave: wave.contact_lengths, default=None)


def contact_length(study: Study, load: float) -> float:
    """Length 2 a of the contact line; of several wheels the longest.

    Parameters
    ----------
    study : Study
    load : float
        Of the gear [N].

    Returns
    -------
    float
        [m]
    """
    data = (tuple(tyre.linear(own, tyre.pressure)) for own, tyre in study.on_wheels(load))
    return 2 * max(float(a) for *_, a in data)


def contact_line_words(study: Study, wave: Wavelength | None) -> tuple[str, ...]:
    """What a contact line other than the exact one means for the waves at hand: a phrase, or none.

    Parameters
    ----------
    study : Study
    wave : Wavelength or None
        The shortest of what is said.

    Returns
    -------
    tuple of str
    """
    line = study.tyre.contact
    least = line.least_wave()
    if least == 0:
        return ()
    words = f"the contact line {line.contact} stands for the exact one (tyre.contact memory)"
    if wave is None:
        return (words,)
    words += (
        f": the shortest wavelength of a mode is {wave.length:.3g} m, {wave.contact_lengths:.3g} contact lengths, "
        f"at {wave.speed:.4g} m/s and {wave.load / 1e3:.4g} kN"
    )
    return (f"{words}; below {least:.3g} the answer may not hold for the tyre" * (wave.contact_lengths < least) or words,)

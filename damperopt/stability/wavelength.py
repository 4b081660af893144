"""Wavelength of the motion along the ground: how many contact lengths a string tyre sees of it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..study.study import Study
from .modes import ModeTable

__all__ = ["Wavelength", "shortest_wavelength"]


@dataclass(frozen=True)
class Wavelength:
    """The shortest wavelength 2 pi V/omega of the modes.

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


def shortest_wavelength(study: Study, tables: Iterable[ModeTable]) -> Wavelength | None:
    """The shortest wavelength of all oscillating modes.

    Parameters
    ----------
    study : Study
        For the length of the contact line.
    tables : iterable of ModeTable
        A load each.

    Returns
    -------
    Wavelength or None
        None where nothing oscillates.
    """
    found = []
    for table in tables:
        fastest = np.abs(table.eigenvalues.imag).max(axis=1)
        with np.errstate(divide="ignore"):
            lengths = np.where(fastest > 0, 2 * math.pi * table.speeds / fastest, np.inf)
        at = int(lengths.argmin())
        if np.isfinite(lengths[at]):
            length = float(lengths[at])
            contact = 2 * max(_half_contact_length(study, own) for own in study.wheel_loads(table.load))
            found.append(Wavelength(length, length / contact, float(table.speeds[at]), table.load))
    return min(found, key=lambda wave: wave.length, default=None)


def _half_contact_length(study: Study, load: float) -> float:
    *_, a = study.tyre.linear(load, study.tyre.pressure)
    return float(a)

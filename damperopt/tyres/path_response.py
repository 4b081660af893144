"""Force and moment of a tyre that follows a wave on the ground: the exact contact line, and what others make of it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .assembly import contact_lines
from .base import ContactLine, Linear

__all__ = ["RESPONSES", "PathResponse", "path_response"]

RESPONSES = {"F/theta": "N/rad", "F/eta": "N/m", "M/theta": "N m/rad", "M/eta": "N"}
"""Side force and aligning moment over swivel and lateral position of the wheel, with their units."""

LONGEST, SHORTEST, POINTS = 100.0, 1.25, 240
"""Contact lengths per wave."""

SPEED = 40.0
"""At which a line is shown that has a time of its own, such as that of its damping [m/s]."""


@dataclass(frozen=True)
class PathResponse:
    """Transfer functions along the path at one load.

    Attributes
    ----------
    load : float
        Of the wheel [N].
    frequencies : ndarray
        (m,) 2 pi over the wavelength [rad/m].
    contact_lengths : ndarray
        (m,) per wave.
    lines : mapping of str to ndarray
        (4, m) complex, of each contact line; in the order of `RESPONSES`. The first is exact.
    """

    load: float
    frequencies: np.ndarray
    contact_lengths: np.ndarray
    lines: Mapping[str, np.ndarray]

    def errors(self, line: str) -> np.ndarray:
        """(4, m) distance of a line's response from the exact one, in parts of its magnitude."""
        exact = self.lines["memory"]
        found: np.ndarray = np.abs(self.lines[line] - exact) / np.abs(exact)
        return found

    def holds_to(self, line: str, part: float = 0.1) -> float:
        """Contact lengths per wave above which all four responses of a line err by less than a part; NaN where none does."""
        bad = np.flatnonzero((self.errors(line) > part).any(axis=0))
        if bad.size == 0:
            return float(self.contact_lengths[-1])
        return float(self.contact_lengths[bad[0] - 1]) if bad[0] else math.nan


def path_response(tyre: Any, load: float) -> PathResponse | None:
    """Responses of a tyre on every contact line that needs no numbers of its own, and on its own one.

    Parameters
    ----------
    tyre : Tyre
    load : float
        Of the wheel [N].

    Returns
    -------
    PathResponse or None
        None where half contact length, relaxation length or a stiffness is missing.
    """
    linear = Linear(*tyre.linear(load, tyre.pressure))
    if any(value is None or not value > 0 for value in linear):
        return None
    lengths = np.geomspace(LONGEST, SHORTEST, POINTS)
    frequencies = math.pi / (float(linear.half_contact_length) * lengths)
    found = [line(contact=name) for name, line in sorted(contact_lines().items()) if _bare(line)]
    lines = {_label(line): line for line in (*sorted(found, key=lambda line: line.contact != "memory"), tyre.contact)}
    return PathResponse(load, frequencies, lengths, {name: _along(line, frequencies, linear) for name, line in lines.items()})


def _bare(line: type[ContactLine]) -> bool:
    return not any(field.is_required() for name, field in line.model_fields.items() if name != "contact")


def _label(line: ContactLine) -> str:
    """Name of a line, with the numbers that its response hangs on; the order of a field is none of them."""
    numbers = {key: getattr(line, key) for key in type(line).model_fields if line.RATIONAL and key != "contact"}
    return ", ".join((line.contact, *(f"{key} {value}" for key, value in numbers.items() if value not in ("memory", None))))


def _along(line: ContactLine, frequencies: np.ndarray, linear: Linear) -> np.ndarray:
    return np.array([line.response(1j * k, linear, SPEED) for k in frequencies]).T

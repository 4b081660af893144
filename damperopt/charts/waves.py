"""Waves along the ground on the boundary of a chart, in contact lengths of the tyre."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..stability.wavelength import Wavelength, contact_length
from ..study.study import Study
from .chart import StabilityChart

__all__ = ["boundary_wavelength"]

LOOKED_AT = 40
"""Points of a curve, at most."""


def boundary_wavelength(study: Study, record: StabilityChart) -> Wavelength | None:
    """The shortest wavelength V/f, in contact lengths, with which the gear swings on the curves of a chart.

    Parameters
    ----------
    study : Study
    record : StabilityChart
        Of the study.

    Returns
    -------
    Wavelength or None
        None where nothing swings.
    """
    found = []
    for point, frequency in _swinging(record):
        V, F_z = point.pop("speed", record.speed), point.pop("vertical_load", record.load)
        tyre = {name.replace(".", "__"): value for name, value in point.items() if name.startswith("tyre.")}
        length = V / frequency
        found.append(Wavelength(length, length / contact_length(study.replace(**tyre) if tyre else study, F_z), V, F_z))
    return min(found, key=lambda wave: wave.contact_lengths, default=None)


def _swinging(record: StabilityChart) -> Iterator[tuple[dict[str, float], float]]:
    """Points of the curves where a pair of roots is critical, by the names of their quantities, and its frequency [Hz]."""
    for family in record.families:
        varied = {} if record.varied is None or family.value is None else {record.varied.name: float(family.value)}
        for curve in family.curves:
            swinging = np.flatnonzero(curve.hopf & (curve.frequency > 0))
            for k in swinging[:: max(1, -(-swinging.size // LOOKED_AT))]:
                x, y = map(float, curve.points[k])
                yield {record.x.name: x, record.y.name: y} | varied, float(curve.frequency[k])

"""Critical speeds: where a root of the characteristic polynomial crosses the axis, as roots and not as hits of a grid."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from ..errors import ConfigError
from .delay import DelayGear
from .delay_line import DelayLine
from .family import Line
from .gear import LinearGear

__all__ = ["CriticalSpeed", "along_loads", "along_speeds", "critical_speeds", "marginal_throughout"]

ON_THE_LINE = 1e-6
"""Relative: |Re + margin| of a root at a candidate that is polished; candidates without such a root are no crossings."""

NEIGHBOURHOOD = 1e-2
"""Relative change of speed over which a root that crosses moves by more than rounding."""

ROUNDING = 1e-12
"""Relative to the largest root: real parts below are rounding of eigenvalues."""

TURNS = 1e-3
"""|Re + margin| where a root touches the line over its values a `NEIGHBOURHOOD` to both sides: it goes with the square of the
distance, while that of a root that only comes near at an end of the range hardly changes."""

SAME = 1e-8
"""Relative: two candidates of one crossing."""


@dataclass(frozen=True)
class CriticalSpeed:
    """A speed at which a root crosses or touches the imaginary axis (or the line Re = -margin).

    Attributes
    ----------
    speed, load : float
        [m/s], [N].
    kind : str
        ``hopf`` (a pair, flutter-like shimmy) or ``divergence`` (a real root).
    frequency : float
        Of the crossing pair [Hz]; 0 for divergence.
    destabilising : bool
        True where the root moves to the right with rising speed.
    boundary : bool
        True where the gear as a whole changes between stable and unstable there.
    touching : bool
        True where the root touches the line and turns back.
    """

    speed: float
    load: float
    kind: str
    frequency: float
    destabilising: bool
    boundary: bool
    touching: bool = False


def along_speeds(gear: LinearGear, load: float, low: float, high: float) -> Line | DelayLine:
    """The gear at one load [N] as a polynomial in speed, from `low` to `high` [m/s]; with a delay by its roots."""
    if isinstance(gear, DelayGear):
        return DelayLine(gear, load, low, high)
    return Line(lambda V: gear.matrices(V, load), gear.powers.speed, low, high, "speed")


def along_loads(gear: LinearGear, speed: float, low: float, high: float) -> Line | None:
    """The gear at one speed [m/s] as a polynomial in the load, from `low` to `high` [N]; None where it is none."""
    if gear.powers.load is None or isinstance(gear, DelayGear):
        return None
    return Line(lambda F: gear.matrices(speed, F), gear.powers.load, low, high, "load")


def critical_speeds(gear: LinearGear, load: float, low: float, high: float, margin: float = 0.0) -> list[CriticalSpeed]:
    """Speeds at which a root crosses Re = -margin, as eigenvalues of a pencil in V, not as hits of a grid.

    Parameters
    ----------
    gear : LinearGear
    load : float
        Vertical load [N].
    low, high : float
        Speed range [m/s].
    margin : float
        Stability margin [1/s].

    Returns
    -------
    list of CriticalSpeed
        Ascending in speed. A root that lies on the line at every speed, to rounding, crosses it nowhere: see
        `marginal_throughout`.

    Raises
    ------
    ConfigError
        If speeds or load are not positive, the range is inverted, or the model does not keep its powers of speed.
    """
    if not (0 < low <= high < np.inf and 0 < load < np.inf):
        raise ConfigError(f"found speeds {low:g} to {high:g} m/s, load {load:g} N; allowed: 0 < low <= high, load > 0")
    found: list[CriticalSpeed] = []
    for rough in along_speeds(gear, load, low, high).crossings(-margin):
        for critical in _at(gear, load, float(rough), margin):
            same = [c for c in found if abs(c.speed - critical.speed) <= SAME * c.speed and c.kind == critical.kind]
            if not any(c.destabilising == critical.destabilising or c.touching or critical.touching for c in same):
                found.append(critical)
    return sorted((c for c in found if low * (1 - SAME) <= c.speed <= high * (1 + SAME)), key=lambda c: c.speed)


def marginal_throughout(gear: LinearGear, load: float, low: float, high: float, margin: float = 0.0) -> bool:
    """Whether the rightmost root lies on Re = -margin, to rounding, at every speed of a range: marginal at every speed.

    Parameters
    ----------
    gear : LinearGear
    load : float
        Vertical load [N].
    low, high : float
        Speed range [m/s].
    margin : float
        Stability margin [1/s].

    Returns
    -------
    bool
        False for a single speed.
    """
    if low == high:
        return False
    roots = gear.roots(np.geomspace(low, high, 9), load)
    return bool((np.abs(roots.real.max(axis=1) + margin) <= 1e3 * ROUNDING * np.abs(roots).max(axis=1)).all())


def _at(gear: LinearGear, load: float, rough: float, margin: float) -> Iterator[CriticalSpeed]:
    """Crossings at a candidate; none where no root of the gear is on the line, or one only by rounding."""

    def roots(V: float) -> np.ndarray:
        return gear.roots(V, load)[0] + margin

    here = roots(rough)
    largest = np.abs(here).max()
    near = [s for s in here if s.imag >= 0 and abs(s.real) <= 1e-2 * (1 + abs(s))]
    for crossing in sorted(near, key=lambda s: abs(s.real)):

        def real_part(V: float, crossing: complex = crossing) -> float:
            values = roots(V)
            return float(values[np.abs(values - crossing).argmin()].real)

        speed = _polish(real_part, rough)
        at = abs(real_part(speed))
        if at > ON_THE_LINE * (1 + abs(crossing)):
            continue  # two real roots at equal distances, or another root than the one that crosses
        step = 1e-5 * speed
        below, above = real_part(speed - step), real_part(speed + step)
        around = [abs(real_part(speed * (1 + side * NEIGHBOURHOOD))) for side in (-1, 1)]
        if max(around) <= ROUNDING * largest:
            continue  # on the line whatever the speed
        touching = (below < 0) == (above < 0)
        if touching and at > TURNS * min(around):
            continue
        before, after = gear.abscissa([speed - step, speed + step], load) + margin
        pair = abs(crossing.imag) > ON_THE_LINE * (1 + abs(crossing))
        yield CriticalSpeed(
            speed=speed,
            load=load,
            kind="hopf" if pair else "divergence",
            frequency=float(abs(crossing.imag) / (2 * np.pi)) if pair else 0.0,
            destabilising=bool(above > below),
            boundary=bool((before < 0) != (after < 0)),
            touching=touching,
        )


def _polish(function: Callable[[float], float], rough: float) -> float:
    for width in (1e-9, 1e-7, 1e-5, 1e-3):
        ends = rough * (1 - width), rough * (1 + width)
        if function(ends[0]) * function(ends[1]) < 0:
            return float(brentq(function, *ends, xtol=1e-14 * rough, rtol=1e-14))
    return rough  # touches the axis without crossing it

"""D(-mu + i w) of a gear with contact memory on boxes of frequency, speed and load: enclosures that do or do not hold 0.

On a box D lies in its own ball enclosure, and, by the mean value theorem, within
|D_w| dw + |D_V| dV + |D_F| dF of its value in the middle, with the derivatives enclosed over the box.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce
from operator import mul
from typing import TypeAlias

import flint

from .balls import Transit, ball, transit_of
from .quasi import Quasipolynomial, Slice, Tyre
from .rationals import decimal

__all__ = ["Box", "Enclosure", "Strip", "Strips"]

Q: TypeAlias = flint.fmpq
Rows: TypeAlias = Mapping[tuple[int, int], flint.acb_poly]


@dataclass(frozen=True)
class Box:
    """Closed intervals of frequency [rad/s], speed [m/s] and load [N], exact ends."""

    w: tuple[Q, Q]
    V: tuple[Q, Q]
    F: tuple[Q, Q]

    def halves(self, name: str) -> tuple[Box, Box]:
        """Cut along ``w``, ``V`` or ``F``."""
        low, high = getattr(self, name)
        middle = (low + high) / 2
        parts = {key: getattr(self, key) for key in ("w", "V", "F")}
        return Box(**parts | {name: (low, middle)}), Box(**parts | {name: (middle, high)})

    @property
    def middle(self) -> tuple[Q, Q, Q]:
        """Frequency, speed, load."""
        w, V, F = ((low + high) / 2 for low, high in (self.w, self.V, self.F))
        return w, V, F


@dataclass(frozen=True)
class Enclosure:
    """What is known of D on a box.

    Attributes
    ----------
    free : bool
        D is not 0 anywhere on it.
    whole : acb
        Ball over D.
    weights : dict
        How much each direction adds to the size of the enclosure: the largest is cut.
    """

    free: bool
    whole: flint.acb
    weights: dict[str, float]


class Strip:
    """D over an interval of speeds and one of loads, for any frequencies.

    Parameters
    ----------
    part : Slice
        D over the loads.
    speeds : tuple of fmpq
        Ends [m/s], which may be one.
    margin : float
        mu [1/s]
    degree, lift : int
        Of D: lambda^degree has the coefficient V^lift.
    """

    def __init__(self, part: Slice, speeds: tuple[Q, Q], margin: float, degree: int, lift: int):
        low, high = speeds
        self._part, self.degree, self._lift = part, degree, lift
        self._mu = -flint.arb(decimal(margin))
        self._middle, self._over = flint.arb((low + high) / 2), ball(flint.arb(low), flint.arb(high))
        self._dV, self._dF = flint.arb((high - low) / 2), part.half_width
        derivatives = {key: [row.derivative() for row in rows] for key, rows in part.over.items()}
        self._at = _put_in(part.middle, self._middle)
        self._all = _put_in(part.over, self._over)
        self._by_s = {key: row.derivative() for key, row in self._all.items()}
        self._by_V = _put_in(derivatives, self._over) if high > low else {}
        self._by_F = _put_in(part.slope, self._over)

    def at(self, w: Q) -> flint.acb:
        """D at one frequency, in the middle of the strip."""
        s = flint.acb(self._mu, flint.arb(w))
        f, m = _of_line(self._part.tyre_middle, transit_of(s * self._part.tyre_middle.length / self._middle))
        return _sum(self._at, s, f, m)

    def on(self, w: tuple[Q, Q]) -> Enclosure:
        """D over an interval of frequencies."""
        s = flint.acb(self._mu, ball(flint.arb(w[0]), flint.arb(w[1])))
        dw = flint.arb((w[1] - w[0]) / 2)
        tyre, V = self._part.tyre_over, self._over
        per = tyre.length / V
        z = s * per
        line = transit_of(z)
        f, m = _of_line(tyre, line)
        direct = _sum(self._all, s, f, m)
        if direct.abs_lower() > 0:
            return Enclosure(True, direct, {})
        f_z = tyre.force[1] * line.delayed_z + tyre.force[2] * line.mean_z
        m_z = tyre.moment[1] * line.delayed_z + tyre.moment[2] * line.chi_z
        by_f, by_m = _slopes(self._all, s, f, m)
        changes = f_z * by_f + m_z * by_m
        weights = {"w": abs(_sum(self._by_s, s, f, m) + changes * per) * dw}
        if self._by_V:
            weights["V"] = abs(_sum(self._by_V, s, f, m) - changes * z / V) * self._dV
        if self._by_F:
            change = self._part.tyre_slope
            f_F, m_F = _of_line(change, line)
            longer = s * change.length / V
            by_F = _sum(self._by_F, s, f, m) + by_f * f_F + by_m * m_F + changes * longer
            weights["F"] = abs(by_F) * self._dF
        middle = self.at((w[0] + w[1]) / 2)
        reach = sum(weights.values(), flint.arb(0)).abs_upper()
        around = middle + flint.acb(flint.arb(0, reach), flint.arb(0, reach))
        free = bool(middle.abs_lower() > reach)
        return Enclosure(free, around, {name: float(value.abs_upper()) for name, value in weights.items()})

    def radius(self) -> Q:
        """R with |D/(V^lift lambda^n) - 1| < 1 wherever |lambda| >= R and Re lambda >= -mu."""
        tyre, n = self._part.tyre_over, self.degree
        largest = (-self._mu * tyre.length / self._over).exp().abs_upper()  # of |E| and |phi1|; |chi| is at most half of it
        f = abs(tyre.force[0]) + (abs(tyre.force[1]) + abs(tyre.force[2])) * largest
        m = abs(tyre.moment[0]) + (abs(tyre.moment[1]) + abs(tyre.moment[2]) / 2) * largest
        lead = self._over**self._lift
        sizes = [flint.arb(0)] * n
        for (k, l), row in self._all.items():
            for i in range(n):
                coefficient = row[i] if i < row.length() else flint.acb(0)
                sizes[i] = sizes[i] + abs(coefficient) * f**k * m**l / lead
        R = Q(1)
        while not sum((size * flint.arb(R) ** (i - n) for i, size in enumerate(sizes)), flint.arb(0)) < 1:
            R *= 2
        return R

    def beyond(self, R: Q) -> flint.arb:
        """Change of the argument of D from the frequency R on, where `radius` holds."""
        s = flint.acb(self._mu, flint.arb(R))
        rest = self.at(R) / (s**self.degree * self._middle**self._lift)
        return self.degree * (flint.arb.pi() / 2 - s.arg()) - rest.arg()


def _put_in(rows: Mapping[tuple[int, int], list[flint.arb_poly]], V: flint.arb) -> Rows:
    return {key: flint.acb_poly([row(V) for row in part]) for key, part in rows.items()}


def _of_line(tyre: Tyre, line: Transit) -> tuple[flint.acb, flint.acb]:
    """f and m of a contact line."""
    f = tyre.force[0] + tyre.force[1] * line.delayed + tyre.force[2] * line.mean
    return f, tyre.moment[0] + tyre.moment[1] * line.delayed + tyre.moment[2] * line.chi


def _product(f: flint.acb, k: int, m: flint.acb, l: int) -> flint.acb:
    return reduce(mul, [f] * k + [m] * l, flint.acb(1))


def _sum(rows: Rows, s: flint.acb, f: flint.acb, m: flint.acb) -> flint.acb:
    return sum((row(s) * _product(f, k, m, l) for (k, l), row in rows.items()), flint.acb(0))


def _slopes(rows: Rows, s: flint.acb, f: flint.acb, m: flint.acb) -> tuple[flint.acb, flint.acb]:
    """Derivatives to f and to m."""
    by_f = by_m = flint.acb(0)
    for (k, l), row in rows.items():
        value = row(s)
        if k:
            by_f += k * value * _product(f, k - 1, m, l)
        if l:
            by_m += l * value * _product(f, k, m, l - 1)
    return by_f, by_m


class Strips:
    """Strips of one characteristic function by speeds and loads, each made once.

    Parameters
    ----------
    characteristic : Quasipolynomial
    margin : float
        mu [1/s]
    """

    def __init__(self, characteristic: Quasipolynomial, margin: float):
        self._characteristic, self._margin = characteristic, margin
        self._slices: dict[tuple[Q, Q], Slice] = {}
        self._strips: dict[tuple[tuple[Q, Q], tuple[Q, Q]], Strip] = {}

    def __call__(self, speeds: tuple[Q, Q], loads: tuple[Q, Q]) -> Strip:
        """Strip over speeds [m/s] and loads [N]."""
        if (speeds, loads) not in self._strips:
            if loads not in self._slices:
                self._slices[loads] = self._characteristic.slice(*loads)
            made = self._slices[loads]
            D = self._characteristic
            self._strips[speeds, loads] = Strip(made, speeds, self._margin, D.degree, D.lift)
        return self._strips[speeds, loads]

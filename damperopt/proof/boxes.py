"""D(-mu + i w) of a gear with contact memory on boxes of frequency, speed and load: enclosures that do or do not hold 0.

On a box D lies in its own ball enclosure, and, by the mean value theorem, within
|D_w| dw + |D_V| dV + |D_F| dF of its value in the middle, with the derivatives enclosed over the box.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import reduce
from operator import mul
from typing import TypeAlias

import flint

from .balls import Transit, ball, transit_of
from .quasi import OverDamping, Quasipolynomial, Rows, Slice, Tyre
from .rationals import decimal

__all__ = ["Box", "Enclosure", "Strip", "Strips"]

Q: TypeAlias = flint.fmpq


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
        D is not 0 anywhere on it: all its values there lie in one open half plane.
    weights : dict
        How much each direction adds to the size of the enclosure: the largest is cut.
    """

    free: bool
    weights: dict[str, float]


def _beside(middle: flint.acb, moves: dict[str, flint.acb]) -> Enclosure:
    """Whether middle + t_w D_w + t_V D_V + t_F D_F, |t| <= 1, keeps to one side of a line through 0.

    Lines across the middle value, and along each move: a root that runs beside Re = -mu as frequency and speed change moves D
    along one line, at a distance that stays.
    """
    weights: dict[str, float] = {}
    for along in (None, *moves.values()):
        normal = middle.mid() if along is None else flint.acb(0, 1) * along.mid()
        away = (middle * normal.conjugate()).real
        sizes = {name: abs((move * normal.conjugate()).real) for name, move in moves.items()}
        if abs(away) > sum(sizes.values(), flint.arb(0)):
            return Enclosure(True, {})
        if along is None:
            weights = {name: float(abs(move).abs_upper()) for name, move in moves.items()}
    return Enclosure(False, weights)


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
    degree : int
        n: lambda^n has the coefficient 1.
    """

    def __init__(self, part: Slice, speeds: tuple[Q, Q], margin: float, degree: int):
        low, high = speeds
        self._part, self.degree = part, degree
        self._mu = -flint.arb(decimal(margin))
        self._middle, self._over = flint.arb((low + high) / 2), ball(flint.arb(low), flint.arb(high))
        self._dV, self._dF = flint.arb((high - low) / 2), part.half_width
        self._by_s = {key: row.derivative() for key, row in part.over.items()}

    def at(self, w: Q) -> flint.acb:
        """D at one frequency, in the middle of the strip."""
        s = flint.acb(self._mu, flint.arb(w))
        line = transit_of(s * self._part.tyre_middle.length / self._middle)
        return _Terms(_values(self._part.middle, s), self._middle, *_of_line(self._part.tyre_middle, line)).total()

    def on(self, w: tuple[Q, Q]) -> Enclosure:
        """D over an interval of frequencies."""
        direct, moves = self.spread(w)
        return Enclosure(True, {}) if direct.abs_lower() > 0 else _beside(self.at((w[0] + w[1]) / 2), moves())

    def spread(self, w: tuple[Q, Q]) -> tuple[flint.acb, Callable[[], dict[str, flint.acb]]]:
        """Ball over D on an interval of frequencies, and what its derivatives there times half the widths are, by direction."""
        s = flint.acb(self._mu, ball(flint.arb(w[0]), flint.arb(w[1])))
        part, V = self._part, self._over
        per = part.tyre_over.length / V
        z = s * per
        line = transit_of(z)
        f_m = _of_line(part.tyre_over, line)
        here = _Terms(_values(part.over, s), V, *f_m)

        def moves() -> dict[str, flint.acb]:
            by_f, by_m = here.by_f(), here.by_m()
            f_z = part.tyre_over.force[1] * line.delayed_z + part.tyre_over.force[2] * line.mean_z
            m_z = part.tyre_over.moment[1] * line.delayed_z + part.tyre_over.moment[2] * line.chi_z
            by_z = f_z * by_f + m_z * by_m
            by_s = _Terms(_values(self._by_s, s), V, *f_m).total() + by_z * per
            found = {"w": flint.acb(0, 1) * by_s * flint.arb((w[1] - w[0]) / 2)}
            if self._dV > 0:
                found["V"] = (here.by_V() - by_z * z / V) * self._dV
            if part.slope:
                f_F, m_F = _of_line(part.tyre_slope, line)
                by_F = _Terms(_values(part.slope, s), V, *f_m).total() + by_f * f_F + by_m * m_F
                found["F"] = (by_F + by_z * s * part.tyre_slope.length / V) * self._dF
            return found

        return here.total(), moves

    def radius(self) -> Q | None:
        """R with |D/lambda^n - 1| < 1 wherever |lambda| >= R and Re lambda >= -mu; None where a coefficient has no bound."""
        tyre, n = self._part.tyre_over, self.degree
        largest = (-self._mu * tyre.length / self._over).exp().abs_upper()  # of |E| and |phi1|; |chi| is at most half of it
        f = abs(tyre.force[0]) + (abs(tyre.force[1]) + abs(tyre.force[2])) * largest
        m = abs(tyre.moment[0]) + (abs(tyre.moment[1]) + abs(tyre.moment[2]) / 2) * largest
        sizes = [flint.arb(0)] * n
        for (k, l, j), row in self._part.over.items():
            for i, coefficient in enumerate(row.coeffs()[:n]):
                sizes[i] = sizes[i] + abs(coefficient) * f**k * m**l * self._over**j
        if not all(size.is_finite() for size in sizes):
            return None
        R = Q(1)
        while not sum((size * flint.arb(R) ** (i - n) for i, size in enumerate(sizes)), flint.arb(0)) < 1:
            R *= 2
        return R

    def beyond(self, R: Q) -> flint.arb:
        """Change of the argument of D from the frequency R on, where `radius` holds."""
        s = flint.acb(self._mu, flint.arb(R))
        return self.degree * (flint.arb.pi() / 2 - s.arg()) - (self.at(R) / s**self.degree).arg()


class _Terms:
    """Terms q f^k m^l V^j of D by (k, l, j), at one place or on one box."""

    def __init__(self, values: list[tuple[tuple[int, int, int], flint.acb]], V: flint.arb, f: flint.acb, m: flint.acb):
        self._values, self._V, self._f, self._m = values, V, f, m

    def total(self) -> flint.acb:
        return self._sum(lambda k, l, j: (1, k, l, j))

    def by_f(self) -> flint.acb:
        return self._sum(lambda k, l, j: (k, k - 1, l, j))

    def by_m(self) -> flint.acb:
        return self._sum(lambda k, l, j: (l, k, l - 1, j))

    def by_V(self) -> flint.acb:
        return self._sum(lambda k, l, j: (j, k, l, j - 1))

    def _sum(self, rule: Callable[[int, int, int], tuple[int, int, int, int]]) -> flint.acb:
        """With the powers that a rule makes of (k, l, j), and a factor: gathered by those of f and m first."""
        gathered: dict[tuple[int, int], flint.acb] = {}
        for key, value in self._values:
            factor, k, l, j = rule(*key)
            if factor:
                term = value * self._V**j * factor if j else value * factor
                gathered[k, l] = gathered[k, l] + term if (k, l) in gathered else term
        total = flint.acb(0)
        for (k, l), value in gathered.items():
            total += reduce(mul, [self._f] * k + [self._m] * l, value)
        return total


def _values(rows: Rows, s: flint.acb) -> list[tuple[tuple[int, int, int], flint.acb]]:
    return [(key, row(s)) for key, row in rows.items()]


def _of_line(tyre: Tyre, line: Transit) -> tuple[flint.acb, flint.acb]:
    """f and m of a contact line."""
    f = tyre.force[0] + tyre.force[1] * line.delayed + tyre.force[2] * line.mean
    return f, tyre.moment[0] + tyre.moment[1] * line.delayed + tyre.moment[2] * line.chi


class Strips:
    """Strips of one characteristic function by speeds and loads, each made once.

    Parameters
    ----------
    characteristic : Quasipolynomial or OverDamping
        Of the latter, the second variable stands in the place of the load.
    margin : float
        mu [1/s]
    """

    def __init__(self, characteristic: Quasipolynomial | OverDamping, margin: float):
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
            self._strips[speeds, loads] = Strip(made, speeds, self._margin, D.degree)
        return self._strips[speeds, loads]

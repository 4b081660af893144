"""D0 and D1 of a gear about its yaw axis at one speed and load, and a proof that a whole box of stiffnesses and dampings
shimmies.

With k0, kappa and tau of what stands between the gear and its damper, D(s) = (1 + tau s) D0(s) + (k0 + kappa s) D1(s). D0
is the characteristic function of the gear with nothing there, D1 what a unit of stiffness adds to it, s D1 what a unit of
damping does.

Claim: every gear of a box has a root right of Re s = -mu. On a rectangle whose left side lies on that line D has no zero
for any gear of the box, and in the middle of the box its argument goes round along it: a root lies inside, and none can
leave. D is affine in the three numbers, so that over the box its values at one s fill a zonotope; s is a ball along each
piece of the side.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeAlias

import flint

from ..errors import CertificateError
from ..stability.linear import LinearModel
from ..stability.response import Structure
from ..study.study import Study
from ..symbols import data_names, data_values
from .balls import ball, transit_of
from .boxes import _of_line, _Terms, _values
from .quasi import BITS, Quasipolynomial, Slice
from .rationals import decimal, evaluate

__all__ = ["Contour", "YawGear"]

Q: TypeAlias = flint.fmpq
Numbers: TypeAlias = tuple[flint.arb, flint.arb, flint.arb]

PIECES = 800
"""Of a contour, before a proof is given up."""


@dataclass(frozen=True)
class Contour:
    """A rectangle -mu <= Re s <= right, low <= Im s <= high."""

    right: float
    low: float
    high: float


Both: TypeAlias = tuple[flint.acb, flint.acb]


@dataclass(frozen=True)
class _Pair:
    """D0 and D1 at one speed and load, and their derivatives to s."""

    at: Callable[[flint.acb], Both]
    slopes: Callable[[flint.acb], Both]


class YawGear:
    """The gear of a study with nothing about its yaw axis.

    Parameters
    ----------
    study : Study

    Raises
    ------
    CertificateError
        If stiffness and damping do not enter the linear model as k + s c in one place, or an actuator acts beside them.
    """

    def __init__(self, study: Study):
        if study.damper.actuator is not None:
            raise CertificateError("an actuator acts beside the damper: what shimmies without it need not with it")
        self._studies = [
            study.replace(damper={"topology": "rotational", "torsional_stiffness": k, "torsional_damping": c})
            for k, c in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))
        ]
        self._margin = decimal(study.required.stability_margin)
        bare = self._studies[0]
        if data_names(bare) != data_names(self._studies[1]):
            raise CertificateError("the gear changes with the stiffness about its yaw axis")
        self._delayed = not study.tyre.contact.RATIONAL
        if self._delayed:
            structure = Structure(bare)
            self._quasi = [Quasipolynomial(own, structure, {}) for own in self._studies]
        else:
            self._matrix = LinearModel(bare).state_matrix
        self._pairs: dict[tuple[float, float], _Pair] = {}

    def pair(self, speed: float, load: float) -> _Pair:
        """D0 and D1 at a speed [m/s] and a load [N]."""
        if (speed, load) not in self._pairs:
            make = self._with_delay if self._delayed else self._rational
            self._pairs[speed, load] = make(decimal(speed), decimal(load))
        return self._pairs[speed, load]

    def _rational(self, V: Q, F: Q) -> _Pair:
        found = []
        for own in self._studies:
            data = [decimal(value) for value in data_values(own)]
            found.append(flint.fmpq_mat(evaluate(self._matrix, [[], [V], [F], data])).charpoly())
        D0, by_k, by_c = found[0], found[1] - found[0], found[2] - found[0]
        if by_c != by_k * flint.fmpq_poly([0, 1]):
            raise CertificateError("stiffness and damping enter the linear model in different places: no bound from stability")
        p0, p1 = (flint.acb_poly([flint.arb(c) for c in p.coeffs()]) for p in (D0, by_k))
        d0, d1 = p0.derivative(), p1.derivative()
        return _Pair(lambda s: (p0(s), p1(s)), lambda s: (d0(s), d1(s)))

    def _with_delay(self, V: Q, F: Q) -> _Pair:
        base, with_k, with_c = (quasi.slice(F, F) for quasi in self._quasi)
        first, by_k, by_c = (_Line(part, flint.arb(V)) for part in (base, _less(with_k, base), _less(with_c, base)))
        probe = flint.acb(flint.arb(1) / 3, flint.arb(70) / 3)
        if not (by_c.value(probe) - probe * by_k.value(probe)).contains(flint.acb(0)):
            raise CertificateError("stiffness and damping enter the linear model in different places: no bound from stability")
        return _Pair(lambda s: (first.value(s), by_k.value(s)), lambda s: (first.slope(s), by_k.slope(s)))

    def shimmies(self, low: Numbers, high: Numbers, speed: float, load: float, contour: Contour) -> bool:
        """Whether every gear of a box of k0, kappa, tau has a root right of the margin at this speed and load: a proof if true.

        Parameters
        ----------
        low, high : tuple of arb
            Ends of k0 [N m/rad], kappa [N m s/rad], tau [s].
        speed, load : float
            [m/s], [N]
        contour : Contour
        """
        with flint.ctx.workprec(BITS):
            box = _Box(self.pair(speed, load), low, high)
            left, right = -flint.arb(self._margin), flint.arb(contour.right)
            if not (right > left and contour.high > contour.low):
                return False
            if not all(x.is_finite() for x in (*low, *high)):
                return False
            ends = [(left, contour.low), (right, contour.low), (right, contour.high), (left, contour.high)]
            corners = [flint.acb(re, flint.arb(im)) for re, im in ends]
            turned, pieces = flint.arb(0), 0
            stack = [(corners[(i + 1) % 4], corners[i]) for i in range(4)]
            while stack:
                end, start = stack.pop()
                pieces += 1
                if box.free(start, end):
                    turned += (box.middle(end) / box.middle(start)).arg()
                elif pieces > PIECES:
                    return False
                else:
                    half = (start + end) / 2
                    stack += [(end, half), (half, start)]
            times = (turned / (2 * flint.arb.pi())).unique_fmpz()
            return times is not None and int(times) >= 1


class _Box:
    """Values of D over a box of the three numbers."""

    def __init__(self, pair: _Pair, low: Numbers, high: Numbers):
        self._pair = pair
        self._k, self._c, self._t = ((a + b).mid() / 2 for a, b in zip(low, high, strict=True))
        self._k, self._c, self._t = self._k.mid(), self._c.mid(), self._t.mid()
        self._radii = [
            flint.arb(max((m - a).upper(), (b - m).upper()))
            for m, a, b in zip((self._k, self._c, self._t), low, high, strict=True)
        ]

    def middle(self, s: flint.acb) -> flint.acb:
        """D in the middle."""
        D0, D1 = self._pair.at(s)
        return (1 + self._t * s) * D0 + (self._k + self._c * s) * D1

    def free(self, start: flint.acb, end: flint.acb) -> bool:
        """Whether D is not 0 for any gear of the box on the piece from start to end, and keeps to one side of a line through 0.

        By the mean value theorem along the piece.
        """
        s, half = flint.acb(ball(start.real, end.real), ball(start.imag, end.imag)), (end - start) / 2
        (D0, D1), (D0_s, D1_s) = self._pair.at(s), self._pair.slopes(s)
        front, behind = 1 + self._t * s, self._k + self._c * s
        by_s = front * D0_s + behind * D1_s + self._t * D0 + self._c * D1
        moves = [by_s * half, *(g * r for g, r in zip((D1, s * D1, s * D0), self._radii, strict=True))]
        centre = self.middle((start + end) / 2)
        for normal in (centre.mid(), *(flint.acb(0, 1) * g.mid() for g in moves)):
            n = normal.conjugate()
            if abs((centre * n).real) > sum((abs((g * n).real) for g in moves), flint.arb(0)):
                return True
        return False


class _Line:
    """D of s with contact memory at one speed, and its derivative."""

    def __init__(self, part: Slice, V: flint.arb):
        self._part, self._V, self._per = part, V, part.tyre_middle.length / V
        self._slopes = {key: row.derivative() for key, row in part.middle.items()}

    def value(self, s: flint.acb) -> flint.acb:
        line = transit_of(s * self._per)
        return _Terms(_values(self._part.middle, s), self._V, *_of_line(self._part.tyre_middle, line)).total()

    def slope(self, s: flint.acb) -> flint.acb:
        tyre, line = self._part.tyre_middle, transit_of(s * self._per)
        f, m = _of_line(tyre, line)
        here = _Terms(_values(self._part.middle, s), self._V, f, m)
        f_z = tyre.force[1] * line.delayed_z + tyre.force[2] * line.mean_z
        m_z = tyre.moment[1] * line.delayed_z + tyre.moment[2] * line.chi_z
        own = _Terms(_values(self._slopes, s), self._V, f, m).total()
        return own + (f_z * here.by_f() + m_z * here.by_m()) * self._per


def _less(part: Slice, other: Slice) -> Slice:
    """Difference of two characteristic functions of one tyre; terms that cancel are left out."""
    rows = {}
    for key, row in part.middle.items():
        left = row - other.middle[key] if key in other.middle else row
        if any(not c.contains(flint.acb(0)) for c in left.coeffs()):
            rows[key] = left
    if missing := other.middle.keys() - part.middle.keys():
        raise CertificateError(f"a stiffness takes the terms {sorted(missing)[:3]} away")
    return replace(part, middle=rows)

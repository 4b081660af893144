"""D(lambda) of a gear with contact memory: an exact polynomial in lambda, V, F_z and the numbers of its contact lines.

With f and m what force and moment take from the foremost contact point of a wheel (`tyres.string`), the gear is a matrix whose
entries are rational in V and F_z and linear in f, m and the tyre's numbers; D is its characteristic polynomial, expanded over
the rationals. lambda^n, n the states of the structure and one per wheel, has the coefficient 1: D has no poles, and no
impedance is left in a denominator, since every compliance has its state.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import casadi as ca
import flint

from ..errors import CertificateError
from ..stability.family import Powers
from ..stability.response import Structure
from ..study.study import Study
from ..symbols import data_values
from .balls import ball, enclosed
from .damping import Interval, Linear, over_damping
from .parts import parts_in_powers
from .rationals import decimal, evaluate, rational
from .varying import Varying

__all__ = ["OverDamping", "Quasipolynomial", "Rows", "Slice", "Tyre", "UnlikeTyres"]

Q: TypeAlias = flint.fmpq
ONE, UNUSED = Q(1), flint.arb(1)
Rows: TypeAlias = dict[tuple[int, int, int], flint.acb_poly]
Kept: TypeAlias = dict[tuple[int, int, int], dict[int, flint.arb]]

BITS = 128
"""Of coefficients, which are exact, and of the tyre's numbers as balls."""

VARIABLES = ("s", "V", "F", "f", "m", "side", "swivel", "turn", "softness", "reach", "g")
"""Those of the tyre from ``side`` on; last what uncertain damping makes linear, see `proof.damping`. Entries of the structure
that change with the load follow, see `proof.varying`."""


@dataclass(frozen=True)
class Term:
    """A term of D: its power of s, those (k, l, j) of f, m and V, and those of all else by position; and its coefficient."""

    of_s: int
    powers: tuple[int, int, int]
    inner: Sequence[tuple[int, int]]
    coefficient: flint.arb


@dataclass(frozen=True)
class Tyre:
    """Numbers of a contact line as balls.

    Attributes
    ----------
    force, moment : sequence of arb
        (3,) of 1, E, phi1, and of 1, E, chi.
    others : sequence of arb
        side, swivel, turn, softness, reach.
    length : arb
        2 a [m].
    """

    force: Sequence[flint.arb]
    moment: Sequence[flint.arb]
    others: Sequence[flint.arb]
    length: flint.arb

    @classmethod
    def of(cls, row: Sequence[flint.arb]) -> Tyre:
        """From numbers in the order of `stability.response.FOOTPRINT`."""
        return cls(row[0:3], row[3:6], row[6:11], row[11])


@dataclass(frozen=True)
class Slice:
    """D over an interval of loads: polynomials in lambda by the powers (k, l, j) of f, m and V that they are multiplied by.

    Powers of V come last: in the polynomials in lambda, whose terms cancel where a root is near, V must not have spread yet.

    Attributes
    ----------
    loads : tuple of fmpq
        Ends [N].
    middle, over, slope : dict
        D at the middle load, over all of them, and its derivative to the load without that of f and m; `slope` is empty at one
        load.
    tyre_middle, tyre_over, tyre_slope : Tyre
        Numbers of f and m, likewise.
    """

    loads: tuple[Q, Q]
    middle: Rows
    over: Rows
    slope: Rows
    tyre_middle: Tyre
    tyre_over: Tyre
    tyre_slope: Tyre

    @property
    def half_width(self) -> flint.arb:
        """Half of the interval of loads [N]."""
        return flint.arb((self.loads[1] - self.loads[0]) / 2)


class UnlikeTyres(CertificateError):
    """The wheels of a gear do not share the numbers of one contact line."""


class Quasipolynomial:
    """D of one study and design.

    Parameters
    ----------
    study : Study
        With a contact line that has a delay.
    structure : Structure
        Of the study.
    design : mapping
        Design variables by name [SI].

    Attributes
    ----------
    degree : int
        n

    Raises
    ------
    CertificateError
        If the structure cannot be evaluated exactly, or does not keep its declared powers.
    """

    def __init__(self, study: Study, structure: Structure, design: Mapping[str, float]):
        self._study, self._structure, self._design = study, structure, design
        self._data = [decimal(value) for value in data_values(study)]
        self.degree = len(structure.states) + structure.wheels
        self._kept: dict[Q | None, list[Term]] = {}
        envelope = study.envelope
        self._speeds = decimal(envelope.speed.min), decimal(envelope.speed.max)
        self._varying: Varying | None = None
        if structure.powers.load is None and envelope.load_is_range:
            own = {name: design[name] for name in structure.design_names}
            self._varying = Varying(structure.system, own, structure.powers.speed, self._speeds)
        self._names = (*VARIABLES, *(f"entry_{k}" for k in range(len(self._entries))))
        load, data = ca.SX.sym("load"), ca.SX.sym("data", len(self._data))
        assert structure.footprint is not None
        row = structure.footprint(load, data)
        if structure.wheels > 1 and not ca.is_equal(row, ca.repmat(row[0, :], structure.wheels, 1), 100):
            raise UnlikeTyres("the wheels of this gear have unlike tyres, and a proof with contact memory needs them alike")
        self._interval = Interval.of(study)
        self.linear: Linear | None = None
        self._numbers = ca.Function("numbers", [load, data], [ca.densify(row[0, :])])
        self._slopes = ca.Function("slopes", [load, data], [ca.densify(ca.jacobian(row[0, :], load))])

    @property
    def _entries(self) -> list[tuple[int, int, int]]:
        """Power of V, row and column of what is a variable of its own."""
        return [] if self._varying is None else self._varying.keys

    def slice(self, low: Q, high: Q) -> Slice:
        """D between two loads [N], which may be one."""
        with flint.ctx.workprec(BITS):
            middle, over = flint.arb((low + high) / 2), ball(flint.arb(low), flint.arb(high))
            terms, data = self._terms(low, high), [flint.arb(value) for value in self._data]
            at = Tyre.of(enclosed(self._numbers, [[middle], data]))
            found, _ = _collected(terms, [middle, *at.others, UNUSED, *self._at(middle, data)], self.lift)
            if low == high:
                return Slice((low, high), found, found, {}, at, at, at)
            across, change = (Tyre.of(enclosed(f, [[over], data])) for f in (self._numbers, self._slopes))
            changes = [flint.arb(1), *change.others, flint.arb(0), *self._at(over, data, slopes=True)]
            values = [over, *across.others, UNUSED, *self._at(over, data)]
            return Slice((low, high), found, *_collected(terms, values, self.lift, changes), at, across, change)

    def _at(self, load: flint.arb, data: list[flint.arb], slopes: bool = False) -> list[flint.arb]:
        """Balls over the entries that are variables, or over their slopes."""
        if self._varying is None:
            return []
        return self._varying.slopes(load, data) if slopes else self._varying.values(load, data)

    def over_damping(self, load: Q) -> OverDamping:
        """D at one load [N] as a function of speed and damping."""
        self._terms(load, load)
        assert self.linear is not None
        return OverDamping(self, load, self.linear)

    def slice_of_damping(self, load: Q, low: Q, high: Q) -> Slice:
        """D at one load [N] between two values of what uncertain damping is linear in; the interval stands as `loads`."""
        with flint.ctx.workprec(BITS):
            F, over, middle = flint.arb(load), ball(flint.arb(low), flint.arb(high)), flint.arb((low + high) / 2)
            terms = self._terms(load, load)
            tyre = Tyre.of(enclosed(self._numbers, [[F], [flint.arb(value) for value in self._data]]))
            at, _ = _collected(terms, [F, *tyre.others, middle], self.lift)
            if low == high:
                return Slice((low, high), at, at, {}, tyre, tyre, tyre)
            still = Tyre.of([flint.arb(0)] * 12)
            changes = [flint.arb(0)] * (1 + len(still.others)) + [flint.arb(1)]
            return Slice((low, high), at, *_collected(terms, [F, *tyre.others, over], self.lift, changes), tyre, tyre, still)

    def _terms(self, low: Q, high: Q) -> list[Term]:
        """Terms of D; at one load alone where they hang on it."""
        key = None if self._structure.powers.load is not None or self._varying is not None else low
        if key not in self._kept:
            if key is not None and low != high:
                raise CertificateError("the structure of this gear is no polynomial in the load")
            self._kept[key] = list(_with_balls(self._expanded([low, high] if key is None else [low])))
        return self._kept[key]

    def _expanded(self, loads: list[Q]) -> flint.fmpq_mpoly:
        """D over the rationals."""
        structure = self._structure
        parts = self._parts(loads)
        ring = flint.fmpq_mpoly_ctx.get(self._names, "lex")
        s, V, F, f, m, side, swivel, turn, softness, reach, g, *entries = ring.gens()
        zero, n, w = ring.constant(0), len(structure.states), structure.wheels
        size = n + 2 * w
        own = dict(zip(self._entries, entries, strict=True))
        lift = [
            max(
                0,
                *(-i for (i, _, _), part in parts.items() if any(part[r, c] != 0 for c in range(size))),
                *(-i for i, row, _ in own if row == r),
            )
            for r in range(n)
        ]
        self.lift = sum(lift)

        def entry(r: int, c: int, raised: int) -> Any:
            """Of the system, times a power of V."""
            terms = [(key, part[r, c]) for key, part in parts.items() if part[r, c] != 0]
            found = sum((V ** (i + raised) * F**j * g**k * value for (i, j, k), value in terms), zero)
            return found + sum((V ** (i + raised) * value for (i, *place), value in own.items() if place == [r, c]), zero)

        rows = [
            [(V ** lift[r] * s if r == c else zero) - entry(r, c, lift[r]) for c in range(n)] + [zero] * w for r in range(n)
        ]
        below = [part[r, c] != 0 for key, part in parts.items() if key != (0, 0, 0) for r in range(n, size) for c in range(n)]
        if any(below) or any(i != 0 and r >= n for i, r, _ in own):
            raise CertificateError("position or swivel of a wheel hangs on the speed in the linear model")
        for k in range(w):
            eta, theta = ([entry(n + 2 * k + q, c, 0) for c in range(n)] for q in (0, 1))
            for r in range(n):
                B_F, B_M = (entry(r, n + 2 * k + q, lift[r]) for q in (0, 1))
                for c in range(n):
                    if eta[c] != 0 or theta[c] != 0:
                        rows[r][c] += B_F * (side * eta[c] + swivel * theta[c]) - B_M * (turn * theta[c])
                rows[r][n + k] = m * B_M - f * B_F
            path = [zero - V * (softness * eta[c] + reach * theta[c]) for c in range(n)]
            rows.append([*path, *((s + V * softness if k == q else zero) for q in range(w))])
        return _determinant(rows, ring)

    def _parts(self, loads: list[Q]) -> dict[tuple[int, int, int], flint.fmpq_mat]:
        """Matrices of V^i F^j g^k of the system."""
        structure, study = self._structure, self._study
        exact = {name: rational(self._design[name]) for name in structure.design_names}
        speeds = self._speeds

        def system(V: Q, F: Q, factor: Q = ONE) -> flint.fmpq_mat:
            values = list(study.damper.with_damping(exact, factor).values())
            return flint.fmpq_mat(evaluate(structure.system, [values, [V], [F], self._data]))

        if self._varying is not None:
            return self._still(system, loads)
        whole = parts_in_powers(system, structure.powers, speeds, loads)
        if self._interval is None:
            return {(i, j, 0): part for (i, j), part in whole.items()}
        found: dict[tuple[int, int, int], flint.fmpq_mat] = {}
        self.linear, at_load = over_damping(
            lambda V, factor: system(V, loads[0], factor), structure.powers.speed, speeds, self._interval
        )
        # what the damping is in is the same at every load: the change with it is taken off at its own value, and shown again
        for (i, k), part in at_load.items():
            found[i, 0, k] = part if k else part - part
        for (i, j), part in whole.items():
            found[i, j, 0] = part - found[i, 0, 1] if j == 0 else part
        V, F, factor = speeds[1], loads[-1], decimal(self._interval.factors[0])
        value = self.linear.linear_in(factor)
        rebuilt = sum((part * (V**i * F**j * value**k) for (i, j, k), part in found.items()), whole[0, 0] - whole[0, 0])
        if rebuilt != system(V, F, factor):
            raise CertificateError(
                "damping and load act together in this structure: no certificate over an interval of dampings"
            )
        return found

    def _still(self, system: Any, loads: Sequence[Q]) -> dict[tuple[int, int, int], flint.fmpq_mat]:
        """The same of the entries that do not hang on the load; that all keep their powers of V is shown at both its ends."""
        assert self._varying is not None
        speed = Powers(self._structure.powers.speed, None)
        whole, *_ = (parts_in_powers(system, speed, self._speeds, [load]) for load in loads)
        for r, c in self._varying.places:
            for part in whole.values():
                part[r, c] = Q(0)
        return {(i, 0, 0): part for (i, _), part in whole.items()}


@dataclass(frozen=True)
class OverDamping:
    """D at one load, its second variable what uncertain damping is linear in."""

    whole: Quasipolynomial
    load: Q
    linear: Linear

    @property
    def degree(self) -> int:
        """n"""
        return self.whole.degree

    def slice(self, low: Q, high: Q) -> Slice:
        """D between two values of the second variable."""
        return self.whole.slice_of_damping(self.load, low, high)


def _determinant(rows: list[list[Any]], ring: Any) -> Any:
    """By expansion along the rows, each minor of the first rows once."""
    minors = {0: ring.constant(1)}
    for row in rows:
        larger: dict[int, Any] = {}
        for columns, minor in minors.items():
            for c, entry in enumerate(row):
                if entry != 0 and not columns >> c & 1:
                    after = bin(columns >> (c + 1)).count("1")
                    term = minor * entry if after % 2 == 0 else -(minor * entry)
                    key = columns | 1 << c
                    larger[key] = larger[key] + term if key in larger else term
        minors = larger
    return minors[(1 << len(rows)) - 1]


def _with_balls(polynomial: flint.fmpq_mpoly) -> Iterator[Term]:
    """Terms of D, their coefficients as balls."""
    with flint.ctx.workprec(BITS):
        for exponents, coefficient in polynomial.terms():
            i, j, in_F, k, l, *others = map(int, exponents)
            inner = [(which, power) for which, power in enumerate((in_F, *others)) if power]
            yield Term(i, (k, l, j), inner, flint.arb(coefficient))


def _collected(
    terms: Sequence[Term], values: Sequence[flint.arb], lift: int, changes: Sequence[flint.arb] | None = None
) -> tuple[Rows, Rows]:
    """By powers of f, m and V polynomials in lambda, with all else put in; and their derivatives, where it changes.

    Parameters
    ----------
    terms : sequence of Term
    values : sequence of arb
        Of load, tyre, damping and entries.
    lift : int
        Power of V that D was multiplied by.
    changes : sequence of arb or None
        Derivatives of the values; None: of none.
    """
    found: tuple[Kept, Kept] = {}, {}
    powers: dict[tuple[int, int], tuple[flint.arb, flint.arb]] = {}
    zero = flint.arb(0)
    for term in terms:
        value, change = term.coefficient, zero
        for which, exponent in term.inner:
            if (which, exponent) not in powers:
                below = values[which] ** (exponent - 1)
                by = zero if changes is None else exponent * below * changes[which]
                powers[which, exponent] = below * values[which], by
            power, by_power = powers[which, exponent]
            if changes is not None:
                change = change * power + value * by_power
            value = value * power
        k, l, j = term.powers
        for rows, part in zip(found, (value, change) if changes is not None else (value,), strict=False):
            row = rows.setdefault((k, l, j - lift), {})
            row[term.of_s] = row[term.of_s] + part if term.of_s in row else part
    first, second = (
        {key: flint.acb_poly([row.get(i, zero) for i in range(max(row) + 1)]) for key, row in rows.items()} for rows in found
    )
    return first, second

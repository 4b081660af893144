"""Balls: enclosures of the functions of a contact line with a delay, and of the graphs that give a tyre's data over a load.

Every value returned encloses all values that the function takes on the arguments. Arithmetic of balls: Arb, in python-flint.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import factorial

import casadi as ca
import flint

from ..errors import CertificateError
from ..expressions.graph import walk

__all__ = ["Transit", "ball", "enclosed", "transit_of"]

SMALL = 0.3
"""Least magnitude of z at which closed forms are used; a ball that reaches below takes the series."""

TERMS = 16
"""Of the series, before its remainder."""


def ball(low: flint.arb, high: flint.arb) -> flint.arb:
    """The least ball over two balls or numbers."""
    return flint.arb(low).union(flint.arb(high))


class Transit:
    """E, phi1, chi (`delayed`, `mean`, `chi`) and their derivatives over z on a ball of z; see `transit_of`."""

    __slots__ = ("chi", "chi_z", "delayed", "delayed_z", "mean", "mean_z")

    def __init__(self, delayed: flint.acb, mean: flint.acb, chi: flint.acb, mean_z: flint.acb, chi_z: flint.acb):
        self.delayed, self.mean, self.chi = delayed, mean, chi
        self.delayed_z, self.mean_z, self.chi_z = -delayed, mean_z, chi_z


def transit_of(z: flint.acb) -> Transit:
    """E = e^-z, phi1 = (1 - E)/z, chi = (1 + E)/z - 2 (1 - E)/z^2 and their derivatives on a ball.

    Parameters
    ----------
    z : acb

    Returns
    -------
    Transit
    """
    E = (-z).exp()
    if z.abs_lower() > SMALL:
        inverse = 1 / z
        mean = (1 - E) * inverse
        chi = (1 + E - 2 * mean) * inverse
        return Transit(E, mean, chi, (E - mean) * inverse, (mean - E - 2 * chi) * inverse)
    size = flint.arb(z.abs_upper())
    rest = size.exp() * size**TERMS / factorial(TERMS)
    error = flint.acb(flint.arb(0, rest.upper()), flint.arb(0, rest.upper()))
    # phi1 = sum (-z)^k/(k + 1)!, chi = -sum k (-z)^k/(k! (k + 1) (k + 2)); a term is below z^k/k! in each, and in derivatives
    mean, chi, mean_z, chi_z = (_SERIES[name](z) + error for name in ("mean", "chi", "mean_z", "chi_z"))
    return Transit(E, mean, chi, mean_z, chi_z)


def _series() -> dict[str, flint.acb_poly]:
    Q = flint.fmpq
    mean = [Q((-1) ** k, factorial(k + 1)) for k in range(TERMS + 1)]
    chi = [Q(-((-1) ** k) * k, factorial(k) * (k + 1) * (k + 2)) for k in range(TERMS + 1)]
    with flint.ctx.workprec(128):
        found = {}
        for name, row in (("mean", mean), ("chi", chi)):
            found[name] = flint.acb_poly([flint.arb(c) for c in row[:TERMS]])
            found[f"{name}_z"] = flint.acb_poly([flint.arb(c * k) for k, c in enumerate(row) if k])
        return found


_SERIES = _series()


_OPERATIONS: dict[int, Callable[..., flint.arb]] = {
    ca.OP_ASSIGN: lambda a: a,
    ca.OP_ADD: lambda a, b: a + b,
    ca.OP_SUB: lambda a, b: a - b,
    ca.OP_MUL: lambda a, b: a * b,
    ca.OP_DIV: lambda a, b: a / b,
    ca.OP_NEG: lambda a: -a,
    ca.OP_INV: lambda a: 1 / a,
    ca.OP_SQ: lambda a: a * a,
    ca.OP_TWICE: lambda a: a + a,
    ca.OP_FABS: abs,
    ca.OP_POW: lambda a, b: a**b,
    ca.OP_CONSTPOW: lambda a, b: a**b,
    ca.OP_SIN: flint.arb.sin,
    ca.OP_COS: flint.arb.cos,
    ca.OP_TAN: flint.arb.tan,
    ca.OP_ATAN: flint.arb.atan,
    ca.OP_SQRT: flint.arb.sqrt,
    ca.OP_EXP: flint.arb.exp,
    ca.OP_ASINH: flint.arb.asinh,
    ca.OP_LOG: flint.arb.log,
}


class _Balls:
    """Visitor of a graph: balls."""

    def __init__(self, arguments: Sequence[Sequence[flint.arb]]):
        self._arguments = arguments

    def constant(self, value: float) -> flint.arb:
        return flint.arb(value)

    def input(self, argument: int, position: int) -> flint.arb:
        return self._arguments[argument][position]

    def operation(self, code: int, operands: Sequence[flint.arb]) -> flint.arb:
        if code in _COMPARISONS:
            return _COMPARISONS[code](*operands)
        if code not in _OPERATIONS:
            raise CertificateError(f"operation {code} of the tyre's data has no enclosure")
        return _OPERATIONS[code](*operands)


EITHER = ball(flint.arb(0), flint.arb(1))


def _truth(yes: bool, no: bool) -> flint.arb:
    return flint.arb(1) if yes else flint.arb(0) if no else EITHER


_COMPARISONS: dict[int, Callable[..., flint.arb]] = {
    ca.OP_LT: lambda a, b: _truth(a < b, a >= b),
    ca.OP_LE: lambda a, b: _truth(a <= b, a > b),
    ca.OP_NOT: lambda a: 1 - a,
    ca.OP_IF_ELSE_ZERO: lambda a, b: a * b,
    ca.OP_SIGN: lambda a: flint.arb(1) if a > 0 else flint.arb(-1) if a < 0 else 2 * EITHER - 1,
    ca.OP_FMAX: lambda a, b: a.max(b),
    ca.OP_FMIN: lambda a, b: a.min(b),
}


def enclosed(function: ca.Function, arguments: Sequence[Sequence[flint.arb]]) -> list[flint.arb]:
    """Balls over the values of an SX function with one dense output, column by column.

    Parameters
    ----------
    function : casadi.Function
    arguments : sequence of sequences of arb
        One sequence per input.

    Returns
    -------
    list of arb
    """
    return walk(function, _Balls(arguments))

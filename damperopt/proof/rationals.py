"""Exact evaluation of a CasADi graph in rational numbers.

The graph is the one that automatic differentiation made; it is walked instruction by instruction with `flint.fmpq`, so
that the state matrix that is certified is the state matrix that is simulated, without a rounding error.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction

import casadi as ca
import flint

from ..errors import CertificateError
from ..expressions.graph import walk

__all__ = ["decimal", "evaluate", "rational"]

IRRATIONAL_BITS = 80
"""A function with an irrational value (cosine of the rake, square root of a length) is taken at this precision: the
matrix certified differs from the ideal one by parts in 1e24, that of floating point by parts in 1e16."""


def rational(value: float) -> flint.fmpq:
    """The exact value of a float: that of a design variable, which a computer has found.

    Examples
    --------
    >>> rational(0.1)
    3602879701896397/36028797018963968
    """
    return flint.fmpq(*value.as_integer_ratio())


def decimal(value: float) -> flint.fmpq:
    """The shortest decimal that returns a float: that of a number of a study, which somebody has written.

    In decimals 0.4 - 0.1 - 0.3 is zero, in floats it is not; whether a gear is marginal can hang on it.

    Examples
    --------
    >>> decimal(0.1)
    1/10
    """
    return flint.fmpq(*Fraction(repr(float(value))).as_integer_ratio())


def _irrational(function: Callable[[flint.arb], flint.arb]) -> Callable[[flint.fmpq], flint.fmpq]:
    def value(argument: flint.fmpq) -> flint.fmpq:
        with flint.ctx.workprec(IRRATIONAL_BITS + 32):
            ball = function(flint.arb(argument))
            mantissa, exponent = ball.mid().man_exp()
        return flint.fmpq(int(mantissa)) * flint.fmpq(2) ** int(exponent)

    return value


def _exact_at_zero(function: Callable[[flint.arb], flint.arb], at_zero: int) -> Callable[[flint.fmpq], flint.fmpq]:
    general = _irrational(function)
    return lambda argument: flint.fmpq(at_zero) if argument == 0 else general(argument)


def _truth(condition: bool) -> flint.fmpq:
    return flint.fmpq(int(condition))


_OPERATIONS: dict[int, Callable[..., flint.fmpq]] = {
    ca.OP_ASSIGN: lambda a: a,
    ca.OP_ADD: lambda a, b: a + b,
    ca.OP_SUB: lambda a, b: a - b,
    ca.OP_MUL: lambda a, b: a * b,
    ca.OP_DIV: lambda a, b: a / b,
    ca.OP_NEG: lambda a: -a,
    ca.OP_INV: lambda a: 1 / a,
    ca.OP_SQ: lambda a: a * a,
    ca.OP_TWICE: lambda a: a + a,
    ca.OP_FABS: lambda a: max(a, -a),
    ca.OP_SIGN: lambda a: flint.fmpq((a > 0) - (a < 0)),
    ca.OP_LT: lambda a, b: _truth(a < b),
    ca.OP_LE: lambda a, b: _truth(a <= b),
    ca.OP_EQ: lambda a, b: _truth(a == b),
    ca.OP_NE: lambda a, b: _truth(a != b),
    ca.OP_NOT: lambda a: _truth(a == 0),
    ca.OP_AND: lambda a, b: _truth(a != 0 and b != 0),
    ca.OP_OR: lambda a, b: _truth(a != 0 or b != 0),
    ca.OP_IF_ELSE_ZERO: lambda a, b: b if a != 0 else flint.fmpq(0),
    ca.OP_SIN: _exact_at_zero(flint.arb.sin, 0),
    ca.OP_COS: _exact_at_zero(flint.arb.cos, 1),
    ca.OP_TAN: _exact_at_zero(flint.arb.tan, 0),
    ca.OP_ATAN: _exact_at_zero(flint.arb.atan, 0),
    ca.OP_SQRT: _exact_at_zero(flint.arb.sqrt, 0),
    ca.OP_ASINH: _exact_at_zero(flint.arb.asinh, 0),
    ca.OP_EXP: _exact_at_zero(flint.arb.exp, 1),
    ca.OP_LOG: _irrational(flint.arb.log),
}


class _Exact:
    """Visitor of a graph: rational numbers."""

    def __init__(self, arguments: Sequence[Sequence[flint.fmpq]]):
        self._arguments = arguments

    def constant(self, value: float) -> flint.fmpq:
        try:
            return rational(value)
        except (ArithmeticError, ValueError) as error:  # infinity, NaN
            raise CertificateError(f"the state matrix has no real value at these data: {error}") from error

    def input(self, argument: int, position: int) -> flint.fmpq:
        return self._arguments[argument][position]

    def operation(self, code: int, operands: Sequence[flint.fmpq]) -> flint.fmpq:
        if code not in _OPERATIONS:
            raise CertificateError(f"operation {code} of the state matrix has no exact form")
        try:
            return _OPERATIONS[code](*operands)
        except ZeroDivisionError as error:
            raise CertificateError("the state matrix divides by zero at these data") from error
        except (ArithmeticError, ValueError) as error:  # root of a negative number
            raise CertificateError(f"the state matrix has no real value at these data: {error}") from error


def evaluate(function: ca.Function, arguments: Sequence[Sequence[flint.fmpq]]) -> list[list[flint.fmpq]]:
    """Values of an SX function with one matrix output.

    Parameters
    ----------
    function : casadi.Function
        SX function; its output must be dense.
    arguments : sequence of sequences of fmpq
        One sequence per input.

    Returns
    -------
    list of lists of fmpq
        Rows of the output matrix.

    Raises
    ------
    CertificateError
        If the graph holds an operation that has no exact form here, or divides by zero.
    """
    rows, columns = function.size_out(0)
    values = walk(function, _Exact(arguments))
    return [[values[column * rows + row] for column in range(columns)] for row in range(rows)]

"""Exact evaluation of a CasADi graph in rational numbers.

The graph is the one that automatic differentiation made; it is walked instruction by instruction with `flint.fmpq`, so
that the state matrix that is certified is the state matrix that is simulated, without a rounding error.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import casadi as ca
import flint

from ..errors import CertificateError

__all__ = ["evaluate", "rational"]

IRRATIONAL_BITS = 80
"""A function with an irrational value (cosine of the rake, square root of a length) is taken at this precision: the
matrix certified differs from the ideal one by parts in 1e24, that of floating point by parts in 1e16."""


def rational(value: float) -> flint.fmpq:
    """The exact value of a float."""
    return flint.fmpq(*value.as_integer_ratio())


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
}


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
    output = [[flint.fmpq(0)] * columns for _ in range(rows)]
    work: dict[int, flint.fmpq] = {}
    for k in range(function.n_instructions()):
        operation = function.instruction_id(k)
        into, out_of = function.instruction_output(k), function.instruction_input(k)
        try:
            if operation == ca.OP_CONST:
                work[into[0]] = rational(function.instruction_constant(k))
            elif operation == ca.OP_INPUT:
                work[into[0]] = arguments[out_of[0]][out_of[1]]
            elif operation == ca.OP_OUTPUT:
                column, row = divmod(into[1], rows)
                output[row][column] = work[out_of[0]]
            elif operation in _OPERATIONS:
                work[into[0]] = _OPERATIONS[operation](*(work[i] for i in out_of))
            else:
                raise CertificateError(f"operation {operation} of the state matrix has no exact form")
        except ZeroDivisionError as error:
            raise CertificateError("the state matrix divides by zero at these data") from error
        except (ArithmeticError, ValueError) as error:  # root of a negative number, infinity, NaN
            raise CertificateError(f"the state matrix has no real value at these data: {error}") from error
    return output

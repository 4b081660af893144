"""The walk over the instructions of a CasADi function, written once; what is done at each is the visitor's.

A visitor gives a value to a constant, to an input and to an operation on earlier values: rational numbers in `proof.rationals`,
the names of lines of compiled code in `charts.maps`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, TypeVar

import casadi as ca

__all__ = ["Visitor", "walk"]

Value = TypeVar("Value")


class Visitor(Protocol[Value]):
    """What becomes of the instructions of a graph."""

    def constant(self, value: float) -> Value:
        """Value of a constant."""
        ...

    def input(self, argument: int, position: int) -> Value:
        """Value of the nonzero `position` of an argument of the function."""
        ...

    def operation(self, code: int, operands: Sequence[Value]) -> Value:
        """Value of an operation, one of CasADi's ``OP_`` codes."""
        ...


def walk(function: ca.Function, visitor: Visitor[Value]) -> list[Value]:
    """Nonzeros of the first output of an SX function, by a visitor.

    Parameters
    ----------
    function : casadi.Function
        SX function.
    visitor : Visitor

    Returns
    -------
    list
        In the order of CasADi: column by column.

    Examples
    --------
    >>> class Words:
    ...     def constant(self, value):
    ...         return f"{value:g}"
    ...
    ...     def input(self, argument, position):
    ...         return "xy"[argument]
    ...
    ...     def operation(self, code, operands):
    ...         return f"({' ? '.join(operands)})"
    >>> x, y = ca.SX.sym("x"), ca.SX.sym("y")
    >>> walk(ca.Function("f", [x, y], [ca.vertcat(x + y, 3 * x)]), Words())
    ['(x ? y)', '(3 ? x)']
    """
    outputs: dict[int, Value] = {}
    work: dict[int, Value] = {}
    for k in range(function.n_instructions()):
        code = function.instruction_id(k)
        into, out_of = function.instruction_output(k), function.instruction_input(k)
        if code == ca.OP_OUTPUT:
            outputs[into[1]] = work[out_of[0]]
        elif code == ca.OP_CONST:
            work[into[0]] = visitor.constant(function.instruction_constant(k))
        elif code == ca.OP_INPUT:
            work[into[0]] = visitor.input(out_of[0], out_of[1])
        else:
            work[into[0]] = visitor.operation(code, [work[i] for i in out_of])
    return [outputs[position] for position in range(function.nnz_out(0))]

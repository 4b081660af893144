"""Functions of the equations for floats, arrays, balls and symbols alike, and slopes of lengths.

The components of a gear are written with these, so that they load without CasADi and one equation serves a number, an
array, an interval and a graph. This module alone asks for CasADi, and only when a symbol is made or met.
"""

from __future__ import annotations

import cmath
import math
import sys
from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Any, TypeAlias

import numpy as np

__all__ = [
    "Expr",
    "absolute",
    "arsinh",
    "atan",
    "cos",
    "exp",
    "implicit_slopes",
    "is_symbol",
    "log",
    "partial",
    "piecewise",
    "sin",
    "slope",
    "sqrt",
    "symbol",
    "tan",
    "value_at",
    "where",
]

Expr: TypeAlias = Any
"""A float, a complex number, an array, a ball or a symbol."""


_OF_ARRAYS = {"atan": "arctan", "asinh": "arcsinh"}


def _applied(name: str, x: Expr) -> Expr:
    if isinstance(x, (int, float)):
        return getattr(math, name)(x)
    if isinstance(x, complex):
        return getattr(cmath, name)(x)
    if isinstance(x, (np.ndarray, np.generic)):
        return getattr(np, _OF_ARRAYS.get(name, name))(x)
    method = getattr(x, name, None) or getattr(x, _OF_ARRAYS[name])
    return method()


def sin(x: Expr) -> Expr:
    """Sine of an angle [rad]."""
    return _applied("sin", x)


def cos(x: Expr) -> Expr:
    """Cosine of an angle [rad]."""
    return _applied("cos", x)


def tan(x: Expr) -> Expr:
    """Tangent of an angle [rad]."""
    return _applied("tan", x)


def atan(x: Expr) -> Expr:
    """Angle of a tangent [rad]."""
    return _applied("atan", x)


def sqrt(x: Expr) -> Expr:
    """Square root."""
    return _applied("sqrt", x)


def exp(x: Expr) -> Expr:
    """Exponential."""
    return _applied("exp", x)


def log(x: Expr) -> Expr:
    """Natural logarithm."""
    return _applied("log", x)


def arsinh(x: Expr) -> Expr:
    """ln(x + sqrt(x^2 + 1))"""
    return _applied("asinh", x)


def absolute(x: Expr) -> Expr:
    """Magnitude."""
    return x.fabs() if is_symbol(x) else abs(x)


def where(condition: Expr, yes: Expr, no: Expr) -> Expr:
    """`yes` where the condition holds, else `no`."""
    if any(map(is_symbol, (condition, yes, no))):
        return import_module("casadi").if_else(condition, yes, no)
    if isinstance(condition, np.ndarray):
        return np.where(condition, yes, no)
    return yes if condition else no


def piecewise(x: Expr, limits: Sequence[float], pieces: Sequence[Callable[[Expr], Expr]]) -> Expr:
    """A continuous function that is written piece by piece.

    It is summed up along x, each piece over its own part: without a choice, so that balls over a limit stay tight.

    Parameters
    ----------
    x : Expr
    limits : sequence of float
        (n,) ascending; from each on the next piece holds, and there both must have one value.
    pieces : sequence of callable
        (n + 1,) of x.

    Examples
    --------
    >>> [piecewise(x, [1.0, 2.0], [lambda x: 0.0, lambda x: x - 1, lambda x: 1.0]) for x in (0.5, 1.25, 3.0)]
    [0.0, 0.25, 1.0]
    """
    value = pieces[0](_smaller(x, limits[0]) if limits else x)
    for k, piece in enumerate(pieces[1:], 1):
        inside = -_smaller(-x, -limits[k - 1])
        if k < len(limits):
            inside = _smaller(inside, limits[k])
        value = value + (piece(inside) - piece(limits[k - 1]))
    return value


def _smaller(x: Expr, limit: float) -> Expr:
    """The smaller of two; as a graph so that balls that hold the limit enclose it and its slope, which lies in [0, 1]."""
    if is_symbol(x):
        return limit + where(x < limit, x - limit, 0.0)
    if isinstance(x, (np.ndarray, np.generic)):
        return np.minimum(x, limit)
    return min(x, limit) if isinstance(x, (int, float)) else x.min(type(x)(limit))


def is_symbol(x: Expr) -> bool:
    """Whether `x` is an expression of CasADi; false for sure while CasADi is not loaded."""
    casadi = sys.modules.get("casadi")
    return casadi is not None and isinstance(x, casadi.SX)


def symbol(name: str) -> Expr:
    """A new scalar symbol."""
    return import_module("casadi").SX.sym(name)


def value_at(expression: Expr, of: Expr, at: Expr) -> Expr:
    """`expression` with the symbol `of` replaced by `at`: a float where nothing else is symbolic."""
    if not is_symbol(expression):
        return expression
    found = import_module("casadi").substitute(expression, of, at)
    return float(found) if found.is_constant() and not is_symbol(at) else found


def partial(expression: Expr, of: Expr) -> Expr:
    """Derivative of an expression with respect to a symbol in it."""
    return import_module("casadi").jacobian(expression, of) if is_symbol(expression) else 0.0


def slope(length: Callable[[Expr], Expr], at: Expr) -> Expr:
    """Slope of a function of one variable, as a lever is of a length.

    Parameters
    ----------
    length : callable
        Of one variable.
    at : Expr
        Where: a float or a symbol.

    Returns
    -------
    Expr

    Examples
    --------
    >>> round(slope(lambda x: sin(x) ** 2, 0.5), 12) == round(math.sin(1.0), 12)
    True
    """
    x = symbol("x")
    return value_at(partial(length(x), x), x, at)


def implicit_slopes(closure: Sequence[Expr], unknowns: Sequence[Expr], angle: Expr) -> list[Expr]:
    """d unknown/d angle of a closed loop, by the implicit function theorem.

    Parameters
    ----------
    closure : sequence of Expr
        (m,) residuals that vanish where the loop is closed, in the symbols `unknowns` and `angle`.
    unknowns : sequence of Expr
        (m,) symbols.
    angle : Expr
        Symbol.

    Returns
    -------
    list of Expr
        (m,)
    """
    casadi = import_module("casadi")
    residual, z = casadi.vertcat(*closure), casadi.vertcat(*unknowns)
    rates = -casadi.inv_minor(casadi.jacobian(residual, z)) @ casadi.jacobian(residual, angle)
    return [rates[i] for i in range(len(unknowns))]

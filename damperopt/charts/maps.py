"""Filled maps of a plane: the side of the margin, or the spectral abscissa itself, at millions of points.

The conditions of stability are built as CasADi expressions of the two quantities alone, all else folded into constants, and
their graph is written out as a loop that numba compiles: what depends on the row only is computed once a row.

*Sign*: the Lienard-Chipart conditions of the polynomial shifted by the margin.

*Abscissa*: Newton's method on the polynomial from the rightmost root of the neighbouring pixel; then Lienard-Chipart for the
polynomial shifted by that abscissa and a little more checks that no root lies to the right. Where one does, or Newton's method
does not converge, all roots are found by Weierstrass' iteration. Every value is so checked, or made from all roots.

With a tyre that has a delay there is no polynomial: fewer pixels, each with its exact eigenvalues.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import casadi as ca
import numpy as np

from ..expressions.graph import walk
from ..stability.hurwitz import characteristic_polynomial, lienard_chipart, shifted
from .plane import Plane

__all__ = ["FilledMap", "StabilityMap", "filled_map"]

_BINARY = {ca.OP_ADD: "{} + {}", ca.OP_SUB: "{} - {}", ca.OP_MUL: "{} * {}", ca.OP_DIV: "{} / {}"}
_BINARY |= {
    ca.OP_POW: "{} ** {}",
    ca.OP_CONSTPOW: "{} ** {}",
    ca.OP_ATAN2: "math.atan2({}, {})",
    ca.OP_HYPOT: "math.hypot({}, {})",
}
_BINARY |= {
    ca.OP_FMAX: "max({}, {})",
    ca.OP_FMIN: "min({}, {})",
    ca.OP_LT: "(1.0 if {} < {} else 0.0)",
    ca.OP_LE: "(1.0 if {} <= {} else 0.0)",
}
_BINARY |= {
    ca.OP_EQ: "(1.0 if {} == {} else 0.0)",
    ca.OP_NE: "(1.0 if {} != {} else 0.0)",
    ca.OP_AND: "{} * {}",
    ca.OP_IF_ELSE_ZERO: "({1} if {0} != 0 else 0.0)",
}
_UNARY = {ca.OP_NEG: "-{}", ca.OP_SQ: "{0} * {0}", ca.OP_TWICE: "2.0 * {}", ca.OP_INV: "1.0 / {}", ca.OP_NOT: "1.0 - {}"}
_UNARY |= {ca.OP_ASSIGN: "{}", ca.OP_FABS: "abs({})", ca.OP_SIGN: "float(({0} > 0) - ({0} < 0))"}
_UNARY |= {
    getattr(ca, f"OP_{name.upper()}"): f"math.{name}({{}})"
    for name in ("sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "asinh", "exp", "log")
}

TINY = 1e-300

DELAY_PIXELS = 160
"""Along each axis where eigenvalues are those of a gear with a delay."""

CLOSE = 1e-8
"""Relative to the root: how far to the right of a value no root is certain to lie."""

_ROUTINES = '''
def newton(a, s):
    """Root of the monic polynomial near s, and whether it has converged."""
    for _ in range(12):
        p, d = 1.0 + 0.0j, 0.0j
        for k in range(1, a.size):
            d = d * s + p
            p = p * s + a[k]
        if d == 0:
            return s, False
        step = p / d
        s -= step
        if abs(step) <= 1e-10 * abs(s) + 1e-14:
            return s, True
    return s, False

def all_roots(a, roots, known):
    """All roots by Weierstrass' simultaneous iteration, from those of a neighbour or from a circle."""
    n = a.size - 1
    for attempt in range(2):
        if attempt == 1 or not known:
            radius = 0.0
            for k in range(1, n + 1):
                radius = max(radius, abs(a[k]) ** (1.0 / k))
            for k in range(n):
                roots[k] = radius * np.exp(1j * (2 * np.pi * k / n + 0.4))
        for _ in range(500 if attempt == 1 or not known else 25):
            largest = 0.0
            for k in range(n):
                p, d = 1.0 + 0.0j, 1.0 + 0.0j
                for m in range(1, n + 1):
                    p = p * roots[k] + a[m]
                for m in range(n):
                    if m != k:
                        d *= roots[k] - roots[m]
                step = p / d
                roots[k] -= step
                largest = max(largest, abs(step) / (abs(roots[k]) + 1e-300))
            if largest < 1e-12:
                return
    roots[:] = np.nan + 0j  # equal roots: left to eigenvalues

def rightmost(a, roots):
    all_roots(a, roots, False)
    best = roots[0]
    for k in range(a.size - 1):
        if roots[k].real > best.real:
            best = roots[k]
    return complex(best.real, abs(best.imag))

def least_damping(a, roots, known):
    all_roots(a, roots, known)
    least = np.inf
    for k in range(a.size - 1):
        least = min(least, -roots[k].real / (abs(roots[k]) + 1e-300))
    return least
'''


@dataclass(frozen=True)
class FilledMap:
    """Values (k, m) of a quantity, ``abscissa`` [1/s] or ``damping``, at x (m,) and y (k,) [SI]."""

    quantity: Literal["abscissa", "damping"]
    x: np.ndarray
    y: np.ndarray
    values: np.ndarray


def filled_map(plane: Plane, quantity: Literal["abscissa", "damping"] = "abscissa", pixels: int = 600) -> FilledMap:
    """Spectral abscissa or least damping ratio all over a plane.

    Parameters
    ----------
    plane : Plane
    quantity : {'abscissa', 'damping'}
    pixels : int
        Along each axis.

    Returns
    -------
    FilledMap
    """
    if plane.delayed:
        return _of_delay(plane, quantity, min(pixels, DELAY_PIXELS))
    x, y = (axis.at((np.arange(pixels) + 0.5) / pixels) for axis in (plane.x, plane.y))
    kernels = StabilityMap(plane)
    values = kernels.abscissa(x, y) if quantity == "abscissa" else kernels.damping_ratio(x, y)
    return FilledMap(quantity, x, y, values)


def _of_delay(plane: Plane, quantity: Literal["abscissa", "damping"], pixels: int) -> FilledMap:
    """From exact eigenvalues of a gear whose tyre has a delay, at every pixel."""
    fractions = (np.arange(pixels) + 0.5) / pixels
    u, v = np.meshgrid(fractions, fractions)
    if quantity == "abscissa":
        values = plane.excess(u, v) - plane.margin
    else:
        roots = plane.roots(u.ravel(), v.ravel())
        values = (-roots.real / np.maximum(np.abs(roots), TINY)).min(axis=1).reshape(u.shape)
    return FilledMap(quantity, plane.x.at(fractions), plane.y.at(fractions), values)


class StabilityMap:
    """Compiled evaluator over a plane.

    Parameters
    ----------
    plane : Plane
        Two quantities, design, operating point and margin.
    """

    def __init__(self, plane: Plane):
        self.plane = plane
        x, y, sigma = ca.SX.sym("x"), ca.SX.sym("y"), ca.SX.sym("sigma")
        polynomial = [ca.SX(1), *characteristic_polynomial(plane.symbolic_matrix(x, y))[1:]]
        a = [ca.SX(1), *ca.vertsplit(ca.SX.sym("a", len(polynomial) - 1))]
        with_margin = lienard_chipart(shifted(polynomial, plane.margin)) if plane.margin else lienard_chipart(polynomial)
        conditions = ca.Function("conditions", [x, y], [ca.cse(ca.vertcat(*with_margin.values()))])
        coefficients = ca.Function("coefficients", [x, y], [ca.cse(ca.vertcat(*polynomial[1:]))])
        to_the_right = ca.vertcat(*lienard_chipart(shifted(a, -sigma)).values())
        certificate = ca.Function("certificate", [ca.vertcat(*a[1:]), sigma], [ca.cse(to_the_right)])
        self._sign = _compiled(_sign_source(conditions), "side")
        self._abscissa = _compiled(_ROUTINES + _abscissa_source(coefficients, certificate), "abscissae")
        self._damping = _compiled(_ROUTINES + _damping_source(coefficients), "dampings")

    def kept(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Whether the margin is kept, by Lienard and Chipart.

        Parameters
        ----------
        x, y : ndarray
            (m,), (k,) values of the two quantities [SI].

        Returns
        -------
        ndarray
            (k, m) bool
        """
        return _filled(self._sign, x, y, np.bool_)

    def abscissa(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Spectral abscissa [1/s].

        Parameters
        ----------
        x, y : ndarray
            (m,), (k,) values of the two quantities [SI].

        Returns
        -------
        ndarray
            (k, m); no root lies to the right of a value by more than 1e-8 of the root.
        """
        return self._completed(_filled(self._abscissa, x, y), x, y, lambda roots: roots.real.max(axis=1))

    def damping_ratio(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Least damping ratio of all modes, -Re(s)/abs(s).

        Parameters
        ----------
        x, y : ndarray
            (m,), (k,) values of the two quantities [SI].

        Returns
        -------
        ndarray
            (k, m), from all roots.
        """
        return self._completed(
            _filled(self._damping, x, y), x, y, lambda roots: (-roots.real / np.maximum(np.abs(roots), TINY)).min(axis=1)
        )

    def _completed(self, out: np.ndarray, x: np.ndarray, y: np.ndarray, measure: Callable[..., np.ndarray]) -> np.ndarray:
        """Pixels whose iteration did not converge, by eigenvalues."""
        rows, columns = np.nonzero(np.isnan(out))
        if rows.size:
            u, v = ((values - a.low) / (a.high - a.low) for values, a in ((x[columns], self.plane.x), (y[rows], self.plane.y)))
            out[rows, columns] = measure(np.linalg.eigvals(self.plane.matrices(u, v)))
        return out


def _filled(kernel: Callable[..., None], x: np.ndarray, y: np.ndarray, kind: type = float) -> np.ndarray:
    """What a kernel gives at every pixel (k, m)."""
    out: np.ndarray = np.empty((len(y), len(x)), kind)
    kernel(np.ascontiguousarray(x, float), np.ascontiguousarray(y, float), out)
    return out


def _compiled(source: str, name: str) -> Callable[..., None]:
    import numba  # takes a second to import, and the kernels a few to compile: for maps only

    scope: dict[str, Any] = {"math": math, "np": np, "prange": numba.prange}
    exec(compile(source, f"<{name}>", "exec"), scope)
    for helper in ("newton", "all_roots", "rightmost", "least_damping", "none_beyond"):
        if helper in scope:
            scope[helper] = numba.njit(scope[helper], error_model="numpy", inline="never")
    return numba.njit(scope[name], parallel=True, error_model="numpy", fastmath={"contract", "arcp"})


class _Source:
    """Visitor of a graph: a line of Python for each operation."""

    def __init__(self, inputs: list[list[str]], prefix: str):
        self._inputs, self._prefix = inputs, prefix
        self.lines: list[str] = []

    def constant(self, value: float) -> str:
        return self._line(repr(float(value)))

    def input(self, argument: int, position: int) -> str:
        return self._line(self._inputs[argument][position])

    def operation(self, code: int, operands: Sequence[str]) -> str:
        return self._line((_BINARY if code in _BINARY else _UNARY)[code].format(*operands))

    def _line(self, expression: str) -> str:
        name = f"{self._prefix}{len(self.lines)}"
        self.lines.append(f"{name} = {expression}")
        return name


def _lines(function: ca.Function, inputs: list[list[str]], prefix: str) -> tuple[list[str], list[str]]:
    """Straight-line Python of a CasADi function: its lines, and the names of its outputs."""
    source = _Source(inputs, prefix)
    outputs = walk(function, source)
    return source.lines, outputs


def _sign_source(conditions: ca.Function) -> str:
    lines, outputs = _lines(conditions, [["x"], ["y"]], "v")
    body = "\n            ".join(lines)
    return f"""
def side(xs, ys, out):
    for j in prange(ys.size):
        y = ys[j]
        for i in range(xs.size):
            x = xs[i]
            {body}
            out[j, i] = {" & ".join(f"({name} > 0.0)" for name in outputs)}
"""


def _coefficient_lines(coefficients: ca.Function) -> str:
    """Body of a loop that fills a[1], ..., a[n] from x and y."""
    lines, values = _lines(coefficients, [["x"], ["y"]], "v")
    return "\n            ".join([*lines, *(f"a[{k + 1}] = {value}" for k, value in enumerate(values))])


def _abscissa_source(coefficients: ca.Function, certificate: ca.Function) -> str:
    n = coefficients.nnz_out(0)
    body = _coefficient_lines(coefficients)
    shift, outputs = _lines(certificate, [[f"a[{k + 1}]" for k in range(n)], ["sigma"]], "w")
    check = "\n    ".join(shift)
    return f"""
def none_beyond(a, sigma):
    {check}
    return {" & ".join(f"({name} > 0.0)" for name in outputs)}

def abscissae(xs, ys, out):
    for j in prange(ys.size):
        y = ys[j]
        a = np.ones({n + 1})
        roots = np.empty({n}, np.complex128)
        s = 0.0j
        known = False
        for i in range(xs.size):
            x = xs[i]
            {body}
            good = False
            if known:
                s, good = newton(a, s)
                good = good and none_beyond(a, s.real + {CLOSE} * abs(s))
            if not good:
                s = rightmost(a, roots)
            known = True
            out[j, i] = s.real
"""


def _damping_source(coefficients: ca.Function) -> str:
    n = coefficients.nnz_out(0)
    body = _coefficient_lines(coefficients)
    return f"""
def dampings(xs, ys, out):
    for j in prange(ys.size):
        y = ys[j]
        a = np.ones({n + 1})
        roots = np.empty({n}, np.complex128)
        for i in range(xs.size):
            x = xs[i]
            {body}
            out[j, i] = least_damping(a, roots, i > 0)
"""

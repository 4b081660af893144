"""Characteristic polynomial and Routh-Hurwitz theory, for numbers, arrays and symbols alike.

A polynomial is the list [a_0, ..., a_n] of a_0 s^n + ... + a_n; its entries may be floats, NumPy arrays or CasADi
expressions, since only +, - and * are used.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import comb
from typing import Any

import numpy as np

__all__ = [
    "characteristic_polynomial",
    "determinant",
    "hurwitz_determinant",
    "hurwitz_determinants",
    "lienard_chipart",
    "shifted",
]


def characteristic_polynomial(A: Any) -> list[Any]:
    """Coefficients of det(s I - A), by expansion along the rows, each minor once and as a polynomial in s.

    Parameters
    ----------
    A : ndarray or SX
        (..., n, n) array, or (n, n) expression.

    Returns
    -------
    list
        [1, a_1, ..., a_n], each an array of shape (...) or an expression.

    Notes
    -----
    A sum of products, so a coefficient is accurate to the size of its own terms; recursions through powers of A lose all
    digits of a_n where the roots lie decades apart, as they do in an overdamped gear. Zeros of the structure are skipped.

    Examples
    --------
    >>> [float(a) for a in characteristic_polynomial(np.array([[0.0, 1.0], [-4.0, -0.6]]))]
    [1.0, 0.6, 4.0]
    """
    rows = _entries(A)
    known: dict[tuple[int, ...], list[Any]] = {(): [1.0]}

    def minor(columns: tuple[int, ...]) -> list[Any]:
        """Of the last rows of s I - A, as many as there are columns: coefficients of s^0, s^1, ..."""
        row = len(rows) - len(columns)
        if columns not in known:
            total: list[Any] = [0] * (len(columns) + 1)
            for j, c in enumerate(columns):
                if c != row and _is_zero(rows[row][c]):
                    continue
                for k, value in enumerate(minor((*columns[:j], *columns[j + 1 :]))):
                    if _is_zero(value):
                        continue
                    if not _is_zero(rows[row][c]):
                        total[k] = total[k] - (-1) ** j * rows[row][c] * value
                    if c == row:
                        total[k + 1] = total[k + 1] + (-1) ** j * value
            known[columns] = total
        return known[columns]

    return minor(tuple(range(len(rows))))[::-1]


def _is_zero(entry: Any) -> bool:
    """Whether an entry is the literal 0."""
    return isinstance(entry, int) and entry == 0


def _entries(A: Any) -> list[list[Any]]:
    """Entries row by row, with the literal 0 where an entry is zero by structure (or all over the stack)."""
    n = A.shape[-1]
    if isinstance(A, np.ndarray):
        return [[A[..., i, j] if np.any(A[..., i, j]) else 0 for j in range(n)] for i in range(n)]
    return [[0 if A[i, j].is_zero() else A[i, j] for j in range(n)] for i in range(n)]


def shifted(a: Sequence[Any], sigma: Any) -> list[Any]:
    """Coefficients of p(s - sigma): its roots are those of p moved to the right by sigma.

    Examples
    --------
    >>> shifted([1.0, 3.0], 1.0)  # s + 3 -> s + 2
    [1.0, 2.0]
    """
    n = len(a) - 1
    return [sum(a[i] * comb(n - i, k - i) * (-sigma) ** (k - i) for i in range(k + 1)) for k in range(n + 1)]


def determinant(rows: Sequence[Sequence[Any]]) -> Any:
    """Determinant by expansion along the first row, each minor once (symbols have no pivots; the literal 0 is skipped)."""
    known: dict[tuple[int, ...], Any] = {}

    def minor(columns: tuple[int, ...]) -> Any:
        """Of the last rows, as many as there are columns."""
        row = rows[-len(columns)]
        if len(columns) == 1:
            return row[columns[0]]
        if columns not in known:
            total: Any = 0
            for j, c in enumerate(columns):
                if not _is_zero(row[c]):
                    total = total + (-1) ** j * row[c] * minor((*columns[:j], *columns[j + 1 :]))
            known[columns] = total
        return known[columns]

    return minor(tuple(range(len(rows))))


def hurwitz_determinant(a: Sequence[Any], order: int) -> Any:
    """Leading principal minor H_order of the Hurwitz matrix.

    Examples
    --------
    >>> hurwitz_determinant([1, 2, 3, 4], 2)  # a_1 a_2 - a_0 a_3
    2
    """
    n = len(a) - 1
    rows = [[a[2 * j - i + 1] if 0 <= 2 * j - i + 1 <= n else 0 for j in range(order)] for i in range(order)]
    return determinant(rows)


def hurwitz_determinants(a: Sequence[Any]) -> list[Any]:
    """Leading principal minors [H_1, ..., H_n] of the Hurwitz matrix; all > 0 with a_0 > 0 iff p is stable.

    Examples
    --------
    >>> hurwitz_determinants([1, 2, 3, 4])  # a_1, a_1 a_2 - a_0 a_3, a_3 H_2
    [2, 2, 8]
    """
    return [hurwitz_determinant(a, order) for order in range(1, len(a))]


def lienard_chipart(a: Sequence[Any]) -> dict[str, Any]:
    """Conditions of Lienard and Chipart: with a_0 > 0, all values > 0 iff every root has a negative real part.

    Parameters
    ----------
    a : sequence
        [a_0, ..., a_n] with a_0 > 0.

    Returns
    -------
    dict
        a_n, a_(n-2), ... and H_(n-1), H_(n-3), ... by name; half the work of Routh-Hurwitz.
        Source: Gantmacher, Theory of Matrices II, ch. XV.

    Examples
    --------
    >>> lienard_chipart([1, 2, 3, 4])
    {'a3': 4, 'a1': 2, 'H2': 2}
    """
    n = len(a) - 1
    conditions = {f"a{i}": a[i] for i in range(n, 0, -2)}
    return conditions | {f"H{m}": hurwitz_determinant(a, m) for m in range(n - 1, 0, -2)}

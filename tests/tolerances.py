"""Tolerances of the tests, each with its reason. A test that needs another one adds it here."""

from decimal import Decimal

import pytest

ROUNDING = 1e-12
"""Relative; the same formula evaluated twice in double precision, some ten operations with little cancellation."""

SAME_EQUATIONS = 1e-11
"""Relative to the largest term; package against twin, where moments of 1e5 N m may cancel to a few."""

CHARACTERISTIC_POLYNOMIAL = 1e-9
"""Relative; five steps of Faddeev and LeVerrier lose up to six of sixteen digits (measured: 1e-11 for Table 0.1)."""

CENTRAL_DIFFERENCE_STEP = 1e-5
CENTRAL_DIFFERENCE = 1e-7
"""Relative to the largest entry; at this step the error of second order and the rounding of differences are both below."""

QUADRATURE = 1e-9
"""Relative; `scipy.integrate.quad` on smooth integrands asks for 1.5e-8 and in fact reaches rounding."""

CRITICAL_DAMPING = 1e-9
"""Relative; a critical damping from `brentq` on eigenvalues, which are known to about 1e-13 of the largest, against algebra."""


def half_last_digit(text: str) -> float:
    """Half a unit in the last place of a printed number: what rounding in print can hide."""
    return 0.5 * 10.0 ** Decimal(text).as_tuple().exponent


def printed(text: str, beyond: float = 0.0):
    """Comparison with a number as its source prints it, e.g. ``printed("93.40")``: half its last digit, and `beyond`.

    `beyond` is what the rounding of an input that the source prints as well can move the number by.
    """
    return pytest.approx(float(text), rel=0, abs=half_last_digit(text) * (1 + 1e-9) + beyond)

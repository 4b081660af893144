"""Tolerances of the tests, each with its reason. A test that needs another one adds it here."""

from decimal import Decimal

import pytest

ROUNDING = 1e-12
"""Relative; one formula evaluated in two ways in double precision, some ten operations with little cancellation."""

SAME_EQUATIONS = 1e-13
"""Relative to the largest rate; package against twin, the same sums in another order (measured: below 1e-14)."""

CHARACTERISTIC_POLYNOMIAL = 1e-10
"""Relative; floating point against rational numbers (measured: 1e-14, and 1e-12 after interpolation in speed)."""

CENTRAL_DIFFERENCE_STEP = 1e-5
CENTRAL_DIFFERENCE = 1e-7
"""Relative to the largest entry; at this step the error of second order and the rounding of differences are both below."""

QUADRATURE = 1e-11
"""Relative; `scipy.integrate.quad` on smooth integrands and square roots at an end (measured: below 1e-12)."""

GRID_SEARCH = 1e-8
"""Relative; a maximum met by a grid of 100 001 slip angles to 80 deg misses by (curvature) (1.4e-5 rad)^2/8 at most."""

CRITICAL_DAMPING = 1e-10
"""Relative; the damping at which an eigenvalue, known to 1e-13 of the largest, crosses the axis (measured: below 1e-12)."""


def half_last_digit(text: str) -> float:
    """Half a unit in the last place of a printed number: what rounding in print can hide."""
    return 0.5 * 10.0 ** Decimal(text).as_tuple().exponent


def printed(text: str, beyond: float = 0.0):
    """Comparison with a number as its source prints it, e.g. ``printed("93.40")``: half its last digit, and `beyond`.

    `beyond` is what the rounding of an input that the source prints as well can move the number by.
    """
    return pytest.approx(float(text), rel=0, abs=half_last_digit(text) * (1 + 1e-9) + beyond)

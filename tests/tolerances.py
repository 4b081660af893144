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


SAME_LINKAGE = 1e-13
"""[m]; a closed loop of links of 0.6 m, solved to rounding by two sets of unknowns (measured: below 1e-15)."""

CONVERGENCE_ORDER = 0.05
"""Of an exponent from values at two arguments, where the next power of a small argument is still to be seen."""

ENERGY = 1e-9
"""Relative; energy of an undamped motion over some five cycles at an integrator tolerance of 1e-11, IDAS at 1e-10
(measured: 3e-10, IDAS)."""

SAME_MOTION = 1e-9
"""Of the amplitude; two integrators at a tolerance of 1e-11 over some cycles (measured: 2e-10, IDAS at 1e-10)."""

STATIC_STIFFNESS = 1e-9
"""Relative; a limit of vanishing (1e-6 N s/m) or very large (1e12) damping in place of none or a rigid one."""

DYNAMIC_STIFFNESS = 1e-11
"""Relative; receptance by one solution of the linear model, less the inertia of the gear (measured: below 1e-12)."""

SENSITIVITY = 2e-8
"""Of the largest value; sensitivities at a tolerance of 1e-10 against fourth-order differences of solutions at 1e-11 or 1e-12
(measured: 4e-9)."""

LINEAR_RESPONSE = 1e-6
"""Relative; steady response to a disturbance so small that squares and cubes of the motion do not count."""

INTERPOLATED_DECAY = 1e-6
"""Relative; heights of extrema from a cubic through 160 samples a cycle."""

EVENT_MOTION = 1e-9
"""Of the amplitude; exact simulation at its tolerance of 1e-10 against closed forms over some cycles and corners."""

CONVERGED = 5e-4
"""Of the amplitude; smooth version against the exact one, corners rounded over a thousandth of their element
(measured: 1.2e-4, gap)."""

FIRST_ORDER = 0.15
"""What a tenth of the width leaves of the error: a tenth, if it goes with the width, and some of the next order."""

INTEGRATED = 1e-6
"""Of the amplitude; smooth engine at 1e-9, which takes corners in its stride, and a cubic through points of the exact one."""

DESCRIBED_AMPLITUDE = 0.05
"""Relative; describing function of a gap against the true limit cycle (measured: 3.9 % smaller)."""

DESCRIBED_FREQUENCY = 0.02
"""Relative; the same of the frequency (measured: 1.4 % slower)."""

SAME_CYCLE = 1e-3
"""Relative; limit cycle with corners rounded over a thousandth of the gap against the exact one."""

GAP_PROPORTION = 2e-3
"""Relative; cubes of yaw angles up to 4 mrad and of the slip, to which a limit cycle near neutral stability is sensitive."""

MIDDLE_OF_EXTREMA = 0.05
"""Relative; second-order perturbation of a limit cycle of 0.2 to 0.26 rad whose restoring torque is the arm's but for a few
per cent (measured: +1.5 to +2 %)."""

SECOND_HARMONIC = 0.05
"""Relative; first-order perturbation by a damper whose torque is a fraction of the inertia's (measured: 1.4 %)."""

SAMPLED_HARMONIC = 5e-5
"""Of the first harmonic; harmonics of a motion by a cubic through 40 samples a cycle (measured: 1.2e-5 where it is odd)."""

SAME_CYCLE_FROM_WITHOUT = 0.01
"""Relative; amplitudes of one limit cycle reached from within and from without, at growth rates near 0.1 1/s."""

COMMANDED_MOTION = 1e-6
"""Of the amplitude; the command's default tolerance of 1e-8 over 50 cycles against SciPy at 1e-11 (measured: 2.4e-7, erk,
and 3.1e-7, IDAS)."""

COMMANDED_PEAK = 1e-5
"""Relative; decay, amplitude and frequency by a cubic through 40 samples a cycle of such a motion."""

PRINTED_ROW = 1e-9
"""Relative to the largest; columns of a CSV with eleven digits, one computed from two others."""

DECAY_RATIO = 2e-6
"""Relative; the default integration tolerance of 1e-8 over three cycles, and the cubic between 64 samples a cycle."""

DECAY_GRADIENT = 2e-5
"""Of ln(ratio) to ln(variable); the cubic between 64 samples a cycle, 2.4e-7, times some sixty radians of phase that
a stiffness shifts."""

SAME_WORST = 2e-3
"""Relative; the largest of 61 speeds against a search between speeds, and a smooth curve sampled 400 times."""

ON_THE_CURVE = 1e-11
"""Of the largest entry of the state matrix; rounding of its eigenvalues, after roots to 1e-13 of the ranges."""

RETURNED = 1e-6
"""Of the largest value of each state; an orbit by collocation of order 7 after one period of DOP853 at 1e-11."""

DIFFERENCED = 1e-4
"""Multiplier by central differences of 1e-5 of the orbit's size, whose error goes with their square; corners are met a little
beside where they are."""

DECAY_BY_CUBES = 0.02
"""Relative; the next term of the normal form at 0.02 rad, and the tail of the lateral mode in the peaks."""

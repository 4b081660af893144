"""`certify` on the brink: windows that no grid sees, neighbouring floats, single points, divergence to the last bit."""

import math
from fractions import Fraction

import numpy as np
import pytest
from exact_gears import Q, exact_hurwitz, fails_at_its_counterexample, first_stable_float, quadratic_gear, rational
from random_gears import STRAIGHT_TANGENT_TYRE, ends, random_gear, refined_maximum, rotational
from scipy.optimize import brentq

from damperopt import certify, linear_gear

# windows of instability that grids do not see


WINDOW_GEARS = {
    "third order": {"order": 3, "margin": 0.0},
    "third order with margin": {"order": 3, "margin": 2.0},
    "fifth order": {"order": 5, "margin": 0.0},
    "fifth order with margin": {"order": 5, "margin": 0.1},
    "rake": {"order": 5, "margin": 0.05, "rake_angle": 0.15},
    "straight tangent": {"order": 5, "margin": 0.1, "tyre": STRAIGHT_TANGENT_TYRE},
}
GRID_SPEEDS = 2000


def _between_the_nodes(low, peak):
    """Upper end of the speed range near 100 m/s that puts `peak` midway between two of GRID_SPEEDS even speeds."""
    cells = round((peak - low) / (100.0 - low) * (GRID_SPEEDS - 1))
    return low + (peak - low) * (GRID_SPEEDS - 1) / (cells + 0.5)


@pytest.mark.parametrize("excess", [1e-7, 1e-8, 1e-9, 1e-10])
@pytest.mark.parametrize("name", WINDOW_GEARS)
def test_a_window_narrower_than_the_grid_is_found_and_a_near_miss_is_proved(main_gear, name, excess):
    """Damping tuned until the abscissa exceeds the margin by `excess` over a window between two of 2000 grid speeds."""
    numbers = dict(WINDOW_GEARS[name])
    margin, low, load = numbers.pop("margin"), 5.0, 1.5e5
    undamped = rotational(main_gear, damping=0.0, **numbers)
    without = linear_gear(undamped, {})
    I_z = undamped.gear.yaw_inertia

    def abscissa(damping, speeds):
        A = without.matrices(speeds, load)
        A[:, 1, 1] -= damping / I_z  # the damper acts on the yaw rate only
        return np.linalg.eigvals(A).real.max(axis=1)

    def above_margin(damping):
        return refined_maximum(lambda V: abscissa(damping, V), low, 100.0, count=60)[0] + margin

    for side in (1, -1):
        damping = brentq(lambda c, s=side: above_margin(c) - s * excess, 500.0, 3000.0, xtol=1e-12, rtol=1e-14)
        top, peak = refined_maximum(lambda V, c=damping: abscissa(c, V), low, 100.0)
        assert top + margin == pytest.approx(side * excess, rel=0.05)
        study = rotational(main_gear, damping=damping, speed=(low, _between_the_nodes(low, peak)), **numbers)
        certificate = certify(study, {}, margin)
        assert certificate.proved == (side < 0)
        if side > 0:
            # what a grid check sees: every one of 2000 speeds is stable
            grid = np.linspace(*ends(study), GRID_SPEEDS)
            assert linear_gear(study, {}).abscissa(grid, load).max() < -margin
            assert certificate.counterexample[0] == pytest.approx(peak, abs=0.02)
            assert fails_at_its_counterexample(study, certificate)


@pytest.mark.parametrize(
    ("order", "margin", "tyre"),
    [(3, 0.0, {}), (3, 1.5, {}), (5, 0.0, {}), (5, 0.125, {}), (5, 0.05, {"relaxation_length": 0.2})],
)
def test_the_verdict_changes_between_two_neighbouring_floats_of_the_damping(main_gear, order, margin, tyre):
    """The window is then some 1e-7 m/s wide and the excess far below the rounding of any eigenvalue solver."""

    def study_at(damping):
        return rotational(main_gear, order=order, damping=damping, tyre=tyre)

    unstable, stable = first_stable_float(study_at, margin, 0.0, 3000.0)
    assert not certify(study_at(unstable), {}, margin).proved
    assert certify(study_at(stable), {}, margin).proved


def test_the_verdict_on_the_brink_survives_other_units(main_gear):
    """Mass, stiffness, damping and load times a power of two: the same eigenvalues but for the decimals of the numbers.

    A study's numbers are the shortest decimals of their floats, half a unit in the last place away at most; the damping is
    therefore taken one float further from the brink.
    """

    def study_at(damping, factor=1.0):
        return rotational(
            main_gear,
            yaw_inertia=100.0 * factor,
            stiffness=3.8e5 * factor,
            damping=damping * factor,
            lateral={"inertia": 600.0 * factor, "stiffness": 6.1e6 * factor, "damping": 300.0 * factor},
            tyre={"tread_width_moment": 570.0 * factor},
            load=1.5e5 * factor,
        )

    unstable, stable = first_stable_float(study_at, 0.0, 0.0, 3000.0)
    below, above = math.nextafter(unstable, 0.0), math.nextafter(stable, math.inf)
    for factor in (2.0**-10, 2.0**10):
        assert not certify(study_at(below, factor), {}, 0.0).proved
        assert certify(study_at(above, factor), {}, 0.0).proved


# instability at exactly one point: a third-order gear whose Routh condition is a quadratic with known zeros


AFTER_1, BEFORE_1 = math.nextafter(1.0, 2.0), math.nextafter(1.0, 0.0)
AFTER_2, BEFORE_HALF = math.nextafter(2.0, 3.0), math.nextafter(0.5, 0.0)


@pytest.mark.parametrize(
    ("M", "speed", "proved"),
    [
        # M = 3.5: unstable between 1/2 and 2 m/s, on the line exactly there
        (3.5, (2.0, 4.0), False),
        (3.5, (AFTER_2, 4.0), True),
        (3.5, (0.25, 0.5), False),
        (3.5, (0.25, BEFORE_HALF), True),
        (3.5, (0.25, 4.0), False),
        (3.5, (2.0, 2.0), False),
        (3.5, (0.5, 0.5), False),
        (3.5, (AFTER_2, AFTER_2), True),
        (3.5, (1.0, 1.0), False),
        # M = 3: touches the line at 1 m/s and nowhere else
        (3.0, (0.5, 2.0), False),
        (3.0, (0.5, 1.5), False),
        (3.0, (0.3, 7.0), False),
        (3.0, (1.0, 4.0), False),
        (3.0, (0.25, 1.0), False),
        (3.0, (1.0, 1.0), False),
        (3.0, (AFTER_1, 4.0), True),
        (3.0, (0.25, BEFORE_1), True),
        # one rounding unit of M to either side: a window of 3e-8 m/s, or none
        (math.nextafter(3.0, 4.0), (0.5, 2.0), False),
        (math.nextafter(3.0, 2.0), (0.5, 2.0), True),
    ],
)
def test_instability_at_exactly_one_speed_is_told_from_none(main_gear, M, speed, proved):
    study = quadratic_gear(main_gear, M, speed)
    certificate = certify(study, {}, 0.0)
    assert certificate.proved is proved
    assert proved or fails_at_its_counterexample(study, certificate)


@pytest.mark.parametrize(
    ("loads", "proved"),
    [
        # at 1 m/s the line is touched at F_z = 3 N with M = 1; more load is unstable
        ((1.0, 3.0), False),
        ((1.0, math.nextafter(3.0, 0.0)), True),
        ((1.0, 3.5), False),
        ((3.0, 3.5), False),
        ((0.25, 1.0), True),
    ],
)
def test_instability_at_exactly_one_corner_or_point_of_a_load_range(main_gear, loads, proved):
    study = quadratic_gear(main_gear, 1.0, (0.5, 2.0), loads)
    certificate = certify(study, {}, 0.0)
    assert certificate.proved is proved
    assert proved or fails_at_its_counterexample(study, certificate)


# divergence


def test_third_order_divergence_is_found_to_the_last_bit(main_gear):
    """k_psi + (e C_F' + C_M) F_z = 0: a root at zero at every speed; the next float of k_psi is stable."""
    tyre = {
        "contact": "leading_point",
        "half_contact_length": 0.25,
        "relaxation_length": 1.0,
        "tread_width_moment": 0.0,
        "cornering_slope": 0.5,
        "aligning_coefficient": -1.0,
    }
    numbers = {"order": 3, "yaw_inertia": 1.0, "caster_length": 0.25, "damping": 1.0, "load": 1.0, "tyre": tyre}
    for stiffness, proved in (
        (0.875, False),
        (math.nextafter(0.875, 1.0), True),
        (math.nextafter(0.875, 0.0), False),
        (0.0, False),
    ):
        study = rotational(main_gear, stiffness=stiffness, speed=(0.5, 8.0), **numbers)
        certificate = certify(study, {}, 0.0)
        assert certificate.proved is proved
        assert proved or fails_at_its_counterexample(study, certificate)


def test_fifth_order_divergence_is_found_to_the_last_bit(main_gear):
    """det A is linear in k_psi and its sign does not depend on speed: the critical stiffness is a rational number."""

    def study_at(stiffness, load=1.5e5):
        lateral = {"damping": 3e4}
        return rotational(
            main_gear, stiffness=stiffness, damping=5e3, tyre={"aligning_coefficient": -1.0}, lateral=lateral, load=load
        )

    def a_n(stiffness):
        value = exact_hurwitz(study_at(stiffness), Q(10), rational(1.5e5), Q(0))[0]
        return Fraction(int(value.p), int(value.q))

    critical = a_n(0.0) / (a_n(0.0) - a_n(1.0))
    below = float(critical)
    below = below if Fraction(str(below)) <= critical else math.nextafter(below, 0.0)
    above = math.nextafter(below, math.inf)
    assert 1e5 < below < 2e5
    assert not certify(study_at(below), {}, 0.0).proved
    assert certify(study_at(above), {}, 0.0).proved
    # over loads: divergence at the top of the range only
    certificate = certify(study_at(above, (1e5, 1.50001e5)), {}, 0.0)
    assert not certificate.proved
    assert fails_at_its_counterexample(study_at(above, (1e5, 1.50001e5)), certificate)
    assert certify(study_at(above, (1e5, 1.5e5)), {}, 0.0).proved


@pytest.mark.parametrize("order", [3, 5])
def test_divergence_of_random_gears_with_a_diverging_tyre(main_gear, order):
    """C_M < 0 and little stiffness: real roots cross. The verdict turns within 1e-8 1/s of the refined maximum."""
    rng = np.random.default_rng(17)
    real = 0
    for _ in range(10):
        study = random_gear(
            rng,
            main_gear,
            order=order,
            damping=3e4,
            stiffness=float(rng.uniform(0.1, 2) * 1.5e5),
            tyre={"aligning_coefficient": -float(rng.uniform(0.5, 1.5))},
        )
        gear, load = linear_gear(study, {}), study.envelope.loads[0]
        top, V = refined_maximum(lambda V, g=gear, F=load: g.abscissa(V, F), *ends(study))
        eigenvalues = np.linalg.eigvals(gear.matrices(V, load)[0])
        real += abs(eigenvalues[eigenvalues.real.argmax()].imag) < 1e-9
        for margin in (max(0.0, -top - 1e-8), max(0.0, -top + 1e-8)):
            certificate = certify(study, {}, margin)
            assert certificate.proved == (top < -margin)
            assert certificate.proved or fails_at_its_counterexample(study, certificate)
    assert real >= 3

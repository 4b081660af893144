"""`certify` against brute force, against a second exact method, and against gears built to mislead it.

The second method shares nothing with the package: the linear gear is written down again in rational numbers, its
Hurwitz determinants come from `fmpq_mat.det` at some speeds and are interpolated, and their zeros are isolated by
Arb (`complex_roots`) where `certify` counts with Sturm's chain.
"""

import math
from fractions import Fraction

import flint
import numpy as np
import pytest
from random_gears import (
    STRAIGHT_TANGENT_TYRE,
    brute_force,
    dense,
    extreme_gear,
    random_gear,
    refined_maximum,
    refined_maximum_2d,
    rotational,
)
from scipy.optimize import brentq

from damperopt import certify, linear_gear, worst_points
from damperopt.proof.certify import (
    _bernstein,
    _bernstein_1d,
    _halves,
    _zero_in_rectangle,
    _zeros_in_range,
)

TOUCH = 1e-9
"""[1/s] How far a counterexample may stay below the margin: zeros in speed are enclosed to 1e-9 of the range."""

RELATIVE_EIGENVALUE_ERROR = 1e-12
"""Relative to the largest entry: backward error of `eigvals` times the condition of the eigenvalues of extreme gears."""

ENCLOSURE = 2e-9
"""Relative; zeros are bisected until the interval is below 1e-9 of its upper end."""

Q = flint.fmpq
RING = flint.fmpq_mpoly_ctx.get(("u", "V", "F"), "lex")
_, SPEED, LOAD = RING.gens()


def rational(value):
    return Q(*float(value).as_integer_ratio())


def abscissa_at(study, point):
    return float(linear_gear(study, {}).abscissa(*point)[0])


def fails_at_its_counterexample(study, certificate):
    """Whether the point named lies in the envelope and misses the margin there (or touches it)."""
    speed, load = certificate.counterexample
    inside = study.envelope.speed.min <= speed <= study.envelope.speed.max
    loads = study.envelope.loads
    inside &= loads[0] <= load <= loads[-1] if study.envelope.load_is_range else load in loads
    return inside and abscissa_at(study, (speed, load)) >= -certificate.margin - TOUCH


# the second exact method: rake 0, linear tyre


def exact_matrix(study, V, F_z):
    """State matrix in rational numbers, from section 2 of the theory page."""
    gear, tyre, damper = study.gear, study.tyre, study.damper
    I_z, e, a, sigma = map(rational, (gear.yaw_inertia, gear.caster_length, tyre.half_contact_length, tyre.relaxation_length))
    kappa, slope, C_M = map(rational, (tyre.tread_width_moment, tyre.cornering_slope, tyre.aligning_coefficient))
    k_psi, c_psi = map(rational, (damper.torsional_stiffness, damper.torsional_damping))
    yaw = [-k_psi / I_z, -(c_psi + kappa / V) / I_z], [-(e * slope + C_M) * F_z / (I_z * sigma)]
    if gear.order == 3:
        return [[Q(0), Q(1), Q(0)], [*yaw[0], *yaw[1]], [V, e - a, -V / sigma]]
    strut = gear.lateral
    I_x, k_delta, c_delta, l_g = map(rational, (strut.inertia, strut.stiffness, strut.damping, strut.height))
    return [
        [Q(0), Q(1), Q(0), Q(0), Q(0)],
        [*yaw[0], Q(0), Q(0), *yaw[1]],
        [Q(0), Q(0), Q(0), Q(1), Q(0)],
        [F_z * e / I_x, Q(0), -k_delta / I_x, -c_delta / I_x, -l_g * slope * F_z / (I_x * sigma)],
        [V, e - a, Q(0), l_g, -V / sigma],
    ]


def exact_hurwitz(study, V, F_z, margin):
    """[a_n, H_1, ..., H_n] of det(s - margin - A), by determinants of the Hurwitz matrix."""
    rows = exact_matrix(study, V, F_z)
    n = len(rows)
    moved = flint.fmpq_mat([[x + (margin if i == j else 0) for j, x in enumerate(row)] for i, row in enumerate(rows)])
    a = moved.charpoly().coeffs()[::-1]
    full = [[a[2 * j - i + 1] if 0 <= 2 * j - i + 1 <= n else Q(0) for j in range(n)] for i in range(n)]
    return [a[n], *(flint.fmpq_mat([row[:m] for row in full[:m]]).det() for m in range(1, n + 1))]


def interpolated(values, speeds):
    vandermonde = flint.fmpq_mat([[V**k for k in range(len(speeds))] for V in speeds])
    solution = vandermonde.solve(flint.fmpq_mat([[value] for value in values]))
    return flint.fmpq_poly([solution[k, 0] for k in range(len(speeds))])


def exactly_stable(study, margin):
    """Whether every speed of the envelope is strictly stable with the margin at its (one) load."""
    low, high = rational(study.envelope.speed.min), rational(study.envelope.speed.max)
    F_z, margin, n = rational(study.envelope.loads[0]), rational(margin), study.gear.order
    if min(exact_hurwitz(study, low, F_z, margin)[1:]) <= 0:
        return False
    # V a_k is quadratic in V, so V a_n and V^(n-1) H_(n-1) have degrees 2 and 2 (n - 1)
    speeds = [Q(k) for k in range(1, 2 * n)]
    samples = [exact_hurwitz(study, V, F_z, margin) for V in speeds]
    for k, power in ((0, 1), (n - 1, n - 1)):
        polynomial = interpolated([s[k] * V**power for s, V in zip(samples, speeds, strict=True)], speeds)
        for root, _ in polynomial.numer().complex_roots():
            if root.imag == 0 and not (root.real < flint.arb(low) or root.real > flint.arb(high)):
                return False
    return True


def first_stable_float(study_at, margin, low, high):
    """Two neighbouring floats (c, c+) such that the exact method says no at c and yes at c+."""
    assert not exactly_stable(study_at(low), margin)
    assert exactly_stable(study_at(high), margin)
    while math.nextafter(low, high) < high:
        middle = (low + high) / 2
        if exactly_stable(study_at(middle), margin):
            high = middle
        else:
            low = middle
    return low, high


# random gears


@pytest.mark.parametrize("seed", range(4))
def test_agrees_with_the_refined_maximum_over_speed(main_gear, seed):
    """Margins are set near the true maximum of the abscissa, down to 1e-8 1/s from it, on either side."""
    rng = np.random.default_rng(seed)
    outcomes = []
    for _ in range(12):
        study = random_gear(rng, main_gear)
        gear, load = linear_gear(study, {}), study.envelope.loads[0]
        top, _ = refined_maximum(lambda V, g=gear, F=load: g.abscissa(V, F), *_ends(study), count=500)
        distance = float(rng.choice([1.0, 1e-3, 1e-6, 1e-8]))
        for margin in {max(0.0, -top - distance), max(0.0, -top + distance)}:
            certificate = certify(study, {}, margin)
            assert certificate.proved == (top < -margin)
            assert certificate.proved or fails_at_its_counterexample(study, certificate)
            assert (certificate.counterexample is None) == certificate.proved
            outcomes.append(certificate.proved)
    assert set(outcomes) == {True, False}


def _ends(study):
    return study.envelope.speed.min, study.envelope.speed.max


@pytest.mark.parametrize("seed", range(4))
def test_agrees_with_a_dense_grid_over_speed_and_load(main_gear, seed):
    rng = np.random.default_rng(100 + seed)
    outcomes = set()
    for _ in range(12):
        low = float(10 ** rng.uniform(3.5, 5))
        study = random_gear(rng, main_gear, load=(low, low * float(10 ** rng.uniform(0.1, 2))))
        gear = linear_gear(study, {})
        top, _, _ = brute_force(gear, dense(*_ends(study), 40), dense(*study.envelope.loads, 15))
        margin = max(0.0, -top + float(rng.choice([1.0, 1e-2, 1e-4]) * rng.choice([-1, 1])))
        certificate = certify(study, {}, margin)
        # the grid knows a point that misses the margin; that it knows none proves nothing, so look where certify points
        assert not (certificate.proved and top >= -margin)
        assert certificate.proved or fails_at_its_counterexample(study, certificate)
        outcomes.add(certificate.proved)
    assert outcomes == {True, False}


@pytest.mark.parametrize("kind", range(5))
@pytest.mark.parametrize("as_range", [False, True])
def test_extreme_gears_are_decided_correctly(main_gear, kind, as_range):
    """Nothing crashes, and nothing is proved that a grid contradicts by more than the error of its eigenvalues."""
    rng = np.random.default_rng(1000 + kind)
    for _ in range(6):
        study = extreme_gear(rng, main_gear, kind)
        if as_range:
            study = study.replace(envelope__vertical_load={"min": 1.0, "max": 1e7})
        gear, loads = linear_gear(study, {}), dense(*study.envelope.loads, 8) if as_range else study.envelope.loads
        speeds = dense(0.01, 1000.0, 60 if as_range else 400)
        top, V, F_z = brute_force(gear, speeds, loads)
        error = RELATIVE_EIGENVALUE_ERROR * np.abs(gear.matrices(V, F_z)).max()
        for margin in {0.0, max(0.0, -top * 0.999), max(0.0, -top * 1.001)}:
            certificate = certify(study, {}, margin)
            assert not (certificate.proved and top > -margin + error)
            if not certificate.proved:
                speed, load = certificate.counterexample
                error_there = RELATIVE_EIGENVALUE_ERROR * np.abs(gear.matrices(speed, load)).max()
                assert float(gear.abscissa(speed, load)[0]) >= -margin - TOUCH - error_there


@pytest.mark.parametrize("topology", ["boeing", "utas", "arreaza"])
@pytest.mark.parametrize("geometry", ["published", "planar"])
def test_layouts_are_certified_like_the_rotational_gear_with_their_stiffness_and_damping(main_gear, topology, geometry):
    rng = np.random.default_rng(7)
    study = main_gear.replace(damper__topology=topology, damper__geometry=geometry)
    for _ in range(3):
        design = {
            "c_lambda": float(10 ** rng.uniform(3.5, 5)),
            "k_lambda": 4e6,
            "I_arm": 5e-6,
            "L": float(rng.uniform(0.4, 0.8)),
            "gamma": float(rng.uniform(0.3, 1.0)),
            "b": 0.2,
        }
        gear = linear_gear(study, design)
        top, _ = refined_maximum(lambda V, g=gear: g.abscissa(V, 1.5e5), 5.0, 100.0)
        for side in (-1, 1):
            margin = max(0.0, -top - side * 1e-8)
            assert certify(study, design, margin).proved == (top < -margin)


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
            grid = np.linspace(*_ends(study), GRID_SPEEDS)
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
    """Mass, stiffness, damping and load times a power of two: the same eigenvalues, exactly."""

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
    for factor in (2.0**-10, 2.0**10):
        assert not certify(study_at(unstable, factor), {}, 0.0).proved
        assert certify(study_at(stable, factor), {}, 0.0).proved


# instability at exactly one point: a third-order gear whose Routh condition is a quadratic with known zeros


def quadratic_gear(base, M, speed, load=1.0):
    """I_z = k_psi = c_psi = sigma = 1, e = a, kappa = 0: stable iff V^2 + (1 - M F_z) V + 1 > 0 and M F_z > -1.

    M is C_M + e C_F', the moment per slip angle and load; from the closed form of the theory page, section 2.
    """
    tyre = {
        "half_contact_length": 0.5,
        "relaxation_length": 1.0,
        "tread_width_moment": 0.0,
        "cornering_slope": 2.0,
        "aligning_coefficient": M - 1.0,
    }
    return rotational(
        base, order=3, yaw_inertia=1.0, caster_length=0.5, stiffness=1.0, damping=1.0, tyre=tyre, speed=speed, load=load
    )


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
    below = below if Fraction(below) <= critical else math.nextafter(below, 0.0)
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
        top, V = refined_maximum(lambda V, g=gear, F=load: g.abscissa(V, F), *_ends(study))
        eigenvalues = np.linalg.eigvals(gear.matrices(V, load)[0])
        real += abs(eigenvalues[eigenvalues.real.argmax()].imag) < 1e-9
        for margin in (max(0.0, -top - 1e-8), max(0.0, -top + 1e-8)):
            certificate = certify(study, {}, margin)
            assert certificate.proved == (top < -margin)
            assert certificate.proved or fails_at_its_counterexample(study, certificate)
    assert real >= 3


# loads


ISLAND = {
    "yaw_inertia": 330.0,
    "caster_length": 0.345,
    "stiffness": 8.9e5,
    "lateral": {"inertia": 190.0, "stiffness": 1.13e6, "damping": 90.0, "height": 4.0},
    "tyre": {
        "half_contact_length": 0.32,
        "relaxation_length": 0.46,
        "tread_width_moment": 150.0,
        "cornering_slope": 0.008,
        "aligning_coefficient": 0.42,
    },
    "speed": (5.0, 100.0),
}
"""A gear, found by search, whose abscissa peaks at 25 m/s and 99 kN, inside 5..100 m/s and 40..260 kN."""


def test_instability_inside_a_rectangle_whose_four_edges_are_stable(main_gear):
    study = rotational(main_gear, damping=150.0, load=(4e4, 2.6e5), **ISLAND)
    gear = linear_gear(study, {})
    speeds, loads = np.linspace(5, 100, 2000), np.linspace(4e4, 2.6e5, 2000)
    edges = [gear.abscissa(speeds, 4e4), gear.abscissa(speeds, 2.6e5), gear.abscissa(5.0, loads), gear.abscissa(100.0, loads)]
    assert max(edge.max() for edge in edges) < -0.05
    assert gear.abscissa(25.6, 9.9e4)[0] > 0.05
    certificate = certify(study, {}, 0.0)
    assert not certificate.proved
    assert fails_at_its_counterexample(study, certificate)
    assert 4e4 < certificate.counterexample[1] < 2.6e5
    assert certify(study.replace(envelope__vertical_load={"min": 4e4, "max": 5e4}), {}, 0.0).proved


@pytest.mark.parametrize("excess", [1e-3, 1e-6, 1e-8, 1e-9])
def test_an_island_of_any_size_is_found_and_a_near_miss_is_proved(main_gear, excess):
    study = rotational(main_gear, damping=200.0, load=(4e4, 2.6e5), **ISLAND)
    top, V, F_z = refined_maximum_2d(linear_gear(study, {}), (5.0, 100.0), (4e4, 2.6e5))
    assert 10 < V < 60
    assert 6e4 < F_z < 1.5e5
    missed, kept = certify(study, {}, -top + excess), certify(study, {}, -top - excess)
    assert kept.proved
    assert not missed.proved
    assert fails_at_its_counterexample(study, missed)


@pytest.mark.parametrize("seed", [0, 5])
def test_the_largest_margin_that_is_proved_is_the_worst_abscissa(main_gear, seed):
    """Bisection of the margin by proofs alone, over speed and load, against the search by eigenvalues."""
    rng = np.random.default_rng(seed)
    while True:
        low = float(10 ** rng.uniform(3, 5))
        study = random_gear(rng, main_gear, load=(low, low * float(10 ** rng.uniform(0.3, 2))))
        if certify(study, {}, 0.0).proved:
            break
    kept, missed = 0.0, 1.0
    while certify(study, {}, missed).proved:
        kept, missed = missed, 2 * missed
    while missed - kept > 1e-9 * missed:
        middle = (kept + missed) / 2
        certificate = certify(study, {}, middle)
        kept, missed = (middle, missed) if certificate.proved else (kept, middle)
        assert certificate.proved or fails_at_its_counterexample(study, certificate)
    worst = worst_points(linear_gear(study, {}), study.envelope)[0]
    assert worst.abscissa == pytest.approx(-kept, rel=1e-8, abs=1e-8)


def test_a_list_of_loads_fails_if_and_only_if_one_of_them_does(main_gear):
    study = rotational(main_gear, damping=150.0, **ISLAND)
    stable, unstable = [2e4, 4e4, 2e5, 2.6e5], [7e4, 9.9e4, 1.3e5]
    for load in stable:
        assert certify(study.replace(envelope__vertical_load=[load]), {}, 0.0).proved
    assert certify(study.replace(envelope__vertical_load=stable), {}, 0.0).proved
    for load in unstable:
        for position in range(len(stable) + 1):
            several = study.replace(envelope__vertical_load=[*stable[:position], load, *stable[position:]])
            certificate = certify(several, {}, 0.0)
            assert certificate.counterexample[1] == load
            assert fails_at_its_counterexample(several, certificate)


def test_a_load_that_is_unstable_at_every_speed_shows_no_crossing_and_is_found_all_the_same(main_gear):
    """k_psi + M F_z < 0 at 2 N: a real root on the right at every speed, and no root ever on the line."""
    for loads, proved in (([0.5], True), ([2.0], False), ([0.5, 2.0], False), ([2.0, 0.5], False), ([0.5, 0.7], True)):
        study = quadratic_gear(main_gear, -1.0, (0.5, 2.0), loads)
        certificate = certify(study, {}, 0.0)
        assert certificate.proved is proved
        assert proved or fails_at_its_counterexample(study, certificate)
        assert proved or certificate.counterexample[1] == 2.0


def test_a_range_of_loads_of_one_rounding_unit_agrees_with_the_single_load(main_gear):
    for damping, proved in ((150.0, False), (400.0, True)):
        study = rotational(main_gear, damping=damping, load=(9.9e4, math.nextafter(9.9e4, math.inf)), **ISLAND)
        assert certify(study, {}, 0.0).proved is proved
        assert certify(study.replace(envelope__vertical_load=[9.9e4]), {}, 0.0).proved is proved


def test_a_gear_that_hardly_feels_the_load_is_proved_near_its_margin(main_gear):
    """Rake of 1e-6 rad and a straight-tangent tyre: the worst speed is the same at every load, to 1e-5 1/s."""
    study = rotational(main_gear, order=3, damping=1600.0, rake_angle=1e-6, tyre=STRAIGHT_TANGENT_TYRE, load=(5e4, 1.5e5))
    gear = linear_gear(study, {})
    top = max(refined_maximum(lambda V, F=F: gear.abscissa(V, F), 5.0, 100.0)[0] for F in np.linspace(5e4, 1.5e5, 11))
    for reserve in (1e-5, 1e-7):
        certificate = certify(study, {}, -top - reserve)
        # the gear keeps this margin; at the least, no point may be named that does not miss it
        assert certificate.proved or fails_at_its_counterexample(study, certificate)


# a single speed


@pytest.mark.parametrize("order", [3, 5])
def test_a_single_speed_is_decided_by_its_eigenvalues(main_gear, order):
    rng = np.random.default_rng(23)
    for _ in range(10):
        speed = float(10 ** rng.uniform(-1, 2.5))
        study = random_gear(rng, main_gear, order=order, speed=(speed, speed))
        top = abscissa_at(study, (speed, study.envelope.loads[0]))
        for margin in (max(0.0, -top - 1e-8), max(0.0, -top + 1e-8)):
            certificate = certify(study, {}, margin)
            assert certificate.proved == (top < -margin)
        load = study.envelope.loads[0]
        ranged = certify(study.replace(envelope__vertical_load={"min": load, "max": load * 1.0001}), {}, 0.0)
        assert not (ranged.proved and top >= 0)


def test_the_margin_of_the_study_is_the_default(main_gear):
    study = rotational(main_gear, damping=2000.0)
    assert main_gear.requirements.stability_margin == 0.1
    assert certify(study, {}).margin == 0.1
    assert certify(study, {}).proved
    assert not certify(study.replace(requirements__stability_margin=0.2), {}).proved
    assert certify(study.replace(requirements=None), {}).margin == 0.0


# Sturm's counting


def polynomial_with(zeros, factor=1):
    product = RING.constant(factor)
    for zero in zeros:
        product *= SPEED - Q(zero.numerator, zero.denominator)
    return product


def assert_same_zeros(found, expected):
    assert len(found) == len(expected), (found, [float(zero) for zero in expected])
    for zero, exact in zip(found, sorted(expected), strict=True):
        assert zero == pytest.approx(float(exact), rel=ENCLOSURE)


@pytest.mark.parametrize("seed", range(3))
def test_zeros_of_random_polynomials_are_those_that_arb_isolates(seed):
    """Degrees to 20, integer coefficients, no zero on an end."""
    rng = np.random.default_rng(seed)
    counted = 0
    for _ in range(40):
        coefficients = [int(c) for c in rng.integers(-50, 50, size=rng.integers(2, 21))]
        condition = sum((c * SPEED**k for k, c in enumerate(coefficients)), RING.constant(0))
        low, high = sorted(float(x) for x in rng.uniform(0.01, 3.0, size=2))
        inside = [
            root.real
            for root, _ in flint.fmpz_poly(coefficients).complex_roots()
            if root.imag == 0 and flint.arb(low) < root.real < flint.arb(high)
        ]
        found = _zeros_in_range(condition, (low, high))
        assert len(found) == len(inside)
        for zero, ball in zip(found, sorted(float(x.mid()) for x in inside), strict=True):
            assert zero == pytest.approx(ball, rel=ENCLOSURE)
        counted += len(found)
    assert counted > 10


def test_zeros_close_together_are_told_apart_and_complex_pairs_ignored():
    near = Fraction(3, 2), Fraction(3, 2) + Fraction(1, 10**7)
    quadratic = (SPEED - Q(3, 2)) ** 2 + Q(1, 10**30)
    assert_same_zeros(_zeros_in_range(polynomial_with(near), (1.0, 2.0)), near)
    assert _zeros_in_range(quadratic, (1.0, 2.0)) == []
    assert_same_zeros(_zeros_in_range(quadratic * polynomial_with(near), (1.0, 2.0)), near)


def test_no_zero_between_two_that_lie_one_rounding_unit_outside():
    low, high = 1.3, 2.7
    outside = Fraction(math.nextafter(low, 0)), Fraction(math.nextafter(high, 3))
    assert _zeros_in_range(polynomial_with(outside), (low, high)) == []
    assert _zeros_in_range(polynomial_with((Fraction(low), Fraction(high))), (low, high)) == [low, high]


@pytest.mark.parametrize("speeds", [(0.0, 10.0), (1.0, 10.0), (0.5, 9.0)])
def test_zeros_of_any_multiplicity_are_all_found_once(speeds):
    """5 is the first point of bisection of 0..10: all members of Sturm's chain vanish at a multiple zero there."""
    rng = np.random.default_rng(3)
    for _ in range(30):
        zeros = [Fraction(int(z)) for z in rng.choice([2, 3, 5, 6, 7, 8], size=3, replace=False)]
        multiplicity = [int(m) for m in rng.integers(1, 4, size=3)]
        condition = polynomial_with([z for z, m in zip(zeros, multiplicity, strict=True) for _ in range(m)])
        assert_same_zeros(_zeros_in_range(condition * (SPEED**2 + 1), speeds), zeros)


def test_a_multiple_zero_on_an_end_is_never_lost():
    for low, high in ((5.0, 9.0), (1.0, 5.0), (5.0, 5.0)):
        for others in ([], [7], [3], [7, 7], [3, 3, 7]):
            condition = polynomial_with([Fraction(z) for z in (5, 5, *others)])
            assert 5.0 in _zeros_in_range(condition, (low, high))


# Bernstein's subdivision


def random_bivariate(rng, degree_V, degree_F):
    return sum(
        (int(rng.integers(-9, 10)) * SPEED**i * LOAD**j for i in range(degree_V + 1) for j in range(degree_F + 1)),
        RING.constant(1),
    )


def value_at(condition, V, F_z):
    """Exact value of a polynomial in V and F."""
    total = Q(0)
    for (_, i, j), coefficient in condition.terms():
        total += coefficient * rational(V) ** i * rational(F_z) ** j
    return total


def test_bernstein_coefficients_are_those_of_the_polynomial():
    """Against the definition sum_k b_k C(n, k) t^k (1 - t)^(n - k), in rational numbers."""
    rng = np.random.default_rng(5)
    for _ in range(20):
        n = int(rng.integers(0, 8))
        power = [Fraction(int(c), 7) for c in rng.integers(-20, 20, size=n + 1)]
        low, high = Fraction(int(rng.integers(-5, 5)), 3), Fraction(int(rng.integers(6, 9)), 2)
        b = _bernstein_1d(np.array(power, dtype=object), low, high)
        for t in (Fraction(0), Fraction(1, 3), Fraction(4, 5), Fraction(1)):
            direct = sum(c * (low + (high - low) * t) ** k for k, c in enumerate(power))
            assert sum(b[k] * math.comb(n, k) * t**k * (1 - t) ** (n - k) for k in range(n + 1)) == direct


def test_bernstein_coefficients_enclose_the_polynomial_on_a_box_and_on_its_halves():
    rng = np.random.default_rng(6)
    for _ in range(10):
        condition = random_bivariate(rng, 4, 3)
        box = _bernstein(condition, (0.5, 2.0), (1.0, 3.0))
        corner = value_at(condition, 0.5, 1.0)
        scale = Fraction(int(box[0, 0])) / Fraction(int(corner.p), int(corner.q)) if corner != 0 else None
        if scale is None:
            continue
        assert scale > 0
        for axis in (0, 1):
            left, right = _halves(box, axis)
            factor = 2 ** (box.shape[axis] - 1)
            for half, first in ((left, True), (right, False)):
                ends = [(0.5, 2.0), (1.0, 3.0)]
                low, high = ends[axis]
                ends[axis] = (low, (low + high) / 2) if first else ((low + high) / 2, high)
                for V, F_z in rng.uniform(*np.array(ends).T, size=(20, 2)):
                    exact = value_at(condition, V, F_z)
                    value = Fraction(int(exact.p), int(exact.q)) * scale * factor
                    assert half.min() <= value <= half.max()
                # a half starts and ends at values of the polynomial itself
                exact = value_at(condition, ends[0][0], ends[1][0])
                assert half[0, 0] == Fraction(int(exact.p), int(exact.q)) * scale * factor


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("reserve", [Q(1), Q(1, 10**4), Q(1, 10**8)])
def test_a_polynomial_without_zeros_in_the_rectangle_is_proved_to_have_none(sign, reserve):
    """Sums of squares plus a small number: positive everywhere by construction, with minima inside and on edges."""
    rng = np.random.default_rng(8)
    for _ in range(8):
        V, F_z = (Q(int(n), 7) for n in rng.integers(0, 30, size=2))
        condition = (SPEED - V) ** 2 + (LOAD - F_z) ** 2 * (1 + SPEED**2) + reserve
        point, examined = _zero_in_rectangle(sign * condition, (0.5, 4.0), (0.25, 3.0))
        assert point is None
        assert examined < 1000


def test_a_polynomial_with_zeros_in_the_rectangle_is_never_proved_positive():
    """Zero curves, lone zeros inside (not on dyadic points), on edges and at corners."""
    third = Q(1, 3)
    lone = (SPEED - 1 - third) ** 2 + (LOAD - 1 - third) ** 2
    touching = {
        "lone zero inside": (lone, (4 / 3, 4 / 3)),
        "zero on an edge": (SPEED - Q(1, 2) + (LOAD - 1 - third) ** 2, (0.5, 4 / 3)),
        "zero at a corner": (SPEED - Q(1, 2) + LOAD - Q(1, 4), (0.5, 0.25)),
        "zero at the far corner": (4 - SPEED + 3 - LOAD, (4.0, 3.0)),
        "negative inside a small disc": (lone - Q(1, 10**8), (4 / 3, 4 / 3)),
    }
    for name, (condition, where) in touching.items():
        point, _ = _zero_in_rectangle(condition, (0.5, 4.0), (0.25, 3.0))
        assert point is not None, name
        assert np.allclose(point, where, atol=1e-3), name
    point, _ = _zero_in_rectangle(-touching["negative inside a small disc"][0], (0.5, 4.0), (0.25, 3.0))
    assert point is not None


@pytest.mark.parametrize("seed", range(3))
def test_random_polynomials_are_judged_as_by_a_dense_grid(seed):
    rng = np.random.default_rng(seed)
    verdicts = set()
    for _ in range(15):
        condition = random_bivariate(rng, int(rng.integers(0, 6)), int(rng.integers(0, 4))) + int(rng.choice([0, 30, -30]))
        values = [value_at(condition, V, F_z) for V in np.linspace(0.25, 1.5, 17) for F_z in np.linspace(0.5, 1.25, 17)]
        point, _ = _zero_in_rectangle(condition, (0.25, 1.5), (0.5, 1.25))
        if point is None:
            assert all(v > 0 for v in values) or all(v < 0 for v in values)
        else:
            # the point has the other sign than the first corner, or is a zero
            assert value_at(condition, *point) * values[0] <= 0
        verdicts.add(point is None)
    assert verdicts == {True, False}


def test_a_single_speed_is_a_rectangle_without_width():
    condition = (SPEED - 2) ** 2 + LOAD - 1
    assert _zero_in_rectangle(condition, (3.0, 3.0), (0.5, 2.0))[0] is None
    assert _zero_in_rectangle(condition, (2.0, 2.0), (0.5, 2.0))[0] is not None
    assert _zero_in_rectangle(condition, (2.0, 2.0), (1.0, 2.0))[0] == (2.0, 1.0)

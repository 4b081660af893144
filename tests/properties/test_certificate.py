"""`certify` against brute force: random and extreme gears, loads, and single speeds."""

import math

import numpy as np
import pytest
from exact_gears import TOUCH, abscissa_at, fails_at_its_counterexample, quadratic_gear
from random_gears import (
    STRAIGHT_TANGENT_TYRE,
    brute_force,
    dense,
    ends,
    extreme_gear,
    random_gear,
    refined_maximum,
    refined_maximum_2d,
    rotational,
)

from damperopt import certify, linear_gear, worst_points

RELATIVE_EIGENVALUE_ERROR = 1e-12
"""Relative to the largest entry: backward error of `eigvals` times the condition of the eigenvalues of extreme gears."""


@pytest.mark.parametrize("seed", range(4))
def test_agrees_with_the_refined_maximum_over_speed(main_gear, seed):
    """Margins are set near the true maximum of the abscissa, down to 1e-8 1/s from it, on either side."""
    rng = np.random.default_rng(seed)
    outcomes = []
    for _ in range(12):
        study = random_gear(rng, main_gear)
        gear, load = linear_gear(study, {}), study.envelope.loads[0]
        top, _ = refined_maximum(lambda V, g=gear, F=load: g.abscissa(V, F), *ends(study), count=500)
        distance = float(rng.choice([1.0, 1e-3, 1e-6, 1e-8]))
        for margin in {max(0.0, -top - distance), max(0.0, -top + distance)}:
            certificate = certify(study, {}, margin)
            assert certificate.proved == (top < -margin)
            assert certificate.proved or fails_at_its_counterexample(study, certificate)
            assert (certificate.counterexample is None) == certificate.proved
            outcomes.append(certificate.proved)
    assert set(outcomes) == {True, False}


@pytest.mark.parametrize("seed", range(4))
def test_agrees_with_a_dense_grid_over_speed_and_load(main_gear, seed):
    rng = np.random.default_rng(100 + seed)
    outcomes = set()
    for _ in range(12):
        low = float(10 ** rng.uniform(3.5, 5))
        study = random_gear(rng, main_gear, load=(low, low * float(10 ** rng.uniform(0.1, 2))))
        gear = linear_gear(study, {})
        top, _, _ = brute_force(gear, dense(*ends(study), 40), dense(*study.envelope.loads, 15))
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


# loads


ISLAND = {
    "yaw_inertia": 330.0,
    "caster_length": 0.345,
    "stiffness": 8.9e5,
    "lateral": {"inertia": 190.0, "stiffness": 1.13e6, "damping": 90.0, "height": 4.0},
    "tyre": {
        "contact": "leading_point",
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

"""Critical speeds against counts of unstable roots, closed forms, and roots that only seem to cross."""

import numpy as np
import pytest
from exact_gears import quadratic_gear
from random_gears import (
    dense,
    eigenvalues,
    ends,
    random_gear,
    rotational,
)

from damperopt import certify, critical_speeds, linear_gear
from damperopt.stability.critical import marginal_throughout

ON_THE_LINE = 1e-10
"""Relative to the largest eigenvalue: |Re + margin| at a critical speed, a root of a bracketed function."""


def unstable_counts(gear, speeds, load, margin):
    return (np.linalg.eigvals(gear.matrices(speeds, load)).real > -margin).sum(axis=1)


def assert_critical_speeds_explain_the_counts(gear, load, low, high, margin, count=2000):
    """Each change of the number of roots right of the line is explained, each critical speed lies on the line.

    Returns the number of critical speeds.
    """
    found = critical_speeds(gear, load, low, high, margin)
    speeds = dense(low, high, count)
    counts = unstable_counts(gear, speeds, load, margin)
    jumps = np.zeros(len(speeds) - 1)
    for c in found:
        assert low <= c.speed <= high
        assert c.load == load
        moved = eigenvalues(gear, c.speed, load) + margin
        on_line = moved[np.abs(moved.real) <= ON_THE_LINE * np.abs(moved).max()]
        assert len(on_line) == (2 if c.kind == "hopf" else 1), c
        assert c.frequency == pytest.approx(np.abs(on_line.imag).max() / (2 * np.pi), rel=1e-6, abs=1e-12)
        cell = min(np.searchsorted(speeds, c.speed, side="right") - 1, len(jumps) - 1)
        jumps[cell] += (2 if c.kind == "hopf" else 1) * (1 if c.destabilising else -1)
        others = (moved.real > ON_THE_LINE * np.abs(moved).max()).any()
        assert c.boundary == (not others)
    assert list(np.flatnonzero(jumps)) == list(np.flatnonzero(np.diff(counts)))
    assert (jumps == np.diff(counts)).all()
    assert [c.speed for c in found] == sorted(c.speed for c in found)
    return len(found)


@pytest.mark.parametrize("seed", range(3))
def test_critical_speeds_explain_every_change_of_stability(main_gear, seed):
    rng = np.random.default_rng(seed)
    total = 0
    for _ in range(20):
        study = random_gear(rng, main_gear)
        gear, load = linear_gear(study, {}), study.envelope.loads[0]
        total += assert_critical_speeds_explain_the_counts(gear, load, *ends(study), float(rng.choice([0, 0.1, 1, 10])))
    assert total >= 4


@pytest.mark.parametrize("margin", [0.0, 0.05, 0.1, 1.0])
@pytest.mark.parametrize("order", [3, 5])
def test_critical_speeds_of_the_main_gear_over_ordinary_speeds(main_gear, order, margin):
    for damping in (300.0, 700.0, 2000.0):
        study = rotational(main_gear, order=order, damping=damping)
        assert_critical_speeds_explain_the_counts(linear_gear(study, {}), 1.5e5, 0.5, 150.0, margin)


@pytest.mark.parametrize(
    ("load", "margin", "tyre", "lateral"),
    [
        (5e4, 0.05, {}, {}),
        (1.5e5, 0.05, {}, {}),
        (1e5, 0.1, {"relaxation_length": 0.12}, {"stiffness": 2e6}),
        (1.5e5, 0.1, {"relaxation_length": 0.12}, {"stiffness": 2e6, "damping": 3e3}),
    ],
)
def test_critical_speeds_from_a_crawl_to_a_rocket_sled(main_gear, load, margin, tyre, lateral):
    """0.01 to 1000 m/s: the string's own root, about -V/sigma, crosses the margin near 0.01 m/s."""
    gear = linear_gear(rotational(main_gear, tyre=tyre, lateral=lateral), {})
    assert assert_critical_speeds_explain_the_counts(gear, load, 0.01, 1000.0, margin) >= 1


def test_critical_speeds_of_a_quadratic_with_known_zeros(main_gear):
    """Third order with V^2 + (1 - M) V + 1 > 0, section 2 of the theory page: M = 3.5 is unstable from 1/2 to 2 m/s.

    On the line lambda^2 = -a_2: at V = 2 that is 1 - c_psi V + ... of I_z = k_psi = c_psi = sigma = 1, e = a.
    """
    tyre = {
        "contact": "leading_point",
        "half_contact_length": 0.5,
        "relaxation_length": 1.0,
        "tread_width_moment": 0.0,
        "cornering_slope": 2.0,
        "aligning_coefficient": 2.5,
    }
    study = rotational(
        main_gear,
        order=3,
        yaw_inertia=1.0,
        caster_length=0.5,
        stiffness=1.0,
        damping=1.0,
        tyre=tyre,
        speed=(0.25, 4.0),
        load=1.0,
    )
    gear = linear_gear(study, {})
    first, second = critical_speeds(gear, 1.0, 0.25, 4.0)
    assert (first.speed, second.speed) == (pytest.approx(0.5, rel=1e-12), pytest.approx(2.0, rel=1e-12))
    assert (first.kind, second.kind) == ("hopf", "hopf")
    assert (first.destabilising, second.destabilising) == (True, False)
    assert first.boundary
    assert second.boundary
    # det(s - A) = (s^2 + w^2)(s + V/sigma + c_psi/I_z): w^2 = c_psi V + k_psi
    assert first.frequency == pytest.approx(np.sqrt(1.5) / (2 * np.pi), rel=1e-9)
    assert second.frequency == pytest.approx(np.sqrt(3.0) / (2 * np.pi), rel=1e-9)
    assert critical_speeds(gear, 1.0, 0.6, 1.9) == []
    assert [c.speed for c in critical_speeds(gear, 1.0, 0.6, 4.0)] == [pytest.approx(2.0, rel=1e-12)]


def test_a_symmetric_pair_of_small_real_roots_is_no_critical_speed(main_gear):
    """H_2 = 0 also where two real roots are +-r; here r = 4.9e-4 1/s at 1 m/s, and no root is on the axis."""
    r_squared = 2.0**-22
    tyre = {
        "contact": "leading_point",
        "half_contact_length": 0.5,
        "relaxation_length": 1.0,
        "tread_width_moment": 0.0,
        "cornering_slope": 0.0,
        "aligning_coefficient": -1 - 2 * r_squared,
    }
    # I_z = k_psi = c_psi = sigma = 1; with these a_2 = -r^2 and a_3 = a_1 a_2 at V = 1
    study = rotational(
        main_gear,
        order=3,
        yaw_inertia=1.0,
        caster_length=0.5 + (2 + r_squared) / (1 + 2 * r_squared),
        stiffness=1.0,
        damping=1.0,
        tyre=tyre,
        load=1.0,
    )
    gear = linear_gear(study, {})
    roots = np.sort(eigenvalues(gear, 1.0, 1.0).real)
    assert roots == pytest.approx([-2.0, -(2.0**-11), 2.0**-11], rel=1e-6)
    assert critical_speeds(gear, 1.0, 0.9, 1.1) == []


def test_a_symmetric_pair_beside_a_lightly_damped_mode_is_no_critical_speed(main_gear):
    """Divergent yaw, C_M < 0: near 0.54 m/s two real roots are +-7.9, while the lateral pair decays with 0.1 % of critical."""
    study = rotational(main_gear, stiffness=0.0, damping=3e3, tyre={"aligning_coefficient": -1.0}, lateral={"damping": 30.0})
    gear = linear_gear(study, {})
    speeds = np.geomspace(0.5, 0.6, 400)
    closest = np.abs(np.linalg.eigvals(gear.matrices(speeds, 1.5e5)).real).min()
    assert closest > 0.09
    assert critical_speeds(gear, 1.5e5, 0.5, 0.6) == []


def test_critical_speed_of_divergence(main_gear):
    """With a margin a real root crosses the line: kind divergence, frequency 0, and the only root there is real."""
    rng = np.random.default_rng(12)
    seen = 0
    for _ in range(12):
        tyre = {"aligning_coefficient": -float(rng.uniform(0.5, 1.5)), "relaxation_length": float(rng.uniform(0.2, 0.6))}
        study = rotational(main_gear, order=3, damping=float(rng.uniform(1e4, 6e4)), tyre=tyre)
        gear = linear_gear(study, {})
        margin = float(rng.uniform(3, 12))
        assert_critical_speeds_explain_the_counts(gear, 1.5e5, 1.0, 100.0, margin)
        for c in critical_speeds(gear, 1.5e5, 1.0, 100.0, margin):
            if c.kind == "divergence":
                seen += 1
                assert c.frequency == 0.0
    assert seen >= 3


# roots that only seem to cross


@pytest.mark.parametrize("stiffness", [0.0, 1000.0])
@pytest.mark.parametrize(("caster", "half_length", "relaxation"), [(0.4, 0.1, 0.3), (0.3, 0.1, 0.2), (0.75, 0.25, 0.5)])
def test_a_gear_that_is_marginal_at_every_speed_has_no_critical_speed(main_gear, stiffness, caster, half_length, relaxation):
    """e = a + sigma, no damping: a pair stays on the axis. In binary 0.4 - 0.1 - 0.3 is 5.6e-17, which crosses nothing."""
    tyre = {
        "contact": "leading_point",
        "half_contact_length": half_length,
        "relaxation_length": relaxation,
        "tread_width_moment": 0.0,
        "cornering_slope": 6.0,
    }
    numbers = {"order": 3, "yaw_inertia": 1.0, "caster_length": caster, "stiffness": stiffness, "damping": 0.0}
    study = rotational(main_gear, speed=(1.0, 60.0), load=1e4, tyre=tyre, **numbers)
    gear = linear_gear(study, {})
    assert critical_speeds(gear, 1e4, 1.0, 60.0) == []
    assert marginal_throughout(gear, 1e4, 1.0, 60.0)
    certificate = certify(study, {}, 0.0)
    assert not certificate.proved
    assert "marginal at every speed" in certificate.reason
    ranged = certify(study.replace(envelope__vertical_load={"min": 1e4, "max": 2e4}), {}, 0.0)
    assert not ranged.proved
    assert "marginal at every speed" in ranged.reason
    # a little damping, and it is stable at every speed
    damped = study.replace(damper__torsional_damping=1e-6)
    assert certify(damped, {}, 0.0).proved
    assert critical_speeds(linear_gear(damped, {}), 1e4, 1.0, 60.0) == []


def test_a_root_that_touches_the_line_is_told_from_one_that_crosses(main_gear):
    """M = 3 of the quadratic gear: V^2 - 2 V + 1 > 0 but at 1 m/s."""
    gear = linear_gear(quadratic_gear(main_gear, 3.0, (0.5, 2.0)), {})
    (found,) = critical_speeds(gear, 1.0, 0.5, 2.0)
    assert found.touching
    assert not found.boundary
    assert found.speed == pytest.approx(1.0, rel=1e-6)
    crossing = linear_gear(quadratic_gear(main_gear, 3.5, (0.25, 4.0)), {})
    assert [c.touching for c in critical_speeds(crossing, 1.0, 0.25, 4.0)] == [False, False]


@pytest.mark.parametrize("low", [1e-12, 1e-9, 1e-6, 1e-3])
def test_a_root_that_tends_to_zero_with_speed_crosses_nothing_at_the_low_end(main_gear, low):
    """The string's root, about -V/sigma, vanishes with the speed; it lies on the axis at no speed."""
    gear = linear_gear(rotational(main_gear, order=3, damping=2000.0), {})
    assert critical_speeds(gear, 1.5e5, low, 100.0) == []


def test_a_critical_speed_at_an_end_of_the_range_is_kept(main_gear):
    gear = linear_gear(quadratic_gear(main_gear, 3.5, (0.25, 4.0)), {})
    assert [c.speed for c in critical_speeds(gear, 1.0, 0.5, 2.0)] == pytest.approx([0.5, 2.0], rel=1e-12)

"""Spectral abscissa, worst points, critical speeds and modes against brute force, and under changes of units."""

import numpy as np
import pytest
from random_gears import (
    LATERAL,
    LINEAR_TYRE,
    STRAIGHT_TANGENT_TYRE,
    brute_force,
    dense,
    extreme_gear,
    random_gear,
    refined_maximum_2d,
    rotational,
)

from damperopt import certify, critical_speeds, linear_gear, track_modes, worst_points

BELOW_GRID = 1e-8
"""[1/s] What the worst point may lie below a grid that also only samples: bounded searches stop at 1e-8 of the speed,
where a smooth peak is flat to its square."""

RELATIVE_EIGENVALUE_ERROR = 1e-12
"""Relative to the largest entry: backward error of `eigvals` times the condition of the eigenvalues of extreme gears."""

ON_THE_LINE = 1e-10
"""Relative to the largest eigenvalue: |Re + margin| at a critical speed, a root of a bracketed function."""

SAME_SPEED = 1e-9
"""Relative; a critical speed from polynomial coefficients in two systems of units."""

SAME_EIGENVALUES = 1e-9
"""Relative to the largest eigenvalue; rounding of `eigvals` in two systems of units."""


def ends(study):
    return study.envelope.speed.min, study.envelope.speed.max


def eigenvalues(gear, speed, load):
    return np.linalg.eigvals(gear.matrices(speed, load)[0])


# spectral abscissa


def test_abscissa_broadcasts_and_is_the_largest_real_part(main_gear):
    rng = np.random.default_rng(0)
    for _ in range(10):
        study = random_gear(rng, main_gear)
        gear = linear_gear(study, {})
        speeds, loads = rng.uniform(1, 100, 7), rng.uniform(1e4, 2e5, 7)
        one_by_one = [max(s.real for s in eigenvalues(gear, V, F)) for V, F in zip(speeds, loads, strict=True)]
        assert gear.abscissa(speeds, loads) == pytest.approx(one_by_one, rel=1e-12, abs=1e-12)
        assert gear.abscissa(speeds, loads[0])[3] == pytest.approx(gear.abscissa(speeds[3], loads[0])[0], abs=1e-12)
        assert gear.abscissa(speeds[0], loads)[3] == pytest.approx(gear.abscissa(speeds[0], loads[3])[0], abs=1e-12)


# worst points


def assert_consistent(points, gear, envelope):
    """Every point lies in the envelope, carries the abscissa found there, and they are in descending order."""
    heights = [p.abscissa for p in points]
    assert heights == sorted(heights, reverse=True)
    for p in points:
        assert envelope.speed.min <= p.speed <= envelope.speed.max
        assert min(envelope.loads) <= p.load <= max(envelope.loads)
        assert p.abscissa == pytest.approx(gear.abscissa(p.speed, p.load)[0], rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_worst_point_over_speed_is_never_below_a_dense_grid(main_gear, seed):
    rng = np.random.default_rng(seed)
    for _ in range(12):
        study = random_gear(rng, main_gear, spread=float(rng.choice([1.0, 2.0])))
        gear, load = linear_gear(study, {}), study.envelope.loads[0]
        top, _, _ = brute_force(gear, dense(*ends(study), 1000), [load])
        points = worst_points(gear, study.envelope)
        assert points[0].abscissa >= top - BELOW_GRID
        assert_consistent(points, gear, study.envelope)


@pytest.mark.parametrize("kind", range(5))
def test_worst_point_of_extreme_gears_is_never_below_a_dense_grid(main_gear, kind):
    rng = np.random.default_rng(50 + kind)
    for _ in range(6):
        study = extreme_gear(rng, main_gear, kind)
        gear, load = linear_gear(study, {}), study.envelope.loads[0]
        top, V, _ = brute_force(gear, dense(0.01, 1000.0, 800), [load])
        error = RELATIVE_EIGENVALUE_ERROR * np.abs(gear.matrices(V, load)).max()
        assert worst_points(gear, study.envelope)[0].abscissa >= top - BELOW_GRID - error


@pytest.mark.parametrize("seed", [5, 32])
def test_worst_point_over_speed_does_not_hang_on_the_number_of_samples(main_gear, seed):
    """The seeds hold gears with two maxima, of which two or three samples and a local search find the lower."""
    rng = np.random.default_rng(seed)
    for _ in range(4):
        study = random_gear(rng, main_gear)
        gear = linear_gear(study, {})
        reference = worst_points(gear, study.envelope)[0].abscissa
        for samples in (2, 3, 5, 150):
            found = worst_points(gear, study.envelope, samples=samples)[0].abscissa
            assert found == pytest.approx(reference, rel=0, abs=2 * BELOW_GRID)


def test_worst_point_of_a_list_of_loads_is_the_worst_of_each(main_gear):
    rng = np.random.default_rng(10)
    for _ in range(8):
        loads = [float(F) for F in rng.uniform(2e4, 3e5, size=3)]
        study = random_gear(rng, main_gear, load=loads)
        gear = linear_gear(study, {})
        points = worst_points(gear, study.envelope)
        assert {p.load for p in points} == set(loads)
        for load in loads:
            alone = worst_points(gear, study.replace(envelope__vertical_load=[load]).envelope)
            assert [p for p in points if p.load == load] == alone


def test_worst_point_of_a_single_speed_is_that_speed(main_gear):
    rng = np.random.default_rng(11)
    for _ in range(5):
        study = random_gear(rng, main_gear, speed=(17.0, 17.0))
        gear = linear_gear(study, {})
        (only,) = worst_points(gear, study.envelope)
        assert (only.speed, only.load) == (17.0, study.envelope.loads[0])
        assert only.abscissa == gear.abscissa(17.0, only.load)[0]


@pytest.mark.parametrize("seed", range(3))
def test_worst_point_over_a_load_range_is_never_below_a_dense_grid(main_gear, seed):
    rng = np.random.default_rng(200 + seed)
    for _ in range(2):
        low = float(10 ** rng.uniform(3.5, 5))
        study = random_gear(rng, main_gear, load=(low, low * float(10 ** rng.uniform(0.1, 1.5))))
        gear = linear_gear(study, {})
        top, _, _ = brute_force(gear, dense(*ends(study), 60), dense(*study.envelope.loads, 20))
        points = worst_points(gear, study.envelope)
        assert points[0].abscissa >= top - BELOW_GRID
        assert_consistent(points, gear, study.envelope)


RESONANT_TYRE = {
    "half_contact_length": 0.04,
    "relaxation_length": 0.2,
    "tread_width_moment": 100.0,
    "cornering_slope": 0.002,
    "aligning_coefficient": 0.9,
}


def resonant(base, load, stiffness=5e3, lateral=None):
    """The aligning moment, which grows with the load, tunes the yaw frequency to the lateral one at one load."""
    return rotational(
        base,
        yaw_inertia=30.0,
        caster_length=0.25,
        stiffness=stiffness,
        damping=50.0,
        lateral={"inertia": 300.0, "stiffness": 5e5, "damping": 300.0, "height": 0.2} | (lateral or {}),
        tyre=RESONANT_TYRE,
        load=load,
    )


RESONANT = {
    "peak on the edge of 5 m/s": {},
    "little lateral damping": {"lateral": {"damping": 20.0}},
    "stiffer": {"stiffness": 2e4, "lateral": {"stiffness": 6.5e5}},
    "low gear": {"stiffness": 2e4, "lateral": {"stiffness": 6.5e5, "height": 0.05}},
    "hardly unstable": {"stiffness": 1e5, "lateral": {"stiffness": 1.45e6, "height": 0.05}},
    "higher frequency": {"stiffness": 1e5, "lateral": {"stiffness": 1.9e6, "height": 0.05}},
}
HEAVY_STRUT = {
    "yaw_inertia": 19.0,
    "caster_length": 0.2,
    "stiffness": 3.3e4,
    "tyre": {
        "half_contact_length": 0.03,
        "relaxation_length": 0.26,
        "tread_width_moment": 570.0,
        "cornering_slope": 5e-4,
        "aligning_coefficient": 1.6,
    },
}
"""Inertia 60 times as large about the lateral axis as about the yaw axis: the ridge runs oblique through many cells."""


@pytest.mark.parametrize("name", RESONANT)
def test_worst_point_where_yaw_and_lateral_frequency_meet_at_one_load(main_gear, name):
    """10 to 500 kN: the abscissa is a narrow ridge in load, oblique to both axes."""
    study = resonant(main_gear, (1e4, 5e5), **RESONANT[name])
    gear = linear_gear(study, {})
    top, _, _ = brute_force(gear, dense(5.0, 100.0, 25), np.linspace(1e4, 5e5, 150))
    assert worst_points(gear, study.envelope)[0].abscissa >= top - BELOW_GRID


@pytest.mark.parametrize(
    ("top_speed", "heaviest", "damping", "lateral_stiffness", "height"),
    [(300.0, 3e5, 500.0, 2e7, 0.2), (300.0, 4e5, 700.0, 1.78e7, 0.2), (20.0, 3.5e5, 500.0, 1.6e7, 0.2)],
)
def test_worst_point_on_a_long_oblique_ridge(main_gear, top_speed, heaviest, damping, lateral_stiffness, height):
    lateral = {"inertia": 1150.0, "stiffness": lateral_stiffness, "damping": 21.0, "height": height}
    study = rotational(main_gear, damping=damping, lateral=lateral, speed=(5.0, top_speed), load=(1e4, heaviest), **HEAVY_STRUT)
    gear = linear_gear(study, {})
    top, _, _ = brute_force(gear, np.geomspace(5.0, top_speed, 40), np.linspace(1e4, heaviest, 300))
    assert worst_points(gear, study.envelope)[0].abscissa >= top - BELOW_GRID


def test_worst_point_of_a_single_speed_over_a_load_range(main_gear):
    for speed in (7.0, 17.0, 33.3):
        study = resonant(main_gear, (1e4, 5e5)).replace(envelope__speed={"min": speed, "max": speed})
        gear = linear_gear(study, {})
        points = worst_points(gear, study.envelope)
        top, _, _ = brute_force(gear, [speed], np.linspace(1e4, 5e5, 5000))
        assert points[0].abscissa >= top - BELOW_GRID
        assert_consistent(points, gear, study.envelope)


def test_worst_point_at_a_small_load_of_a_wide_range(main_gear):
    """Unstable near 50 kN only, range 1 kN to 5 MN; `certify` knows."""
    study = resonant(main_gear, (1e3, 5e6))
    gear = linear_gear(study, {})
    top, _, load = brute_force(gear, np.geomspace(5, 100, 40), np.geomspace(1e3, 5e6, 150))
    assert top > 1
    assert 4e4 < load < 7e4
    assert not certify(study, {}, 0.0).proved
    assert worst_points(gear, study.envelope)[0].abscissa >= top - BELOW_GRID


def test_worst_point_inside_a_rectangle_with_one_smooth_peak_is_exact(main_gear):
    """Peak at 25.7 m/s and 99.2 kN; flat enough to be found to rounding by zooming in."""
    tyre = {
        "half_contact_length": 0.32,
        "relaxation_length": 0.46,
        "tread_width_moment": 150.0,
        "cornering_slope": 0.008,
        "aligning_coefficient": 0.42,
    }
    study = rotational(
        main_gear,
        yaw_inertia=330.0,
        caster_length=0.345,
        stiffness=8.9e5,
        damping=200.0,
        lateral={"inertia": 190.0, "stiffness": 1.13e6, "damping": 90.0, "height": 4.0},
        tyre=tyre,
        load=(4e4, 2.6e5),
    )
    gear = linear_gear(study, {})
    top, V, F_z = refined_maximum_2d(gear, (5.0, 100.0), (4e4, 2.6e5))
    worst = worst_points(gear, study.envelope)[0]
    assert worst.abscissa == pytest.approx(top, rel=0, abs=BELOW_GRID)
    assert (worst.speed, worst.load) == (pytest.approx(V, rel=1e-2), pytest.approx(F_z, rel=1e-2))


def test_enough_only_stops_the_search_where_an_end_of_the_load_range_is_worse(main_gear):
    study = rotational(main_gear, damping=600.0, load=(5e4, 1.5e5))
    gear = linear_gear(study, {})
    full = worst_points(gear, study.envelope)
    at_ends = max(p.abscissa for p in full if p.load in (5e4, 1.5e5))
    stopped = worst_points(gear, study.envelope, enough=at_ends - 1e-3)
    assert {p.load for p in stopped} <= {5e4, 1.5e5}
    assert stopped[0].abscissa == pytest.approx(at_ends, rel=0, abs=BELOW_GRID)
    assert worst_points(gear, study.envelope, enough=at_ends + 1e-3) == full


# critical speeds


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


# units


def scaled_gears(base, rng):
    """(original, other units, factor on eigenvalues, factor on speeds): mass, then time, then length."""
    numbers = {
        "order": int(rng.choice([3, 5])),
        "stiffness": float(rng.uniform(1e5, 5e5)),
        "damping": float(rng.uniform(100, 3000)),
        "caster_length": float(rng.uniform(0.05, 0.2)),
        "rake_angle": float(rng.uniform(-0.2, 0.2)),
    }
    s = float(rng.uniform(2, 7))
    straight = rng.random() < 0.5
    tyre = STRAIGHT_TANGENT_TYRE if straight else LINEAR_TYRE

    def build(inertia, stiffness, damping, kappa, length, force, speed):
        # force times length is a moment; a slope per load and rad has no unit, the aligning coefficient is a length
        return rotational(
            base,
            order=numbers["order"],
            yaw_inertia=100.0 * inertia,
            caster_length=numbers["caster_length"] * length,
            rake_angle=numbers["rake_angle"],
            wheel_radius=0.362 * length,
            stiffness=numbers["stiffness"] * stiffness,
            damping=numbers["damping"] * damping,
            lateral={
                "inertia": LATERAL["inertia"] * inertia,
                "stiffness": LATERAL["stiffness"] * stiffness,
                "damping": LATERAL["damping"] * damping,
                "height": LATERAL["height"] * length,
            },
            tyre=tyre
            | {
                "half_contact_length": tyre["half_contact_length"] * length,
                "relaxation_length": tyre["relaxation_length"] * length,
                "tread_width_moment": tyre["tread_width_moment"] * kappa,
            }
            | (
                {
                    "cornering_stiffness": tyre["cornering_stiffness"] * force,
                    "aligning_stiffness": tyre["aligning_stiffness"] * force * length,
                }
                if straight
                else {"aligning_coefficient": tyre["aligning_coefficient"] * length}
            ),
            speed=(2.0 * speed, 150.0 * speed),
            load=1.5e5 * force,
        )

    original = build(1, 1, 1, 1, 1, 1, 1)
    yield original, build(s, s, s, s, 1, s, 1), 1.0, 1.0
    yield original, build(1, s**2, s, s**2, 1, s**2, s), s, s
    yield original, build(1, 1, 1, s, s, 1 / s, s), 1.0, s


@pytest.mark.parametrize("seed", range(3))
def test_results_do_not_depend_on_the_units_of_mass_time_and_length(main_gear, seed):
    for study, other, rate, speed in scaled_gears(main_gear, np.random.default_rng(seed)):
        gear, scaled = linear_gear(study, {}), linear_gear(other, {})
        load, other_load = study.envelope.loads[0], other.envelope.loads[0]
        for V in (2.0, 15.0, 150.0):
            here, there = (np.sort_complex(eigenvalues(*a)) for a in ((gear, V, load), (scaled, V * speed, other_load)))
            assert there == pytest.approx(here * rate, rel=0, abs=SAME_EIGENVALUES * np.abs(here * rate).max())

        for margin in (0.0, 0.3):
            critical = critical_speeds(gear, load, 2.0, 150.0, margin)
            scaled_critical = critical_speeds(scaled, other_load, 2.0 * speed, 150.0 * speed, margin * rate)
            assert [c.speed * speed for c in critical] == pytest.approx([c.speed for c in scaled_critical], rel=SAME_SPEED)
            assert [(c.kind, c.destabilising, c.boundary) for c in critical] == [
                (c.kind, c.destabilising, c.boundary) for c in scaled_critical
            ]
        worst, scaled_worst = worst_points(gear, study.envelope)[0], worst_points(scaled, other.envelope)[0]
        assert scaled_worst.abscissa == pytest.approx(worst.abscissa * rate, abs=2 * BELOW_GRID * rate)


# modes


def assert_same_set(found, expected):
    """Two sets of eigenvalues, whatever the order."""
    size = np.abs(expected).max()
    left = list(expected)
    for value in found:
        nearest = int(np.argmin([abs(value - other) for other in left]))
        assert abs(value - left.pop(nearest)) <= SAME_EIGENVALUES * size


def test_tracking_conserves_the_eigenvalues_of_every_speed(main_gear):
    rng = np.random.default_rng(30)
    for _ in range(12):
        study = random_gear(rng, main_gear, spread=float(rng.choice([1.0, 2.0])))
        gear, load = linear_gear(study, {}), study.envelope.loads[0]
        speeds = np.sort(rng.uniform(*ends(study), size=7))
        table = track_modes(gear, speeds, load)
        assert (table.speeds == speeds).all()
        for V, found in zip(speeds, table.eigenvalues, strict=True):
            assert_same_set(found, eigenvalues(gear, V, load))
        assert table.abscissa == pytest.approx(gear.abscissa(speeds, load), rel=1e-9, abs=1e-9)


def test_each_mode_name_stands_as_often_as_it_has_states(main_gear):
    rng = np.random.default_rng(31)
    for order, names in (
        (3, ["string", "torsional", "torsional"]),
        (5, ["lateral", "lateral", "string", "torsional", "torsional"]),
    ):
        for _ in range(8):
            study = random_gear(rng, main_gear, order=order)
            table = track_modes(linear_gear(study, {}), np.geomspace(*ends(study), 5), study.envelope.loads[0])
            assert sorted(table.names) == names


def test_modes_of_a_loosely_coupled_gear_have_the_frequencies_of_their_names(main_gear):
    """Table 0.1 with hardly any tyre force: sqrt(k_psi/I_z) = 61.6, sqrt(k_delta/I_x) = 100.8 rad/s, -V/sigma."""
    gear = linear_gear(rotational(main_gear), {})
    table = track_modes(gear, np.linspace(5, 100, 20), 1e3)
    by_name = {name: table.eigenvalues[:, [i for i, n in enumerate(table.names) if n == name]] for name in set(table.names)}
    assert np.abs(by_name["torsional"].imag) == pytest.approx(np.full((20, 2), np.sqrt(3800.0)), rel=0.01)
    assert np.abs(by_name["lateral"].imag) == pytest.approx(np.full((20, 2), np.sqrt(6.1e6 / 600)), rel=0.01)
    assert by_name["string"][:, 0] == pytest.approx(-table.speeds / 0.3, rel=0.01)


def pairs_throughout(table):
    """Pairs of modes that are conjugate, and not real, at every speed."""
    n = len(table.names)
    for i in range(n):
        for j in range(i):
            a, b = table.eigenvalues[:, i], table.eigenvalues[:, j]
            close = np.abs(a - b.conj()) <= 1e-9 * np.abs(a)
            if close.all() and (np.abs(a.imag) > 1e-6 * np.abs(a)).all():
                yield i, j


@pytest.mark.parametrize("damping", [300.0, 2000.0, 1e4, 2e4, 3e4])
@pytest.mark.parametrize("order", [3, 5])
def test_a_conjugate_pair_has_one_name(main_gear, order, damping):
    """From 20 kN m s/rad on the yaw axis is overdamped, and yaw angle and string oscillate together at low speed."""
    gear = linear_gear(rotational(main_gear, order=order, damping=damping), {})
    table = track_modes(gear, np.linspace(5.0, 8.0, 10), 1.5e5)
    pairs = list(pairs_throughout(table))
    assert len(pairs) == (order - 1) // 2
    for i, j in pairs:
        assert table.names[i] == table.names[j]


def never_changes_kind(gear, speeds, load):
    """Whether no pair of real roots meets or parts: only then is it certain which mode is which."""
    s = np.linalg.eigvals(gear.matrices(speeds, load))
    return len(set((np.abs(s.imag) < 1e-9 * np.abs(s)).sum(axis=1))) == 1


FINE_GRIDS = {
    "even": np.linspace(5, 100, 37),
    "geometric": np.geomspace(5, 100, 200),
    "two speeds": np.array([5.0, 100.0]),
    # speeds that miss those of a geometric grid by one rounding unit, as exp(linspace(log ..)) gives them
    "exponential": np.unique(np.clip(np.exp(np.linspace(np.log(5), np.log(100), 400)), 5, 100)),
    "doubled": np.unique(np.concatenate([np.geomspace(5, 100, 60), np.nextafter(np.geomspace(5, 100, 60)[:-1], 1e9)])),
    "neighbours of a geometric grid": np.append(np.append(5.0, np.nextafter(np.geomspace(5, 100, 400)[1:-1], 1e9)), 100.0),
}


@pytest.mark.parametrize("grid", FINE_GRIDS)
def test_modes_do_not_depend_on_the_grid(main_gear, grid):
    compared = 0
    speeds = FINE_GRIDS[grid]
    for order in (3, 5):
        for kappa in (0.0, 570.0):
            for damping in (300.0, 3000.0, 11600.0):
                study = rotational(main_gear, order=order, damping=damping, tyre={"tread_width_moment": kappa})
                gear = linear_gear(study, {})
                if not never_changes_kind(gear, np.geomspace(5, 100, 200), 1.5e5):
                    continue
                reference = track_modes(gear, np.linspace(5, 100, 11), 1.5e5)
                table = track_modes(gear, speeds, 1.5e5)
                size = np.abs(reference.eigenvalues[-1]).max()
                assert np.abs(table.eigenvalues[0] - reference.eigenvalues[0]).max() <= SAME_EIGENVALUES * size
                assert np.abs(table.eigenvalues[-1] - reference.eigenvalues[-1]).max() <= SAME_EIGENVALUES * size
                assert table.names == reference.names
                compared += 1
    assert compared >= 9


@pytest.mark.parametrize("order", [3, 5])
def test_names_do_not_depend_on_how_many_speeds_are_asked_for(main_gear, order):
    """Three real roots at every speed from 20 to 100 m/s: which one is the string's must not hang on the sampling."""
    gear = linear_gear(rotational(main_gear, order=order, damping=22500.0, speed=(20.0, 100.0)), {})
    few, many = (track_modes(gear, np.linspace(20.0, 100.0, count), 1.5e5) for count in (2, 3000))
    assert np.abs(few.eigenvalues[-1] - many.eigenvalues[-1]).max() < 1e-6
    assert few.names == many.names


def test_modes_move_continuously(main_gear):
    """A followed eigenvalue moves by no more than a few times what the fine grid makes it move, however few are asked."""
    for order in (3, 5):
        gear = linear_gear(rotational(main_gear, order=order, damping=2000.0), {})
        table = track_modes(gear, np.linspace(5, 100, 500), 1.5e5)
        string = table.names.index("string")
        others = [i for i in range(order) if i != string]
        assert np.abs(np.diff(table.eigenvalues[:, others], axis=0)).max() < 1.0
        assert np.abs(np.diff(table.eigenvalues[:, string])).max() < 2 * 95 / 499 / 0.3


@pytest.mark.parametrize("order", [3, 5])
def test_modes_of_a_gear_without_stiffness_and_without_tyre_forces(main_gear, order):
    """All eigenvalues but the string's are zero, and there is no basis of eigenvectors: still a legal gear."""
    tyre = {"cornering_slope": 0.0, "aligning_coefficient": 0.0, "tread_width_moment": 0.0}
    lateral = {"stiffness": 0.0, "damping": 0.0}
    study = rotational(main_gear, order=order, stiffness=0.0, damping=0.0, tyre=tyre, lateral=lateral)
    table = track_modes(linear_gear(study, {}), np.array([5.0, 20.0, 100.0]), 1.5e5)
    size = 1e-6 * np.abs(table.eigenvalues).max()
    assert sorted(np.abs(table.eigenvalues[1]))[:-1] == pytest.approx(np.zeros(order - 1), abs=size)
    assert table.abscissa == pytest.approx(np.zeros(3), abs=size)
    assert sorted(table.names).count("string") == 1


def test_frequency_damping_and_upper_half_of_a_mode_table(main_gear):
    table = track_modes(linear_gear(rotational(main_gear), {}), np.linspace(5, 100, 20), 1.5e5)
    s = table.eigenvalues
    assert table.frequency == pytest.approx(np.abs(s.imag) / (2 * np.pi), abs=1e-12)
    assert table.damping_ratio * np.abs(s) == pytest.approx(-s.real, rel=1e-12)
    kept = table.upper_half()
    # two pairs and one real root: three of five
    assert len(kept) == 3 * 20
    assert all(s[i, j].imag >= -1e-6 for i, j in kept)

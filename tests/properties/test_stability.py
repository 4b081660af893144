"""Spectral abscissa, worst points and critical speeds against brute force, and under changes of units."""

import numpy as np
import pytest
from random_gears import (
    LATERAL,
    LINEAR_TYRE,
    STRAIGHT_TANGENT_TYRE,
    brute_force,
    dense,
    eigenvalues,
    ends,
    extreme_gear,
    random_gear,
    refined_maximum_2d,
    rotational,
)

from damperopt import certify, critical_speeds, linear_gear, worst_points

BELOW_GRID = 1e-8
"""[1/s] What the worst point may lie below a grid that also only samples: bounded searches stop at 1e-8 of the speed,
where a smooth peak is flat to its square."""

RELATIVE_EIGENVALUE_ERROR = 1e-12
"""Relative to the largest entry: backward error of `eigvals` times the condition of the eigenvalues of extreme gears."""

SAME_SPEED = 1e-9
"""Relative; a critical speed from polynomial coefficients in two systems of units."""

SAME_EIGENVALUES = 1e-9
"""Relative to the largest eigenvalue; rounding of `eigvals` in two systems of units."""


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
    "contact": "leading_point",
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
        "contact": "leading_point",
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
        "contact": "leading_point",
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
                "contact": "leading_point",
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

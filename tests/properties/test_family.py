"""The linear model as powers of speed and load: gears that make others than today's, and gears that do not keep theirs."""

from types import SimpleNamespace

import casadi as ca
import numpy as np
import pytest
from random_gears import LINEAR_TYRE, dense, rotational
from scipy.optimize import brentq

import damperopt
from damperopt import CertificateError, ConfigError, certify, critical_speeds, linear_gear, worst_points
from damperopt.stability.family import Line, Powers, compound, powers_of
from damperopt.stability.linear import LinearGear, LinearModel

SAME_SPEED = 1e-9
"""Relative; an eigenvalue of a pencil, polished, against a bracketed sign change of the abscissa."""

SAME_SUMS = 1e-10
"""Relative to the largest; sums of two roots against eigenvalues of a matrix of order 10."""


@pytest.fixture(scope="module")
def nose_gear(configs):
    return damperopt.load(configs / "nose_gear_thota.yaml")


def with_spinning_wheel(study, polar_inertia):
    """The linear gear with a wheel that turns: I_z psi'' = ... + h delta', I_x delta'' = ... - h psi', h = I_p V/R_w."""
    plain, gear = linear_gear(study), study.gear

    def matrices(speeds, loads):
        A = plain.matrices(speeds, loads).copy()
        h = polar_inertia * np.broadcast_to(np.asarray(speeds, float), len(A)) / gear.wheel_radius
        A[:, 1, 3] += h / gear.yaw_inertia
        A[:, 3, 1] -= h / gear.lateral.inertia
        return A

    return LinearGear(matrices, plain.states)


def model_with_spinning_wheel(study, polar_inertia):
    """The same for the exact certificate."""
    model, gear = LinearModel(study), study.gear
    design, V, F_z, data = (ca.SX.sym(f"u{i}", *model.state_matrix.size_in(i)) for i in range(4))
    A = model.state_matrix(design, V, F_z, data)
    h = polar_inertia * V / gear.wheel_radius
    A[1, 3] += h / gear.yaw_inertia
    A[3, 1] -= h / gear.lateral.inertia
    model.state_matrix = ca.Function("state_matrix", [design, V, F_z, data], [A])
    return model


@pytest.mark.parametrize(("polar_inertia", "low", "high"), [(2.0, 5.5, 98.8), (10.0, 5.0, 122.9), (30.0, 4.2, 162.1)])
def test_a_spinning_wheel_moves_the_boundaries_and_loses_none(nose_gear, polar_inertia, low, high):
    """Speed enters rows where a gear without a spinning wheel has none; found beside a bracketed abscissa."""
    gear = with_spinning_wheel(nose_gear, polar_inertia)
    found = critical_speeds(gear, 150e3, 2.0, 200.0)
    true = [brentq(lambda V: gear.abscissa(V, 150e3)[0], 0.9 * V, 1.1 * V, xtol=1e-11) for V in (low, high)]
    assert [c.speed for c in found] == pytest.approx(true, rel=SAME_SPEED)
    assert true == pytest.approx([low, high], abs=0.05)
    assert [(c.destabilising, c.boundary, c.touching) for c in found] == [(True, True, False), (False, True, False)]


@pytest.mark.parametrize("polar_inertia", [2.0, 30.0])
def test_worst_point_and_certificate_of_a_spinning_wheel(nose_gear, polar_inertia):
    gear = with_spinning_wheel(nose_gear, polar_inertia)
    worst = worst_points(gear, nose_gear.envelope)[0]
    speeds = dense(2.0, 200.0, 400)
    assert worst.abscissa >= max(gear.abscissa(speeds, load).max() for load in nose_gear.envelope.loads) - 1e-8
    model = model_with_spinning_wheel(nose_gear, polar_inertia)
    first = critical_speeds(gear, 150e3, 2.0, 200.0)[0].speed
    below, beyond = (
        nose_gear.replace(envelope={"speed": {"min": 2.0, "max": first + step}, "vertical_load": 150e3})
        for step in (-1e-6, 1e-6)
    )
    assert certify(below, {}, 0.0, model=model).proved
    assert not certify(beyond, {}, 0.0, model=model).proved


def test_the_gear_with_a_spinning_wheel_is_the_one_built_by_hand(nose_gear):
    """`wheel_polar_inertia` in the study: critical speeds, and a certificate on either side of the first."""
    study = nose_gear.replace(gear__wheel_polar_inertia=10.0, envelope__vertical_load=150e3)
    by_hand = critical_speeds(with_spinning_wheel(nose_gear, 10.0), 150e3, 2.0, 200.0)
    found = critical_speeds(linear_gear(study), 150e3, 2.0, 200.0)
    assert [c.speed for c in found] == pytest.approx([c.speed for c in by_hand], rel=SAME_SPEED)
    first = found[0].speed
    assert certify(study.replace(envelope__speed={"min": 2.0, "max": first - 1e-6}), {}, 0.0).proved
    assert not certify(study.replace(envelope__speed={"min": 2.0, "max": first + 1e-6}), {}, 0.0).proved


@pytest.mark.parametrize("powers", [(-2, -1, 0, 1, 2), (-1, 2), (0, 3), (-3, 0)])
def test_any_powers_of_speed_are_followed(powers):
    """Random matrices: every change of the number of unstable roots on a fine grid lies at a critical speed."""
    rng = np.random.default_rng(3)
    crossings = 0
    for _ in range(4):
        parts = {i: rng.normal(size=(5, 5)) for i in {0, *powers}}

        def matrices(speeds, loads, parts=parts):
            V = np.atleast_1d(speeds)[:, None, None] / 10.0
            return sum(V**i * part for i, part in parts.items())

        gear = LinearGear(matrices, (), Powers(tuple(sorted(parts)), (0,)))
        speeds = np.geomspace(2.0, 50.0, 4000)
        counts = (np.linalg.eigvals(matrices(speeds, 1.0)).real > 0).sum(axis=1)
        expected = np.zeros(len(speeds) - 1)
        for c in critical_speeds(gear, 1.0, 2.0, 50.0):
            assert not c.touching
            expected[np.searchsorted(speeds, c.speed) - 1] += (1 if c.destabilising else -1) * (2 if c.kind == "hopf" else 1)
            crossings += 1
        assert (expected == np.diff(counts)).all()
    assert crossings >= 4


def test_roots_are_found_over_sixteen_decades_of_speed(main_gear):
    """A range that starts near zero has no root at its very end, and none is lost."""
    study = rotational(main_gear)
    gear = linear_gear(study)
    narrow = critical_speeds(gear, 1.5e5, 1.0, 1e3)
    wide = critical_speeds(gear, 1.5e5, 1e-12, 1e4)
    assert [c.speed for c in wide if 1.0 <= c.speed <= 1e3] == pytest.approx([c.speed for c in narrow], rel=SAME_SPEED)
    assert all(c.speed > 1e-3 for c in wide)


def test_eigenvalues_of_the_compound_are_the_sums_of_two():
    rng = np.random.default_rng(4)
    for n in (2, 3, 5, 7):
        A = rng.normal(size=(n, n)) * 10.0 ** rng.uniform(-2, 2, size=n)
        s = np.linalg.eigvals(A)
        sums = np.sort_complex([s[i] + s[j] for i in range(n) for j in range(i)])
        found = np.sort_complex(np.linalg.eigvals(compound(A)))
        assert np.abs(found[:, None] - sums).min(axis=1).max() <= SAME_SUMS * np.abs(sums).max()


# powers are declared


def test_powers_are_those_of_all_components():
    plain, spinning = SimpleNamespace(), SimpleNamespace(SPEED_POWERS=(-1, 0, 1, 2))
    soft = SimpleNamespace(LOAD_POWERS=(0, 1, 2))
    tabulated = SimpleNamespace(LOAD_POWERS=None)

    def study(gear=plain, tyre=plain, damper=plain):
        return SimpleNamespace(gear=gear, tyre=tyre, damper=SimpleNamespace(**vars(damper), actuator=None))

    assert powers_of(study()) == Powers((-1, 0, 1), (0, 1))
    assert powers_of(study(gear=spinning, tyre=soft)) == Powers((-1, 0, 1, 2), (0, 1, 2))
    assert powers_of(study(tyre=tabulated, damper=soft)) == Powers((-1, 0, 1), None)
    assert powers_of(study(tyre=SimpleNamespace(contact=spinning, LOAD_POWERS=None))) == Powers((-1, 0, 1, 2), None)


def test_a_gear_that_does_not_keep_its_powers_is_refused(nose_gear):
    """Drag that grows with the square of speed, undeclared: nothing may be said about a range of speeds."""
    plain = linear_gear(nose_gear)

    def matrices(speeds, loads):
        A = plain.matrices(speeds, loads).copy()
        A[:, 1, 1] -= 1e-6 * np.broadcast_to(np.asarray(speeds, float), len(A)) ** 2
        return A

    gear = LinearGear(matrices, plain.states)
    with pytest.raises(ConfigError, match="no combination of the powers -1, 0, 1 of the speed"):
        critical_speeds(gear, 1.5e5, 5.0, 100.0)
    declared = LinearGear(matrices, plain.states, Powers((-1, 0, 1, 2)))
    assert len(critical_speeds(declared, 1.5e5, 5.0, 100.0)) == 2


@pytest.mark.parametrize("powers", [Powers((0, 1), (0, 1)), Powers((-1, 0, 1), (0,))])
def test_a_certificate_is_refused_where_powers_are_not_kept(main_gear, powers):
    study = rotational(main_gear, damping=2000.0)
    model = LinearModel(study)
    model.powers = powers
    with pytest.raises(CertificateError, match="no combination of the powers"):
        certify(study, {}, model=model)


@pytest.mark.parametrize("load", [1.5e5, (5e4, 1.5e5)])
@pytest.mark.parametrize("damping", [300.0, 2000.0])
def test_powers_that_do_not_occur_change_no_verdict(main_gear, load, damping):
    study = rotational(main_gear, damping=damping, load=load)
    plain, model = certify(study, {}), LinearModel(study)
    model.powers = Powers((-2, -1, 0, 1, 2), (-1, 0, 1, 2))
    generous = certify(study, {}, model=model)
    assert generous.proved == plain.proved
    assert generous.counterexample == pytest.approx(plain.counterexample) if plain.counterexample else generous.proved


# tyres that are no polynomial in the load


def model_with_tabulated_tyre(study):
    """Slopes of the tyre times sqrt(F_z): no polynomial in the load."""
    model = LinearModel(study)
    design, V, F_z, data = (ca.SX.sym(f"u{i}", *model.state_matrix.size_in(i)) for i in range(4))
    A = model.state_matrix(design, V, F_z, data)
    A[1, 4] = -13.0 * ca.sqrt(F_z)
    model.state_matrix = ca.Function("state_matrix", [design, V, F_z, data], [A])
    model.powers = Powers(load=None)
    return model


def test_without_polynomial_in_the_load_each_load_is_proved_and_a_range_by_slices(main_gear):
    listed = rotational(main_gear, damping=2000.0, load=[5e4, 1.5e5], tyre=LINEAR_TYRE)
    model = model_with_tabulated_tyre(listed)
    gear = model.at({})
    worst = worst_points(gear, listed.envelope)[0]
    kept, missed = (certify(listed, {}, max(-worst.abscissa - reserve, 0.0), model=model) for reserve in (1e-6, -1e-6))
    assert kept.proved
    assert not missed.proved
    for load in (5e4, 1.5e5):
        assert critical_speeds(gear, load, 5.0, 100.0) == []

    ranged = rotational(main_gear, damping=2000.0, load=(5e4, 1.5e5))
    top = max(gear.abscissa(dense(5.0, 100.0, 100), load).max() for load in np.linspace(5e4, 1.5e5, 21))
    assert worst_points(gear, ranged.envelope)[0].abscissa >= top - 1e-6
    kept, missed = (certify(ranged, {}, part * -top, model=model) for part in (0.9, 1.001))
    assert (kept.verdict, missed.verdict) == ("proved", "refuted")
    assert gear.abscissa(*missed.counterexample)[0] > 1.001 * top


def test_a_line_of_one_value_has_no_crossing_elsewhere(main_gear):
    gear = linear_gear(rotational(main_gear))
    line = Line(lambda V: gear.matrices(V, 1.5e5), (-1, 0, 1), 17.0, 17.0, "speed")
    assert line.crossings(0.0).size == 0

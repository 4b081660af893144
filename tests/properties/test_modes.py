"""Modes followed over speed: the same set of eigenvalues, the right names, whatever the grid."""

import numpy as np
import pytest
from random_gears import (
    eigenvalues,
    ends,
    random_gear,
    rotational,
)

from damperopt import linear_gear, track_modes

SAME_EIGENVALUES = 1e-9
"""Relative to the largest eigenvalue; rounding of `eigvals` in two systems of units."""


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

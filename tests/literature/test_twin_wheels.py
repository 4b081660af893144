"""Two wheels: eigenvalues of an independent prototype, and limits that are other gears."""

from __future__ import annotations

import numpy as np
import pytest
from table_gear import TYRE, assert_printed, eigenvalues, table_gear

from damperopt import ConfigError, certify, loads, simulate, simulate_exactly
from damperopt.stability.linear import linear_gear

AXLE = {
    "half_track": 0.45,
    "slip_stiffness": 1.2e6,
    "longitudinal_relaxation": 0.25,
    "vertical_stiffness": 1.5e6,
}
HALF = {**TYRE, "tread_width_moment": 285.0}
"""Of one tyre; both together have that of the single one."""


def twin(kind="twin", axle=AXLE, **gear):
    return table_gear(tyre=HALF, kind=kind, axle=axle, **gear)


def test_common_axle():
    printed = [0.206929 + 105.289j, -60.0458 + 122.678j, -46.8886, -130.41]
    assert_printed(eigenvalues(twin(wheel_polar_inertia=6.0), 40.0), printed)
    printed = [-0.360622 + 105.954j, -59.4438 + 121.6j, -47.2578, -130.109]
    assert_printed(eigenvalues(twin(), 40.0), printed)


def test_independent_wheels():
    printed = [1.88306 + 65.5853j, -0.976984 + 105.207j, -79.7413 + 344.179j, -139.305]
    assert_printed(eigenvalues(twin("twin_independent", wheel_polar_inertia=6.0), 40.0), printed)


def test_two_strings_differ_as_one_that_nothing_moves():
    """The one eigenvalue that the prototype, with one string for both, does not have: -V/sigma."""
    found = eigenvalues(twin(), 40.0)
    assert min(abs(value + 40.0 / 0.3) for value in found) < 1e-9


def test_wheels_that_turn_together_are_a_common_axle():
    """k_co to infinity: what is left of the difference of spins is a fast mode."""
    common = eigenvalues(twin(wheel_polar_inertia=6.0), 40.0)
    for k_co, part in ((1e7, 1e-2), (1e9, 1e-4)):
        found = eigenvalues(twin("twin_independent", wheel_polar_inertia=6.0, corotation=k_co), 40.0)
        slow = [value for value in found if abs(value) < 1e5]
        np.testing.assert_allclose(slow, common, rtol=part)


def test_two_wheels_without_track_are_one():
    axle = {**AXLE, "half_track": 0.0}
    found = [value for value in eigenvalues(twin(axle=axle), 40.0) if min(abs(value + 40 / s) for s in (0.3, 0.25)) > 1e-9]
    np.testing.assert_allclose(found, eigenvalues(table_gear(), 40.0), rtol=1e-12)


@pytest.mark.parametrize("rake", [0.0, 0.1571])
def test_without_lag_the_axle_is_a_tread_width_moment(rake):
    """sigma_x to 0: kappa = 2 C_kappa t_w^2, but for a factor cos(phi) with rake, since the moment turns about the vertical."""
    axle = {**AXLE, "axle_roll": False, "longitudinal_relaxation": 1e-6}
    found = [value for value in eigenvalues(twin(axle=axle, rake_angle=rake), 40.0) if abs(value) < 1e6]
    more = 2 * AXLE["slip_stiffness"] * AXLE["half_track"] ** 2 * np.cos(rake)
    one = table_gear(tyre={**TYRE, "tread_width_moment": 570.0 + more}, rake_angle=rake)
    expected = eigenvalues(one, 40.0)
    found = [value for value in found if abs(value + 40 / 0.3) > 1e-6]
    np.testing.assert_allclose(found, expected, rtol=1e-4)


def test_axle_that_does_not_roll_leaves_the_stiffness_of_bending():
    rolls, stiff = twin(), twin(axle={**AXLE, "axle_roll": False})
    at_rest = [linear_gear(study).matrices(40.0, 150e3)[0] for study in (rolls, stiff)]
    row, column = 3, 2
    change = 600.0 * (at_rest[1] - at_rest[0])
    assert change[row, column] == pytest.approx(2 * 1.5e6 * 0.45**2)
    change[row, column] = 0.0
    assert not change.any()


def test_tyres_and_spins_keep_energy():
    """Energy of the gear, of the deflected tyres and of the spins stays what it was without dampers and slip.

    At a walking pace over a long relaxation, V/sigma_x is small.
    """
    none = {**HALF, "cornering_slope": 0.0, "aligning_coefficient": 0.0, "tread_width_moment": 0.0}
    lateral = {"inertia": 600.0, "stiffness": 6.1e6, "damping": 0.0, "height": 2.5}
    axle = {**AXLE, "longitudinal_relaxation": 1e2, "slip_stiffness": 4.8e8}
    study = table_gear(
        3.8e5, 0.0, none, kind="twin_independent", axle=axle, wheel_polar_inertia=6.0, lateral=lateral, caster_length=0.0
    )
    motion = simulate_exactly(study, speed=1e-3, disturbance={"release": {"yaw_angle": 0.01}}, duration=0.2)
    x = {name: np.asarray(values) for name, values in motion.states.items()}
    energy = 100 * x["yaw_rate"] ** 2 / 2 + 3.8e5 * x["yaw_angle"] ** 2 / 2
    energy += 600 * x["bending_rate"] ** 2 / 2 + (6.1e6 + 2 * 1.5e6 * 0.45**2) * x["bending_angle"] ** 2 / 2
    energy += 2 * (4.8e6 * x["fore_aft_deflection"] ** 2 / 2 + 6.0 * x["spin_difference"] ** 2 / 2)
    assert np.ptp(x["spin_difference"]) > 0.1
    np.testing.assert_allclose(energy, energy[0], rtol=1e-6)


def test_slip_of_either_wheel_ends_a_simulation():
    study = twin().replace(tyre__slip_range=0.01)
    for run in (simulate, simulate_exactly):
        motion = run(study, speed=40.0, disturbance={"release": {"yaw_angle": 0.05}}, duration=0.5)
        assert motion.status == "stopped"
        assert "slip_range" in motion.message


UNEQUAL = """
name: one soft tyre
gear: {{kind: twin, yaw_inertia: 100, caster_length: 0.12, wheel_radius: 0.362, axle: {{{axle}}},
       lateral: {{inertia: 600, stiffness: 6.1e6, damping: 300, height: 2.5}}}}
tyre: {{size: 49x17, type: VII, rated_pressure: 170 psi, contact: {contact}}}
damper: {{topology: rotational, torsional_stiffness: 3.8e5, torsional_damping: 3000}}
envelope: {{speed: {{min: 20 m/s, max: 60 m/s}}, vertical_load: 250 kN}}
"""
TRACK = "half_track: 0.45, slip_stiffness: 1.2e6, longitudinal_relaxation: 0.25, vertical_stiffness: 1.5e6"
SOFT = f"{TRACK}, left_share: 0.6, left_pressure: 180 psi, right_pressure: 100 psi"


def unequal(axle, contact="leading_point"):
    return loads(UNEQUAL.format(axle=axle, contact=contact))


def test_tyres_of_different_pressure_and_load():
    """Two strings of their own lengths, by a matrix written out; the numbers of either tyre alone are those of its law."""
    study, V, e, l, t_w = unequal(SOFT), 40.0, 0.12, 2.5, 0.45
    A = np.zeros((7, 7))
    A[0, 1] = A[2, 3] = 1
    A[1, :2] = -3.8e5 / 100, -3000 / 100
    A[3, [0, 2, 3]] = 250e3 * e / 600, -(6.1e6 + 2 * 1.5e6 * t_w**2) / 600, -300 / 600
    A[1, 6] = -2 * 1.2e6 / 0.25 * t_w / 100
    A[6, [1, 6]] = t_w, -V / 0.25
    for k, (share, psi) in enumerate(((0.6, 180.0), (0.4, 100.0))):
        C_Fa, C_Ma, sigma, a = study.tyre.linear(share * 250e3, psi * 6894.757293168)
        A[1, 4 + k] = -(e * C_Fa + C_Ma) / sigma / 100
        A[3, 4 + k] = -l * C_Fa / sigma / 600
        A[4 + k, [0, 1, 3, 4 + k]] = V, e - a, l, -V / sigma
    found = linear_gear(study).roots(V, 250e3)[0]
    np.testing.assert_allclose(np.sort_complex(found), np.sort_complex(np.linalg.eigvals(A)), rtol=1e-9)
    assert abs(found[0] - linear_gear(unequal(TRACK)).roots(V, 250e3)[0, 0]) > 0.05
    assert certify(study, {}, margin=0.1).proved
    left_open = certify(unequal(SOFT, "memory"), {}, margin=0.1)
    assert left_open.verdict == "undecided"
    assert "unlike tyres" in left_open.reason


def test_equal_pressures_are_that_of_the_tyre():
    same = unequal(f"{TRACK}, left_share: 0.5, left_pressure: 170 psi, right_pressure: 170 psi", "memory")
    one, other = (linear_gear(study).roots(40.0, 250e3, 4) for study in (same, unequal(TRACK, "memory")))
    np.testing.assert_allclose(one, other, rtol=1e-12)


def test_pressures_are_refused_where_they_mean_nothing():
    with pytest.raises(ConfigError, match=r"gear\.axle\.right_pressure: .*of the rated pressure"):
        unequal(f"{TRACK}, right_pressure: 20 psi")
    text = UNEQUAL.format(axle=f"{TRACK}, left_pressure: 1 MPa", contact="leading_point")
    law = "law: brush, half_contact_length: 0.1, relaxation_length: 0.3, cornering_stiffness: 4e5, friction: 0.7"
    with pytest.raises(ConfigError, match=r"gear\.axle\.left_pressure: .*'brush' has no part for"):
        loads(text.replace("size: 49x17, type: VII, rated_pressure: 170 psi", law))

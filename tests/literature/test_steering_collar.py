"""A steering collar in series: eigenvalues of an independent prototype, and limits that are other gears."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import eigvals
from table_gear import CARCASS, TYRE, assert_printed, eigenvalues, table_gear

from damperopt import ConfigError, loads, simulate_exactly
from damperopt.stability.linear import linear_gear

K_T, K_S, I_S = 5e5, 1.5e6, 5.0


def collar(k_s=K_S, c_s=2000.0, tyre=TYRE, **gear):
    """With the damper of the study in the steering."""
    block = {
        "inertia": I_S,
        "damper_at": "steering",
        "link_stiffness": K_T,
        "steering_stiffness": 0.0,
        "steering_damping": 0.0,
        "swivel_damping": 300.0,
    }
    return table_gear(k_s, c_s, tyre, kind="seventh", collar=block, **gear)


def at_the_links(k_s=K_S, c_s=2000.0):
    """The same gear with the linkage of the study between piston and collar."""
    block = {"inertia": I_S, "steering_stiffness": k_s, "steering_damping": c_s, "swivel_damping": 300.0}
    return table_gear(K_T, 0.0, kind="seventh", collar=block)


def test_eigenvalues():
    assert collar().gear.order == 7
    printed = [1.65557 + 70.3613j, -0.279581 + 100.875j, -140.989, -199.369 + 600.84j]
    assert_printed(eigenvalues(collar(), 40.0), printed)
    printed = [0.706051 + 63.2688j, -33.4249 + 142.795j, -72.7992, -199.369 + 600.841j]
    assert_printed(eigenvalues(collar(tyre=CARCASS), 40.0), printed)


@pytest.mark.parametrize(
    ("c_s", "printed"),
    [(1e4, -0.484285 + 71.2628j), (2.5e4, -2.03949 + 74.2434j), (1e5, 0.194889 + 77.9902j), (1e6, 1.84608 + 78.4833j)],
)
def test_more_damping_destroys_stability(c_s, printed):
    assert_printed(eigenvalues(collar(c_s=c_s), 40.0), [printed])


def test_linkage_at_either_place_is_one_gear():
    one, other = (linear_gear(study).matrices([7.0, 90.0], 150e3) for study in (collar(), at_the_links()))
    np.testing.assert_allclose(one, other, rtol=1e-14)


def test_steering_that_cannot_turn_is_fifth_order():
    """k_s to infinity; what is left of the collar is a fast mode."""
    fifth = eigenvalues(table_gear(stiffness=K_T), 40.0)
    for k_s, part in ((1e10, 1e-4), (1e12, 1e-6)):
        slow = [value for value in eigenvalues(at_the_links(k_s), 40.0) if abs(value) < 1e4]
        assert len(slow) == len(fifth)
        for value, expected in zip(slow, fifth, strict=True):
            assert abs(value - expected) < part * abs(expected)


def test_steering_without_inertia_is_two_springs_in_series():
    """I_s to 0 without damping: k = k_t k_s/(k_t + k_s)."""
    block = {"inertia": 1e-6, "steering_stiffness": K_S, "steering_damping": 0.0, "swivel_damping": 300.0}
    found = eigenvalues(table_gear(K_T, 0.0, kind="seventh", collar=block), 40.0)
    expected = eigenvalues(table_gear(K_T * K_S / (K_T + K_S)), 40.0)
    slow = [value for value in found if abs(value) < 1e4]
    np.testing.assert_allclose(slow, expected, rtol=1e-6)


def test_free_castering_against_matrices_written_out():
    """k_s = 0: M q'' + C q' + K q = B y for q = (psi, chi, delta), by hand, as one pencil with the string."""
    V, F, e, l, sigma, a = 40.0, 150e3, 0.12, 2.5, 0.3, 0.1
    slope, C_M, kappa, c_s = 0.014, 1.0, 570.0, 2000.0
    M = np.diag([100.0, I_S, 600.0])
    C = np.diag([300.0 + kappa / V, c_s, 300.0])
    K = np.array([[K_T, -K_T, 0.0], [-K_T, K_T, 0.0], [-F * e, 0.0, 6.1e6]])
    B = -F / sigma * np.array([[e * slope + C_M], [0.0], [l * slope]])
    Z, one = np.zeros((3, 3)), np.eye(3)
    left = np.block([[one, Z, np.zeros((3, 1))], [Z, M, np.zeros((3, 1))], [np.zeros((1, 6)), np.ones((1, 1))]])
    string = np.array([[V, 0.0, 0.0, e - a, 0.0, l, -V / sigma]])
    right = np.vstack([np.hstack([Z, one, np.zeros((3, 1))]), np.hstack([-K, -C, B]), string])
    expected = eigvals(right, left)
    expected = sorted(expected[expected.imag >= 0], key=lambda value: -value.real)
    np.testing.assert_allclose(eigenvalues(collar(k_s=0.0), 40.0), expected, rtol=1e-9)


def test_free_castering_stays_where_it_was_turned_without_a_tyre():
    """No torque turns it back: after a slow kick it comes to rest at another angle, chi = psi."""
    none = {**TYRE, "cornering_slope": 0.0, "aligning_coefficient": 0.0, "tread_width_moment": 0.0}
    study = collar(k_s=0.0, tyre=none, caster_length=0.0)
    motion = simulate_exactly(study, speed=40.0, disturbance={"kick": {"yaw_rate": 0.1}}, duration=1.0, points=11)
    # momentum I_z 0.1 is lost to both dampers: c_0 psi + c_s chi = 10 N m s at the end
    end = 100.0 * 0.1 / (300.0 + 2000.0)
    assert motion["yaw_angle"][-1] == pytest.approx(end, rel=2e-2)
    assert motion["collar_angle"][-1] == pytest.approx(motion["yaw_angle"][-1], rel=2e-2)


def test_gyroscopic_moments_do_no_work():
    with_spin, without = (
        linear_gear(study).matrices([20.0, 80.0], 150e3) for study in (collar(wheel_polar_inertia=6.0), collar())
    )
    change = np.diag([0, 100.0, 0, 600.0, 0, I_S, 0]) @ (with_spin - without)
    assert np.abs(change).max() > 0
    np.testing.assert_allclose(change + change.transpose(0, 2, 1), 0.0, atol=1e-9 * np.abs(change).max())


def test_piston_that_nothing_holds_is_refused(configs):
    text = (configs / "nose_gear_somieski.yaml").read_text(encoding="utf-8")
    block = "collar: {inertia: 1 kg m^2, damper_at: steering, steering_stiffness: 0 N m/rad, steering_damping: 0 N m s/rad}"
    lateral = "lateral: {inertia: 10 kg m^2, stiffness: 1e5 N m/rad, damping: 1 N m s/rad, height: 1 m}"
    text = text.replace("  order: 3\n", f"  kind: seventh\n  {block}\n  {lateral}\n")
    with pytest.raises(ConfigError, match=r"gear\.collar\.link_stiffness: nothing holds the piston; allowed: a stiffness > 0"):
        loads(text)

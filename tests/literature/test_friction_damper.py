"""Dry friction as the damper: closed forms, what sticks, Dahl's loop, and a castering gear that only friction holds."""

from __future__ import annotations

import numpy as np
import pytest
from components_of import damper_of
from table_gear import GEAR, TYRE, table_gear

from damperopt import ConfigError, Disturbance, Study, least_breakout, simulate, simulate_exactly
from damperopt.dampers.base import Context
from damperopt.stability.linear import linear_gear

NONE = {**TYRE, "cornering_slope": 0.0, "aligning_coefficient": 0.0, "tread_width_moment": 0.0}
K, INERTIA = 1e5, 100.0


def gear(tyre=NONE, gear=None, **damper):
    block = {"topology": "rotational", "torsional_stiffness": K, "kind": "friction", **damper}
    base = table_gear(tyre=tyre).model_dump(exclude_none=True)
    yaw = {name: GEAR[name] for name in ("yaw_inertia", "caster_length", "wheel_radius")} | {"kind": "yaw"}
    return Study.model_validate({**base, "damper": block, "gear": yaw | (gear or {})})


def coulomb(t, start, torque):
    """Angle of I psi'' = -k psi - T sign(psi'), released from `start` > 0, until it sticks."""
    omega, shift, angle = np.sqrt(K / INERTIA), torque / K, start
    while abs(angle) > shift:
        side = np.sign(angle)
        if t < np.pi / omega:
            return side * shift + (angle - side * shift) * np.cos(omega * t)
        t, angle = t - np.pi / omega, 2 * side * shift - angle
    return angle


RELEASE = {"release": {"yaw_angle": 0.1}}


@pytest.mark.parametrize(
    ("keys", "torque"),
    [
        ({"breakout_torque": 1e3}, 1e3),
        ({"breakout_force": 5e3, "breakout_lever": 0.12}, 600.0),
        ({"breakout_torque": 400.0, "load_lever": 4e-3}, 1000.0),
    ],
)
def test_motion_is_the_closed_form_and_sticks(keys, torque):
    found = simulate_exactly(gear(**keys), speed=30.0, disturbance=RELEASE, duration=1.5, points=401)
    expected = [coulomb(t, 0.1, torque) for t in found.time]
    np.testing.assert_allclose(found["yaw_angle"], expected, rtol=0, atol=1e-8)
    assert found["yaw_rate"][-1] == 0.0


def test_frictions_of_strut_and_damper_add_up():
    study = gear(breakout_torque=600.0, gear={"friction": {"torque": 400.0}})
    found = simulate_exactly(study, speed=30.0, disturbance=RELEASE, duration=1.5, points=401)
    np.testing.assert_allclose(found["yaw_angle"], [coulomb(t, 0.1, 1e3) for t in found.time], rtol=0, atol=1e-8)
    held = simulate_exactly(study, speed=30.0, disturbance={"step": {"yaw_torque": 999.0}}, duration=0.3, points=50)
    assert not held["yaw_angle"].any()


def test_friction_at_two_places_is_refused_by_the_exact_simulation():
    lateral = GEAR["lateral"]
    collar = {"inertia": 5.0, "steering_stiffness": 1e6, "steering_damping": 0.0}
    keys = {"kind": "seventh", "collar": collar, "lateral": lateral, "friction": {"torque": 400.0}}
    with pytest.raises(ConfigError, match="friction of strut and damper at two places"):
        simulate_exactly(gear(breakout_torque=600.0, gear=keys), speed=30.0, disturbance=RELEASE, duration=0.1)


def test_collar_sticks_to_the_piston():
    """Friction between piston and collar that holds: both turn as one, I_z + I_s on k_s."""
    collar = {"inertia": 5.0, "steering_stiffness": 1e6, "steering_damping": 0.0}
    keys = {"kind": "seventh", "collar": collar, "lateral": {**GEAR["lateral"], "damping": 0.0}, "caster_length": 0.0}
    study = gear(breakout_torque=1e6, torsional_stiffness=0.0, gear=keys)
    # kicked, the piston first drags the collar along until both have one rate
    found = simulate_exactly(study, speed=30.0, disturbance={"kick": {"yaw_rate": 1.0}}, duration=0.2, points=2001)
    stuck = found.time > 0.01
    slip = found["yaw_rate"] - found["collar_rate"]
    np.testing.assert_allclose(slip[stuck], 0.0, atol=1e-10)
    psi, t = found["collar_angle"][stuck], found.time[stuck]
    omega = np.sqrt(1e6 / 105.0)
    basis = np.column_stack([np.cos(omega * t), np.sin(omega * t)])
    fit, *_ = np.linalg.lstsq(basis, psi, rcond=None)
    np.testing.assert_allclose(basis @ fit, psi, rtol=0, atol=1e-7 * np.abs(psi).max())


def test_smooth_version_goes_to_the_exact_one():
    exact = simulate_exactly(gear(breakout_torque=1e3), speed=30.0, disturbance=RELEASE, duration=0.3, points=101)
    errors = []
    for width in (1e-2, 1e-3, 1e-4):
        smooth = simulate(gear(breakout_torque=1e3, smoothing=width), speed=30.0, disturbance=RELEASE, duration=0.3)
        error = np.interp(exact.time, smooth.time, smooth["yaw_angle"]) - exact["yaw_angle"]
        errors.append(np.abs(error).max())
    assert errors[2] < errors[0]
    assert errors[2] < 1e-3 * 0.1


def test_loop_of_dahl():
    """F_c 200, sigma_0 2e5, X .002, omega 70: 942.17218 N s/m and 84 559 N/m, where Coulomb's has 1818.91."""
    dahl = damper_of(
        topology="rotational", torsional_stiffness=0.0, kind="dahl", breakout_torque=200.0, presliding_stiffness=2e5
    )
    stiffness, damping = dahl.equivalent({}, 2e-3, 70.0, Context())
    assert damping == pytest.approx(942.17218, rel=1e-8)
    assert stiffness == pytest.approx(84559, rel=1e-5)
    dry = damper_of(topology="rotational", torsional_stiffness=0.0, kind="friction", breakout_torque=200.0)
    assert dry.equivalent({}, 2e-3, 70.0, Context())[1] == pytest.approx(1818.91, rel=1e-5)
    assert dahl.equivalent({}, 2.0, 70.0, Context())[1] == pytest.approx(dry.equivalent({}, 2.0, 70.0, Context())[1], rel=1e-3)


def test_stiff_dahl_is_coulomb():
    exact = simulate_exactly(gear(breakout_torque=1e3), speed=30.0, disturbance=RELEASE, duration=0.3, points=101)
    errors = []
    for stiffness in (1e6, 1e7, 1e8):
        study = gear(kind="dahl", breakout_torque=1e3, presliding_stiffness=stiffness)
        found = simulate_exactly(study, speed=30.0, disturbance=RELEASE, duration=0.3, points=101)
        errors.append(np.abs(found["yaw_angle"] - exact["yaw_angle"]).max())
    assert errors[2] < 0.4 * errors[1] < 0.16 * errors[0]  # by the root of the stiffness


def test_linear_model_has_the_viscous_part_or_the_spring():
    viscous = gear(breakout_torque=1e3, viscous_damping=50.0)
    same = gear(kind="torsional", torsional_damping=50.0)
    np.testing.assert_array_equal(*(linear_gear(study).matrices(30.0, 150e3) for study in (viscous, same)))
    dahl = linear_gear(gear(kind="dahl", breakout_torque=1e3, presliding_stiffness=2e4)).matrices(30.0, 150e3)[0]
    found = np.linalg.eigvals(dahl)
    assert np.abs(found.imag).max() == pytest.approx(np.sqrt((K + 2e4) / INERTIA), rel=1e-6)


def test_a_castering_gear_is_held_up_to_a_kick_and_not_beyond():
    """Unstable without friction: a small kick ends at rest, a large one grows; the border rises with the breakout torque."""
    tyre = {**TYRE, "cornering_slope": 8.0, "aligning_coefficient": 0.3, "tread_width_moment": 0.0}
    base = {"kind": "yaw", "yaw_inertia": 0.3, "caster_length": 0.08, "wheel_radius": 0.15}

    def grows(torque, kick):
        study = gear({**tyre, "half_contact_length": 0.05, "relaxation_length": 0.15}, base, breakout_torque=torque)
        study = study.replace(damper__torsional_stiffness=0.0, envelope__vertical_load=1500.0)
        motion = simulate_exactly(study, speed=15.0, disturbance={"kick": {"yaw_rate": kick}}, duration=1.0)
        if motion.status == "stopped":
            return True
        assert not motion["yaw_rate"][-100:].any()
        return False

    assert not grows(10.0, 0.5)
    assert grows(10.0, 5.0)
    assert not grows(40.0, 5.0)


@pytest.mark.parametrize(
    "keys", [{}, {"breakout_torque": 1.0, "breakout_force": 1.0}, {"breakout_torque": 1.0, "breakout_lever": 0.1}]
)
def test_breakout_is_said_in_one_way(keys):
    with pytest.raises(ValueError, match="incomplete or double breakout"):
        gear(**keys)


@pytest.mark.parametrize(
    ("said", "torque"),
    [("25 lbf at the axle", 25 * 4.4482216152605 * 0.12), ("100 N at 0.2 m", 20.0), ("30 N m", 30.0), (7.0, 7.0)],
)
def test_breakout_as_builders_say_it(said, torque):
    """The axle of this gear stands 0.12 m behind the axis."""
    motion = simulate_exactly(gear(breakout=said), speed=30.0, disturbance={"kick": {"yaw_rate": 1.0}}, duration=0.01)
    assert np.abs(motion["friction_torque"]).max() == pytest.approx(torque, rel=1e-12)


def test_play_and_stop_about_the_yaw_axis():
    """Free of all else, I psi'' = -k (|psi| - g) beyond the play and the stop's k_s beyond the stop: periods in closed form."""
    play, stop, k_s = 0.002, 0.02, 3e6
    study = gear(
        kind="torsional",
        torsional_damping=0.0,
        freeplay={"gap": play},
        end_stop={"stroke": stop, "stiffness": k_s},
    )
    rate = 0.01 * np.sqrt(K / INERTIA)  # stays short of the stop: a quarter is play/rate and a quarter of a sine
    motion = simulate_exactly(study, speed=30.0, disturbance={"kick": {"yaw_rate": rate}}, duration=1.0, points=4001)
    half = 2 * play / rate + np.pi * np.sqrt(INERTIA / K)
    turns = motion.time[:-1][motion["yaw_angle"][:-1] * motion["yaw_angle"][1:] < 0]
    np.testing.assert_allclose(np.diff(turns), half, atol=1e-3)
    assert np.abs(motion["yaw_angle"]).max() == pytest.approx(play + 0.01, rel=1e-3)
    assert np.abs(motion["stop_torque"]).max() < 1e-9  # rounding of its dead band
    fast = 0.05 * np.sqrt(K / INERTIA)
    met = simulate_exactly(study, speed=30.0, disturbance={"kick": {"yaw_rate": fast}}, duration=0.1, points=4001)
    beyond = np.abs(met["yaw_angle"]).max() - play  # energy: I w^2/2 = K x^2/2 + k_s (x - s)^2/2
    assert 0.5 * K * beyond**2 + 0.5 * k_s * (beyond - stop) ** 2 == pytest.approx(0.5 * INERTIA * fast**2, rel=1e-3)
    hard = study.replace(damper__end_stop__stiffness=None)
    ended = simulate_exactly(hard, speed=30.0, disturbance={"kick": {"yaw_rate": fast}}, duration=0.1)
    assert "the damper meets its stop at 1.146 deg" in ended.message


def test_least_breakout_for_a_kick():
    """The border of the test above: what is found holds, a twentieth less does not."""
    tyre = {**TYRE, "cornering_slope": 8.0, "aligning_coefficient": 0.3, "tread_width_moment": 0.0}
    base = {"kind": "yaw", "yaw_inertia": 0.3, "caster_length": 0.08, "wheel_radius": 0.15}
    study = gear({**tyre, "half_contact_length": 0.05, "relaxation_length": 0.15}, base, breakout_torque=10.0)
    study = study.replace(damper__torsional_stiffness=0.0, envelope__vertical_load=1500.0, envelope__speed__max=40.0)
    kick = Disturbance.model_validate({"kick": {"yaw_rate": 3.0}})
    found = least_breakout(study, kick, [8.0, 15.0], 1500.0, 1.0)
    for part, rests in ((1.0, True), (0.96, False)):
        own = study.replace(damper__breakout_torque=part * found.torque)
        moving = [
            simulate_exactly(own, speed=V, disturbance=kick, duration=1.0, points=400)["yaw_rate"][-20:].any()
            for V in (8.0, 15.0)
        ]
        assert (not any(moving)) == rests
    with pytest.raises(ConfigError, match=r"damper.kind: found 'torsional'; allowed: friction"):
        least_breakout(gear(kind="torsional", torsional_damping=1.0), kick, [8.0], 1500.0, 1.0)

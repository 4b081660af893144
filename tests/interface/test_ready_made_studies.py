"""The studies of the page about gears and dampers show what it says."""

import numpy as np
import pytest

import damperopt
from damperopt.motion.breakout import comes_to_rest, least_breakout, with_breakout
from damperopt.stability.linear import LinearModel
from damperopt.study.disturbances import Disturbance


@pytest.fixture
def study(configs, request):
    return damperopt.load(configs / f"{request.param}.yaml")


def worst(study, design, load):
    low, high = study.envelope.speed.min, study.envelope.speed.max
    speeds = np.linspace(low, high, 400)
    abscissa = LinearModel(study).at(design).abscissa(speeds, load)
    return abscissa.max(), speeds[abscissa.argmax()]


@pytest.mark.parametrize("study", ["nose_gear_steered"], indirect=True)
def test_damping_in_the_steering_has_an_upper_limit(study):
    for damping, abscissa, speed in ((1.0, 2.8, 37.0), (1e5, 2.8, 90.0)):
        found = worst(study, {"c_vane": damping}, 30e3)
        assert found[0] == pytest.approx(abscissa, abs=0.05)
        assert found[1] == pytest.approx(speed, abs=1.0)
    result = damperopt.optimise(study)
    assert result.status == "solved"
    assert result.certificate.proved
    assert result.design["c_vane"] == pytest.approx(258, abs=1)
    assert result.mass.total == pytest.approx(4.59, abs=0.01)
    assert worst(study, result.design, 30e3)[0] == pytest.approx(-1.0, abs=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("study", ["main_gear_twin"], indirect=True)
def test_a_common_axle_needs_hardly_a_damper(study):
    alone = damperopt.optimise(study)
    block = study.model_dump(exclude_none=True)
    block["gear"] = {**block["gear"], "kind": "twin"}
    block["gear"].pop("corotation")
    together = damperopt.optimise(damperopt.Study.model_validate(block))
    assert alone.certificate.proved
    assert together.certificate.proved
    assert alone.design["c_lambda"] == pytest.approx(1201, abs=10)
    assert together.design["c_lambda"] == pytest.approx(10, rel=1e-4)


@pytest.mark.parametrize("study", ["nose_wheel_castering"], indirect=True)
def test_friction_holds_kicks_up_to_a_border(study):
    abscissa, speed = worst(study, {}, 1.3e3)
    assert abscissa == pytest.approx(8.66, abs=0.02)
    assert speed == pytest.approx(11.8, abs=0.2)
    kick, release = ({"kick": {"yaw_rate": 2.0}}, {"release": {"yaw_angle": np.radians(5.0)}})
    for pressure, disturbance, speed, torque in ((20, kick, 13.8, 9.64), (31, release, 9.4, 20.6)):
        at = study.replace(tyre__pressure=f"{pressure} psi")
        asked = Disturbance.model_validate(disturbance)
        for part, rests in ((0.9, False), (1.02, True)):
            own = with_breakout(at, part * torque)
            assert comes_to_rest(own, speed, 1.3e3, asked, 2.0) == rests, (pressure, part)


@pytest.mark.parametrize("study", ["nose_wheel_castering"], indirect=True)
def test_least_breakout_against_a_search_of_its_own(study):
    """Where one speed alone is looked at, it lies within 3 % above the largest of a row that does not rest."""
    asked = Disturbance.model_validate({"kick": {"yaw_rate": 2.0}})
    found = least_breakout(study.replace(damper__breakout_force="700 lbf"), asked, [20.0], 1.3e3, 0.5)
    row = np.array([0.96, 1.0]) * found.torque
    rest = [comes_to_rest(with_breakout(study, torque), 20.0, 1.3e3, asked, 0.5) for torque in row]
    assert rest == [False, True]
    assert found.speed == 20.0
    slippery = study.replace(damper__breakout_force="0.1 lbf", tyre__friction=0.05)
    assert least_breakout(slippery, asked, [20.0], 1.3e3, 1e-3).torque is None


@pytest.mark.parametrize("study", ["tail_wheel"], indirect=True)
def test_tail_wheel_ends_in_a_flutter_or_in_shimmy(study):
    assert worst(study, {}, 900.0)[0] == pytest.approx(3.51, abs=0.02)
    for kick, end in ((3.0, 0.02), (10.0, 41.3)):
        motion = damperopt.simulate_exactly(
            study, speed=12.0, disturbance={"kick": {"yaw_rate": kick}}, duration=1.5, points=400
        )
        assert np.degrees(np.abs(motion["yaw_angle"][-40:]).max()) == pytest.approx(end, rel=0.1)


@pytest.mark.parametrize("study", ["nose_gear_imported"], indirect=True)
def test_condensed_frame_needs_little_damping(study):
    abscissa, speed = worst(study, {"c_vane": 1.0}, 30e3)
    assert abscissa == pytest.approx(2.13, abs=0.01)
    assert speed == pytest.approx(70.0)
    assert worst(study, {"c_vane": 16.71}, 30e3)[0] == pytest.approx(-0.5, abs=0.01)
    assert damperopt.certify(study, {"c_vane": 16.8}, margin=0.5).proved


@pytest.mark.parametrize("study", ["nose_gear_mr"], indirect=True)
def test_fail_safe_is_proved_and_the_current_is_simulated(study):
    result = damperopt.optimise(study)
    assert result.certificate.proved
    assert result.mass.total == pytest.approx(3.731, abs=0.01)
    ends = []
    for current in (0.0, 2.0):
        at = study.replace(damper__control_current=current)
        motion = damperopt.simulate(at, result.design, speed=40.0, disturbance={"kick": {"yaw_rate": 3.0}}, duration=0.6)
        ends.append(np.degrees(np.abs(motion["yaw_angle"][motion.time > 0.3]).max()))
    assert ends[0] == pytest.approx(1.0, abs=0.02)
    assert ends[1] == pytest.approx(0.222, abs=0.01)


@pytest.mark.parametrize("study", ["landing_roll"], indirect=True)
def test_a_landing_roll_passes_through_shimmy(configs, study):
    """Bands and peaks of the page on the landing roll."""
    history = damperopt.read_history(configs / "histories" / "landing_roll.csv")
    frozen = damperopt.frozen_along(study, None, history)
    touchdown, roll = frozen.beyond(0.0)
    assert touchdown == pytest.approx((0.097, 0.180), abs=2e-3)
    assert np.interp(roll, frozen.time, frozen.speed) == pytest.approx((61.5, 26.1), abs=0.1)
    assert frozen.abscissa.max() == pytest.approx(1.329, abs=2e-3)
    driven = {"unbalance": {"moment": 0.005}}
    motion = damperopt.simulate_along(study, history=history, disturbance=driven)
    peak = np.abs(motion["yaw_angle"]).argmax()
    assert np.degrees(abs(motion["yaw_angle"][peak])) == pytest.approx(6.09, abs=0.02)
    assert motion["speed"][peak] == pytest.approx(26.7, abs=0.3)
    assert np.abs(motion["damper_force"]).max() == pytest.approx(4064, rel=5e-3)
    data = study.model_dump(exclude_none=True)
    del data["gear"]["strut"]
    assert worst(study, study.start, 100e3)[0] == pytest.approx(1.66, abs=0.02)
    assert worst(damperopt.Study.model_validate(data), study.start, 100e3)[0] == pytest.approx(8.71, abs=0.02)

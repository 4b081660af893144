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
    for damping, abscissa, speed in ((1.0, 2.07, 40.8), (1e5, 2.54, 90.0)):
        found = worst(study, {"c_vane": damping}, 30e3)
        assert found[0] == pytest.approx(abscissa, abs=0.05)
        assert found[1] == pytest.approx(speed, abs=1.0)
    result = damperopt.optimise(study)
    assert result.status == "solved"
    assert result.certificate.proved
    assert result.design["c_vane"] == pytest.approx(210, abs=1)
    assert result.mass.total == pytest.approx(4.48, abs=0.01)
    assert worst(study, result.design, 30e3)[0] == pytest.approx(-1.0, abs=0.01)


@pytest.mark.verify
@pytest.mark.parametrize("study", ["main_gear_twin"], indirect=True)
def test_a_common_axle_needs_hardly_a_damper(study):
    whole = damperopt.optimise(study)
    assert whole.certificate.proved
    assert whole.mass.total == pytest.approx(23.06, abs=0.01)
    simple = {"topology": "boeing", "geometry": "planar", "compliance": "rigid"}
    study = study.replace(damper=simple, design__k_lambda=3.8e6)
    alone = damperopt.optimise(study)
    block = study.model_dump(exclude_none=True)
    block["gear"] = {**block["gear"], "kind": "twin"}
    block["gear"].pop("corotation")
    together = damperopt.optimise(damperopt.Study.model_validate(block))
    assert alone.certificate.proved
    assert together.certificate.proved
    assert alone.design["c_lambda"] == pytest.approx(875, abs=10)
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
    assert worst(study, {}, 900.0)[0] == pytest.approx(2.39, abs=0.02)
    for kick, end in ((3.0, 0.0165), (10.0, 41.9)):
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
    assert result.mass.total == pytest.approx(3.722, abs=0.01)
    ends = []
    for current in (0.0, 2.0):
        at = study.replace(damper__control_current=current)
        motion = damperopt.simulate(at, result.design, speed=40.0, disturbance={"kick": {"yaw_rate": 3.0}}, duration=0.6)
        ends.append(np.degrees(np.abs(motion["yaw_angle"][motion.time > 0.3]).max()))
    assert ends[0] == pytest.approx(0.91, abs=0.02)
    assert ends[1] == pytest.approx(0.188, abs=0.01)


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


@pytest.mark.parametrize("study", ["nose_gear_active"], indirect=True)
def test_what_an_actuator_saves(study):
    """The masses of the page at 20 degC, and that the damper without its actuator is what decides them."""
    study = study.replace(solver__starts=1, solver__bound_seconds=0.0)
    active, passive = (damperopt.optimise(s) for s in (study, study.without_control()))
    assert active.certificate.proved
    assert active.fail_safe.proved
    assert active.mass.total == pytest.approx(4.728, abs=0.005)
    assert passive.mass.total == pytest.approx(5.155, abs=0.005)
    by_name = {c.name: c.active for c in active.constraints}
    assert by_name["fail_safe_margin"]
    assert not by_name["stability_margin"]


@pytest.mark.parametrize("study", ["nose_gear_mr"], indirect=True)
def test_what_a_law_makes_of_a_current(study):
    """The table of the page: the law leaves nothing, the current that always flows is quicker at first and sticks."""
    design = {"c_lambda": 623.26, "k_lambda": 8.72205e6, "L": 0.335043, "gamma": 0.7285}
    study = study.replace(damper__compliance="rigid", damper__geometry="planar")
    law = study.replace(damper__control={"gains": {"yaw_rate": {"constant": 1000.0}}})
    constant = study.replace(damper__control_current=0.0, damper__idle_current=2.0)
    found = []
    for own in (law, constant):
        motion = damperopt.simulate_exactly(own, design, speed=40.0, disturbance={"kick": {"yaw_rate": 3.0}}, duration=0.3)
        angle = np.degrees(np.abs(motion["yaw_angle"]))
        found.append([angle[motion.time > t].max() for t in (0.1, 0.2, 0.27)])
    assert found[0] == pytest.approx([0.25, 7e-4, 3e-5], rel=0.15)
    assert found[1] == pytest.approx([0.187, 0.0197, 0.0197], rel=0.02)

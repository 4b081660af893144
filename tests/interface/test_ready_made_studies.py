"""The studies of the page about gears and dampers show what it says."""

import numpy as np
import pytest

import damperopt
from damperopt.stability.linear import LinearModel


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
    assert alone.design["c_lambda"] == pytest.approx(1201, abs=10)
    assert together.design["c_lambda"] == pytest.approx(10, rel=1e-4)


@pytest.mark.parametrize("study", ["nose_wheel_castering"], indirect=True)
def test_friction_holds_kicks_up_to_a_border(study):
    abscissa, speed = worst(study, {}, 1.3e3)
    assert abscissa == pytest.approx(7.92, abs=0.02)
    assert speed == pytest.approx(6.8, abs=0.2)
    for breakout, speed, border in ((15, 5, 2.5), (25, 15, 6.3), (35, 25, 26)):
        held = study.replace(damper__breakout_force=f"{breakout} lbf")
        for part, rests in ((0.95, True), (1.07, False)):
            kick = {"kick": {"yaw_rate": part * border}}
            motion = damperopt.simulate_exactly(held, speed=speed, disturbance=kick, duration=1.5, points=400)
            still = motion.status == "completed" and not motion["yaw_rate"][-50:].any()
            assert still == rests, (breakout, speed, part)


@pytest.mark.parametrize("study", ["tail_wheel"], indirect=True)
def test_tail_wheel_ends_in_a_flutter_or_in_shimmy(study):
    assert worst(study, {}, 900.0)[0] == pytest.approx(3.51, abs=0.02)
    for kick, end in ((3.0, 0.02), (10.0, 41.3)):
        motion = damperopt.simulate_exactly(
            study, speed=12.0, disturbance={"kick": {"yaw_rate": kick}}, duration=1.5, points=400
        )
        assert np.degrees(np.abs(motion["yaw_angle"][-40:]).max()) == pytest.approx(end, rel=0.1)


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

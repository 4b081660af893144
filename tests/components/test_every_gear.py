"""Every kind of gear, with the tyre and the damper of the base study."""

import numpy as np
import pytest
import standard
from standard import least, once
from whole import goes_through_the_commands, is_optimised, is_reported

from damperopt.expressions.corners import Smooth
from damperopt.ports.motion import Torque
from damperopt.study.components import rooms

KINDS = rooms()["gears"]


def gear_blocks():
    for tag, kind in KINDS.items():
        for i, block in enumerate(standard.blocks(kind, lambda block: standard.takes(gear=block))):
            yield pytest.param(block, id=f"{tag}{' full' * i}")


BLOCKS = list(gear_blocks())


@pytest.fixture(scope="module", params=BLOCKS)
def study(request):
    return standard.study_of(gear=request.param)


def test_equations(study):
    standard.rest_is_an_equilibrium(study)
    standard.mirrored_motions_are_motions(study)
    standard.smooth_goes_to_exact(study)
    standard.declared_powers_are_kept_exactly(study)
    standard.record_survives(study)


def test_yaw_is_among_the_states(study):
    """Tables, figures and requirements are of the yaw angle; a state and its twin name each other."""
    states = {state.name: state for state in study.gear.states()}
    assert states["yaw_angle"].twin == "yaw_rate"
    for state in states.values():
        assert state.twin is None or states[state.twin].twin == state.name


def test_gear_in_floats_is_its_graph(study):
    gear, tyre, names = study.gear, study.tyre, [state.name for state in study.gear.states()]

    def motion(speed, load, torque, yaw_torque, y, *values):
        x = dict(zip(names, values, strict=True))
        wheels = gear.wheels(x, speed, load)
        contacts = [tyre.on_ground(wheel, [y] * len(tyre.states), Smooth()) for wheel in wheels]
        moved = gear.rates(x, contacts, Torque(torque), yaw_torque, Smooth())
        assert moved.rates.keys() == set(names), "a rate for every state, and for nothing else"
        assert moved.outputs.keys() == {output.name for output in gear.OUTPUTS}, "outputs as they are declared"
        places = [(w.swivel, w.swivel_rate, w.lateral, w.lateral_rate, w.trail, w.load) for w in wheels]
        held = [(a.angle, a.rate, a.row) for a in gear.attachments(x).values()]
        return moved.rates, moved.outputs, places, held, gear.lever()

    states = np.random.default_rng(1).uniform(-0.02, 0.02, (3, len(names) + 1))
    standard.agrees_with_its_graph(motion, *([30.0, 4e4, 200.0, -50.0, *row] for row in states))


def test_wheels_move_as_their_rates_say(study):
    """swivel_rate and lateral_rate are the derivatives of swivel and lateral along a motion, and the load is all carried."""
    gear, names, h = study.gear, [state.name for state in study.gear.states()], 1e-6
    x = dict(zip(names, np.random.default_rng(2).uniform(-0.05, 0.05, len(names)), strict=True))
    rates = {s.name: x[s.twin] if s.twin and not s.name.endswith("_rate") else 0.0 for s in gear.states()}
    before, now, after = (gear.wheels({n: x[n] + k * h * rates[n] for n in names}, 30.0, 4e4) for k in (-1, 0, 1))
    for early, wheel, late in zip(before, now, after, strict=True):
        # central differences at 1e-6 s of angles of a twentieth of a radian: rounding 1e-11
        assert wheel.swivel_rate == pytest.approx((late.swivel - early.swivel) / (2 * h), abs=1e-9)
        assert wheel.lateral_rate == pytest.approx((late.lateral - early.lateral) / (2 * h), abs=1e-9)
    assert sum(wheel.load for wheel in now) == pytest.approx(4e4)


def test_says_what_it_leaves_out(study):
    assert all(isinstance(words, str) and words for words in study.gear.leaves_out())


@pytest.mark.parametrize("study", once(BLOCKS), indirect=True)
def test_goes_through_the_commands(study, tmp_path):
    goes_through_the_commands(study, tmp_path)


@pytest.mark.parametrize("study", once(BLOCKS), indirect=True)
def test_is_optimised(study, tmp_path):
    is_optimised(study, tmp_path)


@pytest.mark.verify
@pytest.mark.parametrize("study", least(BLOCKS), indirect=True)
def test_is_reported(study, tmp_path):
    is_reported(study, tmp_path)

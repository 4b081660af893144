"""`requirements.largest_limit_cycle`: checked with its play, refused with the play that would do; amplitude maps."""

import numpy as np
import pytest
from basic_twin import LAYOUT
from components_of import damper_block
from tolerances import GAP_PROPORTION

import damperopt
from damperopt.cycles.amplitude_map import amplitude_map, largest_stable
from damperopt.cycles.branches import Question, from_hopf_points
from damperopt.cycles.motions import Seeder
from damperopt.cycles.requirement import check_limit_cycles, cycle_failures
from damperopt.errors import ConfigError

DESIGN = {"L": LAYOUT["L"], "gamma": LAYOUT["gamma"], "k_lambda": 3.8e6, "c_lambda": 15e3}


@pytest.fixture(scope="module")
def gear(request):
    study = damperopt.load(request.config.rootpath / "configs" / "thesis_gear.yaml")
    damper = damper_block("boeing")
    return study.replace(requirements__decay=None, gear__order=3, damper=damper, envelope__speed={"min": 30.0, "max": 50.0})


def with_limit(gear, angle, gap):
    return gear.replace(requirements__largest_limit_cycle={"yaw_angle": angle, "gap": gap, "speeds": [40.0]})


def test_a_cycle_beyond_the_limit_is_refused_and_the_play_that_would_do_is_enough(gear):
    """Small cycles are in proportion to the play."""
    found = check_limit_cycles(with_limit(gear, 1e-4, 2e-4), DESIGN)
    assert not found.passed
    assert found.lost == 0
    reach = LAYOUT["L"] * np.sin(LAYOUT["gamma"])
    assert 1 < found.yaw_angle / (2e-4 / reach) < 10
    (words,) = cycle_failures(found)
    assert "of play; about" in words
    tight = gear.replace(damper__freeplay={"gap": 2e-4 * found.limit / found.yaw_angle})
    again = Seeder(Question.of(tight, DESIGN, "speed")).settled(40.0, 2e-4).orbit
    assert again.amplitudes["yaw_angle"] == pytest.approx(1e-4, rel=GAP_PROPORTION)


def test_without_the_requirement_nothing_is_looked_for(gear):
    assert check_limit_cycles(gear, DESIGN) is None
    assert not cycle_failures(None)


@pytest.mark.parametrize(
    ("block", "words"),
    [
        ({"yaw_angle": 0.0}, "requirements.largest_limit_cycle.yaw_angle"),
        ({"yaw_angle": 1e-3, "speeds": []}, "an empty list"),
        ({"yaw_angle": 1e-3, "speeds": [60.0]}, "60 m/s is outside the envelope"),
        ({"yaw_angle": 1e-3, "gap": -1.0}, "requirements.largest_limit_cycle.gap"),
    ],
)
def test_a_wrong_requirement_is_refused(gear, block, words):
    with pytest.raises(ConfigError, match=words):
        gear.replace(requirements__largest_limit_cycle=block)


def test_a_map_has_the_amplitudes_of_its_branches(request):
    """The nose gear over speed at two dampings: with 700 N m s/rad nothing shimmies, with 300 it does up to 93.4 m/s."""
    study = damperopt.load(request.config.rootpath / "configs" / "nose_gear_thota.yaml")
    question = Question.of(study, None, "speed", 30.0, 120.0, load=150e3)
    axis = Question.of(study, None, "torsional_damping", 300.0, 700.0).axis
    found = amplitude_map(question, axis, 2)
    assert not found.yaw[1].any()
    assert not found.lost.any()
    assert ((found.yaw[0] > 0) == (found.columns < 93.403)).all()
    (branch,) = from_hopf_points(question)
    near = min(branch.orbits, key=lambda orbit: abs(orbit.parameter - 40.0))
    assert largest_stable([branch], [near.parameter]) == pytest.approx([near.amplitudes["yaw_angle"]])


def test_where_rest_is_unstable_and_no_branch_arrives_a_map_knows_nothing(request):
    """From 30 to 60 m/s there is no Hopf point, and shimmy all over."""
    study = damperopt.load(request.config.rootpath / "configs" / "nose_gear_thota.yaml")
    axis = Question.of(study, None, "torsional_damping", 200.0, 300.0).axis
    found = amplitude_map(Question.of(study, None, "speed", 30.0, 60.0, load=150e3), axis, 2)
    assert found.lost.all()

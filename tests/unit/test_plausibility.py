"""What is possible but not usual is said with the number and its usual range, and what is usual is not."""

import pytest

import damperopt
from damperopt.results import ConstraintResult
from damperopt.study.plausibility import Answer, implausible, implausible_answer, implausible_masses


@pytest.fixture(scope="module")
def usual(configs):
    return damperopt.load(configs / "nose_gear_somieski.yaml")


def test_a_usual_gear_is_not_remarked_upon(usual, configs):
    assert implausible(usual) == []
    assert implausible(damperopt.load(configs / "minimal.yaml")) == []


def test_the_side_force_of_the_thesis_is(main_gear):
    found = implausible(main_gear, main_gear.start)
    assert [number.key for number in found][:2] == ["tyre", "tyre"]
    assert found[0].value == pytest.approx(7 * 0.002)
    assert str(found[0]).endswith("at 150 kN is 0.014; usual: 1 to 30")
    assert "pneumatic trail at 150 kN is 71.4 m; usual: 0 to 0.2 m" in str(found[1])


@pytest.mark.parametrize(
    ("changes", "key", "says"),
    [
        ({"tyre__cornering_slope": 200.0}, "tyre", "side force"),
        ({"tyre__relaxation_length": 5.0}, "tyre.relaxation_length", "5 m; usual: 0.05 to 1 m"),
        ({"tyre__half_contact_length": 0.3, "tyre__relaxation_length": 0.9}, "tyre.half_contact_length", "0.3 m"),
        ({"gear__caster_length": 2.0}, "gear.caster_length", "2 m"),
        ({"gear__rake_angle": 0.9}, "gear.rake_angle", "51.6 deg"),
        ({"gear__yaw_inertia": 1000.0}, "gear.yaw_inertia", "usual: 5 to 60 Hz"),
        ({"gear__yaw_inertia": 1e-3}, "gear.yaw_inertia", "0.025 kg"),
        ({"damper__torsional_stiffness": 1.0}, "gear.yaw_inertia", "0.159 Hz"),
        ({"mass__working_pressure": 1e9}, "mass.working_pressure", "1e+03 MPa"),
    ],
)
def test_each_number_far_outside_is_named_with_its_range(changes, key, says, usual):
    said = [str(number) for number in implausible(usual.replace(**changes))]
    assert any(words.startswith(key + ": ") and says in words for words in said), said


def test_each_remark_is_made_once_where_the_load_does_not_matter(usual):
    found = implausible(usual.replace(envelope__vertical_load=[5e3, 9e3], tyre__cornering_slope=200.0))
    assert sum("side force" in number.what for number in found) == 1


def test_a_part_that_outweighs_all_others():
    assert implausible_masses({"links": 2.0, "damper": 3.0, "oil": 0.01}) == []
    (found,) = implausible_masses({"links": 2.0, "damper": 300.0})
    assert "'damper'" in found.what
    assert found.usual[1] == pytest.approx(200.0)


USUAL = {
    "parts": {"torque links": 4.0, "bending arm": 5.0, "damper": 3.0},
    "damper_mass": 3.0,
    "damper_force": 12e3,
    "rod_diameter": 0.018,
    "working_stroke": 2e-3,
    "yaw_frequencies": (11.0, 14.0),
}


def test_a_usual_design_is_not_remarked_upon(main_gear):
    assert implausible_answer(main_gear, Answer(**USUAL)) == []
    assert implausible_answer(main_gear, Answer()) == []


@pytest.mark.parametrize(
    ("numbers", "says"),
    [
        ({"yaw_frequencies": (3.0, 14.0)}, "design: the least frequency of the yaw mode is 3 Hz; usual: 5 to 60 Hz"),
        ({"yaw_frequencies": (11.0, 80.0)}, "design: the largest frequency of the yaw mode is 80 Hz; usual: 5 to 60 Hz"),
        ({"damper_mass": 0.7}, "mass: the mass of a damper for 12 kN is 0.7 kg; usual: at least 1 kg"),
        ({"rod_diameter": 0.008}, "mass.least_rod_diameter: the damper's rod is 8 mm; usual: at least 12 mm"),
        (
            {"working_stroke": 0.5e-3},
            "requirements.stroke_ratio: the working stroke over the clearance of the apex is 3.94; usual: at least 10",
        ),
        (
            {"parts": {**USUAL["parts"], "support arm": 0.1}},
            "mass: the share of the part 'support arm' is 0.826 %; usual: at least 2 %",
        ),
    ],
)
def test_each_number_that_nobody_would_believe_is_named(numbers, says, main_gear):
    found = [str(number) for number in implausible_answer(main_gear, Answer(**USUAL | numbers))]
    assert found == [says]


def test_what_lies_on_its_limit_is_usual(main_gear):
    on_it = {"rod_diameter": 0.012 * (1 - 1e-9), "working_stroke": 1.27e-3 * (1 - 1e-9)}
    assert implausible_answer(main_gear, Answer(**USUAL | on_it)) == []
    light = {"damper_mass": 0.7, "damper_force": 3e3}
    assert implausible_answer(main_gear, Answer(**USUAL | light)) == []


def limit(active, price, relaxed_by=("requirements.tyre_clearance", "mass.lower_lug_height")):
    row = {"kind": "geometry", "value": 0.05, "limit": 0.05, "sense": ">=", "unit": "m", "multiplier": 1.0}
    return ConstraintResult(name="tyre_clearance", active=active, shadow_price=price, relaxed_by=relaxed_by, **row)


def test_a_limit_that_decides_names_the_default_and_its_price(main_gear):
    chosen = main_gear.replace(requirements__tyre_clearance=0.06)
    (found,) = implausible_answer(chosen, Answer(**USUAL, limits=[limit(True, 60.0)]))
    assert found.key == "mass.lower_lug_height"  # the other is the user's choice
    assert "price of +60 kg per m, with mass.lower_lug_height at the default" in str(found)
    assert found.value == pytest.approx(60 * 0.05 / 12)
    assert implausible_answer(chosen, Answer(**USUAL, limits=[limit(False, 60.0), limit(True, 6.0)])) == []
    (given,) = implausible_answer(chosen, Answer(**USUAL, limits=[limit(True, 60.0, ("requirements.tyre_clearance",))]))
    assert given.key == "requirements.tyre_clearance"
    assert "default" not in str(given)


def test_numbers_are_found_in_a_result(main_gear):
    result = damperopt.optimise(main_gear.replace(solver__starts=1))
    answer = Answer.of(result, (12.0,))
    assert answer.damper_mass == result.mass.parts["damper"]
    assert answer.rod_diameter == result.derived["rod_diameter"]
    assert answer.damper_force == result.limit_event["damper_force"]
    assert answer.working_stroke >= 10 * main_gear.requirements.apex_clearance * (1 - 1e-6)
    assert answer.limits == result.constraints


def test_a_tyre_of_another_size_than_the_wheel_is_named(configs):
    study = damperopt.load(configs / "nose_gear_tr_r64.yaml")
    assert not implausible(study)
    (found,) = implausible(study.replace(gear__wheel_radius=0.4, gear__yaw_inertia=4.0))
    assert (found.key, found.value) == ("gear.wheel_radius", 0.4)
    assert found.usual == pytest.approx((0.8 * 0.2286, 1.02 * 0.2286))  # 18 in across

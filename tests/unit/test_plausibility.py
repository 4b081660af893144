"""What is possible but not usual is said with the number and its usual range, and what is usual is not."""

import pytest

import damperopt
from damperopt.study.plausibility import implausible, implausible_masses


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


def test_a_tyre_of_another_size_than_the_wheel_is_named(configs):
    study = damperopt.load(configs / "nose_gear_tr_r64.yaml")
    assert not implausible(study)
    (found,) = implausible(study.replace(gear__wheel_radius=0.4, gear__yaw_inertia=4.0))
    assert (found.key, found.value) == ("gear.wheel_radius", 0.4)
    assert found.usual == pytest.approx((0.8 * 0.2286, 1.02 * 0.2286))  # 18 in across

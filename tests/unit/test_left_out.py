"""What version 0.1's headline left out, by number: said by results, README, changelog and theory."""

import pytest

import damperopt
from damperopt.optimum.left_out import left_out_by_number

HEADLINE = {"c_lambda": 34803.0, "I_arm": 5.6663e-7, "L": 0.4781, "gamma": 0.532151, "b": 0.15244}
"""The lightest damper of configs/thesis_gear.yaml."""


def test_the_simplified_model_says_what_it_leaves_out(main_gear_with_decay, request):
    space, elastic = left_out_by_number(main_gear_with_decay, HEADLINE)
    assert "k_psi is 1.89e+05 instead of 1.45e+06 N m/rad" in space
    assert "the arm carries 1.97 times its allowable stress" in space
    assert "+2.68 1/s at 13.1 m/s" in elastic
    pages = [(request.config.rootpath / name).read_text(encoding="utf-8") for name in ("README.md", "CHANGELOG.md")]
    for page in pages:
        assert "1.97 times its allowable stress" in page
        assert "+2.68 1/s at 13.1 m/s" in page


def test_arm_of_the_headline_by_hand(main_gear_with_decay):
    """12.53 kN m over the reach bend an arm of 0.478 m, clamped on the strut: a tube of wall ratio 0.1."""
    torque = float(main_gear_with_decay.loads.limit_torque(main_gear_with_decay))
    reach = 0.4781 * 0.507405  # L sin(gamma)
    diameter = (HEADLINE["I_arm"] * 64 / 3.14159265 / (1 - 0.8**4)) ** 0.25
    stress = torque / reach * 0.4781 * diameter / 2 / HEADLINE["I_arm"]
    assert stress / (1103e6 / 1.5) == pytest.approx(1.97, abs=0.005)


def test_a_stiffness_that_is_given_is_not_left_out(configs):
    left_out = "compliance of oil column, rod and brackets in series with the damper (damper.compliance)"
    assert left_out not in damperopt.load(configs / "landing_roll.yaml").damper.leaves_out()
    assert left_out in damperopt.load(configs / "thesis_gear.yaml").damper.leaves_out()


def test_the_whole_gear_leaves_nothing_of_this_out(configs):
    study = damperopt.load(configs / "main_gear.yaml")
    assert left_out_by_number(study, study.start) == ()


def test_cantilever_links_of_version_one(main_gear):
    study = main_gear.replace(damper__link_stiffness=8e6)
    worst = damperopt.worst_points(damperopt.linear_gear(study, HEADLINE), study.envelope)[0]
    assert f"{worst.abscissa:+.2f}" == "+4.02"

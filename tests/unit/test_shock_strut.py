"""Shock strut: its curve, what its stroke makes of a gear, and what is refused."""

import math

import numpy as np
import pytest
from components_of import gear_of
from scipy.optimize import brentq

import damperopt
from damperopt import ConfigError
from damperopt.gears.strut import GasSpring
from damperopt.linkages.base import reach_and_height
from damperopt.optimum.problem import DesignProblem

GAS = {"pressure": "1.2 MPa", "area": "0.03 m^2", "volume": "0.015 m^3", "exponent": 1.1}
LATERAL = {"inertia": 600.0, "stiffness": 6.1e6, "damping": 300.0, "height": 2.5}
GEAR = {"kind": "yaw_bending", "yaw_inertia": 100.0, "caster_length": 0.12, "wheel_radius": 0.362, "lateral": LATERAL}
STRUT = {"gas": GAS, "travel": 0.4}


@pytest.fixture(scope="module")
def main_gear(configs):
    return damperopt.load(configs / "main_gear.yaml")


def test_links_open_as_the_design_page_says():
    """models.md C6: L 0.6 m, 31 deg fully out; stroke 0, 0.1, 0.2, 0.3 m."""
    for stroke, angle, reach in ((0.1, 39.3006, 0.380033), (0.2, 46.3302, 0.433999), (0.3, 52.6150, 0.476744)):
        ell, h = reach_and_height({"L": 0.6, "gamma": math.radians(31)}, stroke)
        assert ell == pytest.approx(reach, abs=5e-7)
        assert math.degrees(math.atan2(ell, h)) == pytest.approx(angle, abs=5e-5)


def test_gas_in_balance():
    """Stroke at a load: root of p V^n = const, with pressures against the air, between both stops."""
    strut = gear_of(**GEAR, strut=STRUT).strut
    p_a, p_0, A, V_0, n = 101_325.0, 1.2e6 + 101_325.0, 0.03, 0.015, 1.1

    def force(x):
        return A * (p_0 * (V_0 / (V_0 - A * x)) ** n - p_a)

    assert force(0) == pytest.approx(36e3)
    for load in (50e3, 100e3, 150e3, 220e3):
        assert strut.at_load(load) == pytest.approx(brentq(lambda x, F=load: force(x) - F, 0, 0.49, xtol=1e-14), abs=1e-12)
        assert strut.gas.force(strut.at_load(load)) == pytest.approx(load, rel=1e-12)
    assert strut.at_load(20e3) == 0  # still on its stop
    assert strut.at_load(300e3) == pytest.approx(0.4, abs=1e-15)
    assert force(0.4) < 300e3
    bare = GasSpring.model_validate({**GAS, "ambient": 0})  # the curve of models.md C6: p_0 A (1 - x/x_0)^-n
    assert bare.force(0.3) == pytest.approx(1.2e6 * 0.03 * (1 - 0.3 / 0.5) ** -1.1, rel=1e-14)


def test_gear_at_a_load_is_the_gear_with_its_numbers(main_gear):
    """l_g, k_delta, I_x and gamma written down by hand for 100 kN; without a strut they are the numbers of a study."""
    tables = {
        "bending_stiffness": {"stroke": [0.05, 0.25, 0.35], "value": [5e6, 7e6, 7.5e6]},
        "caster_length": {"load": [20e3, 180e3], "value": [0.1, 0.14]},
    }
    strut = {"stroke": {"load": [20e3, 100e3, 200e3], "value": [0.05, 0.21, 0.35]}, "moving_mass": 40.0, **tables}
    study = main_gear.replace(gear__strut=strut)
    design = {**study.start, "L": 0.6, "gamma": math.radians(31)}
    x = 0.21
    height, inertia = 2.5 - x, 600 - 40 * (2.5**2 - (2.5 - x) ** 2)
    lateral = {**LATERAL, "height": height, "inertia": inertia, "stiffness": 6.6e6}
    plain = main_gear.replace(gear__lateral=lateral, gear__caster_length=0.12)
    shorter = {**design, "gamma": math.acos((0.6 * math.cos(math.radians(31)) - x / 2) / 0.6)}
    speeds = np.array([8.0, 30.0, 90.0])
    found, expected = damperopt.linear_gear(study, design), damperopt.linear_gear(plain, shorter)
    np.testing.assert_allclose(found.roots(speeds, 100e3), expected.roots(speeds, 100e3), rtol=1e-9)
    assert found.powers.load is None
    assert expected.powers.load is not None


def test_a_strut_that_changes_nothing_is_todays_gear(main_gear):
    still = {"stroke": {"load": [1e3, 1e6], "value": [0, 0]}}
    found, expected = (damperopt.linear_gear(s) for s in (main_gear.replace(gear__strut=still), main_gear))
    speeds = np.array([5.0, 20.0, 100.0])
    np.testing.assert_allclose(found.roots(speeds, 150e3), expected.roots(speeds, 150e3), rtol=1e-12)


def test_torsion_over_load_stands_in_front_of_the_linkage_or_in_the_place_of_the_spring(main_gear, configs):
    table = {"load": [50e3, 150e3], "value": [4e5, 6e5]}
    still = {"stroke": {"load": [1e3, 1e6], "value": [0, 0]}, "torsional_stiffness": table}
    found = damperopt.linear_gear(main_gear.replace(gear__strut=still))
    compliance = main_gear.damper.compliance.model_copy(update={"torsion": 5e5}).model_dump()
    expected = damperopt.linear_gear(main_gear.replace(damper__compliance=compliance))
    np.testing.assert_allclose(found.roots(20.0, 100e3), expected.roots(20.0, 100e3), rtol=1e-10)
    bare = damperopt.load(configs / "nose_gear_somieski.yaml")
    own = {"load": [5e3, 15e3], "value": [1e5, 2e5]}
    found = damperopt.linear_gear(bare.replace(gear__strut={**still, "torsional_stiffness": own}))
    expected = damperopt.linear_gear(bare.replace(damper__torsional_stiffness=1.4e5))
    np.testing.assert_allclose(found.roots(20.0, 9e3), expected.roots(20.0, 9e3), rtol=1e-12)


def test_lengths_hold_fully_in_and_the_working_stroke_at_the_largest_load(configs):
    """Boeing's layout by hand: reach, lugs and apex at the travel; the stroke under a torque T is T/(k_lambda ell)."""
    study = damperopt.load(configs / "landing_roll.yaml").replace(tyre__contact="leading_point")
    design = {"c_lambda": 7e3, "k_lambda": 2e7, "L": 0.45, "gamma": math.radians(24)}
    found = {name: value for name, (value, _) in DesignProblem(study).values(design).items()}
    h, travel, stroke = 0.45 * math.cos(math.radians(24)), 0.36, study.gear.stroke(100e3)
    assert found["lug_distance_max"] == pytest.approx(2 * h)
    assert found["lug_distance_min"] == pytest.approx(2 * h - travel)
    assert found["reach_min"] == pytest.approx(0.45 * math.sin(math.radians(24)))
    assert found["reach_max"] == pytest.approx(math.sqrt(0.45**2 - (h - travel / 2) ** 2))
    assert found["tyre_clearance"] == pytest.approx(h - travel / 2 + 0.3 - 0.36)
    ell = math.sqrt(0.45**2 - (h - stroke / 2) ** 2)
    torque = float(study.loads.limit_torque(study, load=100e3))  # of a chain whose stiffness is given
    assert found["working_stroke"] == pytest.approx(torque / (2e7 * ell))


@pytest.mark.parametrize(
    ("strut", "message"),
    [
        ({}, "gear.strut: no load-stroke curve; allowed: gas, or stroke"),
        ({"gas": GAS}, "gear.strut.travel: missing key; allowed: travel beside gas"),
        ({"gas": GAS, "travel": 0.5}, "gear.strut.travel: 0.5 m, where no gas is left; allowed: less than volume/area, 0.5 m"),
        (
            {**STRUT, "moving_mass": 100.0},
            "gear.strut.moving_mass: 100 kg; allowed: less than gear.lateral.inertia/height^2, 96 kg",
        ),
        (
            {"stroke": {"load": [1e3, 2e5], "value": [0, 3]}},
            "gear.strut: a stroke of 3 m; allowed: less than gear.lateral.height",
        ),
        ({"stroke": {"load": [1e3, 2e5], "value": [0.3, 0]}}, "gear.strut.stroke.value: strokes that fall with the load"),
        ({"stroke": {"load": [1e3, 1e5], "value": [0, 0.3]}}, "150 kN is beyond the table of gear.strut.stroke, 1 to 100 kN"),
        ({**STRUT, "bending_stiffness": {"value": [1, 2]}}, "gear.strut.bending_stiffness: neither load nor stroke"),
        (
            {**STRUT, "bending_stiffness": {"stroke": [0, 0.3], "value": [1e6, 2e6]}},
            "150 kN is beyond the table of gear.strut.bending_stiffness, 0 to 300 mm, with a stroke of 355.6 mm",
        ),
        ({**STRUT, "lateral_stiffness": {"load": [1e3, 2e5], "value": [1e6, 2e6]}}, "gear.strut.lateral_stiffness: gear.kind"),
    ],
)
def test_what_is_refused(main_gear, strut, message):
    with pytest.raises(ConfigError) as error:
        main_gear.replace(gear__strut=strut)
    assert message in str(error.value)


def test_frozen_is_said_to_be_frozen(main_gear):
    frozen, moving = (" ".join(gear.leaves_out()) for gear in (main_gear.gear, gear_of(**GEAR, strut=STRUT)))
    assert "its stroke is frozen" in frozen
    assert "quasi-static" in moving

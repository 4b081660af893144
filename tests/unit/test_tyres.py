"""Tyre laws: values, slopes, symmetry, limits and peaks."""

import casadi as ca
import numpy as np
import pytest
from basic_twin import aligning_moment as twin_moment
from basic_twin import parameters
from basic_twin import side_force as twin_force
from components_of import tyre_of
from scipy.integrate import trapezoid
from tolerances import CENTRAL_DIFFERENCE, CENTRAL_DIFFERENCE_STEP, GRID_SEARCH, ROUNDING

from damperopt.expressions.corners import Smooth

LOAD = 150e3
CONTACT = {"half_contact_length": 0.1, "relaxation_length": 0.3}


def on_string(tyre, deflection):
    """Slip angle of the string's leading point."""
    return ca.atan(deflection / tyre.relaxation_length)


def side_force(tyre, deflection, load):
    return tyre.force(on_string(tyre, deflection), load, None)


def aligning_moment(tyre, deflection, load):
    """The law with its corner at the slip limit."""
    return tyre.moment(on_string(tyre, deflection), load, None, Smooth())


STRING = tyre_of(
    law="nonlinear", cornering_coefficient=0.002, aligning_coefficient=1.0, aligning_slip_limit=np.deg2rad(10.0), **CONTACT
)
LINEAR = tyre_of(law="linear", cornering_slope=20.0, aligning_coefficient=2.0, **CONTACT)
STRAIGHT = tyre_of(law="stiffness", cornering_stiffness=4.0e5, aligning_stiffness=3.0e4, **CONTACT)
TWINS = [
    (STRING, parameters()),
    (LINEAR, parameters(law="linear", C_F=20.0, C_M=2.0)),
    (STRAIGHT, parameters(law="straight_tangent", C_F=4.0e5, C_M=3.0e4)),
]
DEFLECTIONS = np.linspace(-0.4, 0.4, 81)
LIMIT_DEFLECTION = 0.3 * np.tan(np.deg2rad(10.0))


def values(law, tyre, deflections=DEFLECTIONS, load=LOAD):
    """A law at many deflections, through the symbols that the model sees."""
    y = ca.SX.sym("y")
    return ca.Function("law", [y], [law(tyre, y, load)])(ca.DM(np.atleast_1d(deflections)).T).full().ravel()


def slope_at_rest(law, tyre):
    h = CENTRAL_DIFFERENCE_STEP
    return np.diff(values(law, tyre, [-h, h]))[0] / (2 * h)


@pytest.mark.parametrize(("tyre", "p"), TWINS, ids=lambda value: getattr(value, "law", ""))
def test_laws_are_those_of_the_twin(tyre, p):
    expected = [twin_force(y, LOAD, p) for y in DEFLECTIONS]
    np.testing.assert_allclose(values(side_force, tyre), expected, rtol=ROUNDING, atol=ROUNDING * LOAD)
    expected = [twin_moment(y, LOAD, p) for y in DEFLECTIONS]
    np.testing.assert_allclose(values(aligning_moment, tyre), expected, rtol=ROUNDING, atol=ROUNDING * LOAD)


def test_nonlinear_side_force_by_hand():
    """Thesis (2-10) at alpha = 5 deg: X = atan(7 tan 5 deg) = 0.5495023, F_y/F_z = 0.002 X cos(0.95 X) = 9.526283e-4."""
    (found,) = values(side_force, STRING, 0.3 * np.tan(np.deg2rad(5.0)))
    assert found / LOAD == pytest.approx(9.526283e-4, abs=5e-11)


def test_nonlinear_aligning_moment_by_hand():
    """Thesis (4-8) at half the limit: (alpha_m/pi) F_z = 0.1745329/3.1415927 F_z = F_z/18."""
    (found,) = values(aligning_moment, STRING, 0.3 * np.tan(np.deg2rad(5.0)))
    assert found == pytest.approx(LOAD / 18, rel=ROUNDING)


@pytest.mark.parametrize(
    ("tyre", "force_slope", "moment_slope"),
    [
        (STRING, 7 * 0.002 * LOAD / 0.3, 1.0 * LOAD / 0.3),
        (LINEAR, 20.0 * LOAD / 0.3, 2.0 * LOAD / 0.3),
        (STRAIGHT, 4.0e5 / 0.3, 3.0e4 / 0.3),
    ],
    ids=["nonlinear", "linear", "straight_tangent"],
)
def test_slopes_at_rest(tyre, force_slope, moment_slope):
    """Per metre of deflection; 7 C_F for the nonlinear law, which (2-11) of the thesis loses."""
    assert slope_at_rest(side_force, tyre) == pytest.approx(force_slope, rel=CENTRAL_DIFFERENCE)
    assert slope_at_rest(aligning_moment, tyre) == pytest.approx(moment_slope, rel=CENTRAL_DIFFERENCE)


@pytest.mark.parametrize("tyre", [STRING, LINEAR, STRAIGHT], ids=lambda tyre: tyre.law)
@pytest.mark.parametrize("law", [side_force, aligning_moment])
def test_laws_are_odd_and_restore_within_the_limit(tyre, law):
    """F_y and M_z have the sign of the deflection; the moment has none beyond its limit."""
    found = values(law, tyre)
    np.testing.assert_allclose(found, -found[::-1], rtol=ROUNDING, atol=ROUNDING * LOAD)
    within = abs(DEFLECTIONS) < LIMIT_DEFLECTION
    assert (np.sign(found[within]) == np.sign(np.round(DEFLECTIONS[within], 12))).all()


def test_nonlinear_aligning_moment_ends_at_the_slip_limit():
    """Continuous there, exactly zero beyond; the side force goes on."""
    inside, outside = LIMIT_DEFLECTION * (1 - 1e-9), LIMIT_DEFLECTION * (1 + 1e-9)
    assert 0 < values(aligning_moment, STRING, inside)[0] < 1e-8 * LOAD
    beyond = values(aligning_moment, STRING, [outside, 0.1, 1.0, -outside, -1.0])
    assert (beyond == 0).all()
    assert (values(side_force, STRING, [outside, 0.1, 1.0]) > 0).all()


def test_peaks_are_the_largest_values_of_the_nonlinear_law():
    """By search over a fine grid, which meets a flat maximum to second order in its spacing."""
    fine = 0.3 * np.tan(np.linspace(0, np.deg2rad(80.0), 100_001))
    force, moment = values(side_force, STRING, fine), values(aligning_moment, STRING, fine)
    assert force.max() <= STRING.peaks(LOAD, None).side_force * (1 + ROUNDING)
    assert force.max() == pytest.approx(STRING.peaks(LOAD, None).side_force, rel=GRID_SEARCH)
    assert moment.max() <= STRING.peaks(LOAD, None).aligning_moment * (1 + ROUNDING)
    assert moment.max() == pytest.approx(STRING.peaks(LOAD, None).aligning_moment, rel=GRID_SEARCH)


def test_aligning_moment_peaks_at_half_the_slip_limit():
    (at_half,) = values(aligning_moment, STRING, 0.3 * np.tan(np.deg2rad(5.0)))
    assert at_half == pytest.approx(STRING.peaks(LOAD, None).aligning_moment, rel=ROUNDING)


def test_peak_aligning_moment_is_positive_for_either_sign_of_the_coefficient():
    reversed_tyre = STRING.model_copy(update={"aligning_coefficient": -1.0})
    assert reversed_tyre.peaks(LOAD, None).aligning_moment == STRING.peaks(LOAD, None).aligning_moment > 0


@pytest.mark.parametrize("law", [side_force, aligning_moment])
def test_load_scales_all_laws_but_the_straight_tangent(law):
    for tyre in (STRING, LINEAR):
        np.testing.assert_allclose(values(law, tyre, load=2 * LOAD), 2 * values(law, tyre), rtol=ROUNDING)
    np.testing.assert_array_equal(values(law, STRAIGHT, load=2 * LOAD), values(law, STRAIGHT))


def test_nonlinear_law_starts_as_the_linear_one():
    """Within the cube of a small slip angle; slope 7 C_F of one is the slope of the other."""
    same = tyre_of(law="linear", cornering_slope=7 * 0.002, aligning_coefficient=1.0, **CONTACT)
    small = np.array([1e-5, -1e-5])
    for law in (side_force, aligning_moment):
        np.testing.assert_allclose(values(law, STRING, small), values(law, same, small), rtol=1e-6)


def test_straight_tangent_stiffnesses_from_the_carcass():
    """Sums of the carcass forces c_c v over the string, for unit slip: deflection sigma at the leading point, growing to the
    rear along the contact line, decaying over sigma before and behind it. Forces behind the centre turn the wheel back."""
    a, sigma, c_c = 0.1, 0.3, 2e5
    inside, outside = np.linspace(-a, a, 20001), np.linspace(0, 40 * sigma, 400001)  # x forward from the centre
    line = sigma + a - inside
    ahead, behind = line[-1] * np.exp(-outside / sigma), line[0] * np.exp(-outside / sigma)
    places = (inside, a + outside, -a - outside)
    parts = list(zip((line, ahead, behind), places, (inside, outside, outside), strict=True))
    force = c_c * sum(trapezoid(v, along) for v, _, along in parts)
    moment = -c_c * sum(trapezoid(v * x, along) for v, x, along in parts)
    tyre = tyre_of(law="stiffness", carcass_stiffness=c_c, **CONTACT)
    assert tuple(tyre.linear(LOAD, None))[:2] == pytest.approx((force, moment), rel=1e-6)


@pytest.mark.parametrize("given", [{}, {"cornering_stiffness": 1e5}, {"aligning_stiffness": 1e4, "carcass_stiffness": 1e5}])
def test_half_or_double_stiffness_of_the_straight_tangent_is_refused(given):
    with pytest.raises(ValueError, match="incomplete or double stiffness"):
        tyre_of(law="stiffness", **CONTACT, **given)

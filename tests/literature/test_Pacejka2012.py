"""Magic Formula: numbers of an independent prototype for a published set of coefficients, limits, bounds, pressure."""

import math

import casadi as ca
import numpy as np
import pytest
from components_of import tyre_of

from damperopt.expressions.corners import Linear
from damperopt.tyres.coefficients import OFFSETS, Coefficients

LOAD = 35e3

# pure lateral slip, no camber: coefficients of the HMMWV's PAC2002 tyre, data of Project Chrono (BSD licence)
HMMWV = {
    **{"FNOMIN": 35000.0, "UNLOADED_RADIUS": 0.4699, "LFZO": 0.580904846, "PCY1": 1.5874, "PDY1": 0.73957, "PDY2": -0.075004},
    **{"PEY1": 0.37562, "PEY2": -0.069325, "PEY3": 0.29168, "PKY1": -10.289, "PKY2": 3.3343, "PHY1": 0.0056509},
    **{"PHY2": -0.0020257, "PVY1": 0.015216, "PVY2": -0.010365, "PTY1": 1.2, "PTY2": 2.5, "QBZ1": 5.8978, "QBZ2": -0.1535},
    **{"QBZ3": -2.0052, "QBZ9": 10.637, "QBZ10": 0.0, "QCZ1": 1.4982, "QDZ1": 0.085549, "QDZ2": -0.025298, "QDZ6": -0.0013373},
    **{"QDZ7": 0.0013869, "QEZ1": -0.0084519, "QEZ2": 0.0097389, "QEZ3": 0.0, "QEZ4": 4.3583, "QHZ1": 0.0085657},
    **{"QHZ2": -0.0042922},
}


@pytest.fixture(scope="module")
def tyre():
    return tyre_of(law="magic_formula", half_contact_length=0.1, coefficients=HMMWV)


def test_constants_at_the_nominal_load():
    curves = Coefficients(**HMMWV).at(LOAD, None)
    assert pytest.approx(-170546.88, abs=0.005) == curves.K
    assert pytest.approx(-4.47825, abs=5e-6) == curves.K / (curves.C * curves.D)
    assert pytest.approx(23991.037, abs=5e-4) == curves.D
    assert curves.D_t == pytest.approx(0.05444, abs=5e-6)
    assert Coefficients(**HMMWV).relaxation_length(LOAD, None) == pytest.approx(0.30601, abs=5e-6)


@pytest.mark.parametrize(
    ("degrees", "force", "moment"),
    [(0, -443.454, 18.587), (1, -3391.770, 176.772), (4, -11319.952, 530.949), (10, -20456.131, 534.125)],
)
def test_force_and_moment_with_offsets_in_the_signs_of_the_file(degrees, force, moment):
    curves, alpha = Coefficients(**HMMWV).at(LOAD, None), math.radians(degrees)
    assert curves.side_force(alpha) == pytest.approx(force, abs=6e-4)
    assert curves.moment(alpha) == pytest.approx(moment, abs=6e-4)


@pytest.mark.parametrize(
    ("degrees", "force", "moment"), [(1, 2961.041, 159.936), (4, 11003.289, 530.253), (10, 20373.371, 556.496)]
)
@pytest.mark.parametrize("sign", [1, -1])
def test_force_and_moment_without_offsets(tyre, degrees, force, moment, sign):
    alpha = sign * math.radians(degrees)
    assert tyre.force(alpha, LOAD, None) == pytest.approx(sign * force, abs=6e-4)
    assert tyre.moment(alpha, LOAD, None, Linear()) == pytest.approx(sign * moment, abs=6e-4)


def test_small_slip_data(tyre):
    C_Fa, C_Ma, sigma, a = tyre.linear(LOAD, None)
    assert pytest.approx(170546.88, abs=0.005) == C_Fa
    assert pytest.approx(9284.199, abs=6e-4) == C_Ma
    assert (sigma, a) == (pytest.approx(0.30601, abs=5e-6), 0.1)


@pytest.mark.parametrize("change", [{"PKY1": 10.289}, {"PKY1": 10.289, "PDY1": -0.73957, "PDY2": 0.075004}])
def test_files_of_other_axes_are_the_same_tyre(tyre, change):
    other = tyre_of(law="pac2002", half_contact_length=0.1, coefficients=HMMWV | change)
    for alpha in (-0.2, 0.01, 0.4):
        assert other.force(alpha, LOAD, None) == pytest.approx(tyre.force(alpha, LOAD, None), rel=1e-14)
        assert other.moment(alpha, LOAD, None, Linear()) == pytest.approx(tyre.moment(alpha, LOAD, None, Linear()), rel=1e-14)


def test_scaling_factors_act_where_the_source_has_them(tyre):
    """Both curves stretch with LMUY; LKY, LTR and LSGAL scale slope, trail and relaxation length."""
    friction, slope, trail, sigma = (
        tyre_of(law="magic_formula", half_contact_length=0.1, coefficients=HMMWV | {key: 1.3})
        for key in ("LMUY", "LKY", "LTR", "LSGAL")
    )
    alpha = 0.1
    # B = K/(C D) falls by 1.3: as a function of B alpha the force is 1.3 times as large
    assert friction.force(1.3 * alpha, LOAD, None) == pytest.approx(1.3 * tyre.force(alpha, LOAD, None), rel=1e-12)
    assert slope.linear(LOAD, None).cornering_stiffness == pytest.approx(1.3 * 170546.88, rel=1e-7)
    assert slope.force(alpha / 1.3, LOAD, None) == pytest.approx(tyre.force(alpha, LOAD, None), rel=1e-12)
    assert trail.moment(alpha, LOAD, None, Linear()) == pytest.approx(1.3 * tyre.moment(alpha, LOAD, None, Linear()), rel=1e-12)
    assert sigma.linear(LOAD, None).relaxation_length == pytest.approx(1.3 * 0.3060109, rel=1e-6)


def test_without_offsets_nothing_is_left_of_them():
    plain = Coefficients(**{key: value for key, value in HMMWV.items() if key not in OFFSETS})
    assert Coefficients(**HMMWV).symmetric() == plain
    curves = plain.at(LOAD, None)
    assert (curves.side_force(0.0), curves.moment(0.0)) == (0, 0)


def test_curvature_is_at_most_one():
    steep = Coefficients(**HMMWV | {"PEY1": 3.0}).symmetric().at(LOAD, None)
    one = Coefficients(**HMMWV | {"PEY1": 1.0, "PEY2": 0.0}).symmetric().at(LOAD, None)
    assert steep.side_force(0.2) == pytest.approx(one.side_force(0.2), rel=1e-14)


def test_peak_of_the_moment_is_bounded_closely(tyre):
    for load in (10e3, 35e3, 70e3):
        slips = np.linspace(0, tyre.slip_range, 20001)
        found = max(abs(tyre.moment(float(alpha), load, None, Linear())) for alpha in slips)
        assert found <= tyre.peaks(load, None).aligning_moment <= 1.06 * found
        forces = [tyre.force(float(alpha), load, None) for alpha in slips]
        assert max(forces) == pytest.approx(tyre.peaks(load, None).side_force, rel=1e-6)


def test_peak_of_a_trail_that_turns_round_is_bounded():
    """C_t near 2 and a steep trail: the moment is largest where it has changed its sign."""
    turned = tyre_of(law="magic_formula", half_contact_length=0.1, coefficients=HMMWV | {"QCZ1": 2.0, "QBZ1": 20.0})
    moments = [turned.moment(float(alpha), LOAD, None, Linear()) for alpha in np.linspace(0, turned.slip_range, 20001)]
    assert min(moments) < -max(moments)
    assert max(map(abs, moments)) <= turned.peaks(LOAD, None).aligning_moment


def test_newer_formula_by_its_printed_terms():
    """K with PKY4 and pressure, friction and trail with pressure, sigma = K/C_y; MF 6.1 as Pacejka prints it."""
    more = {"PKY4": 1.8, "PPY1": 0.5, "PPY2": 0.2, "PPY3": -0.1, "PPY4": 0.05, "PPZ1": -0.3, "NOMPRES": 8e5, "INFLPRES": 9e5}
    more |= {"LATERAL_STIFFNESS": 4e5, "PCFY1": 0.1, "PCFY2": 0.02, "PCFY3": 0.4}
    c = Coefficients(**{key: value for key, value in HMMWV.items() if key not in ("PTY1", "PTY2")}, **more)
    F_0, dp = 35e3 * 0.580904846, (8.4e5 - 8e5) / 8e5
    df = (LOAD - F_0) / F_0
    K = -10.289 * F_0 * (1 + 0.5 * dp) * math.sin(1.8 * math.atan(LOAD / (3.3343 * F_0 * (1 + 0.2 * dp))))
    curves = c.at(LOAD, 8.4e5)
    assert pytest.approx(K, rel=1e-14) == curves.K
    assert pytest.approx((0.73957 - 0.075004 * df) * (1 - 0.1 * dp + 0.05 * dp**2) * LOAD, rel=1e-14) == curves.D
    trail = LOAD * 0.4699 / F_0 * (0.085549 - 0.025298 * df) * (1 + 0.3 * dp)
    assert pytest.approx(trail, rel=1e-14) == curves.D_t
    C_y = 4e5 * (1 + 0.1 * df + 0.02 * df**2) * (1 + 0.4 * dp)
    assert c.relaxation_length(LOAD, 8.4e5) == pytest.approx(abs(K) / C_y, rel=1e-14)
    assert c.at(LOAD, None) == c.at(LOAD, 9e5)


def test_symbols_give_the_same_curves(tyre):
    alpha, load = ca.SX.sym("alpha"), ca.SX.sym("load")
    graph = ca.Function("law", [alpha, load], [tyre.force(alpha, load, None), tyre.moment(alpha, load, None, Linear())])
    for a, F in ((-0.3, 2e4), (1e-4, 5e4), (0.1, 3.5e4)):
        force, moment = (float(value) for value in graph(a, F))
        assert force == pytest.approx(tyre.force(a, F, None), rel=1e-13)
        assert moment == pytest.approx(tyre.moment(a, F, None, Linear()), rel=1e-13)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"QDZ1": -0.1}, "no trail behind the centre"),
        ({"PKY1": 0.0}, "0; allowed: another number, of either sign"),
        ({"PCY1": 2.5}, "out of range"),
        ({"PTY1": None}, "relaxation_length|valid"),
    ],
)
def test_what_is_no_tyre_is_refused(change, says):
    kept = {key: value for key, value in (HMMWV | change).items() if value is not None}
    with pytest.raises(ValueError, match=says):
        tyre_of(law="magic_formula", half_contact_length=0.1, coefficients=kept)


def test_loads_at_which_a_fit_is_lost_are_named():
    found = tyre_of(law="magic_formula", half_contact_length=0.1, coefficients=HMMWV, data_loads={"min": 1750, "max": 78750})
    assert found.beyond(35e3, None) == ""
    assert "beyond the tyre's data, 1.75 to 78.75 kN" in found.beyond(1e5, None)
    free = tyre_of(law="magic_formula", half_contact_length=0.1, coefficients=HMMWV)
    # the trail vanishes at df = 0.085549/0.025298, 89.1 kN, the friction at 222 kN
    assert free.beyond(89.0e3, None) == ""
    assert "no positive trail" in free.beyond(89.2e3, None)
    assert "no positive friction" in free.beyond(230e3, None)

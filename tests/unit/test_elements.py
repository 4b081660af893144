"""Corners and compliances: elements against piecewise formulas, linear dampers against springs and dashpots in series."""

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from basic_twin import LAYOUT, parameters, spectral_abscissa, state_matrix
from components_of import damper_block, damper_of
from tolerances import (
    CENTRAL_DIFFERENCE,
    CENTRAL_DIFFERENCE_STEP,
    CONVERGENCE_ORDER,
    DYNAMIC_STIFFNESS,
    ROUNDING,
    STATIC_STIFFNESS,
)

from damperopt.dampers.base import Context
from damperopt.dampers.hydraulic import Orifice
from damperopt.expressions.corners import Linear, Smooth, Switched
from damperopt.linkages.joints import EndStop, Freeplay
from damperopt.linkages.torque import damper_torque
from damperopt.ports.linkage import Linkage, Position
from damperopt.ports.motion import Attachment
from damperopt.stability.linear import LinearModel

WIDTH, GAP = 1e-3, 0.25
POINTS = np.array([-1.7, -0.6, -0.1, 0.05, 0.4, 2.3])
"""Away from the corners at 0 and +-0.25."""


def dead_band(x, g):
    """Piecewise: what is left of x beyond +-g."""
    return np.where(x > g, x - g, np.where(x < -g, x + g, 0.0))


PIECEWISE = {
    "absolute": lambda x: np.where(x < 0, -x, x),
    "sign": lambda x: np.where(x < 0, -1.0, 1.0),
    "gap": lambda x: dead_band(x, GAP),
    "slope of the gap": lambda x: np.where(abs(x) > GAP, 1.0, 0.0),
    "contact": lambda x: dead_band(x, GAP),
}


def expressions(elements, x, width):
    """Everything that is made of |x|."""
    beyond, slope = elements.gap("gap", x, GAP, width)
    return {
        "absolute": elements.absolute("zero", x, width),
        "sign": elements.sign("zero", x, width),
        "gap": beyond,
        "slope of the gap": slope,
        "contact": elements.contact("stop", x, GAP, width),
    }


def smooth(name, points, width=WIDTH):
    x = ca.SX.sym("x")
    function = ca.Function("smooth", [x], [expressions(Smooth(), x, width)[name]])
    return function(np.asarray(points)[None, :]).full().ravel()


# ----------------------------------------------------------------------------------------------------------- elements


@pytest.mark.parametrize("name", PIECEWISE)
def test_smooth_element_is_the_piecewise_one_away_from_its_corners(name):
    """|x| is off by w^2/(2 |x|), its slope by w^2/(2 x^2), with |x| the distance to a corner, here 0.05 at least."""
    bound = WIDTH**2 / (2 * 0.05**2)
    np.testing.assert_allclose(smooth(name, POINTS), PIECEWISE[name](POINTS), rtol=0, atol=bound)


@pytest.mark.parametrize("name", ["absolute", "sign", "gap", "slope of the gap", "contact"])
def test_error_away_from_a_corner_goes_with_the_square_of_the_width(name):
    wide, narrow = (abs(smooth(name, POINTS, w) - PIECEWISE[name](POINTS)).max() for w in (1e-2, 1e-3))
    assert np.log10(wide / narrow) == pytest.approx(2, abs=CONVERGENCE_ORDER)


@pytest.mark.parametrize(("name", "corner", "error"), [("absolute", 0.0, 1.0), ("gap", GAP, 0.5), ("contact", -GAP, 0.5)])
def test_error_at_a_corner_is_proportional_to_the_width(name, corner, error):
    """|x| is rounded to w at 0, and a dead band has half of an absolute value at each end."""
    for width in (1e-2, 1e-3, 1e-4):
        found = abs(smooth(name, [corner], width)[0] - PIECEWISE[name](np.array([corner]))[0])
        # the other end of the dead band, at a distance of 0.5
        assert found == pytest.approx(error * width, abs=width**2)


def test_largest_error_of_a_smooth_element_is_at_its_corner():
    grid = np.linspace(-1, 1, 2001)
    assert abs(smooth("absolute", grid) - abs(grid)).max() == pytest.approx(WIDTH, rel=ROUNDING)
    assert abs(smooth("gap", grid) - dead_band(grid, GAP)).max() <= WIDTH / 2


def test_smooth_elements_are_odd():
    for name in ("sign", "gap", "contact"):
        np.testing.assert_allclose(smooth(name, POINTS), -smooth(name, -POINTS), rtol=ROUNDING, atol=ROUNDING)


@pytest.mark.parametrize(("name", "slope"), [("absolute", "sign"), ("gap", "slope of the gap")])
def test_slopes_are_those_of_finite_differences(name, slope):
    """Near the corners too, with a width that a step of 1e-5 resolves."""
    points, h, width = np.concatenate([POINTS, [0.0, 0.24, 0.25, -0.26]]), CENTRAL_DIFFERENCE_STEP, 0.1
    difference = (smooth(name, points + h, width) - smooth(name, points - h, width)) / (2 * h)
    np.testing.assert_allclose(smooth(slope, points, width), difference, rtol=0, atol=CENTRAL_DIFFERENCE)


@pytest.mark.parametrize("name", PIECEWISE)
def test_switched_element_is_the_piecewise_one_with_the_right_modes(name):
    x, elements = ca.SX.sym("x"), Switched()
    made = expressions(elements, x, WIDTH)
    switches = list(elements.switches.values())
    arguments = ca.vertcat(*(switch.argument for switch in switches))
    modes = ca.vertcat(*(switch.mode for switch in switches))
    side = ca.Function("side", [x], [ca.sign(arguments)])
    exact = ca.Function("exact", [x, modes], [made[name]])
    for point in POINTS:
        assert float(exact(point, side(point))) == pytest.approx(float(PIECEWISE[name](point)), rel=ROUNDING, abs=ROUNDING)


def test_switched_elements_of_one_name_share_their_modes():
    """Absolute value and slope of one argument are one switch; a gap has two."""
    x, elements = ca.SX.sym("x"), Switched()
    elements.absolute("one", x, 0)
    elements.sign("one", x, 0)
    assert list(elements.switches) == ["one"]
    elements.gap("two", x, GAP, 0)
    assert list(elements.switches) == ["one", "two +", "two -"]


def test_within_is_one_up_to_the_limit_and_zero_beyond():
    x, elements = ca.SX.sym("x"), Switched()
    step = elements.within("limit", x, GAP)
    arguments = ca.vertcat(*(switch.argument for switch in elements.switches.values()))
    modes = ca.vertcat(*(switch.mode for switch in elements.switches.values()))
    for point in POINTS:
        inside = float(abs(point) <= GAP)
        found = ca.Function("within", [x, modes], [step])(point, np.sign(ca.Function("a", [x], [arguments])(point).full()))
        assert float(found) == inside
        assert float(ca.evalf(Smooth().within("limit", ca.SX(float(point)), GAP))) == inside


def test_linear_elements_have_neither_gap_nor_force():
    x, elements = ca.SX.sym("x"), Linear()
    beyond, slope = elements.gap("gap", x, GAP, WIDTH)
    assert ca.is_equal(beyond, x)
    assert (slope, elements.magnitude(x, 1), elements.sign("a", x, 1), elements.contact("a", x, 1, 1)) == (1, 0, 0, 0)
    assert elements.within("a", x, 1) == 1


# ------------------------------------------------------------------------------------------------- torque of a damper

K, C, REACH, LEVER = 4.0e6, 2.0e4, 0.31, 0.25
"""Spring [N/m] and damper [N s/m] on a straight linkage: spring lever REACH, damper lever LEVER."""


def straight():
    return Linkage(K, lambda psi: Position(REACH * psi, REACH, LEVER * psi, LEVER), REACH, LEVER, REACH)


def torque_of(elements=None, **joints):
    """Torque as a function (psi, psi', own states) of a rigid linkage with these joints."""
    psi, rate = ca.SX.sym("psi"), ca.SX.sym("rate")
    damper, design = damper_of(topology="boeing", **joints), {"c_lambda": C}
    link = replace(straight(), series=damper.series(design))
    made = damper_torque(damper, link, design, elements or Smooth(), Attachment(psi, rate), Context())
    states = ca.vertcat(ca.SX(0, 1), *made.states.values())
    outputs = [made.torque, ca.vertcat(ca.SX(0, 1), *made.rates.values()), made.outputs["damper_force"]]
    return ca.Function("torque", [psi, rate, states], outputs)


def test_torque_of_the_rigid_linkage_by_hand():
    torque = torque_of()
    assert float(torque(0.1, 2.0, [])[0]) == pytest.approx(-K * REACH**2 * 0.1 - C * LEVER**2 * 2.0, rel=ROUNDING)


def test_torque_beyond_a_gap_is_that_of_the_rest_of_the_angle():
    """Gap g at the apex: angle g/reach to either side; inside it neither spring nor damper pulls."""
    gap = 0.01 * REACH
    torque = torque_of(freeplay=Freeplay(gap=gap, smoothing=1e-6))
    assert float(torque(0.1, 2.0, [])[0]) == pytest.approx(-K * REACH**2 * 0.09 - C * LEVER**2 * 2.0, rel=1e-9)
    assert float(torque(-0.1, 2.0, [])[0]) == pytest.approx(K * REACH**2 * 0.09 - C * LEVER**2 * 2.0, rel=1e-9)
    inside = torque(0.005, 2.0, [])
    assert abs(float(inside[0])) < 1e-3
    assert abs(float(inside[2])) < 1e-3  # force of the damper


def test_end_stop_adds_its_spring_beyond_its_stroke():
    stop = EndStop(stroke=0.01, stiffness=1e8, smoothing=1e-6)
    with_stop, without = torque_of(end_stop=stop), torque_of()
    beyond = 0.1 * LEVER - 0.01
    added = float(with_stop(0.1, 0.0, [])[0]) - float(without(0.1, 0.0, [])[0])
    assert added == pytest.approx(-1e8 * beyond * LEVER, rel=1e-9)
    assert float(with_stop(0.03, 0.0, [])[0]) == pytest.approx(float(without(0.03, 0.0, [])[0]), rel=1e-9)


def test_end_stop_without_stiffness_has_no_force():
    assert float(torque_of(end_stop=EndStop(stroke=0.01))(0.5, 0.0, [])[0]) == float(torque_of()(0.5, 0.0, [])[0])


def test_orifice_law_and_its_inverse_undo_each_other():
    """F = c v + c_2 v |v| at the rigidly attached damper; a damper behind a spring turns its force into a speed."""
    orifice = Orifice(coefficient=3e5, smoothing=1e-9)
    law, inverse = torque_of(orifice=orifice), torque_of(orifice=orifice, series_stiffness=1e7)
    for v in (-2.0, -0.3, 1e-3, 0.05, 7.0):
        force = float(law(0.0, v / LEVER, [])[2])
        assert force == pytest.approx(C * v + 3e5 * v * abs(v), rel=ROUNDING)
        # F_d = k_s (s - own) with s = 0
        assert float(inverse(0.0, 0.0, [-force / 1e7])[1]) == pytest.approx(v, rel=1e-9)


def test_orifice_is_a_linear_damper_to_first_order():
    torque = torque_of(Linear(), orifice=Orifice(coefficient=3e5))
    assert float(torque(0.0, 2.0, [])[0]) == pytest.approx(-C * LEVER**2 * 2.0, rel=ROUNDING)


# -------------------------------------------------------------------------------------------------- compliances, linear

DESIGN = LAYOUT | {"c_lambda": 2.0e4, "k_lambda": 3.8e6, "I_arm": 3.4e-6}
ELL = DESIGN["L"] * np.sin(DESIGN["gamma"])
SPEED, LOAD = 40.0, 150e3
SILENT = {
    "law": "nonlinear",
    "contact": "leading_point",
    "half_contact_length": 0.1,
    "relaxation_length": 0.3,
    "cornering_coefficient": 0.0,
    "aligning_coefficient": 0.0,
    "aligning_slip_limit": 0.2,
}


@pytest.fixture
def matrix(main_gear):
    """State matrix of the main gear with a damper and a design."""

    def of(topology="boeing", design=None, tyre=None, **joints):
        study = main_gear.replace(
            gear__order=3,
            damper=damper_block(topology, **joints),
            requirements__limit_torque=1e4,
            **({"tyre": tyre} if tyre else {}),
        )
        model = LinearModel(study)
        values = DESIGN | (design or {})
        return model.at({name: values[name] for name in model.design_names}).matrices(SPEED, LOAD)[0]

    return of


def boeing_by_hand(k_psi, c_psi, tyre=None):
    silent = {"C_F": 0.0, "C_M": 0.0, "kappa": 0.0} if tyre else {}
    return state_matrix(SPEED, LOAD, parameters(k_psi=k_psi, c_psi=c_psi, **silent), 3)


def slow_eigenvalues(A):
    """The three of the rigid gear: all but the fastest."""
    values = np.linalg.eigvals(A)
    return np.sort_complex(values[np.argsort(abs(values))][:3])


@pytest.mark.parametrize("joint", ["link_stiffness", "series_stiffness"])
def test_stiff_joint_leaves_the_rigid_eigenvalues_with_an_error_of_one_over_its_stiffness(matrix, joint):
    rigid = np.sort_complex(np.linalg.eigvals(boeing_by_hand(DESIGN["k_lambda"] * ELL**2, DESIGN["c_lambda"] * ELL**2)))
    errors = [abs(slow_eigenvalues(matrix(**{joint: k})) - rigid).max() for k in (1e8, 1e9, 1e10)]
    assert errors[0] < 20.0
    assert np.log10(errors[0] / errors[1]) == pytest.approx(1, abs=CONVERGENCE_ORDER)
    assert np.log10(errors[1] / errors[2]) == pytest.approx(1, abs=CONVERGENCE_ORDER)


def test_two_stiff_joints_leave_the_rigid_eigenvalues(matrix):
    rigid = np.sort_complex(np.linalg.eigvals(boeing_by_hand(DESIGN["k_lambda"] * ELL**2, DESIGN["c_lambda"] * ELL**2)))
    errors = [
        abs(slow_eigenvalues(matrix(geometry=geometry, link_stiffness=k, series_stiffness=k)) - rigid).max()
        for geometry in ("planar", "spatial")
        for k in (1e9, 1e10)
    ]
    assert np.log10(errors[0] / errors[1]) == pytest.approx(1, abs=CONVERGENCE_ORDER)
    assert np.log10(errors[2] / errors[3]) == pytest.approx(1, abs=CONVERGENCE_ORDER)
    assert errors[1] < 0.5


def driving_point_stiffness(A, omega, inertia=100.0):
    """Dynamic stiffness of the linkage about yaw: torque over yaw at i omega, less the inertia of the gear."""
    torque = np.zeros(len(A))
    torque[1] = 1 / inertia
    psi = np.linalg.solve(1j * omega * np.eye(len(A)) - A, torque)[0]
    return 1 / psi + inertia * omega**2


@pytest.mark.parametrize("omega", [5.0, 60.0, 400.0])
@pytest.mark.parametrize("topology", ["boeing", "utas", "arreaza"])
@pytest.mark.parametrize("joints", [("series_stiffness",), ("link_stiffness",), ("series_stiffness", "link_stiffness")])
def test_driving_point_stiffness_is_that_of_springs_and_dashpots_in_series(matrix, topology, joints, omega):
    """Damper: k_s i w c/(k_s + i w c), a Maxwell element; beside the spring; all in series with k_t ell^2."""
    k_s = 8e6 if "series_stiffness" in joints else None
    k_t = 5e6 if "link_stiffness" in joints else None
    E, R, b = 207e9, np.hypot(ELL, DESIGN["b"]), DESIGN["b"]
    k_psi, lever = {
        "boeing": (DESIGN["k_lambda"] * ELL**2, ELL),
        "utas": (3 * E * DESIGN["I_arm"] / R**3 * (ELL**2 / R) ** 2, ELL * b / R),
        "arreaza": (3 * E * DESIGN["I_arm"] / ELL, ELL),
    }[topology]
    dashpot = 1j * omega * DESIGN["c_lambda"]
    damper = dashpot if k_s is None else k_s * dashpot / (k_s + dashpot)
    expected = k_psi + damper * lever**2
    if k_t is not None:
        expected = 1 / (1 / expected + 1 / (k_t * ELL**2))
    A = matrix(topology, tyre=SILENT, **{joint: {"series_stiffness": k_s, "link_stiffness": k_t}[joint] for joint in joints})
    assert abs(driving_point_stiffness(A, omega) - expected) < DYNAMIC_STIFFNESS * abs(expected)


@pytest.mark.parametrize("topology", ["boeing", "utas", "arreaza"])
def test_static_stiffness_about_yaw_is_that_of_two_springs_in_series(matrix, topology):
    """Thesis (3-14): k_t ell^2 in series with k_psi; a damper that is nearly nothing does not take part."""
    k_t = 5e6
    A = matrix(topology, {"c_lambda": 1e-6}, tyre=SILENT, link_stiffness=k_t, series_stiffness=1e7)
    k_psi = -100.0 * matrix(topology, tyre=SILENT)[1, 0]
    static = 1 / (1 / k_psi + 1 / (k_t * ELL**2))
    assert driving_point_stiffness(A, 1e-3).real == pytest.approx(static, rel=STATIC_STIFFNESS)


def test_nearly_rigid_damper_behind_a_soft_rod_acts_as_its_rod(matrix):
    """c_lambda -> infinity: the Maxwell element is the spring k_s."""
    A = matrix(design={"c_lambda": 1e12}, tyre=SILENT, series_stiffness=8e6)
    expected = (DESIGN["k_lambda"] + 8e6) * ELL**2
    assert driving_point_stiffness(A, 60.0).real == pytest.approx(expected, rel=STATIC_STIFFNESS)


def test_a_soft_rod_takes_damping_from_the_gear(matrix):
    """With c_lambda = 1e5 N s/m and a torsional mode of some 10 Hz, a rod of 2e6 N/m makes the element a spring."""
    strong = {"c_lambda": 1e5}
    rigid, soft = matrix(design=strong), matrix(design=strong, series_stiffness=2e6)
    assert spectral_abscissa(soft) > spectral_abscissa(rigid)

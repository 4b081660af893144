"""Spatial linkage: against the same closed loop written as three points in space that must meet, with its own unknowns."""

from functools import cache

import casadi as ca
import numpy as np
import pytest
from basic_twin import E_STEEL, LAYOUT, parameters, right_hand_side, spectral_abscissa, state_matrix
from components_of import coefficients_of, damper_block, damper_of
from scipy.integrate import quad, solve_ivp
from scipy.optimize import root
from tolerances import (
    CENTRAL_DIFFERENCE,
    CENTRAL_DIFFERENCE_STEP,
    CONVERGENCE_ORDER,
    ENERGY,
    QUADRATURE,
    ROUNDING,
    SAME_LINKAGE,
    SAME_MOTION,
    printed,
)

from damperopt.dynamics import build
from damperopt.expressions.corners import Smooth
from damperopt.expressions.dae import eliminate
from damperopt.linkages.spatial import FORESHORTENING
from damperopt.motion.exact import ExactSimulator
from damperopt.motion.question import UNCLOSED
from damperopt.motion.simulate import Outputs, Simulator
from damperopt.stability.linear import LinearModel
from damperopt.symbols import data_values, symbolic

LAYOUTS = ["boeing", "utas", "arreaza"]
DESIGN = LAYOUT | {"c_lambda": 2.0e4, "k_lambda": 3.8e6, "I_arm": 3.4e-6}
ANGLES = np.concatenate([np.linspace(-0.6, 0.6, 25), [1e-3, -0.013]])


@pytest.fixture(params=LAYOUTS)
def layout(request):
    return request.param


@pytest.fixture
def study(main_gear):
    """The main gear with a spatial linkage and E = 200 GPa."""

    def change(layout, **changes):
        return main_gear.replace(
            damper=damper_block(layout, geometry="spatial"),
            material={"youngs_modulus": E_STEEL, "density": 7850.0, "yield_strength": 1e9},
            requirements__limit_torque=1e4,
            **changes,
        )

    return change


class Loop:
    """The closed loop as a mechanism: lower link at angle beta, upper assembly at angle tau, arm bent by eps.

    Lower link: from (0, 0, -h), in the plane that yaws by psi. Upper assembly: turned about the y axis at height h; in its
    own plane the bent arm ends at (u, y). The two must end in one point of space.
    """

    def __init__(self, layout, L, gamma, b, **design):
        self.layout, self.L, self.b = layout, L, b
        self.ell, self.h = L * np.sin(gamma), L * np.cos(gamma)
        self.y_root = b if layout == "utas" else 0.0
        self.arm = np.hypot(L, self.y_root)
        self.retreat = 0.0 if layout == "boeing" else 0.6 / self.arm  # of the tip along the arm, per eps^2
        self.stiffness = design["k_lambda"] if layout == "boeing" else 3 * E_STEEL * design["I_arm"] / self.arm**3
        self.damping = design["c_lambda"]
        self.guess = np.array([np.pi / 2 - gamma, np.pi / 2 - gamma, 0.0])

    def lower_end(self, beta, psi):
        flat = self.L * np.cos(beta)
        return np.array([flat * np.cos(psi), flat * np.sin(psi), self.L * np.sin(beta) - self.h])

    def upper_end(self, tau, eps):
        along, across = np.array([self.L, -self.y_root]) / self.arm, np.array([self.y_root, self.L]) / self.arm
        u, y = np.array([0.0, self.y_root]) + (self.arm - self.retreat * eps**2) * along + eps * across
        return np.array([u * np.cos(tau), y, self.h - u * np.sin(tau)])

    def misses(self, q, psi):
        """Vector from the upper to the lower end, for q = (beta, tau, eps)."""
        return self.lower_end(q[0], psi) - self.upper_end(q[1], q[2])

    def closed(self, psi):
        """(beta, tau, eps) that close the loop: SciPy, polished to rounding, from rest by steps of 0.1 rad at most."""
        q = self.guess
        for angle in np.linspace(0.0, psi, 2 + int(abs(psi) / 0.1))[1:]:
            q = root(self.misses, q, args=(angle,), tol=1e-15).x
        for _ in range(2):
            q = q - np.linalg.solve(self.slopes(q, psi)[0], self.misses(q, psi))
        return q

    def slopes(self, q, psi):
        """Derivatives of `misses` with respect to q and to psi."""
        beta, tau, eps = q
        sin, cos = np.sin, np.cos
        lower = -self.L * np.array([sin(beta) * cos(psi), sin(beta) * sin(psi), -cos(beta)])
        u = (self.upper_end(0.0, eps))[0]
        du, dy = self.y_root / self.arm, self.L / self.arm
        du -= 2 * self.retreat * eps * self.L / self.arm
        dy += 2 * self.retreat * eps * self.y_root / self.arm
        by_tau = np.array([-u * sin(tau), 0.0, -u * cos(tau)])
        by_eps = np.array([du * cos(tau), dy, -du * sin(tau)])
        by_psi = self.L * cos(beta) * np.array([-sin(psi), cos(psi), 0.0])
        return np.column_stack([lower, -by_tau, -by_eps]), by_psi

    def root_of_damper(self):
        return {
            "utas": np.array([0.0, -self.b, self.h]),
            "arreaza": np.array([self.ell, -self.b, 0.0]),
        }[self.layout]

    def length(self, psi, q):
        if self.layout == "boeing":
            return q[2]
        return np.linalg.norm(self.lower_end(q[0], psi) - self.root_of_damper())

    def lengths(self, psi):
        """Deflection and damper stroke."""
        q = self.closed(psi)
        return np.array([q[2], self.length(psi, q) - self.length(0.0, self.guess)])

    def levers(self, psi):
        """Their derivatives by finite differences."""
        h = CENTRAL_DIFFERENCE_STEP
        return (self.lengths(psi + h) - self.lengths(psi - h)) / (2 * h)

    def torque(self):
        """Torque (psi, rate) -> N m by virtual work, each loop closed from the one before."""
        q = self.guess

        def torque(psi, rate):
            nonlocal q
            for _ in range(20):
                matrix, by_psi = self.slopes(q, psi)
                step = np.linalg.solve(matrix, self.misses(q, psi))
                q = q - step
                if abs(step).max() < 1e-14:
                    break
            change = -np.linalg.solve(matrix, by_psi)
            if self.layout == "boeing":
                ds = change[2]
            else:
                arm = self.lower_end(q[0], psi) - self.root_of_damper()
                ds = arm @ (matrix[:, 0] * change[0] + by_psi) / np.linalg.norm(arm)
            return -self.stiffness * q[2] * change[2] - self.damping * ds**2 * rate

        return torque


def outputs(study, angles, rate=0.0, **design):
    """Outputs of the package by name at yaw angles and a yaw rate."""
    dae = build(symbolic(study), Smooth())
    found = Outputs(dae, study)
    states = np.zeros((len(dae.state_names), len(angles)))
    states[0], states[1] = angles, rate
    return dict(
        zip(found.names, found(states, [(DESIGN | design)[name] for name in dae.design_names], 40.0, 150e3, 0.0), strict=True)
    )


def number(expression):
    return float(ca.evalf(ca.SX(expression)))


# ----------------------------------------------------------------------------------------------------------- geometry


def test_reference_numbers_of_the_theory_page(study):
    found = damper_of(topology="utas", geometry="spatial").linkage(DESIGN, E_STEEL)
    assert number(found.spring_lever) == printed("0.32574")
    assert number(found.damper_lever) == printed("0.19544")
    assert outputs(study("utas"), [0.2, -0.2])["spring_deflection"].tolist() == [printed("0.067372"), printed("-0.061720")]


def test_tip_retreat_is_half_the_integral_of_the_squared_slope():
    """Of a cantilever of length 1 loaded at its tip, w = (3 x^2 - x^3)/2 for a unit deflection."""
    retreat = quad(lambda x: ((6 * x - 3 * x**2) / 2) ** 2 / 2, 0.0, 1.0)[0]
    assert pytest.approx(retreat, rel=QUADRATURE) == FORESHORTENING


def test_lengths_are_those_of_three_points_that_meet(study, layout):
    loop, found = Loop(layout, **DESIGN), outputs(study(layout), ANGLES)
    eps, stroke = np.array([loop.lengths(psi) for psi in ANGLES]).T
    np.testing.assert_allclose(found["spring_deflection"], eps, rtol=0, atol=SAME_LINKAGE)
    np.testing.assert_allclose(found["damper_stroke"], stroke, rtol=0, atol=SAME_LINKAGE)
    assert found["unclosed"].max() < SAME_LINKAGE


def test_levers_are_the_slopes_of_these_lengths(study, layout):
    """Damper lever from the speed at a yaw rate of 1 rad/s, spring lever from the torque at rest."""
    angles = ANGLES[abs(ANGLES) > 1e-2]
    loop, at_rest, moving = Loop(layout, **DESIGN), outputs(study(layout), angles), outputs(study(layout), angles, 1.0)
    of_spring, of_damper = np.array([loop.levers(psi) for psi in angles]).T
    found = -at_rest["linkage_torque"] / at_rest["spring_force"]
    np.testing.assert_allclose(found, of_spring, rtol=CENTRAL_DIFFERENCE)
    np.testing.assert_allclose(moving["damper_speed"], of_damper, rtol=CENTRAL_DIFFERENCE)


def test_damping_torque_is_force_times_lever(study, layout):
    """c_lambda (ds/dpsi)^2 psi', with the slope of the damper length of the loop in the test."""
    loop, angles = Loop(layout, **DESIGN), [-0.4, 0.05, 0.3]
    lost = outputs(study(layout), angles)["linkage_torque"] - outputs(study(layout), angles, 2.0)["linkage_torque"]
    expected = [2.0 * DESIGN["c_lambda"] * loop.levers(psi)[1] ** 2 for psi in angles]
    np.testing.assert_allclose(lost, expected, rtol=CENTRAL_DIFFERENCE)


# ----------------------------------------------------------------------------------------------------------- symmetry


def test_boeing_is_mirror_symmetric(study):
    angles = np.linspace(0.02, 0.6, 20)
    right, left = outputs(study("boeing"), angles, 1.0), outputs(study("boeing"), -angles, -1.0)
    for name in ("spring_deflection", "damper_stroke", "damper_speed", "linkage_torque"):
        np.testing.assert_allclose(right[name], -left[name], rtol=ROUNDING)


def test_arm_of_the_new_design_is_mirror_symmetric(study):
    angles = np.linspace(0.02, 0.6, 20)
    right, left = outputs(study("arreaza"), angles), outputs(study("arreaza"), -angles)
    for name in ("spring_deflection", "linkage_torque"):
        np.testing.assert_allclose(right[name], -left[name], rtol=ROUNDING)


def asymmetry(study, layout, angles, name):
    """Of a quantity at a yaw rate of 1 rad/s, even if it should be odd and odd if it should be even."""
    right, left = outputs(study(layout), angles, 1.0)[name], outputs(study(layout), -angles, 1.0)[name]
    return right - left if name == "damper_speed" else right + left


@pytest.mark.parametrize(
    ("layout", "name", "order"),
    [
        ("arreaza", "damper_speed", 3),  # apex leaves the damper's line by O(psi^2), its length feels the square of that
        ("arreaza", "damper_stroke", 4),
        ("utas", "damper_speed", 1),
        ("utas", "damper_stroke", 2),
        ("utas", "spring_deflection", 2),
    ],
)
def test_order_of_the_asymmetry(study, layout, name, order):
    angles = np.array([0.02, 0.04])
    small, large = asymmetry(study, layout, angles, name)
    assert abs(small) > 0
    assert np.log2(large / small) == pytest.approx(order, abs=CONVERGENCE_ORDER)


def test_a_longer_damper_makes_the_new_design_more_symmetric(study):
    """The damper's part of the asymmetry goes with 1/b."""
    at = np.array([0.1])
    by_length = []
    for b in (0.2, 0.4):
        right, left = outputs(study("arreaza"), at, 1.0, b=b), outputs(study("arreaza"), -at, 1.0, b=b)
        by_length.append((right["damper_speed"] - left["damper_speed"])[0])
    assert by_length[0] / by_length[1] == pytest.approx(2.0, rel=0.05)


# ------------------------------------------------------------------------------------------------------- small angles


def coefficients(layout):
    """(k_psi, c_psi) by hand. An apex that moves sideways by ell psi bends an arm at angle atan(b/L) by its part across the
    arm, over L/l_arm, since the tip can move along the arm only by turning the assembly; damper of UTAS: 2 b ell/l_arm."""
    d = DESIGN
    ell, arm = d["L"] * np.sin(d["gamma"]), np.hypot(d["L"], d["b"])
    if layout == "boeing":
        return d["k_lambda"] * ell**2, d["c_lambda"] * ell**2
    if layout == "utas":
        return 3 * E_STEEL * d["I_arm"] / arm**3 * (ell * arm / d["L"]) ** 2, d["c_lambda"] * (2 * d["b"] * ell / arm) ** 2
    return 3 * E_STEEL * d["I_arm"] / d["L"] ** 3 * ell**2, d["c_lambda"] * ell**2


def test_stiffness_and_damping_at_rest_by_hand(layout):
    found = damper_of(topology=layout, geometry="spatial").linkage(DESIGN, E_STEEL)
    assert number(found.torsional_stiffness) == pytest.approx(coefficients(layout)[0], rel=ROUNDING)
    assert coefficients_of(damper_of(topology=layout, geometry="spatial"), DESIGN, E_STEEL)[1] == pytest.approx(
        coefficients(layout)[1], rel=ROUNDING
    )


@pytest.mark.parametrize("order", [3, 5])
@pytest.mark.parametrize("rake", [0.0, 0.1571])
def test_linear_gear_has_the_matrix_and_eigenvalues_of_the_twin(study, layout, order, rake):
    model = LinearModel(study(layout, gear__order=order, gear__rake_angle=rake))
    gear = model.at({name: DESIGN[name] for name in model.design_names})
    k_psi, c_psi = coefficients(layout)
    for V, F_z in ((40.0, 150e3), (90.0, 350e3)):
        found, expected = gear.matrices(V, F_z)[0], state_matrix(V, F_z, parameters(phi=rake, k_psi=k_psi, c_psi=c_psi), order)
        np.testing.assert_allclose(found, expected, rtol=ROUNDING, atol=ROUNDING)
        assert gear.abscissa(V, F_z)[0] == pytest.approx(spectral_abscissa(expected), rel=0, abs=ROUNDING * abs(expected).max())


# ------------------------------------------------------------------------------------------------------------- motion

SILENT = {
    "law": "nonlinear",
    "contact": "leading_point",
    "half_contact_length": 0.1,
    "relaxation_length": 0.3,
    "cornering_coefficient": 0.0,
    "aligning_coefficient": 0.0,
    "aligning_slip_limit": 0.2,
    "slip_range": 1.4,
}
"""A tyre without forces: what is left is the piston on its linkage."""


TIGHT = {"erk": 1e-11, "cvodes": 1e-11, "idas": 1e-10, "exact": 1e-11}
"""Tolerances; that of IDAS is 1/100 of the one asked for, and it cannot start below 1e-12."""


@pytest.fixture
def interpreted(monkeypatch):
    """No compilation: it takes longer than these motions."""
    monkeypatch.setattr("damperopt.motion.integrators.has_compiler", lambda: False)


def simulator(study, design, engine, tolerance):
    design = {name: value for name, value in design.items() if name in study.start}
    if engine == "exact":
        exact = ExactSimulator(study, design)
        return lambda *arguments: exact(*arguments, tolerance=tolerance, points=200)
    return Simulator(study, design, engine, tolerance)


@pytest.mark.parametrize("engine", ["erk", "cvodes", "idas", "exact"])
def test_energy_of_the_undamped_linkage_is_constant(study, layout, engine, interpreted):
    """I psi'^2/2 + k eps(psi)^2/2, with eps of the loop in the test; five cycles from 0.2 rad."""
    gear = study(layout, gear__order=3, tyre=SILENT)
    motion = simulator(gear, DESIGN | {"c_lambda": 1e-15}, engine, TIGHT[engine])(
        40.0, 150e3, {"release": {"yaw_angle": 0.2}}, 0.5
    )
    assert motion.status == "completed"
    loop, some = Loop(layout, **DESIGN), slice(None, None, 17)
    psi, rate = motion["yaw_angle"][some], motion["yaw_rate"][some]
    eps = np.array([loop.lengths(angle)[0] for angle in psi])
    energy = 100.0 * rate**2 / 2 + loop.stiffness * eps**2 / 2
    assert np.ptp(psi) > 0.3
    np.testing.assert_allclose(energy, loop.stiffness * loop.lengths(0.2)[0] ** 2 / 2, rtol=ENERGY)


@cache
def motion_of_the_loop(layout):
    p = parameters(torque=Loop(layout, **(DESIGN | {"c_lambda": 3e3})).torque())
    start = [0.1, 0.0, 0.0, 0.1, 0.0]
    accuracy = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-14, "max_step": 2e-3}
    return solve_ivp(lambda t, x: right_hand_side(x, 40.0, 150e3, p), (0.0, 0.1), start, dense_output=True, **accuracy).sol


@pytest.mark.parametrize("engine", ["erk", "cvodes", "idas", "exact"])
def test_motion_is_that_of_the_twin_on_the_loop(study, layout, engine, interpreted):
    """Fifth-order gear with tyre and damper; SciPy's DOP853 with the loop closed by Newton's method at every call."""
    gear = study(layout)
    motion = simulator(gear, DESIGN | {"c_lambda": 3e3}, engine, TIGHT[engine])(
        40.0, 150e3, {"release": {"yaw_angle": 0.1}, "kick": {"bending_rate": 0.1}}, 0.1
    )
    # inside the slip limit, where the law of the tyre is smooth
    assert abs(motion["slip_angle"]).max() < parameters().alpha_m
    for values, state in zip(motion_of_the_loop(layout)(motion.time), motion.states.values(), strict=True):
        assert abs(state - values).max() < SAME_MOTION * abs(values).max()


@pytest.mark.parametrize("tolerance", [1e-13, 1e-11, 1e-3])
@pytest.mark.parametrize("engine", ["erk", "cvodes", "idas"])
def test_every_engine_runs_at_every_tolerance_that_is_allowed(study, engine, tolerance, interpreted):
    motion = simulator(study("boeing"), DESIGN, engine, tolerance)(40.0, 150e3, {"release": {"yaw_angle": 0.1}}, 0.05)
    assert (motion.status, motion.message) == ("completed", "")


# --------------------------------------------------------------------------------------------------------- large angles

FLAT = DESIGN | {"gamma": np.deg2rad(60.0), "b": 0.6, "I_arm": 1e-8, "c_lambda": 1.0}
"""Flat links and an arm that stands out far: its tip moves up and down more than sideways. It closes up to 1 rad."""


def test_large_kick_ends_the_exact_motion_at_one_radian(study):
    gear = study("utas", gear__order=3, tyre=SILENT)
    motion = simulator(gear, FLAT, "exact", 1e-9)(40.0, 150e3, {"kick": {"yaw_rate": -20.0}}, 0.3)
    assert motion.status == "stopped"
    assert motion.message.startswith("the yaw angle exceeds 1 rad")
    assert motion["yaw_angle"][-2] > -1.0 > motion["yaw_angle"][-1]
    eps = [Loop("utas", **FLAT).lengths(psi)[0] for psi in motion["yaw_angle"][::5]]
    np.testing.assert_allclose(motion["spring_deflection"][::5], eps, rtol=0, atol=SAME_LINKAGE)


@pytest.mark.parametrize("engine", ["erk", pytest.param("cvodes", marks=pytest.mark.slow), "idas"])
def test_large_kick_stops_the_smooth_motion_and_keeps_what_was_right(study, engine, interpreted):
    """Newton's method from the first-order guess fails at some angle before 1 rad; up to there the loop is closed."""
    gear = study("utas", gear__order=3, tyre=SILENT)
    motion = simulator(gear, FLAT, engine, 1e-8)(40.0, 150e3, {"kick": {"yaw_rate": -20.0}}, 0.3)
    assert motion.status == "stopped"
    assert motion["yaw_angle"].min() < -0.6
    assert motion.message.count(" after ") == 1
    psi = motion["yaw_angle"][:-1]
    eps = [Loop("utas", **FLAT).lengths(angle)[0] for angle in psi[::5]]
    np.testing.assert_allclose(motion["spring_deflection"][:-1][::5], eps, rtol=0, atol=10 * UNCLOSED)


@pytest.mark.parametrize("angle", [-0.9, 0.9])
def test_unknowns_are_not_eliminated_unnoticed_where_newton_fails(study, angle):
    """Either the deflection is right or the residual tells."""
    found = outputs(study("utas"), [angle], **FLAT)
    right = abs(found["spring_deflection"][0] - Loop("utas", **FLAT).lengths(angle)[0]) < SAME_LINKAGE
    assert right == (found["unclosed"][0] < SAME_LINKAGE)
    assert right == (angle > 0)


def test_more_newton_steps_square_the_residual(study):
    """At 0.5 rad, where the first-order guess is visibly off."""
    gear = study("utas")
    dae = build(symbolic(gear), Smooth())
    design = [DESIGN[name] for name in dae.design_names]
    x = np.zeros(5)
    x[0] = 0.5

    def unclosed(steps):
        model = eliminate(dae, steps)
        function = ca.Function("unclosed", [model.x, *model.parameters], [model.outputs["unclosed"]])
        return float(function(x, design, 40.0, 150e3, data_values(gear), 0.0))

    first, second, third = (unclosed(steps) for steps in (0, 1, 2))
    assert first > 1e-3
    assert second < 10 * first**2
    assert third < 10 * second**2
    assert unclosed(6) < SAME_LINKAGE

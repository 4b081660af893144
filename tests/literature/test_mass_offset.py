"""Lateral translation and a swivelling mass off the axis, against matrices and Lagrange's equations written out by hand."""

from __future__ import annotations

import numpy as np
import pytest
import sympy
from pydantic import ValidationError
from scipy.integrate import solve_ivp
from scipy.linalg import eigvals, expm
from table_gear import TYRE, eigenvalues, table_gear

from damperopt import simulate_exactly
from damperopt.stability.linear import linear_gear

V, F, E_T, SIGMA, A = 40.0, 150e3, 0.12, 0.3, 0.1
SIDEWAYS = {"mass": 96.0, "stiffness": 9.76e5, "damping": 48.0}  # I_x, k_delta, c_delta of the table over l_g^2
SWIVELLING = {"mass": 80.0, "offset": 0.15}


def pencil(M, C, K, e, l):
    """Eigenvalues of M q'' + C q' + K q = B y with the string y, for q = (yaw, lateral motion of lever l)."""
    slope, C_M, kappa = 0.014, 1.0, 570.0
    C = C + np.diag([kappa / V, 0.0])
    B = -F / SIGMA * np.array([[e * slope + C_M], [l * slope]])
    Z, one, column = np.zeros((2, 2)), np.eye(2), np.zeros((2, 1))
    left = np.block([[one, Z, column], [Z, M, column], [np.zeros((1, 4)), np.ones((1, 1))]])
    right = np.vstack([np.hstack([Z, one, column]), np.hstack([-K, -C, B]), [[V, 0.0, e - A, l, -V / SIGMA]]])
    found = eigvals(right, left)
    return sorted(found[found.imag >= 0], key=lambda value: -value.real)


def test_translation_against_matrices_written_out():
    P = 80.0 * 0.15
    M = np.array([[100.0, P], [P, 96.0]])
    expected = pencil(M, np.diag([300.0, 48.0]), np.diag([3.8e5, 9.76e5]), E_T, 1.0)
    found = eigenvalues(table_gear(kind="yaw_translation", sideways=SIDEWAYS, swivelling=SWIVELLING), V)
    np.testing.assert_allclose(found, expected, rtol=1e-10)


def test_translation_of_the_table_is_bending_without_the_moment_of_the_load():
    """l_g delta = w; what is missing is F_z e psi on bending, which a strut that does not roll has not."""
    K = np.array([[3.8e5, 0.0], [0.0, 6.1e6]])
    expected = pencil(np.diag([100.0, 600.0]), np.diag([300.0, 300.0]), K, E_T, 2.5)
    found = eigenvalues(table_gear(kind="yaw_translation", sideways=SIDEWAYS), V)
    np.testing.assert_allclose(found, expected, rtol=1e-10)


def test_bending_with_offset_against_matrices_written_out():
    P = 80.0 * 0.15 * 2.1
    M = np.array([[100.0, P], [P, 600.0]])
    K = np.array([[3.8e5, 0.0], [-F * E_T, 6.1e6]])
    expected = pencil(M, np.diag([300.0, 300.0]), K, E_T, 2.5)
    study = table_gear(swivelling=SWIVELLING, swivelling_height=2.1)
    assert study.gear.kind == "yaw_bending_offset"
    np.testing.assert_allclose(eigenvalues(study, V), expected, rtol=1e-10)


def test_spin_does_no_work_with_an_offset():
    P = 80.0 * 0.15 * 2.1
    M = np.array([[100.0, P], [P, 600.0]])
    keys = {"kind": "yaw_bending_offset", "swivelling": SWIVELLING, "swivelling_height": 2.1}
    spun, still = (table_gear(**keys, **spin) for spin in ({"wheel_polar_inertia": 6.0}, {}))
    change = (linear_gear(spun).matrices(V, F) - linear_gear(still).matrices(V, F))[0][np.ix_([1, 3], [1, 3])]
    h = 6.0 * V / 0.362
    np.testing.assert_allclose(M @ change, [[0.0, h], [-h, 0.0]], atol=1e-9 * h)


def lagrange(translation):
    """Accelerations of the free gear by Lagrange's equations, derived here by SymPy; and its energy."""
    t = sympy.symbols("t")
    psi, q = sympy.Function("psi")(t), sympy.Function("q")(t)
    where = q if translation else 2.1 * sympy.sin(q)
    m, x_g, I_z, I_q, k, k_q = 80.0, 0.15, 100.0, 96.0 if translation else 600.0, 3.8e5, 9.76e5 if translation else 6.1e6
    mass = (where + x_g * sympy.sin(psi)).diff(t) ** 2 * m / 2
    # of the swivelling mass both parts of its own are in I_z and I_q: only the product is new
    own = where.diff(t) ** 2 * m / 2 + (x_g * sympy.sin(psi)).diff(t) ** 2 * m / 2
    T = I_z * psi.diff(t) ** 2 / 2 + I_q * q.diff(t) ** 2 / 2 + sympy.expand(mass - own)
    L = T - k * psi**2 / 2 - k_q * q**2 / 2
    equations = [L.diff(u.diff(t)).diff(t) - L.diff(u) for u in (psi, q)]
    names = sympy.symbols("a_1 a_2 p u p_t u_t")
    swaps = [(psi.diff(t, 2), names[0]), (q.diff(t, 2), names[1]), (psi.diff(t), names[4]), (q.diff(t), names[5])]
    equations = [e.doit().subs(swaps).subs([(psi, names[2]), (q, names[3])]) for e in equations]
    solved = sympy.solve(equations, names[:2])
    return sympy.lambdify(names[2:], [solved[a] for a in names[:2]])


@pytest.mark.parametrize("translation", [True, False])
def test_large_motion_is_lagranges(translation):
    """Without tyre, dampers and load at a lever: a swing of half a radian, with the centrifugal terms."""
    none = {**TYRE, "cornering_slope": 0.0, "aligning_coefficient": 0.0, "tread_width_moment": 0.0}
    lateral = {"inertia": 600.0, "stiffness": 6.1e6, "damping": 0.0, "height": 2.5}
    keys = (
        {"kind": "yaw_translation", "sideways": {**SIDEWAYS, "damping": 0.0}}
        if translation
        else {"lateral": lateral, "swivelling_height": 2.1}
    )
    study = table_gear(3.8e5, 0.0, none, caster_length=0.0, swivelling=SWIVELLING, **keys)
    motion = simulate_exactly(study, speed=20.0, disturbance={"release": {"yaw_angle": 0.5}}, duration=0.3, points=61)
    accelerations = lagrange(translation)
    twin = solve_ivp(
        lambda t, x: [x[2], x[3], *accelerations(*x)], (0, 0.3), [0.5, 0, 0, 0], rtol=1e-11, atol=1e-13, t_eval=motion.time
    )
    other = "translation" if translation else "bending_angle"
    for name, row in (("yaw_angle", 0), (other, 1)):
        np.testing.assert_allclose(motion[name], twin.y[row], rtol=0, atol=1e-8 * np.abs(twin.y[row]).max())


def test_friction_holds_against_the_inertia_of_the_other_motion():
    """While the swivel sticks the strut swings as if it were rigid, and friction carries P w'' and the tyre's torque."""
    P, m, k, c, slope = 12.0, 96.0, 9.76e5, 48.0, 0.014
    # w, w', y with psi = 0: y' = w' - V y/sigma, F_y = slope F y/sigma
    held = np.array([[0.0, 1.0, 0.0], [-k / m, -c / m, -slope * F / (SIGMA * m)], [0.0, 1.0, -V / SIGMA]])
    times = np.linspace(0.0, 0.1, 2001)
    x = np.array([expm(held * t) @ [0.0, 0.0, 1e-4] for t in times])
    needed = np.abs(P * (x @ held[1]) + (E_T * slope + 1.0) * F / SIGMA * x[:, 2]).max()
    for torque, moves in ((1.001 * needed, False), (0.999 * needed, True)):
        study = table_gear(kind="yaw_translation", sideways=SIDEWAYS, swivelling=SWIVELLING, friction={"torque": torque})
        release = {"release": {"string_deflection": 1e-4}}
        motion = simulate_exactly(study, speed=V, disturbance=release, duration=0.1, points=2001)
        assert motion["yaw_angle"].any() == moves
        if not moves:
            np.testing.assert_allclose(motion["translation"], x[:, 0], rtol=0, atol=1e-6 * np.abs(x[:, 0]).max())


def test_mass_that_the_inertias_do_not_hold_is_refused():
    with pytest.raises(ValidationError, match=r"yaw_inertia 100 is not above 180, what the swivelling mass alone has"):
        table_gear(kind="yaw_translation", sideways=SIDEWAYS, swivelling={"mass": 80.0, "offset": 1.5})
    with pytest.raises(ValidationError, match=r"inertia 600 is not above 720"):
        table_gear(swivelling=SWIVELLING, swivelling_height=3.0)

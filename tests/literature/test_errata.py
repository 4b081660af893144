"""Errata of C. Arreaza's thesis (Toronto, 2015), each as an exact difference between what is printed and what follows.

Equation numbers are those of the thesis. Every function `printed_...` transcribes one page of it, letter by letter where
the letters differ (`c_lambda`, `k_lambda` where (3-16)..(3-20) and (3-33)..(3-36) write c_delta, k_delta for the damper; c_y,
k_y for the lateral damping and stiffness). What follows is worked out from the thesis' own matrix (3-5) by the recursion of
Faddeev and LeVerrier in rational numbers, at random points: a difference that equals the stated term at each of them equals
it everywhere, the coefficients being polynomials of low degree in the parameters and their reciprocals.
"""

from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
from basic_twin import LAYOUT, parameters, published_coefficients, side_force, state_matrix
from components_of import damper_block
from numpy.polynomial import Polynomial
from scipy.integrate import quad
from tolerances import CHARACTERISTIC_POLYNOMIAL, QUADRATURE, ROUNDING

from damperopt.literature.arreaza2015.charts import MISPRINTS_OF
from damperopt.literature.arreaza2015.printed import COEFFICIENTS, MISPRINTS
from damperopt.stability.hurwitz import characteristic_polynomial, hurwitz_determinants
from damperopt.stability.linear import LinearModel

printed_boeing, printed_utas, printed_new_design = (COEFFICIENTS[layout] for layout in ("boeing", "utas", "arreaza"))

OF_GEAR = ("I_x", "I_z", "V", "sigma", "kappa", "C_F", "C_M", "F_z", "l_g", "e", "a", "k_y", "c_y", "sin_phi", "sin_psi")
OF_DAMPER = ("c_lambda", "k_lambda", "E", "I_arm", "L", "sin_gamma", "sin_alpha", "R", "b")


@pytest.fixture(params=range(5), ids=lambda seed: f"point{seed}")
def p(request):
    """Random positive rational values of every symbol, no two alike, so that no term vanishes or cancels by chance."""
    random = np.random.default_rng(2015 + request.param)
    primes = [n for n in range(2, 110) if all(n % d for d in range(2, n))]
    above, below = random.permutation(primes).tolist(), random.permutation(primes).tolist()
    values = [Fraction(x, y) for x, y in zip(above, below, strict=True) if x != y]
    return SimpleNamespace(**dict(zip((*OF_GEAR, *OF_DAMPER), values, strict=False)))


def changed(p, **values):
    return SimpleNamespace(**(vars(p) | values))


# ---------------------------------------------------------------------------------------------- exact linear algebra


def coefficients(A):
    """[1, a_1, ..., a_n] of det(l I - A) in the arithmetic of the entries (Faddeev and LeVerrier)."""
    n = len(A)
    M = [[Fraction(i == j) for j in range(n)] for i in range(n)]
    found = [Fraction(1)]
    for k in range(1, n + 1):
        M = [[sum(A[i][m] * M[m][j] for m in range(n)) for j in range(n)] for i in range(n)]
        found.append(-sum(M[i][i] for i in range(n)) / k)
        for i in range(n):
            M[i][i] += found[-1]
    return found


def jacobian(right_hand_side, order):
    """Matrix of a linear map by its values at the unit vectors."""
    units = [[Fraction(i == j) for i in range(order)] for j in range(order)]
    columns = [right_hand_side(*unit) for unit in units]
    return [[columns[j][i] for j in range(order)] for i in range(order)]


def difference(A, B):
    """Entries in which two matrices differ, {(row, column): A - B}, counted from 1."""
    n = range(len(A))
    return {(i + 1, j + 1): A[i][j] - B[i][j] for i in n for j in n if A[i][j] != B[i][j]}


# --------------------------------------------------------------------------------------- what the thesis prints


def printed_matrix_3_2(p, k_psi, c_psi):
    """(3-2), states psi, psi', y."""
    return [
        [0, 1, 0],
        [-k_psi / p.I_z, -c_psi / p.I_z + p.kappa / (p.V * p.I_z), p.F_z * (p.C_M - p.e * p.C_F) / (p.I_z * p.sigma)],
        [p.V, p.e - p.a, -p.V / p.sigma],
    ]


def printed_matrix_3_5(p, k_psi, c_psi):
    """(3-5), states psi, psi', delta, delta', y."""
    yaw_of_string = p.F_z * (p.C_M - p.e * p.C_F) / (p.I_z * p.sigma)
    bending_of_string = -p.l_g * p.F_z * p.C_F / (p.I_x * p.sigma)
    return [
        [0, 1, 0, 0, 0],
        [-k_psi / p.I_z, -c_psi / p.I_z + p.kappa / (p.V * p.I_z), 0, 0, yaw_of_string],
        [0, 0, 0, 1, 0],
        [p.F_z * p.e / p.I_x, 0, -p.k_y / p.I_x, -p.c_y / p.I_x, bending_of_string],
        [p.V, p.e - p.a, 0, p.l_g, -p.V / p.sigma],
    ]


def printed_3_1(p, k_psi, c_psi, M_z):
    """psi'' of (3-1) with F_y of (2-11), M_kappa of (2-13), and y' of (2-8), as a function of psi, psi', y."""

    def right_hand_side(psi, psi_t, y):
        alpha = y / p.sigma
        F_y, M_kappa = p.C_F * alpha * p.F_z, p.kappa * psi_t / p.V
        psi_tt = -(k_psi * psi + c_psi * psi_t + F_y * p.e + M_z(alpha) + M_kappa) / p.I_z
        return psi_t, psi_tt, -p.V / p.sigma * y + p.V * psi + (p.e - p.a) * psi_t

    return right_hand_side


def printed_3_3_and_3_4(p, k_psi, c_psi, M_z):
    """(3-3), (3-4), (2-14), linear in the states, rake 0, as a function of psi, psi', delta, delta', y."""

    def right_hand_side(psi, psi_t, delta, delta_t, y):
        psi_t, psi_tt, y_t = printed_3_1(p, k_psi, c_psi, M_z)(psi, psi_t, y)
        F_y = p.C_F * y / p.sigma * p.F_z
        delta_tt = -(p.k_y * delta + p.c_y * delta_t + p.l_g * F_y - p.F_z * p.e * psi) / p.I_x
        return psi_t, psi_tt, delta_t, delta_tt, y_t + p.l_g * delta_t

    return right_hand_side


def restoring_moment(p):
    """M_z of (2-12), linear part."""
    return lambda alpha: p.C_M * alpha * p.F_z


def straight_tangent_moment(p):
    """M_z of (2-5), with the load factor of (2-12)."""
    return lambda alpha: -p.C_M * alpha * p.F_z


# ------------------------------------------------------------------------------- what follows from matrix (3-5)


def derived_boeing(p):
    """det(l I - A) with (3-11), (3-12) and without lateral damping, as (3-15)..(3-20) assume."""
    ell2 = p.L**2 * p.sin_gamma**2
    return coefficients(printed_matrix_3_5(changed(p, c_y=0), p.k_lambda * ell2, p.c_lambda * ell2))


def derived_utas(p):
    """I_x I_z V sigma det(l I - A) with (3-26), (3-30) and without lateral damping, as (3-32)..(3-37) assume."""
    ell = p.L * p.sin_gamma
    k_psi, c_psi = 2 * p.E * p.I_arm * ell * p.sin_alpha / p.R**2, p.c_lambda * ell**2 * p.b / (10 * p.R)
    scale = p.I_x * p.I_z * p.V * p.sigma
    return [scale * a for a in coefficients(printed_matrix_3_5(changed(p, c_y=0), k_psi, c_psi))]


def derived_new_design(p, k_psi):
    """I_x I_z V sigma det(l I - A) with (3-45) and a given stiffness."""
    scale = p.I_x * p.I_z * p.V * p.sigma
    return [scale * a for a in coefficients(printed_matrix_3_5(p, k_psi, p.c_lambda * p.L**2 * p.sin_gamma**2))]


def stiffness_3_42(p):
    return 2 * p.E * p.I_arm / (p.L * p.sin_gamma)


def stiffness_of_the_coefficients(p):
    """What (3-47)..(3-52) put in the place of (3-42)."""
    return 2 * p.E * p.I_arm / (p.L * p.sin_gamma) ** 2


# --------------------------------------------------------------------------------------- errata 1 and 2: two signs


def test_erratum_1_matrices_flip_the_sign_of_the_tread_damping_of_3_1(p):
    k_psi, c_psi, M_z = p.k_lambda, p.c_lambda, straight_tangent_moment(p)
    sign = {(2, 2): 2 * p.kappa / (p.V * p.I_z)}
    assert difference(printed_matrix_3_2(p, k_psi, c_psi), jacobian(printed_3_1(p, k_psi, c_psi, M_z), 3)) == sign
    assert difference(printed_matrix_3_5(p, k_psi, c_psi), jacobian(printed_3_3_and_3_4(p, k_psi, c_psi, M_z), 5)) == sign


@pytest.mark.parametrize("printed", [printed_boeing, printed_utas, printed_new_design])
def test_erratum_1_tread_damping_lowers_every_printed_coefficient_that_has_it(p, printed):
    """a_1 .. a_4 fall with kappa as printed; a_5, and a_0, do not have it. Physical tread damping raises them all."""
    without, with_kappa = printed(changed(p, kappa=Fraction(0))), printed(p)
    assert [(x > y) - (x < y) for x, y in zip(with_kappa, without, strict=True)] == [0, -1, -1, -1, -1, 0]
    M_z = straight_tangent_moment(p)
    physical = coefficients(jacobian(printed_3_3_and_3_4(p, p.k_lambda, p.c_lambda, M_z), 5))
    undamped = changed(p, kappa=Fraction(0))
    baseline = coefficients(jacobian(printed_3_3_and_3_4(undamped, p.k_lambda, p.c_lambda, M_z), 5))
    assert [(x > y) - (x < y) for x, y in zip(physical, baseline, strict=True)] == [0, 1, 1, 1, 1, 0]


def test_erratum_2_aligning_moment_of_3_1_and_2_12_contradicts_the_matrices(p):
    k_psi, c_psi = p.k_lambda, p.c_lambda
    from_equation = jacobian(printed_3_1(p, k_psi, c_psi, restoring_moment(p)), 3)
    moment = 2 * p.C_M * p.F_z / (p.I_z * p.sigma)
    found = difference(printed_matrix_3_2(p, k_psi, c_psi), from_equation)
    assert found == {(2, 2): 2 * p.kappa / (p.V * p.I_z), (2, 3): moment}


def test_erratum_2_negative_coefficient_restores_in_the_matrices_and_diverges_in_3_1(p):
    """Table 0.1 prints C_M = -1: (3-2) then turns the wheel back, (3-1) with (2-12) turns it further."""
    table = changed(p, C_F=Fraction(0), C_M=Fraction(-1))
    assert printed_matrix_3_2(table, 1, 1)[1][2] < 0
    assert jacobian(printed_3_1(table, 1, 1, restoring_moment(table)), 3)[1][2] > 0


def test_both_signs_put_right_the_matrices_are_the_equations_of_motion(p):
    physical = changed(p, kappa=-p.kappa, C_M=-p.C_M)
    equations = printed_3_3_and_3_4(p, p.k_lambda, p.c_lambda, restoring_moment(p))
    assert printed_matrix_3_5(physical, p.k_lambda, p.c_lambda) == jacobian(equations, 5)


# ------------------------------------------------------------------------------------------------- errata 3 and 4


def test_erratum_3_slope_of_2_10_is_seven_times_that_of_2_11():
    """Derivative of (2-10) at alpha = 0 by a complex step, which is exact to rounding."""
    C_F, step = 0.002, 1e-30
    X = np.arctan(7.0 * np.tan(1j * step))
    slope = (C_F * X * np.cos(0.95 * X)).imag / step
    assert slope == pytest.approx(7 * C_F, rel=ROUNDING)
    assert side_force(1j * step, 1.0, parameters(sigma=1.0, C_F=C_F)).imag / step == pytest.approx(slope, rel=ROUNDING)


def printed_4_3(p, k_psi, c_psi, state):
    """I_z psi'' of (4-3), (4-6) with the forces of (2-11), (2-12), (2-13)."""
    M_z, F_y, M_4 = p.C_M * state.alpha * p.F_z, p.C_F * state.alpha * p.F_z, p.kappa * state.psi_t / p.V
    spring = k_psi * state.psi + c_psi * state.psi_t
    return spring + M_z - p.e * F_y + M_4 - p.F_z * p.sin_phi * p.e * state.sin_psi


def printed_4_4(p, state):
    """I_x delta'' of (4-4), (4-7), (4-9)."""
    M_y = p.l_g * p.C_F * state.alpha * p.F_z * state.cos_psi
    return p.k_y * state.delta + p.c_y * state.delta_t + M_y - p.F_z * p.e * state.sin_psi


def printed_3_3(p, k_psi, c_psi, state):
    """I_z psi'' of (3-3) with the same forces."""
    M_z, F_y, M_kappa = p.C_M * state.alpha * p.F_z, p.C_F * state.alpha * p.F_z, p.kappa * state.psi_t / p.V
    left = k_psi * state.psi + c_psi * state.psi_t + F_y * p.e + M_z + M_kappa - p.F_z * p.e * state.sin_psi * p.sin_phi
    return -left


def printed_3_4(p, state):
    """I_x delta'' of (3-4)."""
    F_y = p.C_F * state.alpha * p.F_z
    left = p.k_y * state.delta + p.c_y * state.delta_t + p.l_g * F_y * state.cos_psi - p.F_z * p.e * state.sin_psi
    return -left


@pytest.fixture
def state(p):
    names = ("psi", "psi_t", "delta", "delta_t", "alpha", "sin_psi", "cos_psi")
    return SimpleNamespace(**{name: Fraction(2 * i + 3, 3 * i + 7) for i, name in enumerate(names)})


def test_erratum_4_yaw_equation_of_chapter_4_reverses_every_moment_but_the_side_force(p, state):
    """(4-3) = -(3-3) - 2 e F_y, with e_eff and theta of (4-3) called e and psi as in (3-3)."""
    k_psi, c_psi = p.k_lambda, p.c_lambda
    F_y = p.C_F * state.alpha * p.F_z
    assert printed_4_3(p, k_psi, c_psi, state) == -printed_3_3(p, k_psi, c_psi, state) - 2 * p.e * F_y


def test_erratum_4_lateral_equation_of_chapter_4_reverses_every_moment(p, state):
    assert printed_4_4(p, state) == -printed_3_4(p, state) != 0


def test_erratum_4_chapter_4_as_printed_diverges_at_rest(p):
    """Its springs push away from the middle: a_n of the lateral spring alone is negative."""
    deflected = SimpleNamespace(delta=Fraction(1), delta_t=0, alpha=0, sin_psi=0, cos_psi=1)
    assert printed_4_4(p, deflected) > 0 > printed_3_4(p, deflected)


# ----------------------------------------------------------------- erratum 5: coefficients of the characteristic equation


def test_boeing_coefficients_that_are_right(p):
    """(3-15), (3-16), (3-20)."""
    printed, derived = printed_boeing(p), derived_boeing(p)
    assert [printed[i] for i in (0, 1, 5)] == [derived[i] for i in (0, 1, 5)]


def test_3_17_lacks_the_yaw_stiffness(p):
    assert derived_boeing(p)[2] - printed_boeing(p)[2] == p.k_lambda * (p.L * p.sin_gamma) ** 2 / p.I_z


def test_3_18_lacks_a_factor_speed_on_its_bracket(p):
    bracket = p.I_x * p.k_lambda * p.V + p.c_lambda * (p.k_y * p.sigma + p.C_F * p.F_z * p.l_g**2)
    lost = (p.V - 1) * (p.L * p.sin_gamma) ** 2 * bracket / (p.I_x * p.I_z * p.sigma * p.V)
    assert derived_boeing(p)[3] - printed_boeing(p)[3] == lost != 0


def test_3_19_lacks_the_relaxation_length(p):
    k_psi = p.k_lambda * (p.L * p.sin_gamma) ** 2
    lost = (p.sigma - 1) * p.k_y * k_psi / (p.I_x * p.I_z * p.sigma)
    assert derived_boeing(p)[4] - printed_boeing(p)[4] == lost != 0


def test_utas_coefficients_that_are_right(p):
    """(3-32), (3-33), (3-36)."""
    printed, derived = printed_utas(p), derived_utas(p)
    assert [printed[i] for i in (0, 1, 4)] == [derived[i] for i in (0, 1, 4)]


def test_3_34_lacks_the_lateral_inertia_and_the_side_distance(p):
    ell = p.L * p.sin_gamma
    damper, arm = p.c_lambda * ell * p.V / (10 * p.R), 2 * p.E * p.I_arm * p.sigma * p.sin_alpha / p.R**2
    lost = p.V * ell * ((p.I_x * p.b - 1) * damper + (p.I_x - 1) * arm)
    assert derived_utas(p)[2] - printed_utas(p)[2] == lost != 0


def test_3_35_divides_the_arm_term_by_ten_lengths_for_a_length_squared(p):
    arm = 2 * p.E * p.I_x * p.I_arm * p.L * p.V**2 * p.sin_alpha * p.sin_gamma
    assert derived_utas(p)[3] - printed_utas(p)[3] == arm * (1 / p.R**2 - 1 / (10 * p.R)) != 0


def test_3_37_lacks_the_lateral_stiffness(p):
    arm = 2 * p.E * p.I_arm * p.L * p.V**2 * p.sin_gamma * p.sin_alpha / p.R**2
    assert derived_utas(p)[5] - printed_utas(p)[5] == (p.k_y - 1) * arm != 0


def test_new_design_coefficients_that_are_right_but_for_the_stiffness(p):
    """(3-47), (3-48), (3-52), given the stiffness that they write."""
    printed, derived = printed_new_design(p), derived_new_design(p, stiffness_of_the_coefficients(p))
    assert [printed[i] for i in (0, 1, 5)] == [derived[i] for i in (0, 1, 5)]


def test_3_49_counts_one_term_twice(p):
    derived = derived_new_design(p, stiffness_of_the_coefficients(p))
    assert printed_new_design(p)[2] - derived[2] == p.c_y * p.I_z * p.V**2


def test_3_50_lacks_the_cornering_coefficient(p):
    derived = derived_new_design(p, stiffness_of_the_coefficients(p))
    without = p.l_g**2 * p.F_z * p.c_lambda * (p.L * p.sin_gamma) ** 2 * p.V
    assert derived[3] - printed_new_design(p)[3] == (p.C_F - 1) * without != 0


def test_3_51_lacks_the_coupling_by_the_load(p):
    derived = derived_new_design(p, stiffness_of_the_coefficients(p))
    lost = p.F_z**2 * p.V * p.e * p.l_g * (p.e * p.C_F - p.C_M)
    assert derived[4] - printed_new_design(p)[4] == lost != 0


@pytest.mark.parametrize("printed", [printed_boeing, printed_utas, printed_new_design])
def test_lateral_damping_is_left_out_of_boeing_and_utas_only(p, printed):
    changes = printed(p) != printed(changed(p, c_y=Fraction(0)))
    assert changes == (printed is printed_new_design)


@pytest.mark.parametrize("layout", COEFFICIENTS)
def test_printed_coefficients_with_all_misprints_put_right_are_derived(p, layout):
    derived = {"boeing": derived_boeing, "utas": derived_utas}.get(layout) or (
        lambda p: derived_new_design(p, stiffness_3_42(p))
    )
    lost = [sum(terms.get(i, 0) for terms in MISPRINTS[layout](p).values()) for i in range(6)]
    assert [a + more for a, more in zip(COEFFICIENTS[layout](p), lost, strict=True)] == derived(p)
    assert tuple(MISPRINTS[layout](p)) == MISPRINTS_OF[layout]


def test_hurwitz_determinants_are_printed_right(p):
    """(3-21), (3-22), which (3-38), (3-39), (3-53), (3-54) repeat, against the package's."""
    a = printed_new_design(p)
    rows_3_22 = [[a[1], a[0], 0, 0], [a[3], a[2], a[1], a[0]], [a[5], a[4], a[3], a[2]], [0, 0, a[5], a[4]]]
    H = hurwitz_determinants(a)
    assert H[1] == a[1] * a[2] - a[0] * a[3]
    assert H[3] == coefficients(rows_3_22)[4]  # a_4 of det(l I - M) is det M


# --------------------------------------------------------------------- errata 6, 7 and 8: stiffness and damping of the arm


def test_erratum_6_coefficients_use_another_stiffness_than_3_42(p):
    """Each k_psi of (3-49)..(3-52) is 1/(L sin gamma) times that of (3-42); the other terms stay."""
    ell = p.L * p.sin_gamma
    assert stiffness_of_the_coefficients(p) * ell == stiffness_3_42(p)
    as_written = derived_new_design(p, stiffness_of_the_coefficients(p))
    as_derived = derived_new_design(p, stiffness_3_42(p))
    lost = stiffness_3_42(p) * (1 - 1 / ell)
    of_stiffness = [
        0,
        0,
        p.I_x * p.V * p.sigma,
        p.V * (p.I_x * p.V + p.c_y * p.sigma),
        p.V * (p.c_y * p.V + p.k_y * p.sigma + p.l_g**2 * p.C_F * p.F_z),
        p.V**2 * p.k_y,
    ]
    assert [x - y for x, y in zip(as_derived, as_written, strict=True)] == [factor * lost for factor in of_stiffness]


def test_erratum_7_printed_tip_stiffness_is_a_force(p):
    """In millimetres a stiffness in N/m has a thousandth of its value; (3-24) and (3-41) keep theirs, as a force does."""
    mm = Fraction(1000)
    E, I, R = p.E, p.I_arm, p.R
    E_mm, I_mm, R_mm = E / mm**2, I * mm**4, R * mm
    assert 2 * E_mm * I_mm / R_mm**2 == 2 * E * I / R**2
    assert 3 * E_mm * I_mm / R_mm**3 == 3 * E * I / R**3 / mm


def test_erratum_7_tip_stiffness_of_a_cantilever():
    """Double integral of the curvature M/(E I) under a unit tip force."""
    E, I, R = 2.0e11, 3.4e-6, 0.368
    deflection = quad(lambda x: (R - x) ** 2 / (E * I), 0.0, R)[0]
    assert 1 / deflection == pytest.approx(3 * E * I / R**3, rel=QUADRATURE)
    assert 1 / deflection != pytest.approx(2 * E * I / R**2, rel=0.1)


def test_erratum_7_printed_yaw_stiffness_of_the_new_design_has_the_right_unit_by_two_errors(p):
    """(3-42) takes the lever once: N times m. The consistent 3 E I/ell is 3/2 of it for every arm."""
    ell = p.L * p.sin_gamma
    consistent = 3 * p.E * p.I_arm / ell**3 * ell**2
    assert consistent / stiffness_3_42(p) == Fraction(3, 2)


def test_erratum_7_consistent_yaw_stiffness_of_utas(p):
    """(3 E I/R^3)(ell sin alpha)^2 over (3-26) is 3 ell^2/(2 R^2), since sin alpha = ell/R: a Pythagorean triple serves."""
    ell, b, R = Fraction(4), Fraction(3), Fraction(5)
    sin_alpha = ell / R
    assert ell**2 + b**2 == R**2
    printed = 2 * p.E * p.I_arm * ell * sin_alpha / R**2
    consistent = 3 * p.E * p.I_arm / R**3 * (ell * sin_alpha) ** 2
    assert consistent / printed == Fraction(3, 2) * ell**2 / R**2


def printed_3_29(p, ell, length):
    return p.c_lambda * ell**2 * p.b * p.sin_psi / length


def test_erratum_8_printed_damping_is_the_lever_once_times_the_apex_offset(p):
    """(3-29) = c (ds/dpsi) ell tan(psi); the power of the damper asks for c (ds/dpsi)^2."""
    ell = p.L * p.sin_gamma
    length, cos_psi = p.R, p.sin_alpha  # both stand for irrational functions of psi, free in this identity
    lever = ell * p.b * cos_psi / length  # (3-28)
    assert printed_3_29(p, ell, length) == p.c_lambda * lever * ell * p.sin_psi / cos_psi
    assert printed_3_29(p, ell, length) / (p.c_lambda * lever**2) == length * p.sin_psi / (p.b * cos_psi**2)


def test_erratum_8_printed_damping_vanishes_at_rest_and_is_taken_at_a_tenth(p):
    ell = p.L * p.sin_gamma
    assert printed_3_29(changed(p, sin_psi=Fraction(0)), ell, p.R) == 0
    constant_3_30 = p.c_lambda * p.L**2 * p.sin_gamma**2 * p.b / (10 * p.R)
    assert printed_3_29(changed(p, sin_psi=Fraction(1, 10)), ell, p.R) == constant_3_30


# ------------------------------------------------------------------------------------- the package against the derivation


def rational_parameters(V, top):
    """Table 0.1 for the derivation: slope 7 C_F, and both signs put right."""
    q = parameters()
    ell, b = LAYOUT["L"] * np.sin(LAYOUT["gamma"]), LAYOUT["b"]
    values = {
        "I_x": q.I_x,
        "I_z": q.I_z,
        "V": V,
        "sigma": q.sigma,
        "kappa": -q.kappa,
        "C_F": 7 * q.C_F,
        "C_M": -q.C_M,
        "F_z": 150e3,
        "l_g": q.l_g,
        "e": q.e,
        "a": q.a,
        "k_y": q.k_delta,
        "c_y": q.c_delta if top == "arreaza" else 0.0,
        "E": 207e9,
        "I_arm": 3.4e-6,
        "c_lambda": 2.0e4,
        "k_lambda": 3.8e6,
        "L": LAYOUT["L"],
        "sin_gamma": np.sin(LAYOUT["gamma"]),
        "b": b,
        "R": np.hypot(ell, b),
        "sin_alpha": ell / np.hypot(ell, b),
    }
    return SimpleNamespace(**{name: Fraction(value) for name, value in values.items()})


def derived(top, p):
    if top == "boeing":
        return derived_boeing(p)
    scale = p.I_x * p.I_z * p.V * p.sigma
    scaled = derived_utas(p) if top == "utas" else derived_new_design(p, stiffness_3_42(p))
    return [a / scale for a in scaled]


@pytest.fixture(params=["boeing", "utas", "arreaza"])
def topology(request):
    return request.param


@pytest.fixture
def published(main_gear, topology):
    """The package's gear with the thesis' geometry; c_delta = 0 where the thesis leaves it out."""
    study = main_gear.replace(
        damper=damper_block(topology, geometry="published"),
        material={"youngs_modulus": 207e9, "density": 7850.0, "yield_strength": 1e9},
        gear__lateral__damping=300.0 if topology == "arreaza" else 0.0,
    )
    model = LinearModel(study)
    values = LAYOUT | {"c_lambda": 2.0e4, "k_lambda": 3.8e6, "I_arm": 3.4e-6}
    return model.at({name: values[name] for name in model.design_names})


@pytest.mark.parametrize("V", [5.0, 40.0, 160.0])
def test_characteristic_polynomial_of_the_package_is_the_derived_one(published, topology, V):
    expected = [float(a) for a in derived(topology, rational_parameters(V, topology))]
    A = published.matrices(V, 150e3)[0]
    found = characteristic_polynomial(A)
    np.testing.assert_allclose(found, expected, rtol=CHARACTERISTIC_POLYNOMIAL)


def test_coefficients_times_speed_are_of_second_degree_in_speed(published, topology):
    """As those of the thesis are: V a_i of the package through three speeds, at others, is what was derived."""
    at, others = np.array([20.0, 60.0, 180.0]), [5.0, 40.0, 160.0]
    samples = [at * a for a in characteristic_polynomial(published.matrices(at, 150e3))]
    quadratics = [Polynomial.fit(at, values, 2) for values in samples]
    for V in others:
        expected = [V * float(a) for a in derived(topology, rational_parameters(V, topology))]
        np.testing.assert_allclose([a(V) for a in quadratics], expected, rtol=CHARACTERISTIC_POLYNOMIAL)


def test_matrix_3_5_with_both_signs_and_the_slope_put_right_is_that_of_package_and_twin(published, topology):
    p = rational_parameters(40.0, topology)
    values = LAYOUT | {"c_lambda": 2.0e4, "k_lambda": 3.8e6, "I_arm": 3.4e-6}
    k_psi, c_psi = published_coefficients(topology, 207e9, **values)
    expected = np.array(printed_matrix_3_5(p, Fraction(k_psi), Fraction(c_psi)), float)
    np.testing.assert_allclose(published.matrices(40.0, 150e3)[0], expected, rtol=ROUNDING)
    twin = parameters(k_psi=k_psi, c_psi=c_psi, c_delta=float(p.c_y))
    np.testing.assert_allclose(state_matrix(40.0, 150e3, twin), expected, rtol=ROUNDING)

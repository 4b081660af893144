"""Exact evaluation of CasADi graphs: every operation against Python's fractions or high-precision decimals."""

import math
from fractions import Fraction

import casadi as ca
import flint
import numpy as np
import pytest
from basic_twin import effective_caster, parameters, state_matrix
from components_of import TWIN_LAWS

from damperopt import CertificateError
from damperopt.proof import rationals as exact
from damperopt.proof.rationals import evaluate, rational
from damperopt.stability.linear import LinearModel
from damperopt.symbols import data_values

IRRATIONAL = Fraction(1, 2**80)
"""Relative: the precision that `exact` promises for sines, square roots and the like."""

FLOAT_MATRIX = 1e-12
"""Relative to the sum of the moduli of its terms: an entry of the state matrix in double precision, some ten operations."""


def fraction(value):
    return Fraction(int(value.p), int(value.q))


def evaluated(expression, symbols, values):
    """Rows of fractions."""
    function = ca.Function("f", [ca.vertcat(*symbols)], [ca.densify(expression)])
    return [[fraction(entry) for entry in row] for row in evaluate(function, [[rational(float(v)) for v in values]])]


def scalar(expression, symbols, values):
    return evaluated(expression, symbols, values)[0][0]


x, y = ca.SX.sym("x"), ca.SX.sym("y")

RATIONAL_OPERATIONS = {
    "add": (x + y, lambda a, b: a + b),
    "subtract": (x - y, lambda a, b: a - b),
    "multiply": (x * y, lambda a, b: a * b),
    "divide": (x / y, lambda a, b: a / b),
    "negate": (-x, lambda a, b: -a),
    "invert": (1 / y, lambda a, b: 1 / b),
    "square": (x**2, lambda a, b: a * a),
    "cube": (x**3, lambda a, b: a**3),
    "negative power": (y**-2, lambda a, b: 1 / b**2),
    "twice": (x + x, lambda a, b: 2 * a),
    "absolute": (ca.fabs(x), lambda a, b: abs(a)),
    "sign": (ca.sign(x), lambda a, b: (a > 0) - (a < 0)),
    "less": (x < y, lambda a, b: int(a < b)),
    "less or equal": (x <= y, lambda a, b: int(a <= b)),
    "equal": (x == y, lambda a, b: int(a == b)),
    "unequal": (x != y, lambda a, b: int(a != b)),
    "not": (ca.logic_not(x), lambda a, b: int(a == 0)),
    "and": (ca.logic_and(x, y), lambda a, b: int(a != 0 and b != 0)),
    "or": (ca.logic_or(x, y), lambda a, b: int(a != 0 or b != 0)),
    "if else": (ca.if_else(x < y, 3 * x, y - 1), lambda a, b: 3 * a if a < b else b - 1),
    "if else zero": (ca.if_else(x, y, 0), lambda a, b: b if a != 0 else 0),
    "constants": (0.1 * x + 7, lambda a, b: Fraction(0.1) * a + 7),
}
POINTS = [(0.3, -1.7), (-0.1, 0.1), (1e-30, 1e30), (2.5, 2.5), (0.0, 1.0), (-3.0, -0.25), (5e-324, 1e308)]


@pytest.mark.parametrize("name", RATIONAL_OPERATIONS)
def test_rational_operations_are_exact(name):
    """At points whose exact results no float can hold."""
    expression, expected = RATIONAL_OPERATIONS[name]
    for a, b in POINTS:
        assert scalar(expression, (x, y), (a, b)) == expected(Fraction(a), Fraction(b))


IRRATIONAL_OPERATIONS = {
    "sin": (ca.sin(x), "sin", (0.3, -2.0, 1e-9, 22.0)),
    "cos": (ca.cos(x), "cos", (0.3, -2.0, 1e-9, 1.5707963)),
    "tan": (ca.tan(x), "tan", (0.3, -2.0, 1e-9, 1.57)),
    "atan": (ca.atan(x), "atan", (0.3, -2.0, 1e-9, 1e12)),
    "sqrt": (ca.sqrt(x), "sqrt", (0.3, 2.0, 1e-9, 1e300)),
    "exp": (ca.exp(x), "exp", (0.3, -2.0, 1e-9, 22.0)),
    "log": (ca.log(x), "log", (0.3, 2.0, 1e-9, 1e300)),
    "asinh": (ca.asinh(x), "asinh", (0.3, -2.0, 1e-9, 1e12)),
}


@pytest.mark.parametrize("name", IRRATIONAL_OPERATIONS)
def test_irrational_operations_are_within_the_promised_precision(name):
    """Against 300 bits of Arb, the cosine of the largest angle that a study may have included."""
    expression, function, points = IRRATIONAL_OPERATIONS[name]
    for a in points:
        found = scalar(expression, (x,), (a,))
        with flint.ctx.workprec(300):
            mantissa, exponent = getattr(flint.arb(a), function)().mid().man_exp()
        true = Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
        assert abs(found - true) <= IRRATIONAL * abs(true)
        assert float(found) == pytest.approx(getattr(math, function)(a), rel=1e-15)


def test_irrational_operations_are_exact_at_zero():
    for expression, expected in (
        (ca.sin(x), 0),
        (ca.cos(x), 1),
        (ca.tan(x), 0),
        (ca.atan(x), 0),
        (ca.sqrt(x), 0),
        (ca.exp(x), 1),
    ):
        assert scalar(expression, (x,), (0.0,)) == expected


def test_square_roots_of_squares_are_exact():
    for value in (4.0, 2.25, 2.0**100, 2.0**-60):
        assert scalar(ca.sqrt(x), (x,), (value,)) ** 2 == Fraction(value)


def test_every_operation_in_the_table_is_tested_here():
    """A new operation needs a test: the codes that the expressions above produce are those of the table."""
    produced = set()
    for expression, *_ in (*RATIONAL_OPERATIONS.values(), *IRRATIONAL_OPERATIONS.values()):
        function = ca.Function("f", [ca.vertcat(x, y)], [expression])
        produced |= {function.instruction_id(k) for k in range(function.n_instructions())}
    assert set(exact._OPERATIONS) - {ca.OP_ASSIGN} <= produced


def test_random_graphs_agree_with_fractions():
    """Sums, products and quotients nested at random, evaluated again by Python on fractions."""
    rng = np.random.default_rng(1)
    for _ in range(20):
        symbols = [ca.SX.sym(f"s{i}") for i in range(4)]
        values = [float(v) for v in rng.uniform(0.5, 2.0, size=4)]
        pool = list(zip(symbols, map(Fraction, values), strict=True))
        for _ in range(25):
            (a, u), (b, v) = (pool[int(i)] for i in rng.integers(len(pool), size=2))
            pool.append(
                [(a + b, u + v), (a - b, u - v), (a * b, u * v), (a / (b**2 + 1), u / (v**2 + 1))][int(rng.integers(4))]
            )
        expression, expected = pool[-1]
        assert scalar(expression, symbols, values) == expected


def test_rational_is_the_exact_value_of_a_float():
    rng = np.random.default_rng(2)
    for value in (0.1, -1e-300, 5e-324, 1.7976931348623157e308, 0.0, *rng.normal(size=20)):
        assert fraction(rational(float(value))) == Fraction(float(value))


def test_matrices_come_row_by_row_with_constant_and_zero_entries():
    expression = ca.vertcat(ca.horzcat(x, y, 0), ca.horzcat(2, x * y, -y))
    assert evaluated(expression, (x, y), (0.5, 3.0)) == [
        [Fraction(1, 2), 3, 0],
        [2, Fraction(3, 2), -3],
    ]


def test_several_inputs_and_vectors_are_read_in_order():
    a, b = ca.SX.sym("a", 3), ca.SX.sym("b", 2)
    function = ca.Function("f", [a, b], [ca.vertcat(a[2] - b[1], a[0] * b[0])])
    found = evaluate(function, [[rational(v) for v in (1.0, 2.0, 4.0)], [rational(v) for v in (0.25, 0.5)]])
    assert [fraction(row[0]) for row in found] == [Fraction(7, 2), Fraction(1, 4)]


UNSUPPORTED = {
    "power": x**y,
    "fractional power": x**1.5,
    "smaller": ca.fmin(x, y),
    "larger": ca.fmax(x, y),
    "atan2": ca.atan2(x, y),
    "asin": ca.asin(x),
    "acos": ca.acos(x),
    "tanh": ca.tanh(x),
    "floor": ca.floor(x),
    "modulo": ca.fmod(x, y),
    "hypot": ca.hypot(x, y),
    "erf": ca.erf(x),
}


@pytest.mark.parametrize("name", UNSUPPORTED)
def test_unsupported_operations_are_refused(name):
    with pytest.raises(CertificateError, match="no exact form"):
        scalar(UNSUPPORTED[name], (x, y), (0.5, 0.75))


@pytest.mark.parametrize("expression", [1 / x, y / x, x**-2, ca.tan(y) / x])
def test_division_by_zero_is_refused(expression):
    with pytest.raises(CertificateError, match="divides by zero"):
        scalar(expression, (x, y), (0.0, 1.0))


@pytest.mark.parametrize(
    ("expression", "value"),
    [(ca.sqrt(x), -1.0), (x * math.inf, 2.0), (x + math.nan, 1.0)],
    ids=["square root of a negative number", "infinite constant", "constant that is no number"],
)
def test_what_has_no_real_value_is_refused_as_a_certificate_error(expression, value):
    """No other exception may reach the user, who catches `DamperoptError`."""
    with pytest.raises(CertificateError):
        scalar(expression, (x,), (value,))


# the state matrix


TYRES = {
    "nonlinear": {"cornering_coefficient": 0.002, "aligning_coefficient": 1.0, "aligning_slip_limit": 0.17},
    "linear": {"cornering_slope": 0.014, "aligning_coefficient": -0.7},
    "stiffness": {"cornering_stiffness": 2100.0, "aligning_stiffness": 1.5e5},
}


def study_at_random(base, rng, law, order, rake):
    common = {"half_contact_length": float(rng.uniform(0.05, 0.3)), "relaxation_length": float(rng.uniform(0.1, 0.9))}
    common |= {"contact": "leading_point"}
    return base.replace(
        gear__order=order,
        gear__rake_angle=float(rng.uniform(-1, 1)) if rake else 0.0,
        gear__caster_length=float(rng.uniform(-0.3, 0.3)),
        tyre={"law": law, "tread_width_moment": float(rng.uniform(0, 900)), **common, **TYRES[law]},
        damper={
            "topology": "rotational",
            "torsional_stiffness": float(rng.uniform(0, 5e5)),
            "torsional_damping": float(rng.uniform(0, 5e3)),
        },
    )


def twin_of(study):
    gear, tyre, damper = study.gear, study.tyre, study.damper
    slopes = {
        "arctangent": lambda: {"C_F": tyre.cornering_coefficient, "C_M": tyre.aligning_coefficient},
        "linear": lambda: {"C_F": tyre.cornering_slope, "C_M": tyre.aligning_coefficient},
        "stiffness": lambda: {"C_F": tyre.cornering_stiffness, "C_M": tyre.aligning_stiffness},
    }[tyre.law]()
    return parameters(
        I_z=gear.yaw_inertia,
        I_x=gear.lateral.inertia,
        k_psi=damper.torsional_stiffness,
        c_psi=damper.torsional_damping,
        k_delta=gear.lateral.stiffness,
        c_delta=gear.lateral.damping,
        l_g=gear.lateral.height,
        e=gear.caster_length,
        R_w=gear.wheel_radius,
        phi=gear.rake_angle,
        a=tyre.half_contact_length,
        sigma=tyre.relaxation_length,
        kappa=tyre.tread_width_moment,
        law=TWIN_LAWS[tyre.law],
        **slopes,
    )


def size_of_terms(p, V, F_z, order):
    """Matrix of the sums of the moduli of the terms of each entry: what rounding is relative to, where terms cancel."""
    p.phi = abs(p.phi)
    p.C_M, p.a, p.sigma = abs(p.C_M), -p.a, p.sigma
    p.e = abs(p.e)
    p.k_psi = -p.k_psi
    return np.abs(state_matrix(V, F_z, p, order))


@pytest.mark.parametrize("rake", [False, True])
@pytest.mark.parametrize("law", TYRES)
@pytest.mark.parametrize("order", [3, 5])
def test_exact_state_matrix_agrees_with_the_float_one_and_with_the_basic_twin(main_gear, order, law, rake):
    rng = np.random.default_rng(3)
    for _ in range(4):
        study = study_at_random(main_gear, rng, law, order, rake)
        model, data = LinearModel(study), [rational(v) for v in data_values(study)]
        V, F_z = float(10 ** rng.uniform(-1, 2.5)), float(10 ** rng.uniform(2, 6))
        found = evaluate(model.state_matrix, [[], [rational(V)], [rational(F_z)], data])
        exact_matrix = np.array([[float(fraction(entry)) for entry in row] for row in found])
        twin = twin_of(study)
        by_twin, by_package = state_matrix(V, F_z, twin, order), model.at({}).matrices(V, F_z)[0]
        allowed = FLOAT_MATRIX * size_of_terms(twin, V, F_z, order)
        assert (np.abs(by_package - exact_matrix) <= allowed).all()
        assert (np.abs(by_twin - exact_matrix) <= allowed).all()
        assert ((exact_matrix == 0) == (by_twin == 0)).all()


@pytest.mark.parametrize("geometry", ["published", "planar"])
@pytest.mark.parametrize("topology", ["boeing", "utas", "arreaza"])
def test_exact_state_matrix_of_every_layout_agrees_with_the_float_one(main_gear, topology, geometry):
    study = main_gear.replace(damper__topology=topology, damper__geometry=geometry, gear__rake_angle=0.157)
    model = LinearModel(study)
    rng = np.random.default_rng(4)
    for _ in range(3):
        design = {name: variable.start * float(rng.uniform(0.8, 1.2)) for name, variable in study.design if variable}
        V, F_z = float(rng.uniform(5, 100)), float(rng.uniform(5e4, 2e5))
        values = [rational(design[name]) for name in model.design_names]
        found = evaluate(
            model.state_matrix, [values, [rational(V)], [rational(F_z)], [rational(v) for v in data_values(study)]]
        )
        exact_matrix = np.array([[float(fraction(entry)) for entry in row] for row in found])
        by_package = model.at(design).matrices(V, F_z)[0]
        # e_eff - a and the load's share in the yaw stiffness cancel little here
        assert by_package == pytest.approx(exact_matrix, rel=1e-11, abs=0)
        assert np.abs(exact_matrix).max() > 1e3


def test_third_order_matrix_without_rake_is_the_rational_number_of_the_theory_page(main_gear):
    """Section 2: entries as fractions of the very floats of the study, equal to the last digit of infinitely many."""
    study = study_at_random(main_gear, np.random.default_rng(5), "linear", 3, rake=False)
    V, F_z = 12.3, 98765.4
    found = evaluate(
        LinearModel(study).state_matrix, [[], [rational(V)], [rational(F_z)], [rational(v) for v in data_values(study)]]
    )
    gear, tyre, damper = study.gear, study.tyre, study.damper
    I_z, e, a, sigma = map(Fraction, (gear.yaw_inertia, gear.caster_length, tyre.half_contact_length, tyre.relaxation_length))
    kappa, slope, C_M = map(Fraction, (tyre.tread_width_moment, tyre.cornering_slope, tyre.aligning_coefficient))
    k_psi, c_psi = Fraction(damper.torsional_stiffness), Fraction(damper.torsional_damping)
    V, F_z = Fraction(V), Fraction(F_z)
    assert [[fraction(entry) for entry in row] for row in found] == [
        [0, 1, 0],
        [-k_psi / I_z, -(c_psi + kappa / V) / I_z, -(e * slope + C_M) * F_z / (I_z * sigma)],
        [V, e - a, -V / sigma],
    ]


def test_effective_caster_of_the_twin_is_what_the_rake_test_compares_with():
    """Guards the guard: with rake the twin's caster differs from the plain one, so the rake enters the comparison."""
    p = parameters(phi=0.5)
    assert abs(effective_caster(p) - p.e) > 0.1

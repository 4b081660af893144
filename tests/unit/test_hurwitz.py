"""Characteristic polynomial and the criteria of Hurwitz and of Lienard and Chipart, against the roots themselves."""

from fractions import Fraction
from itertools import permutations
from math import prod

import casadi as ca
import numpy as np
import pytest

from damperopt.stability.hurwitz import characteristic_polynomial, determinant, hurwitz_determinants, lienard_chipart, shifted

ROOTS = 1e-8
"""Absolute, for roots of order one: `numpy.roots` of degree 7 loses up to half its digits where roots lie close."""

COEFFICIENTS = 1e-12
"""Relative to the product of the moduli that each coefficient sums: two ways to it, both to rounding."""

SYMBOLIC = 1e-13
"""Relative; the same operations, once by CasADi and once by Python."""


def expanded(factors):
    """Coefficients of a product of polynomials, exactly."""
    product = [Fraction(1)]
    for factor in factors:
        longer = [Fraction(0)] * (len(product) + len(factor) - 1)
        for i, a in enumerate(product):
            for j, b in enumerate(factor):
                longer[i + j] += a * b
        product = longer
    return product


def random_roots(rng, degree, stable):
    """(factors, real parts): quadratic and linear factors with rational coefficients, on the side that is asked for.

    If not stable, at least one root lies on the right or on the axis.
    """
    factors, real_parts = [], []
    while sum(len(f) - 1 for f in factors) < degree:
        left = degree - sum(len(f) - 1 for f in factors)
        re = -Fraction(int(rng.integers(1, 60)), 20)
        if left > 1 and rng.random() < 0.6:
            im = Fraction(int(rng.integers(1, 60)), 20)
            factors.append((re, im))
        else:
            factors.append((re,))
        factors[-1] = [Fraction(1), -2 * re, re**2 + im**2] if len(factors[-1]) == 2 else [Fraction(1), -re]
        real_parts.append(re)
    if not stable:
        chosen = int(rng.integers(len(factors)))
        re = rng.choice([Fraction(0), Fraction(1, 20), Fraction(3, 2)])
        old = factors[chosen]
        if len(old) == 3:
            im_squared = old[2] - (old[1] / 2) ** 2
            factors[chosen] = [Fraction(1), -2 * re, re**2 + im_squared]
        else:
            factors[chosen] = [Fraction(1), -re]
        real_parts[chosen] = re
    return factors, real_parts


@pytest.mark.parametrize("degree", range(2, 8))
@pytest.mark.parametrize("stable", [True, False])
def test_lienard_chipart_and_hurwitz_decide_random_polynomials_exactly(degree, stable):
    """Integers and fractions all through, so roots on the axis count as not stable."""
    rng = np.random.default_rng(degree)
    for _ in range(25):
        factors, real_parts = random_roots(rng, degree, stable)
        a = [c * 3 for c in expanded(factors)]
        assert all(value > 0 for value in lienard_chipart(a).values()) == stable
        assert all(value > 0 for value in hurwitz_determinants(a)) == stable
        # numpy agrees on the roots; the real parts were chosen at least 1/20 from each other's side
        found = np.roots([float(c) for c in a]).real.max()
        assert found == pytest.approx(float(max(real_parts)), abs=1e-3)


@pytest.mark.parametrize("degree", range(2, 8))
def test_lienard_chipart_agrees_with_numpy_on_random_coefficients(degree):
    """Coefficients at random, all of one sign or not; polynomials with a root near the axis are told by their real part."""
    rng = np.random.default_rng(100 + degree)
    seen = []
    for _ in range(200):
        # (s + r)^n plus noise: stable about as often as not
        a = np.poly(-rng.uniform(0.2, 2, size=degree)) * rng.uniform(0.3, 1.9, size=degree + 1)
        a[0] = abs(a[0])
        top = np.roots(a).real.max()
        assert abs(top) > 1e-6, "a seed that leaves the verdict to rounding"
        stable = all(value > 0 for value in lienard_chipart(list(a)).values())
        assert stable == (top < 0)
        seen.append(stable)
    assert 10 < sum(seen) <= 200
    # with positive coefficients a quadratic is always stable; above that degree both verdicts must occur
    assert degree == 2 or sum(seen) < 200


def test_each_condition_of_lienard_and_chipart_is_needed():
    """For every condition of degree 2, 3 and 4 there is an unstable polynomial that only this one rejects."""
    rng = np.random.default_rng(2)
    for degree, needed in ((2, {"a2", "H1"}), (3, {"a3", "a1", "H2"}), (4, {"a4", "a2", "H3", "H1"})):
        lonely = set()
        for _ in range(2000):
            a = [1, *(int(c) for c in rng.integers(-6, 12, size=degree))]
            failed = [name for name, value in lienard_chipart(a).items() if value <= 0]
            if len(failed) == 1:
                assert np.roots(a).real.max() > -1e-6
                lonely |= set(failed)
        assert lonely == needed


@pytest.mark.parametrize("degree", range(1, 8))
def test_a_stable_polynomial_turned_round_is_rejected(degree):
    """p(-s) has every root on the right, but the same even Hurwitz determinants up to sign."""
    rng = np.random.default_rng(50 + degree)
    for _ in range(10):
        a = expanded(random_roots(rng, degree, stable=True)[0])
        mirrored = [(-1) ** i * c for i, c in enumerate(a)]
        assert all(value > 0 for value in lienard_chipart(a).values())
        assert not all(value > 0 for value in lienard_chipart(mirrored).values())
        assert not all(value > 0 for value in hurwitz_determinants(mirrored))


def test_names_and_number_of_the_conditions():
    assert list(lienard_chipart([1, 2, 3, 4, 5, 6])) == ["a5", "a3", "a1", "H4", "H2"]
    assert list(lienard_chipart([1, 2, 3, 4])) == ["a3", "a1", "H2"]
    assert list(lienard_chipart([1, 2, 3, 4, 5])) == ["a4", "a2", "H3", "H1"]
    assert list(lienard_chipart([1, 2, 3])) == ["a2", "H1"]
    assert lienard_chipart([2, 3]) == {"a1": 3}


def test_hurwitz_determinants_of_low_degree_in_closed_form():
    a0, a1, a2, a3, a4 = 2, 3, 5, 7, 11
    H2 = a1 * a2 - a0 * a3
    assert hurwitz_determinants([a0, a1, a2, a3]) == [a1, H2, a3 * H2]
    H3 = a3 * H2 - a1**2 * a4
    assert hurwitz_determinants([a0, a1, a2, a3, a4]) == [a1, H2, H3, a4 * H3]


@pytest.mark.parametrize("degree", range(2, 7))
def test_last_but_one_hurwitz_determinant_is_orlandos_product(degree):
    """H_(n-1) = (-1)^(n (n-1)/2) a_0^(n-1) prod of s_i + s_j over pairs: zero exactly where two roots are opposite."""
    rng = np.random.default_rng(200 + degree)
    for _ in range(10):
        roots = [Fraction(int(r), 4) for r in rng.integers(-9, 10, size=degree)]
        a = [3 * c for c in expanded([[Fraction(1), -r] for r in roots])]
        product = prod(roots[i] + roots[j] for i in range(degree) for j in range(i))
        assert hurwitz_determinants(a)[-2] == (-1) ** (degree * (degree - 1) // 2) * Fraction(3) ** (degree - 1) * product


@pytest.mark.parametrize("degree", range(1, 8))
def test_shifted_moves_every_root_to_the_right(degree):
    rng = np.random.default_rng(300 + degree)
    for _ in range(10):
        roots = [Fraction(int(r), 8) for r in rng.integers(-20, 20, size=degree)]
        sigma = Fraction(int(rng.integers(-9, 10)), 4)
        a = expanded([[Fraction(1), -r] for r in roots])
        assert shifted(a, sigma) == expanded([[Fraction(1), -(r + sigma)] for r in roots])
        assert shifted(shifted(a, sigma), -sigma) == a
    assert shifted([2.0, 3.0], 0) == [2.0, 3.0]


def test_shifted_works_on_stacks():
    rng = np.random.default_rng(4)
    a = [rng.normal(size=6) for _ in range(5)]
    sigma = rng.normal(size=6)
    together = shifted(a, sigma)
    for k in range(6):
        alone = shifted([c[k] for c in a], sigma[k])
        assert [c[k] for c in together] == pytest.approx(alone, rel=COEFFICIENTS, abs=COEFFICIENTS)


@pytest.mark.parametrize("n", range(1, 7))
def test_determinant_is_the_sum_over_permutations(n):
    rng = np.random.default_rng(400 + n)

    def sign(p):
        return (-1) ** sum(p[i] > p[j] for j in range(n) for i in range(j))

    for _ in range(5):
        rows = [[int(x) for x in row] for row in rng.integers(-5, 6, size=(n, n))]
        for i in range(n):
            rows[i][int(rng.integers(n))] = 0
        expected = sum(sign(p) * prod(rows[i][p[i]] for i in range(n)) for p in permutations(range(n)))
        assert determinant(rows) == expected


def test_determinant_of_rows_of_zeros_and_of_equal_rows_is_zero():
    assert determinant([[0, 0], [1, 2]]) == 0
    assert determinant([[1, 2], [0, 0]]) == 0
    assert determinant([[1, 2, 3], [4, 5, 6], [1, 2, 3]]) == 0
    assert determinant([[7]]) == 7


@pytest.mark.parametrize("n", range(1, 8))
def test_characteristic_polynomial_is_that_of_numpy(n):
    rng = np.random.default_rng(500 + n)
    for _ in range(10):
        A = rng.normal(size=(n, n)) * (rng.random(size=(n, n)) < 0.7)
        a, expected = characteristic_polynomial(A), np.poly(A)
        # coefficient k sums products of k entries: what rounding can do grows with the norm to that power
        size = max(1.0, np.linalg.norm(A, 2)) ** np.arange(n + 1)
        assert np.abs(np.array([float(c) for c in a]) - expected).max() <= (COEFFICIENTS * size * 2**n).max()
        assert float(a[-1]) == pytest.approx((-1) ** n * np.linalg.det(A), rel=1e-9, abs=1e-12)
        if n > 1:
            assert float(a[1]) == pytest.approx(-np.trace(A), rel=1e-12, abs=1e-14)


def test_characteristic_polynomial_of_a_companion_matrix_returns_its_coefficients():
    rng = np.random.default_rng(6)
    for n in range(2, 8):
        a = rng.normal(size=n)
        companion = np.diag(np.ones(n - 1), -1)
        companion[0] = -a
        assert [float(c) for c in characteristic_polynomial(companion)] == pytest.approx([1, *a], rel=1e-12, abs=1e-14)


def test_characteristic_polynomial_of_a_stack_is_that_of_each_matrix():
    rng = np.random.default_rng(7)
    stack = rng.normal(size=(4, 5, 5))
    stack[:, 2, 3] = 0.0
    stack[1, 0, 0] = 0.0  # zero in one matrix only: no zero of the structure
    together = characteristic_polynomial(stack)
    for k, A in enumerate(stack):
        alone = [float(np.broadcast_to(c, 4)[k]) for c in together]
        assert alone == pytest.approx(np.poly(A), rel=1e-10, abs=1e-12)


def test_last_coefficient_keeps_its_digits_where_roots_lie_decades_apart():
    """An overdamped gear: roots from -1e-3 to -1e6 1/s; det A = -1e9 must not drown in powers of 1e6."""
    roots = -np.array([1e-3, 1.0, 1e3, 1e6, 1e3])
    A = np.diag(roots) + np.diag(np.full(4, 3.0), 1)
    assert float(characteristic_polynomial(A)[-1]) == pytest.approx(1e9, rel=1e-12)


def test_all_of_it_works_on_casadi_symbols():
    """a gear-like matrix: shifted polynomial and conditions as one SX function against numbers, and its derivative."""
    rng = np.random.default_rng(8)
    n = 5
    A, sigma = ca.SX.sym("A", n, n), ca.SX.sym("sigma")
    conditions = lienard_chipart(shifted(characteristic_polynomial(A), sigma))
    evaluate = ca.Function("conditions", [A, sigma], [ca.vertcat(*conditions.values())])
    slope = ca.Function("slope", [A, sigma], [ca.jacobian(ca.vertcat(*conditions.values()), sigma)])
    for _ in range(10):
        numbers, margin = rng.normal(size=(n, n)) - 2 * np.eye(n), float(rng.uniform(0, 1))
        by_numbers = lienard_chipart(shifted([float(c) for c in np.poly(numbers)], margin))
        found = evaluate(numbers, margin).full().ravel()
        assert found == pytest.approx(list(by_numbers.values()), rel=1e-9)
        step = 1e-6
        difference = (evaluate(numbers, margin + step) - evaluate(numbers, margin - step)).full().ravel() / (2 * step)
        assert slope(numbers, margin).full().ravel() == pytest.approx(difference, rel=1e-5, abs=1e-5 * np.abs(found).max())


def test_structural_zeros_of_a_symbolic_matrix_give_no_terms():
    """The graph of a sparse matrix is short: products with a zero are never written down."""
    x = ca.SX.sym("x")
    dense, sparse = ca.SX.sym("A", 4, 4), ca.SX.zeros(4, 4)
    for i in range(4):
        sparse[i, i] = x
    count = [
        ca.Function("a", [symbols], [ca.vertcat(*characteristic_polynomial(matrix)[1:])]).n_instructions()
        for symbols, matrix in ((x, sparse), (dense, dense))
    ]
    assert count[0] < count[1] / 3
    values = ca.Function("a", [x], [ca.vertcat(*characteristic_polynomial(sparse)[1:])])(2.0).full().ravel()
    assert values == pytest.approx([-8.0, 24.0, -32.0, 16.0], rel=SYMBOLIC)

"""Zeros of polynomials: Sturm's counting against Arb, Bernstein's subdivision against values and constructions."""

import math
from fractions import Fraction

import flint
import numpy as np
import pytest

from damperopt.proof.zeros import _bernstein, _bernstein_1d, _halves, zero_in_rectangle, zeros_in_range

ENCLOSURE = 2e-9
"""Relative; zeros are bisected until the interval is below 1e-9 of its upper end."""

Q = flint.fmpq
RING = flint.fmpq_mpoly_ctx.get(("u", "V", "F"), "lex")
_, SPEED, LOAD = RING.gens()


def rational(value):
    return Q(*float(value).as_integer_ratio())


# Sturm's counting


def polynomial_with(zeros, factor=1):
    product = RING.constant(factor)
    for zero in zeros:
        product *= SPEED - Q(zero.numerator, zero.denominator)
    return product


def assert_same_zeros(found, expected):
    assert len(found) == len(expected), (found, [float(zero) for zero in expected])
    for zero, exact in zip(found, sorted(expected), strict=True):
        assert zero == pytest.approx(float(exact), rel=ENCLOSURE)


@pytest.mark.parametrize("seed", range(3))
def test_zeros_of_random_polynomials_are_those_that_arb_isolates(seed):
    """Degrees to 20, integer coefficients, no zero on an end."""
    rng = np.random.default_rng(seed)
    counted = 0
    for _ in range(40):
        coefficients = [int(c) for c in rng.integers(-50, 50, size=rng.integers(2, 21))]
        condition = sum((c * SPEED**k for k, c in enumerate(coefficients)), RING.constant(0))
        low, high = sorted(float(x) for x in rng.uniform(0.01, 3.0, size=2))
        inside = [
            root.real
            for root, _ in flint.fmpz_poly(coefficients).complex_roots()
            if root.imag == 0 and flint.arb(low) < root.real < flint.arb(high)
        ]
        found = zeros_in_range(condition, (low, high))
        assert len(found) == len(inside)
        for zero, ball in zip(found, sorted(float(x.mid()) for x in inside), strict=True):
            assert zero == pytest.approx(ball, rel=ENCLOSURE)
        counted += len(found)
    assert counted > 10


def test_zeros_close_together_are_told_apart_and_complex_pairs_ignored():
    near = Fraction(3, 2), Fraction(3, 2) + Fraction(1, 10**7)
    quadratic = (SPEED - Q(3, 2)) ** 2 + Q(1, 10**30)
    assert_same_zeros(zeros_in_range(polynomial_with(near), (1.0, 2.0)), near)
    assert zeros_in_range(quadratic, (1.0, 2.0)) == []
    assert_same_zeros(zeros_in_range(quadratic * polynomial_with(near), (1.0, 2.0)), near)


def test_no_zero_between_two_that_lie_one_rounding_unit_outside():
    low, high = 1.3, 2.7
    outside = Fraction(math.nextafter(low, 0)), Fraction(math.nextafter(high, 3))
    assert zeros_in_range(polynomial_with(outside), (low, high)) == []
    assert zeros_in_range(polynomial_with((Fraction(str(low)), Fraction(str(high)))), (low, high)) == [low, high]


@pytest.mark.parametrize("speeds", [(0.0, 10.0), (1.0, 10.0), (0.5, 9.0)])
def test_zeros_of_any_multiplicity_are_all_found_once(speeds):
    """5 is the first point of bisection of 0..10: all members of Sturm's chain vanish at a multiple zero there."""
    rng = np.random.default_rng(3)
    for _ in range(30):
        zeros = [Fraction(int(z)) for z in rng.choice([2, 3, 5, 6, 7, 8], size=3, replace=False)]
        multiplicity = [int(m) for m in rng.integers(1, 4, size=3)]
        condition = polynomial_with([z for z, m in zip(zeros, multiplicity, strict=True) for _ in range(m)])
        assert_same_zeros(zeros_in_range(condition * (SPEED**2 + 1), speeds), zeros)


def test_a_multiple_zero_on_an_end_is_never_lost():
    for low, high in ((5.0, 9.0), (1.0, 5.0), (5.0, 5.0)):
        for others in ([], [7], [3], [7, 7], [3, 3, 7]):
            condition = polynomial_with([Fraction(z) for z in (5, 5, *others)])
            assert 5.0 in zeros_in_range(condition, (low, high))


# Bernstein's subdivision


def random_bivariate(rng, degree_V, degree_F):
    return sum(
        (int(rng.integers(-9, 10)) * SPEED**i * LOAD**j for i in range(degree_V + 1) for j in range(degree_F + 1)),
        RING.constant(1),
    )


def value_at(condition, V, F_z):
    """Exact value of a polynomial in V and F."""
    total = Q(0)
    for (_, i, j), coefficient in condition.terms():
        total += coefficient * rational(V) ** i * rational(F_z) ** j
    return total


def test_bernstein_coefficients_are_those_of_the_polynomial():
    """Against the definition sum_k b_k C(n, k) t^k (1 - t)^(n - k), in rational numbers."""
    rng = np.random.default_rng(5)
    for _ in range(20):
        n = int(rng.integers(0, 8))
        power = [Fraction(int(c), 7) for c in rng.integers(-20, 20, size=n + 1)]
        low, high = Fraction(int(rng.integers(-5, 5)), 3), Fraction(int(rng.integers(6, 9)), 2)
        b = _bernstein_1d(np.array(power, dtype=object), low, high)
        for t in (Fraction(0), Fraction(1, 3), Fraction(4, 5), Fraction(1)):
            direct = sum(c * (low + (high - low) * t) ** k for k, c in enumerate(power))
            assert sum(b[k] * math.comb(n, k) * t**k * (1 - t) ** (n - k) for k in range(n + 1)) == direct


def test_bernstein_coefficients_enclose_the_polynomial_on_a_box_and_on_its_halves():
    rng = np.random.default_rng(6)
    for _ in range(10):
        condition = random_bivariate(rng, 4, 3)
        box = _bernstein(condition, (0.5, 2.0), (1.0, 3.0))
        corner = value_at(condition, 0.5, 1.0)
        scale = Fraction(int(box[0, 0])) / Fraction(int(corner.p), int(corner.q)) if corner != 0 else None
        if scale is None:
            continue
        assert scale > 0
        for axis in (0, 1):
            left, right = _halves(box, axis)
            factor = 2 ** (box.shape[axis] - 1)
            for half, first in ((left, True), (right, False)):
                ends = [(0.5, 2.0), (1.0, 3.0)]
                low, high = ends[axis]
                ends[axis] = (low, (low + high) / 2) if first else ((low + high) / 2, high)
                for V, F_z in rng.uniform(*np.array(ends).T, size=(20, 2)):
                    exact = value_at(condition, V, F_z)
                    value = Fraction(int(exact.p), int(exact.q)) * scale * factor
                    assert half.min() <= value <= half.max()
                # a half starts and ends at values of the polynomial itself
                exact = value_at(condition, ends[0][0], ends[1][0])
                assert half[0, 0] == Fraction(int(exact.p), int(exact.q)) * scale * factor


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("reserve", [Q(1), Q(1, 10**4), Q(1, 10**8)])
def test_a_polynomial_without_zeros_in_the_rectangle_is_proved_to_have_none(sign, reserve):
    """Sums of squares plus a small number: positive everywhere by construction, with minima inside and on edges."""
    rng = np.random.default_rng(8)
    for _ in range(8):
        V, F_z = (Q(int(n), 7) for n in rng.integers(0, 30, size=2))
        condition = (SPEED - V) ** 2 + (LOAD - F_z) ** 2 * (1 + SPEED**2) + reserve
        point, examined = zero_in_rectangle(sign * condition, (0.5, 4.0), (0.25, 3.0))
        assert point is None
        assert examined < 1000


def test_a_polynomial_with_zeros_in_the_rectangle_is_never_proved_positive():
    """Zero curves, lone zeros inside (not on dyadic points), on edges and at corners."""
    third = Q(1, 3)
    lone = (SPEED - 1 - third) ** 2 + (LOAD - 1 - third) ** 2
    touching = {
        "lone zero inside": (lone, (4 / 3, 4 / 3)),
        "zero on an edge": (SPEED - Q(1, 2) + (LOAD - 1 - third) ** 2, (0.5, 4 / 3)),
        "zero at a corner": (SPEED - Q(1, 2) + LOAD - Q(1, 4), (0.5, 0.25)),
        "zero at the far corner": (4 - SPEED + 3 - LOAD, (4.0, 3.0)),
        "negative inside a small disc": (lone - Q(1, 10**8), (4 / 3, 4 / 3)),
    }
    for name, (condition, where) in touching.items():
        point, _ = zero_in_rectangle(condition, (0.5, 4.0), (0.25, 3.0))
        assert point is not None, name
        assert np.allclose(point, where, atol=1e-3), name
    point, _ = zero_in_rectangle(-touching["negative inside a small disc"][0], (0.5, 4.0), (0.25, 3.0))
    assert point is not None


@pytest.mark.parametrize("seed", range(3))
def test_random_polynomials_are_judged_as_by_a_dense_grid(seed):
    rng = np.random.default_rng(seed)
    verdicts = set()
    for _ in range(15):
        condition = random_bivariate(rng, int(rng.integers(0, 6)), int(rng.integers(0, 4))) + int(rng.choice([0, 30, -30]))
        values = [value_at(condition, V, F_z) for V in np.linspace(0.25, 1.5, 17) for F_z in np.linspace(0.5, 1.25, 17)]
        point, _ = zero_in_rectangle(condition, (0.25, 1.5), (0.5, 1.25))
        if point is None:
            assert all(v > 0 for v in values) or all(v < 0 for v in values)
        else:
            # the point has the other sign than the first corner, or is a zero
            assert value_at(condition, *point) * values[0] <= 0
        verdicts.add(point is None)
    assert verdicts == {True, False}


def test_a_single_speed_is_a_rectangle_without_width():
    condition = (SPEED - 2) ** 2 + LOAD - 1
    assert zero_in_rectangle(condition, (3.0, 3.0), (0.5, 2.0))[0] is None
    assert zero_in_rectangle(condition, (2.0, 2.0), (0.5, 2.0))[0] is not None
    assert zero_in_rectangle(condition, (2.0, 2.0), (1.0, 2.0))[0] == (2.0, 1.0)

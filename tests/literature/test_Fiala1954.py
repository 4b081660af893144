"""Brush law of Fiala (1954): numbers of an independent prototype, a quadrature over the bristles, and the limits of the law."""

from __future__ import annotations

import math

import numpy as np
import pytest
from components_of import tyre_of
from scipy.integrate import quad

from damperopt.expressions.corners import Linear
from damperopt.tyres.assembly import slip_laws, tyre

LOAD = 150e3
SLIDES = 0.6857295  # rad: tan = 3 mu F_z/C_Fa
NUMBERS = {0.02: (8587.7585, 272.37735), 0.2: (68919.374, 1265.5568), 0.5: (115596.88, 293.99754)}


@pytest.fixture(scope="module")
def brush():
    keys = {"half_contact_length": 0.1, "relaxation_length": 0.3, "cornering_stiffness": 440e3, "friction": 0.8}
    return tyre(slip_laws()["brush"]).model_validate({"law": "brush", **keys})


@pytest.mark.parametrize("alpha", NUMBERS)
@pytest.mark.parametrize("sign", [1, -1])
def test_force_and_moment(brush, alpha, sign):
    force, moment = NUMBERS[alpha]
    assert brush.force(sign * alpha, LOAD, None) == pytest.approx(sign * force, rel=1e-7)  # eight digits are given
    assert brush.moment(sign * alpha, LOAD, None, Linear()) == pytest.approx(sign * moment, rel=1e-7)


def test_sliding(brush):
    assert math.atan(3 * 0.8 * LOAD / 440e3) == pytest.approx(SLIDES, abs=5e-8)
    for alpha in (SLIDES + 1e-6, 0.9):
        assert brush.force(alpha, LOAD, None) == pytest.approx(0.8 * LOAD, rel=1e-12)
        assert brush.moment(alpha, LOAD, None, Linear()) == 0


def test_peaks_are_met_and_bound(brush):
    alphas = np.linspace(0, 0.78, 4001)
    peaks = brush.peaks(LOAD, None)
    forces = [brush.force(float(alpha), LOAD, None) for alpha in alphas]
    moments = [brush.moment(float(alpha), LOAD, None, Linear()) for alpha in alphas]
    assert max(forces) == pytest.approx(peaks.side_force, rel=1e-12)
    assert max(moments) <= peaks.aligning_moment == pytest.approx(max(moments), rel=1e-6)  # of a grid


def test_slopes_at_zero_slip(brush):
    C_Fa, C_Ma, *_ = brush.linear(LOAD, None)
    assert (C_Fa, C_Ma) == (440e3, pytest.approx(440e3 * 0.1 / 3, rel=1e-15))
    assert brush.force(1e-7, LOAD, None) / 1e-7 == pytest.approx(C_Fa, rel=1e-6)
    assert brush.moment(1e-7, LOAD, None, Linear()) / 1e-7 == pytest.approx(C_Ma, rel=1e-6)


def over_bristles(alpha, mu):
    """Force and moment about the middle of the footprint, bristle by bristle.

    A bristle that entered the footprint at x = a has the deflection (a - x) tan(alpha) at x, and slides where its spring would
    pull more than mu times the pressure 3 F_z/(4 a) (1 - x^2/a^2) on it.
    """
    a, slip = 0.1, abs(math.tan(alpha))
    stiffness = 440e3 / (2 * a**2)  # per length: its force is C_Fa tan(alpha) where all stick

    def pull(x):
        return min(stiffness * (a - x) * slip, mu * 3 * LOAD / (4 * a) * (1 - (x / a) ** 2))

    # both meet where 1 + x/a = (4 a^2 stiffness slip)/(3 mu F_z)
    corner = [min(a, a * (4 * a**2 * stiffness * slip / (3 * mu * LOAD) - 1))]
    force = quad(pull, -a, a, points=corner, epsabs=0, epsrel=1e-12)[0]
    moment = quad(lambda x: -x * pull(x), -a, a, points=corner, epsabs=1e-9, epsrel=1e-12)[0]
    return math.copysign(force, alpha), math.copysign(1.0, alpha) * moment


@pytest.mark.parametrize("alpha", [1e-3, 0.02, -0.1, 0.2, 0.5, -0.68, 0.75])
@pytest.mark.parametrize("falls_to", [None, 0.5])
def test_is_the_sum_of_its_bristles(brush, alpha, falls_to):
    mu = 0.8 - (0 if falls_to is None else (0.8 - falls_to) * abs(math.tan(alpha)))
    law = brush if falls_to is None else brush.model_copy(update={"sliding_friction": falls_to})
    force, moment = over_bristles(alpha, mu)
    assert law.force(alpha, LOAD, None) == pytest.approx(force, rel=1e-10)
    assert law.moment(alpha, LOAD, None, Linear()) == pytest.approx(moment, rel=1e-8, abs=1e-6)


def test_friction_that_falls(brush):
    law = brush.model_copy(update={"sliding_friction": 0.5})
    assert law.force(1.2, LOAD, None) == pytest.approx(0.5 * LOAD)  # tan(1.2) > 1
    assert law.force(0.7, LOAD, None) < brush.force(0.7, LOAD, None)


def test_pneumatic_trail_at_zero_slip_is_a_third_of_the_half_length(brush):
    assert brush.moment(1e-7, LOAD, None, Linear()) / brush.force(1e-7, LOAD, None) == pytest.approx(0.1 / 3, rel=1e-6)


@pytest.mark.parametrize("alpha", [0.02, -0.2, 0.5, 0.75])
def test_law_of_gim_and_nikravesh_is_the_same_function(brush, alpha):
    """UA at zero camber: C_a S l^2 + mu F_z (1 - 3 l^2 + 2 l^3), l = 1 - S/S*, S* = 3 mu F_z/C_a, S = |tan(alpha)|."""
    slip, grip = abs(math.tan(alpha)), 0.8 * LOAD
    sticks = max(0.0, 1 - slip * 440e3 / (3 * grip))
    force = 440e3 * slip * sticks**2 + grip * (1 - 3 * sticks**2 + 2 * sticks**3)
    assert brush.force(alpha, LOAD, None) == pytest.approx(math.copysign(force, alpha), rel=1e-12)


@pytest.mark.parametrize("name", ["fiala", "ua", "brush"])
def test_law_has_the_names_of_both(brush, name):
    block = {"half_contact_length": 0.1, "relaxation_length": 0.3, "cornering_stiffness": 440e3, "friction": 0.8}
    assert tyre_of(law=name, **block) == brush

"""Brush law of Fiala (1954): numbers of an independent quadrature over the bristles, and the limits of the law."""

from __future__ import annotations

import math

import numpy as np
import pytest

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

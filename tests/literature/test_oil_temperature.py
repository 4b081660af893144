"""Oil over temperature: viscosities of an independent prototype, and gears whose damping is that of the factor."""

from __future__ import annotations

import math

import numpy as np
import pytest
from components_of import damper_of

from damperopt import load, optimise
from damperopt.dampers.base import Context
from damperopt.dampers.oil import Oil, orifice_area
from damperopt.expressions.corners import Linear
from damperopt.stability.linear import linear_gear


def viscosity(T, points=((313.15, 13.5), (373.15, 5.0))):
    """In mm^2/s; decimal logarithms, as the standard prints it."""
    (T_1, nu_1), (T_2, nu_2) = points
    y_1, y_2 = (math.log10(math.log10(nu + 0.7)) for nu in (nu_1, nu_2))
    B = (y_1 - y_2) / (math.log10(T_2) - math.log10(T_1))
    return 10**10 ** (y_1 + B * (math.log10(T_1) - math.log10(T))) - 0.7


@pytest.mark.parametrize(
    ("celsius", "printed"), [(-54, 522.8), (-40, 219.4), (20, 21.71), (40, 13.5), (70, 7.71), (100, 5.0), (135, 3.37)]
)
def test_viscosity(celsius, printed):
    found = 1e6 * Oil(temperature=293.15).viscosity(273.15 + celsius)
    assert found == pytest.approx(printed, abs=0.006 if printed < 100 else 0.06)
    assert found == pytest.approx(viscosity(273.15 + celsius), rel=1e-9)


@pytest.mark.parametrize(
    "block",
    [
        {"topology": "boeing"},
        {"topology": "rotational", "torsional_stiffness": 0.0, "kind": "vane", "mean_radius": 0.05, "vane_width": 0.03},
    ],
)
def test_damping_at_a_temperature(block):
    name = "c_vane" if "kind" in block else "c_lambda"
    damper = damper_of(**block, oil={"temperature": 233.15, "laminar_fraction": 0.3})
    expected = 0.3 * viscosity(233.15) / viscosity(293.15) + 0.7 * (1 + 8e-4 * 60)
    assert damper.damping({name: 100.0}) == pytest.approx(100 * expected)
    assert damper.equivalent({name: 100.0}, 1e-3, 70.0, Context())[1] == pytest.approx(100 * expected)
    assert damper.rate({name: 100.0}, {}, 0.0, 5.0, Context(), Linear()) == pytest.approx(0.05 / expected)
    warm = damper.force({name: 100.0}, {}, 0.0, 1.0, Context(temperature=293.15), Linear()).force
    assert warm == pytest.approx(100.0)


def test_a_hot_gear_has_less_damping_and_needs_more_of_it(configs):
    """The steered nose gear at 70 degrees has the matrices of a smaller damping, and an optimum larger by the factor."""
    study = load(configs / "nose_gear_steered.yaml")
    hot = study.replace(damper__oil={"temperature": 343.15})
    factor = 0.2 * viscosity(343.15) / viscosity(293.15) + 0.8 * (1 - 8e-4 * 50)
    matrices = [linear_gear(s, {"c_vane": c}).matrices(30.0, 30e3) for s, c in ((hot, 400.0), (study, 400.0 * factor))]
    np.testing.assert_allclose(*matrices, rtol=1e-12)
    assert optimise(hot).design["c_vane"] == pytest.approx(optimise(study).design["c_vane"] / factor, rel=1e-4)


def test_oil_that_thickens_with_heat_is_refused():
    with pytest.raises(ValueError, match="thinner when it is hot"):
        Oil(temperature=293.15, viscosity_at_40_degrees=5e-6, viscosity_at_100_degrees=6e-6)


@pytest.mark.parametrize(
    ("text", "kelvin"), [("20 degC", 293.15), ("-65 degF", 219.2611111), ("-54 °C", 219.15), ("300 K", 300.0), (300, 300.0)]
)
def test_temperatures_with_units(text, kelvin):
    assert Oil(temperature=text).temperature == pytest.approx(kelvin, rel=1e-9)


@pytest.mark.parametrize("text", ["20", "20 C", "20 degC degC", 20, "-300 degC", "20,5 degC"])
def test_what_is_no_temperature_is_refused(text):
    with pytest.raises(ValueError, match="such as '20 degC'"):
        Oil(temperature=text)


def test_a_range_refers_to_a_temperature_within():
    span = Oil(temperature={"min": "-54 degC", "max": "70 degC"})
    assert span.factor() == 1.0
    assert span.factor(span.span.min) == pytest.approx(0.2 * 522.8 / 21.71 + 0.8 * (1 + 8e-4 * 74), rel=1e-3)
    with pytest.raises(ValueError, match="within the range"):
        Oil(temperature={"min": "30 degC", "max": "70 degC"})


def test_orifice_for_a_damping():
    """The orifice of 6 mm^2 whose simulated first harmonic at 2 mm and 70 rad/s is 725.641 N s/m."""
    assert orifice_area(725.641, 6e-4, 2e-3 * 70.0, 860.0) == pytest.approx(6e-6, rel=1e-3)

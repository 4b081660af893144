"""Optima that survive an interval of dampings: what one costs, what breaks without it, what the cold damper must bear."""

from __future__ import annotations

import math

import numpy as np
import pytest

from damperopt import certify, optimise
from damperopt.proof.check import check_decay
from damperopt.stability.linear import LinearModel
from damperopt.strength.release import peak_damper_torque

NOMINAL = {"c_lambda": 34802.68, "I_arm": 5.666277826e-7, "L": 0.47810114, "gamma": 0.53210236, "b": 0.15244488}
SURVIVING = {"c_lambda": 60499.07, "I_arm": 5.666277827e-7, "L": 0.4868774594, "gamma": 0.5619666434, "b": 0.1743259055}
"""Optima of the thesis gear with its decay requirement, for one damping and for 0.5 to 2 times it."""


@pytest.fixture(scope="module")
def linear(main_gear):
    return main_gear.replace(solver__starts=2)


@pytest.fixture(scope="module")
def nominal(linear):
    return optimise(linear)


@pytest.fixture(scope="module")
def surviving(linear):
    return optimise(linear.replace(damper__damping_range=[0.5, 2.0]))


def test_price(nominal, surviving):
    """3.5 % of mass for a factor of two either way: twice the damping, and a damper four times as strong."""
    assert nominal.status == surviving.status == "solved"
    assert nominal.mass.total == pytest.approx(11.415, abs=2e-3)
    assert surviving.mass.total == pytest.approx(11.811, abs=2e-3)
    assert surviving.certificate.damping == (0.5, 2.0)
    assert surviving.stability.damping == pytest.approx(0.5)
    assert surviving.design["c_lambda"] == pytest.approx(2.03 * nominal.design["c_lambda"], rel=0.01)


def test_every_damping_of_the_interval(main_gear, surviving):
    """Eigenvalues of the gear with other dampings written into the design."""
    model, V = LinearModel(main_gear), np.geomspace(5, 100, 400)
    for factor in np.linspace(0.5, 2, 31):
        design = surviving.design | {"c_lambda": factor * surviving.design["c_lambda"]}
        assert model.at(design).abscissa(V, 150e3).max() < -0.1


@pytest.mark.verify
def test_an_optimum_of_one_damping_survives_no_other(linear, nominal):
    """Half of its damping misses the margin; an eighth is unstable, though the whole is proved stable."""
    found = certify(linear.replace(damper__damping_range=[0.5, 2.0]), nominal.design)
    assert found.verdict == "refuted"
    assert found.damping_factor < 1
    assert certify(linear, nominal.design, 0.0).proved
    eighth = certify(linear.replace(damper__damping_range=[0.125, 1.0]), nominal.design, 0.0)
    assert eighth.verdict == "refuted"
    design = nominal.design | {"c_lambda": eighth.damping_factor * nominal.design["c_lambda"]}
    assert LinearModel(linear).at(design).abscissa(*eighth.counterexample)[0] > 0


def test_force_is_that_of_the_largest_damping(main_gear, surviving):
    """2 c ell T/sqrt(k_psi I_z) of a rigid chain."""
    k_psi = surviving.derived["torsional_stiffness"]
    reach = surviving.design["L"] * math.sin(surviving.design["gamma"])
    expected = 2 * surviving.design["c_lambda"] * reach * surviving.limit_event["linkage_torque"]
    expected /= math.sqrt(k_psi * main_gear.gear.yaw_inertia)
    assert surviving.limit_event["damper_force"] == pytest.approx(expected, rel=1e-9)


@pytest.mark.verify
@pytest.mark.parametrize("factor", [0.7, 0.5, 2.0])
def test_decay(main_gear_with_decay, factor):
    """A single factor of 0.7 breaks the decay of an optimum of one damping; one made for the interval keeps it."""
    study = main_gear_with_decay.replace(requirements__decay__speeds=[20.0, 35.0, 37.0, 60.0])
    ratios = [check_decay(study, of | {"c_lambda": factor * of["c_lambda"]}).ratio for of in (NOMINAL, SURVIVING)]
    assert (ratios[0] > 1 / 3) == (factor < 1)
    assert ratios[1] <= 1 / 3


def test_the_force_grows_with_the_damping():
    """Of elastic chains at random: the coldest oil is the worst case."""
    rng = np.random.default_rng(5)
    for _ in range(100):
        k = 10 ** rng.uniform(4.5, 6.5)
        front, series = k * 10 ** rng.uniform(-0.5, 2), k * 10 ** rng.uniform(-0.5, 2)
        dampings = k / 60 * np.geomspace(0.01, 30, 25)
        forces = np.array([float(peak_damper_torque(1.0, 100.0, front, k, c, series)) for c in dampings])
        assert (np.diff(forces) > -2e-3 * forces[1:]).all(), (k, front, series)


@pytest.mark.verify
def test_oil_over_temperature_is_an_interval(linear):
    """The factors of the oil at both ends, given as such, make the same optimum; the result shows the dampings."""
    warm = linear.replace(solver__starts=1, damper__oil={"temperature": {"min": "-20 degC", "max": "158 degF"}})
    low, high = warm.damper.damping_factors()
    same = linear.replace(solver__starts=1, damper__damping_range=[low, high])
    found, other = optimise(warm), optimise(same)
    assert found.status == "solved"
    assert found.mass.total == pytest.approx(other.mass.total, rel=1e-9)
    c = found.design["c_lambda"]
    shown = [found.derived[f"c_lambda_at_{T}_degC"] / c for T in (-54, 20, 70)]
    assert shown == pytest.approx([5.66266, 1.0, 0.838996], abs=1e-5)  # 0.2 x 522.8/21.71 + 0.8 (1 + 8e-4 x 74), ...
    assert shown[2] == pytest.approx(low)

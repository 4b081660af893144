"""Elastomer dampers: loss of a standard linear solid, gears with the element written out, and the block that they weigh."""

from __future__ import annotations

import numpy as np
import pytest
from components_of import damper_of
from table_gear import table_gear

from damperopt import Study
from damperopt.dampers.base import Context
from damperopt.ports.sizing import LimitEvent
from damperopt.stability.linear import linear_gear
from damperopt.study.mass_model import MassModel

ELL, OMEGA, ETA, K_E = 0.3, 70.0, 0.204124, 1e6
LINKS = {"topology": "boeing", "geometry": "planar", "compliance": "rigid", "loss_factor": ETA, "loss_frequency": OMEGA}
DESIGN = {"k_elastomer": K_E, "k_lambda": 3e6, "L": 0.6, "gamma": np.arcsin(ELL / 0.6)}


def gear(kind, **joints):
    study = table_gear()
    design = {name: {"start": value, "min": value / 2, "max": value * 2} for name, value in DESIGN.items() if name != "gamma"}
    design["gamma"] = {"start": DESIGN["gamma"], "min": 0.1, "max": 1.5}
    required = {"stability_margin": 0.1, "lug_distance": {"min": 0.4, "max": 1.2}, "reach": {"min": 0.1, "max": 0.4}}
    more = {"damper": LINKS | {"kind": kind} | joints, "design": design, "requirements": required | {"limit_torque": 1e4}}
    return Study.model_validate(study.model_dump(exclude_none=True) | more)


def test_largest_loss_of_the_solid():
    """r = 1.5 has the loss factor 0.204124, at omega tau = 0.816497, and less to either side."""
    zener = damper_of(**LINKS, kind="zener")

    def loss(omega):
        k, c = zener.equivalent({"k_elastomer": K_E}, 1.0, omega, Context())
        return omega * c / k, k

    assert loss(OMEGA)[0] == pytest.approx(ETA, rel=1e-9)
    assert max(loss(0.9 * OMEGA)[0], loss(1.1 * OMEGA)[0]) < ETA
    assert loss(1e-6)[1] == pytest.approx(K_E)
    assert loss(1e9)[1] == pytest.approx(1.5 * K_E, rel=1e-5)
    force = zener.force({"k_elastomer": K_E}, {"relaxed_stroke": 0.0}, 1e-3, 0.0, Context(), None)
    tau = 1e-3 / force.rates["relaxed_stroke"]
    assert pytest.approx(0.816497, rel=1e-5) == tau * OMEGA


def test_gear_with_spring_and_dashpot_is_one_with_their_sum():
    A = linear_gear(gear("kelvin_voigt")).matrices(40.0, 150e3)[0]
    expected = linear_gear(table_gear(ELL**2 * (3e6 + K_E), ELL**2 * ETA * K_E / OMEGA)).matrices(40.0, 150e3)[0]
    np.testing.assert_allclose(A, expected, rtol=1e-12)


@pytest.mark.parametrize("K_t", [None, 8e5])
def test_gear_with_the_solid_against_its_dynamic_stiffness(K_t):
    """At an eigenvalue s, the gear with the spring k_0 + k_1 s tau/(1 + s tau) in the damper's place has it too.

    Behind elastic links, K_t about the yaw axis, the linkage stands where forces balance: no state, and stiffnesses in series.
    """
    study = gear("zener", **({} if K_t is None else {"link_stiffness": K_t / ELL**2}))
    values = np.linalg.eigvals(linear_gear(study).matrices(40.0, 150e3)[0])
    tau, k_1 = 0.816497 / OMEGA, 0.5 * K_E
    stiff, stiffer = (linear_gear(table_gear(k, 0.0)).matrices(40.0, 150e3)[0] for k in (3.8e5, 4.8e5))
    for s in values:
        k = ELL**2 * (3e6 + K_E + k_1 * s * tau / (1 + s * tau))
        k = k if K_t is None else k * K_t / (k + K_t)
        made = stiff + (stiffer - stiff) * (k - 3.8e5) / 1e5
        assert np.abs(np.linalg.eigvals(made) - s).min() < 1e-4 * abs(s)
    assert len(values) == 6


@pytest.mark.parametrize("kind", ["kelvin_voigt", "zener"])
def test_block_of_rubber(kind):
    """Thickness stroke/shear, area k t/G: the volume is k stroke^2/(G shear^2)."""
    damper, model = damper_of(**LINKS, kind=kind), MassModel(wall_allowance=0.0)
    k, c = damper.equivalent({"k_elastomer": K_E}, 1.0, OMEGA, Context())
    dynamic, stroke, rate = np.hypot(k, OMEGA * c), 0.01, 0.01 * 55.0
    force = damper.peak_force({"k_elastomer": K_E}, rate)
    assert force == pytest.approx(dynamic * rate / OMEGA)
    event = LimitEvent(1e4, 0.03, 0.03 * 55.0, stroke, force, 1e4, 0, 1e4, 100.0)
    assert damper.parts(event, model).masses["damper"] == pytest.approx(1100 * dynamic * stroke**2 / (1e6 * 0.4**2))

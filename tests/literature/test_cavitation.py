"""Cavitation by hand: F/(2 A) off the charge, at the force that a simulation shows and at that of the limit event."""

from __future__ import annotations

import pytest
from table_gear import CARCASS, table_gear

from damperopt import Study, optimise, simulate_exactly
from damperopt.study.cavitation import cavitation


def studied(**damper):
    base = table_gear(tyre=CARCASS).model_dump(exclude_none=True)
    base["damper"] = {"topology": "boeing", "geometry": "planar", "compliance": "rigid", **damper}
    base["envelope"] = {"speed": {"min": 10.0, "max": 60.0}, "vertical_load": 150e3}
    base["design"] = {"c_lambda": 2e4, "k_lambda": 5e6, "L": 0.6, "gamma": 0.5}
    required = {"stability_margin": 0.1, "limit_torque": 3e4}
    base["requirements"] = required | {"lug_distance": {"min": 0.4, "max": 1.1}, "reach": {"min": 0.1, "max": 0.4}}
    base["mass"] = {"working_pressure": 2e7}
    return Study.model_validate(base)


def test_by_hand():
    """The piston is as large as the limit event asks, A = F_lim/p; a bore that is given has its own area."""
    study = studied(charge_pressure=1e6)
    lever = 0.6 * 0.479425538604203
    limit = 2e4 * lever * 3e4 / (5e6 * lever**2) * (5e6 * lever**2 / 100) ** 0.5  # c v of c_lambda at the limit event
    area = limit / 2e7
    border = 2 * area * (1e6 - 1e3)
    assert cavitation(study, study.start, 0.999 * border) == ""
    words = cavitation(study, study.start, 4 * border)
    assert "would be at -3 MPa" in words  # 1 - 4 (1 - 0.001)
    assert "enough for this: 4 MPa" in words
    assert "would be at -9 MPa" in cavitation(study, study.start)  # 1 MPa - p/2 at the limit event
    assert cavitation(studied(), study.start) == ""
    assert cavitation(studied(charge_pressure=1.1e7), study.start) == ""


def test_at_the_simulated_peak():
    study = studied(charge_pressure=1e6)
    motion = simulate_exactly(study, speed=40.0, disturbance={"kick": {"yaw_rate": 8.0}}, duration=0.2)
    peak = abs(motion["damper_force"]).max()
    assert peak == pytest.approx(2e4 * abs(motion["damper_speed"]).max(), rel=1e-6)
    assert "oil cavitates" in cavitation(study, study.start, peak)


def test_result_says_it():
    assert any("oil cavitates" in words for words in optimise(studied(charge_pressure=1e6)).implausible)
    silent = optimise(studied())
    assert not any("cavitates" in words for words in silent.implausible)
    assert any("cavitation of the oil" in words for words in silent.leaves_out)

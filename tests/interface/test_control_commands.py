"""Control and cavitation on the command line: gains that come back as a block, both proofs, warnings at a peak."""

from __future__ import annotations

import json
import re

import pytest
import yaml

from damperopt import load_result
from damperopt.output.words import certificate

GEAR = """
name: gear with an actuator
gear: {kind: yaw_bending, yaw_inertia: 100 kg m^2, caster_length: 0.12 m, wheel_radius: 0.362 m,
       lateral: {inertia: 600 kg m^2, stiffness: 6.1 MN m/rad, damping: 300 N m s/rad, height: 2.5 m}}
tyre: {law: stiffness, contact: leading_point, carcass_stiffness: 1.4e6 N/m^2, half_contact_length: 0.1 m,
       relaxation_length: 0.3 m}
damper: {topology: boeing, geometry: planar, compliance: rigid, charge_pressure: 1 MPa}
envelope: {speed: {min: 10 m/s, max: 60 m/s}, vertical_load: 150 kN}
requirements: {stability_margin: 2 1/s, limit_torque: 30 kN m,
               lug_distance: {min: 0.4 m, max: 1.1 m}, reach: {min: 0.1 m, max: 0.4 m}}
design: {c_lambda: 12 kN s/m, k_lambda: 5 MN/m, L: 0.6 m, gamma: 0.5 rad}
solver: {starts: 1, verification_speeds: 50, bound_seconds: 0}
"""


@pytest.fixture
def study(tmp_path):
    path = tmp_path / "study.yaml"
    path.write_text(GEAR, encoding="utf-8")
    return path


def changed(path, **blocks):
    data = yaml.safe_load(path.read_text(encoding="utf-8"))
    for block, keys in blocks.items():
        data[block] |= keys
    path.write_text(yaml.safe_dump(data), encoding="utf-8")


def test_gains_come_back_as_a_block(call, study):
    options = ("--size", "yaw_angle=10mrad", "--torque", "2 kN m", "--measured", "yaw_rate", "--degree", "1")
    found = call("gains", study, *options)
    assert found.code == 0, found.err
    block = yaml.safe_load(found.out.split("study:\n")[1].split("Exact")[0])
    assert block["control"]["gains"].keys() == {"yaw_rate"}
    changed(study, damper=block, requirements={"fail_safe_margin": 0.5})
    analysed = " ".join(call("analyse", study).out.split())
    assert re.search(r"Exact certificate, margin 2 1/s: proved", analysed), analysed
    assert re.search(r"Exact certificate, stable, actuator off: (proved|not met)", analysed), analysed
    assert "as long as it does not saturate" in analysed


def test_both_proofs_in_a_result(call, study, tmp_path):
    control = {"gains": {"yaw_rate": {"constant": 3000}}, "lag": "4 ms", "limit": "2 kN m", "mass": "3 kg"}
    changed(study, damper={"control": control}, requirements={"fail_safe_margin": 0.5})
    changed(study, design={"c_lambda": {"start": 2e4, "min": 1e3, "max": 1e6}})
    found = call("optimise", study, "--no-figures", "-o", tmp_path / "run")
    assert found.code == 0, found.out + found.err
    result = json.loads((tmp_path / "run" / "result.json").read_text(encoding="utf-8"))
    assert [result[key]["verdict"] for key in ("certificate", "fail_safe")] == ["proved", "proved"]
    assert [result[key]["margin"] for key in ("certificate", "fail_safe")] == [2.0, 0.5]
    assert result["mass"]["parts"]["actuator"] == 3.0
    assert any(c["name"] == "fail_safe_margin" for c in result["constraints"])
    assert "Exact certificate, actuator off: proved: margin 0.5 1/s" in " ".join(found.out.split())
    assert "With the actuator off: Proved" in certificate(load_result(tmp_path / "run"))


def test_what_gains_refuses(call, study):
    for options, words in (
        (("--size", "yaw=1", "--torque", "1 kN m"), "--size: found 'yaw=1'"),
        (("--size", "yaw_rate=-1", "--torque", "1 kN m"), "--size yaw_rate"),
        (("--size", "yaw_rate=1", "--torque", "1 kg"), "--torque"),
        (("--size", "yaw_rate=1", "--torque", "1 kN m", "--measured", "speed"), "'speed' is no state that can be measured"),
    ):
        found = call("gains", study, *options)
        assert found.code == 2
        assert words in found.err


def test_cavitation_is_said(call, study, tmp_path):
    checked = call("validate", study)
    assert checked.code == 0
    assert "oil cavitates" in checked.err
    found = call("simulate", study, "--speed", "40", "--kick", "yaw=8rad/s", "--duration", "0.2", "-o", tmp_path / "run")
    assert found.code == 0, found.err
    assert "Cavitation: damper.charge_pressure" in found.out

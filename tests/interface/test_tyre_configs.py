"""The shipped gears with real-sized tyres: usual numbers, a proof that eigenvalues confirm, tyres that move with the load."""

import numpy as np
import pytest

import damperopt
from damperopt.study.plausibility import implausible


@pytest.mark.parametrize(("name", "law"), [("nose_gear_tr_r64", "tr_r64"), ("main_gear_property_file", "magic_formula")])
def test_gear_is_usual_and_proved(configs, name, law):
    study = damperopt.load(configs / f"{name}.yaml")
    assert study.tyre.law == law
    assert not implausible(study)
    assert damperopt.certify(study, study.start, margin=0.0).proved
    gear, speeds = damperopt.linear_gear(study), np.linspace(study.envelope.speed.min, study.envelope.speed.max, 300)
    for load in study.envelope.loads:
        assert gear.abscissa(speeds, load).max() < 0
    data = [tuple(study.tyre.linear(load, study.tyre.pressure)) for load in study.envelope.loads]
    for values in zip(*data, strict=True):
        assert len(set(values)) == 3  # stiffnesses and lengths are those of each load


def test_invented_tyre_says_so(configs):
    for file in (configs / "tyres" / "invented_main.tir", configs / "main_gear_property_file.yaml"):
        assert "invented" in file.read_text()

"""Sweeps that are refused, with file, line and key; the shipped ones."""

import pytest

from damperopt.errors import ConfigError
from damperopt.sweep import load_sweep, sweep_of

MANY = ("gear.caster_length", "gear.yaw_inertia", "tyre.relaxation_length", "tyre.aligning_coefficient")

BAD = {
    "unknown key": ("vary: {gear.caster: [1, 2]}", "gear.caster"),
    "unit": ("vary: {gear.caster_length: [1 kg, 2 kg]}", "kg"),
    "nothing": ("run: analyse", "nothing is varied"),
    "empty list": ("vary: {gear.caster_length: []}", "empty list"),
    "twice": ("vary: {gear.caster_length: [0.1, 100 mm]}", "twice"),
    "inverted": ("vary: {gear.caster_length: {from: 2, to: 1, points: 3}}", "from < to"),
    "log of zero": ("vary: {gear.caster_length: {from: 0, to: 1, points: 3, spacing: log}}", "0 < from"),
    "one point": ("vary: {gear.caster_length: {from: 0, to: 1, points: 1}}", "points"),
    "names and numbers": ("vary: {material: [AISI 4340, 3]}", "material"),
    "range of names": ("vary: {damper.topology: {from: 1, to: 2, points: 3}}", "range of names"),
    "law": ("samples: {count: 4, over: {gear.caster_length: {uniform: [2, 1]}}}", "low, high"),
    "two laws": ("samples: {count: 4, over: {gear.caster_length: {uniform: [1, 2], normal: [1, 2]}}}", "none or several"),
    "deviation": ("samples: {count: 4, over: {gear.caster_length: {normal: [1, -2]}}}", "deviation > 0"),
    "both": (
        "vary: {gear.caster_length: [1]}\nsamples: {count: 4, over: {gear.caster_length: {normal: [1, 2]}}}",
        "allowed: one of them",
    ),
    "set": ("set: {gear.mass: 3}\nvary: {gear.caster_length: [0.1]}", "gear.mass"),
    "block and key": ("vary: {gear.lateral: [1], gear.lateral.damping: [100.0, 200.0]}", "is inside 'gear.lateral'"),
    "fixed and varied": ("set: {gear.caster_length: 0.1}\nvary: {gear.caster_length: [0.1, 0.2]}", "is varied too"),
    "underscores": ("vary: {gear__caster_length: [0.1, 0.2]}", "no key path"),
    "yes": ("warm_start: 'yes'\nvary: {gear.caster_length: [0.1]}", "warm_start"),
    "too many": (
        "vary: {" + ", ".join(f"{key}: {{from: 1, to: 2, points: 65536}}" for key in MANY) + "}",
        f"{65536**4} points",
    ),
    "all invalid": ("vary: {gear.yaw_inertia: [-1.0, -2.0]}", "no point is a valid study"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_sweeps_are_refused_with_file_line_and_key(configs, tmp_path, case):
    text, words = BAD[case]
    path = tmp_path / "bad.yaml"
    path.write_text(f"base: {configs / 'thesis_gear.yaml'}\n{text}\n")
    with pytest.raises(ConfigError) as refused:
        load_sweep(path)
    assert words in str(refused.value)
    assert f"{path}:" in str(refused.value)


def test_missing_base_is_said_with_both_files(tmp_path):
    path = tmp_path / "lost.yaml"
    path.write_text("base: nowhere.yaml\nvary: {gear.caster_length: [0.1]}\n")
    with pytest.raises(ConfigError, match=r"lost.yaml:1: base: .*nowhere.yaml: cannot be read"):
        load_sweep(path)


def test_changes_that_hold_together_only_are_checked_together(main_gear, nose):
    pair = {"damper.topology": "rotational", "damper.torsional_stiffness": 1e4, "damper.torsional_damping": 300.0}
    sweep = sweep_of(main_gear, run="analyse", set=pair, vary={"gear.caster_length": [0.1, 0.2]})
    assert sweep.points[0].study.damper.topology == "rotational"
    with pytest.raises(ConfigError, match=r"set.*torsional_damping"):
        sweep_of(main_gear, run="analyse", set=dict(list(pair.items())[:2]), vary={"gear.caster_length": [0.1, 0.2]})


def test_shipped_sweeps_are_valid(configs):
    counts = {f.stem: len(load_sweep(f).points) for f in (configs / "sweeps").glob("*.yaml")}
    assert counts == {"margin": 15, "decay": 14, "ranking": 18, "envelope": 16, "scatter": 128}

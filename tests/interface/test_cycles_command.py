"""The command `damperopt cycles`: files, words, refused questions; and what `analyse` says of critical speeds."""

import csv
import json

import pytest

FILES = {"cycles.csv", "cycles.json", "largest-cycle.csv", "cycles.png", "cycles.svg"}

CASTOR = """
name: castor
gear: {kind: yaw, yaw_inertia: 0.6 kg m^2, caster_length: 0.09 m, wheel_radius: 0.17 m}
tyre: {law: linear, contact: leading_point, half_contact_length: 50 mm, relaxation_length: 0.12 m,
       cornering_slope: 6 1/rad, aligning_coefficient: 0 m/rad, tread_width_moment: 3 N m^2/rad}
damper: {topology: rotational, kind: friction, torsional_stiffness: 0 N m/rad, breakout_torque: 10 N m}
envelope: {speed: {min: 10 m/s, max: 20 m/s}, vertical_load: 1.2 kN}
"""


def test_branch_of_the_nose_gear_in_files_and_words(call, configs, tmp_path):
    """Over a damping: from 93.4 m/s, where 300 N m s/rad are just enough, to less."""
    study, folder = configs / "nose_gear_thota.yaml", tmp_path / "run"
    over = "torsional_damping=50:400"
    said = call("cycles", study, "--over", over, "--speed", "93.40291508693824", "--load", "150 kN", "-o", folder)
    assert said.code == 0, said.err
    assert {path.name for path in folder.iterdir()} == FILES, said.err
    record = json.loads((folder / "cycles.json").read_text())
    assert record["question"]["over"] == "damper.torsional_damping"
    (branch,) = record["branches"]
    assert branch["orbits"][0]["parameter"] == pytest.approx(300.0, rel=1e-4)
    assert all(orbit["stable"] for orbit in branch["orbits"])
    with open(folder / "cycles.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(branch["orbits"])
    column = "amplitude of yaw_angle [rad]"
    assert [float(row[column]) for row in rows] == pytest.approx([o["amplitudes"]["yaw_angle"] for o in branch["orbits"]])
    assert "Branch 1: from Hopf point at 300" in said.out
    assert "goes on beyond the range, 50" in said.out


def test_threshold_of_a_castering_wheel(call, tmp_path):
    (tmp_path / "castor.yaml").write_text(CASTOR)
    said = call("cycles", "castor.yaml", "--threshold", "release", "--points", "2", "-o", "run")
    assert said.code == 0, said.err
    points = json.loads((tmp_path / "run" / "threshold.json").read_text())["points"]
    assert [point["speed"] for point in points] == [10.0, 20.0]
    assert 0 < points[0]["dies"] < points[1]["dies"] < points[1]["not_dies"]
    assert "dies at 10 m/s" in said.out


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--from", "rest"), "--from: found 'rest'; allowed: hopf or simulation"),
        (("--over", "torsional_damping"), "has no range; allowed: torsional_damping=LOW:HIGH in N m s/rad"),
        (("--over", "speed=50:5"), "allowed: a finite range, low < high"),
        (("--over", "colour=1:2"), "'colour' is unknown"),
        (("--threshold", "push"), "--threshold: found 'push'; allowed: release or kick"),
        (("--threshold", "kick", "--points", "1"), "--points: found 1; allowed: 2 to 1000"),
        (("--threshold", "kick", "--over", "vertical_load"), "allowed: speed"),
        (("--speed", "0"), "--speed: "),
    ],
)
def test_bad_questions_leave_no_folder(call, configs, tmp_path, options, words):
    said = call("cycles", configs / "nose_gear_thota.yaml", *options)
    assert said.code == 2
    assert words in said.err
    assert not list(tmp_path.iterdir())


def test_no_hopf_point_is_no_proof(call, configs):
    said = call("cycles", configs / "nose_gear_thota.yaml", "--over", "speed=100:140", "--load", "150 kN", "-o", "run")
    assert "no Hopf point" in said.out
    assert "not excluded by this" in said.out


def test_analyse_says_how_limit_cycles_begin(call, configs, tmp_path):
    """The main gear's starts are subcritical: the branch goes to lower speeds, and turns back in a fold."""
    said = call("analyse", configs / "main_gear.yaml", "-o", "run")
    assert "subcritical: hidden shimmy below it" in said.out.replace("\n", " ")
    with open(tmp_path / "run" / "critical-speeds.csv", encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    assert row["criticality"] == "subcritical"
    critical = float(row["speed [m/s]"])
    over = f"speed={0.96 * critical}:{1.05 * critical}"
    said = call("cycles", configs / "main_gear.yaml", "--over", over, "-o", "cycles")
    (branch,) = json.loads((tmp_path / "cycles" / "cycles.json").read_text())["branches"]
    (fold,) = [orbit for orbit in branch["orbits"] if orbit["label"] == "fold"]
    assert fold["parameter"] < critical
    assert not branch["orbits"][0]["stable"]
    assert branch["orbits"][-1]["stable"]
    assert "hidden shimmy" in said.out


def test_a_limit_is_undecided_where_nothing_is_known(call, configs, tmp_path):
    """Rest is unstable and no branch begins in the range; and a castering wheel whose joints are closed."""
    nose = configs / "nose_gear_thota.yaml"
    said = call("cycles", nose, "--over", "speed=30:60", "--load", "150 kN", "--at-most", "1deg", "-o", "a")
    assert said.code == 3
    assert "undecided" in said.out
    assert "Rest is unstable" in said.out
    (tmp_path / "castor.yaml").write_text(CASTOR)
    said = call("cycles", "castor.yaml", "--at-most", "1deg", "-o", "b")
    assert said.code == 3
    assert "the joints were closed" in said.out
    said = call("cycles", nose, "--over", "speed=30:120", "--load", "150 kN", "--at-most", "9deg", "-o", "c")
    assert (said.code, "kept" in said.out) == (0, True)
    said = call("cycles", nose, "--over", "speed=30:120", "--load", "150 kN", "--at-most", "8deg", "-o", "d")
    assert (said.code, "not kept" in said.out) == (3, True)

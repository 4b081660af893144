"""The command `damperopt breakout`: rows by pressure and disturbance, the file, refused questions."""

import csv

import pytest

SHORT = ("--speeds", "1", "--duration", "0.1")


@pytest.fixture
def caster(call):
    assert call("init", "--gear", "caster", "caster.yaml").code == 0
    return call


def test_answers_by_pressure_and_disturbance(caster, tmp_path):
    asked = ("--kick", "1rad/s", "--release", "1deg", "--pressure", "40psi")
    done = caster("breakout", "caster.yaml", *asked, *SHORT, "-o", "found")
    assert done.code == 0
    assert "over 0.1 s at 2 m/s, 1300 N: no proof" in done.out
    with open(tmp_path / "found" / "breakout.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [(row["pressure"], row["disturbance"]) for row in rows] == [
        ("40psi", "kick of yaw rate 1rad/s"),
        ("40psi", "release of yaw 1deg"),
    ]
    for row in rows:
        torque = float(row["breakout [N m]"])
        pounds = torque / 0.11 / 4.4482216152605
        assert f"{row['pressure']}, {row['disturbance']}: {torque:.3g} N m, {pounds:.3g} lbf" in done.out
        assert torque > 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "found no disturbance"),
        (("--kick", "3Hz"), "write rad/s"),
        (("--kick", "0"), "nothing is disturbed"),
        (("--kick", "3rad/s", "--pressure", "5psi"), "0.161 of the rated pressure"),
    ],
)
def test_refused_questions_leave_nothing(caster, tmp_path, arguments, words):
    done = caster("breakout", "caster.yaml", *arguments)
    assert done.code == 2
    assert words in done.err
    assert {path.name for path in tmp_path.iterdir()} == {"caster.yaml"}


def test_refused_studies(caster, tmp_path):
    assert caster("init", "--gear", "tail", "tail.yaml").code == 0
    assert "found 'dahl'; allowed: friction" in caster("breakout", "tail.yaml", "--kick", "1").err
    text = (tmp_path / "caster.yaml").read_text()
    block = text[text.index("tyre:") : text.index("damper:")]
    numbers = "half_contact_length: 45 mm, relaxation_length: 0.11 m, cornering_stiffness: 12 kN/rad, friction: 0.8"
    brush = f"tyre: {{law: brush, {numbers}}}\n"
    (tmp_path / "brush.yaml").write_text(text.replace(block, brush))
    done = caster("breakout", "brush.yaml", "--kick", "1", "--pressure", "20psi")
    assert done.code == 2
    assert "the law 'brush' does not depend on it" in done.err

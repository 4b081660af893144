"""The commands on a study whose tyre remembers: what is proved, of what, and where it fails."""

import csv

import pytest
import typer
from memory_twin import O, S, gear, study_text

from damperopt.commands.analyse import analyse


@pytest.fixture
def said(capsys):
    """What a command prints, in one line."""
    return lambda: " ".join(capsys.readouterr().out.split())


def file_of(folder, numbers, **keys):
    path = folder / "gear.yaml"
    path.write_text(study_text(gear(numbers), **keys), encoding="utf-8")
    return path


def test_analyse_says_what_it_covers_before_it_says_what_is_proved(tmp_path, said):
    analyse(file_of(tmp_path, O | {"C_F": S["C_F"], "C_M": S["C_M"]}), output=tmp_path / "out", speeds="5:100:5")
    text = said()
    covers = text.index("the tyre on its contact line memory, with its exact delay")
    assert covers < text.index("Exact certificate, stable: proved over the whole envelope")
    assert "without memory of its contact line is doubtful" not in text
    with open(tmp_path / "out" / "modes.csv", encoding="utf-8") as file:
        modes = list(csv.DictReader(file))
    assert {row["mode"] for row in modes} >= {"torsional", "lateral", "string"}
    assert max(float(row["real_1_s"]) for row in modes) < 0


def test_analyse_shows_where_a_margin_is_missed(tmp_path, said):
    path = file_of(tmp_path, O)
    needed = "requirements: {stability_margin: 0.1, lug_distance: {min: 0.4, max: 1.1}, reach: {min: 0.1, max: 0.4}}"
    path.write_text(path.read_text() + needed, encoding="utf-8")
    analyse(path, output=tmp_path / "out")
    text = said()
    assert "Worst point: -0.052901 1/s at 8.67 m/s" in text
    assert "Exact certificate, margin 0.1 1/s: not met: missed at" in text
    assert "2 roots right of the line" in text


def test_unstable_with_memory_is_exit_code_3_if_stability_is_asked_for(tmp_path, said):
    with pytest.raises(typer.Exit) as ended:
        analyse(file_of(tmp_path, O | {"k_psi": 1.1e6}), require_stable=True, output=tmp_path / "out")
    assert ended.value.exit_code == 3
    text = said()
    assert "6.963" in text
    assert "22.35" in text


def test_an_approximation_is_said_to_be_one(tmp_path, said):
    analyse(file_of(tmp_path, O, contact="{kind: pade, order: 2}"), output=tmp_path / "out")
    text = said()
    assert "contact memory beyond 2 a w/V = 2" in text
    assert "3.14 the answer may not hold for the tyre" in text

"""Results of schema version 1 are read as what they were, and everything made of them says so."""

import json
from pathlib import Path

import numpy as np
import pytest

import damperopt
from damperopt.output import write_report
from damperopt.output.gallery import figures_of

FILE = Path(__file__).with_name("result_of_version_1.json")
"""As version 0.1 wrote it for the thesis' gear, with fewer starts and sensitivities."""

SAYS = "a result of schema version 1, read with damper.geometry planar, damper.compliance rigid, tyre.contact leading_point"


@pytest.fixture
def written():
    return json.loads(FILE.read_text())


@pytest.fixture
def study_file(configs, tmp_path):
    """A study of that version: it names neither compliance nor contact line."""
    lines = (configs / "thesis_gear.yaml").read_text().splitlines()
    kept = [line for line in lines if not line.strip().startswith(("compliance:", "contact:"))]
    (tmp_path / "old.yaml").write_text("\n".join(kept))
    return tmp_path / "old.yaml"


def test_is_read_with_its_numbers_and_becomes_one_of_version_two(written, tmp_path):
    result = damperopt.load_result(FILE)
    assert result.design == written["design"]
    assert result.mass.parts == written["mass"]["parts"]
    assert (result.schema_version, result.verdict) == (2, "proved")
    assert result.completed[0].startswith(SAYS)
    (tmp_path / "again.json").write_text(result.to_json())
    assert damperopt.load_result(tmp_path / "again.json") == result


def test_its_study_is_the_rigid_planar_one_on_the_leading_point(written):
    study = damperopt.Study.model_validate(damperopt.load_result(FILE).config)
    assert sorted(study.start) == sorted(written["design"])  # no sizes of elastic parts
    assert (study.damper.geometry, study.tyre.contact.contact) == ("planar", "leading_point")
    gear = damperopt.linear_gear(study, written["design"])
    at = written["stability"]
    assert np.linalg.eigvals(gear.matrices([at["speed"]], at["load"])[0]).real.max() == pytest.approx(at["abscissa"], rel=1e-9)
    torque = float(study.loads.limit_torque(study))
    assert torque == pytest.approx(written["limit_event"]["linkage_torque"], rel=1e-12)  # of the tyre, and of no rule
    assert study.required.ultimate_factor == 1


@pytest.mark.parametrize("key", ["tyre.contact", "damper.geometry", "requirements", "config"])
def test_what_it_lacks_is_filled_in(key, written):
    block, _, name = key.partition(".")
    if name:
        del written["config"][block][name]
    elif block == "config":
        written["config"] = {}
    else:
        written["config"]["requirements"] = None
    words = damperopt.DesignResult.model_validate(written).completed[0]
    assert words.startswith(SAYS) or not name


def test_a_design_that_was_refuted_comes_back_as_refuted(written):
    point = [20.0, 150e3]
    written["certificate"] |= {"proved": False, "counterexample": point}
    written["status"] = "failed"
    assert damperopt.DesignResult.model_validate(written).verdict == "refuted"
    written["certificate"]["counterexample"] = None
    assert damperopt.DesignResult.model_validate(written).verdict == "undecided"


def test_report_says_so_and_what_was_left_out_by_number(tmp_path):
    (tmp_path / "result.json").write_text(FILE.read_text())
    for figure in figures_of(damperopt.load_result(tmp_path)):
        (tmp_path / f"{figure.name}.svg").write_text("<svg/>")
    text = write_report(tmp_path).read_text()
    top = text[: text.index("What was asked")]
    assert SAYS in top
    assert "geometry planar: in space k_psi is" in top
    assert "the parts are taken as rigid (link, support, damper)" in top


def test_analyse_takes_what_the_study_does_not_name_from_the_design(study_file, tmp_path, call, written):
    done = call("analyse", study_file, "--design", FILE, "-o", tmp_path / "out")
    assert done.code == 0, done.err
    assert SAYS in done.out
    assert "taken from it: damper.compliance rigid, tyre.contact leading_point" in done.out
    assert f"Worst point: {written['stability']['abscissa']:.6f} 1/s at 5.00 m/s" in done.out
    assert "the parts are taken as rigid (link, support, damper)" in done.out


def test_what_the_study_names_stays(study_file, tmp_path, call):
    study_file.write_text(study_file.read_text().replace("geometry: planar", "geometry: planar\n  compliance: sized"))
    done = call("analyse", study_file, "--design", FILE, "-o", tmp_path / "out")
    assert done.code == 2
    assert "A_link" in done.err

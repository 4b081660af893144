"""A result that was changed after it was written: what `optimise` cannot have written is not shown as proved."""

import copy
import json
import math

import pytest

import damperopt
from damperopt.output import write_report
from damperopt.output.gallery import figures_of


@pytest.fixture(scope="module")
def written(request):
    study = damperopt.load(request.config.rootpath / "configs" / "thesis_gear.yaml")
    study = study.replace(damper__topology="boeing", solver__starts=1, requirements__decay=None)
    return json.loads(damperopt.optimise(study).to_json())


def changed(written, path, value):
    record = copy.deepcopy(written)
    *blocks, key = path.split(".")
    block = record
    for name in blocks:
        block = block[name]
    block[key] = value
    return record


UNREADABLE = {
    "mass": None,
    "mass.total": 1.0,
    "mass.parts.damper": -1.0,
    "stability.abscissa": math.nan,
    "verification.kkt_residual": math.inf,
    "design.L": math.nan,
    "design.gamma": -0.5,
    "derived.rod_diameter": 0.0,
    "certificate.proved": False,
    "certificate.margin": math.nan,
    "certificate": None,
    "verification.passed": False,
    "status": "infeasible",
    "schema_version": 3,
    "verdict": "refuted",
    "certificate.counterexample": [20.0, 150e3],
}


@pytest.mark.parametrize(("path", "value"), UNREADABLE.items(), ids=UNREADABLE)
def test_what_cannot_have_been_written_is_not_read(written, path, value, tmp_path):
    (tmp_path / "result.json").write_text(json.dumps(changed(written, path, value)))
    with pytest.raises(damperopt.ConfigError, match=r"result\.json:1: .*allowed: a result\.json of 'optimise'"):
        write_report(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["result.json"]


CONTRADICTING = {
    "topology": "trapeze",
    "geometry": "spatial",
    "material": "cheese",
    "study": "another",
    "stability_margin": 0.05,
    "design": {"L": 1.0},
    "certificate.speed": [1.0, 200.0],
    "certificate.loads": [1.0],
    "config.damper.topology": "utas",
}


@pytest.mark.parametrize(("path", "value"), CONTRADICTING.items(), ids=CONTRADICTING)
def test_what_contradicts_its_own_study_makes_no_page(written, path, value, tmp_path):
    (tmp_path / "result.json").write_text(json.dumps(changed(written, path, value)))
    with pytest.raises(damperopt.ConfigError, match=r"allowed: "):
        write_report(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["result.json"]


def test_names_stay_names_on_the_page(written, tmp_path):
    name = "<script>alert(1)</script> {{ 7 * 7 }}"
    record = changed(changed(written, "study", name), "config.name", name)
    (tmp_path / "result.json").write_text(json.dumps(record))
    for figure in figures_of(damperopt.load_result(tmp_path)):
        (tmp_path / f"{figure.name}.svg").write_text("<svg/>")  # what is there is not drawn again
    text = write_report(tmp_path).read_text()
    assert "<script" not in text
    assert "{{ 7 * 7 }}" in text


def test_empty_keys_of_other_layouts_are_no_contradiction(written, tmp_path):
    """As the first version wrote them."""
    record = changed(written, "config.damper.torsional_stiffness", None)
    (tmp_path / "result.json").write_text(json.dumps(record))
    for figure in figures_of(damperopt.load_result(tmp_path)):
        (tmp_path / f"{figure.name}.svg").write_text("<svg/>")
    assert "boeing layout" in write_report(tmp_path).read_text()


def test_result_as_it_was_written_is_read(written, tmp_path):
    (tmp_path / "result.json").write_text(json.dumps(written))
    assert damperopt.load_result(tmp_path).status == "solved"

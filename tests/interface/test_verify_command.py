"""`damperopt verify`: a run is checked from its files, and one altered digit is enough to refuse it."""

import json
import re
import shutil

import pytest
from typer.testing import CliRunner

from damperopt.answers.sums import write_sums
from damperopt.cli import app
from damperopt.errors import ConfigError
from damperopt.proof.again import check_again
from damperopt.results import load_result
from damperopt.study import config


@pytest.fixture(scope="module")
def run(tmp_path_factory, request):
    """Of the thesis' gear with boeing's layout, without decay."""
    folder = tmp_path_factory.mktemp("verify")
    text = (request.config.rootpath / "configs/thesis_gear.yaml").read_text()
    text = re.sub(r"  decay:.*?\n  limit_factor", "  limit_factor", text, flags=re.DOTALL)
    text = text.replace("topology: arreaza", "topology: boeing") + "\nsolver: {starts: 1, bound_seconds: 1.0}\n"
    (folder / "study.yaml").write_text(text)
    arguments = ["optimise", str(folder / "study.yaml"), "-o", str(folder / "run"), "--no-figures"]
    assert CliRunner().invoke(app, arguments).exit_code == 0
    return folder / "run"


def verified(folder):
    done = CliRunner().invoke(app, ["verify", str(folder)])
    return done.exit_code, done.output


@pytest.mark.bound
def test_a_run_holds_and_an_altered_digit_does_not(run, tmp_path):
    code, words = verified(run)
    assert code == 0, words
    assert "lower bound: holds: 10.9" in words
    for name in ("result.json", "bound.json", "config.yaml"):
        copy = tmp_path / name
        shutil.copytree(run, copy)
        text = (copy / name).read_text()
        place = next(re.finditer(r"\d\.\d+", text)).start()
        (copy / name).write_text(text[:place] + str((int(text[place]) + 1) % 10) + text[place + 1 :])
        code, words = verified(copy)
        assert code == 4
        assert f"{name} is not what was written" in words


def test_a_file_is_no_run(run):
    with pytest.raises(ConfigError, match="is a file; allowed: the folder"):
        CliRunner().invoke(app, ["verify", str(run / "result.json")], catch_exceptions=False)


@pytest.mark.bound
def test_new_sums_do_not_save_a_claim_that_is_false(run, tmp_path):
    study = config.load(run / "config.yaml")
    tree = json.loads((run / "bound.json").read_text())

    def fails(**changes):
        result = load_result(run).model_copy(update=changes)
        return {finding.claim for finding in check_again(study, result, tree) if not finding.holds}

    honest = load_result(run)
    lighter = honest.mass.model_copy(update={"total": honest.mass.total * (1 - 1e-6)})
    assert fails() == set()
    assert "mass and requirements" in fails(mass=lighter)
    lighter_damper = {**honest.mass.parts, "damper": 0.9 * honest.mass.parts["damper"]}
    assert fails(mass=honest.mass.model_copy(update={"parts": lighter_damper})) == {"mass and requirements"}
    assert fails(design={**honest.design, "c_lambda": honest.design["c_lambda"] * 0.99}) >= {"stability"}
    tighter = {**honest.bound.__dict__, "mass": honest.bound.mass * (1 + 1e-6)}
    assert fails(bound=type(honest.bound)(**tighter)) == {"lower bound"}
    shutil.copytree(run, tmp_path / "run")
    (tmp_path / "run/bound.json").unlink()
    write_sums(tmp_path / "run")
    code, words = verified(tmp_path / "run")
    assert code == 4
    assert "certificate is missing" in words

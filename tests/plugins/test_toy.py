"""Components of another distribution, installed by pip, go through every command without an edit in this package."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from beside import ROOT, TOY, environment

HERE = Path(__file__).parent
TAGS = {"saturating", "root", "two_lags", "steering_collar", "a_frame", "gas", "quintic", "slipped_jack"}
AXES = {
    "gas": "--x w=0.1:1 --y k_gas=0:1e6",
    "quintic": "--x c_lambda=100:1e5 --y A_leg=1e-6:1e-3",
    "collar": "--x c_lambda=0:1e5 --y k_lambda=0:1e7",
}
DECLARED = {
    "gas": {"carcass_deflection", "tread_deflection", "leaked_stroke", "gas_force"},
    "quintic": {"link_angle", "damper_speed"},
    "collar": {"collar_angle", "collar_rate", "steering_torque"},
}


def study(name):
    return str(HERE / "studies" / f"{name}.yaml")


def test_known_to_messages_schema_and_list(toy, commands, tmp_path):
    text = Path(study("gas")).read_text()
    for key, tag in (("law", "saturating"), ("topology", "a_frame"), ("kind", "gas"), ("kind", "yaw")):
        (tmp_path / f"{tag}.yaml").write_text(text.replace(f"{key}: {tag}", f"{key}: nonsense"))
    (tmp_path / "line.yaml").write_text(text.replace("kind: two_lags, tread_length: 0.05 m", "kind: nonsense"))
    wrong = {"saturating": "root", "a_frame": "a_frame", "gas": "quintic", "yaw": "steering_collar", "line": "two_lags"}
    lines = ["schema", "components --json", f"validate {study('gas')} {study('quintic')} {study('collar')}"]
    schema, listed, valid, *refused = commands(toy, *lines, *(f"validate {name}.yaml" for name in wrong))
    assert all(f'"{tag}"' in schema["out"] for tag in TAGS)
    assert {tag for room in json.loads(listed["out"]).values() for tag in room} >= TAGS
    assert (valid["code"], valid["out"].count(": valid (")) == (0, 3), valid
    for answer, tag in zip(refused, wrong.values(), strict=True):
        assert answer["code"] == 2, answer
        assert "nonsense" in answer["err"]
        assert tag in answer["err"]


@pytest.mark.slow
@pytest.mark.parametrize("name", AXES)
def test_goes_through_every_command(toy, commands, tmp_path, name):
    file, motion = study(name), "--speed 40 --release yaw=0.1deg --duration 0.1"
    answers = commands(
        toy,
        f"analyse {file} -o analysis",
        f"chart {file} {AXES[name]} -o chart",
        f"simulate {file} {motion} --engine cvodes -o smooth",
        f"simulate {file} {motion} --engine exact -o exact",
        f"optimise {file} -o design",
        "report design",
    )
    assert [answer["code"] for answer in answers] == [0] * 6, answers
    assert not any("not drawn" in answer["err"] for answer in answers), answers
    result = json.loads((tmp_path / "design" / "result.json").read_text())
    assert result["status"] == "solved"
    assert result["certificate"]["proved"]
    assert set(result["design"]) | set(result["derived"]) <= set(result["units"])
    for kind in ("smooth", "exact"):
        header = (tmp_path / kind / "trajectory.csv").read_text().partition("\n")[0]
        assert {column.partition(" [")[0] for column in header.split(",")} >= DECLARED[name]
    peaks = [json.loads((tmp_path / kind / "motion.json").read_text()) for kind in ("smooth", "exact")]
    assert peaks[0]["peaks"]["damper_force"] == pytest.approx(peaks[1]["peaks"]["damper_force"], rel=1e-2)
    page = (tmp_path / "design" / "report.html").read_text()
    assert all(name in page for name in result["design"])


@pytest.mark.slow
def test_no_polynomial_in_the_load_is_proved_over_a_range_in_slices(toy, commands, tmp_path):
    text = Path(study("quintic")).read_text()
    (tmp_path / "range.yaml").write_text(text.replace("[30 kN, 40 kN]", "{min: 30 kN, max: 40 kN}"))
    over_range, listed = commands(toy, "analyse range.yaml -o range", f"analyse {study('quintic')} -o list")
    assert over_range["code"] == listed["code"] == 0, (over_range, listed)
    for done in (over_range, listed):
        assert "stable: proved over the whole envelope" in done["out"], done["out"]


@pytest.mark.slow
def test_its_own_literature_test_and_the_standard_tests_run_for_it(toy):
    """The pages say so: what is installed is tested like what is here."""
    run = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--no-header"]
    own = subprocess.run([*run, TOY / "literature"], capture_output=True, text=True, env=environment(toy), cwd=TOY)
    assert own.returncode == 0, own.stdout
    assert "1 passed" in own.stdout
    words = "(saturating or root or two_lags) and not commands and not optimised"
    standard = subprocess.run(
        [*run, "tests/components", "-k", words], capture_output=True, text=True, env=environment(toy), cwd=ROOT
    )
    assert standard.returncode == 0, standard.stdout
    assert "passed" in standard.stdout

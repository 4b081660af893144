"""The command line as a user meets it: exit codes, files, messages; in this process but where processes count."""

import csv
import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import jsonschema
import pytest
import yaml

import damperopt
from damperopt.commands.studies import KINDS, STARTERS
from damperopt.gears.yaw_bending import YawBending
from damperopt.study.components import rooms
from damperopt.study.mass_model import MassModel
from damperopt.study.requirements import Requirements
from damperopt.study.solver import Solver

pytestmark = pytest.mark.slow

FILES = {
    "SHA256SUMS",
    "bound.json",
    "chart.png",
    "chart.svg",
    "config.yaml",
    "linkage.png",
    "linkage.svg",
    "mass.png",
    "mass.svg",
    "modes.csv",
    "modes.png",
    "modes.svg",
    "region.png",
    "region.svg",
    "report.html",
    "result.json",
    "tornado.png",
    "tornado.svg",
}


def run(*arguments, cwd):
    command = [sys.executable, "-W", "error", "-c", "from damperopt.cli import main; main()", *map(str, arguments)]
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=300)


def test_optimise_writes_a_complete_run_folder(configs, tmp_path):
    done = run("optimise", configs / "minimal.yaml", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    (folder,) = (tmp_path / "runs").iterdir()
    assert {f.name for f in folder.iterdir()} == FILES
    assert (folder / "config.yaml").read_bytes() == (configs / "minimal.yaml").read_bytes()
    result = json.loads((folder / "result.json").read_text())
    assert (result["schema_version"], result["verdict"]) == (2, "proved")
    assert result["status"] == "solved"
    assert result["mass"]["total"] == pytest.approx(sum(result["mass"]["parts"].values()))
    sizes = {"A_link", "I_hinge", "A_piston", "rod_diameter", "s_damper"}  # of the elastic parts
    assert set(result["design"]) == {"c_lambda", "k_lambda", "L", "gamma", *sizes}
    assert result["certificate"]["proved"]
    assert result["verification"]["passed"]
    assert len(result["starts"]) == 16
    assert len(result["provenance"]["config_sha256"]) == 64
    assert f"{result['mass']['total']:.3f} kg" in done.stdout
    assert damperopt.load_result(folder).design == result["design"]


def test_several_combinations_are_ranked_in_one_table(configs, tmp_path, call):
    text = (
        configs / "minimal.yaml"
    ).read_text() + "  I_arm: {start: 1e-6, min: 1e-8, max: 1e-4}\n  b: {start: 0.2, min: 0.02, max: 0.6}\n"
    (tmp_path / "study.yaml").write_text(text + "solver: {starts: 4}\n")
    done = call(
        "optimise",
        "study.yaml",
        "--topology",
        "all",
        "--material",
        "Ti-6Al-4V,CFRP UD",
        "--no-figures",
        "-o",
        "out",
    )
    assert done.code == 0, done.err
    best = damperopt.load_result(tmp_path / "out")  # as analyse --design reads it
    assert best == damperopt.load_result(next((tmp_path / "out").glob("01-*")))
    with open(tmp_path / "out" / "ranking.csv") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 6
    masses = [float(row["mass_kg"]) for row in rows]
    assert masses == sorted(masses)
    assert {(row["topology"], row["material"]) for row in rows} == {
        (t, m) for t in ("boeing", "utas", "arreaza") for m in ("Ti-6Al-4V", "CFRP UD")
    }
    assert all(abs(float(row["abscissa_1_s"]) + 1) < 1e-4 or float(row["abscissa_1_s"]) < -1 for row in rows)


def test_analyse_gives_modes_and_critical_speeds_of_literature(configs, tmp_path):
    done = run("analyse", configs / "nose_gear_thota.yaml", "--speeds", "5:100:5", "-o", "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "5.6118 m/s" in done.stdout
    assert "93.4029 m/s" in done.stdout
    with open(tmp_path / "out" / "modes.csv") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["speed_m_s", "vertical_load_N", "mode", "real_1_s", "imag_rad_s", "frequency_Hz", "damping_ratio"]
    assert len(rows) == 20 * 2 * 3  # speeds, loads, modes
    at_40 = {r["mode"]: r for r in rows if r["speed_m_s"] == "40" and r["vertical_load_N"] == "150000"}
    # Thota et al. (2009) data: 1.320 +- 70.87i and -0.203 +- 100.81i
    assert float(at_40["torsional"]["real_1_s"]) == pytest.approx(1.320, abs=5e-4)
    assert float(at_40["torsional"]["imag_rad_s"]) == pytest.approx(70.87, abs=6e-3)
    assert float(at_40["lateral"]["real_1_s"]) == pytest.approx(-0.203, abs=5e-4)
    assert float(at_40["lateral"]["imag_rad_s"]) == pytest.approx(100.81, abs=6e-3)


def test_analyse_takes_a_design_from_a_result(configs, tmp_path, call):
    assert call("optimise", configs / "minimal.yaml", "--no-figures", "-o", "best").code == 0
    done = call("analyse", configs / "minimal.yaml", "--design", "best", "-o", "out")
    assert done.code == 0, done.err
    assert "Exact certificate, margin 1 1/s: proved" in done.out


def test_infeasible_says_what_is_missing_and_what_would_help(configs, tmp_path, call):
    text = (configs / "minimal.yaml").read_text().replace("max: 1 m}", "max: 0.6 m}")
    (tmp_path / "tight.yaml").write_text(text)
    done = call("optimise", "tight.yaml", "-o", "out")
    assert done.code == 3, done.err
    # the wheel reaches 0.35 m and 50 mm above it are asked for, the lugs allow 0.3 m
    assert "tyre_clearance can reach -0.05 m, required 0.05" in done.out
    assert "lug_distance_max of 0.8 m instead of 0.6" in done.out
    assert {f.name for f in (tmp_path / "out").iterdir()} == {"result.json", "config.yaml", "report.html", "SHA256SUMS"}


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("optimise", "absent.yaml"), "absent.yaml: cannot be read"),
        (("optimise", "{nose}"), "'rotational' has no design variables"),
        (("optimise", "{minimal}", "--topology", "utas"), "design.I_arm"),
        (("optimise", "{minimal}", "--topology", "delorean"), "--topology: 'delorean' is unknown"),
        (("optimise", "{minimal}", "--material", "cheese"), "--material: 'cheese' is unknown"),
        (("optimise", "{minimal}", "-o", "full"), "exists already"),
        (("optimise", "{minimal}", "-o", "/proc/none/out"), "cannot be written"),
        (("analyse", "{nose}", "--speeds", "5-100"), "--speeds: found '5-100'"),
        (("analyse", "{nose}", "--speeds", "5:100:0"), "--speeds: found '5:100:0'"),
        (("analyse", "{nose}", "--design", "broken.json"), "broken.json"),
        (("validate", "broken.json"), "broken.json:1"),
        (("init", "broken.json"), "exists already"),
    ],
)
def test_bad_calls_end_with_code_2_and_one_message(arguments, says, configs, tmp_path, call):
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "file").touch()
    (tmp_path / "broken.json").write_text("{}")
    places = {"{nose}": configs / "nose_gear_somieski.yaml", "{minimal}": configs / "minimal.yaml"}
    done = call(*(places.get(a, a) for a in arguments))
    assert done.code == 2, done.err
    assert says in done.err.replace("\n", " ")
    assert {p.name for p in tmp_path.iterdir()} == {"full", "broken.json"}  # nothing half written


def test_interrupt_leaves_nothing_half_written(configs, tmp_path):
    text = (configs / "minimal.yaml").read_text() + "solver: {starts: 2000}\n"
    (tmp_path / "long.yaml").write_text(text)
    often = "from damperopt.commands import shared; shared.SECONDS_A_LINE = 0.2"
    command = [sys.executable, "-c", f"{often}; from damperopt.cli import main; main()", "optimise", "long.yaml"]
    process = subprocess.Popen(
        command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    assert any(re.search(r": [1-9]\d* of 2000", line) for line in process.stderr)  # the workers are at work
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does: to the workers too
    _, error = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "interrupted" in error
    assert "Traceback" not in error
    assert {p.name for p in tmp_path.iterdir()} <= {"long.yaml", "runs"}
    assert not list(tmp_path.glob("runs/*"))


def test_init_writes_a_study_that_is_valid_and_solves(tmp_path, call):
    assert call("init", "my.yaml").code == 0
    assert call("validate", "my.yaml").code == 0
    result = damperopt.optimise(damperopt.load(tmp_path / "my.yaml"))
    assert result.status == "solved"


@pytest.mark.parametrize("gear", STARTERS)
def test_ready_made_gears_are_written_and_valid(gear, tmp_path, call):
    """Under the name of the file, with the schema's line first; the commands that they tell are commands of theirs."""
    place = tmp_path / f"my {gear}.yaml"
    written = call("init", "--gear", gear, place.name)
    assert written.code == 0
    assert f"next: damperopt {'analyse' if gear in ('caster', 'tail') else 'optimise'} my {gear}.yaml" in written.out
    assert call("validate", place.name).code == 0
    text = place.read_text()
    assert text.startswith("# yaml-language-server")
    assert f"'my {gear}.yaml'" in text
    assert "configs/" not in text.replace("configs/tyres", "")


def test_kinds_of_gear_name_their_starter(tmp_path, call):
    for kind, gear in KINDS.items():
        assert call("init", "--gear", kind, f"{kind}.yaml").code == 0
        assert call("init", "--gear", gear, f"{kind}_{gear}.yaml").code == 0
        one, other = ((tmp_path / f"{name}.yaml").read_text() for name in (kind, f"{kind}_{gear}"))
        assert one.replace(f"{kind}.yaml", "") == other.replace(f"{kind}_{gear}.yaml", "")
    assert rooms()["gears"].keys() <= {*KINDS, *STARTERS}
    wrong = call("init", "--gear", "skid", "skid.yaml")
    assert wrong.code == 2
    assert "found 'skid'" in wrong.err
    assert all(name in wrong.err for name in (*STARTERS, *KINDS))
    assert not (tmp_path / "skid.yaml").exists()


def test_schema_accepts_every_shipped_study_and_refuses_unknown_keys(configs, tmp_path, call):
    schema = json.loads(call("schema").out)
    starter = Path(damperopt.__file__).with_name("starter.yaml")
    for file in [*configs.glob("*.yaml"), starter]:
        jsonschema.validate(yaml.safe_load(file.read_text()), schema)
    wrong = yaml.safe_load(starter.read_text()) | {"colour": "red"}
    with pytest.raises(jsonschema.ValidationError, match="colour"):
        jsonschema.validate(wrong, schema)


def test_starter_shows_every_key_with_its_default():
    starter = Path(damperopt.__file__).with_name("starter.yaml").read_text()
    for record in (MassModel, Solver, Requirements, YawBending):
        for key in record.model_fields:
            assert f"{key}:" in starter, key


def test_every_config_is_valid(configs):
    files = sorted(configs.glob("*.yaml"))
    assert len(files) >= 5
    for file in files:
        damperopt.load(file)


def test_version(tmp_path):
    assert run("--version", cwd=tmp_path).stdout.startswith("damperopt 0.")

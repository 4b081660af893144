"""Sizes that exist through the commands: run folder, console, report, a design that comes back, and an interrupt."""

import json
import subprocess
import sys

import pytest

import damperopt
from damperopt.output import write_report

FEW = {
    "catalogue_dampers.csv": (
        "name, c [N s/m], stroke [mm], length [mm], force [kN], mass [kg], series_stiffness [MN/m]\n"
        "invented <weak>, 25000, 9, 185, 2, 1.0, 36\ninvented 20-9, 25000, 9, 185, 20, 4.0, 36\n"
    )
}


@pytest.fixture
def study(configs, tmp_path):
    """The shipped study with fewer sizes, beside its catalogue."""
    text = (configs / "catalogue_main_gear.yaml").read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if not line.startswith(("  tube_diameters", "  walls", "  bores"))]
    lines.insert(lines.index("  law: brush"), "  contact: leading_point")
    at = lines.index("available:")
    lines[at + 1 : at + 1] = ["  tube_diameters: [36 mm, 45 mm]", "  walls: [1.6 mm, 2.5 mm]"]
    folder = tmp_path / "beside"
    folder.mkdir()
    for name, rows in FEW.items():
        (folder / name).write_text(rows, encoding="utf-8")
    (folder / "gear.yaml").write_text("\n".join([*lines, "solver: {starts: 1}", ""]), encoding="utf-8")
    return folder / "gear.yaml"


def test_run_folder_goes_through_the_other_commands(study, tmp_path, call):
    done = call("optimise", study, "--output", "run", "--no-figures")
    assert done.code == 0, done.err
    assert "torque links 36 x 2.5 mm, damper invented 20-9" in done.out
    assert "beside the optimum of any size" in done.out
    run = tmp_path / "run"
    assert (run / "catalogue_dampers.csv").read_text() == FEW["catalogue_dampers.csv"]
    result = damperopt.load_result(run)
    assert result.certificate.proved
    assert result.stock.chosen == {"torque links": "36 x 2.5 mm", "damper": "invented 20-9"}
    assert "c_lambda" not in result.design
    again = call("analyse", run / "config.yaml", "--design", run / "result.json", "--output", "analysis")
    assert again.code == 0, again.err + again.out
    assert f"{result.stability.abscissa:.5f}" in again.out
    page = write_report(run).read_text(encoding="utf-8")
    assert "Sizes that exist" in page
    assert "invented &lt;weak&gt;" in page
    assert "largest_force can reach" in page


def test_nothing_that_exists_fits(study, call):
    rows = FEW["catalogue_dampers.csv"].splitlines()[:2]
    (study.parent / "catalogue_dampers.csv").write_text("\n".join(rows), encoding="utf-8")
    done = call("optimise", study, "--output", "run")
    assert done.code == 3
    assert "no design of sizes that exist was found" in done.out
    assert "largest_force" in done.out


def test_interrupt_keeps_the_optimum_of_any_size(study, tmp_path):
    program = (
        "import os, signal, time; from damperopt.optimum.stock import StockSearch\n"
        "StockSearch.run = lambda *given: (os.kill(os.getpid(), signal.SIGINT), time.sleep(30))\n"
        "from damperopt.cli import main; main()"
    )
    command = [sys.executable, "-W", "error", "-c", program, "optimise", study, "--output", "run", "--no-figures"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=200)
    assert done.returncode == 130, done.stderr
    assert "sizes that exist were not searched to the end" in done.stderr
    result = json.loads((tmp_path / "run" / "result.json").read_text())
    assert result["status"] == "solved"
    assert result["stock"]["finished"] is False
    assert result["mass"]["total"] == result["stock"]["continuous_mass"]


def test_a_number_beside_the_stiffness_of_the_row_is_refused(configs):
    row = damperopt.load(configs / "catalogue_main_gear.yaml").catalogue[0].model_dump()
    block = {"topology": "boeing", "kind": "bought", "row": row, "compliance": {"damper": 3e7}}
    with pytest.raises(
        damperopt.ConfigError, match=r"damper.*compliance.damper: 3e\+07 N/m beside series_stiffness of the row"
    ):
        damperopt.load(configs / "catalogue_main_gear.yaml").replace(damper=block)

"""Stock sizes and catalogues: enumerations against brute force, and one message for each bad row."""

import itertools
import math
from pathlib import Path

import pytest

import damperopt
from damperopt.strength.stock import Tube, tubes
from damperopt.study.stock import read_catalogue

HEADER = "name, c [N s/m], stroke [mm], length [mm], force [kN], mass [kg], series_stiffness [MN/m]"
ROW = "one, 4000, 4, 150, 8, 1.9, 20"


def test_tube_by_hand():
    """40 mm with a wall of 4 mm: A = pi 36 4 = 452.3893 mm^2, I = pi (40^4 - 32^4)/64 = 74191.85 mm^4."""
    tube = Tube(0.040, 0.004)
    assert tube.area == pytest.approx(452.3893e-6, rel=1e-6)
    assert tube.inertia == pytest.approx(74191.85e-12, rel=1e-6)
    assert tube.section.thickness_ratio == pytest.approx(0.1)


def test_tubes_are_all_that_have_a_bore_and_the_lightest_is_first():
    diameters, walls = [0.05, 0.02, 0.03], [0.004, 0.001, 0.012]
    found = tubes(diameters, walls)
    assert set(found) == {Tube(d, t) for d, t in itertools.product(diameters, walls) if 2 * t < d}
    assert [tube.area for tube in found] == sorted(tube.area for tube in found)
    assert Tube(0.02, 0.012) not in found


@pytest.fixture
def catalogue(tmp_path):
    def written(*lines):
        file = tmp_path / "dampers.csv"
        file.write_text("\n".join(lines) + "\n")
        return file

    return written


def test_rows_are_read_in_the_units_of_the_header(catalogue):
    (row,) = read_catalogue(catalogue("# a remark", "", HEADER, ROW))
    assert (row.c, row.stroke, row.length) == (4000.0, 0.004, 0.15)
    assert (row.force, row.mass, row.series_stiffness) == (8e3, 1.9, 20e6)
    other_units = "mass [lb], name, c [lbf s/in], stroke [in], length [in], force [lbf], series_stiffness [lbf/in]"
    (other,) = read_catalogue(catalogue(other_units, '4, "a, b", 10, 0.25, 6, 2000, 1e5'))
    assert other.name == "a, b"
    assert other.mass == pytest.approx(4 * 0.45359237)
    assert other.c == pytest.approx(10 * 4.4482216152605 / 0.0254)


@pytest.mark.parametrize(
    ("lines", "says"),
    [
        ([], ":1: no header; allowed: the header name, c [N s/m], stroke [m]"),
        ([HEADER], ":1: no dampers"),
        ([HEADER.replace("force [kN]", "power [kW]"), ROW], ":1: 'power [kW]' is no column"),
        ([HEADER.replace("force [kN]", "c [N s/m]"), ROW], ":1: 'c [N s/m]' stands twice"),
        ([HEADER.replace(", mass [kg]", ""), ROW], ":1: mass: missing column"),
        ([HEADER.replace("force [kN]", "force"), ROW], ":1: force: no unit; allowed: force [N]"),
        ([HEADER.replace("name", "name [kg]"), ROW], ":1: name: a unit"),
        ([HEADER, ROW, "two, 4000, 4"], ":3: 3 cells; allowed: 7"),
        ([HEADER, "one, 4000, 4, 150, much, 1.9, 20"], ":2: force: 'much' is no number"),
        ([HEADER, "one, 4000, 4, 150, 8 kN, 1.9, 20"], ":2: force: '8 kN' is no number; allowed: a number, in kN"),
        ([HEADER, "one, 4000, 4, 150, -8, 1.9, 20"], ":2: force: -8 kN (= -8000 N) is out of range"),
        ([HEADER.replace("[kN]", "[kg]"), ROW], ":2: force: '8 kg' has the unit 'kg'"),
        ([HEADER, ROW, "# between", ROW], ":4: name: 'one' stands on line 2 too"),
        ([HEADER, ", 4000, 4, 150, 8, 1.9, 20"], ":2: name: "),
    ],
)
def test_what_is_wrong_is_said_with_its_line(catalogue, lines, says):
    with pytest.raises(damperopt.ConfigError) as error:
        read_catalogue(catalogue(*lines))
    (problem,) = error.value.problems
    assert "dampers.csv" + says in problem


def test_every_bad_row_is_named(catalogue):
    with pytest.raises(damperopt.ConfigError) as error:
        read_catalogue(catalogue(HEADER, "one, x, y, 150, 8, 1.9, 20", "two, 1, 1, 1, 0, 1, 1"))
    assert [problem.split("dampers.csv:")[1][:10] for problem in error.value.problems] == [
        "2: c: 'x' ",
        "2: stroke:",
        "3: force: ",
    ]


def test_the_shipped_study_has_its_catalogue_beside_it(configs, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # the path is seen from the folder of the study
    study = damperopt.load(configs / "catalogue_main_gear.yaml")
    assert len(study.catalogue) == 6
    assert math.isclose(min(study.available.tube_diameters), 0.025)
    assert damperopt.Study.model_validate_json(study.model_dump_json(exclude_none=True)) == study


@pytest.mark.parametrize(
    ("block", "where", "says"),
    [
        ("catalogue: nowhere.csv", "catalogue", "nowhere.csv: cannot be read"),
        ("catalogue: []", "catalogue", "no dampers"),
        ("catalogue: 3", "catalogue", "found 3"),
        ("available: {walls: [2 mm]}", "available.walls", "without tube_diameters"),
        ("available: {walls: [20 mm], tube_diameters: [30 mm]}", "available.walls", "no wall leaves a bore"),
        ("available: {}", "available", "no sizes"),
        ("available: {bores: [3 mm, 0.003 m]}", "available.bores.1", "0.003 m twice"),
        ("available: {bores: 3 mm}", "available.bores", "instead of a list"),
        ("available: {pipes: [3 mm]}", "available.pipes", "unknown key"),
    ],
)
def test_bad_lists_are_said_once(configs, block, where, says):
    text = Path(configs / "minimal.yaml").read_text()
    with pytest.raises(damperopt.ConfigError) as error:
        damperopt.loads(f"{text}\n{block}\n")
    (problem,) = error.value.problems
    assert f": {where}: " in problem
    assert says in problem

"""The command `damperopt tyre`: of a study, a property file, a size; tables, figures, block of a study, refused calls."""

import csv
import sys
from types import SimpleNamespace

import numpy as np
import pytest
import yaml

import damperopt
from damperopt import cli
from damperopt.tyres.curves import tyre_curves

SIZE = ("--size", "49x17", "--type", "VII", "--rated-pressure", "170psi")
FILES = {"tyre.csv", "tyre-slip.csv", "tyre-response.csv"}
FILES |= {f"{name}.{kind}" for name in ("slip", "load", "response") for kind in ("png", "svg")}
TIR = """[MODEL]
FITTYP = 5
[DIMENSION]
UNLOADED_RADIUS = 0.6
[VERTICAL]
FNOMIN = 1e5
[LATERAL_COEFFICIENTS]
PCY1 = 1.4
PDY1 = 0.8
PKY1 = -12
PKY2 = 2.2
PTY1 = 1.3
PTY2 = 2.1
[ALIGNING_COEFFICIENTS]
QBZ1 = 7
QCZ1 = 1.2
QDZ1 = 0.09
"""


@pytest.fixture
def call(monkeypatch, capsys, tmp_path):
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        monkeypatch.setattr(sys, "argv", ["damperopt", "tyre", *map(str, arguments)])
        with pytest.raises(SystemExit) as end:
            cli.main()
        said = capsys.readouterr()
        return SimpleNamespace(code=end.value.code or 0, out=said.out, err=said.err)

    return run


def columns(file):
    with open(file, encoding="utf-8") as text:
        header, *rows = csv.reader(text)
    return {name: [row[i] for row in rows] for i, name in enumerate(header)}


def test_size_gives_table_and_figures_and_says_that_it_is_an_estimate(call, tmp_path):
    done = call(*SIZE, "--pressure", "160psi", "-o", "out")
    assert done.code == 0, done.err
    assert {file.name for file in (tmp_path / "out").iterdir()} == FILES
    for words in ("estimate", "about 20 %", "half contact length", "relaxation length", "pneumatic trail", "kN/rad", "unit"):
        assert words in done.out
    table = columns(tmp_path / "out" / "tyre.csv")
    assert len(table["load [N]"]) == 25
    assert "within 10 %" in done.out
    response = columns(tmp_path / "out" / "tyre-response.csv")
    assert {"memory", "leading_point", "von_schlippe", "pade, order 2"} < set(response["contact line"])
    slip = columns(tmp_path / "out" / "tyre-slip.csv")
    assert max(map(float, slip["aligning_moment [N m]"])) > 0


def test_table_of_the_size_is_that_of_the_law(call, tmp_path):
    call(*SIZE, "--loads", "20000lbf:39600lbf", "-o", "out")
    table = columns(tmp_path / "out" / "tyre.csv")
    first, last = ([float(values[i]) for values in table.values()] for i in (0, -1))
    names = [name.split(" ")[0] for name in table]
    # the rows of a published size that tests of the law have too
    for row, expected in ((first, (0.2049, 0.3708, 5.9970e5)), (last, (0.2708, 0.5402, 7.3298e5))):
        found = dict(zip(names, row, strict=True))
        assert (
            found["half_contact_length"],
            found["relaxation_length"],
            found["cornering_stiffness"],
        ) == pytest.approx(expected, rel=6e-4)
        assert found["aligning_stiffness"] == pytest.approx(found["pneumatic_trail"] * found["cornering_stiffness"], rel=1e-6)
        c_c = found["cornering_stiffness"] / (2 * (found["half_contact_length"] + found["relaxation_length"]) ** 2)
        assert found["carcass_stiffness"] == pytest.approx(c_c, rel=1e-6)


@pytest.mark.parametrize("arguments", [SIZE, (*SIZE, "--pressure", "150psi", "--relaxation-length", "0.4m")])
def test_block_is_taken_by_a_study(call, configs, arguments):
    block = yaml.safe_load(call(*arguments, "--yaml").out)["tyre"]
    data = yaml.safe_load((configs / "nose_gear_thota.yaml").read_text()) | {"tyre": block}
    data["envelope"]["vertical_load"] = "150 kN"
    tyre = damperopt.loads(yaml.safe_dump(data)).tyre
    assert tyre.law == "tr_r64"
    assert (tyre.relaxation_length == 0.4) == ("0.4m" in arguments)


def test_property_file_says_what_was_used(call, tmp_path):
    (tmp_path / "main.tir").write_text(TIR)
    done = call("main.tir", "-o", "out")
    assert done.code == 0, done.err
    assert "used: FNOMIN" in done.out
    assert "taken as 0: PDY2" in done.out
    assert "no [UNITS]: taken as SI" in done.out
    assert not (tmp_path / "out" / "response.png").exists()
    table = columns(tmp_path / "out" / "tyre.csv")
    assert set(table["half_contact_length [m]"]) == set(table["carcass_stiffness [N/m^2]"]) == {""}
    assert all(table["aligning_stiffness [N m/rad]"])
    assert "to be added" in call("main.tir", "--yaml").out


def test_block_of_a_property_file_is_the_tyre_of_a_study_with_that_file(call, tmp_path, configs):
    (tmp_path / "main.tir").write_text(TIR)
    block = yaml.safe_load(call("main.tir", "--half-contact-length", "0.2 m", "--yaml").out)["tyre"]
    data = yaml.safe_load((configs / "nose_gear_thota.yaml").read_text())
    data["envelope"]["vertical_load"] = "100 kN"
    (tmp_path / "one.yaml").write_text(yaml.safe_dump(data | {"tyre": block}))
    (tmp_path / "other.yaml").write_text(yaml.safe_dump(data | {"tyre": {"file": "main.tir", "half_contact_length": "0.2 m"}}))
    assert damperopt.load(tmp_path / "one.yaml") == damperopt.load(tmp_path / "other.yaml")


def test_study_is_shown_at_the_loads_of_its_envelope(call, configs, tmp_path):
    done = call(configs / "main_gear.yaml", "-o", "out")
    assert done.code == 0, done.err
    table = columns(tmp_path / "out" / "tyre.csv")
    assert "150000" in table["load [N]"]
    assert set(table["relaxation_length [m]"]) == {"0.3"}


def test_curves_leave_out_loads_without_data():
    from components_of import tyre_of

    tyre = tyre_of(size="49x17", type="VII", rated_pressure="170 psi")
    record = tyre_curves(tyre, [1e5, 2e5, 4e5], "x")
    np.testing.assert_array_equal(record.loads, [1e5, 2e5])
    np.testing.assert_allclose(record.force[1, -1], tyre.force(tyre.slip_range, 2e5, None))
    with pytest.raises(damperopt.ConfigError, match="presses a 49x17 tyre flat"):
        tyre_curves(tyre, [4e5], "x")


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ((), "tyre: found neither; allowed: a study or a property file, or --size"),
        (("--size", "49x17"), "--size: found no --type"),
        (("--size", "49x17", "--type", "VII"), "--size: found no --rated-pressure"),
        (("--size", "49x17", "--type", "IX", "--rated-pressure", "170psi"), "tyre.type: "),
        (("--size", "46x17R20", "--type", "VII", "--rated-pressure", "170psi"), "tyre.size: '46x17R20' is a radial tyre"),
        ((*SIZE, "--pressure", "170kg"), "--pressure: '170kg' has the unit 'kg'"),
        ((*SIZE, "--loads", "20kN"), "--loads: found '20kN'; allowed: LOW:HIGH"),
        ((*SIZE, "--loads", "20kN:10kN"), "--loads: found '20kN:10kN'; allowed: LOW:HIGH"),
        ((*SIZE, "--loads", "900kN:950kN"), "900 kN presses a 49x17 tyre flat"),
        (("none.tir",), "none.tir: none.tir: cannot be read"),
        (("none.yaml",), "none.yaml: cannot be read"),
        (("main.tir", *SIZE), "tyre: found both"),
    ],
)
def test_bad_calls_end_with_code_2_and_one_message(call, tmp_path, arguments, says):
    done = call(*arguments)
    assert done.code == 2
    assert says in done.err
    assert len(done.err.strip().splitlines()) == 1
    assert not list(tmp_path.glob("runs/*"))

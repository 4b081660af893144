"""Property files (.tir): what is read, in which units, what is refused by line and key; a zoo of mutilated ones."""

import codecs
import logging
import math

import jsonschema
import pytest
import yaml

import damperopt
from damperopt.cli import app
from damperopt.tyres.property_file import property_file

WHOLE = """$ a tyre of nobody
[MDI_HEADER]
FILE_TYPE = 'tir'
(COMMENTS)
{comment_string}
'no tyre = of any maker'
[UNITS]
LENGTH = 'meter'
FORCE = 'newton'
ANGLE = 'radians'
MASS = 'kg'
TIME = 'second'
[MODEL]
PROPERTY_FILE_FORMAT = 'PAC2002'   $ the formula
TYRESIDE = 'LEFT'
LONGVL = 16.6
[DIMENSION]
UNLOADED_RADIUS = 0.62
WIDTH = 0.43
[SHAPE]
{radial width}
 1.0    0.0
 1.0    0.4
[VERTICAL]
FNOMIN = 100000
[SLIP_ANGLE_RANGE]
ALPMIN = -0.5
ALPMAX = 0.4
[VERTICAL_FORCE_RANGE]
FZMIN = 5000
FZMAX = 250000
[SCALING_COEFFICIENTS]
LMUY = 0.9
LGAY = 1
[LONGITUDINAL_COEFFICIENTS]
PCX1 = 1.6
[LATERAL_COEFFICIENTS]
PCY1 = 1.4
PDY1 = 0.8
PDY2 = -0.05
PDY3 = 3
PEY1 = -0.5
PKY1 = -12.0
PKY2 = 2.2
PKY3 = 0.3
PHY1 = 0.002
PTY1 = 1.3
PTY2 = 2.1
[ALIGNING_COEFFICIENTS]
QBZ1 = 7.0
QCZ1 = 1.2
QDZ1 = 0.09
QEZ1 = -1.5
"""

STUDY = """
name: with a file
gear: {kind: yaw, yaw_inertia: 20 kg m^2, caster_length: 0.1 m, wheel_radius: 0.6 m}
tyre: {file: tyres/main.tir, half_contact_length: 0.2 m}
damper: {topology: rotational, torsional_stiffness: 1e5 N m/rad, torsional_damping: 400 N m s/rad}
envelope: {speed: {min: 5 m/s, max: 60 m/s}, vertical_load: [60 kN, 120 kN]}
"""


def coefficients(text):
    return property_file(text, "main.tir", ()).block["coefficients"]


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "tyres").mkdir()
    (tmp_path / "tyres" / "main.tir").write_text(WHOLE)
    (tmp_path / "study.yaml").write_text(STUDY)
    return tmp_path


def test_what_is_read_and_what_becomes_of_the_rest():
    found = property_file(WHOLE, "main.tir", ())
    assert found.kind == "Magic Formula, PAC2002"
    c = found.block["coefficients"]
    assert (c["FNOMIN"], c["UNLOADED_RADIUS"], c["PKY1"], c["LMUY"]) == (1e5, 0.62, -12.0, 0.9)
    assert found.block["data_loads"] == {"min": 5000, "max": 250e3}
    assert found.block["slip_range"] == 0.4
    assert found.absent == ("PEY2", "QBZ2", "QBZ3", "QDZ2", "QEZ2", "QEZ3")
    assert {"PDY3", "PKY3", "LGAY", "PCX1", "WIDTH", "LONGVL", "FILE_TYPE"} == set(found.aside)
    assert found.unknown == ()
    assert any("offsets removed: PHY1" in note for note in found.notes)
    assert any("LEFT" in note for note in found.notes)


def test_a_study_reads_the_file_beside_it(folder, monkeypatch):
    study = damperopt.load(folder / "study.yaml")
    monkeypatch.chdir(folder / "tyres")
    assert damperopt.loads(STUDY.replace("tyres/", "")) == study
    assert (study.tyre.law, study.tyre.source, study.tyre.slip_range) == ("magic_formula", "main.tir", 0.4)
    # K = |PKY1| F_z0 sin(2 atan(F_z/(PKY2 F_z0)))
    K = 12e5 * math.sin(2 * math.atan(60e3 / 2.2e5))
    assert study.tyre.linear(60e3, None).cornering_stiffness == pytest.approx(K, rel=1e-14)
    assert study.tyre.linear(60e3, None).relaxation_length == pytest.approx(
        1.3 * 0.62 * math.sin(2 * math.atan(60e3 / 2.1e5)), rel=1e-14
    )
    again = damperopt.loads(yaml.safe_dump(study.model_dump(mode="json", exclude_none=True)))
    assert again == study


def test_run_folder_holds_the_file_that_its_study_names(folder, configs, monkeypatch):
    text = (configs / "minimal.yaml").read_text()
    start, end = text.index("tyre:"), text.index("damper:")
    block = "tyre: {file: tyres/main.tir, half_contact_length: 0.1 m}\n"
    (folder / "own.yaml").write_text(text[:start] + block + text[end:] + "solver: {starts: 1}\n")
    monkeypatch.chdir(folder)
    with pytest.raises(SystemExit) as end_of_command:
        app(["optimise", "own.yaml", "--no-figures", "-o", "out"])
    assert not end_of_command.value.code
    assert (folder / "out" / "tyres" / "main.tir").read_text() == WHOLE
    assert damperopt.load(folder / "out" / "config.yaml") == damperopt.load(folder / "own.yaml")
    assert damperopt.load_result(folder / "out").config["tyre"]["source"] == "main.tir"


def test_keys_of_the_study_come_first(folder):
    file = folder / "study.yaml"
    more = "{file: tyres/main.tir, law: pac2002, half_contact_length: 0.2 m, relaxation_length: 0.5 m, slip_range: 10 deg}"
    file.write_text(STUDY.replace("{file: tyres/main.tir, half_contact_length: 0.2 m}", more))
    tyre = damperopt.load(file).tyre
    assert tyre.linear(60e3, None).relaxation_length == 0.5
    assert tyre.slip_range == pytest.approx(math.radians(10))


def test_a_load_beyond_the_data_is_refused_unless_the_study_says_more(folder):
    file = folder / "study.yaml"
    file.write_text(STUDY.replace("120 kN", "300 kN"))
    with pytest.raises(damperopt.ConfigError, match=r"300 kN is beyond the tyre's data, 5 to 250 kN \(tyre.data_loads\)"):
        damperopt.load(file)
    more = "half_contact_length: 0.2 m, data_loads: {min: 5 kN, max: 320 kN}"
    file.write_text(STUDY.replace("120 kN", "300 kN").replace("half_contact_length: 0.2 m", more))
    assert damperopt.load(file).envelope.loads == (60e3, 300e3)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (("'meter'", "UNLOADED_RADIUS = 0.62"), ("'mm'", "UNLOADED_RADIUS = 620")),
        (("'meter'", "UNLOADED_RADIUS = 0.62"), ("inch", "unloaded_radius=24.409448818897637")),
        (("'newton'", "= 100000", "= 5000", "= 250000"), ("'kN'", "= 1.0D+2", "= 5", "= 250")),
        (
            ("'newton'", "= 100000", "= 5000", "= 250000"),
            ("'POUND_FORCE'", "= 22480.894309971", "= 1124.04471549855", "= 56202.2357749275"),
        ),
        (("'radians'", "ALPMIN = -0.5", "= 0.4"), ("'degree'", "ALPMIN = -28.64788975654116", "= 22.918311805232928")),
        (("[UNITS]\nLENGTH = 'meter'\nFORCE = 'newton'\nANGLE = 'radians'\nMASS = 'kg'\nTIME = 'second'\n",), ("",)),
    ],
)
def test_units_and_spellings_make_no_difference(old, new):
    text = WHOLE
    for one, other in zip(old, new, strict=True):
        assert one in text
        text = text.replace(one, other)
    found, expected = property_file(text, "main.tir", ()).block, property_file(WHOLE, "main.tir", ()).block
    assert found["coefficients"] == pytest.approx(expected["coefficients"], rel=1e-12)
    assert found["data_loads"] == pytest.approx(expected["data_loads"], rel=1e-12)
    assert found["slip_range"] == pytest.approx(expected["slip_range"], rel=1e-12)


@pytest.mark.parametrize(
    "changed",
    [
        WHOLE.lower(),
        WHOLE.replace("\n", "\r\n"),
        WHOLE.replace("\n", "\r"),
        WHOLE.replace(" = ", "="),
        WHOLE.replace("PCY1 = 1.4", "\tPCY1\xa0=\t1.4   ! inline"),
        WHOLE.replace("PCY1 = 1.4", "! PCY1 = 9\n$ PCY1 = 8\nPCY1 = 14.0e-1"),
        WHOLE.replace("'PAC2002'", '"pac2002"'),
        WHOLE.replace("PROPERTY_FILE_FORMAT = 'PAC2002'", "FITTYP = 52"),
        WHOLE.replace("PROPERTY_FILE_FORMAT = 'PAC2002'", "PROPERTY_FILE_FORMAT = 'MF_05'"),
        WHOLE.replace("[LATERAL_COEFFICIENTS]", "[ LATERAL_COEFFICIENTS ]   $ section"),
        WHOLE.replace("'LEFT'", "'RIGHT'"),
        WHOLE + "\n\x1a",
    ],
)
def test_what_does_not_matter_does_not(changed):
    assert coefficients(changed) == coefficients(WHOLE)


@pytest.mark.parametrize(
    "data",
    [
        codecs.BOM_UTF8 + WHOLE.encode(),
        WHOLE.encode("utf-16"),
        WHOLE.replace("of nobody", "für niemand").encode("cp1252"),
        WHOLE.replace("of nobody", "für niemand").encode(),
        WHOLE.replace("of nobody", "\x81\x8d").encode("latin-1"),
    ],
)
def test_encodings(folder, data):
    expected = damperopt.load(folder / "study.yaml")
    (folder / "tyres" / "main.tir").write_bytes(data)
    assert damperopt.load(folder / "study.yaml") == expected


ZOO = [
    ("PKY1 = -12.0\n", "", "main.tir:37: [LATERAL_COEFFICIENTS] PKY1: missing key; allowed: a number"),
    ("PTY1 = 1.3\n", "", "[LATERAL_COEFFICIENTS] PTY1: missing key; allowed: a number, or tyre.relaxation_length in the study"),
    ("UNLOADED_RADIUS = 0.62\n", "", "main.tir:17: [DIMENSION] UNLOADED_RADIUS: missing key"),
    ("[VERTICAL]\nFNOMIN = 100000\n", "", "main.tir:1: [VERTICAL] FNOMIN: missing key"),
    ("QDZ1 = 0.09\n", "", "[ALIGNING_COEFFICIENTS] QDZ1: missing key; allowed: a number > 0"),
    ("PKY1 = -12.0", "PKY1 = twelve", "main.tir:43: [LATERAL_COEFFICIENTS] PKY1: found 'twelve'; allowed: a number"),
    ("PKY1 = -12.0", "PKY1 = -12,0", "PKY1: found '-12,0'; allowed: a number (write the decimal sign as a point)"),
    ("PKY1 = -12.0", "PKY1 =", "main.tir:43: [LATERAL_COEFFICIENTS] PKY1: found nothing; allowed: a number"),
    ("PKY1 = -12.0", "PKY1 = '-12.0'x", "PKY1: found \"'-12.0'x\"; allowed: text between two quotes"),
    ("PKY1 = -12.0", "PKY1 = 'x", 'PKY1: found "\'x"; allowed: text between two quotes'),
    ("PKY1 = -12.0", "PKY1 -12.0", "main.tir:43: [LATERAL_COEFFICIENTS]: found 'PKY1 -12.0'; allowed: [SECTION], KEY = value"),
    ("PKY1 = -12.0", "PKY1 = nan", "PKY1: found 'nan'; allowed: a number"),
    ("PKY1 = -12.0", "PKY1 = 1e999", "PKY1: found '1e999'; allowed: a number"),
    ("PKY1 = -12.0", "PKY1 = 0", "PKY1: found 0; allowed: a number, not 0"),
    ("PKY1 = -12.0", "PKY1 = -12.0 N", "PKY1: found '-12.0 N'; allowed: a number"),
    (
        "PKY1 = -12.0",
        "PKY1 = -12.0\nPKY1 = -13.0",
        "main.tir:44: [LATERAL_COEFFICIENTS] PKY1: found a second time, first on line 43",
    ),
    ("QBZ1 = 7.0", "QBZ1 = 7.0\nPKY1 = -12", "[ALIGNING_COEFFICIENTS] PKY1: found a second time, first on line 43"),
    ("PKY2 = 2.2", "PKY2 = -2.2", "main.tir:44: [LATERAL_COEFFICIENTS] PKY2: found -2.2 is out of range"),
    ("PCY1 = 1.4", "PCY1 = 14", "main.tir:38: [LATERAL_COEFFICIENTS] PCY1: found 14.0 is out of range; allowed: a number"),
    ("QDZ1 = 0.09", "QDZ1 = -0.09", "QDZ1: found -0.09; allowed: a number, > 0"),
    ("LMUY = 0.9", "LMUY = 0", "[SCALING_COEFFICIENTS] LMUY: found 0.0 is out of range"),
    ("FNOMIN = 100000", "FNOMIN = -100000", "main.tir:25: [VERTICAL] FNOMIN: found -100000.0 is out of range"),
    ("LENGTH = 'meter'", "LENGTH = 'mm'", "main.tir:18: [DIMENSION] UNLOADED_RADIUS: found 0.00062 is out of range"),
    ("FORCE = 'newton'", "FORCE = 'kN'", "main.tir:25: [VERTICAL] FNOMIN: found 100000000.0 is out of range"),
    ("PDY1 = 0.8", "PDY1 = 80", "main.tir:39: [LATERAL_COEFFICIENTS] PDY1: found 80.0 is out of range"),
    ("LENGTH = 'meter'", "LENGTH = 'parsec'", "main.tir:8: [UNITS] LENGTH: found 'parsec'; allowed: meter"),
    ("FORCE = 'newton'", "FORCE = 'newton'\nFORCE = 'kN'", "main.tir:10: [UNITS] FORCE: found a second time, first on line 9"),
    ("'PAC2002'", "'FTIRE'", "main.tir:14: [MODEL] PROPERTY_FILE_FORMAT: found 'FTIRE'; allowed: PAC2002"),
    ("PROPERTY_FILE_FORMAT = 'PAC2002'   $ the formula\n", "", "main.tir:13: [MODEL] PROPERTY_FILE_FORMAT: missing key"),
    ("[DIMENSION]", "[DIMENSION", "main.tir:17: found '[DIMENSION'; allowed: a section as [NAME]"),
    ("FZMIN = 5000", "FZMIN = 500000", "main.tir:31: [VERTICAL_FORCE_RANGE] FZMAX: found 250000 after FZMIN 500000"),
    ("ALPMAX = 0.4", "ALPMAX = text", "main.tir:28: [SLIP_ANGLE_RANGE] ALPMAX: found 'text'; allowed: a number"),
    ("TYRESIDE = 'LEFT'", "TYRESIDE = 'LEFT'\nTYRESIDE = 'RIGHT'", "main.tir:16: [MODEL] TYRESIDE: found a second time"),
]


@pytest.mark.parametrize(("old", "new", "says"), ZOO, ids=[case[2][:60] for case in ZOO])
def test_mutilated_files_are_refused_with_line_and_key(folder, old, new, says):
    assert WHOLE.count(old) == 1
    (folder / "tyres" / "main.tir").write_text(WHOLE.replace(old, new))
    with pytest.raises(damperopt.ConfigError) as error:
        damperopt.load(folder / "study.yaml")
    assert says in str(error.value)
    assert len(error.value.problems) == 1
    assert "main.tir:" in error.value.problems[0]


def test_all_problems_of_a_file_are_told_at_once():
    text = WHOLE.replace("PKY1 = -12.0\n", "").replace("PCY1 = 1.4", "PCY1 = x").replace("FNOMIN = 100000", "FNOMIN = y")
    with pytest.raises(damperopt.ConfigError) as error:
        property_file(text, "main.tir", ())
    keys = [problem.split("]")[1].split(":")[0].strip() for problem in error.value.problems]
    assert keys == ["FNOMIN", "PKY1", "PCY1"]


@pytest.mark.parametrize(
    ("block", "says"),
    [
        ("{file: none.tir, half_contact_length: 0.2 m}", "study.yaml:4: tyre.file: "),
        ("{file: 5, half_contact_length: 0.2 m}", "study.yaml:4: tyre.file: found 5; allowed: the name of a property file"),
        ("{file: tyres, half_contact_length: 0.2 m}", "is a folder; allowed: a readable property file"),
        ("{file: tyres/main.tir}", "study.yaml:4: tyre.half_contact_length: missing key"),
        ("{file: tyres/main.tir, law: linear, half_contact_length: 0.2 m}", "found law 'linear'"),
        ("{file: tyres/main.tir, coefficients: {PCY1: 1}, half_contact_length: 0.2 m}", "found coefficients beside it"),
        (
            "{file: tyres/main.tir, friction: 0.5, half_contact_length: 0.2 m}",
            "study.yaml:4: tyre.friction: belongs to another",
        ),
    ],
)
def test_blocks_that_name_a_file_wrongly(folder, block, says):
    file = folder / "study.yaml"
    file.write_text(STUDY.replace("{file: tyres/main.tir, half_contact_length: 0.2 m}", block))
    with pytest.raises(damperopt.ConfigError) as error:
        damperopt.load(file)
    assert says in str(error.value)
    assert len(error.value.problems) == 1


def test_no_text_is_refused(folder):
    (folder / "tyres" / "main.tir").write_bytes(b"\x00\x01\x02PKY1")
    with pytest.raises(damperopt.ConfigError, match="holds zero bytes"):
        damperopt.load(folder / "study.yaml")
    (folder / "tyres" / "main.tir").write_bytes(b"$" * 2_000_000)
    with pytest.raises(damperopt.ConfigError, match="is larger than 1024 KiB"):
        damperopt.load(folder / "study.yaml")


def test_keys_that_no_formula_knows_are_listed():
    text = WHOLE.replace("PCY1 = 1.4", "PCY1 = 1.4\nPKY9X = 3").replace("[MODEL]", "[OWN]\nCOLOUR = 'black'\n[MODEL]")
    assert property_file(text, "main.tir", ()).unknown == ("COLOUR", "PKY9X")


NEWER = (
    WHOLE.replace("PROPERTY_FILE_FORMAT = 'PAC2002'", "PROPERTY_FILE_FORMAT = 'USER'\nFITTYP = 61")
    .replace("PTY1 = 1.3\nPTY2 = 2.1\n", "PKY4 = 1.9\nPPY1 = 0.4\n")
    .replace("FNOMIN = 100000", "FNOMIN = 100000\nLATERAL_STIFFNESS = 1.2e6\nNOMPRES = 1.1e6\nINFLPRES = 1.1e6")
)


def test_newer_formula_is_read_as_far_as_it_is_used(folder, caplog):
    (folder / "tyres" / "main.tir").write_text(NEWER)
    with caplog.at_level(logging.WARNING, "damperopt"):
        study = damperopt.load(folder / "study.yaml")
    assert "Magic Formula, FITTYP 61" in caplog.text
    assert "not used: camber, turn slip" in caplog.text
    K = 12e5 * math.sin(1.9 * math.atan(60e3 / 2.2e5))
    C, _, sigma, _ = study.tyre.linear(60e3, None)
    assert pytest.approx(K, rel=1e-14) == C
    assert sigma == pytest.approx(K / 1.2e6, rel=1e-14)
    assert study.tyre.linear(60e3, 1.21e6).cornering_stiffness == pytest.approx(1.04 * K, rel=1e-14)


def test_newer_keys_in_an_older_file_are_not_used_and_said():
    found = property_file(WHOLE.replace("PKY3 = 0.3", "PKY3 = 0.3\nPKY4 = 1.5"), "main.tir", ())
    assert "PKY4" not in found.block["coefficients"]
    assert "PKY4" in found.aside


def test_newer_file_without_a_relaxation_length_is_refused():
    text = NEWER.replace("LATERAL_STIFFNESS = 1.2e6\n", "")
    with pytest.raises(damperopt.ConfigError, match="PTY1: missing key"):
        property_file(text, "main.tir", ())
    assert "PTY1" not in property_file(text, "main.tir", ("relaxation_length",)).block["coefficients"]


BRUSH = """[UNITS]
LENGTH = 'mm'
FORCE = 'newton'
ANGLE = 'degree'
[MODEL]
PROPERTY_FILE_FORMAT = 'FIALA'
[DIMENSION]
UNLOADED_RADIUS = 620
WIDTH = 430
[PARAMETER]
VERTICAL_STIFFNESS = 2000
CALPHA = 8000
UMIN = 0.5
UMAX = 0.8
REL_LEN_LAT = 400
"""


@pytest.mark.parametrize("kind", ["'FIALA'", "'UA'", "'Aircraft_Basic'"])
def test_brush_files(folder, kind):
    (folder / "tyres" / "main.tir").write_text(BRUSH.replace("'FIALA'", kind))
    tyre = damperopt.load(folder / "study.yaml").tyre
    assert tyre.law == "brush"
    assert tyre.linear(60e3, None).cornering_stiffness == pytest.approx(8000 * 180 / math.pi)
    assert (tyre.friction, tyre.sliding_friction, tyre.relaxation_length) == (0.8, 0.5, pytest.approx(0.4))


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("CALPHA = 8000\n", "", "main.tir:10: [PARAMETER] CALPHA: missing key; allowed: a number"),
        ("UMIN = 0.5", "UMIN = 0.9", "main.tir:13: [PARAMETER] UMIN: found 0.9; allowed: at most UMAX"),
        ("UMAX = 0.8", "UMAX = 8", "main.tir:14: [PARAMETER] UMAX: found 8; allowed: a number > 0 and <= 2"),
        ("CALPHA = 8000", "CALPHA = -8000", "CALPHA: found -458366; allowed: a number > 0"),
        ("REL_LEN_LAT = 400\n", "", "REL_LEN_LAT: missing key; allowed: a number, or tyre.relaxation_length in the study"),
    ],
)
def test_mutilated_brush_files(old, new, says):
    with pytest.raises(damperopt.ConfigError) as error:
        property_file(BRUSH.replace(old, new), "main.tir", ())
    assert says in str(error.value)
    assert len(error.value.problems) == 1


def test_schema_takes_a_file_and_a_size_without_a_law():
    schema = jsonschema.Draft202012Validator(damperopt.json_schema())
    data = yaml.safe_load(STUDY)
    schema.validate(data)
    data["tyre"] = {"size": "49x17", "type": "VII", "rated_pressure": "170 psi"}
    schema.validate(data)
    for wrong in ({"file": "x.tir", "half_length": 1}, {"file": "x.tir"}, {"size": "49x17"}):
        data["tyre"] = wrong
        assert not schema.is_valid(data)

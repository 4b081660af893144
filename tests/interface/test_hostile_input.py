"""Input that is meant to break the reader: one message with file, line and key, soon, short and printable; no traceback."""

import json
import os
import subprocess
import sys
import time

import pytest

import damperopt
from damperopt.results import load_result

NINES = "9" * 400

# what may stand in the place of a length
NO_LENGTHS = {
    "octal": ("010", "leading zeros"),
    "octal with a unit": ("010 m", "leading zeros"),
    "base sixty": ("1:30", "decimal digits"),
    "base sixty with a unit": ("1:30 m", "decimal digits"),
    "hexadecimal": ("0x10", "decimal digits"),
    "binary": ("0b11", "decimal digits"),
    "underscore": ("1_000", "underscores"),
    "underflow": ("1e-400", "would become 0"),
    "underflow with a unit": ("1e-400 m", "would become 0"),
    "underflow of a long exponent": ("1e-" + NINES[:30], "would become 0"),
    "overflow": ("1e" + NINES[:30], "not a finite number"),
    "overflow with a unit": ("1e99999999999999999999 m", "not a finite number"),
    "400 digits": (NINES, "400 characters"),
    "5000 digits": ("9" * 5000, "5000 characters"),
    "400 digits with a unit": (f"{NINES} m", "more characters"),
    "digits of another script": ("١٢", "digits are 0 to 9"),
    "digits of another script with a unit": ("'١٢ m'", "digits are 0 to 9"),
    "another minus": ("−0.1 m", "write the sign as -"),
    "decimal comma": ("0,12 m", "decimal sign as a point"),
    "thousands": ("1,200 m", "without separators"),
    "trailing rubbish": ("'0.12 m rubbish'", "'m rubbish'"),
    "angle smuggled in": ("1 m deg", "another dimension"),
    "percentage of a metre": ("12 % m", "another dimension"),
    "date": ("2026-11-25", "another dimension"),
    "tag int": ("!!int ''", "the tag"),
    "tag bool": ("!!bool foo", "the tag"),
    "tag timestamp": ("!!timestamp abc", "the tag"),
    "tag of a class": ("!!python/object:os.system x", "the tag"),
    "own tag": ("!mine 5", "the tag '!mine'"),
    "empty tag": ("! 0.12", "the tag '!'"),
    "half of a pair": (r'"\ud800"', "U+D800"),
    "zero byte": (r'"0.12 m\0"', "U+0000"),
    "terminal escape": (r'"\e[31m"', "U+001B"),
    "long unit": ("5 " + "m" * 100_000, "100002 characters"),
    "tower of powers": ("5 m^9^9^9^9", "another dimension"),
    "merge as a value": ("<<", "is no value"),
    "infinity": (".inf", "not a finite number"),
    "far": ("1e8 m", "beyond any landing gear"),
    "near": ("1e-12 m", "beyond any landing gear"),
}


def problems_of(text):
    start = time.process_time()  # however busy the machine
    with pytest.raises(damperopt.ConfigError) as error:
        damperopt.loads(text, "study.yaml")
    assert time.process_time() - start < 5
    for problem in error.value.problems:
        assert problem.isprintable()
        assert len(problem) < 1000
    return error.value.problems


@pytest.fixture(scope="module")
def gear(configs):
    return (configs / "thesis_gear.yaml").read_text()


@pytest.mark.parametrize("case", NO_LENGTHS)
def test_no_length_is_refused_at_its_line(case, gear):
    value, says = NO_LENGTHS[case]
    (problem,) = problems_of(gear.replace("0.12 m ", value + " ", 1))
    assert problem.startswith("study.yaml:12: ")
    assert says in problem


@pytest.mark.parametrize(
    ("old", "new", "key", "says"),
    [
        ("cycles: 3", "cycles: 010", "requirements.decay.cycles", "'010'"),
        ("cycles: 3", f"cycles: {NINES}", "requirements.decay.cycles", "400 characters"),
        ("ratio: 1/3", f"ratio: {NINES}/1", "requirements.decay.ratio", "no fraction"),
        ("ratio: 1/3", "ratio: 1e999999999/3", "requirements.decay.ratio", "no fraction"),
        ("ratio: 1/3", "ratio: 01/3", "requirements.decay.ratio", "no fraction"),
        ("ratio: 1/3", "ratio: ١/٣", "requirements.decay.ratio", "no fraction"),
        ("0.1 1/s", "0.1 Hz", "requirements.stability_margin", "Hz may count cycles or radians; write 1/s"),
        ("0.1 1/s", "1 rpm", "requirements.stability_margin", "another dimension"),
        ("150 kN", "9 mN", "envelope.vertical_load", "beyond any landing gear"),
        ("150 kN", "150 KN", "envelope.vertical_load", "did you mean 'kN'?"),
        ("min: 5 m/s", "min: 0 kt", "envelope.speed.min", "begin to taxi at a small speed"),
        ("min: 5 m/s", "min: 1e-12 m/s", "envelope.speed.min", "out of range"),
        ("max: 100 m/s", "max: 120 KTAS", "envelope.speed.max", "did you mean 'kt'?"),
        ("name: main gear", r'name: "a\0b"', "name", "U+0000"),
        ("name: main gear", r'name: "a\u202eb"', "name", "U+202E"),
        ("name: main gear", r'name: "a\nb"', "name", "U+000A"),
        ("name: main gear", "name: " + "x" * 300, "name", "at most 200"),
        ("gear:\n", "gear:\n  <<: {order: 3}\n", "gear.order", "duplicate key, first on line 10"),
        ("gear:\n", "gear:\n  1: x\n", "gear", "the key '1' is no text"),
        ("gear:\n", "gear:\n  null: x\n", "gear", "the key 'null' is no text"),
        ("gear:\n", "gear:\n  ? [a]\n  : x\n", "gear", "is no text"),
        ("gear:\n", 'gear:\n  "\\e[31m": x\n', "gear", "U+001B"),
        ("gear:\n", f"gear:\n  {'k' * 900}: x\n", "gear.'kkk", "unknown key"),
    ],
)
def test_other_keys_say_what_is_wrong(old, new, key, says, gear):
    assert old in gear
    text = gear.replace(old, new, 1)
    problem = problems_of(text)[0]
    head, _, rest = problem.partition(": ")
    assert rest.startswith(key)
    assert says in problem
    assert int(head.removeprefix("study.yaml:")) >= gear[: gear.index(old)].count("\n") + 1


def bomb(first, following):
    return f"a: &a {first}\n" + "".join(f"{b}: &{b} {following(a)}\n" for a, b in zip("abcdefgh", "bcdefghi", strict=True))


@pytest.mark.parametrize(
    "text",
    [
        bomb("[x, x]", lambda a: "[" + ", ".join([f"*{a}"] * 10) + "]"),
        bomb("{x: 1}", lambda a: "{" + ", ".join(f"k{i}: *{a}" for i in range(10)) + "}"),
        bomb("{x: 1}", lambda a: "{<<: [" + ", ".join([f"*{a}"] * 10) + "]}"),
        "a: &a [*a]\n",
        "a: &a {b: *a}\n",
        "a: &a {<<: *a}\n",
        "a: " + "[" * 100_000,
        "a: " + "{a: " * 3000,
        "".join(f"k{i}: 1\n" for i in range(20_000)),
        "name: a\n" * 3000,
    ],
    ids=["lists", "mappings", "merges", "self", "self in a mapping", "self merged", "deep", "deep mapping", "wide", "repeated"],
)
def test_files_that_grow_in_memory_are_refused_soon(text):
    assert len(problems_of(text)) <= 31


def test_a_merged_block_counts_as_written_out(gear):
    merged = gear.replace("    inertia: 600 kg m^2 ", "    <<: {inertia: 600 kg m^2} ", 1)
    assert damperopt.loads(merged) == damperopt.loads(gear)


def test_line_of_a_character_that_yaml_does_not_have(gear):
    (problem,) = problems_of(gear.replace("order: 5", "order: 5 \x07", 1))
    assert problem.startswith("study.yaml:10: not valid YAML: the character U+0007")


@pytest.fixture
def odd_files(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "folder").mkdir()
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    (tmp_path / "large").write_bytes(b"a" * (1 << 20))
    with open(tmp_path / "endless", "wb") as file:
        file.truncate(1 << 40)
    (tmp_path / "binary").write_bytes(b"\xff\xfe\x00")
    return tmp_path


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("pipe", "is a pipe"),
        ("folder", "folder"),
        ("loop", "symbolic links"),
        ("endless", "is larger than"),
        ("binary", "not UTF-8"),
        ("missing", "No such file"),
        ("/dev/zero", "is a device"),
        ("a\0b", "null"),
        ("x" * 5000, "too long"),
        ("half\udc80", "No such file"),
    ],
)
@pytest.mark.parametrize("read", [damperopt.load, load_result])
def test_only_regular_files_of_a_size_are_read(read, name, says, odd_files):
    if read is load_result and name == "folder":
        says = "No such file"  # of result.json in it
    with pytest.raises(damperopt.ConfigError) as error:
        read(odd_files / name)
    assert says in str(error.value)
    assert str(error.value).isprintable()
    assert len(str(error.value)) < 1000


@pytest.mark.parametrize(
    "text",
    [
        "[" * 200_000,
        '{"config":' + '{"a":' * 100_000,
        "null",
        "5",
        '{"status": 5}',
        '{"' + "k" * 100_000 + '": 1}',
        '{"schema_version": ' + "9" * 5000 + "}",
    ],
)
def test_what_is_no_result_is_refused(text, tmp_path):
    (tmp_path / "result.json").write_text(text)
    with pytest.raises(damperopt.ConfigError) as error:
        load_result(tmp_path)
    assert len(str(error.value)) < 1000


def test_a_result_with_endless_digits_makes_no_study(main_gear):
    for value in (int(NINES), "9" * 5000 + " Pa", float("nan")):
        with pytest.raises(damperopt.ConfigError, match=r"material\.youngs_modulus"):
            main_gear.replace(material__youngs_modulus=value)


@pytest.mark.parametrize("path", ["name__x", "design__L__start__x", "envelope__vertical_load__0", "gear__yaw_inertia__x__y"])
def test_changes_lead_through_blocks_only(path, main_gear):
    with pytest.raises(damperopt.ConfigError, match=r"has no keys; allowed: a new value of"):
        main_gear.replace(**{path: 1})


@pytest.mark.parametrize("name", ["a\0b", "\ud800", "a\x1b[31m", ""])
def test_names_given_in_python_are_printable(name, main_gear):
    with pytest.raises(damperopt.ConfigError, match="name"):
        main_gear.replace(name=name)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--speed", "40", "--kick", "yaw=1Hz"], "write rad/s, deg/s or rpm"),
        (["--speed", "0 kt", "--kick", "yaw=1"], "begin to taxi"),
        (["--speed", "١٢", "--kick", "yaw=1"], "digits are 0 to 9"),
        (["--speed", "1_0", "--kick", "yaw=1"], "underscores"),
        (["--speed", "40", "--release", "yaw=1e-400"], "would become 0"),
        (["--speed", "1 a" + " " * 50_000 + "b", "--kick", "yaw=1"], "more characters"),
        (["--speed", "40", "--release", "yaw=" + "9" * 50_000], "more characters"),
    ],
)
def test_arguments_are_read_as_strictly_as_files(arguments, says, configs):
    from damperopt.cli import app

    with pytest.raises(damperopt.ConfigError, match=says) as error:
        app(["simulate", str(configs / "nose_gear_somieski.yaml"), *arguments], standalone_mode=False)
    assert len(str(error.value)) < 1000


@pytest.mark.parametrize("home", ["/dev/null", "missing", None])
def test_works_without_a_home(home, configs, tmp_path):
    """Containers have none, or one that cannot be written; units are read without their cache."""
    lost = {"HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME", "MPLCONFIGDIR"}
    environment = {key: value for key, value in os.environ.items() if key not in lost}
    if home is not None:
        environment |= {"HOME": home, "XDG_CACHE_HOME": home}
    program = "from damperopt.study.config import load; import sys; print(load(sys.argv[1]).name)"
    run = subprocess.run(
        [sys.executable, "-c", program, str(configs / "minimal.yaml")],
        env=environment, cwd=tmp_path, capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    assert run.stdout == "minimal\n", run.stderr
    assert json.dumps(run.stderr) == '""'

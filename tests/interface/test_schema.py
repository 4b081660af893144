"""The JSON Schemas say what every key means and its unit, and agree with the reader; the starter points editors to them."""

import json
import re
from pathlib import Path

import jsonschema
import pytest
import yaml

import damperopt
from damperopt.cli import app
from damperopt.study.schema import json_schema
from damperopt.sweep.spec import SweepSpec

STARTER = Path(damperopt.__file__).with_name("starter.yaml")


@pytest.fixture(scope="module")
def study_schema():
    return jsonschema.Draft202012Validator(damperopt.json_schema())


@pytest.fixture(scope="module")
def sweep_schema():
    return jsonschema.Draft202012Validator(json_schema(SweepSpec))


def keys_of(schema):
    for name, block in [("", schema), *schema.get("$defs", {}).items()]:
        for part in (block, *block.get("anyOf", ())):
            yield from ((f"{name}.{key}", described) for key, described in part.get("properties", {}).items())


@pytest.mark.parametrize("which", ["study_schema", "sweep_schema"])
def test_every_key_says_what_it_means(which, request):
    schema = request.getfixturevalue(which).schema
    silent = [
        key for key, about in keys_of(schema) if not about.get("description") or about["description"].startswith("a number")
    ]
    assert not silent


def test_keys_with_units_say_them(study_schema):
    keys = dict(keys_of(study_schema.schema))
    assert "kg m^2" in keys["YawBending.yaw_inertia"]["description"]
    assert "offset of the axle" in keys["YawBending.caster_length"]["description"]


def test_shipped_files_pass(study_schema, sweep_schema, configs):
    for file in [*configs.glob("*.yaml"), STARTER]:
        study_schema.validate(yaml.safe_load(file.read_text()))
    for file in (configs / "sweeps").glob("*.yaml"):
        sweep_schema.validate(yaml.safe_load(file.read_text()))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("caster_length: 0.12 m", "caster_length: 70 kg"),
        ("caster_length: 0.12 m", "caster_length: 1e8"),
        ("vertical_load: 150 kN", "vertical_load: 70 kg"),
        ("vertical_load: 150 kN", "vertical_load: [150 kN, 2 m]"),
        ("min: 5 m/s", "min: 0"),
        ("min: 5 m/s", "min: 5 m"),
        ("order: 5", "order: 4"),
        ("start: 31 deg", "start: 31 kg"),
        ("stability_margin: 0.1 1/s", "stability_margin: 0.1 Hz"),
        ("half_contact_length: 0.1 m", "half_contact_length: null"),
    ],
)
def test_what_the_reader_refuses_the_schema_refuses(old, new, study_schema):
    text = STARTER.read_text()
    assert old in text
    with pytest.raises(damperopt.ConfigError):
        damperopt.loads(text.replace(old, new, 1))
    assert not study_schema.is_valid(yaml.safe_load(text.replace(old, new, 1)))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("caster_length: 0.12 m", "caster_length: 5 in"),
        ("yaw_inertia: 100 kg m^2", "yaw_inertia: 900 lb-in-s^2"),
        ("damping: 300 N m s/rad", "damping: 2700 in-lb-s/rad"),
        ("vertical_load: 150 kN", "vertical_load: {min: 30000 lbf, max: 150 kN}"),
        ("cornering_stiffness: 448 kN/rad", "cornering_stiffness: 448000"),
        ("friction: 0.7", "friction: 70 %"),
    ],
)
def test_what_the_reader_takes_the_schema_takes(old, new, study_schema):
    text = STARTER.read_text().replace(old, new, 1)
    damperopt.loads(text)
    study_schema.validate(yaml.safe_load(text))


def test_commands_print_both(capsys):
    for arguments, key in ((["schema"], "gear"), (["schema", "--sweep"], "vary")):
        app(arguments, standalone_mode=False)
        assert key in json.loads(capsys.readouterr().out)["properties"]


def test_starter_points_editors_to_the_schema_that_it_names():
    first, text = STARTER.read_text().splitlines()[0], STARTER.read_text()
    file = re.fullmatch(r"# yaml-language-server: \$schema=(\S+)", first)
    assert file
    assert f"damperopt schema > {file[1]}" in text


def test_starter_is_a_usual_gear(capsys):
    app(["validate", str(STARTER)], standalone_mode=False)
    shown = capsys.readouterr()
    assert "valid" in shown.out
    assert not shown.err


def test_validate_knows_a_sweep_and_says_what_is_not_usual(configs, capsys):
    app(["validate", str(configs / "sweeps" / "margin.yaml"), str(configs / "thesis_gear.yaml")], standalone_mode=False)
    shown = capsys.readouterr()
    assert "valid (sweep mass against margin, 15 points to optimise)" in shown.out
    assert "usual: 1 to 30" in shown.err


def test_a_sweep_given_for_a_study_is_named(configs):
    with pytest.raises(damperopt.ConfigError) as error:
        damperopt.load(configs / "sweeps" / "margin.yaml")
    assert len(error.value.problems) == 1
    assert "this is a sweep, not a study" in str(error.value)


def test_validate_of_a_broken_sweep_speaks_of_sweeps(tmp_path, configs):
    file = tmp_path / "sweep.yaml"
    file.write_text(
        f"base: {configs / 'minimal.yaml'}\nrun: guess\nvary: {{gear.caster_length: {{from: 1, to: 2, point: 3}}}}\n"
    )
    with pytest.raises(damperopt.ConfigError) as error:
        app(["validate", str(file)], standalone_mode=False)
    text = str(error.value)
    assert f"{file}:2: run: 'guess' is not one of the choices; allowed: 'optimise' or 'analyse'" in text
    assert f"{file}:3: vary.gear.caster_length.point: unknown key (did you mean 'points'?)" in text
    assert "damperopt init" not in text
    assert "list[any]" not in text

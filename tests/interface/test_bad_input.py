"""Bad input never passes: exit code 2 and file:line: key.path: what is wrong; allowed: ..."""

import re

import pytest

import damperopt

# what to change in main_gear.yaml, where it is reported, and what the message must say
BROKEN = {
    "unknown key": ("caster_length:", "caster_lenght:", "gear.caster_lenght", "did you mean 'caster_length'"),
    "missing key": ("  yaw_inertia: 100 kg m^2", "  #", "gear.yaw_inertia", "missing key; allowed: a number in kg m^2"),
    "missing block": ("  lateral:", "  _lateral:", "gear._lateral", "unknown key"),
    "wrong dimension": ("0.3 m ", "0.3 kg ", "tyre.relaxation_length", "another dimension"),
    "unknown unit": ("150 kN", "150 kNewt", "envelope.vertical_load", "unknown"),
    "not a number": ("0.1 1/s", ".nan", "requirements.stability_margin", "nan is not a finite number"),
    "infinite": ("0.1 1/s", ".inf", "requirements.stability_margin", "inf is not a finite number"),
    "text that looks like a number": ("1000 N s/m", "'1e5'", "design.c_lambda.start", "text without a unit"),
    "inverted speeds": ("min: 5 m/s", "min: 500 m/s", "envelope.speed", "inverted range"),
    "inverted bounds": ("min: 0.2 m,", "min: 2 m,", "design.L", "inverted range"),
    "start outside its bounds": ("start: 0.6 m", "start: 3 m", "design.L", "start outside"),
    "inverted lengths": ("{min: 0.1 m, max: 0.4 m}", "{min: 0.5 m, max: 0.4 m}", "requirements.reach", "inverted"),
    "duplicate key": ("name: main gear", "name: a\nname: b", "name", "duplicate key, first on line"),
    "choice": ("topology: arreaza", "topology: citroen", "damper.topology", "'boeing', 'utas', 'arreaza'"),
    "order": ("order: 5 ", "order: 4 ", "gear.order", "3 or 5"),
    "tyre law": ("law: nonlinear", "law: magic", "tyre", "'nonlinear', 'linear', 'straight_tangent'"),
    "boolean": ("150 kN", "true", "envelope.vertical_load", "found True"),
    "nothing": ("0.12 m ", "~ ", "gear.caster_length", "found nothing"),
    "list for a number": ("0.12 m ", "[0.12] ", "gear.caster_length", "found a list"),
    "zero inertia": ("100 kg m^2", "0 kg m^2", "gear.yaw_inertia", "out of range"),
    "negative speed": ("min: 5 m/s", "min: -5 m/s", "envelope.speed.min", "out of range"),
    "angle in degrees without a unit": ("start: 31 deg", "start: 31", "design.gamma.start", "such as '31 deg'"),
    "material": ("AISI 4340  ", "mithril  ", "material", "no known material"),
    "load list": ("150 kN", "[150 kN, 2 m]", "envelope.vertical_load.1", "another dimension"),
    "load twice": ("150 kN", "[150 kN, 150 kN]", "envelope.vertical_load", "names a load twice"),
    "no load": ("150 kN", "[]", "envelope.vertical_load", "empty list"),
    "block for text": ("name: main gear", "name: {a: 1}", "name", "found {'a': 1}"),
    "text for a block": ("tyre:\n", "tyre: round\nx:\n", "tyre", "instead of a block"),
    "no design variable": ("  I_arm:", "  #", "design.I_arm", "topology 'arreaza' needs design variables"),
    "rotational without numbers": ("topology: arreaza", "topology: rotational", "damper", "torsional_stiffness"),
    "yaml": ("order: 5", "order: [5", "", "not valid YAML"),
}


@pytest.mark.parametrize("case", BROKEN)
def test_message_names_file_line_key_and_what_is_allowed(case, configs):
    old, new, key, says = BROKEN[case]
    text = (configs / "main_gear.yaml").read_text()
    assert text.count(old) >= 1, "the test looks for text that is no longer in the config"
    with pytest.raises(damperopt.ConfigError) as error:
        damperopt.loads(text.replace(old, new, 1), "study.yaml")
    messages = error.value.problems
    matching = [m for m in messages if says in m]
    assert matching, messages
    assert re.match(rf"study\.yaml:\d+: {re.escape(key)}", matching[0])
    assert "allowed" in matching[0] or case == "yaml"


def test_line_is_that_of_the_key(configs):
    text = (configs / "main_gear.yaml").read_text().replace("0.3 m ", "0.3 kg ", 1)
    line = next(i for i, row in enumerate(text.splitlines(), 1) if "0.3 kg" in row)
    with pytest.raises(damperopt.ConfigError, match=f"study.yaml:{line}: "):
        damperopt.loads(text, "study.yaml")


def test_all_problems_are_reported_at_once(configs):
    text = (configs / "main_gear.yaml").read_text()
    text = text.replace("0.3 m ", "0.3 kg ", 1).replace("caster_length:", "caster:", 1)
    with pytest.raises(damperopt.ConfigError) as error:
        damperopt.loads(text)
    assert len(error.value.problems) == 3  # wrong dimension, unknown key, missing key


@pytest.mark.parametrize("text", ["", "- a\n- b\n", "hello", "name: x", "a: *b", "\t", "name: \x00", "? [a, b]\n: c", "1: 2"])
def test_files_that_are_no_study_are_refused(text):
    with pytest.raises(damperopt.ConfigError):
        damperopt.loads(text)


def test_numbers_may_be_written_as_engineers_do(configs, main_gear):
    text = (configs / "main_gear.yaml").read_text().replace("max: 1e7 N s/m", "max: 1e7").replace("150 kN", "1.5E+5", 1)
    study = damperopt.loads(text)
    assert study.design.c_lambda.max == 1e7
    assert study.envelope.loads == main_gear.envelope.loads


def test_replace_checks_the_new_study(main_gear):
    assert main_gear.replace(damper__topology="utas").damper.topology == "utas"
    for bad in ({"gear__mass": 1.0}, {"gear__yaw_inertia": float("nan")}, {"envelope__speed__min": 1e9}):
        with pytest.raises(damperopt.ConfigError, match=next(iter(bad)).replace("__", ".").rsplit(".min")[0]):
            main_gear.replace(**bad)

"""Bad input never passes: exit code 2 and file:line: key.path: what is wrong; allowed: ..."""

import re

import pytest

import damperopt

NAME, RADIUS, PLANAR = "name: main gear", "wheel_radius: 0.362 m", "geometry: planar"
MARGIN, RELEASE = "stability_margin: 0.1 1/s", "release: {yaw_angle: 0.25 deg}"
ROTATIONAL = "topology: rotational\n  torsional_stiffness: 1\n  torsional_damping: 1\n  "

# what to change in thesis_gear.yaml, where it is reported, and what the message must say
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
    "choice": ("topology: arreaza", "topology: citroen", "damper.topology", "allowed: arreaza, boeing, rotational, utas"),
    "order": ("order: 5 ", "order: 4 ", "gear.order", "3 or 5"),
    "tyre law": (
        "law: arctangent",
        "law: magic",
        "tyre.law",
        "allowed: arctangent, brush, linear, magic_formula, stiffness, tr_r64",
    ),
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
    "decay to nothing": ("ratio: 1/3 ", "ratio: 0 ", "requirements.decay.ratio", "0 is out of range"),
    "no decay": ("ratio: 1/3 ", "ratio: 1 ", "requirements.decay.ratio", "1 is out of range"),
    "growth": ("ratio: 1/3 ", "ratio: 3/2 ", "requirements.decay.ratio", "1.5 is out of range"),
    "ratio in words": ("ratio: 1/3 ", "ratio: one third ", "requirements.decay.ratio", "'one third' is not a number"),
    "division by zero": ("ratio: 1/3 ", "ratio: 1/0 ", "requirements.decay.ratio", "'1/0'"),
    "no cycles": ("cycles: 3", "cycles: 0", "requirements.decay.cycles", "found 0"),
    "part of a cycle": ("cycles: 3", "cycles: 1.5", "requirements.decay.cycles", "found 1.5"),
    "release and kick": (RELEASE, f"{RELEASE}\n    kick: {{yaw_rate: 1}}", "requirements.decay", "release and kick"),
    "neither release nor kick": (RELEASE, "", "requirements.decay", "neither release nor kick; allowed: one of the two"),
    "unknown state": (RELEASE, "release: {roll: 1 deg}", "requirements.decay.release.roll", "unknown key"),
    "release of a rate": (RELEASE, "release: {yaw_rate: 1}", "requirements.decay.release.yaw_rate", "mean 'yaw_angle'"),
    "release from rest": (RELEASE, "release: {yaw_angle: 0}", "requirements.decay.release", "nothing is disturbed"),
    "release without yaw": (RELEASE, "release: {bending_angle: 1 deg}", "requirements.decay", "without yaw"),
    "kick by nothing": (RELEASE, "kick: {yaw_rate: 0}", "requirements.decay.kick", "nothing is disturbed"),
    "no decay speeds": (RELEASE, f"{RELEASE}\n    speeds: []", "requirements.decay.speeds", "an empty list"),
    "negative decay speed": (RELEASE, f"{RELEASE}\n    speeds: [-5]", "requirements.decay.speeds.0", "-5 is out of range"),
    "decay beyond the envelope": (RELEASE, f"{RELEASE}\n    speeds: [200]", "requirements.decay.speeds.0", "5 to 100 m/s"),
    "empty decay": (RELEASE, f"{RELEASE}\n    speeds:", "requirements.decay.speeds", "found nothing; allowed"),
    "empty freeplay": (
        PLANAR,
        f"freeplay:\n  {PLANAR}",
        "damper.freeplay",
        "found nothing; allowed: a mapping with",
    ),
    "rigid compliance": (PLANAR, f"series_stiffness: 1e14\n  {PLANAR}", "damper.series_stiffness", "<= 1e+10 N/m"),
    "speed of light": ("max: 100 m/s", "max: 3e8 m/s", "envelope.speed.max", "<= 10000 m/s"),
    "cycles in quotes": ("cycles: 3", "cycles: '3'", "requirements.decay.cycles", "a whole number, >= 1 and <= 100"),
    "one decay speed": (RELEASE, f"{RELEASE}\n    speeds: 40", "requirements.decay.speeds", "found 40"),
    "limit event": (MARGIN, f"limit_event: wheel\n  {MARGIN}", "requirements.limit_event", "'torque' or 'simulated'"),
    "no gap": (PLANAR, f"freeplay: {{gap: 0}}\n  {PLANAR}", "damper.freeplay.gap", "0 is out of range"),
    "negative gap": (PLANAR, f"freeplay: {{gap: -1 mm}}\n  {PLANAR}", "damper.freeplay.gap", "-1 mm (= -0.001 m) is out"),
    "all corner": (PLANAR, f"freeplay: {{gap: 1 mm, smoothing: 0.6}}\n  {PLANAR}", "damper.freeplay.smoothing", "0.6 is out"),
    "stop at rest": (PLANAR, f"end_stop: {{stroke: 0}}\n  {PLANAR}", "damper.end_stop.stroke", "0 is out of range"),
    "soft stop": (PLANAR, f"end_stop: {{stroke: 1 mm, stiffness: -1}}\n  {PLANAR}", "damper.end_stop.stiffness", "-1 is out"),
    "stop without stroke": (PLANAR, f"end_stop: {{stiffness: 1}}\n  {PLANAR}", "damper.end_stop.stroke", "missing key"),
    "orifice that pushes": (PLANAR, f"orifice: {{coefficient: -1}}\n  {PLANAR}", "damper.orifice.coefficient", "-1 is out"),
    "linear orifice": (PLANAR, f"orifice: {{coefficient: 1 N s/m}}\n  {PLANAR}", "damper.orifice.coefficient", "dimension"),
    "negative compliance": (PLANAR, f"series_stiffness: -1\n  {PLANAR}", "damper.series_stiffness", "-1 is out of range"),
    "rotational links": ("topology: arreaza", f"{ROTATIONAL}link_stiffness: 1 MN/m", "damper.link_stiffness", "another kind"),
    "rotational gap": ("topology: arreaza", f"{ROTATIONAL}freeplay: {{gap: 1 mm}}", "damper.freeplay.gap", "another dimension"),
    "geometry": ("geometry: planar", "geometry: spacial", "damper.geometry", "'published', 'planar' or 'spatial'"),
    "no friction": (RADIUS, f"friction: {{torque: 0}}\n  {RADIUS}", "gear.friction.torque", "0 is out of range"),
    "friction force": (RADIUS, f"friction: {{torque: 1 N}}\n  {RADIUS}", "gear.friction.torque", "another dimension"),
    "no slip": ("tyre:\n", "tyre:\n  slip_range: 0 deg\n", "tyre.slip_range", "0 deg (= 0 rad) is out of range"),
    "all slip": ("tyre:\n", "tyre:\n  slip_range: 90 deg\n", "tyre.slip_range", "90 deg (= 1.5708 rad) is out of range"),
    "engine": (NAME, f"{NAME}\nsolver: {{engine: rk4}}", "solver.engine", "'auto', 'erk', 'cvodes' or 'idas'"),
    "tolerance": (NAME, f"{NAME}\nsolver: {{integration_tolerance: 1}}", "solver.integration_tolerance", "1 is out of range"),
    "no reserve": (NAME, f"{NAME}\nsolver: {{decay_reserve: 0}}", "solver.decay_reserve", "0 is out of range"),
    "all reserve": (NAME, f"{NAME}\nsolver: {{decay_reserve: 1}}", "solver.decay_reserve", "1 is out of range"),
    "contact line": ("contact: leading_point", "contact: {kind: memori}", "tyre.contact.kind:", "'memori' is unknown"),
    "one speed": (NAME, f"{NAME}\nsolver: {{decay_speeds: 1}}", "solver.decay_speeds", "found 1; input should be"),
}


@pytest.mark.parametrize("case", BROKEN)
def test_message_names_file_line_key_and_what_is_allowed(case, configs):
    old, new, key, says = BROKEN[case]
    text = (configs / "thesis_gear.yaml").read_text()
    assert text.count(old) >= 1, "the test looks for text that is no longer in the config"
    with pytest.raises(damperopt.ConfigError) as error:
        damperopt.loads(text.replace(old, new, 1), "study.yaml")
    messages = error.value.problems
    matching = [m for m in messages if says in m]
    assert matching, messages
    assert re.match(rf"study\.yaml:\d+: {re.escape(key)}", matching[0])
    assert "allowed" in matching[0] or case == "yaml"


def test_simulated_limit_event_needs_motions_to_simulate(configs):
    """Without the block decay there is nothing to take the peaks from; the message says so under its key."""
    text = (configs / "thesis_gear.yaml").read_text()
    start, end = text.index("  decay:"), text.index("  lug_distance:")
    with pytest.raises(
        damperopt.ConfigError, match=r"study\.yaml:\d+: requirements\.decay: missing key; allowed: the block decay"
    ):
        damperopt.loads(text[:start] + "  limit_event: simulated\n" + text[end:], "study.yaml")


def test_line_is_that_of_the_key(configs):
    text = (configs / "thesis_gear.yaml").read_text().replace("0.3 m ", "0.3 kg ", 1)
    line = next(i for i, row in enumerate(text.splitlines(), 1) if "0.3 kg" in row)
    with pytest.raises(damperopt.ConfigError, match=f"study.yaml:{line}: "):
        damperopt.loads(text, "study.yaml")


def test_all_problems_are_reported_at_once(configs):
    text = (configs / "thesis_gear.yaml").read_text()
    text = text.replace("0.3 m ", "0.3 kg ", 1).replace("caster_length:", "caster:", 1)
    with pytest.raises(damperopt.ConfigError) as error:
        damperopt.loads(text)
    assert len(error.value.problems) == 3  # wrong dimension, unknown key, missing key


@pytest.mark.parametrize("text", ["", "- a\n- b\n", "hello", "name: x", "a: *b", "\t", "name: \x00", "? [a, b]\n: c", "1: 2"])
def test_files_that_are_no_study_are_refused(text):
    with pytest.raises(damperopt.ConfigError):
        damperopt.loads(text)


def test_numbers_may_be_written_as_engineers_do(configs, main_gear):
    text = (configs / "thesis_gear.yaml").read_text().replace("max: 1e7 N s/m", "max: 1e7").replace("150 kN", "1.5E+5", 1)
    study = damperopt.loads(text)
    assert study.design.c_lambda.max == 1e7
    assert study.envelope.loads == main_gear.envelope.loads


def test_replace_checks_the_new_study(main_gear):
    assert main_gear.replace(damper__topology="utas").damper.topology == "utas"
    for bad in ({"gear__mass": 1.0}, {"gear__yaw_inertia": float("nan")}, {"envelope__speed__min": 1e9}):
        with pytest.raises(damperopt.ConfigError, match=next(iter(bad)).replace("__", ".").rsplit(".min")[0]):
            main_gear.replace(**bad)

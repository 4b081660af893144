"""Loads and factors in a file: what passes, and one message for what does not."""

import pytest

import damperopt


@pytest.fixture(scope="module")
def text(configs):
    return (configs / "minimal.yaml").read_text()


@pytest.mark.parametrize(
    ("block", "where", "says"),
    [
        ("{gear: tail}", "loads.gear", "'main' or 'nose'"),
        ("{landing_vertical: 300 kg}", "loads.landing_vertical", "another dimension"),
        ("{cases: {turning: {sid: 0.6}}}", "loads.cases.turning.sid", "did you mean 'side'"),
        ("{cases: {turning: {side: -1}}}", "loads.cases.turning.side", "out of range"),
        ("{cases: {turning: {kind: towing}}}", "loads.cases.turning.kind", "under the name of another case"),
        ("{cases: {turning: 3}}", "loads.cases.turning", "found 3 instead of a block"),
        ("{cases: [turning, hopping]}", "loads.cases.1", "'hopping' is no load case"),
        ("{cases: []}", "loads.cases", "no case is left"),
        ("{cases: {hopping: true}}", "loads.cases.hopping", "'hopping' is no load case"),
        ("{cases: {hopping: {vertical: 3 kN}}}", "loads.cases.hopping.kind", "missing key"),
        ("{cases: {hopping: {kind: given}}}", "loads.cases.hopping.vertical", "missing key"),
        ("{cases: {towing: true}}", "loads.cases.towing", "enabled without aircraft_weight"),
        ("{cases: {nose_steering: true}}", "loads.cases.nose_steering.enabled", "without its torque"),
    ],
)
def test_what_is_wrong_is_said_once(text, block, where, says):
    with pytest.raises(damperopt.ConfigError) as error:
        damperopt.loads(f"{text}\nloads: {block}\n")
    (problem,) = error.value.problems
    assert f": {where}: " in problem
    assert says in problem


def test_cases_are_switched_changed_and_added(text):
    block = """
loads:
  aircraft_weight: 60000 lb
  cases:
    towing: true
    side_load: false
    turning: {side: 0.6}
    hard landing: {kind: given, by: our report 12, vertical: 80 kN, side: 20 kN, loads_are: ultimate}
"""
    study = damperopt.loads(text + block)
    cases = study.loads.all_cases
    assert cases["towing"].enabled
    assert cases["side_load"].enabled is False
    assert cases["turning"].side == 0.6
    assert cases["hard landing"].rule == "our report 12"
    assert list(cases)[-1] == "hard landing"
    assert damperopt.Study.model_validate(study.model_dump(exclude_none=True)) == study
    assert damperopt.Study.model_validate_json(study.model_dump_json(exclude_none=True)) == study


def test_factor_on_yield_keeps_its_older_name(text):
    plain = text.replace("  limit_factor: 1.5\n", "")
    assert damperopt.loads(plain).required.limit_factor == 1.0
    old = damperopt.loads(plain.replace("requirements:", "requirements:\n  safety_factor: 1.2"))
    assert (old.required.limit_factor, old.required.safety_factor) == (1.2, 1.2)
    again = damperopt.Study.model_validate(old.model_dump(exclude_none=True))
    assert again == old
    for key in ("limit_factor", "safety_factor"):
        changed = old.replace(**{f"requirements__{key}": 1.4})
        assert (changed.required.limit_factor, changed.required.safety_factor) == (1.4, 1.4)


def test_factor_on_yield_is_given_once(text):
    with pytest.raises(damperopt.ConfigError, match="safety_factor: another number than limit_factor"):
        damperopt.loads(text.replace("requirements:", "requirements:\n  safety_factor: 1.2"))


def test_factors_below_one_are_refused(text):
    for key in ("ultimate_factor", "safety_factor"):
        with pytest.raises(damperopt.ConfigError) as error:
            damperopt.loads(text.replace("  limit_factor: 1.5\n", f"  {key}: 0.9\n"))
        (problem,) = error.value.problems
        assert f"requirements.{key}: 0.9 is out of range" in problem


@pytest.mark.parametrize(
    ("lug", "says"),
    [
        ("{edge: 0.8}", r"mass\.lug\.edge: 0\.8 is 1\.33 bores.*1\.5 bores \(0\.9\)"),
        ("{width: 0.6}", r"mass\.lug\.width: .*beside the bore"),
    ],
)
def test_an_eye_is_one_that_strengths_hold_for(text, tmp_path, lug, says):
    path = tmp_path / "study.yaml"
    path.write_text(f"{text}\nmass: {{lug: {lug}}}\n")
    with pytest.raises(damperopt.ConfigError, match=says):
        damperopt.load(path)

"""Every load case, those of other distributions included: its rule is stated, and more load is never less torque."""

import inspect
from dataclasses import replace

import casadi as ca
import pytest
import standard

from damperopt.load_cases.base import Context
from damperopt.study.components import rooms

KINDS = rooms()["load cases"]

FULL = Context(
    largest_vertical=150e3,
    e_eff=0.12,
    trail=0.03,
    half_contact_length=0.1,
    wheel_radius=0.4,
    half_track=0.2,
    wheels=2,
    landing_vertical=300e3,
    static_reaction=150e3,
    aircraft_weight=250e3,
    brake_torque=20e3,
    unsprung_mass=200.0,
    tyre_moment=8e3,
    shimmy_torque=3e3,
)
NUMBERS = [name for name, value in vars(FULL).items() if isinstance(value, float)]


@pytest.fixture(params=KINDS)
def case(request):
    kind = KINDS[request.param]
    asked = {"torque": 5e3} if request.param == "nose_steering" else {}
    return kind.model_validate(standard.example(kind) | {"kind": request.param} | asked)


def test_it_says_its_rule_and_whether_it_was_read(case):
    assert case.rule
    assert inspect.getdoc(case)
    assert case.level in ("limit", "ultimate")
    assert case.nature in ("static", "dynamic")
    assert set(case.NEEDS) <= set(vars(FULL))
    assert set(case.GEARS) <= {"main", "nose"}
    for gear in ("main", "nose"):
        counts = not case.off(replace(FULL, gear=gear))
        assert counts == (gear in case.GEARS and bool(case.READ))


def test_switched_off_it_does_not_count_and_without_numbers_it_says_them(case):
    assert case.model_copy(update={"enabled": False}).off(FULL)
    for name in case.NEEDS:
        lacking = replace(FULL, **{name: None})
        assert name in case.off(lacking)
        assert case.loads(lacking) is None


@pytest.mark.parametrize("name", NUMBERS)
def test_more_is_never_less_torque(case, name):
    """In every number of the gear but the radius of the wheel, on which a brake's force rests."""
    if name == "wheel_radius":
        return
    before = case.loads(FULL).yaw_torque
    assert case.loads(replace(FULL, **{name: 1.3 * getattr(FULL, name)})).yaw_torque >= before


def test_symbols_give_the_floats(case):
    symbols = {name: ca.SX.sym(name) for name in NUMBERS}
    loads = case.loads(replace(FULL, **symbols))
    numbers = [loads.vertical, loads.side, loads.drag, loads.yaw_torque]
    found = ca.Function("loads", list(symbols.values()), [ca.SX(number) for number in numbers])
    floats = case.loads(FULL)
    expected = floats.vertical, floats.side, floats.drag, floats.yaw_torque
    values = found(*(getattr(FULL, name) for name in NUMBERS))
    assert tuple(float(value) for value in values) == pytest.approx(expected, rel=standard.ROUNDING)


def test_it_survives_a_file(case):
    block = {"cases": {"mine" if case.kind == "given" else case.kind: case.model_dump(exclude_none=True)}}
    study = standard.study_of(loads=block)
    standard.record_survives(study)

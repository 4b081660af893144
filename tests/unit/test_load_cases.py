"""Load cases against the rules' own numbers, worked by hand; scrub against quadrature."""

import math
from pathlib import Path
from types import SimpleNamespace

import casadi as ca
import pytest
from scipy.integrate import quad
from tolerances import QUADRATURE, ROUNDING

import damperopt
from damperopt.load_cases.base import Context, Loads, Row, load_cases, load_table, standard_cases, trail_left, worst_torque
from damperopt.load_cases.handling import POUND, scrub_radius, towing_force
from damperopt.symbols import data_values, symbolic

MAIN = Context(largest_vertical=150e3, e_eff=0.12, trail=0.03, half_contact_length=0.1, wheel_radius=0.4)
"""Main gear, 150 kN as the vertical of every case; twice that in a landing is the same for a rule that takes half."""


@pytest.fixture(scope="module")
def main_gear(main_gear):
    """With the rules' cases, and their factor from limit to ultimate load."""
    return main_gear.replace(loads__cases={}, requirements__ultimate_factor=1.5)


def rows_of(study):
    return {row.name: row for row in study.loads.table(study)}


def limit_torque(study, **shimmy):
    return study.loads.limit_torque(study, **shimmy)


def service_torque(study):
    return study.loads.service_torque(study)


def loads_of(kind, context=MAIN, **numbers):
    return load_cases()[kind](kind=kind, **numbers).loads(context)


# 14 CFR 25.485(b), read at lexbuild.dev and faraim.org: 0.8 inward, with half of the largest vertical of level landing
def test_side_load_is_14400_newton_metres_at_150_kilonewton():
    given = Context(**{**vars(MAIN), "landing_vertical": 300e3})
    for context in (MAIN, given):
        loads = loads_of("side_load", context)
        assert (loads.vertical, loads.side, loads.drag) == pytest.approx((150e3, 120e3, 0.0))
        assert loads.yaw_torque == pytest.approx(0.8 * 150e3 * 0.12)
    assert loads_of("side_load", side=0.6).side == pytest.approx(90e3)  # outward


# 14 CFR 25.479(d)(2)(i), read at lawstack.com: 75 % of the largest vertical, drag 40 % and side 25 % of that
def test_drift_landing():
    loads = loads_of("drift_landing", Context(**{**vars(MAIN), "landing_vertical": 300e3, "trail": 0.0}))
    assert (loads.vertical, loads.side, loads.drag) == pytest.approx((225e3, 56.25e3, 90e3))
    assert loads.yaw_torque == pytest.approx(56.25e3 * 0.12)


# 14 CFR 25.511(e), read at faraim.org: not below 1 g, 50 % of 0.5 to the side, drag at each inflated tyre as without a flat one
def test_flat_tyre():
    assert load_cases()["flat_tyre"](kind="flat_tyre").off(MAIN) == "needs two wheels"
    twin = Context(**{**vars(MAIN), "wheels": 2, "half_track": 0.4, "trail": 0.0})
    loads = loads_of("flat_tyre", twin)
    assert (loads.vertical, loads.side, loads.drag) == pytest.approx((150e3, 37.5e3, 60e3))
    assert loads.yaw_torque == pytest.approx(37.5e3 * 0.12 + 60e3 * 0.4)
    assert loads_of("flat_tyre", Context(**{**vars(twin), "gear": "nose"})).drag == 0


# 14 CFR 25.487(b), read at faraim.org: load factor 20 on the unsprung weight
def test_rebound_loads_the_strut_alone():
    assert loads_of("rebound") is None
    loads = loads_of("rebound", Context(**{**vars(MAIN), "unsprung_mass": 200.0}))
    assert loads.vertical == pytest.approx(20 * 200 * 9.80665)
    assert loads.yaw_torque == 0


# 14 CFR 25.493, faraim.org: drag 0.8 of the vertical at 1.0 g and ramp weight
def test_braked_roll_turns_only_a_gear_with_two_wheels():
    assert loads_of("braked_roll").drag == pytest.approx(120e3)
    assert loads_of("braked_roll").yaw_torque == 0
    twin = Context(**{**vars(MAIN), "half_track": 0.2, "wheels": 2})
    assert loads_of("braked_roll", twin).yaw_torque == pytest.approx(0.8 * 150e3 * 0.2)
    assert loads_of("braked_roll", twin, load_factor=1.2).yaw_torque == pytest.approx(1.2 * 0.8 * 150e3 * 0.2)


# 14 CFR 25.495, lexbuild.dev: side force of half the vertical on each wheel
def test_turning_keeps_some_pneumatic_trail():
    loads = loads_of("turning")
    assert loads.side == pytest.approx(75e3)
    # brush tyre at u = 0.5/0.8: (1 - s)^3 = 1 - u, t = a s (1 - s)^3/u against a/3 at small slip
    s = 1 - (1 - 0.625) ** (1 / 3)
    assert loads.yaw_torque == pytest.approx(75e3 * (0.12 + 0.03 * 3 * s * 0.375 / 0.625), rel=ROUNDING)
    assert loads_of("turning", Context(**{**vars(MAIN), "trail": 0.0})).yaw_torque == pytest.approx(9000)


# 14 CFR 25.503, pilotfriend.com: 1.0 g, friction 0.8, brakes locked
def test_pivoting_scrubs_6000_newton_metres():
    assert loads_of("pivoting").yaw_torque == pytest.approx(0.8 * 150e3 * 0.05)
    assert loads_of("pivoting", pressure="parabolic").yaw_torque == pytest.approx(0.8 * 150e3 * 0.0375)


# 14 CFR 25.507, faraim.org: 0.55 of the vertical, or 1.2 times the nominal maximum static brake torque if that is less
@pytest.mark.parametrize(("brake_torque", "drag"), [(None, 82.5e3), (20e3, 60e3), (30e3, 82.5e3)])
def test_reversed_braking_takes_the_less(brake_torque, drag):
    assert loads_of("reversed_braking", Context(**{**vars(MAIN), "brake_torque": brake_torque})).drag == pytest.approx(drag)


# 14 CFR 25.509(a)(3), faraim.org; (6 W + 450 000)/7, as two copies print it, would jump at 30 000 lb
@pytest.mark.parametrize("pounds", [30e3, 100e3])
def test_tow_force_is_continuous(pounds):
    below, above = (towing_force(pounds * (1 + step) * POUND) for step in (-1e-9, 1e-9))
    assert above == pytest.approx(below, rel=1e-8)


def test_tow_force_of_a_middling_aircraft():
    assert towing_force(70e3 * POUND) == pytest.approx((6 * 70e3 + 450e3) / 70 * POUND)


def test_towing_at_thirty_degrees():
    assert loads_of("towing") is None
    loads = loads_of("towing", Context(**{**vars(MAIN), "aircraft_weight": 60e3 * POUND}))
    force = 0.75 * (6 * 60e3 + 450e3) / 70 * POUND
    assert (loads.side, loads.drag) == pytest.approx((force / 2, force * math.sqrt(0.75)))
    assert loads.yaw_torque == pytest.approx(force / 2 * 0.12)


@pytest.mark.parametrize("half_track", [0.02, 0.1, 0.5])
def test_scrub_of_two_wheels_against_quadrature(half_track):
    a = 0.13
    mean = quad(lambda x: math.hypot(x, half_track), 0, a, epsabs=0)[0] / a
    weighed = quad(lambda x: 1.5 / a * (1 - (x / a) ** 2) * math.hypot(x, half_track), 0, a, epsabs=0)[0]
    assert scrub_radius(a, half_track) == pytest.approx(mean, rel=QUADRATURE)
    assert scrub_radius(a, half_track, "parabolic") == pytest.approx(weighed, rel=QUADRATURE)
    assert scrub_radius(a, 1e-9) == pytest.approx(scrub_radius(a), rel=1e-6)


def test_trail_vanishes_at_the_friction_limit_and_beyond():
    assert trail_left(0.8) == trail_left(0.6, 0.6) == 0.0
    assert 0 < trail_left(0.25, 0.4) < trail_left(0.25) < trail_left(0.0) == 1.0


def test_tyre_moment_is_given_or_a_factor_on_the_tyre():
    with_peak = Context(**{**vars(MAIN), "tyre_moment": 8e3})
    assert loads_of("tyre_moment") is None
    assert loads_of("tyre_moment", with_peak).yaw_torque == pytest.approx(12e3)
    assert loads_of("tyre_moment", with_peak, factor=2.0).yaw_torque == pytest.approx(16e3)
    asked = Context(**{**vars(with_peak), "limit_torque": 9e3})
    assert loads_of("tyre_moment", asked).yaw_torque == 9e3
    assert loads_of("tyre_moment", asked, torque=7e3).yaw_torque == 7e3


def test_main_gear_is_sized_by_its_side_load(main_gear):
    rows = rows_of(main_gear)
    assert not rows["side_load"].off
    assert limit_torque(main_gear) == pytest.approx(14400)
    assert service_torque(main_gear) == pytest.approx(3600)
    assert "aircraft_weight" in rows["towing"].off
    assert "main" not in rows["nose_yaw"].off
    assert "nose gear" in rows["nose_yaw"].off
    tyre = 150e3 * math.radians(10) / math.pi  # C_M = 1, and a side force of 177 N on 0.12 m
    assert rows["tyre_moment"].loads.yaw_torque == pytest.approx(1.5 * tyre, rel=3e-3)


def test_todays_loads_are_one_case(main_gear):
    thesis = main_gear.replace(loads__cases=["tyre_moment"])
    assert [name for name, row in rows_of(thesis).items() if not row.off] == ["tyre_moment"]
    assert limit_torque(thesis.replace(requirements__limit_torque=10e3)) == 10e3
    assert service_torque(thesis.replace(requirements__service_torque=1e3)) == 1e3


@pytest.mark.parametrize(
    "more",
    [
        {"requirements__limit_torque": 50e3},
        {"requirements__limit_torque_factor": 3.0},
        {"requirements__limit_factor": 2.0},
        {"requirements__ultimate_factor": 2.0},
        {"loads__landing_vertical": 900e3},
        {"loads__static_reaction": 400e3},
        {"loads__aircraft_weight": 2e6},
        {"loads__cases": {"turning": {"side": 0.9}}},
        {"loads__cases": {"mine": {"kind": "given", "vertical": 1e5, "torque": 60e3}}},
        {"loads__cases": ["tyre_moment"]},
    ],
)
def test_no_limit_load_and_no_factor_makes_a_stroke_easier_to_have(main_gear, more):
    assert service_torque(main_gear.replace(**more)) == service_torque(main_gear)


def test_nose_gear_has_its_own_rules_and_what_was_not_read_is_off(main_gear):
    rows = rows_of(main_gear.replace(loads__gear="nose"))
    assert "main gear" in rows["side_load"].off
    assert "has not been read" in rows["nose_yaw"].off
    assert not rows["turning"].off
    asked = main_gear.replace(loads__gear="nose", loads__cases={"nose_yaw": True})
    assert limit_torque(asked) == pytest.approx(14400)


def test_shimmy_is_one_case_and_never_replaces_the_others(main_gear):
    assert limit_torque(main_gear, shimmy_torque=2e3) == pytest.approx(14400)
    assert limit_torque(main_gear, shimmy_torque=20e3) == 20e3
    assert service_torque(main_gear) == pytest.approx(3600)  # static loads alone


def test_an_ultimate_case_counts_by_its_part_at_limit():
    loads = Loads(10e3, moment=18e3)
    table = (
        Row("mine", "", "", loads, "ultimate", "static"),
        Row("off", "", "", Loads(1.0, moment=1e6), "limit", "static", "off"),
    )
    assert worst_torque(table) == pytest.approx(12e3)


def test_trail_of_a_tyre_is_inside_its_footprint(main_gear):
    assert main_gear.loads.context(main_gear).trail == 0.1  # 71 m by the thesis' coefficients
    brush = damperopt.load(Path(damperopt.__file__).with_name("starter.yaml"))
    assert brush.loads.context(brush).trail == pytest.approx(0.1 / 3)


def test_numbers_of_a_study_enter_as_symbols(main_gear):
    study = main_gear.replace(loads__landing_vertical=280e3, loads__aircraft_weight=3e5, loads__static_reaction=140e3)
    twin = symbolic(study)
    torques = [twin.study.loads.limit_torque(twin.study), twin.study.loads.service_torque(twin.study)]
    found = ca.Function("torques", [twin.data], [*torques, ca.jacobian(torques[0], twin.data)])(data_values(study))
    assert [float(value) for value in found[:2]] == pytest.approx([0.8 * 140e3 * 0.12, 3600.0], rel=ROUNDING)
    slopes = dict(zip(twin.names, found[2].full().ravel(), strict=True))
    moved = {name: slope for name, slope in slopes.items() if slope}
    lever = {"gear.caster_length": 0.8 * 140e3, "gear.rake_angle": 0.8 * 140e3 * 0.362}  # e_eff = e cos + (R_w + ..) tan
    assert moved == pytest.approx(lever | {"loads.landing_vertical": 0.4 * 0.12})


def test_two_wheels_share_the_load(main_gear):
    axle = SimpleNamespace(half_track=0.2)
    wheels = [SimpleNamespace(load=75e3, pressure=None)] * 2
    gear = SimpleNamespace(
        axle=axle, states=lambda: (), wheels=lambda x, speed, load: wheels, wheel_radius=0.4, lever=lambda: 0.12
    )
    brush = damperopt.load(Path(damperopt.__file__).with_name("starter.yaml"))
    loads, tyre, required = main_gear.loads, brush.tyre, main_gear.requirements
    twin = SimpleNamespace(gear=gear, tyre=tyre, envelope=main_gear.envelope, requirements=required, loads=loads)
    context, peaks = loads.context(twin), tyre.peaks(75e3, None)
    assert (context.wheels, context.half_track, context.largest_vertical) == (2, 0.2, 150e3)
    assert context.tyre_moment == pytest.approx(2 * (peaks.aligning_moment + 0.12 * peaks.side_force))
    assert rows_of(twin)["braked_roll"].loads.yaw_torque == pytest.approx(0.8 * 150e3 * 0.2)


def test_symbols_are_taken_as_well():
    names = ("largest_vertical", "e_eff", "trail", "half_contact_length", "half_track", "aircraft_weight", "brake_torque")
    values = (150e3, -0.12, 0.03, 0.1, 0.2, 60e3 * POUND, 20e3)
    symbols = {name: ca.SX.sym(name) for name in names}
    rest = {"wheels": 2, "wheel_radius": 0.4, "tyre_moment": 8e3}
    of_symbols = load_table(standard_cases(), Context(**symbols, **rest))
    of_floats = load_table(standard_cases(), Context(**dict(zip(names, values, strict=True)), **rest))
    found = ca.Function("torques", list(symbols.values()), [worst_torque(of_symbols), *(r.limit_torque() for r in of_symbols)])
    expected = (worst_torque(of_floats), *(row.limit_torque() for row in of_floats))
    assert [float(value) for value in found(*values)] == pytest.approx(expected, rel=ROUNDING)

"""Sizes and margins of a report: those from which the masses and the limits of the result follow."""

import itertools
import math
from functools import cache

import numpy as np
import pytest
from components_of import damper_block

import damperopt
from damperopt.output import facts
from damperopt.quantities.shown import as_written, rounded, shown
from damperopt.stability.modes import ModeTable

LAYOUTS = ("boeing", "arreaza")


@pytest.fixture(scope="module")
def optimum(main_gear):
    """Study and result of a layout, rigid from the top or elastic in space; each is found once."""

    @cache
    def of(topology, block):
        damper = damper_block(topology) if block == "rigid" else {"topology": topology}
        study = main_gear.replace(damper=damper, solver__starts=1)
        return study, damperopt.optimise(study)

    return of


@pytest.fixture(params=LAYOUTS)
def solved(request, optimum):
    return optimum(request.param, "rigid")


@pytest.fixture(params=LAYOUTS)
def elastic(request, optimum):
    return optimum(request.param, "elastic")


@pytest.fixture(params=itertools.product(LAYOUTS, ("rigid", "elastic")), ids=" ".join)
def either(request, optimum):
    return optimum(*request.param)


def by_name(found):
    return {(size.part, size.words): size for size in found}


def test_damper_of_the_report_weighs_what_the_result_says(either):
    """Cylinder, rod, caps and oil of the sizes shown, with the caps as clamped plates."""
    study, result = either
    sizes, model, steel = by_name(facts.sizes(study, result)), study.mass, study.mass.damper_material
    sigma, p = steel.yield_strength / study.required.safety_factor, model.working_pressure
    D, t, length = (sizes["damper cylinder", words].value for words in ("bore", "wall", "length of cylinder and rod"))
    rod = sizes["damper rod", "diameter, against yield"].value
    cap = model.wall_allowance + D / 2 * math.sqrt(0.75 * p / sigma)
    volume = math.pi * (D + t) * t * length + math.pi / 4 * rod**2 * length + math.pi / 2 * (D + 2 * t) ** 2 * cap
    piston = result.limit_event["damper_force"] / sizes["damper cylinder", "peak pressure"].value
    assert math.pi / 4 * (D**2 - rod**2) == pytest.approx(piston, rel=1e-9)
    oil = model.oil_density * piston * length
    mass = steel.density * volume * (1 + model.damper_fittings_fraction) + oil
    fixed = model.damper_fixed_mass if "A_piston" in result.design else 0.0
    assert mass + fixed == pytest.approx(result.mass.parts["damper"], rel=1e-9)


def test_links_of_the_report_weigh_what_the_result_says(solved):
    """Tapered tubes: cantilever_taper times the prism of the root."""
    study, result = solved
    sizes, model = by_name(facts.sizes(study, result)), study.mass
    names = [part for part, words in sizes if "torque link" in part and words == "outer diameter"]
    assert len(names) == (2 if result.topology == "boeing" else 1)
    root, wall = (sizes[names[0], words].value for words in ("outer diameter", "wall"))
    area = math.pi / 4 * (root**2 - (root - 2 * wall) ** 2)
    prism = study.material.density * area * result.design["L"] * (1 + model.link_fittings_fraction)
    assert len(names) * model.cantilever_taper * prism == pytest.approx(result.mass.parts["torque links"], rel=1e-9)


def tube(sizes, part):
    """Area of the tube that is shown [m^2]."""
    outer, wall = (sizes[part, words].value for words in ("outer diameter", "wall"))
    return math.pi / 4 * (outer**2 - (outer - 2 * wall) ** 2)


def test_legs_of_the_report_weigh_what_the_result_says(elastic):
    """From feet that are half the link apart: two for each link, two of the support for a damper b to the side."""
    study, result = elastic
    sizes, L = by_name(facts.sizes(study, result)), result.design["L"]
    per_length = study.material.density * (1 + study.mass.link_fittings_fraction)
    links = 2 if result.topology == "boeing" else 1
    legs = per_length * tube(sizes, "torque links, each leg") * 2 * math.hypot(L, L / 4)
    assert links * legs == pytest.approx(result.mass.parts["torque links"], rel=1e-9)
    if result.topology == "arreaza":
        lengths = [math.hypot(L, result.design["b"] + side * L / 4) for side in (-1, 1)]
        support = per_length * tube(sizes, "support, each leg") * sum(lengths)
        assert support == pytest.approx(result.mass.parts["support"], rel=1e-9)


def test_margins_of_legs_are_those_of_the_constraints(elastic):
    """Stress falls with the area, Euler's load grows with its square."""
    study, result = elastic
    sizes, rows = by_name(facts.sizes(study, result)), {c.name: c for c in result.constraints}
    parts = {"link": "torque links, each leg", "support": "support, each leg"}
    for kind, part in parts.items() if result.topology == "arreaza" else [("link", parts["link"])]:
        over = {
            check: rows[f"{kind}_{check}"].value / rows[f"{kind}_{check}"].limit for check in ("limit", "ultimate", "buckling")
        }
        expected = min(over["limit"], over["ultimate"], over["buckling"] ** 2) - 1
        assert sizes[part, "outer diameter"].margin == pytest.approx(expected, abs=1e-9)
    if "arm_stress" in rows:
        expected = min(rows[name].limit / rows[name].value for name in ("arm_stress", "arm_ultimate")) - 1
        assert sizes["bending arm", "outer diameter"].margin == pytest.approx(expected, abs=1e-9)


def test_margins_of_safety_are_those_of_the_constraints(solved):
    study, result = solved
    sizes, rows = by_name(facts.sizes(study, result)), {c.name: c for c in result.constraints}
    rod = rows["rod_yield"].value
    assert sizes["damper rod", "diameter, against yield"].margin == pytest.approx((rod / rows["rod_yield"].limit) ** 2 - 1)
    assert sizes["damper rod", "diameter, against buckling"].margin == pytest.approx(
        (rod / rows["rod_buckling"].limit) ** 4 - 1
    )
    if "arm_stress" in rows:
        margin = rows["arm_stress"].limit / rows["arm_stress"].value - 1
        assert sizes["bending arm", "outer diameter"].margin == pytest.approx(margin, abs=1e-9)


def test_least_damping_is_found_over_speeds_and_loads():
    roots = np.array([[-1 + 10j, -1 - 10j, -5], [-0.5 + 10j, -0.5 - 10j, -5]])
    tables = [
        ModeTable(np.array([10.0, 20.0]), load, ("torsional",) * 2 + ("string",), shift * roots)
        for load, shift in ((1e4, 1.0), (2e4, 2.0))
    ]
    (least,) = facts.least_damping(tables)
    assert (least.mode, least.speed, least.load) == ("torsional", 20.0, 1e4)
    assert least.ratio == pytest.approx(0.5 / math.hypot(0.5, 10))


def test_next_critical_speed_is_the_first_that_destabilises_beyond_the_envelope(main_gear):
    """The start of the main gear turns unstable somewhere; an envelope that ends below meets that speed next."""
    study = main_gear
    gear = damperopt.linear_gear(study)
    first = next(
        c.speed
        for c in damperopt.critical_speeds(gear, max(study.envelope.loads), 0.5, 200.0)
        if c.boundary and c.destabilising
    )
    short = study.replace(envelope__speed={"min": 0.3 * first, "max": 0.6 * first})
    assert facts.next_critical_speed(short, gear).speed == pytest.approx(first, rel=1e-9)
    far = study.replace(envelope__speed={"min": 0.01 * first, "max": 0.02 * first})
    assert facts.next_critical_speed(far, gear) is None


@pytest.mark.parametrize(
    ("values", "unit", "expected"),
    [
        ([1852 / 3600, 120 * 1852 / 3600], "m/s", (["1", "120"], "kt")),
        ([10 / 3.6, 250 / 3.6], "m/s", (["10", "250"], "km/h")),
        ([0.05, 2.0], "m/s", (["0.05", "2"], "m/s")),
        ([5000 * 4.4482216152605], "N", (["5000"], "lbf")),
        ([22e3, 150e3], "N", (["22", "150"], "kN")),
        ([math.pi, 10.0], "m/s", (["3.1416", "10"], "m/s")),
    ],
)
def test_questions_come_back_in_their_own_unit(values, unit, expected):
    assert as_written(values, unit) == expected


def test_results_have_one_unit_and_no_offset():
    assert shown(3.4e-6, "m^4") == ("3 400 000", "mm⁴")
    assert shown(0.35, "1") == ("0.35", "")
    assert [rounded(value) for value in (99999.9, 9999.94, 0.1 + 0.2, 1e-12, -5e4)] == [
        "100 000",
        "9 999.9",
        "0.3",
        "1e-12",
        "-50 000",
    ]

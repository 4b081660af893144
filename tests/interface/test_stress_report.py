"""What a stress engineer reads: load table, margins of safety and parts list of a gear whose parts give way."""

import html
import json
import math
import re
from io import StringIO

import numpy as np
import pytest
from rich.console import Console

import damperopt
from damperopt.commands.design_summary import show_design
from damperopt.figures.design import bounding
from damperopt.optimum.region import FeasibleRegion
from damperopt.output import facts, margins, write_report
from damperopt.output.gallery import figures_of
from damperopt.results import LoadRow, MarginRow


@pytest.fixture(scope="module")
def solved(request):
    study = damperopt.load(request.config.rootpath / "configs" / "main_gear.yaml")
    study = study.replace(requirements__decay=None, solver__starts=1)
    return study, damperopt.optimise(study)


@pytest.fixture(scope="module")
def page(solved, tmp_path_factory):
    folder, result = tmp_path_factory.mktemp("page"), solved[1]
    (folder / "result.json").write_text(result.to_json())
    for figure in figures_of(result):
        (folder / f"{figure.name}.svg").write_text("<svg/>")  # what is there is not drawn
    return write_report(folder).read_text()


@pytest.fixture(scope="module")
def console(solved):
    out = Console(file=StringIO(), width=200)
    show_design(out, solved[1], solved[0])
    return out.file.getvalue()


def rows(page, region):
    """Cells of the table of a region, row by row."""
    table = re.search(rf'aria-label="{region}">.*?</table>', page, flags=re.DOTALL)[0]
    found = [
        re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row, flags=re.DOTALL) for row in re.findall(r"<tr.*?</tr>", table, re.DOTALL)
    ]
    return [[html.unescape(re.sub(r"<[^>]*>", " ", cell)).strip() for cell in row] for row in found]


def test_load_table_has_rule_forces_and_torque_of_each_case(page):
    """150 kN on a lever of 0.12 m: 0.8 F_z from the side is 14.4 kN m (14 CFR 25.485), the pivot 25.503 is 0.8 F_z a/2."""
    table = {row[0].split("  ")[0].split(" limit")[0].strip(): row for row in rows(page, "Load cases")}
    side = table["side load"]
    assert side[1].startswith("14 CFR 25.485(b)")
    assert side[2:6] == ["150", "120", "0", "14.4"]
    assert table["turning"][2:5] == ["150", "75", "0"]
    assert table["pivoting"][5] == "6"
    assert table["towing"][-1] == "off: needs aircraft_weight"
    assert table["nose yaw"][-1] == "off: is for a nose gear"
    torques = [float(row[5]) for row in rows(page, "Load cases")[1:] if len(row) > 5]
    assert torques == sorted(torques, reverse=True)


def test_the_case_that_sizes_names_its_parts(solved, page):
    _, result = solved
    (heaviest,) = [row for row in result.loads if row.sizing]
    reach = result.design["L"] * math.sin(result.design["gamma"])
    assert heaviest.apex_force == pytest.approx(14.4e3 / reach)
    sized = margins.sized_by(heaviest, result.margins)
    assert {"bending arm", "support", "damper"} <= set(sized)
    assert ", ".join(sized) == rows(page, "Load cases")[1][-1]


def test_margin_of_the_arm_by_hand(solved, page):
    """Bending over L at its root, tube t/d = 0.1, typical 1172 MPa at 1.5 times limit load."""
    _, result = solved
    inner = 0.8  # of the diameter
    d = (64 * result.design["I_arm"] / (math.pi * (1 - inner**4))) ** 0.25
    force = 14.4e3 / (result.design["L"] * math.sin(result.design["gamma"]))
    stress = force * result.design["L"] * d / 2 / result.design["I_arm"]
    (arm,) = [row for row in rows(page, "Margins of safety") if row[0] == "bending arm"]
    assert float(arm[4]) == pytest.approx(stress / 1e6, rel=1e-4)
    (row,) = [m for m in result.margins if (m.part, m.check, m.case) == ("bending arm", "rupture", "side_load")]
    assert row.value == pytest.approx(1172e6 / (1.5 * stress) - 1, abs=1e-6)
    assert arm[1:4] == ["rupture", "side load", "ultimate"]


def test_critical_margins_are_the_least_of_each_part_and_all_are_in_the_fold(solved, page):
    _, result = solved
    least = {}
    for row in result.margins:
        least[row.part] = min(least.get(row.part, math.inf), row.value)
    shown = rows(page, "Margins of safety")[1:]
    assert [row[0] for row in shown] == sorted(least, key=least.get)
    head, *table = rows(page, "Every margin of safety by case")
    cells = [cell for row in table for cell in row[3:] if cell]
    assert len(cells) == len(result.margins)
    assert head[3] == "side load"
    assert head[-1] == "spectrum"


def test_parts_list_weighs_what_it_shows(solved, page):
    """Two legs of a tube, and two unequal ones of the support, with a fifth more for fittings."""
    study, result = solved
    table = rows(page, "Parts list")[1:]
    value = {(row[0], row[1]): float(row[2].replace("\u202f", "").replace(" ", "")) for row in table}

    def tube(part):
        d, t = value[part, "outer diameter"], value[part, "wall"]
        return math.pi / 4 * (d**2 - (d - 2 * t) ** 2) * 1e-6

    per_length = 1.2 * study.material.density
    links = per_length * tube("torque links, each leg") * 2 * value["torque links, each leg", "length"] * 1e-3
    assert links == pytest.approx(value["torque links", "mass, fittings included"], rel=1e-3)
    lengths = [value["support, each leg", f"length, {side} leg"] for side in ("near", "far")]
    support = per_length * tube("support, each leg") * sum(lengths) * 1e-3
    assert support == pytest.approx(value["support", "mass, fittings included"], rel=1e-3)
    assert sum(v for (_, what), v in value.items() if what.startswith("mass")) == pytest.approx(result.mass.total, abs=2e-3)
    pressures = [value["damper cylinder", f"{name} pressure"] for name in ("peak", "proof", "burst")]
    assert pressures == pytest.approx([20.7, 1.5 * 20.7, 2 * 20.7], rel=1e-4)
    bore, rod = value["damper cylinder", "bore"], value["damper rod", "diameter"]
    length = 2 * value["damper cylinder", "stroke to one side"] + 120
    assert value["damper", "oil volume"] == pytest.approx(math.pi / 4 * (bore**2 - rod**2) * length / 1e3, rel=1e-3)


def test_page_says_first_what_the_proof_is_about_and_what_is_not_usual(solved, page):
    _, result = solved
    top = html.unescape(page[: page.index("What was asked")])
    for sentence in (*result.covers, *result.leaves_out, *result.implausible):
        assert sentence in top
    for sentence in result.rests_on:
        assert sentence[1:] in html.unescape(page)
    assert "Typical values, no design allowables: AISI 4340" in page
    assert "typical spectrum, of no aircraft" in page.lower()


def test_result_says_what_it_is(solved):
    _, result = solved
    record = json.loads(result.to_json())
    assert (record["schema_version"], record["verdict"], record["witness"]) == (2, "proved", {})
    assert "elastic by their sections: torque links, support, oil column and rod" in record["covers"][0]
    assert any("shock strut" in words for words in record["leaves_out"])
    assert set(record["leaves_out"]) <= set(record["not_checked"])
    assert any(words.startswith("tyre: the pneumatic trail at 150 kN is 71.4 m") for words in record["implausible"])
    assert not any("frequency of the yaw mode" in words for words in record["implausible"])  # 11 to 12.5 Hz


def test_console_names_the_case_the_margins_and_what_is_not_usual(console):
    assert "Sizing load case: side_load (14 CFR 25.485(b)): yaw torque 14.4 kN m" in console
    assert "Least margins of safety: bending arm 0 (rupture, ultimate, side_load)" in console
    assert "of all other parts above +1" in console
    assert "Not usual: tyre: the pneumatic trail" in console
    assert "The certificate covers the linear gear about straight rolling" in console


def test_a_refuted_design_has_a_witness(solved):
    """Far too little damping: the point that refutes it, with the frequency at which the gear shimmies there."""
    from damperopt.optimum.said import said_of

    study, result = solved
    weak = result.design | {"c_lambda": 100.0}
    refuted = result.model_copy(update={"design": weak, "certificate": damperopt.certify(study, weak)})
    gear = damperopt.linear_gear(study, weak)
    said = said_of(study, refuted, gear)
    assert said["verdict"] == "refuted"
    speed, load, frequency = (said["witness"][name] for name in ("speed", "load", "frequency"))
    roots = np.linalg.eigvals(gear.matrices([speed], load)[0])
    top = roots[roots.real.argmax()]
    assert top.real > -study.required.stability_margin
    assert frequency == pytest.approx(abs(top.imag))


def load(**changes):
    given = {"case": "a", "rule": "", "read": "", "level": "limit", "nature": "static", "vertical": 1.0, "side": 0.0}
    return LoadRow(**{**given, "drag": 0.0, "yaw_torque": 1.0, "apex_force": 1.0, "off": "", "sizing": False, **changes})


def margin(part, check, case, value):
    return MarginRow(part, check, case, "limit", 1.0, 1.0, 1.0, "Pa", value)


def test_parts_are_sized_by_the_case_that_leaves_them_nothing():
    found = [margin("arm", "yield", "a", 1e-8), margin("arm", "yield", "b", 0.3), margin("link", "column", "b", 0.02)]
    assert margins.sized_by(load(case="a"), found) == ["arm"]
    assert margins.sized_by(load(case="b"), found) == []
    assert [(row.part, row.case) for row in margins.critical_rows(found[::-1])] == [("arm", "a"), ("link", "b")]


def test_a_margin_that_is_missing_is_as_strong_as_one_that_is_nothing():
    found = [margin("arm", "yield", "a", -0.02), margin("arm", "yield", "b", 0.3), margin("link", "column", "b", 0.006)]
    result = damperopt.DesignResult.model_construct(loads=(load(), load(case="b")), margins=tuple(found))
    assert [(line.cells[-1], line.strong) for line in margins.critical_margins(result)] == [("-0.02", True), ("+0.0060", False)]
    cases, lines = margins.margins_by_case(result)
    assert cases == ["a", "b"]
    assert [(line.cells[3:], line.strong) for line in lines] == [(("-0.02", "+0.30"), True), (("", "+0.0060"), False)]


def test_rigid_parts_are_sized_by_the_largest_torque(main_gear):
    result = damperopt.DesignResult.model_construct(loads=(load(sizing=True), load(case="b", off="needs x")), margins=())
    first, second = margins.load_cases(result)
    assert first.cells[-1] == "the parts"
    assert second.cells[-1] == "off: needs x"
    assert set(second.cells[3:-1]) == {""}


def test_limits_that_bound_a_region_are_found():
    """Feasible for x < 2 and y < 3; a third limit lies far outside."""
    x, y = np.arange(6.0), np.arange(6.0)
    X, Y = np.meshgrid(x, y)
    violated = {"right": X - 1.5, "above": Y - 2.5, "far": X - 4.5}
    record = FeasibleRegion("c_lambda", "I_arm", x, y, X, np.ones_like(X), violated, {})
    assert bounding(record) == ["right", "above"]


def test_sizes_belong_to_the_parts_that_weigh(solved):
    study, result = solved
    assert {size.group for size in facts.sizes(study, result)} == set(result.mass.parts)

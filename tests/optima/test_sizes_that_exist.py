"""Sizes that exist: the search against every combination, each solved alone from the study's own start."""

import itertools
import math

import pytest

import damperopt
from damperopt.design import _proved_alone
from damperopt.errors import Unfinished
from damperopt.optimum import stock
from damperopt.optimum.exchange import first_points
from damperopt.optimum.local import best_local
from damperopt.optimum.problem import DesignProblem
from damperopt.optimum.solve import NlpSolver
from damperopt.optimum.stock import StockSearch, of_chosen_sizes
from damperopt.output.facts import sizes
from damperopt.strength.stock import Tube

ONE = {"solver__starts": 1, "tyre__contact": "leading_point"}
ROWS = [
    {"name": "short", "c": 2e4, "stroke": 0.005, "length": 0.165, "force": 2e4, "mass": 2.0, "series_stiffness": 4e7},
    {"name": "light", "c": 2.5e4, "stroke": 0.009, "length": 0.185, "force": 2e4, "mass": 4.0, "series_stiffness": 3.6e7},
    {"name": "heavy", "c": 1.5e4, "stroke": 0.012, "length": 0.185, "force": 2e4, "mass": 4.6, "series_stiffness": 3.6e7},
    {"name": "weak", "c": 2.5e4, "stroke": 0.009, "length": 0.185, "force": 2e3, "mass": 1.0, "series_stiffness": 3.6e7},
]


@pytest.fixture(scope="module")
def gear(configs):
    return damperopt.load(configs / "catalogue_main_gear.yaml").replace(available=None, catalogue=None, **ONE)


def each_alone(study, choices):
    """Mass of every combination that has a design; changes of the study by the words of each choice."""
    found = {}
    for chosen in itertools.product(*choices):
        changes = {key: value for _, change in chosen for key, value in change.items()}
        solver = NlpSolver(DesignProblem(study.replace(**changes)))
        alone = best_local(solver, solver.problem.study.start, first_points(solver))
        if alone.solved:
            found[tuple(words for words, _ in chosen)] = alone.solution.objective
    return found


def of_tubes(variable, section, tubes):
    def made(tube):
        number = tube.area if variable.startswith("A_") else tube.inertia
        return {f"design__{variable}": number, f"mass__{section}": tube.section.model_dump(exclude_none=True)}

    return [(str(tube), made(tube)) for tube in tubes]


def lists(diameters, walls):
    return {"tube_diameters": diameters, "walls": walls}, [Tube(d, t) for d in diameters for t in walls]


def test_tubes_and_bores(gear):
    available, tubes = lists([0.036, 0.045], [0.0016, 0.0025])
    bores = [0.025, 0.032]
    found = damperopt.optimise(gear.replace(available={**available, "bores": bores}))
    each = each_alone(
        gear,
        [of_tubes("A_link", "link_section", tubes), [(f"bore {1e3 * b:g} mm", {"damper__bore": b}) for b in bores]],
    )
    best = min(each, key=each.get)
    assert found.status == "solved"
    assert (found.stock.chosen["torque links"], found.stock.chosen["damper"]) == best
    assert found.mass.total == pytest.approx(each[best], rel=1e-6)
    _complete(found.stock, 8)
    made = of_chosen_sizes(gear, found)
    again = damperopt.optimise(made)
    assert again.mass.total == pytest.approx(found.mass.total, rel=1e-6)
    assert sorted(found.design) == sorted(made.variable_names)
    assert found.config == made.model_dump(mode="json")
    for row in found.stock.candidates:  # what is said of single choices is what each alone has
        if row.combinations == 1 and row.mass is not None:
            assert row.mass == pytest.approx(each[tuple(row.parts[p] for p in ("torque links", "damper"))], rel=1e-6)


def _complete(stock, combinations):
    assert stock.finished
    assert stock.combinations == combinations
    assert sum(row.combinations for row in stock.candidates) == combinations
    assert [row.outcome for row in stock.candidates].count("chosen") == 1
    assert stock.candidates[0].outcome == "chosen"
    masses = [row.mass for row in stock.candidates if row.mass is not None]
    assert masses == sorted(masses)


@pytest.mark.verify
def test_catalogue(gear):
    found = damperopt.optimise(gear.replace(catalogue=ROWS))
    block = {"topology": "boeing", "kind": "bought"}
    each = each_alone(gear, [[(row["name"], {"damper": {**block, "row": row}}) for row in ROWS]])
    best = min(each, key=each.get)
    assert (found.stock.chosen["damper"],) == best
    assert found.mass.total == pytest.approx(each[best], rel=1e-6)
    assert found.stock.price == pytest.approx(found.mass.total - found.stock.continuous_mass)
    _complete(found.stock, 4)
    why = {row.parts["damper"]: (row.outcome, row.why) for row in found.stock.candidates}
    assert why["short"][0] == why["weak"][0] == "no design"
    assert "usable_stroke" in why["short"][1]
    assert "largest_force" in why["weak"][1]
    assert set(each) == {("light",), ("heavy",)}


@pytest.mark.verify
@pytest.mark.slow
def test_three_parts_of_the_new_layout(configs):
    """Links, support and bending arm, each of four tubes."""
    study = damperopt.load(configs / "main_gear.yaml").replace(
        requirements__decay=None, requirements__damping_ratio=None, solver__starts=4
    )
    free = damperopt.optimise(study)
    available, tubes = lists([0.032, 0.08], [0.0025, 0.008])
    found = damperopt.optimise(study.replace(available=available))
    parts = [("A_link", "link_section"), ("A_support", "support_section"), ("I_arm", "arm_section")]
    assert set(found.stock.chosen) == {"torque links", "support", "bending arm"}
    each = each_alone(study.replace(solver__starts=1), [of_tubes(*part, tubes) for part in parts])
    best = min(each, key=each.get)
    assert tuple(found.stock.chosen[part] for part in ("torque links", "support", "bending arm")) == best
    assert found.mass.total == pytest.approx(each[best], rel=1e-6)
    assert found.stock.continuous_mass == pytest.approx(free.mass.total, rel=1e-6)
    assert found.stock.solved < len(tubes) ** 3


@pytest.mark.verify
def test_bound_of_a_box_is_below_all_that_it_holds(gear):
    available, tubes = lists([0.04, 0.05, 0.06], [0.0016, 0.003])
    search = StockSearch(gear.replace(available=available), _proved_alone)
    (box,) = search._boxes
    assert box.combinations == len(tubes)

    def least(part):
        solver = search._solver(part)
        found = best_local(solver, solver.problem.study.start, first_points(solver))
        return found.solution if found.solved else None

    whole = least(box)
    halves = [least(half) for half in box.split(whole.design)]
    assert all(half.objective >= whole.objective * (1 - 1e-9) for half in halves if half)
    for tube in tubes:
        alone = least(type(box)(box.damper, {"A_link": (tube,)}))
        assert alone is None or alone.objective >= whole.objective * (1 - 1e-9)


@pytest.mark.verify
def test_what_fails_a_check_is_passed_over(gear):
    """The lightest choice fails its proof here; the next one is taken, and the first is listed with the reason."""
    available, tubes = lists([0.04, 0.045, 0.05], [0.0016, 0.002])
    each = each_alone(gear, [of_tubes("A_link", "link_section", tubes)])
    first, second, *_ = sorted(each, key=each.get)
    asked = []

    def prove(solver, found):
        asked.append(found.solution.objective)
        result = _proved_alone(solver, found)
        return result.model_copy(update={"status": "failed", "message": "by hand"}) if len(asked) == 1 else result

    search = StockSearch(gear.replace(available=available), prove)
    search.run(gear.start)
    record = search.record(None, finished=True)
    assert asked == pytest.approx([each[first], each[second]], rel=1e-6)
    assert (record.chosen["torque links"],) == second
    (failed,) = (row for row in record.candidates if row.outcome == "not proved")
    assert ((failed.parts["torque links"],), failed.why) == (first, "by hand")
    assert sum(row.combinations for row in record.candidates) == len(tubes)


def test_what_has_no_effect_is_said(gear):
    solid = {"mass__link_section": {"family": "solid_round"}}
    available, _ = lists([0.04], [0.003])
    found = damperopt.optimise(gear.replace(available={**available, "bores": [0.025]}, catalogue=ROWS[1:2], **solid))
    assert any(words.startswith("bores: the damper is bought") for words in found.stock.leaves_out)
    assert any("torque links" in words and "no tubes" in words for words in found.stock.leaves_out)
    nothing = damperopt.optimise(gear.replace(available=available, **solid))
    assert nothing.status == "solved"
    assert nothing.stock.chosen == {}
    assert any("no tubes" in words for words in nothing.stock.leaves_out)


def test_rigid_chain_has_bores_alone(gear):
    """The cylinder has the bore that was chosen, and the area of its piston is the annulus around the rod."""
    available, _ = lists([0.04], [0.003])
    rigid = gear.replace(damper__compliance="rigid")
    found = damperopt.optimise(rigid.replace(available={**available, "bores": [0.025, 0.04]}))
    assert found.stock.chosen == {"damper": "bore 25 mm"}
    assert any("tubes for the torque links" in words for words in found.stock.leaves_out)
    shown = {(size.part, size.words): size.value for size in sizes(of_chosen_sizes(rigid, found), found)}
    assert shown["damper cylinder", "bore"] == pytest.approx(0.025)
    area = math.pi / 4 * (0.025**2 - found.derived["rod_diameter"] ** 2)
    assert shown["damper cylinder", "peak pressure"] == pytest.approx(found.limit_event["damper_force"] / area)
    (pressed,) = (c for c in found.constraints if c.name == "piston_pressure")
    assert pressed.limit == pytest.approx(area)
    assert pressed.value <= area


def test_lists_without_a_fitting_size(gear):
    available, _ = lists([0.006], [0.001])
    with pytest.raises(damperopt.ConfigError, match=r"no tube for the torque links, design.A_link from"):
        damperopt.optimise(gear.replace(available=available))
    found = damperopt.optimise(gear.replace(catalogue=ROWS[3:]))
    assert found.status == "infeasible"
    assert found.exit_code == 3
    assert found.mass is None
    assert found.stock.continuous_mass > 0
    assert "no design of sizes that exist was found" in found.message


def test_interrupt_keeps_the_optimum_of_any_size(gear, monkeypatch):
    solver_of = stock.best_local
    solved = []

    def interrupted(*given):
        solved.append(solver_of(*given))
        if len(solved) == 3:
            raise KeyboardInterrupt
        return solved[-1]

    monkeypatch.setattr(stock, "best_local", interrupted)
    with pytest.raises(Unfinished) as caught:
        damperopt.optimise(gear.replace(catalogue=ROWS))
    result = caught.value.result
    assert result.status == "solved"
    assert result.mass.total == pytest.approx(result.stock.continuous_mass)
    assert not result.stock.finished
    assert result.stock.chosen == {}
    assert "interrupted" in result.message
    assert damperopt.DesignResult.model_validate_json(result.to_json()) == result

"""No design of a fine grid is feasible and lighter than the optimum; near the optimum the grid comes close to it."""

import itertools

import numpy as np
import pytest

from damperopt.optimum.problem import DesignProblem

pytestmark = pytest.mark.slow

LONGER = [pytest.param(topology, marks=pytest.mark.verify) for topology in ("utas", "arreaza")]
"""Layouts that `make verify` looks at too."""

SPEEDS = np.unique(np.concatenate([np.geomspace(5, 100, 30), np.linspace(20, 60, 21)]))


def lightest_on_grid(study, axes, lighter_than):
    """Least mass among the grid's feasible designs below a mass; stability by eigenvalues, of candidates only."""
    problem = DesignProblem(study)
    designs = np.array(list(itertools.product(*axes)))
    found = problem.over_designs(designs)
    ok = np.all(found["rows"] <= 1e-9, axis=1) & (found["mass"] < lighter_than)
    for index in np.flatnonzero(ok)[np.argsort(found["mass"][ok])]:
        design = dict(zip(problem.design_names, designs[index], strict=True))
        if problem.model.at(design).abscissa(SPEEDS, 150e3).max() <= -study.requirements.stability_margin:
            return found["mass"][index]
    return np.inf


@pytest.mark.parametrize("topology", ["boeing", *LONGER])
def test_no_grid_point_of_the_whole_box_is_lighter(topology, main_gear, optimum):
    study = main_gear.replace(damper__topology=topology)
    counts = {"boeing": (24, 24, 24, 24), "utas": (15, 15, 13, 13, 9), "arreaza": (15, 15, 13, 13, 9)}[topology]
    spans = {
        "c_lambda": (300.0, 2e6),
        "k_lambda": (5e5, 2e8),
        "I_arm": (1e-7, 1e-5),
        "L": (0.42, 0.8),
        "gamma": (0.25, 0.9),
        "b": (0.05, 0.5),
    }
    names = DesignProblem(study).design_names
    axes = [np.geomspace(*spans[name], count) for name, count in zip(names, counts, strict=True)]
    best = optimum(topology).mass.total
    assert lightest_on_grid(study, axes, lighter_than=best) == np.inf
    assert np.isfinite(lightest_on_grid(study, axes, lighter_than=4 * best))  # the grid does hold designs


@pytest.mark.parametrize("topology", ["boeing", *LONGER])
def test_grid_around_the_optimum_is_nowhere_lighter_and_comes_close(topology, main_gear, optimum):
    study = main_gear.replace(damper__topology=topology)
    result = optimum(topology)
    count = 9 if topology == "boeing" else 7
    axes = [value * np.linspace(0.97, 1.03, count) for value in result.design.values()]
    best = result.mass.total
    assert lightest_on_grid(study, axes, lighter_than=best * (1 - 1e-5)) == np.inf
    assert lightest_on_grid(study, axes, lighter_than=best * 1.1) < best * 1.1

"""Optimisation with contact memory: proved, at its limits, and no lighter design near it."""

from __future__ import annotations

import numpy as np
import pytest

import damperopt
from damperopt.optimum.problem import DesignProblem


@pytest.fixture(scope="module")
def solved(main_gear):
    study = main_gear.replace(tyre__contact="memory", solver__starts=2)
    return study, damperopt.optimise(study)


def test_ends_with_a_certified_design(solved):
    study, result = solved
    assert result.status == "solved", result.message
    assert result.certificate.verdict == "proved"
    assert result.certificate.method == "balls"
    assert damperopt.certify(study, result.design).proved
    # the exact margin is what stops it, and not that of the rational model
    worst = damperopt.worst_points(damperopt.linear_gear(study, result.design), study.envelope)[0].abscissa
    assert -0.1 - 1e-5 < worst < -0.1
    tangent = study.replace(tyre__contact="leading_point")
    assert damperopt.linear_gear(tangent, result.design).abscissa(37.0, 150e3)[0] > -0.1


@pytest.mark.verify
def test_no_lighter_design_is_near(solved):
    """Sixty thousand designs about it: those that are lighter miss a limit, or the exact margin."""
    study, result = solved
    problem, rng = DesignProblem(study), np.random.default_rng(0)
    names = problem.design_names
    best = np.array([result.design[name] for name in names])
    lower, upper = (np.array([getattr(study.variable(name), end) for name in names]) for end in ("min", "max"))
    sizes = 10.0 ** rng.uniform(-4, -1, (60_000, 1))
    steps = sizes * rng.standard_normal((60_000, len(names)))
    steps[:, names.index("I_arm")] = np.abs(steps[:, names.index("I_arm")]) / 100  # its strength alone sizes it
    designs = np.clip(best * np.exp(steps), lower, upper)
    found = problem.over_designs(designs)
    lighter = (found["mass"] < result.mass.total * (1 - 1e-6)) & (found["rows"] <= 0).all(axis=1)
    assert lighter.sum() > 30
    speeds = np.geomspace(5, 100, 120)
    for row in designs[lighter]:
        gear = damperopt.linear_gear(study, dict(zip(names, row.tolist(), strict=True)))
        assert gear.abscissa(speeds, 150e3).max() > -0.1


def test_a_design_of_the_straight_tangent_is_no_design_with_memory(main_gear):
    tangent = damperopt.optimise(main_gear.replace(solver__starts=1))
    memory = main_gear.replace(tyre__contact="memory")
    assert tangent.status == "solved"
    certificate = damperopt.certify(memory, tangent.design)
    exact = damperopt.worst_points(damperopt.linear_gear(memory, tangent.design), memory.envelope)[0].abscissa
    assert certificate.proved == (exact < -0.1)

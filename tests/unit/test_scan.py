"""Starting points: screening without eigenvalues, the scan over stiffness, and what they promise."""

import numpy as np
import pytest

import damperopt
from damperopt.optimum.multistart import starting_designs
from damperopt.optimum.problem import DesignProblem
from damperopt.optimum.scan import promising_designs, sobol_designs, steady_designs, stiffness_scan
from damperopt.stability.screening import Screening


@pytest.fixture(scope="module", params=["boeing", "utas", "arreaza"])
def problem(request, main_gear):
    return DesignProblem(main_gear.replace(damper__topology=request.param))


def test_screening_agrees_with_eigenvalues(main_gear):
    rng = np.random.default_rng(2)
    k, c = 10 ** rng.uniform(4.5, 6.5, 400), 10 ** rng.uniform(1.5, 5, 400)
    least = Screening(main_gear).least_conditions(k, c)
    speeds = np.geomspace(5, 100, 24)
    for i in range(k.size):
        plain = {"topology": "rotational", "torsional_stiffness": k[i], "torsional_damping": c[i]}
        worst = damperopt.linear_gear(main_gear.replace(damper=plain)).abscissa(speeds, 150e3).max()
        assert (least[i] > 0) == (worst < -0.1)
    assert 20 < np.sum(least > 0) < 380


def test_worst_abscissae_are_those_of_single_gears(main_gear):
    k, c = np.array([2e5, 1e6, 3e6]), np.array([300.0, 2000.0, 700.0])
    found = Screening(main_gear).worst_abscissae(k, c)
    for i in range(3):
        plain = {"topology": "rotational", "torsional_stiffness": k[i], "torsional_damping": c[i]}
        gear = damperopt.linear_gear(main_gear.replace(damper=plain))
        assert found[i] == pytest.approx(gear.abscissa(np.geomspace(5, 100, 8), 150e3).max(), rel=1e-9)


def test_scan_points_meet_strength_and_geometry(problem):
    points = stiffness_scan(problem)
    assert len(points) > 5
    for point in points:
        assert max(problem.rows(point.design).values()) < 1e-4
        assert problem.mass(point.design) == pytest.approx(point.mass, rel=1e-3)
        assert problem.yaw_numbers(point.design)["torsional_stiffness"] == pytest.approx(point.k_psi, rel=1e-3)


@pytest.mark.slow
def test_lightest_of_the_scan_is_near_the_optimum(problem):
    best = promising_designs(problem, 1)[0]
    optimum = damperopt.optimise(problem.study)
    assert problem.mass(best) < 1.1 * optimum.mass.total


def test_steady_designs_are_steadier_than_the_start(problem):
    designs = steady_designs(problem, 2)
    assert len(designs) == 2
    speeds = np.geomspace(5, 100, 40)
    start = problem.model.at(problem.study.start).abscissa(speeds, 150e3).max()
    for design in designs:
        assert problem.model.at(design).abscissa(speeds, 150e3).max() < start
        assert max(problem.rows(design).values()) < 1e-4


def test_starts_are_the_same_each_time_and_within_bounds(problem):
    first, second = starting_designs(problem), starting_designs(problem)
    assert first == second
    assert len(first) == 16
    assert first[0] == problem.study.start
    for design in first:
        for name, value in design.items():
            variable = problem.study.variable(name)
            assert variable.min <= value <= variable.max


def test_sobol_designs_do_not_depend_on_their_number(problem):
    assert np.array_equal(sobol_designs(problem, 5), sobol_designs(problem, 16)[:5])


def test_fixed_variables_stay_fixed(main_gear):
    problem = DesignProblem(main_gear.replace(design__L=0.6, design__b=0.2))
    designs = sobol_designs(problem, 8)
    assert np.all(designs[:, problem.design_names.index("L")] == 0.6)
    assert np.all(designs[:, problem.design_names.index("b")] == 0.2)
    assert len(np.unique(designs[:, 0])) == 8

"""Starting points: screening without eigenvalues, the scan over stiffness, and what they promise."""

import numpy as np
import pytest
from basic_twin import parameters, state_matrix
from scipy.linalg import expm

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
    k, c = 10 ** rng.uniform(4.5, 6.5, 150), 10 ** rng.uniform(1.5, 5, 150)
    least = Screening(main_gear).least_conditions(k, c)
    speeds = np.geomspace(5, 100, 24)
    for i in range(k.size):
        plain = {"topology": "rotational", "torsional_stiffness": k[i], "torsional_damping": c[i]}
        worst = damperopt.linear_gear(main_gear.replace(damper=plain)).abscissa(speeds, 150e3).max()
        assert (least[i] > 0) == (worst < -0.1)
    assert 15 < np.sum(least > 0) < 135


def test_worst_abscissae_are_those_of_single_gears(main_gear):
    k, c = np.array([2e5, 1e6, 3e6]), np.array([300.0, 2000.0, 700.0])
    found = Screening(main_gear).worst_abscissae(k, c)
    for i in range(3):
        plain = {"topology": "rotational", "torsional_stiffness": k[i], "torsional_damping": c[i]}
        gear = damperopt.linear_gear(main_gear.replace(damper=plain))
        assert found[i] == pytest.approx(gear.abscissa(np.geomspace(5, 100, 8), 150e3).max(), rel=1e-9)


def test_linear_decay_is_that_of_the_stepped_twin(main_gear_with_decay):
    """Exponentials of the twin's matrix, step by step, at the five speeds: three cycles after the first extremum."""
    required, speeds = main_gear_with_decay.required.decay, np.geomspace(5, 100, 5)
    steps, cycles = 64, required.cycles + 1.5
    k, c = np.array([2e5, 1e6, 3e6, 1e4]), np.array([3000.0, 2000.0, 700.0, 0.0])
    found = Screening(main_gear_with_decay).linear_decay(k, c, steps)
    for i in range(k.size):
        worst = 0.0
        for speed in speeds:
            A = state_matrix(speed, 150e3, parameters(k_psi=k[i], c_psi=c[i]))
            roots = np.abs(np.linalg.eigvals(A).imag)
            period = 2 * np.pi / min(roots[roots > 1].min(), np.sqrt(-A[1, 0]))
            step, x = expm(A * period * cycles / (steps * cycles - 1)), np.array([1.0, 0, 0, 0, 0])
            yaw = [1.0]
            while len(yaw) < cycles * steps:
                x = step @ x
                yaw.append(x[0])
            yaw = np.array(yaw)
            zeros = np.flatnonzero(yaw[1:] * yaw[:-1] < 0)
            after = zeros[2 * required.cycles - 1] + 1 if len(zeros) >= 2 * required.cycles else 2 * required.cycles * steps
            worst = max(worst, np.abs(yaw[after:]).max(initial=0.0) / np.abs(yaw[: 2 * steps]).max())
        assert found[i] == pytest.approx(worst, rel=1e-6)
    assert (found < 0.5).any()
    assert (found > 1).any()


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

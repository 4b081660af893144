"""Both ways to impose stability agree with eigenvalues, and their derivatives with differences."""

import casadi as ca
import numpy as np
import pytest

import damperopt
from damperopt.optimum.conditions import Slots, StableFactors
from damperopt.optimum.exchange import first_points, solve_envelope
from damperopt.optimum.problem import DesignProblem
from damperopt.optimum.program import ElasticFactorProgram, ElasticHurwitzProgram, FactorProgram, HurwitzProgram
from damperopt.optimum.scan import sobol_designs
from damperopt.optimum.solve import NlpSolver

LIGHTEST = 15.5630475
"""kg: main_gear.yaml without decay and damping ratio, from four starts by factors, and from each of these by Hurwitz."""

POINTS = [(5.0, 150e3), (22.0, 150e3), (60.0, 100e3)]


@pytest.fixture(scope="module", params=["boeing", "utas", "arreaza"])
def problem(request, main_gear):
    return DesignProblem(main_gear.replace(damper__topology=request.param))


@pytest.fixture(scope="module")
def design(problem):
    """The optimum."""
    return damperopt.optimise(problem.study.replace(solver__starts=3)).design


def random_designs(problem, count):
    return [dict(zip(problem.design_names, row, strict=True)) for row in sobol_designs(problem, count).tolist()]


def test_hurwitz_rows_hold_exactly_where_every_eigenvalue_keeps_the_margin(problem):
    program = HurwitzProgram(problem, 4)
    g = ca.Function("g", [program.nlp["x"], program.nlp["p"]], [program.nlp["g"]])
    rows = len(problem.constraints)
    stable = 0
    for design in random_designs(problem, 256):
        it = program.instance(design, POINTS)
        conditions = g(it.x0, it.p).full().ravel()[rows:]
        holds = np.all(conditions[np.isfinite(it.ubg[rows:])] < 0)
        abscissa = problem.model.at(design).abscissa(*np.array(POINTS).T).max()
        assert holds == (abscissa < -0.1 - 1e-6)
        stable += holds
    assert 10 < stable < 246  # the sample has both kinds


def test_factors_start_on_the_polynomial(problem):
    program = FactorProgram(problem, 4)
    g = ca.Function("g", [program.nlp["x"], program.nlp["p"]], [program.nlp["g"]])
    rows = len(problem.constraints)
    for design in random_designs(problem, 64):
        it = program.instance(design, POINTS)
        residual = g(it.x0, it.p).full().ravel()[rows:]
        lifted = np.abs(it.x0[len(problem.variables) :])
        assert np.abs(residual).max() < 1e-12 * max(lifted.max(), 1) ** 3  # of coefficients up to that size


@pytest.mark.parametrize("form", [HurwitzProgram, FactorProgram])
def test_gradient_of_the_objective_is_that_of_differences(problem, form):
    program = form(problem, 4)
    it = program.instance(problem.study.start, POINTS)
    f = ca.Function("f", [program.nlp["x"], program.nlp["p"]], [program.nlp["f"]])
    gradient = ca.Function("df", [program.nlp["x"], program.nlp["p"]], [ca.gradient(program.nlp["f"], program.nlp["x"])])
    exact = gradient(it.x0, it.p).full().ravel()
    step = 1e-6
    for i in range(len(problem.variables)):
        e = np.zeros(it.x0.size)
        e[i] = step
        difference = (float(f(it.x0 + e, it.p)) - float(f(it.x0 - e, it.p))) / (2 * step)
        assert exact[i] == pytest.approx(difference, rel=1e-5, abs=1e-6)


def test_both_forms_end_in_the_same_optimum(problem, design):
    solver = NlpSolver(problem)
    near = {name: value * 1.01 for name, value in design.items()}
    points = [(p.speed, p.load) for p in damperopt.worst_points(problem.model.at(design), problem.study.envelope)]
    masses = [solver.solve(near, points, form) for form in (HurwitzProgram, FactorProgram)]
    assert all(solution.converged for solution in masses)
    assert masses[0].objective == pytest.approx(masses[1].objective, rel=1e-6)
    assert masses[0].kkt_residual < 1e-6


@pytest.mark.parametrize("form", [ElasticHurwitzProgram, ElasticFactorProgram])
def test_elastic_program_needs_nothing_where_a_design_exists(problem, design, form):
    solver = NlpSolver(problem)
    names = (*problem.constraint_names, "stability_margin")
    solution = solver.solve(design, POINTS[:2], form, relaxed=names)
    assert solution.converged
    assert solution.objective == pytest.approx(0.0, abs=1e-5)


def test_parameter_gradient_is_that_of_solving_again(problem, design):
    """Speed and load of an active point, through the multipliers."""
    solver = NlpSolver(problem)
    point = (30.0, 150e3)
    base = solver.solve(design, [point])
    for column, step in ((0, 0.05), (1, 300.0)):
        moved = [tuple(point[i] + sign * step * (i == column) for i in range(2)) for sign in (1, -1)]
        up, down = (solver.solve(base.design, [p]).objective for p in moved)
        assert base.gradient.points[0, column] == pytest.approx((up - down) / (2 * step), rel=2e-2, abs=1e-9)


def test_factors_pass_where_real_roots_meet(configs):
    """The main gear's own start: two real roots, neighbours of two others, meet at 5 m/s before the lightest design is met."""
    study = damperopt.load(configs / "main_gear.yaml").replace(requirements__decay=None, requirements__damping_ratio=None)
    solver = NlpSolver(DesignProblem(study))
    found = solve_envelope(solver, study.start, first_points(solver), FactorProgram)
    assert found.solved
    assert found.solution.objective == pytest.approx(LIGHTEST, rel=1e-6)


@pytest.mark.parametrize(
    ("real", "together"),
    [
        ([-88.0, -60.001, -60.0, -38.6], [(126.6, 3396.8), (120.001, 3600.06)]),
        ([-5.0, -3.0, 3.0], [(8.0, 15.0)]),
        ([0.0, 0.0, -4.0, -4.0], [(0.0, 0.0), (8.0, 16.0)]),
    ],
)
def test_real_roots_that_are_nearest_share_a_factor(real, together):
    slots = Slots([[1.0, *ca.vertsplit(ca.SX.sym("a", len(real)))]], ca.SX.sym("rate", 1))
    numbers = StableFactors(slots).numbers(np.array([real], complex), np.array([2.0]), 1)
    pairs = numbers.variables.start[: len(together) * 2].reshape(-1, 2) * [1, 4]
    assert pairs == pytest.approx(np.array(together))

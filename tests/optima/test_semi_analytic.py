"""Fifth order: the damper enters the linear gear through (k_psi, c_psi) alone, so the optimum can be found another way.

Along the border of the stable region in that plane, find the cheapest layout for each point; stability here is that of
numpy eigenvalues on a dense grid, the search a bounded scan with SLSQP inside. Only mass and strength are the package's.
"""

import numpy as np
import pytest
from scipy.optimize import brentq, minimize

from damperopt.optimum.problem import DesignProblem

pytestmark = pytest.mark.slow

MARGIN = 0.1
SPEEDS = np.geomspace(5, 100, 250)
BETTER = 1e-3  # a mass that another method beats by 0.1 % is a failure


def gear_matrices(k_psi, c_psi):
    """State matrices of the main gear (theory page, linear model, rake 0), typed out."""
    a, e, I_z, I_x, F_z, slope, C_M, sigma = 0.1, 0.12, 100.0, 600.0, 150e3, 0.014, 1.0, 0.3
    k_delta, c_delta, l_g, kappa = 6.1e6, 300.0, 2.5, 570.0
    A = np.zeros((len(SPEEDS), 5, 5))
    A[:, 0, 1] = A[:, 2, 3] = 1
    A[:, 1, 0], A[:, 1, 1] = -k_psi / I_z, -(c_psi + kappa / SPEEDS) / I_z
    A[:, 1, 4] = -(e * slope + C_M) * F_z / (I_z * sigma)
    A[:, 3, 0], A[:, 3, 2], A[:, 3, 3] = F_z * e / I_x, -k_delta / I_x, -c_delta / I_x
    A[:, 3, 4] = -l_g * slope * F_z / (I_x * sigma)
    A[:, 4, 0], A[:, 4, 1], A[:, 4, 3], A[:, 4, 4] = SPEEDS, e - a, l_g, -SPEEDS / sigma
    return A


def excess(k_psi, c_psi):
    return np.linalg.eigvals(gear_matrices(k_psi, c_psi)).real.max() + MARGIN


def least_dampings(k_psi):
    """Lower ends of the stable intervals of c_psi at this stiffness."""
    grid = np.geomspace(50, 2e5, 40)
    values = np.array([excess(k_psi, c) for c in grid])
    enters = np.flatnonzero((values[:-1] > 0) & (values[1:] <= 0))
    return [brentq(lambda c: excess(k_psi, c), grid[i], grid[i + 1], rtol=1e-8) for i in enters]


def cheapest_layout(problem, k_psi, c_psi, start):
    """Least mass of a Boeing or new-design linkage with this stiffness and damping, over its lengths."""
    E = problem.study.material.youngs_modulus
    boeing = problem.study.damper.topology == "boeing"

    def design(x):
        L, gamma = x[0], x[1]
        ell = L * np.sin(gamma)
        spring = {"k_lambda": k_psi / ell**2} if boeing else {"I_arm": k_psi * ell / (3 * E), "b": x[2]}
        return {"c_lambda": c_psi / ell**2, "L": L, "gamma": gamma, **spring}

    solution = minimize(
        lambda x: problem.mass(design(x)),
        start[: 2 if boeing else 3],
        method="SLSQP",
        bounds=[(0.2, 1.5), (0.1, 1.4), (0.02, 0.6)][: 2 if boeing else 3],
        constraints={"type": "ineq", "fun": lambda x: -np.array(list(problem.rows(design(x)).values()))},
        options={"ftol": 1e-10, "maxiter": 200},
    )
    feasible = max(problem.rows(design(solution.x)).values()) < 1e-6
    return (solution.fun, solution.x) if feasible else (np.inf, start)


@pytest.mark.parametrize("topology", [pytest.param("boeing", marks=pytest.mark.verify), "arreaza"])
def test_optimum_found_along_the_border_of_the_stable_region(topology, main_gear, optimum):
    problem = DesignProblem(main_gear.replace(damper__topology=topology))

    def best_at(k_psi, start):
        found = [cheapest_layout(problem, k_psi, c_psi, start) for c_psi in least_dampings(k_psi)]
        return min(found, key=lambda f: f[0], default=(np.inf, start))

    stiffnesses = np.geomspace(2e5, 4e6, 24)
    start = np.array([0.55, 0.7 if topology == "boeing" else 0.55, 0.15])
    masses = [best_at(k, start)[0] for k in stiffnesses]
    k_best = stiffnesses[int(np.argmin(masses))]
    for width in (1.13, 1.04, 1.01, 1.003):
        around = k_best * np.geomspace(1 / width, width, 9)
        masses = [best_at(k, start)[0] for k in around]
        k_best = around[int(np.argmin(masses))]
    ours = optimum(topology).mass.total
    assert np.isfinite(min(masses))
    assert ours <= min(masses) * (1 + BETTER)
    assert ours >= min(masses) * (1 - BETTER)  # and no lighter than what is possible

"""Lightest damper of the main gear: damperopt beside SLSQP and differential evolution on the same functions.

    python benchmarks/optimise.py [--layouts boeing,utas,arreaza] [--evolution-generations 150]

All methods get the same study, thesis_gear.yaml without its decay requirement (which only damperopt could impose), the same
mass, strength and geometry functions (`DesignProblem`) and the same bounds. The others impose stability as users would by
hand, as the spectral abscissa of numpy.linalg.eigvals at 40 speeds; damperopt imposes and proves it for every speed. Each
row: wall time in one process, best mass, share of the starts that end within 0.1 % of the best mass of all, and the largest
abscissa of the answer over the continuous speed range.
"""

from __future__ import annotations

import argparse
import platform
import time
from pathlib import Path

import numpy as np
from scipy.optimize import differential_evolution, minimize

import damperopt
from damperopt.optimum.multistart import starting_designs
from damperopt.optimum.problem import DesignProblem

STUDY = Path(__file__).parents[1] / "configs" / "thesis_gear.yaml"
SPEEDS = np.geomspace(5, 100, 40)


def study_of(layout: str = "arreaza") -> damperopt.Study:
    """What every method solves: no decay, which the others do not have."""
    return damperopt.load(STUDY).replace(damper__topology=layout, requirements__decay=None)


class SameFunctions:
    """Mass and constraints over the scaled design variables, as a user would hand them to SciPy."""

    def __init__(self, problem: DesignProblem):
        self.problem, self.margin = problem, problem.study.required.stability_margin
        lower, upper = problem.bounds()
        self.bounds = list(zip(lower[:-1], upper[:-1], strict=True))
        self.evaluations = 0

    def design(self, x):
        return self.problem.unscaled(np.append(x, 0.0))

    def mass(self, x):
        self.evaluations += 1
        return self.problem.mass(self.design(x))

    def violations(self, x):
        """All <= 0 where feasible: strength and geometry rows, abscissa above -margin at each speed."""
        design = self.design(x)
        abscissa = self.problem.model.at(design).abscissa(SPEEDS, self.problem.load_limit)
        return np.append(list(self.problem.rows(design).values()), abscissa + self.margin)

    def penalised(self, x):
        excess = np.maximum(self.violations(x), 0).sum()
        return self.mass(x) if excess <= 1e-9 else 1e3 + 1e2 * excess


def ours(study):
    result = damperopt.optimise(study)
    masses = [start.mass for start in result.starts if start.solved]
    return result.design, masses, f"status {result.status}"


def slsqp(study):
    functions = SameFunctions(DesignProblem(study))
    found = []
    for start in starting_designs(functions.problem):
        x0 = np.array([v.scale(start[v.name]) for v in functions.problem.variables[:-1]])
        constraint = {"type": "ineq", "fun": lambda x: -functions.violations(x)}
        try:
            solution = minimize(
                functions.mass, x0, method="SLSQP", bounds=functions.bounds, constraints=constraint, options={"maxiter": 300}
            )
        except (ValueError, np.linalg.LinAlgError):  # SLSQP may step out of its own bounds
            continue
        if np.all(functions.violations(solution.x) < 1e-5):
            found.append((solution.fun, functions.design(solution.x)))
    best = min(found, key=lambda f: f[0])
    return best[1], [mass for mass, _ in found], f"{functions.evaluations} evaluations"


def evolution(study, generations):
    functions = SameFunctions(DesignProblem(study))
    solution = differential_evolution(
        functions.penalised, functions.bounds, rng=1, maxiter=generations, popsize=15, tol=1e-8, polish=False
    )
    return functions.design(solution.x), [solution.fun], f"{functions.evaluations} evaluations"


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--layouts", default="boeing,utas,arreaza")
    parser.add_argument("--evolution-generations", type=int, default=150)
    arguments = parser.parse_args()
    print(f"{platform.machine()}, {platform.system()}, Python {platform.python_version()}, NumPy {np.__version__}\n")
    print("| layout | method | time [s] | mass [kg] | starts at the best | worst abscissa [1/s] | note |")
    print("|---|---|---|---|---|---|---|")
    for layout in arguments.layouts.split(","):
        study = study_of(layout)
        methods = {
            "damperopt": lambda s: ours(s),
            "SLSQP": lambda s: slsqp(s),
            "differential evolution": lambda s: evolution(s, arguments.evolution_generations),
        }
        rows = []
        for name, method in methods.items():
            clock = time.perf_counter()
            design, masses, note = method(study)
            rows.append((name, time.perf_counter() - clock, design, masses, note))
        best = min(min(masses) for _, _, _, masses, _ in rows)
        for name, seconds, design, masses, note in rows:
            share = sum(mass <= best * 1.001 for mass in masses)
            total = 1 if name.startswith("diff") else study.solver.starts
            worst = damperopt.worst_points(damperopt.linear_gear(study, design), study.envelope)[0].abscissa
            print(f"| {layout} | {name} | {seconds:.2f} | {min(masses):.4f} | {share} of {total} | {worst:.6f} | {note} |")

    study = study_of()
    design = damperopt.optimise(study).design
    print("\n| exact certificate of stability | time [ms] |\n|---|---|")
    for words, envelope in (
        ("one load", {}),
        ("five loads", {"envelope__vertical_load": [50e3, 75e3, 100e3, 125e3, 150e3]}),
        ("load range 100 to 150 kN", {"envelope__vertical_load": {"min": 100e3, "max": 150e3}}),
        ("contact memory, one load", {"tyre__contact": "memory"}),
        ("contact memory, 80 to 150 kN", {"tyre__contact": "memory", "envelope__vertical_load": {"min": 80e3, "max": 150e3}}),
    ):
        times = []
        for _ in range(5):
            clock = time.perf_counter()
            certificate = damperopt.certify(study.replace(**envelope), design, margin=0.0)
            times.append(time.perf_counter() - clock)
        print(f"| {words}: {'proved' if certificate.proved else certificate.reason} | {1e3 * min(times):.1f} |")


if __name__ == "__main__":
    main()

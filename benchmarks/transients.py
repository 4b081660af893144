"""Transients with design sensitivities: damperopt's integrators beside SciPy's, at equal error.

    python benchmarks/transients.py [--repeats 7]

One motion of the main gear (fifth order, new design, planar): the yaw angle released at 0.25 deg, 0.5 s at 40 m/s, 200 output
times. damperopt integrates the state and its derivatives to all five design variables; SciPy the state alone, with the gear
written with NumPy's functions as usual, with those of math, and as CasADi's expression called without overhead. Errors are the
largest of the yaw angle over its release, against DOP853 at 1e-13. Every method runs at several tolerances; its time at equal
error is interpolated in the logarithms. Then how the cost grows with duration and speeds, what a loop over designs costs, and
the whole solution of a study.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable
from types import ModuleType

import casadi as ca
import numpy as np
from scipy.integrate import solve_ivp

import damperopt
from damperopt.dynamics import build
from damperopt.expressions.corners import Smooth
from damperopt.motion.decay import DecayAnalysis
from damperopt.motion.integrators import Integrator, has_compiler
from damperopt.motion.simulate import Simulator
from damperopt.symbols import data_values, symbolic

STUDY = "configs/thesis_gear.yaml"
DESIGN = {"c_lambda": 34803.0, "I_arm": 5.6663e-07, "L": 0.4781, "gamma": 0.53215, "b": 0.15244}
RELEASE, SPEED, LOAD, DURATION, POINTS = math.radians(0.25), 40.0, 150e3, 0.5, 200
SCIPY = {
    "DOP853": [1e-4, 1e-6, 1e-8, 1e-10],
    "RK45": [1e-4, 1e-6, 1e-8],
    "LSODA": [1e-4, 1e-6, 1e-8, 1e-10],
    "BDF": [1e-3, 1e-5, 1e-7],
    "Radau": [1e-3, 1e-5, 1e-7],
}
OURS = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9]
ERRORS = [1e-4, 1e-6, 1e-8]


def gear_in_python(study: damperopt.Study, library: ModuleType) -> Callable:
    """Fifth-order gear with the planar new design; functions of numpy, as usual, or of math, faster for scalars."""
    gear, tyre, lateral = study.gear, study.tyre, study.gear.lateral
    I_z, e, I_x, k, c, l_g = (
        gear.yaw_inertia,
        gear.caster_length,
        lateral.inertia,
        lateral.stiffness,
        lateral.damping,
        lateral.height,
    )
    a, sigma, kappa = tyre.half_contact_length, tyre.relaxation_length, tyre.tread_width_moment
    C_F, C_M, limit = tyre.cornering_coefficient, tyre.aligning_coefficient, tyre.aligning_slip_limit
    ell = DESIGN["L"] * math.sin(DESIGN["gamma"])
    k_torque = 3 * study.material.youngs_modulus * DESIGN["I_arm"] / ell
    c_torque = DESIGN["c_lambda"] * ell**2
    sin, cos, tan, pi = library.sin, library.cos, library.tan, library.pi
    atan = library.atan if library is math else library.arctan

    def rate(t, x):
        psi, psi_rate, delta, delta_rate, y = x.tolist() if library is math else x
        alpha = atan(y / sigma)
        X = atan(7 * tan(alpha))
        side = C_F * X * cos(0.95 * X) * LOAD
        aligning = C_M * limit / pi * sin(pi * alpha / limit) * LOAD if abs(alpha) < limit else 0.0
        s, r = sin(psi), cos(psi)
        torque = k_torque * s * r + c_torque * r * r * psi_rate
        return (
            psi_rate,
            (-torque - e * side - aligning - kappa / SPEED * psi_rate) / I_z,
            delta_rate,
            (-k * delta - c * delta_rate - l_g * side * r * cos(delta) + LOAD * e * s) / I_x,
            SPEED * s + (e - a) * psi_rate * r - SPEED / sigma * y * r + l_g * delta_rate * cos(delta),
        )

    return rate


def compiled_gear(dae, data: list[float]) -> Callable:
    """CasADi's expression of the same model, called through its buffers."""
    values = [ca.DM(list(DESIGN.values())), SPEED, LOAD, ca.DM(data)]
    ode = ca.substitute(dae.ode, ca.vertcat(dae.design, dae.speed, dae.load, dae.data), ca.vertcat(*values))
    ode = ca.substitute(ode, dae.yaw_torque, 0)
    function = ca.Function("rate", [dae.x], [ca.densify(ode)])
    buffer, evaluate = function.buffer()
    x, out = np.zeros(5), np.zeros(5)
    buffer.set_arg(0, memoryview(x))
    buffer.set_res(0, memoryview(out))

    def rate(t, state):
        x[:] = state
        evaluate()
        return out.copy()

    rate.kept_alive = function, buffer  # evaluate holds neither
    return rate


def shortest(work: Callable, repeats: int) -> tuple[float, object]:
    """Least wall time of some calls after a first one [s], and the value."""
    value, best = work(), math.inf
    for _ in range(repeats):
        begin = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - begin)
    return best, value


def time_at(error: float, runs: list[tuple[float, float]]) -> float | None:
    """Time at an error, between runs of (error, time) by their logarithms; the cheapest run that is more accurate otherwise."""
    logs = np.log(np.array(sorted(runs)))
    if not logs[0, 0] <= math.log(error):
        return None
    return float(np.exp(np.interp(math.log(error), logs[:, 0], np.minimum.accumulate(logs[:, 1]))))


def equal_error(study: damperopt.Study, repeats: int) -> None:
    dae, data = build(symbolic(study), Smooth()), data_values(study)
    grid, x0 = np.linspace(0, DURATION, POINTS + 1), np.array([RELEASE, 0, 0, 0, 0])
    python, compiled = gear_in_python(study, math), compiled_gear(dae, data)
    reference = solve_ivp(python, (0, DURATION), x0, "DOP853", grid, rtol=1e-13, atol=1e-18).y[0]
    runs: dict[str, list[tuple[float, float]]] = {}

    def record(name: str, work: Callable, yaw: Callable) -> None:
        seconds, found = shortest(work, repeats)
        runs.setdefault(name, []).append((float(np.abs(yaw(found) - reference).max() / RELEASE), seconds))

    for kind, rate in (("NumPy", gear_in_python(study, np)), ("math", python), ("CasADi", compiled)):
        for method, tolerances in SCIPY.items():
            for rtol in tolerances:
                record(
                    f"SciPy {method}, {kind}",
                    lambda m=method, r=rate, e=rtol: solve_ivp(r, (0, DURATION), x0, m, grid, rtol=e, atol=e * 1e-4),
                    lambda found: found.y[0],
                )
    design = list(DESIGN.values())
    engines = [("erk", True)] * has_compiler() + [("erk", False), ("cvodes", False), ("idas", False)]
    for engine, jit in engines:
        for tolerance in OURS:
            integrator = Integrator(dae, data, POINTS, engine, tolerance, sensitivities=True, compiled=jit)
            name = f"damperopt {engine}{' compiled' if jit else ''}, with 5 sensitivities"
            record(name, lambda i=integrator: i(x0, design, SPEED, LOAD, DURATION), lambda found: found.x[0])
    print("\n| method | " + " | ".join(f"time at error {e:g} [ms]" for e in ERRORS) + " |")
    print("|---|" + "---|" * len(ERRORS))
    for name, found in runs.items():
        cells = [time_at(e, found) for e in ERRORS]
        print(f"| {name} | " + " | ".join("not reached" if c is None else f"{1e3 * c:.2f}" for c in cells) + " |")
    for prefix in ["damperopt erk compiled"] * has_compiler() + ["damperopt cvodes", "damperopt idas"]:
        ratios = []
        for error in ERRORS:

            def best(start: str, error: float = error) -> float:
                return min(t for n, r in runs.items() if start in n and (t := time_at(error, r)) is not None)

            ratios.append(f"{best('SciPy') / best(prefix):.1f} ({best(', NumPy') / best(prefix):.1f})")
        print(f"| SciPy's best (with NumPy) / {prefix} | " + " | ".join(ratios) + " |")


def growth(study: damperopt.Study, repeats: int) -> None:
    dae, data, design = build(symbolic(study), Smooth()), data_values(study), list(DESIGN.values())
    x0 = np.array([RELEASE, 0, 0, 0, 0])
    engine = "erk" if has_compiler() else "cvodes"
    print(f"\n| duration [s] | state [ms] | state and 5 sensitivities [ms] | ({engine}, 400 points a second)")
    print("|---|---|---|")
    for duration in (0.25, 0.5, 1.0, 2.0, 4.0):
        cells = []
        for sensitivities in (False, True):
            integrator = Integrator(dae, data, round(400 * duration), engine, 1e-8, sensitivities)
            cells.append(shortest(lambda i=integrator, d=duration: i(x0, design, SPEED, LOAD, d), repeats)[0])
        print(f"| {duration:g} | " + " | ".join(f"{1e3 * c:.2f}" for c in cells) + " |")
    print("\n| speeds of the first look | search for the worst decay [ms] | worst ratio |")
    print("|---|---|---|")
    for speeds in (8, 16, 32, 64):
        analysis = DecayAnalysis(study.replace(solver__decay_speeds=speeds))
        analysis.worst(DESIGN)
        nudges = iter(1 + 1e-9 * np.arange(1, 100))  # a new design each time: answers are kept
        seconds, found = shortest(
            lambda a=analysis, n=nudges: a.worst({**DESIGN, "c_lambda": DESIGN["c_lambda"] * next(n)}), repeats
        )
        print(f"| {speeds} | {1e3 * seconds:.1f} | {found[0].ratio:.7f} |")


def loop_over_designs(study: damperopt.Study) -> None:
    """Short motions of one simulator with another design each: what is not integration is the price of asking."""
    release = {"release": {"yaw_angle": RELEASE}}
    dampings = DESIGN["c_lambda"] * np.geomspace(0.5, 2, 100)
    print("\n| engine | simulator and first motion [ms] | 0.1 s with another design [ms] | of which not integration [ms] |")
    print("|---|---|---|---|")
    for engine in ["erk"] * has_compiler() + ["cvodes", "idas"]:
        begin = time.perf_counter()
        run = Simulator(study, engine=engine)
        run(SPEED, LOAD, release, 0.1, design=DESIGN)
        first, inside, spent = time.perf_counter() - begin, 0.0, []
        integrate = Integrator.__call__

        def timed(*arguments, integrate=integrate, **options):
            nonlocal inside
            begin = time.perf_counter()
            found = integrate(*arguments, **options)
            inside += time.perf_counter() - begin
            return found

        Integrator.__call__ = timed
        try:
            for c in dampings:
                begin, inside = time.perf_counter(), 0.0
                run(SPEED, LOAD, release, 0.1, design=DESIGN | {"c_lambda": float(c)})
                spent.append((time.perf_counter() - begin, inside))
        finally:
            Integrator.__call__ = integrate
        total, integration = np.array(spent).T
        print(f"| {engine} | {1e3 * first:.0f} | {1e3 * total.min():.2f} | {1e3 * (total - integration).min():.2f} |")


def whole_solution(study: damperopt.Study) -> None:
    print("\n| study | engine | time [s] | mass [kg] |")
    print("|---|---|---|---|")
    cases = [("without decay", study.replace(requirements__decay=None), "auto")]
    cases += [("with decay", study, engine) for engine in ["erk"] * has_compiler() + ["cvodes", "idas"]]
    for name, case, engine in cases:
        begin = time.perf_counter()
        result = damperopt.optimise(case.replace(solver__engine=engine))
        print(f"| {name} | {engine} | {time.perf_counter() - begin:.2f} | {result.mass.total:.4f} |")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=7)
    repeats = parser.parse_args().repeats
    study = damperopt.load(STUDY)
    if not has_compiler():
        print("No C compiler here: the compiled Runge-Kutta method is left out.")
    equal_error(study, repeats)
    growth(study, repeats)
    loop_over_designs(study)
    whole_solution(study)


if __name__ == "__main__":
    main()

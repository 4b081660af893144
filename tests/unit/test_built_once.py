"""Models, integrators and kernels are built once per study and handed on; no plain name simulates."""

import pickle
import time

import numpy as np
import pytest

import damperopt
from damperopt.motion import decay, exact, integrators, simulate
from damperopt.optimum import multistart, problem
from damperopt.stability import linear, screening

RELEASE = {"release": {"yaw_angle": "0.25 deg"}}
DESIGN = {"c_lambda": 34803.0, "I_arm": 5.6663e-07, "L": 0.4781, "gamma": 0.53215, "b": 0.15244}


@pytest.fixture
def builds(monkeypatch):
    """Calls of `dynamics.build` and makings of integrators, by what was called."""
    made = {"model": 0, "integrator": 0}

    def counted(name, work):
        def call(*arguments, **options):
            made[name] += 1
            return work(*arguments, **options)

        return call

    for module in (linear, decay, exact, simulate, problem):
        monkeypatch.setattr(module, "build", counted("model", module.build), raising=False)
    monkeypatch.setattr(integrators, "_create", counted("integrator", integrators._create))
    return made


def test_one_optimisation_builds_each_model_once(main_gear, builds):
    result = damperopt.optimise(main_gear.replace(solver__starts=4))
    assert result.status == "solved"
    # the problem's symbols, its linear model, and the gear with any damper; of the gear in space with elastic parts, which says
    # what the thesis' model leaves out, the symbols and two linear models
    assert 1 <= builds["model"] <= 3 + 3
    assert builds["integrator"] == 0


@pytest.mark.slow
def test_one_optimisation_with_decay_builds_each_model_once(main_gear_with_decay, builds):
    study = main_gear_with_decay.replace(solver__starts=2, solver__engine="cvodes")
    assert damperopt.optimise(study).status == "solved"
    # besides: the smooth gear of the search and the exact one of its check
    assert 1 <= builds["model"] <= 5 + 3
    assert builds["integrator"] == 2  # with and without sensitivities


@pytest.mark.skipif(not integrators.has_compiler(), reason="needs gcc")
def test_studies_that_differ_in_numbers_are_translated_once(main_gear_with_decay):
    integrators._compiled.cache_clear()  # of what other tests have translated
    study = main_gear_with_decay.replace(solver__engine="erk")
    heavier = study.replace(gear__yaw_inertia=1.1 * study.gear.yaw_inertia)
    points = [decay.DecayAnalysis(study).at(DESIGN, 40.0, 150e3)]
    translated = integrators._compiled.cache_info().misses
    points.append(decay.DecayAnalysis(heavier).at(DESIGN, 40.0, 150e3))
    assert integrators._compiled.cache_info().misses == translated
    other = study.replace(damper__topology="utas")
    decay.DecayAnalysis(other).at(other.start, 40.0, 150e3)
    assert integrators._compiled.cache_info().misses == translated + 1
    interpreted = [decay.DecayAnalysis(s.replace(solver__engine="cvodes")).at(DESIGN, 40.0, 150e3) for s in (study, heavier)]
    assert [p.ratio for p in points] == pytest.approx([p.ratio for p in interpreted], rel=1e-4)
    assert points[0].ratio != pytest.approx(points[1].ratio, rel=1e-2)


def test_a_loop_over_designs_builds_nothing_again(main_gear, builds):
    def motions(c):
        return damperopt.simulate(
            main_gear, DESIGN | {"c_lambda": c}, speed=40, disturbance=RELEASE, duration=0.05, engine="cvodes"
        )

    first = motions(3e4)
    built = dict(builds)
    others = [motions(c) for c in np.geomspace(1e4, 1e5, 5)]
    assert builds == built
    again = motions(3e4)
    assert np.array_equal(again["yaw_angle"], first["yaw_angle"])  # no trace of the designs between
    assert len({float(motion["yaw_angle"][-1]) for motion in others}) == 5
    other_study = main_gear.replace(gear__yaw_inertia=main_gear.gear.yaw_inertia * 2)
    moved = damperopt.simulate(other_study, DESIGN, speed=40, disturbance=RELEASE, duration=0.05, engine="cvodes")
    assert moved["yaw_angle"][-1] != first["yaw_angle"][-1]


def test_a_repeated_motion_costs_milliseconds(main_gear):
    run = simulate.Simulator(main_gear, engine="cvodes")
    run(40.0, 150e3, RELEASE, 0.1, design=DESIGN)
    shortest = np.inf
    for c in np.geomspace(1e4, 1e5, 20):
        begin = time.perf_counter()
        run(40.0, 150e3, RELEASE, 0.1, design=DESIGN | {"c_lambda": float(c)})
        shortest = min(shortest, time.perf_counter() - begin)
    assert shortest < 0.02  # building takes longer than that


@pytest.mark.parametrize("kind", [lambda study, design: simulate.Simulator(study, design, "cvodes"), exact.ExactSimulator])
def test_design_of_the_call_is_that_of_the_simulator(main_gear, kind):
    """Both ways to give a design, and the design of one call leaves no trace in the next."""
    run = kind(main_gear, None)
    heavier = DESIGN | {"c_lambda": 6e4}
    at_call = run(40.0, None, RELEASE, 0.05, design=heavier)
    assert np.array_equal(at_call["yaw_angle"], kind(main_gear, heavier)(40.0, None, RELEASE, 0.05)["yaw_angle"])
    assert np.array_equal(
        run(40.0, None, RELEASE, 0.05)["yaw_angle"], kind(main_gear, None)(40.0, None, RELEASE, 0.05)["yaw_angle"]
    )
    with pytest.raises(damperopt.ConfigError, match=r"design\.c_lambda"):
        run(40.0, None, RELEASE, 0.05, design={})


def test_no_plain_function_of_a_design_simulates(main_gear_with_decay, builds):
    kick = {"requirements__limit_event": "simulated", "requirements__decay__kick": {"yaw_rate": 0.5}}
    study = main_gear_with_decay.replace(**kick, requirements__decay__release=None)
    sized = problem.DesignProblem(study)
    for name in ("mass", "parts", "rows", "values", "limit_event", "least_sizes"):
        with pytest.raises(ValueError, match="simulated_factors"):
            getattr(sized, name)(DESIGN)
    peaks = sized.limit_event(DESIGN, problem.ESTIMATED)
    twice = {name: 2 * value for name, value in peaks.items()}
    factors = sized.factors_of(DESIGN, twice)
    assert factors == pytest.approx(2.0)
    assert sized.limit_event(DESIGN, factors) == pytest.approx(twice)
    assert sized.mass(DESIGN, factors) > sized.mass(DESIGN, problem.ESTIMATED)
    assert builds["integrator"] == 0


def test_worker_process_keeps_its_solver_and_changes_it_with_the_study(main_gear, builds, monkeypatch):
    monkeypatch.setattr(multistart._Worker, "solver", None)
    study = main_gear.replace(solver__starts=2)
    first = multistart._Worker.run(study, 0, study.start)
    built = builds["model"]
    copied = pickle.loads(pickle.dumps(study))  # as it reaches a worker: equal, not the same
    assert multistart._Worker.run(copied, 0, study.start).found.solution.objective == first.found.solution.objective
    assert builds["model"] == built
    other = multistart._Worker.run(study.replace(material="Ti-6Al-4V"), 0, study.start)
    assert builds["model"] > built
    assert other.found.solution.objective != first.found.solution.objective


def test_screening_has_no_trace_of_the_damper(main_gear):
    k, c = np.array([2e5, 1e6]), np.array([300.0, 2000.0])
    found = [screening.Screening(main_gear.replace(damper__topology=t)).worst_abscissae(k, c) for t in ("boeing", "utas")]
    assert np.array_equal(*found)

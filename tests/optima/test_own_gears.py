"""Optima of gears of no aircraft: held by an independent model, beaten by no evolution, never lighter when more is asked."""

import json

import numpy as np
import pytest
from attack import Attack, attacked
from frame import compliance
from own_gear import damper_stiffness, least_of, state_matrices
from own_studies import FORMS, GEARS, MARGIN, RATIO, plain_numbers, speeds, study_block

import damperopt
from damperopt.optimum.problem import DesignProblem
from damperopt.study.study import Study

pytestmark = pytest.mark.verify

FRAME = 0.003
"""Relative, of damping ratios through a frame (measured at an optimum of UTAS: 0.001)."""

SAME_MASS = 1e-4
"""Relative; nothing may be lighter by more."""


@pytest.fixture(scope="module", params=GEARS)
def optimum(request):
    study = Study.model_validate(study_block(request.param))
    result = damperopt.optimise(study)
    assert result.status == "solved", result.message
    return request.param, study, result


def test_margin_holds_on_a_frame(optimum):
    """Frame, string tyre and damper with its oil and rod: roots at 200 speeds."""
    topology, study, result = optimum
    d = result.design
    chain = np.array(compliance(topology, d, study.material.youngs_modulus, *FORMS[topology]))[:, None]
    c, k = np.array([d["c_lambda"]]), np.array([damper_stiffness(d)])
    abscissa, ratio = least_of(state_matrices(speeds(topology, 200), plain_numbers(topology), chain, c, k))
    assert abscissa[0] < -MARGIN
    assert ratio[0] > RATIO * (1 - FRAME)
    assert result.verification.passed
    assert all(row.value > -1e-6 for row in result.margins)


def test_no_evolution_finds_a_lighter_design(optimum):
    """Mass and rows by the plain functions, roots by the own matrix: the penalised mass of 150 generations."""
    topology, study, result = optimum
    attack = Attack(DesignProblem(study), topology)
    own = np.array([[result.design[name] for name in attack.names]])
    mass, over = attack.violation(own)
    assert mass[0] == pytest.approx(result.mass.total, rel=1e-9)
    assert over[0] < 10 * RATIO * FRAME  # the optimum is one of the own problem too, but for the arm's shortening
    for seed in (1, 2):
        lightest, _ = attacked(attack, 150, seed)
        assert lightest > result.mass.total * (1 - SAME_MASS)


def test_more_starts_find_nothing_lighter(optimum):
    _, study, result = optimum
    more = damperopt.optimise(study.replace(solver__starts=64, solver__seed=7))
    assert more.mass.total > result.mass.total * (1 - SAME_MASS)


def asked(kind, block, factor):
    """A study and one that asks for more of one kind, by a factor."""
    less, more = (json.loads(json.dumps(block)) for _ in range(2))
    F = block["envelope"]["vertical_load"]

    def steel(weaker):
        return {
            "name": "a steel",
            "youngs_modulus": 207e9,
            "density": 7850.0,
            "yield_strength": 1.2e9 / weaker,
            "ultimate_strength": 1.5e9 / weaker,
        }

    keys = {
        "ultimate_factor": 1.5,
        "limit_factor": 1.5,
        "limit_torque_factor": 1.5,
        "damping_ratio": RATIO,
        "stability_margin": 3.0,
    }
    for study, times in ((less, 1.0), (more, factor)):
        if kind in keys:
            study["requirements"][kind] = keys[kind] * times
        elif kind == "loads":
            study["loads"] = {"landing_vertical": 2 * F * times, "static_reaction": 1.2 * F * times}
        elif kind == "allowable":
            study["material"] = steel(times)
        else:
            study["requirements"]["service_torque"] = 900.0 / times  # a stroke is harder to have at less torque
    return less, more


KINDS = (
    "ultimate_factor",
    "limit_factor",
    "limit_torque_factor",
    "damping_ratio",
    "stability_margin",
    "loads",
    "allowable",
    "stroke",
)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("topology", GEARS)
def test_more_asked_is_never_lighter(topology, kind, seed):
    rng = np.random.default_rng([seed, KINDS.index(kind), len(topology)])
    block = study_block(topology, starts=4)
    for room, key, spread in (("gear", "yaw_inertia", 0.5), ("gear", "caster_length", 0.4), ("tyre", "relaxation_length", 0.3)):
        block[room][key] *= float(np.exp(rng.uniform(-spread, spread)))
    results = [damperopt.optimise(Study.model_validate(one)) for one in asked(kind, block, 1 + 0.4 * rng.random())]
    less, more = (result.mass.total if result.status == "solved" else np.inf for result in results)
    assert more >= less * (1 - SAME_MASS), [result.message for result in results]


def test_more_moment_of_the_tyre_is_never_lighter(configs):
    """UTAS without decay: a local optimum, and a stroke under the limit torque, once made the larger factor lighter."""
    study = damperopt.load(configs / "main_gear.yaml").replace(
        damper__topology="utas",
        requirements__decay=None,
        requirements__damping_ratio=None,
        loads__cases=["tyre_moment"],
        solver__starts=6,
    )
    masses = [damperopt.optimise(study.replace(requirements__limit_torque_factor=f)).mass.total for f in (1.5, 1.55, 1.6)]
    assert masses[0] < masses[1] < masses[2]

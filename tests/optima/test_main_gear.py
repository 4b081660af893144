"""The main gear, frozen: regression, not validation (other files in this folder find these optima in other ways)."""

import pytest

import damperopt

pytestmark = pytest.mark.slow

# mass [kg], design, constraints active at the optimum; margin 0.1 1/s, 5-100 m/s, 150 kN, AISI 4340
FROZEN = {
    "boeing": (
        10.978193,
        {"c_lambda": 3003.2, "k_lambda": 2.76217e7, "L": 0.545313, "gamma": 0.714334},
        {"stability_margin", "rod_minimum", "working_stroke", "tyre_clearance"},
    ),
    "utas": (
        13.185723,
        {"c_lambda": 49487.0, "I_arm": 8.8508e-7, "L": 0.490205, "gamma": 0.572656, "b": 0.133577},
        {"stability_margin", "rod_minimum", "working_stroke", "tyre_clearance"},
    ),
    "arreaza": (
        11.415172,
        {"c_lambda": 10804.1, "I_arm": 5.66628e-7, "L": 0.473503, "gamma": 0.515371, "b": 0.143205},
        {"stability_margin", "arm_stress", "rod_minimum", "tyre_clearance", "damper_length"},
    ),
}
MASS, DESIGN = 1e-6, 1e-4  # the objective is flat: designs agree less closely than masses


@pytest.mark.parametrize("topology", FROZEN)
def test_frozen_optimum(topology, optimum):
    mass, design, active = FROZEN[topology]
    result = optimum(topology)
    assert result.status == "solved"
    assert result.mass.total == pytest.approx(mass, rel=MASS)
    for name, value in design.items():
        assert result.design[name] == pytest.approx(value, rel=DESIGN), name
    assert {c.name for c in result.constraints if c.active} == active
    assert result.certificate.proved
    assert result.verification.passed
    assert result.verification.kkt_residual < 1e-6


@pytest.mark.parametrize("topology", FROZEN)
def test_answer_does_not_depend_on_seed_or_workers(topology, main_gear, optimum):
    other = damperopt.optimise(main_gear.replace(damper__topology=topology, solver__seed=7), workers=2)
    assert other.mass.total == pytest.approx(optimum(topology).mass.total, rel=MASS)


@pytest.mark.parametrize("topology", FROZEN)
def test_no_design_variable_rests_on_a_bound(topology, optimum, main_gear):
    """The bounds of thesis_gear.yaml only frame the search; what stops a design is a requirement with a reason."""
    for name, value in optimum(topology).design.items():
        variable = main_gear.variable(name)
        assert variable.min * 1.01 < value < variable.max * 0.99


def test_single_starts_miss_the_best_of_several_local_optima(main_gear, optimum):
    """UTAS has at least two: the config's own start and others end in heavier ones."""
    optima = optimum("utas").local_optima
    assert len(optima) >= 2
    assert optima[0].starts < sum(o.starts for o in optima)
    assert optima[1].mass > optima[0].mass * 1.02
    heavier = optima[1].design
    changes = {f"design__{name}__start": value for name, value in heavier.items()}
    single = damperopt.optimise(main_gear.replace(damper__topology="utas", solver__starts=1, **changes))
    assert single.status == "solved"  # a proved design, but not the lightest
    assert single.mass.total == pytest.approx(optima[1].mass, rel=1e-5)


@pytest.mark.parametrize(
    ("heavier", "key", "values"),
    [
        (True, "requirements__stability_margin", (0.0, 0.1, 0.2)),
        (True, "requirements__safety_factor", (1.2, 1.5, 2.0)),
        (True, "envelope__vertical_load", (100e3, 150e3, 200e3)),
        (True, "requirements__tyre_clearance", (0.02, 0.05, 0.1)),
        (False, "mass__working_pressure", (10e6, 20e6, 40e6)),
        (True, "mass__dead_length", (0.08, 0.12, 0.2)),
    ],
)
def test_mass_is_monotone_where_physics_says_so(heavier, key, values, main_gear):
    masses = [damperopt.optimise(main_gear.replace(**{key: value}, solver__starts=2)).mass.total for value in values]
    assert masses == sorted(masses, reverse=not heavier)
    assert masses[0] != masses[-1]

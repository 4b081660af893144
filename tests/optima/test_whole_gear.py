"""The main gear with everything in, frozen: regression, not validation; others in this folder attack such optima."""

import pytest

import damperopt

pytestmark = pytest.mark.slow

# mass [kg], design, constraints active at the optimum of configs/main_gear.yaml
FROZEN = {
    "arreaza": (
        15.0240114,
        {"c_lambda": 28029.8, "I_arm": 1.0725113e-6, "L": 0.5550806, "gamma": 0.7343977, "b": 0.1808912}
        | {"A_piston": 6.450462e-4, "rod_diameter": 0.012, "s_damper": 9.940665e-3}
        | {"A_link": 2.3002921e-4, "A_support": 1.6002465e-4},
        {
            "damping_ratio",
            "arm_ultimate",
            "link_buckling",
            "support_buckling",
            "rod_minimum",
            "piston_pressure",
            "damper_stroke",
        }
        | {"tyre_clearance", "damper_length"},
    ),
    "utas": (
        17.1272311,
        {"c_lambda": 164529.5, "I_arm": 1.018577e-6, "L": 0.5742334, "gamma": 0.7706209, "b": 0.0981429}
        | {"A_piston": 1.739776e-3, "rod_diameter": 0.012, "s_damper": 0.00508, "A_link": 2.294807e-4},
        {"damping_ratio", "arm_ultimate", "link_buckling", "rod_minimum", "piston_pressure", "damper_stroke", "working_stroke"}
        | {"reach_max", "tyre_clearance"},
    ),
    "boeing": (
        8.7014159,
        {"c_lambda": 90983.3, "k_lambda": 7086614.0, "L": 0.5742334, "gamma": 0.7706209}
        | {"A_piston": 1.104845e-3, "rod_diameter": 0.012, "s_damper": 0.00508, "A_link": 2.294807e-4},
        {"damping_ratio", "link_buckling", "rod_minimum", "piston_pressure", "damper_stroke", "working_stroke", "reach_max"}
        | {"tyre_clearance"},
    ),
}
MASS, DESIGN = 1e-6, 1e-4  # the objective is flat: designs agree less closely than masses


@pytest.mark.parametrize("topology", FROZEN)
def test_frozen_optimum(topology, configs):
    mass, design, active = FROZEN[topology]
    study = damperopt.load(configs / "main_gear.yaml").replace(damper__topology=topology, solver__starts=1)
    result = damperopt.optimise(study)
    assert result.status == "solved", result.message
    assert result.mass.total == pytest.approx(mass, rel=MASS)
    for name, value in design.items():
        assert result.design[name] == pytest.approx(value, rel=DESIGN), name
    assert {c.name for c in result.constraints if c.active} == active
    assert result.certificate.method == "balls"
    assert min(margin.value for margin in result.margins) > -1e-6

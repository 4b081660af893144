"""The main gear with everything in, frozen: regression, not validation; others in this folder attack such optima."""

import pytest

import damperopt

pytestmark = pytest.mark.slow

# mass [kg], design, constraints active at the optimum of configs/main_gear.yaml
FROZEN = {
    "arreaza": (
        17.1757787,
        {"c_lambda": 33320.2, "I_arm": 1.0241587e-6, "L": 0.5720368, "gamma": 0.7666577, "b": 0.1849796}
        | {"A_piston": 7.391172e-4, "rod_diameter": 0.012, "s_damper": 0.010679722}
        | {"A_link": 2.2951124e-4, "I_hinge": 1.7443995e-7, "A_support": 1.762418e-4, "I_foot": 1.115379e-7},
        {"damping_ratio", "arm_ultimate", "link_buckling", "support_buckling", "rod_minimum", "piston_pressure"}
        | {"damper_stroke", "tyre_clearance", "damper_length"},
    ),
    "utas": (
        16.5507774,
        {"c_lambda": 132052.2, "I_arm": 1.0741623e-6, "L": 0.5678836, "gamma": 0.7590345, "b": 0.1171125}
        | {
            "A_piston": 1.4880434e-3,
            "rod_diameter": 0.012,
            "s_damper": 0.00508,
            "A_link": 2.2959022e-4,
            "I_hinge": 1.7428467e-7,
        },
        {"damping_ratio", "beam_ultimate", "hinge_ultimate", "link_buckling", "rod_minimum", "piston_pressure", "damper_stroke"}
        | {"working_stroke", "tyre_clearance"},
    ),
    "boeing": (
        11.4368066,
        {"c_lambda": 86857.1, "k_lambda": 4913702.7, "L": 0.5742334, "gamma": 0.7706209}
        | {
            "A_piston": 1.2443401e-3,
            "rod_diameter": 0.012,
            "s_damper": 7.3264508e-3,
            "A_link": 2.2948074e-4,
            "I_hinge": 1.7377287e-7,
        },
        {"damping_ratio", "hinge_ultimate", "link_buckling", "rod_minimum", "piston_pressure", "damper_stroke", "reach_max"}
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

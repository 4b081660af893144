"""Mass and strength against a second calculation, typed out from the model's description (docs/study.md) in plain floats."""

import math

import numpy as np
import pytest

from damperopt.optimum.problem import DesignProblem

PI = math.pi
ROUNDING = 1e-12

# Table 0.1 (thesis): T = 1.5 (F_z C_M alpha_m/pi + e max F_y), max F_y from a fine scan of the tyre law
X = np.linspace(0, PI / 2, 2_000_001)
SIDE = 0.002 * float(np.max(X * np.cos(0.95 * X))) * 150e3
TORQUE = 1.5 * (150e3 * 1.0 * math.radians(10) / PI + 0.12 * SIDE)

STEEL = {"E": 207e9, "rho": 7830.0, "sigma": 1103e6 / 1.5}
TUBE_AREA = PI / 4 * (1 - 0.8**2)  # of outer diameter 1 and wall 0.1
TUBE_INERTIA = PI / 64 * (1 - 0.8**4)


def tube_area(inertia):
    return TUBE_AREA * math.sqrt(inertia / TUBE_INERTIA)


def tube_area_for_modulus(modulus):
    diameter = (modulus / (2 * TUBE_INERTIA)) ** (1 / 3)
    return TUBE_AREA * diameter**2


def damper_mass(force, stroke):
    length = 2 * stroke + 0.12
    rod = max(
        math.sqrt(4 * force / (PI * STEEL["sigma"])),
        (64 * 2 * force * length**2 / (PI**3 * STEEL["E"])) ** 0.25,
        0.012,
    )
    bore = math.sqrt(4 * force / (PI * 20.7e6) + rod**2)
    wall = 0.002 + 20.7e6 * bore / (2 * STEEL["sigma"])
    cap = 0.002 + bore / 2 * math.sqrt(0.75 * 20.7e6 / STEEL["sigma"])
    cylinder = PI * (bore + wall) * wall * length
    caps = 2 * PI / 4 * (bore + 2 * wall) ** 2 * cap
    steel = cylinder + PI / 4 * rod**2 * length + caps
    return 1.5 * STEEL["rho"] * steel + 860 * force / 20.7e6 * length, rod, bore


def cantilever_mass(force, length):
    return 1.2 * 0.6 * STEEL["rho"] * length * tube_area_for_modulus(force * length / STEEL["sigma"])


def problem_of(main_gear, topology):
    return DesignProblem(main_gear.replace(damper__topology=topology))


def test_boeing_part_by_part(main_gear):
    design = {"c_lambda": 9000.0, "k_lambda": 8e6, "L": 0.6, "gamma": math.radians(31)}
    ell = 0.6 * math.sin(design["gamma"])
    k_psi = 8e6 * ell**2
    psi = TORQUE / k_psi
    stroke, force = ell * psi, 9000 * ell * psi * math.sqrt(k_psi / 100)
    energy_per_volume = 0.3 * STEEL["sigma"] ** 2 / (2 * STEEL["E"])
    expected = {
        "torque links": 2 * cantilever_mass(TORQUE / ell, 0.6),
        "spring": STEEL["rho"] * TORQUE * psi / 2 / energy_per_volume,
        "damper": damper_mass(force, stroke)[0],
    }
    assert problem_of(main_gear, "boeing").parts(design) == pytest.approx(expected, rel=ROUNDING)


def test_arreaza_part_by_part(main_gear):
    design = {"c_lambda": 20e3, "I_arm": 1e-6, "L": 0.55, "gamma": 0.6, "b": 0.18}
    ell = 0.55 * math.sin(0.6)
    k_psi = 3 * STEEL["E"] * 1e-6 / ell
    psi = TORQUE / k_psi
    stroke, force = ell * psi, 20e3 * ell * psi * math.sqrt(k_psi / 100)
    mass, rod, bore = damper_mass(force, stroke)
    expected = {
        "torque links": cantilever_mass(TORQUE / ell, 0.55),
        "bending arm": 1.2 * STEEL["rho"] * 0.55 * tube_area(1e-6),
        "damper": mass,
        "support arm": cantilever_mass(force, 0.18),
    }
    problem = problem_of(main_gear, "arreaza")
    assert problem.parts(design) == pytest.approx(expected, rel=ROUNDING)
    assert problem.least_sizes(design)["rod_diameter"] == pytest.approx(rod, rel=ROUNDING)
    values = problem.values(design)
    diameter = (1e-6 / TUBE_INERTIA) ** 0.25
    stress = TORQUE / ell * ell * (diameter / 2) / 1e-6  # root moment of the tip force T/ell on an arm of length ell
    assert values["arm_stress"] == pytest.approx((stress, STEEL["sigma"]), rel=ROUNDING)
    assert values["arm_fatigue"] == pytest.approx((stress / 2, 1758e6 * 2e6**-0.0977), rel=ROUNDING)
    assert values["damper_length"] == pytest.approx((0.18, 3 * stroke + 0.12 + bore), rel=ROUNDING)
    assert values["working_stroke"] == pytest.approx((stroke, 1.27e-3), rel=ROUNDING)
    assert values["tyre_clearance"] == pytest.approx((0.55 * math.cos(0.6) - 0.362, 0.05), rel=1e-11)
    assert values["lug_distance_max"] == pytest.approx((1.1 * math.cos(0.6), 1.1), rel=ROUNDING)
    assert values["reach_max"] == pytest.approx((ell, 0.4), rel=ROUNDING)


def test_utas_stress_is_that_of_the_deflected_cantilever(main_gear):
    """3 E eps h_f/R^2 with eps the tip deflection at the static yaw of the limit event."""
    design = {"c_lambda": 50e3, "I_arm": 9e-7, "L": 0.5, "gamma": 0.57, "b": 0.14}
    ell = 0.5 * math.sin(0.57)
    R = math.hypot(ell, 0.14)
    lever = ell**2 / R
    k_psi = 3 * STEEL["E"] * 9e-7 / R**3 * lever**2
    eps = lever * TORQUE / k_psi
    fibre = (9e-7 / TUBE_INERTIA) ** 0.25 / 2
    problem = problem_of(main_gear, "utas")
    assert problem.values(design)["arm_stress"][0] == pytest.approx(3 * STEEL["E"] * eps * fibre / R**2, rel=ROUNDING)
    arm = 1.2 * STEEL["rho"] * math.hypot(0.5, 0.14) * tube_area(9e-7)  # true length, not the view from the top
    assert problem.parts(design)["bending arm"] == pytest.approx(arm, rel=ROUNDING)
    assert problem.yaw_numbers(design)["torsional_stiffness"] == pytest.approx(k_psi, rel=ROUNDING)


def test_laminate_is_sized_by_strain_and_given_torque_replaces_the_derived_one(main_gear):
    study = main_gear.replace(material="CFRP UD", requirements__limit_torque=10e3, requirements__ultimate_factor=1.5)
    problem = DesignProblem(study)
    design = study.start
    assert problem.limit_event(design)["linkage_torque"] == 10e3
    assert problem.values(design)["arm_stress"][1] == pytest.approx(140e9 * 0.0045 / 1.5)  # at ultimate load
    assert "arm_fatigue" not in problem.values(design)  # no Basquin data


def test_many_designs_at_once_are_the_same_as_one_by_one(main_gear):
    for topology in ("boeing", "utas", "arreaza"):
        problem = problem_of(main_gear, topology)
        base = np.array(list(problem.study.start.values()))
        designs = base * np.random.default_rng(4).uniform(0.8, 1.2, (7, base.size))
        found = problem.over_designs(designs)
        for i, row in enumerate(designs):
            design = dict(zip(problem.design_names, row, strict=True))
            assert found["mass"][i] == pytest.approx(problem.mass(design), rel=ROUNDING)
            assert found["rows"][i] == pytest.approx(list(problem.rows(design).values()), rel=1e-9, abs=1e-12)
            numbers = problem.yaw_numbers(design)
            assert found["torsional_stiffness"][i] == pytest.approx(numbers["torsional_stiffness"], rel=ROUNDING)
            assert found["torsional_damping"][i] == pytest.approx(numbers["torsional_damping"], rel=ROUNDING)


def test_less_damping_is_never_heavier(main_gear):
    """The scan of starting points rests on it."""
    for topology in ("boeing", "utas", "arreaza"):
        problem = problem_of(main_gear, topology)
        start = problem.study.start
        dampings = np.geomspace(100, 1e6, 40)
        masses = [problem.mass(start | {"c_lambda": c}) for c in dampings]
        worst_rows = [max(problem.rows(start | {"c_lambda": c}).values()) for c in dampings]
        assert np.all(np.diff(masses) >= 0)
        assert np.all(np.diff(worst_rows) >= -1e-12)

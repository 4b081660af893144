"""Load table, margins of safety and energy of three gears of no aircraft, each number written out once more."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from frame import compliance
from own_gear import damper_stiffness, released_force
from own_studies import FORMS, FRICTION, GEARS, LATERAL, study_block
from scipy.integrate import cumulative_simpson

import damperopt
from damperopt.optimum.margins import load_rows, margins
from damperopt.optimum.problem import DesignProblem
from damperopt.strength.cylinder import rod_column
from damperopt.strength.margins import Column, column_margins
from damperopt.study.mass_model import MassModel
from damperopt.study.study import Study

STRENGTHS = {"boeing": (205e9, 1586e6, 1931e6), "utas": (207e9, 1103e6, 1172e6), "arreaza": (117e9, 1185e6, 1233e6)}
"""Modulus, yield, rupture of each gear's material [Pa], typed from the tables of the library."""

DESIGNS = {
    "boeing": {"c_lambda": 7.5e3, "k_lambda": 1.9e6, "L": 0.47, "gamma": 0.8, "A_link": 1.2e-4, "I_hinge": 2e-7},
    "utas": {"c_lambda": 5.2e4, "I_arm": 9.4e-7, "L": 0.6, "gamma": 0.73, "b": 0.13, "A_link": 2.3e-4, "I_hinge": 4.5e-7},
    "arreaza": {"c_lambda": 3.3e4, "I_arm": 8e-7, "L": 0.5, "gamma": 0.6, "b": 0.21, "I_link": 2.1e-6, "I_support": 7.5e-7},
}
DAMPER = {"A_piston": 9.5e-4, "rod_diameter": 0.013, "s_damper": 0.016}

EXACT = 1e-9
QUADRATURE = 1e-4
"""Of the energy at the start; Simpson's rule over the points of a trajectory (measured: 1.2e-5)."""

FRAME = 0.01
"""Relative, where a number comes through the frame (tests/unit/test_frame.py: half of it)."""


@pytest.fixture(params=GEARS)
def case(request):
    study = Study.model_validate(study_block(request.param))
    assert (study.material.youngs_modulus, study.material.yield_strength) == STRENGTHS[request.param][:2]
    return request.param, study, DESIGNS[request.param] | DAMPER


def table(topology):
    """Yaw torque of each case [N m]: brush tyre, one wheel, all verticals the load of the envelope."""
    g = GEARS[topology]
    F, e, a = g["F_z"], g["e"], g["a"]

    def turned(side, drag=0.0):
        u = math.hypot(side, drag) / 0.8
        left = 3 * (1 - u) * (1 - (1 - u) ** (1 / 3)) / u
        return side * (e + left * a / 3)

    return {
        "tyre_moment": 1.5 * FRICTION * F * (27 / 256 * a + e),  # largest of h (1 - h)^3 is 27/256
        "side_load": F * 0.8 * e,  # no landing vertical is given: it stands for the vertical of the case
        "drift_landing": F * turned(0.25, 0.4),
        "turning": F * turned(0.5),
        "braked_roll": 0.0,
        "pivoting": 0.8 * F * a / 2,
        "reversed_braking": 0.0,
    }


def test_load_table(case):
    topology, study, design = case
    rows = {row.case: row for row in load_rows(study, design, {}) if not row.off}
    expected, reach = table(topology), design["L"] * math.sin(design["gamma"])
    assert rows.keys() == expected.keys()
    for name, torque in expected.items():
        assert rows[name].yaw_torque == pytest.approx(torque, rel=EXACT, abs=1e-9), name
        assert rows[name].apex_force == pytest.approx(torque / reach, rel=EXACT, abs=1e-9), name
    assert {name for name, row in rows.items() if row.sizing} == {max(expected, key=expected.__getitem__)}


def tube(A=None, I=None):
    """Area, second moment, outer diameter of a tube whose wall is a tenth of it."""
    d = math.sqrt(A / (math.pi * 0.09)) if A else (I / (math.pi / 64 * (1 - 0.8**4))) ** 0.25
    return math.pi * 0.09 * d**2, math.pi / 64 * (1 - 0.8**4) * d**4, d


def bending(force, lever, I):
    return force * lever * tube(I=I)[2] / 2 / I


def test_margins_of_the_largest_case(case):
    topology, study, design = case
    E, strength, rupture = STRENGTHS[topology]
    T, L, b = table(topology)["tyre_moment"], design["L"], design.get("b", 0.0)
    F, w = T / (L * math.sin(design["gamma"])), L / 2
    found = {(m.part, m.check): m for m in margins(study, design, {}) if m.case == "tyre_moment"}

    def holds(part, check, margin, rel=EXACT):
        assert 1 + found.pop((part, check)).value == pytest.approx(1 + margin, rel=rel), (part, check)

    def of_stress(part, stress, rel=EXACT):
        holds(part, "yield", strength / stress - 1, rel)
        holds(part, "rupture", rupture / (1.5 * stress) - 1, rel)

    if FORMS[topology][0] == "a_frame":
        leg = math.hypot(L, w / 2)
        (A, I, _), N = tube(A=design["A_link"]), F * leg / w
        of_stress("torque links", N / A)
        euler = math.pi**2 * E * I / leg**2 / A
        column = euler if euler < strength / 2 else strength * (1 - strength / 4 / euler)
        holds("torque links", "column", column / (1.5 * N / A) - 1)
        # the feet pull with F L/w at w/2 from the middle, and push each half with F/2
        of_stress("link hinges", bending(F, L / 2, design["I_hinge"]) + F / 2 / tube(I=design["I_hinge"])[0])
    else:
        of_stress("torque links", bending(F, L, design["I_link"]))
    if topology == "utas":
        # both ends of the near half bear the arm's moment; the apex pushes the arm with F b/l, and that half with F
        area = tube(I=design["I_arm"])[0]
        of_stress("bending arm", bending(F, L, design["I_arm"]) + F * b / math.hypot(L, b) / area)
        of_stress("hinge line", bending(F, L, design["I_arm"]) + F / area)
    elif topology == "arreaza":
        of_stress("bending arm", bending(F, L, design["I_arm"]))
    chain = compliance(topology, design, E, *FORMS[topology])
    S = released_force(T, GEARS[topology]["I_z"], chain, design["c_lambda"], damper_stiffness(design))
    if topology == "arreaza":  # on the strut: the damper's force has the lever ell
        of_stress("support", bending(S, L * math.sin(design["gamma"]), design["I_support"]), FRAME)
    rod, steel = design["rod_diameter"], STRENGTHS["utas"]
    stress = S / (math.pi / 4 * rod**2)
    holds("damper rod", "yield", steel[1] / stress - 1, FRAME)
    holds("damper rod", "rupture", steel[2] / (1.5 * stress) - 1, FRAME)
    length = 2 * design["s_damper"] + 0.12
    euler = math.pi**2 * steel[0] * (rod / 4) ** 2 / length**2
    column = euler if euler < steel[1] / 2 else steel[1] * (1 - steel[1] / 4 / euler)
    holds("damper rod", "column", column / (1.5 * stress) - 1, FRAME)
    bore = math.sqrt(4 * design["A_piston"] / math.pi + rod**2)
    wall = 2e-3 + 20.7e6 * bore / (2 * min(steel[1], steel[2] / 1.5))
    hoop = S / design["A_piston"] * bore / (2 * wall)
    holds("damper cylinder", "proof pressure", steel[1] / (1.5 * hoop) - 1, FRAME)
    holds("damper cylinder", "burst pressure", steel[2] / (2 * hoop) - 1, FRAME)
    holds("damper", "stroke", design["s_damper"] / (chain[1] * T) - 1, FRAME)
    left = {check for part, check in found if part != "spring"}  # which has a test of its own
    assert left <= {"wall", "bearing", "shear-out", "net tension", "double shear"}


def test_energy_of_a_transient(case):
    """What the tyre does and a release brings is in motion and in springs, or has become heat in the damper."""
    topology, study, design = case
    speed, g, lateral = 30.0, GEARS[topology], LATERAL.get(topology)
    disturbance = {"release": {"yaw_angle": 0.01}}
    motion = damperopt.simulate(study, design, speed=speed, disturbance=disturbance, duration=0.25, tolerance=1e-10)
    t, x, out = motion.time, motion.states, motion.outputs
    psi, rate = x["yaw_angle"], x["yaw_rate"]
    link = damperopt.linkages.elastic.elastic_linkage(study, design)
    ell = design["L"] * math.sin(design["gamma"])
    K_t, k_s = float(link.links) * ell**2, float(link.series)
    kept = g["I_z"] / 2 * rate**2 + out["linkage_torque"] ** 2 / (2 * K_t)
    kept = kept + out["spring_force"] * out["spring_deflection"] / 2 + out["damper_force"] ** 2 / (2 * k_s)
    power = -g["e"] * out["side_force"] * rate - out["aligning_moment"] * rate
    lost = out["damper_force"] * out["damper_speed"]
    if lateral:
        delta, delta_t = x["bending_angle"], x["bending_rate"]
        kept = kept + lateral["I_x"] / 2 * delta_t**2 + lateral["k_d"] / 2 * delta**2
        lost = lost + lateral["c_d"] * delta_t**2
        side = -lateral["l_g"] * out["side_force"] * np.cos(psi) * np.cos(delta)
        power = power + (side + g["F_z"] * g["e"] * np.sin(psi)) * delta_t
    change = cumulative_simpson(power - lost, x=t, initial=0)
    assert np.ptp(kept) > 0.5 * kept[0], "nothing happens"
    assert np.abs(kept - kept[0] - change).max() < QUADRATURE * kept[0]


@pytest.mark.parametrize(("force", "stroke"), [(2e3, 0.02), (40e3, 0.004), (150e3, 0.006)])
def test_rod_is_sized_as_its_margin_checks_it(force, stroke):
    """Slender and stocky rods: at the least diameter the margin of the column is nothing left."""
    model = MassModel()
    event = SimpleNamespace(damper_force=force, stroke=stroke, ultimate_factor=1.5)
    diameter, length = rod_column(event, model), 2 * stroke + model.dead_length
    column = Column(math.pi / 4 * diameter**2, math.pi / 64 * diameter**4, length)
    (margin,) = column_margins("rod", "case", force, column, model.damper_material, 1.5)
    assert margin.value == pytest.approx(0.0, abs=1e-12)


def test_spring_stores_the_limit_torque_at_its_allowable_stress():
    """Half F^2/k in a volume that holds eta sigma^2/(2 E): its margins are those of this stress, and of the spectrum."""
    study, design = Study.model_validate(study_block("boeing")), DESIGNS["boeing"] | DAMPER
    F = table("boeing")["tyre_moment"] / (design["L"] * math.sin(design["gamma"]))
    E, strength, rupture = STRENGTHS["utas"]
    volume = DesignProblem(study).parts(design)["spring"] / 7830
    stress = math.sqrt(2 * E * F**2 / (2 * design["k_lambda"]) / (0.3 * volume))
    found = {(m.check, m.case): m.value for m in margins(study, design, {}) if m.part == "spring"}
    assert found["yield", "tyre_moment"] == pytest.approx(strength / stress - 1, rel=EXACT)
    assert found["rupture", "tyre_moment"] == pytest.approx(rupture / (1.5 * stress) - 1, abs=EXACT)
    assert min(found.values()) == pytest.approx(0.0, abs=1e-9)
    hard = study.replace(requirements__fatigue={"spectrum": {"turn_share": 1.0, "turns": 500.0}})
    heavier = DesignProblem(hard).parts(design)["spring"]
    assert heavier > 1.5 * volume * 7830
    assert min(m.value for m in margins(hard, design, {}) if m.part == "spring") > -1e-9

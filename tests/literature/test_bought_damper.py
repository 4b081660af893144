"""A bought damper: Maxwell's element written out by hand, and what its row allows."""

import math

import numpy as np
import pytest
from scipy.linalg import expm

import damperopt
from damperopt.linkages.elastic import elastic_linkage
from damperopt.optimum.margins import margins
from damperopt.optimum.problem import DesignProblem
from damperopt.stability.linear import LinearModel
from damperopt.strength.limit_event import limit_event

ROW = {
    "name": "of no maker",
    "c": 2e4,
    "stroke": 0.008,
    "length": 0.17,
    "force": 2e4,
    "mass": 3.5,
    "series_stiffness": 3e7,
}
LAYOUT = {"k_lambda": 4e6, "L": 0.5, "gamma": math.radians(30)}
ELL = 0.25


def gear(configs, **damper):
    study = damperopt.load(configs / "thesis_gear.yaml")
    return study.replace(damper={"topology": "boeing", "geometry": "planar", "kind": "bought", "row": ROW, **damper})


def by_hand(V, k, c, k_s):
    """Table 0.1 of the thesis with spring k and Maxwell element (k_s, c) at the apex: psi, psi', delta, delta', y, d."""
    a, e, I_z, I_x, F_z, C_F, C_M, sigma = 0.1, 0.12, 100.0, 600.0, 150e3, 0.014, 1.0, 0.3
    k_d, c_d, l_g, kappa = 6.1e6, 300.0, 2.5, 570.0
    K = (k + k_s) * ELL**2
    return np.array(
        [
            [0, 1, 0, 0, 0, 0],
            [-K / I_z, -kappa / V / I_z, 0, 0, -(e * C_F + C_M) * F_z / (I_z * sigma), k_s * ELL / I_z],
            [0, 0, 0, 1, 0, 0],
            [F_z * e / I_x, 0, -k_d / I_x, -c_d / I_x, -l_g * C_F * F_z / (I_x * sigma), 0],
            [V, e - a, 0, l_g, -V / sigma, 0],
            [k_s * ELL / c, 0, 0, 0, 0, -k_s / c],
        ]
    )


@pytest.mark.parametrize("V", [5.0, 20.0, 100.0])
def test_maxwell_element_by_hand(configs, V):
    mine = np.linalg.eigvals(LinearModel(gear(configs, compliance="rigid")).at(LAYOUT).matrices(V, 150e3)[0])
    theirs = np.linalg.eigvals(by_hand(V, 4e6, ROW["c"], ROW["series_stiffness"]))
    assert np.abs(np.sort_complex(mine) - np.sort_complex(theirs)).max() < 1e-9 * np.abs(theirs).max()


def test_largest_force_is_that_of_the_chain_that_is_let_go(configs):
    """Against the matrix exponential of I psi'' = -K (psi - p), K (psi - p) = k p + k_s (p - d), c d' = k_s (p - d)."""
    study = gear(configs, compliance={"link": "sized", "support": "rigid", "arm": "rigid"})
    design = {**LAYOUT, "A_link": 3e-4, "I_hinge": 5e-7}
    link = elastic_linkage(study, design)
    event = limit_event(study, link, design, max(study.envelope.loads))
    torque, inertia = float(event.torque), study.gear.yaw_inertia
    K, k, k_s, c = (float(x) * ELL**2 for x in (link.links, 4e6, ROW["series_stiffness"], ROW["c"]))
    p = np.array([K, 0, k_s]) / (K + k + k_s)  # of psi, psi', d
    A = np.array([[0, 1, 0], -K / inertia * (np.array([1, 0, 0]) - p), k_s / c * (p - np.array([0, 0, 1]))])
    start, step = np.array([torque / K + torque / k, 0, torque / k]), expm(A * 1e-5)
    x, largest = start, 0.0
    for _ in range(20000):
        x = step @ x
        largest = max(largest, -k_s * (p @ x - x[2]))
    assert float(event.damper_force) == pytest.approx(largest / ELL, rel=2e-3)


def test_row_limits_force_stroke_and_room(configs):
    study = gear(configs, compliance="sized")
    design = {**LAYOUT, "A_link": 3e-4, "I_hinge": 5e-7}
    problem = DesignProblem(study)
    event = problem.limit_event(design)
    values = problem.values(design)
    assert values["largest_force"] == pytest.approx((event["damper_force"], ROW["force"]))
    assert values["usable_stroke"] == pytest.approx((event["damper_stroke"], ROW["stroke"]))
    assert values["apex_room"] == pytest.approx((ROW["length"], study.required.apex_room))
    assert problem.parts(design)["damper"] == ROW["mass"]
    found = {m.check: m for m in margins(study, design, {}) if m.part == "damper" and m.case == "tyre_moment"}
    assert found["largest force"].value == pytest.approx(ROW["force"] / event["damper_force"] - 1)
    assert found["usable stroke"].value == pytest.approx(ROW["stroke"] / event["damper_stroke"] - 1)


def test_too_short_a_stroke_has_no_design_and_says_so(configs):
    """Nothing of the layout helps where the working stroke asks for more than the row has."""
    block = gear(configs, compliance="sized").damper.model_dump(exclude_none=True)
    block["row"]["stroke"] = 1e-4
    base = damperopt.load(configs / "thesis_gear.yaml").replace(requirements__decay=None, solver__starts=1)
    found = damperopt.optimise(base.replace(damper=block))
    assert found.status == "infeasible"
    assert {s.name for s in found.infeasibility.shortfalls} <= {"usable_stroke", "working_stroke"}

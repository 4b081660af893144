"""Linkages against a 3-D frame: stiffness at the piston, stroke of the damper and stiffness along it, roots of the gear."""

import math

import numpy as np
import pytest
from frame import compliance
from own_gear import damper_stiffness, state_matrix

import damperopt
from damperopt.linkages.elastic import elastic_linkage
from damperopt.stability.linear import LinearModel

E = 207e9

AXIAL = 2e-3
"""Relative; formulas of small motion with smooth corners at the strut (measured: 0.0007 without, 0.0012 with a strut)."""

LAYOUT = {"c_lambda": 3e4, "L": 0.55, "gamma": 0.72, "A_piston": 6e-4, "rod_diameter": 0.014, "s_damper": 0.009}
SIZES = {"a_frame": {"A_link": 2e-4, "I_hinge": 6e-7}, "cantilever": {"I_link": 8e-7}}
SUPPORTS = {"a_frame": {"A_support": 1.5e-4, "I_foot": 4e-7}, "cantilever": {"I_support": 5e-7}}
GEAR = {"I_z": 100, "e": 0.12, "F_z": 150e3, "C_Fa": 2100, "C_Ma": 150e3, "a": 0.1, "sigma": 0.3, "kappa": 570}
GEAR |= {"I_x": 600, "k_d": 6.1e6, "c_d": 300, "l_g": 2.5}

CASES = [  # layout, b, links, support, its root, width of the strut
    ("arreaza", 0.18, "a_frame", "a_frame", "hinge_line", 0.0),
    ("arreaza", 0.18, "a_frame", "a_frame", "hinge_line", 0.12),
    ("arreaza", 0.08, "cantilever", "a_frame", "hinge_line", 0.0),
    ("arreaza", 0.3, "a_frame", "cantilever", "hinge_line", 0.0),
    ("arreaza", 0.3, "a_frame", "cantilever", "hinge_line", 0.12),
    ("arreaza", 0.18, "a_frame", "cantilever", "strut", 0.12),
    ("utas", 0.05, "a_frame", "a_frame", "hinge_line", 0.0),
    ("utas", 0.18, "cantilever", "a_frame", "hinge_line", 0.12),
    ("utas", 0.3, "a_frame", "a_frame", "hinge_line", 0.0),
    ("boeing", 0.0, "a_frame", "a_frame", "hinge_line", 0.0),
    ("boeing", 0.0, "a_frame", "a_frame", "hinge_line", 0.12),
    ("boeing", 0.0, "cantilever", "a_frame", "hinge_line", 0.0),
]


@pytest.fixture(params=CASES, ids=lambda case: " ".join(map(str, case)))
def case(request, configs):
    topology, b, links, support, root, strut = request.param
    forms = {"links": {"form": links, "strut_width": strut or None}, "support": {"form": support, "root": root}}
    damper = {"topology": topology, **forms}
    design = LAYOUT | SIZES[links]
    design |= {"k_lambda": 1e6} if topology == "boeing" else {"b": b, "I_arm": 1e-6}
    design |= SUPPORTS[support] if topology == "arreaza" else {}
    study = damperopt.load(configs / "main_gear.yaml").replace(damper=damper, tyre__contact="leading_point")
    return study, design, compliance(topology, design, E, links, support, root, strut)


def test_stiffness_and_stroke(case):
    """psi, stroke and stiffness along the damper where the piston is held: against K_t, k, r and k_s."""
    study, design, (c11, c12, c22) = case
    link = elastic_linkage(study, design)
    K, k, r = link.links * link.reach**2, link.torsional_stiffness, link.damper_lever
    assert 1 / K + 1 / k == pytest.approx(c11, rel=AXIAL)
    assert r / k == pytest.approx(c12, rel=AXIAL)
    behind = 1 / link.series - 1 / damper_stiffness(design)
    assert behind + r**2 / k == pytest.approx(c22, rel=AXIAL)
    assert math.isclose(behind, 0, abs_tol=1e-12) == (study.damper.topology == "boeing")


def test_roots_of_the_whole_gear(case):
    study, design, chain = case
    gear = LinearModel(study).at(design)
    for V in (5.0, 20.0, 100.0):
        mine = np.linalg.eigvals(state_matrix(V, GEAR, chain, design["c_lambda"], damper_stiffness(design)))
        theirs = np.linalg.eigvals(gear.matrices(V, 150e3)[0])
        # of what swings: the rest is far to the left and follows the chain's stiffness to the same part
        pairs = [np.sort_complex(roots[roots.imag > 1]) for roots in (mine, theirs)]
        assert np.abs(pairs[0] - pairs[1]).max() < 2 * AXIAL * np.abs(pairs[0]).min()

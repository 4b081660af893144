"""The drawing of a linkage is that of the equations: same lengths, same ends, same side."""

import numpy as np
import pytest
from scipy.optimize import fsolve

import damperopt
from damperopt.figures.linkage import hinge_lines, linkage
from damperopt.linkages.assembly import layouts

DESIGN = {"L": 0.6, "gamma": np.deg2rad(31.0), "b": 0.2, "c_lambda": 1.0, "I_arm": 1e-6, "k_lambda": 1e6}
TURNED = 0.02
"""Yaw angle [rad]: the apex moves to +y."""


def drawn_damper(topology):
    """Ends of the damper in the top view [m], (x, y) each."""
    line = next(line for line in linkage(topology, DESIGN).axes[1].lines if line.get_color() == "#c2571a")
    return np.array(line.get_xydata()) / 1e3


@pytest.mark.parametrize(("topology", "height"), [("utas", 1.0), ("arreaza", 0.0)])
def test_damper_is_on_the_side_of_the_equations(topology, height):
    """Its length with the apex moved as the closed loop moves it: mirrored, it would shorten instead."""
    import casadi as ca

    kind = layouts()[topology].model_construct(topology=topology, geometry="spatial")
    found = kind.linkage(DESIGN, 200e9)
    unknowns, psi = ca.vertcat(*found.unknowns), ca.SX.sym("psi")
    closure = ca.Function("closure", [unknowns, psi], [ca.vertcat(*found.closure(psi))])
    at = fsolve(lambda x: closure(x, TURNED).full().ravel(), [float(value) for value in found.rest], xtol=1e-13)
    stroke = float(ca.Function("stroke", [unknowns, psi], [found.at(psi).stroke])(at, TURNED))
    _, reach, z = at
    apex = np.array([reach * np.cos(TURNED), reach * np.sin(TURNED)])

    ends = drawn_damper(topology)
    at_rest = np.array([DESIGN["L"] * np.sin(DESIGN["gamma"]), 0.0])
    root = next(end for end in ends if not np.allclose(end, at_rest))
    up = height * DESIGN["L"] * np.cos(DESIGN["gamma"])
    longer = np.hypot(np.linalg.norm(apex - root), z - up) - np.hypot(np.linalg.norm(at_rest - root), up)
    assert root[1] == pytest.approx(-DESIGN["b"])
    assert longer == pytest.approx(stroke, rel=1e-6)
    assert stroke > 1e-3


@pytest.mark.parametrize("topology", ["boeing", "utas", "arreaza"])
def test_both_views_have_one_scale(topology):
    figure = linkage(topology, DESIGN)
    figure.draw_without_rendering()
    pixels = [axis.get_window_extent().width / np.ptp(axis.get_xlim()) for axis in figure.axes]
    assert pixels == pytest.approx([pixels[0]] * 3, rel=1e-6)


@pytest.mark.parametrize(("topology", "feet"), [("boeing", [-0.15, 0.15]), ("utas", [-0.2, 0.2]), ("arreaza", [-0.15, 0.15])])
def test_legs_stand_apart_on_a_hinge_line(topology, feet, configs):
    """Two legs from feet that are half the link apart; of UTAS arm and damper from 2 b apart."""
    study = damperopt.load(configs / "main_gear.yaml").replace(damper__topology=topology)
    design = DESIGN | {"A_link": 1e-4, "A_support": 1e-4, "I_hinge": 2e-7, "I_foot": 2e-7}
    lines = sorted(hinge_lines(study.damper.members(design)), key=lambda line: line[0, 2])
    height = DESIGN["L"] * np.cos(DESIGN["gamma"])
    assert [line[0, 2] for line in lines] == pytest.approx([-height, height])
    assert lines[0][:, 1] == pytest.approx([-0.15, 0.15])
    assert lines[1][:, 1] == pytest.approx(feet)
    behind = linkage(study.damper, design).axes[2]
    dashed = [np.array(line.get_xdata()) / 1e3 for line in behind.lines if line.get_linestyle() == "--"]
    np.testing.assert_allclose(dashed, [line[:, 1] for line in hinge_lines(study.damper.members(design))])
    legs = [line for line in behind.lines if line.get_color() == "#4a4a4a" and line.get_linestyle() == "-"]
    assert len(legs) == (4 if topology == "boeing" else 2)


def test_a_rigid_link_stands_on_the_axis(configs):
    study = damperopt.load(configs / "thesis_gear.yaml").replace(damper__topology="boeing")
    assert hinge_lines(study.damper.members(DESIGN)) == []

"""The drawing of a linkage is that of the equations: same lengths, same ends, same side."""

import casadi as ca
import numpy as np
import pytest

from damperopt.figures.linkage import linkage, parts_of
from damperopt.linkages.spatial import spatial

DESIGN = {"L": 0.6, "gamma": np.deg2rad(31.0), "b": 0.2}
TURNED = 0.02
"""Yaw angle [rad]: the apex moves to +y."""


@pytest.mark.parametrize("topology", ["boeing", "utas", "arreaza"])
def test_parts_have_the_lengths_of_the_theory(topology):
    """Links of length L, arm of UTAS hypot(L, b), damper of the Arreaza layout b and at right angles to the link."""
    parts = {part.name: np.subtract(part.end, part.start) for part in parts_of(topology, DESIGN)}
    assert np.linalg.norm(parts["lower torque link"]) == pytest.approx(0.6)
    if topology == "utas":
        assert np.linalg.norm(parts["bending arm"]) == pytest.approx(np.hypot(0.6, 0.2))
        assert np.linalg.norm(parts["damper"]) == pytest.approx(np.hypot(0.6, 0.2))
    if topology == "arreaza":
        assert np.linalg.norm(parts["bending arm"]) == pytest.approx(0.6)
        assert np.linalg.norm(parts["damper"]) == pytest.approx(0.2)
        assert parts["damper"] @ parts["lower torque link"] == pytest.approx(0.0)


@pytest.mark.parametrize("topology", ["utas", "arreaza"])
def test_damper_is_on_the_side_of_the_equations(topology):
    """Length of the drawn damper with its apex end moved as the closed loop moves it: mirrored, it would shorten instead."""
    stiff = spatial(topology, DESIGN | {"c_lambda": 1.0, "I_arm": 1.0}, ca.SX(1.0))
    psi = ca.SX.sym("psi")
    loop = ca.rootfinder("loop", "newton", {"x": stiff.unknowns, "p": psi, "g": stiff.closure(psi)})
    unknowns = loop(stiff_rest(stiff), TURNED).full().ravel()
    stroke = float(ca.Function("s", [stiff.unknowns, psi], [stiff.at(psi).stroke])(unknowns, TURNED))
    _, reach, height = unknowns
    apex = np.array([reach * np.cos(TURNED), reach * np.sin(TURNED), height])

    damper = next(part for part in parts_of(topology, DESIGN) if part.name == "damper")
    length = np.linalg.norm(np.subtract(damper.end, damper.start))
    assert np.allclose(damper.end, [DESIGN["L"] * np.sin(DESIGN["gamma"]), 0, 0])
    assert np.linalg.norm(apex - damper.start) - length == pytest.approx(stroke, rel=1e-9)
    assert stroke > 1e-3


def stiff_rest(found):
    """Values of the unknowns at rest."""
    return ca.Function("rest", [], [found.rest])()["o0"]


@pytest.mark.parametrize("topology", ["boeing", "utas", "arreaza"])
def test_both_views_have_one_scale(topology):
    figure = linkage(topology, DESIGN)
    figure.draw_without_rendering()
    pixels = [axis.get_window_extent().width / np.ptp(axis.get_xlim()) for axis in figure.axes]
    assert pixels[0] == pytest.approx(pixels[1], rel=1e-6)

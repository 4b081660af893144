"""Vectors in named blocks, and the motion of a tangent by the names of states."""

import casadi as ca
import numpy as np
import pytest

from damperopt.motion.measure import fastest_rate, latest_count, slowest_rate
from damperopt.motion.tangent import TangentMotion
from damperopt.optimum.parameters import Blocks, Limits, instance_of


@pytest.fixture
def blocks():
    return Blocks(speeds=ca.SX.sym("V", 3), nothing=ca.SX(0, 1), cuts=ca.SX.sym("cuts", 2, 2), excess=ca.SX.sym("e"))


def test_blocks_are_found_by_name(blocks):
    vector = blocks.vector(speeds=np.array([1.0, 2, 3]), nothing=np.zeros(0), cuts=np.array([4.0, 5, 6, 7]), excess=8.0)
    assert vector.tolist() == [1, 2, 3, 4, 5, 6, 7, 8]
    assert blocks.part(vector, "cuts").tolist() == [4, 5, 6, 7]
    assert blocks.part(vector, "nothing").size == blocks.part(vector, "unknown").size == 0
    assert blocks.size("cuts") == 4
    assert blocks.size("unknown") == 0


def test_vector_needs_every_block_and_no_other(blocks):
    parts = {"speeds": 0.0, "nothing": 0.0, "cuts": 0.0, "excess": 0.0}
    with pytest.raises(KeyError, match="excess"):
        blocks.vector(**{name: value for name, value in parts.items() if name != "excess"})
    with pytest.raises(KeyError, match="loads"):
        blocks.vector(**parts, loads=1.0)
    with pytest.raises(ValueError, match="shape"):
        blocks.vector(**{**parts, "speeds": np.zeros(4)})


def test_instance_does_not_hang_on_the_order_in_which_blocks_are_given():
    variables = Blocks(design=ca.SX.sym("x", 2), excess=ca.SX.sym("e"))
    rows, parameters = Blocks(strength=ca.SX.sym("g")), Blocks(data=ca.SX.sym("p", 2))
    limits = {"excess": Limits(0.0, np.inf, 0.0), "design": Limits(np.array([1.0, 2.0]), 5.0, np.array([3.0, 4.0]))}
    found = instance_of(variables, rows, parameters, limits, {"strength": Limits(-np.inf, 0.0)}, {"data": np.array([6.0, 7.0])})
    assert (found.x0.tolist(), found.lbx.tolist(), found.ubx.tolist()) == ([3, 4, 0], [1, 2, 0], [5, 5, np.inf])
    assert (found.lbg.tolist(), found.ubg.tolist(), found.p.tolist()) == ([-np.inf], [0], [6, 7])


def test_rates_find_the_yaw_angle_wherever_it_stands():
    """A yaw mode of 30 rad/s behind a creep of 0.1 rad/s: the order of the states is nothing."""
    names = ("string_deflection", "yaw_rate", "yaw_angle")
    A = np.array([[-5.0, 0.0, 0.0], [0.0, -2.0, -900.0], [0.0, 1.0, 0.0]])
    other = [names.index(name) for name in ("yaw_angle", "yaw_rate", "string_deflection")]
    turned = A[np.ix_(other, other)]
    assert latest_count(A, 3, names) == pytest.approx(6 * 2 * np.pi / 30)
    assert latest_count(A, 3, names) == latest_count(turned, 3, ("yaw_angle", "yaw_rate", "string_deflection"))
    damped = np.sqrt(900 - 1)
    assert fastest_rate(A) == pytest.approx(damped)
    assert slowest_rate(A, names) == pytest.approx(damped)


def test_tangent_reads_the_yaw_angle_by_name():
    """exp(-2 t) with a sensitivity 3 exp(-2 t) to one variable, its state last."""
    t = np.linspace(0, 1, 2001)
    yaw, rate = np.exp(-2 * t), -2 * np.exp(-2 * t)
    x, S = np.vstack([0 * t, rate, yaw]), np.stack([0 * t, 3 * rate, 3 * yaw])[:, None, :]
    motion = TangentMotion(("string_deflection", "yaw_rate", "yaw_angle"), t, x, S)
    assert motion.log_slopes(0.5) == pytest.approx([3.0], rel=1e-9)
    assert motion.log_rate(0.5) == pytest.approx(-2.0, rel=1e-9)

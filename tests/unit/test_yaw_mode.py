"""The yaw mode is that of the yaw, also where two other roots meet and part."""

import numpy as np
import pytest

import damperopt
from damperopt.proof.check import check_damping
from damperopt.stability.linear import LinearGear
from damperopt.stability.yaw_mode import yaw_mode, yaw_modes

W, ZETA = 75.0, 0.06
"""Of the yaw alone [rad/s], [1]."""


def gear(split, coupled=5.0):
    """Yaw, and two states whose roots are -100 +- i sqrt(split), coupled to it."""
    yaw = [[0, 1, 0, 0], [-(W**2), -2 * ZETA * W, coupled, 0]]
    return np.array([*yaw, [0, coupled, -100, 1], [coupled, 0, -split, -100]], float)


@pytest.mark.parametrize("split", [1e-8, 1e-4, 1.0, 100.0])
def test_a_pair_that_is_nearly_one_root_does_not_pass_for_the_yaw(split):
    s, v, w = yaw_mode(gear(split), 0, 1)
    assert s.imag == pytest.approx(W, rel=0.05)
    assert w @ v == pytest.approx(1)
    np.testing.assert_allclose(gear(split) @ v, s * v, atol=1e-9 * abs(s))


def test_nor_in_the_check(main_gear):
    """Two roots that part at the split of each speed; the check looks at all speeds of the envelope."""
    study = main_gear.replace(damper__topology="boeing")
    states = damperopt.linear_gear(study).states[:4]

    def matrices(speeds, loads):
        return np.stack([gear(1e-3 * (V - 20.0) + 1e-8) for V in np.atleast_1d(speeds)])

    class Model:
        def at(self, design):
            return LinearGear(matrices, states, None)

    ratio, _, load, _ = check_damping(study, study.start, Model())
    assert ratio == pytest.approx(ZETA, abs=0.01)
    assert load == 150e3


def test_waves_of_the_contact_line_do_not_pass_for_the_yaw(configs):
    """With memory: of all roots the one that follows the yaw of the gear with a line that follows its leading point."""
    study = damperopt.load(configs / "main_gear.yaml")
    design = {"c_lambda": 3e4, "I_arm": 1e-6, "L": 0.56, "gamma": 0.75, "b": 0.18, "A_piston": 7e-4, "rod_diameter": 0.012}
    design |= {"s_damper": 0.01, "A_link": 2.3e-4, "A_support": 1.7e-4, "I_hinge": 4e-7, "I_foot": 3e-7}
    speeds = np.geomspace(5, 100, 40)
    lines = [study.replace(tyre__contact=contact) for contact in ("leading_point", "memory")]
    point, memory = (yaw_modes(damperopt.linear_gear(line, design), speeds, 150e3) for line in lines)
    np.testing.assert_allclose(memory.imag, point.imag, rtol=0.25)  # waves of the line are six times as fast

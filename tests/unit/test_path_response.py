"""Force and moment over path frequency of each contact line, as `damperopt tyre` shows them."""

import numpy as np
import pytest
from components_of import tyre_of

from damperopt.tyres.path_response import RESPONSES, path_response

STRING = {"law": "stiffness", "half_contact_length": 0.1, "relaxation_length": 0.3, "carcass_stiffness": 1.4e6}
EXACT = {
    2: (278867.839 - 254845.907j, -422830.403 - 637114.766j, 18657.516 - 17372.282j, -39689.544 - 43430.705j),
    8: (-50720.261 - 118243.706j, -1246800.652 - 295609.264j, -535.234 + 15042.550j, -87671.419 + 37606.376j),
}
"""Of the exact line, by rad/m; computed from the closed forms by code of its own."""
OFF = {"leading_point": (".037", ".185", ".73", "2.10"), "von_schlippe": (".0034", ".0001", ".067", ".003")}
"""F/theta and M/theta at 2 and at 8 rad/m, distance in parts, as printed."""


@pytest.fixture(scope="module")
def found():
    return path_response(tyre_of(**STRING), 150e3)


def at(found, frequency, values):
    """Real and imaginary parts at a frequency between those of the table."""
    x, own = np.log(found.frequencies), np.log(frequency)
    return np.array([np.interp(own, x, row.real) + 1j * np.interp(own, x, row.imag) for row in values])


@pytest.mark.parametrize("frequency", EXACT)
def test_first_line_is_the_exact_one(found, frequency):
    assert next(iter(found.lines)) == "memory"
    # straight lines between 240 frequencies
    assert at(found, frequency, found.lines["memory"]) == pytest.approx(np.array(EXACT[frequency]), rel=2e-3)


@pytest.mark.parametrize("line", OFF)
def test_distances_from_it(found, line):
    force, moment = (list(RESPONSES).index(name) for name in ("F/theta", "M/theta"))
    errors = [np.interp(k, found.frequencies, found.errors(line)[which]) for k in (2, 8) for which in (force, moment)]
    for error, printed in zip(errors, OFF[line], strict=True):
        assert error == pytest.approx(float(printed), abs=0.52 * 10.0 ** -len(printed.split(".")[1]))
    least = found.holds_to(line)
    worst = found.errors(line).max(axis=0)
    assert worst[found.contact_lengths >= least].max() <= 0.1 < worst[found.contact_lengths < least].max()


def test_a_missing_length_has_no_response():
    assert path_response(tyre_of(**STRING).model_copy(update={"half_contact_length": float("nan")}), 150e3) is None


def test_the_tyre_s_own_line_is_shown_with_its_numbers():
    """Its damping too: of long waves it takes no force, and 2 c_M (b/c) V (a + sigma)^2 of the moment, at 40 m/s."""
    own = tyre_of(**STRING, contact={"kind": "pade", "order": 6, "damping_time": 2.6e-3})
    found = path_response(own, 150e3)
    label = "pade, order 6, damping_time 0.0026"
    assert label in found.lines
    force, moment = (list(RESPONSES).index(name) for name in ("F/theta", "M/theta"))
    taken = 2 * 2.6e-3 * 40 * 0.4**2 / (2 * 0.1 * (0.3 * 0.4 + 0.1**2 / 3))
    assert found.errors(label)[force, 0] < 0.05
    assert found.errors(label)[moment, 0] == pytest.approx(taken, rel=0.01)
    moreland = {"kind": "moreland", "lateral_stiffness": 1.1e6, "time_constant": 2e-3}
    slopes = {"cornering_stiffness": 4.48e5, "aligning_stiffness": 3.4e4}
    assert path_response(tyre_of(law="stiffness", half_contact_length=0.1, contact=moreland, **slopes), 150e3) is None

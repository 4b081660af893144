"""A wheel that does not slip sideways: printed roots, the stiff limit of the package's own tyre, and the criterion."""

from __future__ import annotations

import numpy as np
import pytest
from table_gear import assert_printed, eigenvalues, table_gear

from damperopt import certify, linear_gear, loads
from damperopt.gears.rigid_tyre import rigid_polynomial


def roots(speed, stiffness=3.8e5, damping=300.0, load=150e3, **gear):
    found = np.roots(rigid_polynomial(table_gear(**gear).gear, stiffness, damping, speed, load))
    return list(found[found.imag >= 0])


@pytest.mark.parametrize(
    ("speed", "printed"),
    [
        (5.0, [-1.48389, -1.02508 + 62.3821j]),
        (40.0, [-11.7082, 2.09855 + 62.7881j]),
        (100.0, [-27.1799, 6.42554 + 64.8770j]),
    ],
)
def test_roots(speed, printed):
    assert_printed(roots(speed), printed)


def test_stiff_tyre_of_a_point_is_rigid():
    """Side stiffness to infinity over lengths to zero: the error falls with the length."""
    errors = []
    for length in (1e-2, 1e-3, 1e-4):
        tyre = {
            "law": "stiffness",
            "contact": "leading_point",
            "half_contact_length": length / 10,
            "relaxation_length": length,
            "cornering_stiffness": 1e8 / length,
            "aligning_stiffness": 0.0,
        }
        slow = [value for value in eigenvalues(table_gear(tyre=tyre), 40.0) if abs(value) < 100]
        errors.append(max(min(abs(value - other) for other in slow) for value in roots(40.0)))
    assert errors[2] < 0.01
    assert errors[2] < 0.15 * errors[1] < 0.03 * errors[0]


@pytest.mark.parametrize("speed", [2.0, 30.0, 120.0])
def test_undamped_it_is_stable_where_yaw_is_the_faster(speed):
    lateral = {"inertia": 600.0, "stiffness": 6.1e6, "damping": 0.0, "height": 2.5}
    equal = 6.1e6 / 600 * 100
    for ratio, stable in ((1.01, True), (0.99, False)):
        worst = max(value.real for value in roots(speed, ratio * equal, 0.0, 0.0, lateral=lateral))
        assert (worst < 0) == stable


def test_without_caster_there_is_no_such_gear():
    with pytest.raises(ValueError, match="needs a caster, and no rake"):
        roots(40.0, caster_length=0.0)


CASTOR = """
name: towed castor
gear: {{kind: yaw_translation, yaw_inertia: {inertia}, caster_length: 0.2, wheel_radius: 0.3,
       sideways: {{mass: 40, stiffness: 2e5, damping: 0}}, swivelling: {{mass: 25, offset: {offset}}}}}
tyre: {{law: stiffness, contact: leading_point, half_contact_length: 1e-5, relaxation_length: 1e-5,
       cornering_stiffness: 1e11, aligning_stiffness: 0}}
damper: {{topology: rotational, torsional_stiffness: 0, torsional_damping: 0}}
envelope: {{speed: {{min: 1 m/s, max: 40 m/s}}, vertical_load: 10 kN}}
"""


@pytest.mark.parametrize("offset", [0.05, 0.12])
def test_castor_is_stable_where_the_ground_is_beyond_the_centre_of_percussion(offset):
    """Towed on an elastic pivot without slip: w' + e psi' + V psi = 0 leaves a cubic, stable at every speed or at none.

    With T = (I psi'^2 + 2 m x_g w' psi' + m_w w'^2)/2 and the constraint,
    (I - 2 m x_g e + m_w e^2) s^3 + (m_w e - m x_g) V s^2 + k_w e^2 s + k_w e V: Routh asks for m x_g e > I.
    """
    e, V, lever = 0.2, 10.0, 25 * offset
    for part, stable in ((0.98, True), (1.02, False)):
        study = loads(CASTOR.format(inertia=part * lever * e, offset=offset))
        leading = part * lever * e - 2 * lever * e + 40 * e**2
        cubic = np.sort_complex(np.roots([leading, (40 * e - lever) * V, 2e5 * e**2, 2e5 * e * V]))
        found = linear_gear(study).roots(V, 1e4, 3)[0]
        np.testing.assert_allclose(np.sort_complex(found), cubic, rtol=1e-3)
        assert (cubic.real.max() < 0) == stable
        assert certify(study, {}, margin=0.0).proved == stable

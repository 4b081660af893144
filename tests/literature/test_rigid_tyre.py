"""A wheel that does not slip sideways: printed roots, the stiff limit of the package's own tyre, and the criterion."""

from __future__ import annotations

import numpy as np
import pytest
from table_gear import assert_printed, eigenvalues, table_gear

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

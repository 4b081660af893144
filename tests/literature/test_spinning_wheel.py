"""Gyroscopic moments of a spinning wheel: eigenvalues of an independent prototype (NumPy, no code shared with the package)."""

from __future__ import annotations

import numpy as np
import pytest

from damperopt import Study
from damperopt.stability.linear import linear_gear

TABLE = {  # Table 0.1 of Arreaza (2015), with stiffness and damping about the yaw axis
    "name": "T",
    "gear": {
        "kind": "yaw_bending",
        "yaw_inertia": 100.0,
        "caster_length": 0.12,
        "wheel_radius": 0.362,
        "lateral": {"inertia": 600.0, "stiffness": 6.1e6, "damping": 300.0, "height": 2.5},
    },
    "tyre": {
        "law": "linear",
        "contact": "leading_point",
        "half_contact_length": 0.1,
        "relaxation_length": 0.3,
        "cornering_slope": 0.014,
        "aligning_coefficient": 1.0,
        "tread_width_moment": 570.0,
    },
    "damper": {"topology": "rotational", "torsional_stiffness": 3.8e5, "torsional_damping": 300.0},
    "envelope": {"speed": {"min": 5.0, "max": 150.0}, "vertical_load": 150e3},
}
PRINTED = {  # V [m/s]: I_p = 6 kg m^2; six significant digits
    40.0: [2.61325 + 71.2079j, -0.815792 + 100.35j, -140.571],
    100.0: [0.607588 + 72.7843j, -0.618854 + 100.341j, -336.868],
}


def gear_with(**keys):
    return Study.model_validate({**TABLE, "gear": {**TABLE["gear"], **keys}})


def eigenvalues(study, speed):
    found = np.linalg.eigvals(linear_gear(study).matrices(speed, 150e3)[0])
    return sorted(found[found.imag >= 0], key=lambda value: -value.real)


@pytest.mark.parametrize("speed", PRINTED)
def test_eigenvalues(speed):
    found = eigenvalues(gear_with(wheel_polar_inertia=6.0), speed)
    for value, printed in zip(found, sorted(PRINTED[speed], key=lambda value: -complex(value).real), strict=True):
        # the reference has six digits: half a unit of the last one of the larger part
        assert abs(value - printed) <= 5e-6 * abs(printed) + 5e-6


def test_the_key_names_the_kind():
    assert gear_with(wheel_polar_inertia=6.0).gear.kind == "spinning_wheel"
    by_order = {**{key: value for key, value in TABLE["gear"].items() if key != "kind"}, "order": 5, "wheel_polar_inertia": 6.0}
    assert Study.model_validate({**TABLE, "gear": by_order}).gear.kind == "spinning_wheel"
    assert gear_with().gear.kind == "yaw_bending"


def test_gyroscopic_moments_do_no_work():
    """I_z psi' psi'' + I_x delta' delta'' is the same with and without spin: the coupling is skew."""
    speeds = [20.0, 80.0]
    with_spin, without = (
        linear_gear(study).matrices(speeds, 150e3) for study in (gear_with(wheel_polar_inertia=6.0), gear_with())
    )
    change = with_spin - without
    assert np.abs(change).max() > 0
    power = np.diag([0.0, 100.0, 0.0, 600.0, 0.0]) @ change
    np.testing.assert_allclose(power + power.transpose(0, 2, 1), 0.0, atol=1e-9 * np.abs(power).max())


def test_without_bending_spin_has_no_effect():
    spun, still = (gear_with(kind="yaw", **keys) for keys in ({"wheel_polar_inertia": 6.0}, {}))
    assert spun.gear.kind == "yaw"
    np.testing.assert_array_equal(*(linear_gear(study).matrices([10.0, 90.0], 150e3) for study in (spun, still)))
    assert any("gyroscopic" in words for words in spun.gear.leaves_out())
    assert not any("gyroscopic" in words for words in gear_with(wheel_polar_inertia=6.0).gear.leaves_out())

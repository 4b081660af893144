"""Tuned absorber: the gear of the table with one of five per cent, and the optimum of a host that drives itself."""

from __future__ import annotations

import numpy as np
import pytest
from table_gear import TYRE, table_gear

from damperopt import Study, simulate_exactly
from damperopt.stability.linear import linear_gear


def gear(damping=300.0, tyre=TYRE, stiffness=3.8e5, gear=None, **absorber):
    base = table_gear(tyre=tyre).model_dump(exclude_none=True)
    block = {"absorber_inertia": 5.0, "absorber_stiffness": 20937.0, "absorber_damping": 41.71} | absorber
    damper = {"topology": "rotational", "kind": "absorber", "torsional_stiffness": stiffness, "torsional_damping": damping}
    return Study.model_validate(base | {"damper": damper | block} | ({"gear": gear} if gear else {}))


SPEEDS = np.linspace(5.0, 100.0, 2000)


def test_five_per_cent_keep_the_gear_of_the_table_stable():
    """-0.231 over 5 to 100 m/s with c_psi 300, which is the lateral mode's; +0.895 without any other damper."""
    assert linear_gear(gear()).abscissa(SPEEDS, 150e3).max() == pytest.approx(-0.231, abs=1e-3)
    assert linear_gear(gear(0.0)).abscissa(SPEEDS, 150e3).max() == pytest.approx(0.895, abs=1e-3)


def test_best_absorber_of_a_host_with_negative_damping():
    """mu .05: a host of zeta up to sqrt(mu)/2 = 0.1118 at most is held, by g 1/sqrt(1 + mu) and zeta_a 0.1098 nearly that."""
    none = {**TYRE, "cornering_slope": 0.0, "aligning_coefficient": 0.0}
    yaw = {"kind": "yaw", "yaw_inertia": 100.0, "caster_length": 0.12, "wheel_radius": 0.362}
    omega = 60.0

    def worst(zeta, g, zeta_a):
        # c_psi enters the matrix linearly, so that a negative one is got from it
        keys = {"absorber_stiffness": 5.0 * (g * omega) ** 2, "absorber_damping": 2 * zeta_a * 5.0 * g * omega}
        none["tread_width_moment"] = 0.0
        with_damping, without = (
            linear_gear(gear(c, none, 100.0 * omega**2, yaw, **keys)).matrices(30.0, 150e3)[0] for c in (100.0, 0.0)
        )
        A = without - (with_damping - without) / 100.0 * (2 * zeta * 100.0 * omega)
        values = np.linalg.eigvals(A)
        return values.real[np.abs(values.imag) > 1].max()

    assert worst(0.11, 0.9759, 0.1098) < 0
    assert worst(0.1125, 0.9759, 0.1098) > 0
    for g, zeta_a in ((0.95, 0.1098), (1.0, 0.1098), (0.9759, 0.09), (0.9759, 0.13)):
        assert worst(0.11, g, zeta_a) > 0


def test_energy_is_kept_with_a_cubic_spring():
    none = {**TYRE, "cornering_slope": 0.0, "aligning_coefficient": 0.0, "tread_width_moment": 0.0}
    yaw = {"kind": "yaw", "yaw_inertia": 100.0, "caster_length": 0.0, "wheel_radius": 0.362}
    study = gear(0.0, none, 3.8e5, yaw, absorber_damping=0.0, cubic_stiffness=1e6)
    motion = simulate_exactly(study, speed=30.0, disturbance={"release": {"yaw_angle": 0.2}}, duration=0.5)
    psi, psi_t, chi, chi_t = (motion[name] for name in ("yaw_angle", "yaw_rate", "absorber_angle", "absorber_rate"))
    twist = psi - chi
    energy = 50 * psi_t**2 + 1.9e5 * psi**2 + 2.5 * chi_t**2 + 20937 / 2 * twist**2 + 1e6 / 4 * twist**4
    np.testing.assert_allclose(energy, energy[0], rtol=1e-7)

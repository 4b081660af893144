"""Charts and maps of a gear with contact memory, held against the twin's collocation."""

from __future__ import annotations

import numpy as np
import pytest
from memory_twin import F_Z, O, T, gear, rightmost, study_text

from damperopt import chart, filled_map, loads
from damperopt.charts.explicit import joint_boundary
from damperopt.charts.plane import Plane

K, C = ("damper.torsional_stiffness", 1e5, 3e6), ("damper.torsional_damping", 0.0, 8000.0)
MARGIN, SPEED = 0.1, 8.75


def twin(V, k_psi, c_psi):
    return rightmost(V, F_Z, gear(O, k_psi=float(k_psi), c_psi=float(c_psi)))


@pytest.fixture(scope="module")
def study():
    return loads(study_text(gear(O)))


def test_explicit_boundary_has_its_roots_on_the_line(study):
    """-1/G(i w) with the delay: stiffness and damping give the twin an eigenvalue -margin + i w."""
    frequencies = np.array([9.0, 10.645, 14.0, 17.0, 21.0])
    k, c = joint_boundary(study, SPEED, F_Z, frequencies, MARGIN)
    for w, k_psi, c_psi in zip(2 * np.pi * frequencies, k, c, strict=True):
        p = gear(O, k_psi=float(k_psi), c_psi=float(c_psi))
        found = np.abs(rightmost(SPEED, F_Z, p, nodes=50, count=12) - (-MARGIN + 1j * w)).min()
        assert found < 1e-6 * w


def test_chart_of_stiffness_and_damping_is_explicit(study):
    record = chart(study, K, C, speed=SPEED, margin=MARGIN)
    (family,) = record.families
    assert family.explicit
    for curve in family.curves:
        for (k_psi, c_psi), hertz in zip(curve.points[5::60], curve.frequency[5::60], strict=True):
            top = twin(SPEED, k_psi, c_psi)[0]
            assert top.real == pytest.approx(-MARGIN, abs=2e-3)  # chords to 1e-5 of the ranges
            assert abs(top.imag) / (2 * np.pi) == pytest.approx(hertz, rel=1e-3)
    rng = np.random.default_rng(1)
    k, c = rng.uniform(1e5, 3e6, 60), rng.uniform(0, 8000, 60)
    sides = [twin(SPEED, *place)[0].real < -MARGIN for place in zip(k, c, strict=True)]
    assert record.stable(k, c).tolist() == sides


def test_chart_over_speed_is_traced(study):
    """Speed is no joint: the boundary is traced by exact eigenvalues."""
    record = chart(study, ("speed", 5.0, 40.0), K, cells=16, margin=MARGIN)
    assert not record.families[0].explicit
    rng = np.random.default_rng(2)
    V, k = rng.uniform(5, 40, 40), rng.uniform(1e5, 3e6, 40)
    excess = np.array([twin(V_i, k_i, O["c_psi"])[0].real + MARGIN for V_i, k_i in zip(V, k, strict=True)])
    clear = np.abs(excess) > 1e-3
    assert (record.stable(V, k) == (excess < 0))[clear].all()


def test_maps_hold_exact_eigenvalues(study):
    plane = Plane(study, *(chart_axis(study, *axis) for axis in (K, C)), {}, SPEED, F_Z, MARGIN)
    abscissa, damping = filled_map(plane, pixels=24), filled_map(plane, "damping", pixels=24)
    rng = np.random.default_rng(3)
    for i, j in rng.integers(0, 24, (12, 2)):
        roots = twin(SPEED, abscissa.x[j], abscissa.y[i])
        assert abscissa.values[i, j] == pytest.approx(roots[0].real, abs=1e-6)
        assert damping.values[i, j] == pytest.approx((-roots.real / np.abs(roots)).min(), abs=1e-6)


def chart_axis(study, name, low, high):
    from damperopt.charts.plane import Axis

    return Axis.of(study, name, low, high)


def test_straight_tangent_draws_another_chart():
    """The same plane for T at 20 m/s: 800 N m s/rad are enough with memory, and not without."""
    sides = {}
    for contact in ("memory", "leading_point"):
        of = loads(study_text(gear(T), contact=contact))
        record = chart(of, ("damper.torsional_damping", 0.0, 2000.0), K, speed=20.0)
        sides[contact] = bool(record.stable(np.array([800.0]), np.array([3.8e5]))[0])
    assert sides == {"memory": True, "leading_point": False}

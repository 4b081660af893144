"""Takacs, Orosz & Stepan (2009): shimmy of a towed wheel on a stretched string, with the delay of its contact line.

Their characteristic function in l = lambda/(V/(2 a)), for towing length e = L a, relaxation length sigma = Sigma a, and speed
v = 2 a w_n V, is that of the package's third-order gear without spring and damper, but for a factor that does not hang on l.
"""

from __future__ import annotations

import numpy as np
import pytest

from damperopt import certify, critical_speeds, linear_gear, loads

a, sigma, c_c, J = 0.04, 0.072, 53506.0, 0.3
SIGMA = sigma / a


def natural_frequency(L):
    return np.sqrt(2 * a**3 * c_c * (L**2 * (1 + SIGMA) + 1 / 3 + SIGMA * (1 + SIGMA)) / J)


def their_function(l, V, L):
    """As they print it, without damping of the tyre."""
    q, den = L - 1 - SIGMA, L**2 + 1 / 3 + SIGMA * (L**2 + 1 + SIGMA)
    E = np.exp(-l)
    braces = 2 / l**2 * ((L - 1) * l + 2 - ((L + 1) * l + 2) * E) + q * SIGMA + (L + 1 + SIGMA) * SIGMA * E
    return SIGMA * V**2 * l**3 + 2 * V**2 * l**2 + SIGMA * l + 2 - q / den * braces


def towed(L, low=0.05, high=1.0, contact="memory"):
    """The same wheel as a study, speeds as V."""
    unit = 2 * a * natural_frequency(L)
    return unit, loads(f"""
name: towed wheel
gear: {{order: 3, yaw_inertia: {J!r}, caster_length: {L * a!r}, wheel_radius: 0.2}}
tyre: {{law: stiffness, half_contact_length: {a!r}, relaxation_length: {sigma!r}, carcass_stiffness: {c_c!r},
       contact: {contact}}}
damper: {{topology: rotational, torsional_stiffness: 0, torsional_damping: 0}}
envelope: {{speed: {{min: {float(low * unit)!r}, max: {float(high * unit)!r}}}, vertical_load: 100}}
""")


@pytest.mark.parametrize("L", [0.3, 0.5, 1.0, 2.0, 3.5])
def test_characteristic_functions_are_the_same(L):
    unit, study = towed(L)
    rng = np.random.default_rng(7)
    for V in (0.1, 0.3, 0.9):
        frozen = linear_gear(study).frozen(np.array([V * unit]), np.array([100.0]))
        l = rng.uniform(-3, 3, 40) + 1j * rng.uniform(0.5, 12, 40)
        s = l * V * unit / (2 * a)
        A, _ = frozen.at(s[None])
        ours = np.linalg.det(s[:, None, None] * np.eye(3) - A[0])
        ratio = their_function(l, V, L) / ours
        assert ratio == pytest.approx(ratio[0], rel=1e-10)


BOUNDARY = {
    0.5: ((0.21771, 1.67876), (0.18509, 5.75475), (0.12712, 7.30525)),
    1.0: ((0.36191, 1.88872), (0.19221, 5.50635), (0.12474, 7.58348)),
    2.0: ((0.43135, 2.16468), (0.19543, 5.21915), (0.12443, 7.91316)),
}
"""(V, Im l) on the boundary of stability, of an independent prototype."""


@pytest.mark.parametrize("L", BOUNDARY)
def test_boundary_points(L):
    unit, study = towed(L, low=0.11, high=1.0)
    found = critical_speeds(linear_gear(study), 100.0, 0.11 * unit, unit)
    points = [(c.speed / unit, 2 * np.pi * c.frequency * 2 * a / c.speed) for c in found]
    for V, w in BOUNDARY[L]:
        assert min(max(abs(p[0] - V), abs(p[1] - w)) for p in points) < 6e-6  # half a unit of the last digit


def test_certificate_finds_their_narrow_bands():
    """Between two boundary points the wheel shimmies, beyond them not; the certificate of both ranges says so."""
    _, shimmies = towed(0.5, low=0.15, high=0.2)
    certificate = certify(shimmies, {}, 0.0)
    assert certificate.verdict == "refuted"
    _, rolls = towed(0.5, low=0.186, high=0.217)
    assert certify(rolls, {}, 0.0).verdict == "proved"


DAMPED = {
    0.5: ((0.21744, 1.66773), (0.16810, 6.12756), (0.13604, 6.98200)),
    1.0: ((0.36461, 1.85547), (0.17519, 5.90767), (0.13305, 7.19436)),
    2.0: ((0.47522, 1.94467),),
}
"""With the damping of their tyre, zeta = 0.02, of the same prototype."""


def damped(L, line="memory", order=12, **ends):
    """With zeta = 0.02 and the delay by a Pade approximation good to 2 a w/V = 12."""
    beta = float(2 * 0.02 / natural_frequency(L))
    return towed(L, contact=f"{{kind: pade, order: {order}, line: {line}, damping_time: {beta!r}}}", **ends)


@pytest.mark.parametrize("L", DAMPED)
def test_boundary_points_with_side_damping(L):
    unit, study = damped(L, low=0.11)
    found = critical_speeds(linear_gear(study), 100.0, 0.11 * unit, unit)
    points = [(c.speed / unit, 2 * np.pi * c.frequency * 2 * a / c.speed) for c in found]
    assert len(points) == len(DAMPED[L])
    for V, w in DAMPED[L]:
        assert min(max(abs(p[0] - V), abs(p[1] - w)) for p in points) < 6e-6


def test_side_damping_is_proved_where_their_chart_is_stable():
    """Between the second and third boundary points of L = 1 the damped wheel shimmies; beyond them it is proved not to."""
    _, shimmies = damped(1.0, order=6, low=0.15, high=0.16)
    assert certify(shimmies, {}, 0.0).verdict == "refuted"
    _, rolls = damped(1.0, order=6, low=0.2, high=0.36)
    assert certify(rolls, {}, 0.0).verdict == "proved"

"""Steady braking and rolling drag: matrices and moments written out here, which share no code with the package."""

import numpy as np
import pytest

import damperopt
from damperopt.expressions.corners import Smooth
from damperopt.ports.motion import Torque
from damperopt.ports.wheel import Contact

I_Z, I_X, E, A, SIGMA, C_F, K_PSI, C_PSI = 100.0, 600.0, 0.12, 0.1, 0.3, 448e3, 3.8e5, 300.0
K_X, C_X, HEIGHT, RADIUS, LOAD, V = 6.1e6, 300.0, 2.5, 0.362, 150e3, 40.0
C_M = C_F / (2 * (A + SIGMA) ** 2) * 2 * A * (SIGMA * (SIGMA + A) + A**2 / 3)

STUDY = """
name: dragged
gear: {{{gear}, wheel_radius: 0.362}}
tyre: {{law: stiffness, half_contact_length: 0.1, relaxation_length: 0.3, contact: {contact},
       cornering_stiffness: 448000, aligning_stiffness: {moment}}}
damper: {{topology: rotational, torsional_stiffness: 3.8e5, torsional_damping: 300}}
envelope: {{speed: {{min: 5 m/s, max: 100 m/s}}, vertical_load: [100 kN, 150 kN]}}
"""
LATERAL = "lateral: {inertia: 600, stiffness: 6.1e6, damping: 300, height: 2.5}"
GEAR = f"yaw_inertia: 100, caster_length: 0.12, {LATERAL}"
DRAGS = {
    "{brake_torque: 36.2 kN m}": (1e5, 0.0, None),
    "{force: 40 kN, rolling_resistance: 0.1}": (0.0, 55e3, None),
    "{brake_torque: 18.1 kN m, force: 10 kN, lateral_stiffness: 0.9 MN/m}": (5e4, 1e4, 0.9e6),
}


def study_of(gear, contact="leading_point"):
    return damperopt.loads(STUDY.format(gear=gear, contact=contact, moment=C_M))


def matrix(braked, rolling, stiffness):
    """psi, psi', delta, delta', y: the side force acts on a trail e - D/K_y, the drag swivels with the wheel."""
    trail = E - (braked + rolling) / (stiffness or C_F / (A + SIGMA))
    turned = (LOAD * E + HEIGHT * braked + (HEIGHT - RADIUS) * rolling) / I_X
    return np.array(
        [
            [0, 1, 0, 0, 0],
            [-K_PSI / I_Z, -C_PSI / I_Z, 0, 0, -(trail * C_F + C_M) / SIGMA / I_Z],
            [0, 0, 0, 1, 0],
            [turned, 0, -K_X / I_X, -C_X / I_X, -HEIGHT * C_F / SIGMA / I_X],
            [V, E - A, 0, HEIGHT, -V / SIGMA],
        ]
    )


@pytest.mark.parametrize("drag", DRAGS)
def test_straight_tangent(drag):
    gear = damperopt.linear_gear(study_of(f"kind: yaw_bending, {GEAR}, drag: {drag}"))
    expected = np.linalg.eigvals(matrix(*DRAGS[drag]))
    found = gear.roots(V, LOAD)[0]
    np.testing.assert_allclose(np.sort_complex(found), np.sort_complex(expected), rtol=1e-9)


@pytest.mark.parametrize("drag", DRAGS)
def test_contact_memory(drag):
    """The determinant of theta, delta and the foremost point with the delay vanishes; the proof is on the side of the roots."""
    braked, rolling, stiffness = DRAGS[drag]
    study = study_of(f"kind: yaw_bending, {GEAR}, drag: {drag}", "memory")
    arm = (braked + rolling) / (stiffness or C_F / (A + SIGMA))
    c_c = C_F / (2 * (A + SIGMA) ** 2)

    def determinant(root):
        s = root / V
        z = 2 * A * s
        delayed, mean, first = np.exp(-z), (1 - np.exp(-z)) / z, (1 + np.exp(-z)) / z - 2 * (1 - np.exp(-z)) / z**2
        f = 2 * A * mean + SIGMA * (1 + delayed)
        m = 2 * A**2 * first + SIGMA * (A + SIGMA) * (1 - delayed)
        lag = 1 / (1 + SIGMA * s)
        by_theta = c_c * f * lag * (A + SIGMA), C_M - c_c * m * lag * (A + SIGMA)
        by_eta = c_c * f * lag - 2 * c_c * (A + SIGMA), -c_c * m * lag
        push, turn = ([of[k] for of in (by_theta, by_eta)] for k in (0, 1))
        # eta = -(e psi + l delta)
        F, M = ([of[0] - E * of[1], -HEIGHT * of[1]] for of in (push, turn))
        turned = LOAD * E + HEIGHT * braked + (HEIGHT - RADIUS) * rolling
        yaw = [I_Z * root**2 + C_PSI * root + K_PSI + (E - arm) * F[0] + M[0], (E - arm) * F[1] + M[1]]
        bending = [HEIGHT * F[0] - turned, I_X * root**2 + C_X * root + K_X + HEIGHT * F[1]]
        return np.linalg.det([yaw, bending]), abs(yaw[0] * bending[1]) + abs(yaw[1] * bending[0])

    rightmost = damperopt.linear_gear(study).roots(V, LOAD, 4)[0]
    for root in rightmost:
        value, scale = determinant(root)
        assert abs(value) < 1e-9 * scale
        assert abs(determinant(root * 1.001)[0]) > 1e-5 * scale
    proof = damperopt.certify(study.replace(damper__torsional_damping=3000.0), {}, margin=0.01)
    assert proof.proved
    assert proof.method == "balls"


def test_forces_where_they_act():
    """At large angles: the drag on a contact patch beside the wheel plane, and on the strut, by moments of vectors."""
    study = study_of(f"kind: yaw_bending, {GEAR}, drag: {{brake_torque: 7240, lateral_stiffness: 1e6}}")
    gear, psi, force = study.gear, 0.3, 9e3
    x = {"yaw_angle": psi, "yaw_rate": 0.0, "bending_angle": 0.1, "bending_rate": 0.0}
    (wheel,) = gear.wheels(x, V, LOAD)
    contact = Contact((), force, 0.0, deflection=9e9, wheel=wheel)
    rates = gear.rates(x, [contact], Torque(0), 0.0, Smooth()).rates
    # aft, and to the side to which a positive bending moves the wheel
    along, across = np.array([np.cos(psi), np.sin(psi)]), np.array([np.sin(psi), -np.cos(psi)])
    patch = E * along + force / 1e6 * across
    total = 20e3 * along
    turning = patch[0] * total[1] - patch[1] * total[0] - E * force
    assert rates["yaw_rate"] == pytest.approx(turning / I_Z, rel=1e-12)
    aside = HEIGHT * (total + force * across)[1] * np.cos(0.1) + LOAD * E * np.sin(psi)
    assert rates["bending_rate"] == pytest.approx((aside - K_X * 0.1) / I_X, rel=1e-12)


def test_translation_has_no_lever():
    drag = "drag: {brake_torque: 18.1 kN m, force: 5 kN}, sideways: {mass: 96, stiffness: 976000, damping: 48}"
    gear = damperopt.linear_gear(study_of(f"kind: yaw_translation, yaw_inertia: 100, caster_length: 0.12, {drag}"))
    A_5 = matrix(5e4, 5e3, None)
    A_5[3] = [55e3 / 96, 0, -976000 / 96, -48 / 96, -C_F / SIGMA / 96]
    A_5[4, 3] = 1
    np.testing.assert_allclose(np.sort_complex(gear.roots(V, LOAD)[0]), np.sort_complex(np.linalg.eigvals(A_5)), rtol=1e-9)


@pytest.mark.parametrize("contact", ["leading_point", "memory"])
def test_matrices_and_twins_without_track_are_the_gear_with_bending(contact):
    drag = "drag: {brake_torque: 18.1 kN m}"
    one = damperopt.linear_gear(study_of(f"kind: yaw_bending, {GEAR}, {drag}", contact)).roots(V, LOAD, 5)[0]
    matrices = "M: [[100, 0], [0, 600]], C: [[0, 0], [0, 300]], K: [[0, 0], [0, 6.1e6]], K_g: [[0, 0], [-0.12, 0]]"
    structure = f"{{{matrices}, K_D: [[0, 0], [-2.5, 0]], H_eta: [-0.12, -2.5], H_theta: [1, 0]}}"
    imported = damperopt.linear_gear(study_of(f"kind: imported, {drag}, structure: {structure}", contact))
    np.testing.assert_allclose(imported.roots(V, LOAD, 5)[0], one, rtol=1e-9)
    axle = "axle: {half_track: 0, slip_stiffness: 1e6, longitudinal_relaxation: 0.25, vertical_stiffness: 1e6}"
    twin = study_of(f"kind: twin, {GEAR}, {axle}, {drag}", contact)
    halved = twin.replace(tyre__cornering_stiffness=C_F / 2, tyre__aligning_stiffness=C_M / 2)
    found = damperopt.linear_gear(halved).roots(V, LOAD, 8)[0]
    assert all(np.abs(found - root).min() < 1e-7 * abs(root) for root in one)


def test_refused():
    with pytest.raises(damperopt.ConfigError, match=r"gear\.drag.*no drag"):
        study_of(f"kind: yaw_bending, {GEAR}, drag: {{}}")
    matrices = "M: [[100, 0], [0, 600]], C: [[0, 0], [0, 300]], K: [[0, 0], [0, 6.1e6]], H_eta: [-0.12, -2.5], H_theta: [1, 0]"
    with pytest.raises(damperopt.ConfigError, match=r"K_D.*missing key"):
        study_of(f"kind: imported, drag: {{force: 1 kN}}, structure: {{{matrices}}}")
    block = f"kind: yaw_bending, {GEAR}, drag: {{force: 80 kN}}"
    text = STUDY.format(gear=block, contact="memory", moment=C_M).replace("law: stiffness", "law: brush, friction: 0.7")
    with pytest.raises(damperopt.ConfigError, match=r"gear\.drag.*80000 N at a load of 100000 N.*less than 70000 N"):
        damperopt.loads(text.replace(f", aligning_stiffness: {C_M}", "").replace(f"aligning_stiffness: {C_M}", ""))

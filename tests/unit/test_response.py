"""The structure between ground and damper: transfer functions by hand, and its loop with the tyre against D with a delay."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from basic_twin import effective_caster
from memory_twin import F_Z, S, T, gear, study_text

from damperopt import certify, linear_gear, loads
from damperopt.gears.yaw import Yaw
from damperopt.proof.delay import roots_to_the_right
from damperopt.stability.linear import LinearModel
from damperopt.tyres.base import Linear

LINE = Linear(S["C_F"], S["C_M"], 0.3, 0.1)
LINKAGE = """damper: {topology: boeing, geometry: planar, compliance: rigid%s}
requirements: {stability_margin: 0.1, limit_torque: 12500, lug_distance: {min: 0.4, max: 1.1}, reach: {min: 0.1, max: 0.4}}
design: {c_lambda: 1e4, k_lambda: 4e6, L: 0.6, gamma: 31 deg}
"""


def with_linkage(joints="", phi=0.0, **gear_keys):
    text = study_text(gear(S, phi=phi))
    keys = "".join(f", {key}: {value}" for key, value in gear_keys.items())
    text = text.replace("wheel_radius: 0.362", f"wheel_radius: 0.362{keys}")
    start, end = text.index("damper:"), text.index("envelope:")
    return loads(text[:start] + LINKAGE % joints + text[end:])


STRUCTURES = {
    "plain": (5, with_linkage()),
    "links": (6, with_linkage(", link_stiffness: 8e6")),
    "links and series": (6, with_linkage(", link_stiffness: 8e6, series_stiffness: 3e7", phi=0.1571)),
    "spinning": (6, with_linkage(", series_stiffness: 3e7", phi=-0.1, wheel_polar_inertia=6.0)),
}
"""Number of states with that of the tyre."""


@pytest.mark.parametrize("case", STRUCTURES)
def test_loop_of_structure_and_tyre_is_the_characteristic_function(case):
    """det(s - A) det(1 - T C (s - A)^-1 B) (s + V/sigma) = D, for chains, rake and a spinning wheel."""
    order, study = STRUCTURES[case]
    model, design = LinearModel(study), study.start
    structure, V = model.structure, 14.0
    blocks = structure.at([design[name] for name in structure.design_names], np.array([V]), np.array([F_Z]))
    rng = np.random.default_rng(5)
    frozen = model.at(design).frozen(np.array([V]), np.array([F_Z]))
    ratios = []
    for s in rng.uniform(-5, 5, 8) + 1j * rng.uniform(1, 200, 8):
        G = blocks.transfer(np.array([s]))[0]
        F_theta, F_eta, M_theta, M_eta = study.tyre.contact.response(s / V, LINE)
        tyre = np.array([[F_eta, F_theta], [M_eta, M_theta]])
        n = blocks.A.shape[1]
        loop = np.linalg.det(s * np.eye(n) - blocks.A[0]) * np.linalg.det(np.eye(2) - tyre @ G)
        A, _ = frozen.at(np.array([[s]]))
        D = np.linalg.det(s * np.eye(n + 1) - A[0, 0])
        ratios.append(D / (loop * (s + V / 0.3)))
    assert ratios == pytest.approx(np.ones(8), rel=1e-9)
    assert len(structure.states) == order - 1


def test_transfer_functions_by_hand():
    """Two uncoupled oscillators where load and bending height do not couple them: eta and theta over F_y and M_z, with rake."""
    p = gear(S, phi=0.1571, kappa=0.0)
    study = loads(study_text(p))
    structure, V, s = LinearModel(study).structure, 20.0, 3 + 60j
    G = structure.at([], np.array([V]), np.array([F_Z])).transfer(np.array([s]))[0]
    e, c = effective_caster(p), np.cos(p.phi)
    # I_z psi'' = -e F - M + F_z sin(phi) e theta, I_x delta'' = -l_g c F + F_z e theta
    yaw = p.I_z * s**2 + p.c_psi * s + p.k_psi - F_Z * np.sin(p.phi) * e * c
    bending = p.I_x * s**2 + p.c_delta * s + p.k_delta
    for column, (F, M) in enumerate(((1.0, 0.0), (0.0, 1.0))):
        psi = (-e * F - M) / yaw
        delta = (-p.l_g * c * F + F_Z * e * c * psi) / bending
        assert G[:, column] == pytest.approx([-(e * c * psi + p.l_g * delta), c * psi], rel=1e-12)


def test_force_rows_are_not_the_transposes_with_rake():
    structure = LinearModel(loads(study_text(gear(T, phi=0.1571)))).structure
    blocks = structure.at([], np.array([20.0]), np.array([F_Z]))
    scaled = np.array([blocks.B[0, 1] * 100.0, blocks.B[0, 3] * 600.0])  # of yaw and bending, times their inertias
    measured = blocks.C[0][:, [0, 2]].T
    assert not np.allclose(scaled, measured * [[1, -1], [1, -1]], rtol=1e-6)
    straight = LinearModel(loads(study_text(gear(T)))).structure.at([], np.array([20.0]), np.array([F_Z]))
    scaled = np.array([straight.B[0, 1] * 100.0, straight.B[0, 3] * 600.0])
    assert scaled == pytest.approx(straight.C[0][:, [0, 2]].T * [[1, -1], [1, -1]], rel=1e-12)


def test_speeds_that_nearly_stand_are_answered_and_never_proved_wrongly():
    """The structure then follows the string, which relaxes along its path: as fast as the wheel rolls."""
    study = loads(study_text(gear(T), low=0.002, high=0.004))
    slow, slower = (linear_gear(study).abscissa(V, F_Z)[0] for V in (0.03, 0.003))
    assert slower == pytest.approx(slow / 10, rel=1e-3)
    assert certify(study, {}, 1e3).verdict in ("refuted", "undecided")


def test_published_towed_wheel():
    """Stable at every speed on the leading point, with windows of shimmy once the contact line remembers."""
    text = """
gear: {order: 3, yaw_inertia: 2.2080820440169657, caster_length: 0.2, wheel_radius: 0.2}
tyre: {law: stiffness, half_contact_length: 0.04, relaxation_length: 0.072, carcass_stiffness: 53506, contact: %s}
damper: {topology: rotational, torsional_stiffness: 0, torsional_damping: 0}
envelope: {speed: {min: 0.05, max: 2}, vertical_load: 100}
"""
    tangent, memory = (loads("name: towed" + text % contact) for contact in ("leading_point", "memory"))
    assert certify(tangent, {}, 0.0).proved
    assert certify(memory, {}, 0.0).verdict == "refuted"


class TwoWheels(Yaw):
    """Two wheels on one axle, half of the load and of the tyre each: together one."""

    def wheels(self, x, speed, load):
        (wheel,) = super().wheels(x, speed, load)
        return tuple(replace(wheel, load=load / 2, index=i) for i in range(2))

    def rates(self, x, contacts, damper, yaw_torque, corners):
        one, other = contacts
        force, moment = one.side_force + other.side_force, one.aligning_moment + other.aligning_moment
        return super().rates(x, [replace(one, side_force=force, aligning_moment=moment)], damper, yaw_torque, corners)


def test_two_wheels_are_one():
    """Eigenvalues, count and proof of a gear with two contact lines; the difference of the lines decays by itself."""
    single = loads(study_text(gear(S, c_psi=900.0), order=3))
    half = {"cornering_stiffness": S["C_F"] / 2, "aligning_stiffness": S["C_M"] / 2, "tread_width_moment": 285.0}
    blocks = {key: getattr(single, key) for key in type(single).model_fields}
    wheels = TwoWheels.model_construct(**{key: getattr(single.gear, key) for key in Yaw.model_fields})
    double = type(single).model_construct(**blocks | {"gear": wheels, "tyre": single.tyre.model_copy(update=half)})
    model = LinearModel(double)
    for V in (8.0, 25.0, 60.0):
        one = linear_gear(single).roots(V, F_Z)[0]
        two = model.at({}).roots(V, F_Z, 6)[0]
        for root in one:
            assert np.abs(two - root).min() < 1e-9 * abs(root)
        assert np.abs(two + V / 0.3).min() < 1e-9 * V / 0.3  # v1 of one against the other's: sigma v' = -V v
        for margin in (0.0, 1.0):
            count = roots_to_the_right(double, {}, margin, V, F_Z, model)
            assert count == roots_to_the_right(single, {}, margin, V, F_Z, LinearModel(single))
    for margin in (0.0, 0.1, 3.0):
        assert certify(double, {}, margin, model).verdict == certify(single, {}, margin).verdict

"""Elastic chains: against published algebra, a hand-written matrix, hand formulas, and rigid limits."""

import math

import numpy as np
import pytest
from own_gear import feet_on_beam
from scipy.linalg import expm

import damperopt
from damperopt.linkages.elastic import elastic_linkage, leg_length, two_legs_stiffness
from damperopt.stability.linear import LinearModel
from damperopt.stability.worst import worst_points
from damperopt.strength.release import peak_damper_torque

ELL = 0.25  # reach of the apex: L 0.5 m at 30 deg
LAYOUT = {"L": 0.5, "gamma": math.radians(30)}


def chain(configs, K_t, k, c):
    """The main gear with these numbers about the yaw axis: stiffness in front, spring and damper behind."""
    study = damperopt.load(configs / "thesis_gear.yaml").replace(
        damper={"topology": "boeing", "geometry": "planar", "compliance": {"link": K_t / ELL**2, "damper": "rigid"}}
    )
    return study, {"c_lambda": c / ELL**2, "k_lambda": k / ELL**2, **LAYOUT}


def by_hand(V, K_t, k, c):
    """State matrix of Table 0.1 of the thesis with a chain K_t - (k, c): psi, psi', delta, delta', y, psi_l."""
    a, e, I_z, I_x, F_z, C_F, C_M, sigma = 0.1, 0.12, 100.0, 600.0, 150e3, 0.014, 1.0, 0.3
    k_d, c_d, l_g, kappa = 6.1e6, 300.0, 2.5, 570.0
    return np.array(
        [
            [0, 1, 0, 0, 0, 0],
            [-K_t / I_z, -kappa / V / I_z, 0, 0, -(e * C_F + C_M) * F_z / (I_z * sigma), K_t / I_z],
            [0, 0, 0, 1, 0, 0],
            [F_z * e / I_x, 0, -k_d / I_x, -c_d / I_x, -l_g * C_F * F_z / (I_x * sigma), 0],
            [V, e - a, 0, l_g, -V / sigma, 0],
            [K_t / c, 0, 0, 0, 0, -(K_t + k) / c],
        ]
    )


@pytest.mark.parametrize(("K_t", "k", "c", "worst"), [(4.38e5, 2e5, 8e3, -0.208197), (2e6, 1e6, 1.2e4, 0.061919)])
def test_chain_of_the_design_page(configs, K_t, k, c, worst):
    """Both are worst at 5 m/s with the leading point; the numbers come from an independent model."""
    study, design = chain(configs, K_t, k, c)
    model = LinearModel(study)
    found = worst_points(model.at(design), study)[0]
    assert (found.speed, round(found.abscissa, 6)) == (5.0, worst)
    for V in (5.0, 8.75, 20.0, 100.0):
        mine, theirs = (np.linalg.eigvals(A) for A in (model.at(design).matrices(V, 150e3)[0], by_hand(V, K_t, k, c)))
        assert np.abs(np.sort_complex(mine) - np.sort_complex(theirs)).max() < 1e-9 * np.abs(theirs).max()


def test_a_frame_is_a_truss_of_two_bars():
    """Direct stiffness of two bars from (0, +-w/2) and unequal ones to one joint, whose motion along the links is free."""
    E, A, L, w = 207e9, 2e-4, 0.4781, 0.25
    for offset in (0.0, 0.17):
        feet = (offset + w / 2, offset - w / 2)
        K = np.zeros((2, 2))
        for foot in feet:
            bar = np.array([L, foot])
            K += E * A / np.linalg.norm(bar) ** 3 * np.outer(bar, bar)
        across = 1 / np.linalg.inv(K)[1, 1]
        legs = tuple(leg_length(L, foot) for foot in feet)
        assert two_legs_stiffness(E, A, legs, w) == pytest.approx(across, rel=1e-12)


@pytest.mark.parametrize("topology", ["boeing", "utas", "arreaza"])
@pytest.mark.parametrize("geometry", ["planar", "spatial"])
def test_stiff_parts_are_rigid(configs, topology, geometry):
    """With parts that are a million times as stiff the roots are those of the rigid chain, and one more far to the left."""
    study = damperopt.load(configs / "thesis_gear.yaml").replace(damper__topology=topology, damper__geometry=geometry)
    stiff = study.replace(damper__compliance={"torsion": 1e12, "link": 1e10, "arm": "rigid", "support": 1e10, "damper": 1e10})
    design = study.start | {"c_lambda": 2e4} | ({"I_arm": 2e-7} if topology != "boeing" else {})
    rigid, elastic = (np.linalg.eigvals(LinearModel(s).at(design).matrices(40.0, 150e3)[0]) for s in (study, stiff))
    kept = elastic[np.argsort(elastic.real)[1:]]
    assert np.abs(np.sort_complex(kept) - np.sort_complex(rigid)).max() < 1e-3 * np.abs(rigid).max()


def test_impedance_of_a_chain(configs):
    """Z(s) = k_t (k + s c)/(k_t + k + s c) in front of a damper without series stiffness."""
    K_t, k, c = 4.38e5, 2e5, 8e3
    study, design = chain(configs, K_t, k, c)
    A = LinearModel(study).at(design).matrices(1e4, 1e-3)[0]
    names = LinearModel(study).state_names
    psi, rate, link = (names.index(name) for name in ("yaw_angle", "yaw_rate", "link_angle"))
    s = 70j
    Z = -(A[rate, psi] + A[rate, link] * A[link, psi] / (s - A[link, link])) * study.gear.yaw_inertia
    assert pytest.approx(K_t * (k + s * c) / (K_t + k + s * c), rel=1e-6) == Z


def test_stiffness_of_the_parts_by_hand(configs):
    """Arreaza's chain from its sections, each formula written out once more."""
    study = damperopt.load(configs / "main_gear.yaml")
    E, L, gamma, b = 207e9, 0.55, 0.72, 0.18
    design = {"c_lambda": 3e4, "I_arm": 1e-6, "L": L, "gamma": gamma, "b": b}
    design |= {"A_link": 2e-4, "A_support": 1.5e-4, "A_piston": 6e-4, "rod_diameter": 0.014, "s_damper": 0.009}
    design |= {"I_hinge": 5e-7, "I_foot": 4e-7}
    study = study.replace(damper__links={"form": "a_frame"})
    link = elastic_linkage(study, design)
    w, leg = L / 2, math.hypot(L, L / 4)
    lower = 2 * E * 2e-4 / leg * (w / 2 / leg) ** 2, 1 / feet_on_beam(E, 5e-7, L, w, 0.0)
    assert float(link.links) == pytest.approx(1 / (1 / lower[0] + 1 / lower[1]), rel=1e-12)
    legs = math.hypot(L, b + w / 2), math.hypot(L, b - w / 2)
    support = E * 1.5e-4 * w**2 / (legs[0] ** 3 + legs[1] ** 3)
    oil = 2 * 1e9 * 6e-4 / (0.009 + 0.02)
    rod = E * math.pi / 4 * 0.014**2 / (2 * 0.009 + 0.12)
    foot = feet_on_beam(E, 4e-7, L, w, b)
    assert float(link.series) == pytest.approx(1 / (1 / support + foot + 1 / oil + 1 / rod), rel=1e-12)


@pytest.mark.parametrize("c", [1.0, 3e3, 4e4, 1e6])
@pytest.mark.parametrize(("front", "series"), [(2e6, 3e6), (None, 3e6), (2e6, None)])
def test_peak_of_a_released_chain(c, front, series):
    """Against the exponential of the same motion in small steps, with the states that each chain has."""
    inertia, k, T = 100.0, 4e5, 1.2e4
    if front is None:  # psi, psi', dashpot
        A = [[0, 1, 0], [-(k + series) / inertia, 0, series / inertia], [series / c, 0, -series / c]]
        force, start = [series, 0, -series], [T / k, 0, T / k]
    elif series is None:  # psi, psi', angle behind the links
        A = [[0, 1, 0], [-front / inertia, 0, front / inertia], [front / c, 0, -(front + k) / c]]
        force, start = [front, 0, -(front + k)], [T / k + T / front, 0, T / k]
    else:
        behind = np.array([front, 0, series]) / (front + k + series)
        force = series * (behind - [0, 0, 1])
        A = [[0, 1, 0], -front / inertia * ([1, 0, 0] - behind), force / c]
        start = [T / k + T / front, 0, T / k]
    steps = 4000
    advance = expm(np.array(A) * math.tau * math.sqrt(inertia / k) / steps)
    states = [np.array(start)]
    for _ in range(steps):
        states.append(advance @ states[-1])
    largest = np.abs(states @ np.array(force)).max()
    assert peak_damper_torque(T, inertia, front, k, c, series) == pytest.approx(largest, rel=2e-5)

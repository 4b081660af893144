"""Every kind of gear with random numbers and rake against state matrices that are written out here."""

import numpy as np
import pytest
import yaml

import damperopt

DRAWS = range(3)
CLOSE = 1e-11
"""Relative, of eigenvalues: rounding in two ways of writing the same matrix."""


class Numbers:
    """Of one gear, drawn; every draw has a rake, every third a free castering collar."""

    def __init__(self, seed):
        draw = np.random.default_rng(seed).uniform
        self.__dict__ |= {name: float(draw(*ends)) for name, ends in RANGES.items()}
        self.k_s *= seed % 3 != 0
        self.sin, self.cos = (float(f(self.phi)) for f in (np.sin, np.cos))
        self.lever = self.e * self.cos + (self.R_w + self.e * self.sin) * self.sin / self.cos
        self.h = self.I_p * self.V / self.R_w
        self.lateral = {"inertia": self.I_x, "stiffness": self.k_x, "damping": self.c_x, "height": self.l}

    def block(self, gear):
        given = {"half_contact_length": self.a, "relaxation_length": self.sigma, "tread_width_moment": self.kappa}
        stiff = {"cornering_stiffness": self.C_F, "aligning_stiffness": self.C_M}
        return {
            "name": "drawn",
            "gear": gear,
            "tyre": {"law": "stiffness", "contact": "leading_point", **given, **stiff},
            "damper": {"topology": "rotational", "torsional_stiffness": self.k, "torsional_damping": self.c},
            "envelope": {"speed": {"min": 1.0, "max": 120.0}, "vertical_load": self.F_z},
        }

    def roots(self, **gear):
        body = {"yaw_inertia": self.I_z, "caster_length": self.e, "rake_angle": self.phi}
        own = {} if gear["kind"] == "imported" else body
        study = damperopt.loads(yaml.safe_dump(self.block({"wheel_radius": self.R_w, **own, **gear})))
        return damperopt.linear_gear(study).roots(self.V, self.F_z)[0]

    def bending(self, wheels=1, k=None, c=None, spin=True):
        """psi, psi', delta, delta', y of yaw, bending and so many wheels on one string."""
        k, c, h = self.k if k is None else k, self.c if c is None else c, wheels * self.h * spin
        F, M, kappa = wheels * self.C_F / self.sigma, wheels * self.C_M / self.sigma, wheels * self.kappa
        turned = self.F_z * self.lever * self.cos
        yaw = [turned * self.sin - k, -c - kappa * self.cos / self.V, 0, h, -(self.lever * F + M)]
        bend = [turned, -h, -self.k_x, -self.c_x, -self.l * self.cos * F]
        string = [self.V * self.cos, (self.lever - self.a) * self.cos, 0, self.l, -self.V / self.sigma]
        return np.array([[0, 1, 0, 0, 0], np.array(yaw) / self.I_z, [0, 0, 0, 1, 0], np.array(bend) / self.I_x, string])


RANGES = {"I_z": (10, 200), "e": (-0.05, 0.3), "R_w": (0.15, 0.7), "C_F": (5e4, 1e6), "C_M": (0, 5e4), "a": (0.03, 0.2)}
RANGES |= {"sigma": (0.05, 0.6), "kappa": (0, 600), "k": (0, 5e5), "c": (0, 2000), "V": (3, 110), "F_z": (5e3, 2e5)}
RANGES |= {"phi": (-0.2, 0.25), "I_x": (200, 900), "k_x": (5e5, 1e7), "c_x": (0, 2000), "l": (0.8, 3), "I_p": (0.5, 12)}
RANGES |= {"I_s": (0.2, 8), "k_t": (1e4, 6e5), "c_t": (0, 200), "k_s": (1e4, 2e6), "c_s": (0, 5e4), "c_0": (0, 300)}
RANGES |= {"t_w": (0, 0.6), "C_kappa": (1e5, 2e6), "sigma_x": (0.1, 0.5), "K_z": (1e5, 2e6), "k_co": (0, 500)}
RANGES |= {"m_w": (50, 300), "k_w": (5e4, 2e6), "c_w": (0, 200), "m": (5, 20), "x_g": (-0.2, 0.2), "l_c": (0.5, 2)}


@pytest.fixture(params=DRAWS)
def drawn(request):
    return Numbers(request.param)


def agree(found, matrix):
    expected = np.linalg.eigvals(matrix)
    assert len(found) == len(expected)
    assert all(np.abs(expected - root).min() < CLOSE * (1 + abs(root)) for root in found)


def test_bending_and_spin(drawn):
    agree(drawn.roots(kind="yaw_bending", lateral=drawn.lateral), drawn.bending(spin=False))
    agree(drawn.roots(kind="spinning_wheel", lateral=drawn.lateral, wheel_polar_inertia=drawn.I_p), drawn.bending())


@pytest.mark.parametrize("at", ["links", "steering"])
def test_collar(drawn, at):
    n, A = drawn, np.zeros((7, 7))
    A[:5, :5] = n.bending(k=0, c=n.c_0)
    k_t, c_t, k_s, c_s = (n.k_t + n.k, n.c_t + n.c, n.k_s, n.c_s) if at == "links" else (n.k_t, n.c_t, n.k_s + n.k, n.c_s + n.c)
    links = np.array([-k_t, -c_t, 0, 0, 0, k_t, c_t])
    A[1] += links / n.I_z
    A[5, 6] = 1
    A[6] = -links / n.I_s
    A[6, 5:] -= np.array([k_s, c_s]) / n.I_s
    collar = {"inertia": n.I_s, "damper_at": at, "link_stiffness": n.k_t, "link_damping": n.c_t, "swivel_damping": n.c_0}
    collar |= {"steering_stiffness": n.k_s, "steering_damping": n.c_s}
    agree(n.roots(kind="seventh", lateral=n.lateral, wheel_polar_inertia=n.I_p, collar=collar), A)


def test_two_wheels(drawn):
    n, A, one = drawn, np.zeros((8, 8)), drawn.bending(wheels=2)
    A[:4, :4], A[:4, 4], A[:4, 5] = one[:4, :4], one[:4, 4] / 2, one[:4, 4] / 2
    A[4, :5] = one[4]
    A[5, [0, 1, 3, 5]] = one[4, [0, 1, 3, 4]]
    A[3, 2] -= 2 * n.K_z * n.t_w**2 / n.I_x
    A[1, 6] = -2 * n.C_kappa / n.sigma_x * n.t_w * n.cos / n.I_z
    A[6, [1, 6, 7]] = n.t_w * n.cos, -n.V / n.sigma_x, -n.R_w
    A[7, [6, 7]] = n.R_w * n.C_kappa / n.sigma_x / n.I_p, -2 * n.k_co / n.I_p
    axle = {"half_track": n.t_w, "slip_stiffness": n.C_kappa, "longitudinal_relaxation": n.sigma_x, "vertical_stiffness": n.K_z}
    both = {"lateral": n.lateral, "wheel_polar_inertia": n.I_p, "axle": axle}
    agree(n.roots(kind="twin", **both), A[:7, :7])
    agree(n.roots(kind="twin_independent", corotation=n.k_co, **both), A)


def test_mass_off_the_axis(drawn):
    n, inertia = drawn, np.eye(5)
    swivelling = {"mass": n.m, "offset": n.x_g}
    inertia[1, 3], inertia[3, 1] = n.m * n.x_g * n.l_c / n.I_z, n.m * n.x_g * n.l_c / n.I_x
    gear = {"lateral": n.lateral, "wheel_polar_inertia": n.I_p, "swivelling": swivelling, "swivelling_height": n.l_c}
    agree(n.roots(kind="yaw_bending_offset", **gear), np.linalg.solve(inertia, n.bending()))
    A = n.bending(spin=False)
    A[3] = np.array([0, 0, -n.k_w, -n.c_w, -n.cos * n.C_F / n.sigma]) / n.m_w
    A[4, 3] = 1
    inertia[1, 3], inertia[3, 1] = n.m * n.x_g / n.I_z, n.m * n.x_g / n.m_w
    sideways = {"mass": n.m_w, "stiffness": n.k_w, "damping": n.c_w}
    agree(n.roots(kind="yaw_translation", sideways=sideways, swivelling=swivelling), np.linalg.solve(inertia, A))


def test_matrices(drawn):
    n, lever = drawn, drawn.lever
    squares = {"M": [[n.I_z, 0], [0, n.I_x]], "C": [[0, 0], [0, n.c_x]], "K": [[0, 0], [0, n.k_x]]}
    squares |= {"K_g": [[-n.sin * lever * n.cos, 0], [-lever * n.cos, 0]], "G": [[0, -n.I_p / n.R_w], [n.I_p / n.R_w, 0]]}
    rows = {"H_eta": [-lever * n.cos, -n.l], "H_theta": [n.cos, 0], "B_F": [-lever, -n.l * n.cos], "B_M": [1, 0], "H_d": [1, 0]}
    agree(n.roots(kind="imported", structure=squares | rows), n.bending())

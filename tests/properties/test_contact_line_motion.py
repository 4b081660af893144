"""Motions with contact memory: against eigenvalues, and a brute-force history of points that the ground carries along."""

from __future__ import annotations

import numpy as np
import pytest
from basic_twin import parameters
from memory_twin import F_Z, T, gear, study_text

from damperopt import ConfigError, linear_gear, loads, simulate, simulate_exactly
from damperopt.ports.wheel import Wheel
from damperopt.tyres.assembly import contact_lines
from damperopt.tyres.base import Linear

ARCTANGENT = """law: arctangent, cornering_coefficient: 0.002, aligning_coefficient: 1.0, aligning_slip_limit: 10 deg,
       half_contact_length: 0.1, relaxation_length: 0.3, tread_width_moment: 570.0"""


def nonlinear(contact="memory", low=5.0):
    text = study_text(gear(T), low=low, contact=contact)
    start, end = text.index("tyre: {") + len("tyre: {"), text.index(", contact:")
    return loads(text[:start] + ARCTANGENT + text[end:])


class History:
    """The nonlinear gear of Table 0.1 whose contact line is a row of points that the ground carries backwards.

    Each point is laid down at x = a with the deflection y of the moment, and moves in the wheel frame as the ground does:
    x' = -V cos(theta), v' = V sin(theta) - eta' - x cos(theta) theta'. Force and moment are sums over the trapezia between the
    points; the rear end lies between two of them. Runge-Kutta steps of fourth order.
    """

    def __init__(self, V, F_z, start, kick=(0.0, 0.0), deflection=0.0, steps=200):
        p = self.p = parameters()
        self.V, self.F_z, self.h = V, F_z, 2 * p.a / V / steps
        # front first; one point beyond the rear end
        self.x = np.linspace(p.a, -p.a, steps + 1)
        self.x = np.append(self.x, self.x[-1] - 2 * p.a / steps)
        self.v = np.full(self.x.size, deflection)
        self.s = np.array([start[0], kick[0], start[1], kick[1], deflection])
        self.C_Fa, self.C_Ma = 7 * p.C_F * F_z, p.C_M * F_z

    def forces(self, y, x, v):
        p, a, sigma = self.p, self.p.a, self.p.sigma
        x, v = np.append(a, x), np.append(y, v)
        last = int(np.searchsorted(-x, a))
        share = (x[last - 1] + a) / (x[last - 1] - x[last])
        rear = v[last - 1] + share * (v[last] - v[last - 1])
        x, v = np.append(x[:last], -a), np.append(v[:last], rear)
        F = -np.trapezoid(v, x) + sigma * (y + rear)
        M = np.trapezoid(x * v, x) - sigma * (a + sigma) * (y - rear)
        tan_F, tan_M = F / (2 * (a + sigma) ** 2), M / (2 * a * (sigma * (a + sigma) + a**2 / 3))
        X = np.arctan(7 * tan_F)
        alpha = np.arctan(tan_M)
        moment = p.C_M * p.alpha_m / np.pi * np.sin(np.pi * alpha / p.alpha_m) * self.F_z if abs(alpha) < p.alpha_m else 0.0
        return p.C_F * X * np.cos(0.95 * X) * self.F_z, moment

    def rates(self, s, x, v):
        p, V = self.p, self.V
        psi, psi_t, delta, delta_t, y = s
        F, M = self.forces(y, x, v)
        cos = np.cos(psi)
        eta_t = -(p.e * cos * psi_t + p.l_g * np.cos(delta) * delta_t)
        psi_tt = (-p.k_psi * psi - p.c_psi * psi_t - p.e * F - M - p.kappa / V * psi_t) / p.I_z
        bending = -p.k_delta * delta - p.c_delta * delta_t - p.l_g * F * cos * np.cos(delta) + self.F_z * p.e * np.sin(psi)
        y_t = V * np.sin(psi) - eta_t - p.a * cos * psi_t - V / p.sigma * y * cos
        line = V * np.sin(psi) - eta_t - x * cos * psi_t
        return np.array([psi_t, psi_tt, delta_t, bending / p.I_x, y_t]), np.full(x.size, -V * cos), line

    def run(self, duration):
        count = round(duration / self.h)
        psi = [self.s[0]]
        for _ in range(count):
            h, state = self.h, (self.s, self.x, self.v)
            k1 = self.rates(*state)
            k2 = self.rates(*(q + h / 2 * k for q, k in zip(state, k1, strict=True)))
            k3 = self.rates(*(q + h / 2 * k for q, k in zip(state, k2, strict=True)))
            k4 = self.rates(*(q + h * k for q, k in zip(state, k3, strict=True)))
            parts = zip(state, k1, k2, k3, k4, strict=True)
            self.s, x, v = (q + h / 6 * (a + 2 * b + 2 * c + d) for q, a, b, c, d in parts)
            kept = np.searchsorted(-x, self.p.a) + 1
            self.x, self.v = np.append(self.p.a, x[:kept]), np.append(self.s[4], v[:kept])
            psi.append(self.s[0])
        return self.h * np.arange(count + 1), np.array(psi)


@pytest.mark.parametrize(
    ("V", "disturbance", "keys"),
    [
        (20.0, {"release": {"yaw_angle": 0.05}}, {"start": (0.05, 0.0)}),
        (8.0, {"release": {"yaw_angle": 0.03, "bending_angle": 0.004}}, {"start": (0.03, 0.004)}),
        (20.0, {"kick": {"yaw_rate": 4.0}}, {"start": (0.0, 0.0), "kick": (4.0, 0.0)}),
        (30.0, {"release": {"string_deflection": 0.02}}, {"start": (0.0, 0.0), "deflection": 0.02}),
    ],
    ids=["release", "slow", "kick", "string"],
)
def test_nonlinear_motion_is_that_of_points_on_the_ground(V, disturbance, keys):
    """Large motions, all starts: a release finds the line in the wheel plane, a deflection shifts all of it."""
    t, psi = History(V, F_Z, **keys).run(0.3)
    for run in (simulate, simulate_exactly):
        found = run(nonlinear(), speed=V, disturbance=disturbance, duration=0.3)
        assert found.status == "completed"
        error = np.abs(np.interp(t, found.time, found["yaw_angle"]) - psi).max() / np.abs(psi).max()
        assert error < 4e-3  # chords between output points: (0.15)^2/8
        spline = np.polynomial.polynomial.polyfit(found.time[-9:] - 0.3, found["yaw_angle"][-9:], 5)
        assert spline[0] == pytest.approx(np.interp(0.3, t, psi), abs=3e-4 * np.abs(psi).max())  # trapezia of a/100


def test_history_converges_to_the_field():
    """Finer points come nearer, with the square of their distance."""
    field = simulate(nonlinear(), speed=20.0, disturbance={"release": {"yaw_angle": 0.05}}, duration=0.2)["yaw_angle"][-1]
    errors = [abs(History(20.0, F_Z, (0.05, 0.0), steps=n).run(0.2)[1][-1] - field) for n in (50, 100, 200)]
    assert errors[2] < 2e-5
    assert errors[0] / errors[2] > 6


@pytest.mark.parametrize("contact", ["memory", "von_schlippe", "parabola"])
def test_small_motions_follow_exact_eigenvalues(contact):
    """What is left after the first quarter of a second is a sum of the five leading modes of the exact gear."""
    study = loads(study_text(gear(T), contact=contact))
    motion = simulate(study, speed=20.0, disturbance={"kick": {"yaw_rate": 1e-3}}, duration=1.0, tolerance=1e-11)
    roots = linear_gear(study).roots(20.0, F_Z)[0]
    late = motion.time > 0.25
    modes = np.exp(np.multiply.outer(motion.time[late], roots))
    shares, *_ = np.linalg.lstsq(modes, motion["yaw_angle"][late].astype(complex), rcond=None)
    left = np.abs(modes @ shares - motion["yaw_angle"][late]).max()
    assert left < 1e-6 * np.abs(motion["yaw_angle"]).max()


def test_order_of_the_field_is_refused_where_it_is_too_low():
    study = loads(study_text(gear(T), low=0.5, contact="{kind: memory, order: 3}"))
    release = {"release": {"yaw_angle": 1e-3}}
    with pytest.raises(ConfigError, match=r"tyre\.contact\.order"):
        simulate(study, speed=1.0, disturbance=release, duration=0.1)
    fine = study.replace(tyre__contact={"kind": "memory", "order": 30})
    assert simulate(fine, speed=1.0, disturbance=release, duration=0.1, engine="cvodes").status == "completed"


def test_field_converges_with_its_order():
    """The motion at 10 m/s by orders 4, 6, 8 against 20."""
    ends = {}
    for order in (4, 6, 8, 20):
        study = nonlinear(f"{{kind: memory, order: {order}}}")
        release = {"release": {"yaw_angle": 0.03}}
        ends[order] = simulate(study, speed=14.0, disturbance=release, duration=0.3, tolerance=1e-11, engine="cvodes")[
            "yaw_angle"
        ]
    errors = [np.abs(ends[order] - ends[20]).max() for order in (6, 8)]
    assert errors[0] < 1e-5
    assert errors[1] < 1e-6


@pytest.mark.parametrize("tag", ["memory", "von_schlippe", "parabola", "leading_point", "pade"])
@pytest.mark.parametrize("theta", [0.02, 0.2, -0.5])
def test_steady_slip_is_the_swivel(tag, theta):
    """Rolling straight at a swivel, the deflections stand still at the one state where both slip angles are the swivel."""
    line = contact_lines()[tag](contact=tag)
    linear, a, sigma = Linear(4e5, 3e4, 0.3, 0.1), 0.1, 0.3
    y, slope = sigma * np.tan(theta), np.tan(theta)
    x = [y, a * slope, -a * slope, *[0.0] * 40][: len(line.states())]  # u = tan(theta) (a - x), in Legendre polynomials
    rates, alpha_F, alpha_M = line.slips(Wheel(30.0, theta, 0.0, 0.01, 0.0, 0.12, F_Z), linear, x)
    assert np.abs(rates).max() < 1e-12
    assert alpha_M == pytest.approx(theta, rel=1e-12)
    assert alpha_F == pytest.approx(theta, rel=1e-12)


def test_leading_point_is_the_front_of_every_line():
    """y' is today's equation, whatever lies behind it."""
    lines = [contact_lines()[tag](contact=tag) for tag in ("leading_point", "memory", "parabola")]
    wheel, linear = Wheel(30.0, 0.2, 1.5, 0.03, -0.4, 0.12, F_Z), Linear(4e5, 3e4, 0.3, 0.1)
    rng = np.random.default_rng(2)
    found = [line.slips(wheel, linear, [0.02, *rng.uniform(-0.01, 0.01, len(line.states()) - 1)]).rates[0] for line in lines]
    assert found == pytest.approx([found[0]] * 3, rel=1e-13)


def test_coefficients_of_the_field_are_not_shown():
    """They are internal; the deflection of the leading point is what users see."""
    for run in (simulate, simulate_exactly):
        motion = run(nonlinear(), speed=20.0, disturbance={"kick": {"yaw_rate": 0.1}}, duration=0.05)
        assert "string_deflection" in motion.states
        assert not [name for name in motion.states if name.startswith("contact_line")]

"""Motion along a history against integrators of other equations: momentum, and the path that the tyre lays on the ground.

Small motions, so that both are linear. Bending is written with the momentum I_x delta', the tyre with the lateral position q of
the ground points under it: a point that the front meets at X = s + a lies where the string ahead of it leads,
dq/dX = theta - y/sigma, and stays there; with memory, force and moment are integrals of q over s - a .. s + a.
"""

import numpy as np
import pytest
import yaml
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import brentq

import damperopt
from damperopt.motion.history import frozen_along, simulate_along
from damperopt.study.history import History

GEAR = {"I_z": 100.0, "e": 0.12, "k_psi": 4e5, "c_psi": 900.0, "I_x": 600.0, "k": 6.1e6, "c": 2000.0, "l": 2.5, "kappa": 200.0}
GAS = {"pressure": 1.2e6, "area": 0.03, "volume": 0.015, "exponent": 1.15}
MASS, SLOPE, TRAIL, SIGMA = 60.0, 12.0, 0.4, 0.3
STIFFNESS = [5.5e6, 6.8e6]
LOADS, LENGTHS = [20e3, 160e3], [0.05, 0.15]
ROWS = (
    (0.0, 60.0, 50e3, 0.0),
    (0.05, 59.5, 130e3, 40.0),
    (0.1, 59.0, 90e3, 0.0),
    (0.2, 52.0, 60e3, -30.0),
    (0.4, 30.0, 110e3, 0.0),
)
RELEASE = 1e-4


def history(stroke=None):
    keys = ("time", "speed", "load", "yaw_torque")
    rows = [dict(zip(keys, row, strict=True)) for row in ROWS]
    rows = rows if stroke is None else [row | {"stroke": x} for row, x in zip(rows, stroke, strict=True)]
    return History(moments=rows)


def study_of(contact):
    G = GEAR
    lateral = {"inertia": G["I_x"], "stiffness": G["k"], "damping": G["c"], "height": G["l"]}
    strut = {"gas": GAS, "travel": 0.42, "moving_mass": MASS}
    strut["bending_stiffness"] = {"stroke": [0, 0.42], "value": STIFFNESS}
    data = {
        "name": "roll",
        "gear": {"kind": "yaw_bending", "yaw_inertia": G["I_z"], "caster_length": G["e"], "wheel_radius": 0.36},
        "tyre": {
            "law": "linear",
            "half_contact_length": {"load": LOADS, "value": LENGTHS},
            "relaxation_length": SIGMA,
            "cornering_slope": SLOPE,
            "aligning_coefficient": TRAIL,
            "tread_width_moment": G["kappa"],
            "contact": contact,
        },
        "damper": {"topology": "rotational", "torsional_stiffness": G["k_psi"], "torsional_damping": G["c_psi"]},
        "envelope": {"speed": {"min": 20, "max": 70}, "vertical_load": 90e3},
    }
    data["gear"] |= {"lateral": lateral, "strut": strut}
    return damperopt.loads(yaml.safe_dump(data))


class Ground:
    """Everything that the history gives, as functions of time, and the gear on it."""

    def __init__(self, stroke=None, stretch=True):
        self.t, self.V, self.F, self.T = np.array(ROWS).T
        self.given, self.stretch = stroke, stretch
        self.s = np.append(0, np.cumsum((self.V[1:] + self.V[:-1]) / 2 * np.diff(self.t)))

    def at(self, t, k):
        """V, F, a, a', s, torque within the row k and the next one."""
        u = t - self.t[k]
        V_t, F_t, T_t = ((v[k + 1] - v[k]) / (self.t[k + 1] - self.t[k]) for v in (self.V, self.F, self.T))
        per = (LENGTHS[1] - LENGTHS[0]) / (LOADS[1] - LOADS[0])
        F = self.F[k] + F_t * u
        a = LENGTHS[0] + per * (F - LOADS[0])
        s = self.s[k] + self.V[k] * u + V_t * u**2 / 2
        return self.V[k] + V_t * u, F, a, per * F_t * self.stretch, s, self.T[k] + T_t * u

    def stroke(self, t, F):
        if self.given is not None:
            return np.interp(t, self.t, self.given)
        p_a, (p_0, A, V_0, n) = 101_325.0, GAS.values()
        return brentq(lambda x: A * ((p_0 + p_a) * (1 - x * A / V_0) ** -n - p_a) - F, 0, 0.45)

    def rates(self, t, k, state, force, torque=None):
        """Of psi, psi', delta, H = I_x delta'; `force` gives F_y, M_z, and the rate of q at the front; `torque` of a damper."""
        psi, psi_t, delta, H = state[:4]
        G, (V, F, a, a_t, s, T) = GEAR, self.at(t, k)
        x_s = self.stroke(t, F)
        l, k_delta = G["l"] - x_s, STIFFNESS[0] + (STIFFNESS[1] - STIFFNESS[0]) * x_s / 0.42
        I_x = G["I_x"] - MASS * (G["l"] ** 2 - l**2)
        eta = -(G["e"] * psi + l * delta)
        F_y, M_z, q_t = force(V, F, a, a_t, s, eta, psi)
        torque = -G["k_psi"] * psi - G["c_psi"] * psi_t if torque is None else torque
        yaw = T + torque - G["kappa"] * psi_t / V - G["e"] * F_y - M_z
        bending = -k_delta * delta - G["c"] * H / I_x - l * F_y + F * G["e"] * psi
        return np.array([psi_t, yaw / G["I_z"], H / I_x, bending, q_t])

    def start(self):
        l = GEAR["l"] - self.stroke(0, self.F[0])
        return -GEAR["e"] * RELEASE, l


def leading_point(ground, links=None):
    """By SciPy, from row to row; the state q of the front, and d of the dashpot of links.

    Links at the apex, by forces: K (ell psi - eps) = k eps + k_s (eps - d), d' = k_s (eps - d)/c; rigid ones have d = ell psi.
    """
    times, found = [], []
    eta, _ = ground.start()
    x = np.array([RELEASE, 0, 0, 0, eta + ground.at(0, 0)[2] * RELEASE])
    if links is not None:
        x = np.append(x, links.held(ground, RELEASE))
    for k in range(len(ground.t) - 1):

        def rates(t, x, k=k):
            def force(V, F, a, a_t, s, eta, psi):
                y = x[4] - eta - a * psi
                return SLOPE * F * y / SIGMA, TRAIL * F * y / SIGMA, (V + a_t) * (psi - y / SIGMA)

            torque, more = (None, ()) if links is None else links.torque(ground, t, k, x)
            return np.append(ground.rates(t, k, x, force, torque), more)

        leg = solve_ivp(rates, ground.t[k : k + 2], x, method="LSODA", rtol=1e-10, atol=1e-15, dense_output=True)
        grid = np.linspace(*ground.t[k : k + 2], 50)
        times, found, x = [*times, *grid], [*found, *leg.sol(grid).T], leg.y[:, -1]
    return np.array(times), np.array(found)[:, :3:2].T


class Links:
    """Two torque links with spring and damper at their apex, whose reach ell follows the stroke."""

    L, GAMMA, SPRING, DAMPING = 0.6, 0.5, 2.5e6, 6e3

    def __init__(self, front=None, series=None):
        self.K, self.k_s = front, series

    def reach(self, ground, t, k):
        x_s = ground.stroke(t, ground.at(t, k)[1])
        return np.sqrt(self.L**2 - (self.L * np.cos(self.GAMMA) - x_s / 2) ** 2)

    def held(self, ground, psi):
        """d where the chain stands at rest: nothing but the spring carries."""
        return () if self.K is None else (self.K * self.reach(ground, 0, 0) * psi / (self.K + self.SPRING),)

    def torque(self, ground, t, k, x):
        ell, h = self.reach(ground, t, k), 1e-6
        if self.K is None:  # the rate of the reach by a difference within the row
            a, b = max(t - h, ground.t[k]), min(t + h, ground.t[k + 1])
            ell_t = (self.reach(ground, b, k) - self.reach(ground, a, k)) / (b - a)
            return -ell * (self.SPRING * ell * x[0] + self.DAMPING * (ell * x[1] + ell_t * x[0])), ()
        eps = (self.K * ell * x[0] + self.k_s * x[5]) / (self.K + self.SPRING + self.k_s)
        return -ell * self.K * (ell * x[0] - eps), (self.k_s * (eps - x[5]) / self.DAMPING,)

    def block(self, geometry):
        compliance = "rigid" if self.K is None else {"link": self.K, "damper": self.k_s}
        return {"topology": "boeing", "geometry": geometry, "compliance": compliance}


def memory(ground, h=1e-4):
    """By Heun's method with the path on the ground kept; psi and delta at every step."""
    (eta, _), a = ground.start(), ground.at(0, 0)[2]
    X = list(np.linspace(-a, a, 60))
    q = [eta + place * RELEASE for place in X]
    x, times, found = np.array([RELEASE, 0, 0, 0, q[-1]]), [0.0], [[RELEASE, 0.0]]
    w = np.polynomial.legendre.leggauss(12)

    def rates(t, k, x):
        def force(V, F, a, a_t, s, eta, psi):
            recent = slice(-int(2 * 0.15 / (20 * h)) - 80, None)
            laid = np.interp(s + a * np.append(w[0], -1), [*X[recent], s + a], [*q[recent], x[4]])
            v = laid - eta - a * np.append(w[0], -1) * psi
            v1, v2 = x[4] - eta - a * psi, v[-1]
            c_F = SLOPE * F / (2 * (a + SIGMA) ** 2)
            c_M = TRAIL * F / (2 * a * (SIGMA * (a + SIGMA) + a**2 / 3))
            F_y = c_F * (a * (w[1] @ v[:-1]) + SIGMA * (v1 + v2))
            M_z = -c_M * (a**2 * (w[1] * w[0]) @ v[:-1] + SIGMA * (a + SIGMA) * (v1 - v2))
            return F_y, M_z, (V + a_t) * (psi - v1 / SIGMA)

        return ground.rates(t, k, x, force)

    for k in range(len(ground.t) - 1):
        for t in np.arange(ground.t[k], ground.t[k + 1] - h / 2, h):
            one = rates(t, k, x)
            other = rates(t + h, k, x + h * one)
            x = x + h / 2 * (one + other)
            *_, a, _, s, _ = ground.at(t + h, k)
            X.append(s + a)
            q.append(x[4])
            times.append(t + h)
            found.append([x[0], x[2]])
    return np.array(times), np.array(found).T


def error(motion, times, found):
    """Largest difference of yaw and of bending over the largest of each."""
    names = (("yaw_angle", "yaw_rate"), ("bending_angle", "bending_rate"))
    own = [CubicHermiteSpline(motion.time, motion[name], motion[rate])(times) for name, rate in names]
    return max(np.abs(mine - theirs).max() / np.abs(theirs).max() for mine, theirs in zip(own, found, strict=True))


STROKES = (0.1, 0.3, 0.25, 0.18, 0.3)


@pytest.fixture(scope="module")
def rolls():
    """Motions of others: by contact line, with the stroke in balance and with a history of its own."""
    return {
        ("leading_point", None): leading_point(Ground()),
        ("leading_point", STROKES): leading_point(Ground(STROKES)),
        ("memory", None): memory(Ground()),
    }


@pytest.mark.parametrize(("contact", "stroke"), [("leading_point", None), ("leading_point", STROKES), ("memory", None)])
@pytest.mark.parametrize("engine", ["cvodes", "exact"])
def test_against_other_equations(rolls, contact, stroke, engine):
    study = study_of(contact)
    motion = simulate_along(study, history=history(stroke), disturbance={"release": {"yaw_angle": RELEASE}}, engine=engine)
    assert motion.status == "completed"
    # Heun's steps and straight lines between points of the path leave 6e-5, a quarter of it with half the step; SciPy 1e-8
    assert error(motion, *rolls[contact, stroke]) < (2e-4 if contact == "memory" else 1e-6)
    assert motion["strut_stroke"][0] == pytest.approx(STROKES[0] if stroke else Ground().stroke(0, ROWS[0][2]))


LENGTHS_OF_ALL = {"lug_distance": {"min": 0.1, "max": 2}, "reach": {"min": 0.1, "max": 0.6}}


@pytest.mark.parametrize(
    ("geometry", "links"),
    [("planar", Links()), ("spatial", Links()), ("planar", Links(8e6, 2e7)), ("spatial", Links(8e6, 2e7))],
)
def test_links_follow_the_stroke_with_its_rate(geometry, links):
    """Levers that grow with the stroke: at a yaw angle that stands still, the strut alone moves the damper."""
    data = study_of("leading_point").model_dump(exclude_none=True) | {"damper": links.block(geometry)}
    data["requirements"] = {"stability_margin": 0.0, "limit_torque": 1e4, **LENGTHS_OF_ALL}
    data["design"] = {"c_lambda": links.DAMPING, "k_lambda": links.SPRING, "L": links.L, "gamma": links.GAMMA}
    study = damperopt.Study.model_validate(data)
    ground = Ground(STROKES)
    motion = simulate_along(study, history=history(STROKES), disturbance={"release": {"yaw_angle": RELEASE}}, engine="exact")
    assert error(motion, *leading_point(ground, links)) < 1e-6


def test_what_the_rates_of_load_and_stroke_add_is_seen():
    """A footprint whose growth were left out, or a stroke that stands still, would miss by a hundred times more."""
    motion = simulate_along(
        study_of("leading_point"), history=history(), disturbance={"release": {"yaw_angle": RELEASE}}, engine="cvodes"
    )
    for wrong in (Ground(stretch=False), Ground((0.2,) * len(ROWS))):
        assert error(motion, *leading_point(wrong)) > 5e-3


@pytest.mark.parametrize("engine", ["cvodes", "idas", "exact"])
def test_a_history_that_stands_still_is_the_constant_motion(engine):
    study, release = study_of("memory"), {"release": {"yaw_angle": 0.02}}
    rows = [{"time": t, "speed": 40.0, "load": 90e3} for t in (2.0, 2.07, 2.25)]
    along = simulate_along(study, history=History(moments=rows), disturbance=release, engine=engine)
    asked = {"speed": 40.0, "load": 90e3, "disturbance": release, "duration": 0.25}
    exact = engine == "exact"
    still = damperopt.simulate_exactly(study, **asked) if exact else damperopt.simulate(study, **asked, engine=engine)
    assert error(along, still.time + 2.0, (still["yaw_angle"], still["bending_angle"])) < 1e-6
    assert along["speed"] == pytest.approx(40.0)
    assert damperopt.linear_gear(study).abscissa(40.0, 90e3)[0] == pytest.approx(
        frozen_along(study, None, History(moments=rows)).abscissa[5]
    )


def test_an_unbalance_turns_with_the_path():
    """Yaw torque m Omega^2 sin(phi), Omega = V/R_w, phi' = Omega: the angle is that of the path, not V t/R_w."""
    rows = [{"time": t, "speed": V, "load": 90e3} for t, V in ((0.0, 60.0), (0.1, 20.0), (0.2, 50.0))]
    driven = {"unbalance": {"moment": 0.01}}
    motion = simulate_along(study_of("leading_point"), history=History(moments=rows), disturbance=driven, engine="cvodes")
    t, V = motion.time, motion["speed"]
    path = np.where(t < 0.1, 60 * t - 200 * t**2, 4.0 + 20 * (t - 0.1) + 150 * (t - 0.1) ** 2)
    expected = 0.01 * (V / 0.36) ** 2 * np.sin(path / 0.36)
    np.testing.assert_allclose(motion["external_torque"], expected, atol=1e-9 * np.abs(expected).max())

"""Gains over speed: closed loops written out by hand, Riccati's equation by SciPy, proofs to both sides of the true margin."""

from __future__ import annotations

import math
from types import SimpleNamespace

import memory_twin
import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.linalg import solve_continuous_are, solve_continuous_lyapunov
from scipy.optimize import minimize
from table_gear import CARCASS, eigenvalues, table_gear

from damperopt import CertificateError, ConfigError, certify, loads, optimise, simulate, simulate_exactly
from damperopt.proof.yaw import YawGear
from damperopt.stability.gain_schedule import gain_schedule
from damperopt.stability.linear import linear_gear
from damperopt.study.passive_rest import passive_rest

F_Z, TAU = 150e3, 4e-3
GAINS = {
    "yaw_angle": {"constant": -2e4, "linear": 350.0},
    "yaw_rate": {"constant": 900.0, "linear": -11.0, "quadratic": 0.06},
    "bending_rate": {"linear": 25.0, "cubic": -1e-3},
}
ORDER = ("yaw_angle", "yaw_rate", "bending_angle", "bending_rate", "string_deflection")


def powers(gain):
    return [gain.get(name, 0.0) for name in ("constant", "linear", "quadratic", "cubic")]


def K_of(V, gains=GAINS):
    return np.array([np.polyval(powers(gains.get(name, {}))[::-1], V) for name in ORDER])


def open_loop(V):
    """Table 0.1 with its moment-driven tyre and a straight tangent: states as `ORDER`."""
    I_z, I_x, e, l_g, a, sigma = 100.0, 600.0, 0.12, 2.5, 0.1, 0.3
    F, M = 7 * 0.002 * F_Z / sigma, 1.0 * F_Z / sigma  # per metre of deflection
    A = np.zeros((5, 5))
    A[0, 1] = A[2, 3] = 1
    A[1] = np.array([-3.8e5, -300.0 - 570.0 / V, 0, 0, -(e * F + M)]) / I_z
    A[3] = np.array([F_Z * e, 0, -6.1e6, -300.0, -l_g * F]) / I_x
    A[4] = [V, e - a, 0, l_g, -V / sigma]
    return A, np.array([0, 1 / I_z, 0, 0, 0])


def closed_loop(V, gains=GAINS, tau=TAU):
    """tau u' = -K x - u, u on the yaw rate."""
    A, b = open_loop(V)
    whole = np.zeros((6, 6))
    whole[:5, :5], whole[:5, 5] = A, b
    whole[5] = np.append(-K_of(V, gains), -1) / tau
    return whole


def controlled(study, gains=GAINS, **control):
    return study.replace(damper__control={"gains": gains, **control})


def test_closed_loop_is_the_one_by_hand():
    study = controlled(table_gear(), lag=TAU)
    gear = linear_gear(study)
    assert gear.state_names == (*ORDER, "actuator_torque")
    for V in (5.0, 31.0, 140.0):
        found, expected = np.linalg.eigvals(gear.matrices(V, F_Z)[0]), np.linalg.eigvals(closed_loop(V))
        np.testing.assert_allclose(np.sort_complex(found), np.sort_complex(expected), rtol=1e-9)


def test_certificate_meets_the_true_margin():
    """The worst abscissa over 1500 speeds, by hand: a margin just below it is proved, one just above it is not."""
    study = controlled(table_gear(), lag=TAU).replace(envelope__speed__max=60.0)
    worst = max(np.linalg.eigvals(closed_loop(V)).real.max() for V in np.geomspace(5, 60, 1500))
    assert worst < 0
    assert certify(study, {}, -worst * (1 - 1e-4)).proved
    refuted = certify(study, {}, -worst * (1 + 1e-4))
    assert refuted.verdict == "refuted"
    V, _ = refuted.counterexample
    assert np.linalg.eigvals(closed_loop(V)).real.max() > worst * (1 + 1.1e-4)


def test_certificate_with_memory():
    """Roots of the characteristic function by hand, in which the lagging gains stand beside stiffness and damping."""
    gains = {name: GAINS[name] for name in ("yaw_angle", "yaw_rate")}
    passive = loads(memory_twin.study_text(memory_twin.gear(memory_twin.S), high=60.0))
    study = controlled(passive, gains, lag=TAU)
    gear, p = linear_gear(study), memory_twin.gear(memory_twin.S)
    speeds = np.geomspace(5, 60, 600)
    roots = gear.roots(speeds, F_Z, 1)[:, 0]
    worst = roots.real.max()
    for V, root in zip(speeds[::20], roots[::20], strict=True):
        K = K_of(V, gains)

        def D(l, V=V, K=K):
            lag = 1 + TAU * l
            own = SimpleNamespace(**{**vars(p), "k_psi": p.k_psi + K[0] / lag, "c_psi": p.c_psi + K[1] / lag})
            return memory_twin.characteristic(l, V, F_Z, own)

        step = 1e-5 * abs(root)
        newton = D(root) / ((D(root + step) - D(root - step)) / (2 * step))
        assert abs(newton) < 1e-7 * abs(root)  # the derivative by differences leaves parts of 1e-10 of it
    assert worst < 0
    assert certify(study, {}, 0.98 * -worst).proved
    assert certify(study, {}, 1.02 * -worst).verdict == "refuted"


def test_riccati():
    """models.md D: K for Q = diag(1e6, 0, 1e2, 0, 0) on (psi, delta, psi', delta', y), R 1e-3 at 40 m/s."""
    study = table_gear().replace(envelope__speed={"min": 40.0, "max": 40.0})
    sizes, torque = {"yaw_angle": 1e-3, "yaw_rate": 0.1}, 1e-3**-0.5
    found = gain_schedule(study, sizes, torque, degree=0)
    printed = {"yaw_angle": 10290.149, "bending_angle": 146966.593, "yaw_rate": 1144.532575}
    printed |= {"bending_rate": -800.8499, "string_deflection": -32184.0751}
    A, b = open_loop(40.0)
    P = solve_continuous_are(A, b[:, None], np.diag([1e6, 1e2, 0, 0, 0]), [[1e-3]])
    np.testing.assert_allclose(found.gains[0], b @ P / 1e-3, rtol=1e-8)
    assert dict(zip(found.states, found.gains[0], strict=True)) == pytest.approx(printed, rel=1e-7)
    roots = eigenvalues(controlled(study, found.block), 40.0)
    np.testing.assert_allclose(roots, [-0.281493 + 100.871j, -3.4614 + 70.7765j, -140.935], rtol=1e-5)
    passive = eigenvalues(table_gear(damping=1444.5), 40.0)[1]
    assert passive == pytest.approx(-3.2105 + 70.5688j, rel=1e-5)  # the gain on the yaw rate alone, as a damper


def test_gains_of_what_is_measured():
    """Of all gains on these two states those of least cost, by a search that knows the cost alone."""
    study, measured = table_gear(), ("yaw_rate", "bending_rate")
    V = 30.0
    found = gain_schedule(
        study.replace(envelope__speed={"min": V, "max": V}), {"yaw_angle": 0.01}, 3e3, measured=measured, degree=0
    )
    A, b = open_loop(V)
    rows = [ORDER.index(name) for name in measured]

    def cost(k):
        row = np.zeros(5)
        row[rows] = np.array(k) * 1e3
        closed = A - np.outer(b, row)
        if np.linalg.eigvals(closed).real.max() >= 0:
            return 1e9
        Q = np.outer(row, row) / 3e3**2 + np.diag([1e4, 0, 0, 0, 0])
        return 1e6 * (b @ solve_continuous_lyapunov(closed.T, -Q) @ b)

    best = minimize(cost, [2.0, 0.0], method="Nelder-Mead", options={"xatol": 1e-8, "fatol": 1e-12, "maxiter": 4000})
    np.testing.assert_allclose(found.gains[0], np.array(best.x) * 1e3, rtol=1e-4)
    assert cost(found.gains[0] / 1e3) <= best.fun * (1 + 1e-9)


def test_fit_over_speed():
    study = table_gear().replace(envelope__speed__max=100.0)
    found = gain_schedule(study, {"yaw_rate": 0.1}, 500.0, measured=["yaw_rate"], degree=3)
    fit = np.polynomial.Polynomial.fit(found.speeds, found.gains[:, 0], 3).convert().coef
    np.testing.assert_allclose(found.coefficients[0], fit, rtol=1e-4)
    for keys, words in (
        ({"measured": ["damper_stroke"]}, "no state that can be measured; allowed: yaw_angle"),
        ({"degree": 4}, "degree: found 4; allowed: 0 to 3"),
        ({"torque": -1.0}, "found -1.0 for torque"),
    ):
        with pytest.raises(ConfigError, match=words):
            gain_schedule(study, {"yaw_rate": 0.1}, **{"torque": 1.0, **keys})


def test_skyhook_is_viscous_here():
    """A torque against the rate of the piston is that of a damper between piston and strut: the strut does not yaw."""
    active = linear_gear(controlled(table_gear(), {"yaw_rate": {"constant": 1144.5}}))
    passive = linear_gear(table_gear(damping=1444.5))
    for V in (5.0, 40.0, 120.0):
        np.testing.assert_allclose(active.matrices(V, F_Z), passive.matrices(V, F_Z), rtol=1e-13)


def test_yaw_alone_does_not_reach_the_lateral_mode():
    """Measured in yaw, however strong: the lateral mode goes to that of a gear clamped in yaw, by hand."""
    V = 40.0
    A, _ = open_loop(V)
    clamped = np.linalg.eigvals(A[2:, 2:])
    light = clamped[clamped.imag > 0][0]
    gains = {"yaw_angle": {"constant": 1e9}, "yaw_rate": {"constant": 1e7}}
    lateral = eigenvalues(controlled(table_gear(), gains), V)[0]
    assert lateral == pytest.approx(light, rel=1e-3)
    assert lateral.real == pytest.approx(-0.42, abs=0.005)
    # measured in bending it moves, by torques that no actuator has: 17 kN m for 1 mrad, 2.5 mm at the wheel
    study = table_gear().replace(envelope__speed={"min": V, "max": V})
    found = gain_schedule(study, {"bending_rate": 1e-4}, 30.0, degree=0)
    reached = eigenvalues(controlled(study, found.block), V)
    assert max(root.real for root in reached) == pytest.approx(-6.4, abs=0.1)
    assert abs(found.gains[0][ORDER.index("bending_angle")]) == pytest.approx(1.7e7, rel=0.05)


def test_saturation_is_simulated():
    """Small motions are the linear ones; beyond the limit the unstable gear runs away, in exact and in smooth motion alike."""
    gains = {"yaw_rate": {"constant": 2000.0}}
    study = controlled(table_gear(), gains, lag=TAU, limit=500.0)
    assert certify(study, {}).proved
    small = simulate_exactly(study, speed=40.0, disturbance={"kick": {"yaw_rate": 0.1}}, duration=0.6, points=301)
    assert np.abs(small["yaw_angle"][-50:]).max() < 0.5 * np.abs(small["yaw_angle"]).max()
    large = {"kick": {"yaw_rate": 6.0}}
    exact = simulate_exactly(study, speed=40.0, disturbance=large, duration=0.6, points=301)
    assert np.abs(exact["actuator_torque"]).max() <= 500.0 * (1 + 1e-12)  # rounding between output times
    assert np.abs(exact["yaw_angle"][-50:]).max() > np.abs(exact["yaw_angle"][:50]).max()
    rounded = study.replace(damper__control__smoothing=1e-4)
    smooth = simulate(rounded, speed=40.0, disturbance=large, duration=0.6)
    between = CubicSpline(smooth.time, smooth["yaw_angle"])(exact.time)
    np.testing.assert_allclose(between, exact["yaw_angle"], rtol=0, atol=1e-5)


def test_release_begins_with_the_torque_that_holds():
    """The actuator has had time to answer the angle from which the gear is let go."""
    study = controlled(table_gear(), {"yaw_angle": {"constant": 5e4}}, lag=TAU)
    motion = simulate_exactly(study, speed=40.0, disturbance={"release": {"yaw_angle": 0.01}}, duration=0.01, points=11)
    assert motion["actuator_torque"][0] == pytest.approx(-500.0)


@pytest.fixture(scope="module")
def nose():
    """A boeing layout whose mass hangs on its damping, by a short room for the spring."""
    base = table_gear(tyre=CARCASS).model_dump(exclude_none=True)
    base["damper"] = {"topology": "boeing", "geometry": "planar", "compliance": "rigid"}
    base["envelope"] = {"speed": {"min": 10.0, "max": 60.0}, "vertical_load": F_Z}
    bounds = {"c_lambda": (1e2, 3e3, 1e7), "k_lambda": (1e5, 3e6, 1e8), "L": (0.2, 0.6, 1.5), "gamma": (0.1, 0.5, 1.4)}
    base["design"] = {k: dict(zip(("min", "start", "max"), v, strict=True)) for k, v in bounds.items()}
    base["requirements"] = {
        "stability_margin": 3.0,
        "limit_torque": 1.2e4,
        "lug_distance": {"min": 0.4, "max": 1.1},
        "reach": {"min": 0.1, "max": 0.4},
    }
    base["solver"] = {"starts": 1, "verification_speeds": 50, "bound_seconds": 0}
    return type(table_gear()).model_validate(base)


def test_fail_safe_decides_what_control_leaves(nose):
    """With strong gains the damper is as light as one that keeps the fail-safe margin alone, and both are proved."""
    gains = {"yaw_rate": {"constant": 3000.0}}
    active = optimise(controlled(nose, gains, lag=TAU, mass=1.0).replace(requirements__fail_safe_margin=1.0))
    alone = optimise(nose.replace(requirements__stability_margin=1.0))
    assert active.status == alone.status == "solved", (active.message, alone.message)
    assert active.mass.parts["actuator"] == 1.0
    assert active.mass.total - 1.0 == pytest.approx(alone.mass.total, rel=1e-6)
    assert (active.certificate.margin, active.fail_safe.margin) == (3.0, 1.0)
    assert active.certificate.proved
    assert active.fail_safe.proved
    by_name = {c.name: c for c in active.constraints}
    assert by_name["fail_safe_margin"].active
    assert not by_name["stability_margin"].active
    h = 1e-3
    more = optimise(nose.replace(requirements__stability_margin=1.0 + h)).mass.total
    price = -by_name["fail_safe_margin"].shadow_price  # kg per 1/s of margin: the limit is minus the margin
    assert abs(price) == pytest.approx((more - alone.mass.total) / h, rel=0.02)


def test_no_bound_of_a_gear_without_its_actuator(nose):
    """A bound on the mass that knows the passive gear alone would be wrong with an actuator: there is none."""
    with pytest.raises(CertificateError, match="an actuator acts beside the damper"):
        YawGear(controlled(nose))


def test_both_margins_where_control_does_harm(nose):
    """Gains that take damping away: the margin with the actuator decides, and the design carries them."""
    bad = controlled(nose, {"yaw_rate": {"constant": -400.0}}).replace(
        requirements__stability_margin=1.0, requirements__fail_safe_margin=0.5
    )
    found = optimise(bad)
    assert found.status == "solved", found.message
    c_psi = found.derived["torsional_damping"]
    alone = optimise(nose.replace(requirements__stability_margin=1.0))
    assert c_psi - 400.0 == pytest.approx(alone.derived["torsional_damping"], rel=0.05)
    rest = passive_rest(bad)
    assert certify(rest, found.design).proved
    assert not certify(bad, alone.design).proved


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"damper__control": {"gains": {"yaw": {"constant": 1.0}}}}, "damper.control.gains.yaw: no state that can be measured"),
        ({"damper__control": {"gains": {}}}, "damper.control.gains"),
        ({"damper__control": {"gains": {"yaw_rate": {"quartic": 1.0}}}}, "damper.control.gains.yaw_rate.quartic: unknown key"),
        (
            {"damper__control": {"gains": {"yaw_rate": {"constant": 1.0}}, "lag": -1.0}},
            "damper.control.lag",
        ),
    ],
)
def test_bad_blocks(changes, words):
    with pytest.raises(ConfigError, match=words):
        table_gear().replace(**changes)


def test_nothing_to_fail(nose):
    with pytest.raises(ConfigError, match="fail_safe_margin: nothing to fail"):
        nose.replace(requirements__fail_safe_margin=0.1)
    with pytest.raises(ConfigError, match=r"string_deflection: no state that can be measured"):
        controlled(nose.replace(tyre__contact="memory"), {"string_deflection": {"constant": 1.0}})
    assert math.isclose(controlled(nose).fail_safe_margin, 0.0)

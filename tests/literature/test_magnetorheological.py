"""Magnetorheological dampers: closed forms of sticking, hysteresis against Dahl's, the lag, and what proofs have of them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from components_of import damper_block, damper_of
from scipy.integrate import solve_ivp
from table_gear import TYRE, table_gear

from damperopt import ConfigError, Study, simulate, simulate_exactly
from damperopt.dampers.base import Context
from damperopt.expressions.corners import Switched
from damperopt.stability.linear import linear_gear
from damperopt.study.scope import covers

NONE = {**TYRE, "cornering_slope": 0.0, "aligning_coefficient": 0.0, "tread_width_moment": 0.0}
ELL, K_LAMBDA = 0.3, 1e6
DESIGN = {"c_lambda": 1e-3, "k_lambda": K_LAMBDA, "L": 0.6, "gamma": math.asin(ELL / 0.6)}


def gear(tyre=NONE, design=None, kind="magnetorheological", **damper):
    base = table_gear(tyre=tyre, kind="yaw").model_dump(exclude_none=True)
    base["gear"] = {"kind": "yaw", "yaw_inertia": 100.0, "caster_length": 0.12, "wheel_radius": 0.362}
    required = {
        "stability_margin": 0.1,
        "limit_torque": 1e4,
        "lug_distance": {"min": 0.4, "max": 1.2},
        "reach": {"min": 0.1, "max": 0.4},
    }
    bounds = {name: {"start": value, "min": value / 2, "max": 1.5 * value} for name, value in (DESIGN | (design or {})).items()}
    block = damper_block("boeing", kind=kind, yield_per_ampere=1e3, **damper)
    return Study.model_validate(base | {"damper": block, "design": bounds, "requirements": required})


RELEASE = {"release": {"yaw_angle": 0.002}}


def test_yield_force_sticks_on_a_linkage():
    """Small angles: half cycles about +-f/(k ell), as with dry friction of the torque f ell; then it rests."""
    force = 80.0
    found = simulate_exactly(gear(idle_current=0.08), speed=30.0, disturbance=RELEASE, duration=1.0, points=401)
    shift, k = force * ELL / (K_LAMBDA * ELL**2), K_LAMBDA * ELL**2
    omega = math.sqrt(k / 100.0)
    angle, expected = 0.002, []
    for t in found.time:
        turns = int(t * omega / math.pi)
        amplitude = 0.002 - shift * (2 * turns + 1)
        past = next((n for n in range(turns + 1) if abs(0.002 - 2 * n * shift) <= shift), None)
        side = (-1) ** turns
        expected.append(
            (-1) ** past * (0.002 - 2 * past * shift) if past is not None else side * shift + amplitude * math.cos(omega * t)
        )
    # the sine of 0.002 rad in lever and spring: parts of 1e-6 in a cycle
    np.testing.assert_allclose(found["yaw_angle"], expected, rtol=0, atol=5e-6 * angle)
    assert found["yaw_rate"][-1] == 0.0


def test_yield_in_series_with_elastic_links():
    """Below the yield force the links alone give way; the smooth version goes to the exact one."""
    study = gear(design={"c_lambda": 1e4}, idle_current=0.3, link_stiffness=5e6, smoothing=1e-5)
    exact = simulate_exactly(study, speed=30.0, disturbance=RELEASE, duration=0.3, points=101)
    smooth = simulate(study, speed=30.0, disturbance=RELEASE, duration=0.3)
    error = np.interp(exact.time, smooth.time, smooth["yaw_angle"]) - exact["yaw_angle"]
    assert np.abs(error).max() < 1e-3 * 0.002
    assert np.ptp(exact["damper_stroke"]) > 0


def test_hysteresis_with_one_shape_is_dahls():
    """beta 1, n 1: F' = f/x_y v (1 - F sign(v)/f), whose loop has a closed form."""
    damper = damper_of(
        topology="boeing", kind="bouc_wen", yield_per_ampere=100.0, idle_current=2.0, knee=1e-3, sharpness=1, unloading=1.0
    )
    dahl = damper_of(
        topology="rotational", torsional_stiffness=0.0, kind="dahl", breakout_torque=200.0, presliding_stiffness=2e5
    )
    stiffness, damping = loop(damper, 2e-3, 70.0)
    expected = dahl.equivalent({}, 2e-3, 70.0, Context())
    assert stiffness == pytest.approx(expected[0], rel=1e-4)
    assert damping == pytest.approx(expected[1], rel=1e-4)


def test_hysteresis_of_small_and_large_strokes():
    """Small: the spring f/x_y. Large: dry friction f."""
    damper = damper_of(topology="boeing", kind="bouc_wen", yield_per_ampere=100.0, idle_current=2.0, knee=1e-3)
    assert loop(damper, 1e-6, 70.0)[0] == pytest.approx(2e5, rel=1e-3)
    assert loop(damper, 1.0, 70.0)[1] == pytest.approx(4 * 200 / (math.pi * 70.0), rel=1e-2)


def loop(damper, amplitude, omega):
    """First harmonic of the force along a sinusoid, here integrated."""

    def force(t, z):
        x, v = amplitude * math.sin(omega * t), amplitude * omega * math.cos(omega * t)
        states = {"control_current": 0.0, "hysteresis": float(z)}
        return damper.force({"c_lambda": 0.0}, states, x, v, Context(), Switched())

    def rates(t, z):
        return [force(t, z[0]).rates["hysteresis"]]

    period, z = 2 * math.pi / omega, 0.0
    for _ in range(4):
        z = solve_ivp(rates, (0, period), [z], rtol=1e-8, atol=1e-10, max_step=period / 200).y[0, -1]
    times = period * (np.arange(2000) + 0.5) / 2000
    zs = solve_ivp(rates, (0, period), [z], rtol=1e-8, atol=1e-10, max_step=period / 200, t_eval=times).y[0]
    forces = np.array([force(t, z).force for t, z in zip(times, zs, strict=True)])
    sine, cosine = (2 * np.mean(forces * f(omega * times)) for f in (np.sin, np.cos))
    return sine / amplitude, cosine / (amplitude * omega)


def test_current_follows_the_rate_with_its_lag():
    """A stroke of constant rate: i = i_1 v^2/(v^2 + v_1^2) (1 - exp(-t/tau))."""
    damper = damper_of(
        topology="boeing",
        kind="magnetorheological",
        yield_per_ampere=1e3,
        control_current=2.0,
        control_rate=0.1,
        response_time=0.02,
    )

    def rates(t, i):
        made = damper.force({"c_lambda": 0.0}, {"control_current": i[0]}, 0.2 * t, 0.2, Context(), Switched())
        return [made.rates["control_current"]]

    found = solve_ivp(rates, (0, 0.05), [0.0], rtol=1e-10, atol=1e-12).y[0, -1]
    assert found == pytest.approx(2.0 * 0.8 * (1 - math.exp(-2.5)), rel=1e-8)
    assert damper.peak_force({"c_lambda": 10.0}, 1.0) == pytest.approx(10.0 + 2e3)
    assert damper.equivalent({"c_lambda": 10.0}, 1e-3, 70.0, Context()) is None


def test_a_proof_has_the_damper_without_current():
    """However large the currents, the linear model is that of the viscous part."""
    on, off = (gear(TYRE, {"c_lambda": 5e3}, **keys) for keys in ({"idle_current": 2.0, "control_current": 3.0}, {}))
    A, B = (linear_gear(study).matrices(40.0, 150e3)[0] for study in (on, off))
    np.testing.assert_array_equal(A, B)
    viscous = linear_gear(table_gear(K_LAMBDA * ELL**2, 5e3 * ELL**2, kind="yaw")).matrices(40.0, 150e3)[0]
    found, expected = np.linalg.eigvals(A), np.linalg.eigvals(viscous)
    assert all(np.abs(found - value).min() < 1e-8 * abs(value) for value in expected)


def test_hysteresis_is_a_spring_in_the_linear_model():
    study = gear(TYRE, {"c_lambda": 5e3}, kind="bouc_wen", idle_current=0.5, knee=1e-3)
    found = np.linalg.eigvals(linear_gear(study).matrices(40.0, 150e3)[0])
    expected = np.linalg.eigvals(
        linear_gear(table_gear((K_LAMBDA + 500.0 / 1e-3) * ELL**2, 5e3 * ELL**2, kind="yaw")).matrices(40.0, 150e3)[0]
    )
    assert all(np.abs(found - value).min() < 1e-8 * abs(value) for value in expected)


def test_fail_safe_gear_shimmies_and_a_current_holds_it():
    """Too little viscous damping: without current it grows; a current by the rate keeps it small."""
    keys = {"response_time": 0.01, "control_rate": 0.02}
    tyre = {
        **TYRE,
        "cornering_slope": 0.014,
        "law": "arctangent",
        "cornering_coefficient": 0.002,
        "aligning_slip_limit": 0.1745,
    }
    tyre.pop("cornering_slope")

    def last(current):
        study = gear(tyre, {"c_lambda": 2e3}, control_current=current, **keys)
        motion = simulate(study, speed=40.0, disturbance={"release": {"yaw_angle": 0.01}}, duration=2.0)
        return np.abs(motion["yaw_angle"][-300:]).max()

    assert last(0.0) > 0.05
    assert last(5.0) < 0.02


JOINTS = {
    "spatial": {"geometry": "spatial"},
    "freeplay": {"freeplay": {"gap": 2e-4}},
    "spatial with freeplay": {"geometry": "spatial", "freeplay": {"gap": 2e-4}},
    "freeplay and links": {"freeplay": {"gap": 2e-4}, "link_stiffness": 5e6},
    "spatial with links": {"geometry": "spatial", "link_stiffness": 5e6},
}


@pytest.mark.parametrize("joints", JOINTS)
@pytest.mark.parametrize("current", [0.08, 0.8])
def test_smooth_version_goes_to_the_exact_one_with_joints(joints, current):
    """Where it sticks, slides, and in a gap does neither."""
    study = gear(design={"c_lambda": 500.0}, idle_current=current, smoothing=1e-5, **JOINTS[joints])
    question = {"speed": 30.0, "disturbance": {"release": {"yaw_angle": 0.01}}, "duration": 0.4}
    exact, smooth = simulate_exactly(study, points=201, **question), simulate(study, **question)
    assert exact.status == smooth.status == "completed"
    error = np.interp(exact.time, smooth.time, smooth["yaw_angle"]) - exact["yaw_angle"]
    assert np.abs(error).max() < 2e-3 * 0.01


K_ANGLE, K_RATE = 2e3, 3e3
LAW = {"gains": {"yaw_angle": {"constant": K_ANGLE}, "yaw_rate": {"constant": K_RATE}}}


def clipped_motion(hysteresis: bool, start: list[float], duration: float):
    """I psi'' = -k ell^2 sin cos - F ell cos with the clipped-optimal current, written out and given to SciPy."""
    c, f_1, i_1, tau, band, knee = 500.0, 1e3, 2.0, 0.01, 50.0, 2e-3

    def clip(x, low, high):
        return min(max(x, low), high)

    def rates(t, x):
        psi, w, i = x[:3]
        lever = ELL * math.cos(psi)
        v = lever * w
        z = x[3] if hysteresis else math.tanh(v / 1e-6)
        F, wanted = c * v + f_1 * i * z, (K_ANGLE * psi + K_RATE * w) / ELL
        share = clip((wanted * clip(F / band, -1, 1) - abs(F)) / band, 0, 1)
        found = [w, -(K_LAMBDA * ELL * math.sin(psi) + F) * lever / 100.0, (i_1 * share - i) / tau]
        return [*found, (v - 0.5 * abs(v) * z * abs(z) - 0.5 * v * z * z) / knee] if hysteresis else found

    method = "DOP853" if hysteresis else "LSODA"
    return solve_ivp(rates, (0, duration), start, method, rtol=1e-9, atol=1e-12, max_step=1e-3, dense_output=True).sol


@pytest.mark.parametrize(("kind", "own"), [("magnetorheological", {"smoothing": 1e-5}), ("bouc_wen", {"knee": 2e-3})])
def test_clipped_optimal_current(kind, own):
    """Against equations of this file: exact, and smooth as far as its corners are rounded; of the proof it is no part."""
    study = gear(kind=kind, design={"c_lambda": 500.0}, control_current=2.0, response_time=0.01, control=LAW, **own)
    kick = {"kick": {"yaw_rate": 2.0}}
    theirs = clipped_motion(kind == "bouc_wen", [0.0, 2.0, 0.0] + [0.0] * (kind == "bouc_wen"), 0.5)
    for run, yaw, current in ((simulate_exactly, 1e-6, 1e-4), (simulate, 2e-3, 0.02)):
        motion = run(study, speed=30.0, disturbance=kick, duration=0.5)
        expected = theirs(motion.time)
        assert np.abs(motion["yaw_angle"] - expected[0]).max() < yaw * np.abs(expected[0]).max()
        assert np.abs(motion["control_current"] - expected[2]).max() < current
        assert motion["control_current"].max() > 1.9
    without = study.without_control()
    for V in (10.0, 40.0):
        np.testing.assert_array_equal(linear_gear(study).matrices(V, 150e3), linear_gear(without).matrices(V, 150e3))
    words = " ".join(covers(study))
    assert "commands a current, which the certificate does not hold" in words


def test_what_a_law_commands():
    study = gear(control_current=2.0, control=LAW)
    for key, value, words in (
        ("damper__control__lag", 0.01, "damper.control.lag: a lag of an actuator"),
        ("damper__control__limit", 100.0, "damper.control.limit"),
        ("damper__control_current", 0.0, "damper.control_current: no current that the law could command"),
    ):
        with pytest.raises(ConfigError, match=words):
            study.replace(**{key: value})

"""Exact simulation: closed forms of motions with corners, energy, and what the smooth version converges to."""

import numpy as np
import pytest
from basic_twin import LAYOUT
from components_of import VARIABLES, damper_block
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import brentq
from tolerances import CONVERGED, ENERGY, EVENT_MOTION, FIRST_ORDER, INTEGRATED

import damperopt
from damperopt.motion.exact import ExactSimulator, simulate_exactly
from damperopt.motion.simulate import Simulator
from damperopt.motion.trajectory import motion_of

SPEED, LOAD, INERTIA = 40.0, 150e3, 100.0
DESIGN = LAYOUT | {"c_lambda": 3.0e3, "k_lambda": 3.8e6, "I_arm": 3.4e-6}
ELL = DESIGN["L"] * np.sin(DESIGN["gamma"])
STIFFNESS = 3.8e5
SILENT = {
    "law": "nonlinear",
    "contact": "leading_point",
    "half_contact_length": 0.1,
    "relaxation_length": 0.3,
    "cornering_coefficient": 0.0,
    "aligning_coefficient": 0.0,
    "aligning_slip_limit": 0.2,
    "slip_range": 1.4,
}
"""A tyre without forces: what is left is the piston on its damper."""


@pytest.fixture
def study(main_gear):
    def change(damper, **changes):
        return main_gear.replace(
            damper=damper, requirements__limit_torque=1e4, **({"gear__order": 3, "tyre": SILENT} | changes)
        )

    return change


@pytest.fixture
def interpreted(monkeypatch):
    """No compilation: it takes longer than these motions."""
    monkeypatch.setattr("damperopt.motion.integrators.has_compiler", lambda: False)


@pytest.fixture(autouse=True)
def impatient(monkeypatch):
    """No motion here has more than some hundred corners: one that goes on chattering at a corner fails soon."""
    monkeypatch.setattr("damperopt.motion.events.MAX_EVENTS", 300)


def design_of(topology, **changes):
    return {name: value for name, value in (DESIGN | changes).items() if name in VARIABLES[topology]}


# -------------------------------------------------------------------------------------------------------- dry friction


def oscillator(study, friction, stiffness=STIFFNESS):
    damper = {"topology": "rotational", "torsional_stiffness": stiffness, "torsional_damping": 0.0}
    return study(damper, gear__friction={"torque": friction})


def coulomb(t, start, friction, stiffness=STIFFNESS):
    """Angle at t of I psi'' = -k psi - T sign(psi'), released from `start` > 0: half cycles about +-T/k, then it sticks."""
    omega, shift = np.sqrt(stiffness / INERTIA), friction / stiffness
    angle = start
    while abs(angle) > shift:
        side = np.sign(angle)
        if t < np.pi / omega:
            return side * shift + (angle - side * shift) * np.cos(omega * t)
        t, angle = t - np.pi / omega, 2 * side * shift - angle
    return angle


@pytest.mark.parametrize("friction", [1e3, 2.3e3, 7e3])
def test_dry_friction_follows_its_closed_form(study, friction):
    """The amplitude falls by 2 T/k in each half cycle, until the spring cannot move it any more."""
    found = simulate_exactly(
        oscillator(study, friction), speed=SPEED, disturbance={"release": {"yaw_angle": 0.1}}, duration=1.2, points=401
    )
    expected = [coulomb(t, 0.1, friction) for t in found.time]
    assert found.status == "completed"
    np.testing.assert_allclose(found["yaw_angle"], expected, rtol=0, atol=0.1 * EVENT_MOTION)
    assert found["yaw_rate"][-1] == 0.0
    assert abs(found["yaw_angle"][-1]) <= friction / STIFFNESS


def test_gear_sticks_at_once_where_friction_exceeds_the_spring(study):
    found = simulate_exactly(
        oscillator(study, 4e4), speed=SPEED, disturbance={"release": {"yaw_angle": 0.1}}, duration=0.2, points=50
    )
    assert (found["yaw_angle"] == 0.1).all()
    assert not found["yaw_rate"].any()


def test_friction_holds_a_step_of_torque_up_to_its_own(study):
    """Below: nothing moves. Above: it swings about (torque - friction)/k, to twice that, and sticks there."""
    held, moved = (
        simulate_exactly(oscillator(study, 1e3), speed=SPEED, disturbance={"step": {"yaw_torque": torque}}, duration=0.5)
        for torque in (999.0, 1500.0)
    )
    assert not held["yaw_angle"].any()
    assert moved["yaw_angle"][-1] == pytest.approx(2 * 500.0 / STIFFNESS, rel=EVENT_MOTION)


def test_stuck_gear_breaks_loose_when_the_unbalance_exceeds_friction(study):
    """m Omega^2 sin(Omega t) = T at asin(T/(m Omega^2))/Omega; before, the angle is zero, after, it is not."""
    omega, moment, friction = SPEED / 0.362, 0.1, 800.0
    start = np.arcsin(friction / (moment * omega**2)) / omega
    found = simulate_exactly(
        oscillator(study, friction), speed=SPEED, disturbance={"unbalance": {"moment": moment}}, duration=0.03, points=3001
    )
    assert found.status == "completed"
    first = found.time[np.flatnonzero(found["yaw_angle"])[0]]
    assert first == pytest.approx(start, abs=2 * found.time[1])
    assert first >= start


def test_work_of_friction_is_the_energy_that_is_missing(study):
    """Spring, inertia and T times the path, with the tyre switched off."""
    found = simulate_exactly(
        oscillator(study, 500.0), speed=SPEED, disturbance={"kick": {"yaw_rate": 5.0}}, duration=0.5, points=4001
    )
    psi, rate = found["yaw_angle"], found["yaw_rate"]
    turns = np.flatnonzero(np.sign(rate[:-1]) * np.sign(rate[1:]) < 0)[:4]
    path = np.append(0.0, np.cumsum(abs(np.diff(psi))))
    energy = INERTIA * rate**2 / 2 + STIFFNESS * psi**2 / 2 + 500.0 * path
    # between samples that enclose a turning point the path is longer than the chord, by the square of the step
    missed = len(turns) * 500.0 * 2 * abs(rate[turns] - rate[turns + 1]).max() * found.time[1]
    assert abs(energy - energy[0]).max() < missed


# -------------------------------------------------------------------------------------------------- stops and freeplay


def free_spring(study, topology="boeing", geometry="planar", **joints):
    return study(damper_block(topology, geometry=geometry, **joints))


def boeing_energy(found, gap=0.0, stroke=np.inf, contact=0.0):
    """I psi'^2/2 + k eps^2/2 + k_stop beyond^2/2 of the planar Boeing layout, eps = ell sin(psi beyond the gap)."""
    psi, rate = found["yaw_angle"], found["yaw_rate"]
    rest = np.sign(psi) * np.maximum(abs(psi) - gap / ELL, 0.0)
    eps = ELL * np.sin(rest)
    beyond = np.maximum(abs(eps) - stroke, 0.0)
    return INERTIA * rate**2 / 2 + DESIGN["k_lambda"] * eps**2 / 2 + np.nan_to_num(contact * beyond**2 / 2)


@pytest.mark.parametrize(
    ("joints", "energy"),
    [
        ({"freeplay": {"gap": 0.01}}, {"gap": 0.01}),
        ({"end_stop": {"stroke": 0.01, "stiffness": 3e7}}, {"stroke": 0.01, "contact": 3e7}),
        (
            {"freeplay": {"gap": 0.004}, "end_stop": {"stroke": 0.01, "stiffness": 3e8}},
            {"gap": 0.004, "stroke": 0.01, "contact": 3e8},
        ),
    ],
    ids=["freeplay", "stop", "both"],
)
def test_energy_of_the_undamped_gear_is_constant(study, joints, energy):
    gear = free_spring(study, **joints)
    found = simulate_exactly(
        gear, design_of("boeing", c_lambda=1e-15), speed=SPEED, disturbance={"release": {"yaw_angle": 0.1}}, duration=0.3,
        points=200, tolerance=1e-12,
    )  # fmt: skip
    assert found.status == "completed"
    assert np.ptp(found["yaw_angle"]) > 0.19
    values = boeing_energy(found, **energy)
    np.testing.assert_allclose(values, values[0], rtol=ENERGY)


def test_gear_crosses_a_gap_at_constant_rate(study):
    """Inside the gap nothing acts: the angle is a straight line in time."""
    found = simulate_exactly(
        free_spring(study, freeplay={"gap": 0.02}), design_of("boeing", c_lambda=1e-15), speed=SPEED,
        disturbance={"kick": {"yaw_rate": 1.0}}, duration=0.06, points=61,
    )  # fmt: skip
    np.testing.assert_allclose(found["yaw_angle"], found.time, rtol=0, atol=1e-12)
    np.testing.assert_allclose(found["yaw_rate"], 1.0, rtol=1e-12)


def test_end_stop_follows_its_closed_form(study):
    """Small angles: an arc of the spring up to the contact, an arc about the centre of both springs, and back to zero."""
    contact, rate, k_stop = 5e-7, 2e-4, 3e8  # rad, rad/s, N/m
    gear = free_spring(study, end_stop={"stroke": contact * ELL, "stiffness": k_stop})
    k_1, k_2 = DESIGN["k_lambda"] * ELL**2, (DESIGN["k_lambda"] + k_stop) * ELL**2
    w_1, w_2 = np.sqrt(k_1 / INERTIA), np.sqrt(k_2 / INERTIA)
    until = np.arcsin(contact * w_1 / rate) / w_1
    arrival, centre = rate * np.cos(w_1 * until), k_stop * ELL**2 * contact / k_2
    touching = (np.pi - 2 * np.arctan((contact - centre) * w_2 / arrival)) / w_2
    simulator = ExactSimulator(gear, design_of("boeing", c_lambda=1e-15))
    found = simulator(SPEED, LOAD, {"kick": {"yaw_rate": rate}}, 2 * until + touching, tolerance=1e-13, points=501)
    peak = centre + np.hypot(contact - centre, arrival / w_2)
    assert found["yaw_angle"].max() == pytest.approx(peak, rel=1e-4)  # at the nearest of 501 points
    # then it passes zero with the opposite rate
    assert abs(found["yaw_angle"][-1]) < EVENT_MOTION * peak
    assert found["yaw_rate"][-1] == pytest.approx(-rate, rel=EVENT_MOTION)
    inside = found["stop_force"] > 1e-9 * found["stop_force"].max()
    assert np.ptp(found.time[inside]) == pytest.approx(touching, abs=2.5 * found.time[1])


def test_period_in_a_gap_is_that_of_two_half_cycles_and_two_flights(study):
    """Undamped, small: pi/w for each touch, 2 g/v for each flight between them."""
    gap, rate = 2e-6, 1e-3
    w = np.sqrt(DESIGN["k_lambda"] * ELL**2 / INERTIA)
    period = 2 * np.pi / w + 4 * (gap / ELL) / rate
    found = ExactSimulator(free_spring(study, freeplay={"gap": gap}), design_of("boeing", c_lambda=1e-15))(
        SPEED, LOAD, {"kick": {"yaw_rate": rate}}, 3 * period, tolerance=1e-13, points=301
    )
    assert abs(found["yaw_angle"][[100, 200, 300]]).max() < EVENT_MOTION * found["yaw_angle"].max()


# ------------------------------------------------------------------------------------------- smooth version and exact one

ROUNDED = {
    "freeplay": {"freeplay": {"gap": 0.004}},
    "end stop": {"end_stop": {"stroke": 0.01, "stiffness": 2e7}},
    "orifice": {"orifice": {"coefficient": 3e4}},
    "freeplay, links": {"freeplay": {"gap": 0.004}, "link_stiffness": 2e7},
    "freeplay, rod": {"freeplay": {"gap": 0.004}, "series_stiffness": 2e7},
    "end stop, links": {"end_stop": {"stroke": 0.01, "stiffness": 2e7}, "link_stiffness": 2e7},
    "orifice, rod": {"orifice": {"coefficient": 3e4}, "series_stiffness": 2e7},
    "orifice, links": {"orifice": {"coefficient": 3e4}, "link_stiffness": 2e7},
    "freeplay, orifice": {"freeplay": {"gap": 0.004}, "orifice": {"coefficient": 3e4}},
    "orifice, links, rod": {"orifice": {"coefficient": 3e4}, "link_stiffness": 2e7, "series_stiffness": 2e7},
    "all but an orifice": {
        "freeplay": {"gap": 0.002},
        "end_stop": {"stroke": 0.01, "stiffness": 2e7},
        "link_stiffness": 2e7,
        "series_stiffness": 2e7,
    },
}
EVERYTHING = ROUNDED["all but an orifice"] | ROUNDED["orifice"]
KICK = {"kick": {"yaw_rate": 6.0}}


def smoothed(joints, width):
    """Every corner rounded over `width`, in the element's own unit."""
    return {name: joint | {"smoothing": width} if isinstance(joint, dict) else joint for name, joint in joints.items()}


def distance(gear, design, disturbance, duration, exact):
    smooth = Simulator(gear, design, "cvodes", 1e-9)(SPEED, LOAD, disturbance, duration)
    assert smooth.status == exact.status == "completed"
    angle = CubicHermiteSpline(exact.time, exact["yaw_angle"], exact["yaw_rate"])(smooth.time)
    return abs(smooth["yaw_angle"] - angle).max() / abs(angle).max()


def of_first_order(errors):
    """Errors at widths of 1e-1, 1e-2 and 1e-3: each about a tenth of the one before at most, down to what the integrators
    leave. The first may be of anything, since so wide a corner is another element."""
    falls = [errors[k + 1] < max(FIRST_ORDER * errors[k], INTEGRATED) for k in range(2)]
    return errors[2] < CONVERGED and all(falls)


def errors_over_widths(study, damper, joints, interval=0.1, **changes):
    design = design_of(damper["topology"], c_lambda=2e4)
    exact = ExactSimulator(study(damper | joints, **changes), design)(SPEED, LOAD, KICK, interval, points=1001)
    assert (exact.status, exact.message) == ("completed", "")
    widths = (1e-1, 1e-2, 1e-3)
    gears = [study(damper | smoothed(joints, width), **changes) for width in widths]
    return [distance(gear, design, KICK, interval, exact) for gear in gears]


@pytest.mark.parametrize("name", ROUNDED)
def test_smooth_version_converges_to_the_exact_one(study, name, interpreted):
    """At least to first order in the width: every element alone and in series with each compliance."""
    errors = errors_over_widths(study, damper_block("boeing"), ROUNDED[name])
    assert of_first_order(errors), errors


@pytest.mark.slow
@pytest.mark.parametrize("geometry", ["planar", "spatial"])
@pytest.mark.parametrize("name", ROUNDED)
def test_smooth_version_converges_to_the_exact_one_for_an_asymmetric_layout(study, name, geometry, interpreted):
    errors = errors_over_widths(study, damper_block("utas", geometry=geometry), ROUNDED[name])
    assert of_first_order(errors), errors


@pytest.mark.slow
@pytest.mark.parametrize("topology", ["boeing", "utas", "arreaza"])
@pytest.mark.parametrize("geometry", ["planar", "spatial"])
def test_smooth_version_with_everything_converges_to_the_exact_one(study, topology, geometry, interpreted):
    errors = errors_over_widths(study, damper_block(topology, geometry=geometry), EVERYTHING, 0.1)
    assert of_first_order(errors), errors


@pytest.mark.parametrize("yaw", [0.1, -0.1, 0.02, 0.004])
def test_released_chain_starts_where_its_damper_carries_nothing(study, yaw):
    """Beyond gap and stop, beyond the gap alone, and inside it: links, spring and stop in equilibrium, found by bisection."""
    k_t, k_stop, gap, stroke = 2e7, 3e7, 0.002, 0.01
    joints = {"freeplay": {"gap": gap}, "end_stop": {"stroke": stroke, "stiffness": k_stop}, "link_stiffness": k_t}

    def held(u):
        twist, s = abs(yaw) - u, ELL * np.sin(u)
        spring = DESIGN["k_lambda"] * s + k_stop * max(s - stroke, 0.0)
        return k_t * ELL**2 * max(twist - gap / ELL, 0.0) - spring * ELL * np.cos(u)

    expected = np.sign(yaw) * brentq(held, 0.0, abs(yaw), xtol=1e-15)
    for more in ({}, {"series_stiffness": 2e7}):
        gear, release = study(damper_block("boeing", **joints, **more)), {"release": {"yaw_angle": yaw}}
        found = ExactSimulator(gear, design_of("boeing"))(SPEED, LOAD, release, 0.001, points=3)
        assert found["link_angle"][0] == pytest.approx(expected, rel=1e-12, abs=1e-15)
        assert abs(found["damper_force"][0]) < 1e-6


@pytest.mark.parametrize("geometry", ["planar", pytest.param("spatial", marks=pytest.mark.slow)])
def test_smooth_friction_converges_to_the_exact_one(study, geometry, interpreted):
    """While it moves: where the exact one sticks, the smooth one creeps."""
    design, duration = design_of("utas", c_lambda=1e3), 0.1
    gears = [
        study(damper_block("utas", geometry=geometry), gear__friction={"torque": 2e3, "smoothing": width})
        for width in (1e-1, 1e-2, 1e-3)
    ]
    exact = ExactSimulator(gears[0], design)(SPEED, LOAD, KICK, duration, points=2001)
    errors = [distance(gear, design, KICK, duration, exact) for gear in gears]
    assert of_first_order(errors), errors


def test_slip_limit_is_an_event(main_gear, interpreted):
    """The moment of the tyre has a kink there, which the smooth engines step over: both move alike."""
    design, sideways = main_gear.start, {"release": {"string_deflection": 0.1}}
    exact = simulate_exactly(main_gear, design, speed=SPEED, disturbance=sideways, duration=0.2, points=2001)
    slip, limit = abs(exact["slip_angle"]), main_gear.tyre.aligning_slip_limit
    assert slip[0] > limit > slip[-1]
    assert (exact["aligning_moment"][slip > limit] == 0).all()
    assert distance(main_gear, design, sideways, 0.2, exact) < INTEGRATED


@pytest.mark.parametrize(
    "joints",
    [
        {"orifice": {"coefficient": 3e6}, "series_stiffness": 2e7},
        {"orifice": {"coefficient": 3e6}, "series_stiffness": 2e7, "link_stiffness": 2e7},
        {"orifice": {"coefficient": 3e4}, "freeplay": {"gap": 0.004}},
    ],
    ids=["strong orifice behind a rod", "and behind the links", "orifice in a gap"],
)
def test_exact_motion_of_an_orifice_goes_on_after_its_corner(study, joints):
    """The damper turns round, or is at rest inside the gap."""
    found = ExactSimulator(study(damper_block("boeing", **joints)), design_of("boeing", c_lambda=1e3))(
        SPEED, LOAD, KICK, 0.15, points=100
    )
    assert (found.status, found.message) == ("completed", "")
    assert found.time[-1] == 0.15


# ------------------------------------------------------------------------------------------------------ absurd but legal


@pytest.mark.parametrize(
    ("joints", "changes"),
    [
        ({"freeplay": {"gap": 0.1}}, {}),
        ({"freeplay": {"gap": 2e-7}}, {}),
        ({"end_stop": {"stroke": 1e-6, "stiffness": 1e12}}, {}),
        ({"end_stop": {"stroke": 1e-6, "stiffness": 1e12}, "freeplay": {"gap": 0.01}}, {}),
        ({"orifice": {"coefficient": 1e12}}, {}),
        ({"orifice": {"coefficient": 1e12}, "link_stiffness": 1e6}, {}),
        ({"link_stiffness": 1.0}, {}),
        ({"series_stiffness": 1e-3}, {}),
        ({}, {"gear__friction": {"torque": 1e9}}),
        ({"freeplay": {"gap": 0.1}}, {"gear__friction": {"torque": 1e-3}}),
    ],
)
def test_absurd_numbers_end_with_a_status(study, joints, changes):
    gear = free_spring(study, **joints)
    if changes:
        gear = gear.replace(**changes)
    found = ExactSimulator(gear, design_of("boeing"))(SPEED, LOAD, {"release": {"yaw_angle": 0.02}}, 0.01, points=50)
    assert found.status in ("completed", "stopped")
    assert bool(found.message) == (found.status == "stopped")
    assert np.isfinite(found["yaw_angle"]).all()
    assert abs(found["yaw_angle"]).max() <= 0.02 * (1 + 1e-9)


def test_huge_friction_holds_whatever_stands_there(study):
    found = ExactSimulator(free_spring(study).replace(gear__friction={"torque": 1e9}), design_of("boeing"))(
        SPEED, LOAD, {"release": {"yaw_angle": 0.02}}, 0.05, points=50
    )
    assert (found["yaw_angle"] == 0.02).all()
    assert motion_of(found).kind == "settled"


def test_huge_friction_stops_a_moving_gear_within_its_stopping_distance(study):
    """I w^2/(2 T) = 100 * 25/2e9 rad."""
    found = ExactSimulator(free_spring(study).replace(gear__friction={"torque": 1e9}), design_of("boeing"))(
        SPEED, LOAD, {"kick": {"yaw_rate": 5.0}}, 0.05, points=50
    )
    assert found["yaw_rate"][-1] == 0.0
    assert found["yaw_angle"][-1] == pytest.approx(100.0 * 25.0 / 2e9, rel=1e-3)


def test_gap_wider_than_the_motion_leaves_the_gear_free(study):
    found = ExactSimulator(free_spring(study, freeplay={"gap": 0.1}), design_of("boeing"))(
        SPEED, LOAD, {"kick": {"yaw_rate": 1.0}}, 0.2, points=50
    )
    np.testing.assert_allclose(found["yaw_angle"], found.time, rtol=0, atol=1e-12)


def test_hard_stop_returns_the_gear(study):
    """Stiff enough to be a wall: within a quarter of a contact it turns round, and keeps its energy."""
    gear = free_spring(study, end_stop={"stroke": 1e-3, "stiffness": 1e12})
    found = ExactSimulator(gear, design_of("boeing", c_lambda=1e-15))(
        SPEED, LOAD, {"kick": {"yaw_rate": 1.0}}, 0.02, tolerance=1e-12, points=400
    )
    wall = brentq(lambda psi: ELL * np.sin(psi) - 1e-3, 0.0, 0.1)
    deepest = np.sqrt(INERTIA / 1e12) / ELL  # v/w of the contact, rad
    assert wall < abs(found["yaw_angle"]).max() < wall + 1.01 * deepest
    energy = boeing_energy(found, stroke=1e-3, contact=1e12)
    np.testing.assert_allclose(energy, energy[0], rtol=1e-6)


@pytest.mark.parametrize(
    ("changes", "design", "disturbance", "speed"),
    [
        ({"damper__control_current": 0.0}, {"c_lambda": 1.1e4, "k_lambda": 8.2e5}, {"release": {"yaw_angle": 1e-3}}, 22.3),
        ({"damper__freeplay": {"gap": 1.1e-4}}, {"c_lambda": 213.0, "k_lambda": 1.2e5}, {"unbalance": {"moment": 0.05}}, 18.8),
    ],
    ids=["no yield at all", "no force in the gap"],
)
def test_a_yield_of_nothing_is_passed_once(configs, changes, design, disturbance, speed):
    """Behind elastic links both corners of a yield stand where the force is nothing: met again and again by rounding."""
    study = damperopt.load(configs / "nose_gear_mr.yaml").replace(
        damper__compliance="sized", damper__geometry="spatial", **changes
    )
    start = study.start | design
    motion = simulate_exactly(study, start, speed=speed, disturbance=disturbance, duration=0.3)
    smooth = damperopt.simulate(study, start, speed=speed, disturbance=disturbance, duration=0.3)
    assert motion.status == "completed"
    yaw = np.interp(smooth.time, motion.time, motion["yaw_angle"])
    assert np.abs(yaw - smooth["yaw_angle"]).max() < 0.03 * np.abs(yaw).max()

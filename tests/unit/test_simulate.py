"""Transient simulation: engines and sensitivities against SciPy on the basic twin, steady states, refusals, kinds of motion."""

from functools import cache

import numpy as np
import pytest
from basic_twin import E_STEEL, LAYOUT, parameters, planar_coefficients, planar_torque, right_hand_side, state_matrix
from components_of import VARIABLES, damper_block
from scipy.integrate import solve_ivp
from tolerances import INTERPOLATED_DECAY, LINEAR_RESPONSE, ROUNDING, SAME_MOTION, SENSITIVITY

from damperopt.dynamics import build
from damperopt.errors import ConfigError
from damperopt.expressions.corners import Smooth
from damperopt.motion.exact import simulate_exactly
from damperopt.motion.integrators import Integrator
from damperopt.motion.measure import crossings, extrema
from damperopt.motion.question import valid_part
from damperopt.motion.simulate import Simulator, simulate
from damperopt.motion.trajectory import Trajectory, motion_of
from damperopt.symbols import data_values, symbolic

DESIGN = LAYOUT | {"c_lambda": 3.0e3, "k_lambda": 3.8e6, "I_arm": 3.4e-6}
SPEED, LOAD, RAKE = 40.0, 150e3, 0.1571
DURATION, SHORT = 0.25, 0.1
RELEASE = {"release": {"yaw_angle": 0.08, "bending_angle": -0.002, "string_deflection": 0.01}}
START = [0.08, 0.0, -0.002, 0.0, 0.01]
DAMPERS = {
    "rotational": {"topology": "rotational", "torsional_stiffness": 3.8e5, "torsional_damping": 300.0},
    "boeing": damper_block("boeing"),
    "utas": damper_block("utas"),
}


@pytest.fixture
def interpreted(monkeypatch):
    """No compilation: it takes longer than these motions."""
    monkeypatch.setattr("damperopt.motion.integrators.has_compiler", lambda: False)


@pytest.fixture
def study(main_gear):
    def change(damper="boeing", **changes):
        return main_gear.replace(
            damper=DAMPERS[damper] if isinstance(damper, str) else damper,
            material={"youngs_modulus": E_STEEL, "density": 7850.0, "yield_strength": 1e9},
            requirements__limit_torque=1e4,
            **({"gear__rake_angle": RAKE} | changes),
        )

    return change


def design_of(topology, **changes):
    return {name: value for name, value in (DESIGN | changes).items() if name in VARIABLES[topology]}


def twin(topology, phi=RAKE, **design):
    if topology == "rotational":
        return parameters(phi=phi)
    k_psi, c_psi = planar_coefficients(topology, E_STEEL, **(DESIGN | design))
    return parameters(phi=phi, k_psi=k_psi, c_psi=c_psi, torque=planar_torque(topology, E_STEEL, **(DESIGN | design)))


def motion_of_the_twin(topology, duration=DURATION, max_step=2e-3, **design):
    """DOP853 on the twin's equations, as a function of time; short steps for what it interpolates between them."""
    p = twin(topology, **design)
    accuracy = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-14, "max_step": max_step}
    return solve_ivp(lambda t, x: right_hand_side(x, SPEED, LOAD, p), (0, duration), START, dense_output=True, **accuracy).sol


reference = cache(motion_of_the_twin)


def differs(states, expected):
    """Largest difference, of the amplitude of each state."""
    return max(abs(a - b).max() / abs(b).max() for a, b in zip(states, expected, strict=True))


# ------------------------------------------------------------------------------------------------------------- engines


@pytest.mark.parametrize("engine", ["erk", "cvodes", "idas"])
@pytest.mark.parametrize("damper", DAMPERS)
def test_engines_move_as_the_twin_does(study, damper, engine, interpreted):
    found = Simulator(study(damper), design_of(damper), engine, 1e-11)(SPEED, LOAD, RELEASE, DURATION)
    assert (found.status, found.engine) == ("completed", engine)
    assert found.time[-1] == DURATION
    assert abs(found["slip_angle"]).max() < parameters().alpha_m  # where the law of the tyre is smooth
    assert differs(found.states.values(), reference(damper)(found.time)) < SAME_MOTION


@pytest.mark.slow
def test_compiled_and_interpreted_engine_take_the_same_steps(study, monkeypatch):
    compiled = Simulator(study(), design_of("boeing"), "erk", 1e-9)(SPEED, LOAD, RELEASE, DURATION)
    monkeypatch.setattr("damperopt.motion.integrators.has_compiler", lambda: False)
    interpreted = Simulator(study(), design_of("boeing"), "erk", 1e-9)(SPEED, LOAD, RELEASE, DURATION)
    assert differs(compiled.states.values(), list(interpreted.states.values())) < 1e-10


@pytest.mark.parametrize("engine", ["erk", "cvodes", "idas"])
def test_error_falls_with_the_tolerance(study, engine, interpreted):
    errors = []
    for tolerance in (1e-5, 1e-7, 1e-9):
        found = Simulator(study(), design_of("boeing"), engine, tolerance)(SPEED, LOAD, RELEASE, DURATION)
        errors.append(differs(found.states.values(), reference("boeing")(found.time)))
    assert errors[0] > 10 * errors[1] > 100 * errors[2]


def test_stretches_join_without_a_seam(study, interpreted):
    """More than one stretch of output steps against one solution over the whole time."""
    simulator = Simulator(study("utas"), design_of("utas"), "cvodes", 1e-11)
    found = simulator(SPEED, LOAD, RELEASE, DURATION)
    longer = simulator(SPEED, LOAD, RELEASE, 8 * DURATION)
    assert longer.time.size > found.time.size
    np.testing.assert_allclose(np.diff(longer.time), longer.time[1], rtol=1e-9)
    part = longer.time <= DURATION
    assert differs([v[part] for v in longer.states.values()], reference("utas")(longer.time[part])) < SAME_MOTION


def test_yaw_acceleration_is_the_slope_of_the_rate(study, interpreted):
    found = simulate(study(), design_of("boeing"), speed=SPEED, disturbance=RELEASE, duration=DURATION, tolerance=1e-10)
    expected = [right_hand_side(x, SPEED, LOAD, twin("boeing"))[1] for x in np.array(list(found.states.values())).T]
    np.testing.assert_allclose(found["yaw_acceleration"], expected, rtol=0, atol=1e-12 * np.abs(expected).max())


# ------------------------------------------------------------------------------------------------------- sensitivities


@cache
def sensitivities_of_the_twin(topology, name):
    """dx/d ln(design variable) at the end, by differences of fourth order."""
    h = 5e-4

    def end(steps):
        return motion_of_the_twin(topology, SHORT, np.inf, **{name: DESIGN[name] * np.exp(steps * h)})(SHORT)

    return (8 * (end(1) - end(-1)) - (end(2) - end(-2))) / (12 * h)


@pytest.mark.parametrize("engine", ["erk", "cvodes", "idas"])
@pytest.mark.parametrize("topology", ["boeing", "utas"])
def test_sensitivities_are_differences_of_solutions_of_the_twin(study, topology, engine):
    gear = study(topology)
    dae = build(symbolic(gear), Smooth())
    integrator = Integrator(dae, data_values(gear), 10, engine, 1e-10, sensitivities=True, compiled=False)
    found = integrator(np.array(START), [DESIGN[name] for name in dae.design_names], SPEED, LOAD, SHORT).sensitivities
    assert found.shape == (5, len(dae.design_names), 11)
    assert not found[:, :, 0].any()
    for i, name in enumerate(dae.design_names):
        expected = sensitivities_of_the_twin(topology, name)
        size = abs(found[:, i]).max(axis=1)
        assert (abs(found[:, i, -1] - expected) < SENSITIVITY * size).all(), name


@pytest.mark.parametrize("engine", [pytest.param("cvodes", marks=pytest.mark.slow), "idas"])
def test_sensitivities_of_the_spatial_linkage_are_differences_of_its_motions(study, engine):
    """Both engines, so that the unknowns are eliminated in one case and integrated in the other."""
    gear = study(damper_block("utas", geometry="spatial"))
    dae = build(symbolic(gear), Smooth())
    design = np.array([DESIGN[name] for name in dae.design_names])
    made = Integrator(dae, data_values(gear), 10, engine, 1e-10, sensitivities=True, compiled=False)
    found = made(np.array(START), design, SPEED, LOAD, SHORT).sensitivities
    plain = Integrator(dae, data_values(gear), 10, "cvodes", 1e-12, compiled=False)
    h = 1e-3
    for i, name in enumerate(dae.design_names):
        unit = np.eye(len(design))[i]
        ends = {k: plain(np.array(START), design * np.exp(k * h * unit), SPEED, LOAD, SHORT).x[:, -1] for k in (-2, -1, 1, 2)}
        expected = (8 * (ends[1] - ends[-1]) - (ends[2] - ends[-2])) / (12 * h)
        assert (abs(found[:, i, -1] - expected) < SENSITIVITY * abs(found[:, i]).max(axis=1)).all(), name


def test_sensitivities_go_on_from_where_they_stopped(study):
    gear = study("utas")
    dae = build(symbolic(gear), Smooth())
    design = [DESIGN[name] for name in dae.design_names]
    integrator = Integrator(dae, data_values(gear), 4, "cvodes", 1e-10, sensitivities=True, compiled=False)
    whole = integrator(np.array(START), design, SPEED, LOAD, SHORT)
    half = integrator(np.array(START), design, SPEED, LOAD, SHORT / 2)
    rest = integrator(half.x[:, -1], design, SPEED, LOAD, SHORT / 2, SHORT / 2, half.sensitivities[:, :, -1])
    size = abs(whole.sensitivities).max(axis=2)
    assert (abs(rest.sensitivities[:, :, -1] - whole.sensitivities[:, :, -1]) < SENSITIVITY * size).all()


# ------------------------------------------------------------------------------------------------------ steady response


def linear(topology, order, **design):
    return state_matrix(SPEED, LOAD, twin(topology, **design), order)


def test_step_settles_at_the_static_solution_of_the_linear_model(study, interpreted):
    """1 N m is small enough; -A^-1 B with B = (0, 1/I_z, 0)."""
    gear, strong = study(gear__order=3), {"c_lambda": 2e4}
    torque = 1.0
    found = Simulator(gear, design_of("boeing", **strong), "cvodes", 1e-10)(SPEED, LOAD, {"step": {"yaw_torque": torque}}, 5.0)
    expected = -np.linalg.solve(linear("boeing", 3, **strong), [0.0, torque / 100.0, 0.0])
    assert found["yaw_angle"][-1] == pytest.approx(expected[0], rel=LINEAR_RESPONSE)
    assert found["string_deflection"][-1] == pytest.approx(expected[2], rel=LINEAR_RESPONSE)
    assert motion_of(found).peaks["yaw_angle"] > 1.3 * expected[0]  # it swings in


def test_unbalance_shakes_with_the_frequency_response_of_the_linear_model(study, interpreted):
    gear, strong, moment = study(gear__order=3), {"c_lambda": 2e4}, 1e-5
    omega = SPEED / 0.362
    found = Simulator(gear, design_of("boeing", **strong), "cvodes", 1e-10)(SPEED, LOAD, {"unbalance": {"moment": moment}}, 5.0)
    late = found.time > 4.0
    t, x = found.time[late], np.array(list(found.states.values()))[:, late]
    cosine, sine = np.linalg.lstsq(np.column_stack([np.cos(omega * t), np.sin(omega * t)]), x.T, rcond=None)[0]
    A = linear("boeing", 3, **strong)
    response = np.linalg.solve(1j * omega * np.eye(3) - A, [0.0, moment * omega**2 / 100.0, 0.0])
    # of the torque Im(e^{i omega t}): x = Im(response e^{i omega t})
    np.testing.assert_allclose(sine + 1j * cosine, response, rtol=0, atol=LINEAR_RESPONSE * abs(response[1]))


def test_small_release_decays_with_the_eigenvalues_of_the_linear_model(study, interpreted):
    """Solution x_0 of exp(A t) by the eigenvectors of the twin's matrix, 1e-5 rad."""
    start = np.array([1e-5, 0.0, 0.0, 0.0, 0.0])
    found = Simulator(study("utas"), design_of("utas"), "cvodes", 1e-10)(SPEED, LOAD, {"release": {"yaw_angle": 1e-5}}, 0.5)
    values, vectors = np.linalg.eig(linear("utas", 5))
    weights = np.linalg.solve(vectors, start)
    expected = ((vectors * weights) @ np.exp(np.outer(values, found.time))).real
    assert differs(found.states.values(), expected) < 10 * 1e-5  # the damper of UTAS is even in psi at next order


# ------------------------------------------------------------------------------------------------------------ refusals

ONE_DEGREE = {"release": {"yaw_angle": "1 deg"}}


@pytest.mark.parametrize("simulate_", [simulate, simulate_exactly])
@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"speed": -1.0}, "speed"),
        ({"speed": 0.0}, "speed"),
        ({"speed": np.nan}, "speed"),
        ({"speed": np.inf}, "speed"),
        ({"load": -1.0}, "load"),
        ({"load": np.nan}, "load"),
        ({"duration": 0.0}, "duration"),
        ({"duration": np.inf}, "duration"),
        ({"disturbance": {}}, "disturbance"),
        ({"disturbance": {"release": {}}}, "release"),
        ({"disturbance": {"release": {"yaw_angle": 0.0}}}, "release"),
        ({"disturbance": {"release": {"yaw_angle": np.nan}}}, "yaw_angle"),
        ({"disturbance": {"release": {"yaw_angle": 1.5}}}, "yaw_angle"),
        ({"disturbance": {"release": {"pitch_angle": 0.1}}}, "pitch_angle"),
        ({"disturbance": {"release": {"bending_angle": 0.01}}}, "bending_angle"),
        ({"disturbance": {"kick": {"bending_rate": 0.1}}}, "bending_rate"),
        ({"disturbance": {"kick": {"yaw_rate": "1 m/s"}}}, "yaw_rate"),
        ({"disturbance": {"gust": {"speed": 3.0}}}, "gust"),
        ({"disturbance": {"step": {"yaw_torque": np.inf}}}, "yaw_torque"),
        ({"design": {"c_lambda": 1e3}}, "design"),
        ({"design": LAYOUT | {"c_lambda": -1e3, "k_lambda": 3.8e6}}, "c_lambda"),
    ],
)
def test_ill_posed_questions_are_refused_by_name(study, interpreted, simulate_, changes, key):
    gear = study(gear__order=3)
    question = {"speed": SPEED, "disturbance": ONE_DEGREE, "duration": 0.1} | changes
    with pytest.raises(ConfigError, match=key):
        simulate_(gear, **question)


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"tolerance": 0.0}, "tolerance"),
        ({"tolerance": 0.1}, "tolerance"),
        ({"tolerance": np.nan}, "tolerance"),
        ({"engine": "rk4"}, "engine"),
        ({"duration": 1e7}, "duration"),
    ],
)
def test_ill_posed_settings_are_refused_by_name(study, interpreted, changes, key):
    with pytest.raises(ConfigError, match=key):
        simulate(study(), speed=SPEED, **({"disturbance": ONE_DEGREE, "duration": 0.1} | changes))


@pytest.mark.parametrize("simulate_", [simulate, simulate_exactly])
def test_start_beyond_the_slip_range_is_refused(study, interpreted, simulate_):
    """atan(0.31/0.3) is more than 45 deg."""
    with pytest.raises(ConfigError, match="slip_range"):
        simulate_(study(), speed=SPEED, disturbance={"release": {"string_deflection": 0.31}}, duration=0.1)


@pytest.mark.parametrize("simulate_", [simulate, simulate_exactly])
def test_start_beyond_the_stop_is_refused(study, interpreted, simulate_):
    stopped = study(damper_block("boeing", end_stop={"stroke": "5 mm"}))
    with pytest.raises(ConfigError, match="stop"):
        simulate_(stopped, speed=SPEED, disturbance={"release": {"yaw_angle": 0.1}}, duration=0.1)


# ---------------------------------------------------------------------------------------------------- end of validity


@pytest.mark.parametrize("simulate_", [simulate, simulate_exactly])
def test_motion_stops_at_the_slip_range(study, interpreted, simulate_):
    gear = study(tyre__slip_range="8 deg")
    found = simulate_(gear, design_of("boeing"), speed=SPEED, disturbance={"kick": {"yaw_rate": 12.0}}, duration=0.5)
    assert found.status == "stopped"
    assert "slip_range, 8 deg" in found.message
    slip = abs(np.degrees(found["slip_angle"]))
    assert slip[-2] <= 8.0 < slip[-1]
    assert (slip[:-1] <= 8.0).all()
    assert motion_of(found).kind == "diverging"


@pytest.mark.parametrize("simulate_", [simulate, simulate_exactly])
def test_motion_ends_at_a_stop_without_stiffness(study, interpreted, simulate_):
    gear = study(damper_block("boeing", end_stop={"stroke": "20 mm"}))
    found = simulate_(gear, design_of("boeing"), speed=SPEED, disturbance={"kick": {"yaw_rate": 12.0}}, duration=0.5)
    assert found.status == "stopped"
    assert "stop at 20 mm" in found.message
    stroke = abs(found["damper_stroke"])
    assert stroke[-2] <= 0.02 < stroke[-1]


def test_valid_part_ends_with_the_first_sample_beyond_any_limit(study):
    """Yaw beyond 1 rad, slip beyond 45 deg or a linkage that is open; a sample that is not a number is not valid."""
    names, gear = ("yaw_angle", "unclosed", "slip_angle"), study()

    def part(**samples):
        return valid_part(np.array([samples.get(name, [0.0] * 4) for name in names]), names, gear)

    assert part() == (4, "")
    assert part(yaw_angle=[0.0, 0.5, 0.9, -1.1]) == (4, "the yaw angle exceeds 1 rad")
    assert part(yaw_angle=[0.0, 0.5, np.nan, 0.0])[0] == 3
    kept, message = part(yaw_angle=[0.0, 0.0, 2.0, 2.0], slip_angle=[0.0, 0.8, 0.0, 0.0])
    assert (kept, "slip_range" in message) == (2, True)
    assert part(unclosed=[1.0, 0.0, 0.0, 0.0]) == (1, "the equations of the closed linkage are not solved")


def test_diverging_gear_is_stopped_and_called_so(study, interpreted):
    """A linear tyre with a destabilising moment that no stiffness stands against."""
    tyre = {
        "law": "linear",
        "contact": "leading_point",
        "half_contact_length": 0.1,
        "relaxation_length": 0.3,
        "cornering_slope": 1.0,
        "aligning_coefficient": -30.0,
    }
    found = simulate(study(gear__order=3, tyre=tyre), design_of("boeing"), speed=SPEED, disturbance=ONE_DEGREE, duration=5.0)
    assert found.status == "stopped"
    assert found.time[-1] < 5.0
    assert motion_of(found).kind == "diverging"


# -------------------------------------------------------------------------------------------------- what a motion shows


def oscillation(decay, frequency=8.0, duration=3.0, points=4000, offset=0.0, phase=0.0, status="completed"):
    """Re(exp(s t + i phase)) as a trajectory, s = -decay + 2 pi i frequency; exact derivatives."""
    t = np.linspace(0, duration, points)
    s = -decay + 2j * np.pi * frequency
    z = np.exp(s * t + 1j * phase)
    states = {"yaw_angle": offset + z.real, "yaw_rate": (s * z).real}
    return Trajectory(40.0, 1e5, t, states, {"yaw_acceleration": (s**2 * z).real}, status, "", "analytic")


def test_crossings_of_an_analytic_function():
    """sin(t^2) on uneven samples: zeros at sqrt(n pi)."""
    t = np.sort(np.concatenate([np.linspace(0.3, 8, 3000), np.linspace(2, 3, 77)]))
    found = crossings(t, np.sin(t**2), 2 * t * np.cos(t**2))
    np.testing.assert_allclose(found, np.sqrt(np.pi * np.arange(1, 21)), rtol=0, atol=1e-8)


def test_crossing_at_a_sample_is_counted_once():
    t = np.arange(-3.0, 4.0)
    assert crossings(t, t, np.ones(7)).tolist() == pytest.approx([0.0], abs=ROUNDING)


def test_a_function_that_keeps_its_sign_has_no_crossing():
    t = np.linspace(0, 1, 11)
    assert crossings(t, 1 + t, np.ones(11)).size == 0


def test_extrema_of_a_damped_cosine():
    """exp(-d t) cos(w t) turns where tan(w t) = -d/w."""
    motion = oscillation(1.5, phase=-0.4)
    w = 2 * np.pi * 8.0
    found, heights = extrema(motion.time, motion["yaw_angle"], motion["yaw_rate"])
    at = (0.4 + np.arange(60) * np.pi - np.arctan(1.5 / w)) / w
    at = at[(at > 0) & (at < 3.0)]
    np.testing.assert_allclose(found, at, rtol=0, atol=1e-5)
    np.testing.assert_allclose(heights, np.exp(-1.5 * at) * np.cos(w * at - 0.4), rtol=0, atol=INTERPOLATED_DECAY)


@pytest.mark.parametrize("cycles", [1, 3, 5])
@pytest.mark.parametrize("phase", [-0.4, -1.2, 2.0])
def test_decay_ratio_of_a_damped_cosine(cycles, phase):
    """A cycle shrinks every extremum by exp(-decay/frequency)."""
    found = motion_of(oscillation(1.5, phase=phase), cycles)
    assert found.decay_ratio == pytest.approx(np.exp(-1.5 * cycles / 8.0), rel=INTERPOLATED_DECAY)


def test_decay_ratio_needs_its_cycles():
    assert motion_of(oscillation(1.5, duration=0.3, phase=-0.4), 3).decay_ratio is None
    assert motion_of(oscillation(1.5, duration=0.6, phase=-0.4), 3).decay_ratio is not None


def test_frequency_cycles_and_peaks_of_a_damped_cosine():
    found = motion_of(oscillation(0.4, phase=-0.4))
    assert found.frequency == pytest.approx(8.0, rel=1e-4)
    assert found.cycles == pytest.approx(3.0 * 8.0, abs=1.0)
    assert found.peaks["yaw_rate"] == pytest.approx(abs(oscillation(0.4, phase=-0.4)["yaw_rate"]).max())
    last = np.exp(-0.4 * 3.0)
    assert found.amplitude == pytest.approx(last, rel=0.05)


@pytest.mark.parametrize(
    ("decay", "kind"),
    [(3.0, "settled"), (0.5, "decaying"), (0.05, "decaying"), (0.0, "limit cycle"), (-0.05, "growing"), (-1.0, "growing")],
)
def test_kind_of_a_damped_or_growing_cosine(decay, kind):
    assert motion_of(oscillation(decay, phase=-0.4)).kind == kind


def test_slow_decay_over_few_cycles_is_not_a_limit_cycle():
    """0.6 % a cycle, seen in nine cycles."""
    assert motion_of(oscillation(0.05, duration=1.2, phase=-0.4)).kind == "decaying"


def test_kind_of_a_motion_that_left_the_model():
    assert motion_of(oscillation(-1.0, status="stopped")).kind == "diverging"


def test_asymmetric_limit_cycle_keeps_its_mean_and_amplitude():
    found = motion_of(oscillation(0.0, phase=-0.4, offset=0.3))
    assert found.kind == "limit cycle"
    assert found.mean == pytest.approx(0.3, abs=1e-6)
    assert found.amplitude == pytest.approx(1.0, rel=1e-6)


def test_kind_of_an_aperiodic_decay():
    t = np.linspace(0, 3, 1000)
    states = {"yaw_angle": np.exp(-3 * t), "yaw_rate": -3 * np.exp(-3 * t)}
    motion = motion_of(Trajectory(40.0, 1e5, t, states, {"yaw_acceleration": 9 * np.exp(-3 * t)}, "completed", "", "analytic"))
    assert motion.kind == "settled"
    assert motion.decay_ratio is None


def test_a_motion_that_sticks_is_settled_and_has_no_frequency_of_its_samples():
    """Two cycles, then held by friction at a turning point."""
    t = np.linspace(0, 3, 1001)
    moving = t < 0.5
    psi = np.where(moving, 0.2 + 0.8 * np.cos(8 * np.pi * t), 1.0)
    rate = np.where(moving, -0.8 * 8 * np.pi * np.sin(8 * np.pi * t), 0.0)
    acceleration = np.where(moving, -0.8 * (8 * np.pi) ** 2 * np.cos(8 * np.pi * t), 0.0)
    states = {"yaw_angle": psi, "yaw_rate": rate}
    motion = motion_of(Trajectory(40.0, 1e5, t, states, {"yaw_acceleration": acceleration}, "completed", "", "analytic"))
    assert motion.kind == "settled"
    assert motion.frequency <= 4.1

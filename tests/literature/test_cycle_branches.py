"""Branches of limit cycles against AUTO's numbers for Thota, Krauskopf and Lowenberg (2009), and return maps by DOP853.

The return maps integrate the equations of the basic twin, or those written here, over one period; multipliers are differences
of them. None shares code with the package.
"""

import numpy as np
import pytest
from basic_twin import LAYOUT, parameters, right_hand_side, spectral_abscissa, state_matrix
from components_of import damper_block
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from tolerances import DECAY_BY_CUBES, DESCRIBED_AMPLITUDE, DESCRIBED_FREQUENCY, DIFFERENCED, RETURNED, printed

import damperopt
from damperopt.cycles.branches import Question, from_hopf_points
from damperopt.cycles.criticality import NormalForm
from damperopt.cycles.edge import Kicker, edge
from damperopt.cycles.joints import Jointed
from damperopt.cycles.motions import Seeder
from damperopt.motion.exact import ExactSimulator


@pytest.fixture(scope="module")
def nose(request):
    return damperopt.load(request.config.rootpath / "configs" / "nose_gear_thota.yaml")


@pytest.fixture(scope="module")
def branch(nose):
    """The torsional branch at 150 kN or 350 kN, with the rake of the source or without."""
    kept = {}

    def at(load, rake=0.1571):
        if (load, rake) not in kept:
            question = Question.of(nose.replace(gear__rake_angle=rake), None, "speed", load=load)
            kept[load, rake] = from_hopf_points(question)
        (only,) = kept[load, rake]
        return only

    return at


def at_speed(branch, speed):
    """Orbit next to a speed, and its states at time zero."""
    orbit = min(branch.orbits, key=lambda orbit: abs(orbit.parameter - speed))
    return orbit, orbit.time_and_states()[1][0]


def returned(rate, x, period):
    """States after a period."""
    return solve_ivp(rate, (0, period), x, method="DOP853", rtol=1e-12, atol=1e-15).y[:, -1]


def multiplier(turn, x, direction_scale):
    """Largest multiplier but that of a shift in time, of a map by central differences."""
    steps = 1e-5 * direction_scale
    M = np.array([(turn(x + h * e) - turn(x - h * e)) / (2 * h) for h, e in zip(steps, np.eye(len(x)), strict=True)]).T
    values = np.linalg.eigvals(M)
    return np.abs(np.delete(values, np.abs(values - 1).argmin())).max()


@pytest.mark.parametrize(
    ("load", "rake", "ends"),
    [(150e3, 0.1571, ("5.612", "93.40")), (150e3, 0.0, ("4.153", "129.08")), (350e3, 0.1571, ("3.725", "169.47"))],
)
def test_the_branch_joins_the_two_hopf_points(branch, load, rake, ends):
    found = branch(load, rake)
    assert [orbit.parameter for orbit in (found.orbits[0], found.orbits[-1])] == [printed(text, 2e-3) for text in ends]
    assert found.ends.startswith("amplitude vanishes")
    assert found.error < 1e-4


def test_torsional_cycle_at_40_metres_per_second(nose):
    """AUTO: 10.58 Hz, 0.135 rad; without rake a simulation of 20 s has 10.401855 Hz."""
    for rake, frequency, amplitude in ((0.1571, "10.58", "0.135"), (0.0, "10.401855", None)):
        question = Question.of(nose.replace(gear__rake_angle=rake), None, "speed", 30.0, 40.0, load=150e3)
        found = Seeder(question).settled(40.0, 0.15).orbit
        assert found.frequency == printed(frequency)
        assert found.stable
        assert amplitude is None or found.amplitudes["yaw_angle"] == printed(amplitude)


def test_lateral_cycle_at_175_metres_per_second(nose):
    """AUTO: 16.04 Hz, l_g sin(delta) 0.102 m; no Hopf point of this mode lies in the range: out of a motion."""
    found = Seeder(Question.of(nose, None, "speed", 170.0, 180.0, load=350e3)).settled(175.0, 0.02).orbit
    assert found.frequency == printed("16.04")
    assert found.amplitudes["lateral_displacement"] == printed("0.102")


def test_torsional_branch_loses_its_stability_to_the_lateral_mode(branch):
    """At 350 kN between 147.1 and 151.0 m/s, by a pair of complex multipliers."""
    labels = {orbit.label: orbit for orbit in branch(350e3).special if orbit.parameter > 100}
    assert set(labels) == {"Neimark-Sacker"}
    assert 147.1 < labels["Neimark-Sacker"].parameter < 151.0
    assert at_speed(branch(350e3), 140.0)[0].stable
    assert at_speed(branch(350e3), 155.0)[0].unstable == 2


@pytest.mark.parametrize(("load", "speed"), [(150e3, 30.0), (350e3, 155.0)])
def test_orbits_return_and_have_the_multipliers_of_the_twin(branch, load, speed):
    orbit, x = at_speed(branch(load), speed)
    rate = lambda t, x: right_hand_side(x, orbit.parameter, load, parameters(phi=0.1571))  # noqa: E731
    size = np.abs(orbit.time_and_states()[1]).max(axis=0)
    turn = lambda x: returned(rate, x, orbit.period)  # noqa: E731
    assert np.abs((turn(x) - x) / size).max() < RETURNED
    assert np.abs(orbit.multipliers).max() == pytest.approx(multiplier(turn, x, size), abs=DIFFERENCED)


def test_amplitude_at_a_critical_speed_falls_as_the_normal_form_says(nose):
    """There a' = c a^3, so that 1/a^2 grows by -2 c t: c out of peaks of a motion of the twin."""
    (critical, _) = damperopt.critical_speeds(damperopt.linear_gear(nose), 150e3, 2.0, 200.0)
    found = NormalForm(nose).at({}, critical)
    assert (found.kind, found.stable_below, found.leading) == ("supercritical", True, "yaw_angle")
    p = parameters(phi=0.1571)
    turning = lambda t, x: x[1]  # noqa: E731
    start = 0.02 * np.array([1.0, 0.0, 0.0, 0.0, 0.0])
    run = solve_ivp(
        lambda t, x: right_hand_side(x, critical.speed, 150e3, p),
        (0, 30),
        start,
        method="DOP853",
        rtol=1e-10,
        atol=1e-13,
        events=turning,
    )
    times, peaks = run.t_events[0], np.abs(run.y_events[0][:, 0])
    later = times > 10.0  # the lateral mode has died by then
    slope = np.polyfit(times[later], 1 / peaks[later] ** 2, 1)[0]
    assert -2 * found.coefficient == pytest.approx(slope, rel=DECAY_BY_CUBES)


# ---------------------------------------------------------------------------------------------- gap in the apex joint

SPEED, LOAD, GAP = 40.0, 150e3, 2e-4
ELL = LAYOUT["L"] * np.sin(LAYOUT["gamma"])
K_PSI = 3.8e6 * ELL**2


def abscissa(share, c_psi):
    return spectral_abscissa(state_matrix(SPEED, LOAD, parameters(k_psi=share * K_PSI, c_psi=share * c_psi), 3))


C_PSI = 2 * brentq(lambda c: abscissa(1.0, c), 1.0, 3e3)


def dead_band(x, speed):
    """Rates of the twin of three states with spring and damper behind the gap."""
    twist = x[0] - np.clip(x[0], -GAP / ELL, GAP / ELL)
    torque = -K_PSI * np.sin(twist) * np.cos(twist) - C_PSI * np.cos(twist) ** 2 * x[1] * (twist != 0)
    return right_hand_side(x, speed, LOAD, parameters(torque=lambda psi, rate: torque))


def by_legs(rate, edges, x, period):
    """A motion over a period from corner to corner, each met as an event."""
    t = 0.0
    events = [(lambda t, x, g=g: g(x)) for g in edges]
    for event in events:
        event.terminal = True
    while t < period:
        ahead = x + 1e-9 * rate(x)
        sides = [np.sign(g(ahead)) for g in edges]
        for event, side in zip(events, sides, strict=True):
            event.direction = -side
        leg = solve_ivp(
            lambda t, x: rate(x), (t, period), x, method="DOP853", rtol=1e-11, atol=1e-15, events=events, max_step=2e-3
        )
        t, x = leg.t[-1], leg.y[:, -1]
        if leg.status == 1:
            x, t = x + 1e-12 * rate(x), t + 1e-12
    return x


@pytest.fixture(scope="module")
def gap_cycle(request):
    study = damperopt.load(request.config.rootpath / "configs" / "thesis_gear.yaml")
    damper = damper_block("boeing", freeplay={"gap": GAP, "smoothing": 1e-3})
    study = study.replace(requirements__decay=None, gear__order=3, damper=damper)
    design = {"L": LAYOUT["L"], "gamma": LAYOUT["gamma"], "k_lambda": 3.8e6, "c_lambda": C_PSI / ELL**2}
    return Seeder(Question.of(study, design, "speed", 30.0, 50.0)).settled(SPEED, 1e-3).orbit


def test_cycle_of_a_gap_is_near_that_of_the_describing_function(gap_cycle):
    share = brentq(lambda n: abscissa(n, C_PSI), 0.05, 1.0)
    d = brentq(lambda d: 1 - 2 / np.pi * (np.arcsin(d) + d * np.sqrt(1 - d**2)) - share, 0.0, 1.0)
    values = np.linalg.eigvals(state_matrix(SPEED, LOAD, parameters(k_psi=share * K_PSI, c_psi=share * C_PSI), 3))
    frequency = abs(values[values.real.argmax()].imag) / (2 * np.pi)
    assert gap_cycle.amplitudes["yaw_angle"] == pytest.approx(GAP / ELL / d, rel=DESCRIBED_AMPLITUDE)
    assert gap_cycle.frequency == pytest.approx(frequency, rel=DESCRIBED_FREQUENCY)
    assert len(gap_cycle.path.legs) == 2  # of half a cycle: outside the gap, and inside


def test_cycle_of_a_gap_returns_and_its_multiplier_is_that_of_a_map_through_the_corners(gap_cycle):
    states = gap_cycle.time_and_states()[1]
    x, size = states[20], np.abs(states).max(axis=0)  # away from a corner
    edges = [lambda x: x[0] - GAP / ELL, lambda x: x[0] + GAP / ELL]
    turn = lambda x: by_legs(lambda x: dead_band(x, SPEED), edges, x, gap_cycle.period)  # noqa: E731
    assert np.abs((turn(x) - x) / size).max() < RETURNED
    assert np.abs(gap_cycle.multipliers).max() == pytest.approx(multiplier(turn, x, size), abs=DIFFERENCED)


@pytest.mark.verify
def test_cycle_between_the_stops_of_a_gear_with_a_gap_returns(request):
    """Half a cycle has four legs, those through the gap a hundredth of it long."""
    stop, stiffness, damping = 2e-3, 5e7, 3e3
    study = damperopt.load(request.config.rootpath / "configs" / "thesis_gear.yaml")
    damper = damper_block("boeing", freeplay={"gap": GAP}, end_stop={"stroke": stop, "stiffness": stiffness})
    study = study.replace(requirements__decay=None, gear__order=3, damper=damper)
    design = {"L": LAYOUT["L"], "gamma": LAYOUT["gamma"], "k_lambda": 3.8e6, "c_lambda": damping}
    orbit = Seeder(Question.of(study, design, "speed", 30.0, 50.0)).settled(SPEED, 0.05).orbit
    assert len(orbit.path.legs) == 4

    def stroke(x):
        return ELL * np.sin(x[0] - np.clip(x[0], -GAP / ELL, GAP / ELL))

    def rate(x):
        twist = x[0] - np.clip(x[0], -GAP / ELL, GAP / ELL)
        s, lever = ELL * np.sin(twist), ELL * np.cos(twist)
        force = 3.8e6 * s + damping * lever * x[1] * (twist != 0) + stiffness * (s - np.clip(s, -stop, stop))
        return right_hand_side(x, SPEED, LOAD, parameters(torque=lambda psi, rate: -lever * force))

    states = orbit.time_and_states()[1]
    x, size = states[20], np.abs(states).max(axis=0)
    edges = [lambda x: x[0] - GAP / ELL, lambda x: x[0] + GAP / ELL, lambda x: stroke(x) - stop, lambda x: stroke(x) + stop]
    assert np.abs((by_legs(rate, edges, x, orbit.period) - x) / size).max() < 10 * RETURNED


# ------------------------------------------------------------------------------------ castering wheel held by friction

CASTOR = {"I_z": 0.6, "e": 0.09, "a": 0.05, "sigma": 0.12, "C_F": 6.0, "C_M": 0.0, "kappa": 3.0, "law": "linear", "R_w": 0.17}
BREAKOUT = 10.0


@pytest.fixture(scope="module")
def castor(request):
    study = damperopt.load(request.config.rootpath / "configs" / "nose_wheel_castering.yaml")
    tyre = {"law": "linear", "contact": "leading_point", "half_contact_length": 0.05, "relaxation_length": 0.12}
    tyre |= {"cornering_slope": 6.0, "aligning_coefficient": 0.0, "tread_width_moment": 3.0}
    damper = {"topology": "rotational", "kind": "friction", "torsional_stiffness": 0.0, "breakout_torque": BREAKOUT}
    gear = {"kind": "yaw", "yaw_inertia": 0.6, "caster_length": 0.09, "wheel_radius": 0.17}
    return study.replace(gear=gear, tyre=tyre, damper=damper, envelope__vertical_load=1200.0)


@pytest.fixture(scope="module")
def threshold(castor):
    return edge(Kicker(ExactSimulator(castor, {})), 15.0, 1200.0)


def test_largest_release_of_a_castering_wheel_that_dies(threshold):
    """At 15 m/s one of 0.10 rad dies, one of 0.14 rad does not."""
    assert 0.10 < threshold.dies < threshold.not_dies < 0.14
    assert threshold.fate in ("grows", "leaves")


def test_between_them_is_an_unstable_cycle_that_returns(castor):
    seeder = Seeder(Question.of(castor, None, "speed", 10.0, 20.0))
    orbit = seeder.between(15.0).orbit
    assert orbit.unstable == 1
    states = orbit.time_and_states()[1]
    x, size = states[40], np.abs(states).max(axis=0)
    p = parameters(**CASTOR)

    def rate(x):
        friction = -BREAKOUT * np.sign(x[1])
        return right_hand_side(x, 15.0, 1200.0, p.__class__(**(vars(p) | {"torque": lambda psi, rate: friction})))

    turn = lambda x: by_legs(rate, [lambda x: x[1]], x, orbit.period)  # noqa: E731
    assert np.abs((turn(x) - x) / size).max() < 10 * RETURNED
    assert np.abs(orbit.multipliers).max() == pytest.approx(multiplier(turn, x, size), rel=1e-3)


def test_friction_that_holds_keeps_the_wheel_still_and_its_reserve_is_what_the_tyre_leaves(castor):
    """Reserve to both sides: T_c -+ the torque of the tyre, e C_F F_z atan(y/sigma), that drives the wheel."""
    model = Jointed(castor)
    flow = model.flow(np.zeros(1), sticks=True)
    x = np.array([[0.05, 0.0, 0.002]])
    numbers = flow.values({}, 15.0, 1200.0)
    rates = flow.slopes(x, flow.unknowns(x, numbers), numbers, 0 * numbers).rates[0]
    y_t = 15.0 * (np.sin(0.05) - 0.002 / 0.12 * np.cos(0.05))
    assert rates == pytest.approx([0.0, 0.0, y_t], abs=1e-12)
    torque = -0.09 * 6.0 * 1200.0 * np.arctan(0.002 / 0.12) / 0.6  # over the inertia: of the rate, as friction holds it
    reserve = model.signs(flow, x, numbers).reserve[0]
    assert reserve == pytest.approx([BREAKOUT / 0.6 - torque, BREAKOUT / 0.6 + torque], rel=1e-9)

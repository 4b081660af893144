"""What a motion is called: beating, forced, on its cycle or on its way there; amplitudes with known limits."""

import numpy as np
import pytest

import damperopt
from damperopt import linear_gear
from damperopt.motion.trajectory import Trajectory, motion_of

OPTIMUM = {"c_lambda": 34802.7, "I_arm": 5.66628e-7, "L": 0.478101, "gamma": 0.532102, "b": 0.152445}
"""Of the main gear, to six digits: its lateral mode, hardly damped, takes energy from the yaw mode and gives it back."""


def trajectory(time, angle, rate, forcing=0.0):
    states = {"yaw_angle": np.real(angle), "yaw_rate": np.real(rate)}
    return Trajectory(40.0, 1e5, time, states, {}, "completed", "", "analytic", forcing)


def modal(A, x0, time):
    """Linear motion x' = A x by its eigenvectors."""
    s, vectors = np.linalg.eig(A)
    parts = np.linalg.solve(vectors, x0)[:, None] * np.exp(np.outer(s, time))
    return trajectory(time, vectors[0] @ parts, vectors[0] @ (s[:, None] * parts))


@pytest.mark.parametrize("speed", [8.0, *(pytest.param(speed, marks=pytest.mark.slow) for speed in (14.0, 40.0)), 80.0])
@pytest.mark.parametrize("state", ["string_deflection", "bending_angle", "yaw_rate"])
def test_a_beating_decay_is_never_called_growing(main_gear, speed, state):
    """Linear motions of a gear proved stable, cut off at any time: also where the amplitude of a beat is rising."""
    gear = linear_gear(main_gear, OPTIMUM)
    assert gear.abscissa(speed, 150e3)[0] < -0.09
    x0 = np.array([0.1 * (name == state) for name in gear.state_names])
    for duration in np.arange(0.4, 3.05, 0.1):
        time = np.linspace(0.0, duration, int(duration * 1500))
        found = motion_of(modal(gear.matrices(speed, 150e3)[0], x0, time))
        # a kick of the strut reaches the wheel late: until then its yaw has exceeded all before
        if duration > 1.0 or state == "string_deflection":
            assert found.kind in ("decaying", "settled"), duration


def beating(decay, depth=0.8, frequency=12.0, beat=1.3, duration=6.0):
    """Two modes with frequencies `beat` apart, the second `depth` as large; both with the same decay."""
    time = np.linspace(0.0, duration, int(duration * 1500))
    first, second = (-decay + 2j * np.pi * f for f in (frequency, frequency + beat))
    parts = np.exp(first * time), depth * np.exp(second * time)
    return trajectory(time, sum(parts), first * parts[0] + second * parts[1])


@pytest.mark.parametrize("duration", [4.0, 4.2, 4.4, 4.6, 4.8, 6.0, 12.0])
@pytest.mark.parametrize(("decay", "kind"), [(0.3, "decaying"), (-0.3, "growing"), (0.1, "decaying"), (-0.1, "growing")])
def test_a_beating_motion_is_judged_by_its_envelope(decay, kind, duration):
    assert motion_of(beating(decay, duration=duration)).kind == kind


def test_growth_after_a_first_decay_is_growth():
    """A string let go dies away at once and leaves an unstable mode behind."""
    time = np.linspace(0.0, 3.0, 4500)
    fast, slow = -12.0 + 2j * np.pi * 11, 0.6 + 2j * np.pi * 10
    parts = np.exp(fast * time), 0.02 * np.exp(slow * time)
    assert motion_of(trajectory(time, sum(parts), fast * parts[0] + slow * parts[1])).kind == "growing"


def with_amplitude(amplitude, slope, frequency=11.0, duration=3.0, forcing=0.0):
    """A(t) cos(w t) with its derivative."""
    time = np.linspace(0.0, duration, int(duration * 1500))
    w = 2 * np.pi * frequency
    angle = amplitude(time) * np.cos(w * time)
    return trajectory(time, angle, slope(time) * np.cos(w * time) - w * amplitude(time) * np.sin(w * time), forcing)


@pytest.mark.parametrize("start", [0.5, 0.8, 0.97, 1.0, 1.03, 1.3, 2.0])
def test_a_motion_that_tends_to_a_cycle_is_on_it_at_the_default_duration(start):
    """A = 1 + (start - 1) exp(-1.3 t)."""
    rate = 1.3
    found = motion_of(
        with_amplitude(
            lambda t: 1 + (start - 1) * np.exp(-rate * t),
            lambda t: -rate * (start - 1) * np.exp(-rate * t),
        )
    )
    assert found.kind == "limit cycle"


@pytest.mark.parametrize("rate", [0.05, 0.1, 0.3, 1.0])
def test_two_decays_one_after_the_other_are_no_cycle(rate):
    """The fast one dies away, the slow one stays: its change per cycle is constant and does not vanish."""
    found = motion_of(
        with_amplitude(
            lambda t: np.exp(-rate * t) + 0.5 * np.exp(-4 * t), lambda t: -rate * np.exp(-rate * t) - 2 * np.exp(-4 * t)
        )
    )
    assert found.kind == "decaying"


@pytest.mark.parametrize("duration", [3.0, 6.0, 12.0])
def test_a_decay_with_the_reciprocal_of_time_is_no_cycle(duration):
    """As damping by the square of the speed gives."""
    found = motion_of(with_amplitude(lambda t: 1 / (1 + t), lambda t: -1 / (1 + t) ** 2, duration=duration))
    assert found.kind == "decaying"


def test_a_steady_motion_at_the_frequency_that_drives_it_is_a_forced_response():
    def steady(forcing):
        return with_amplitude(lambda t: 1 + 0 * t, lambda t: 0 * t, forcing=forcing)

    assert motion_of(steady(0.0)).kind == "limit cycle"
    assert motion_of(steady(11.0)).kind == "forced response"
    # a cycle of the gear's own beside a wheel that turns at another frequency
    assert motion_of(steady(17.0)).kind == "limit cycle"


@pytest.mark.parametrize("release", [None, {"yaw_angle": 0.01}])
def test_an_unbalanced_wheel_makes_a_forced_response_of_a_stable_gear(main_gear, release):
    found = damperopt.simulate(
        main_gear,
        OPTIMUM,
        speed=40.0,
        disturbance={"unbalance": {"moment": 0.05}} | ({"release": release} if release else {}),
        engine="cvodes",
    )
    assert found.forcing == pytest.approx(40.0 / 0.362 / (2 * np.pi))
    assert motion_of(found).kind == "forced response"
    exact = damperopt.simulate_exactly(
        main_gear, OPTIMUM, speed=40.0, disturbance={"unbalance": {"moment": 0.05}}, duration=0.2
    )
    assert exact.forcing == found.forcing

"""Limit cycles: those of Thota, Krauskopf and Lowenberg (2009), and the residual ones of a gap in the apex joint.

The first are Figs 4.5 to 4.10 of the thesis, numbers as section 6 of the theory page prints them. The second are compared
with the describing function of a dead band (Gelb and Vander Velde 1968): under psi = A sin(w t), spring and damper behind a
gap of +-d A act in the mean over a cycle with N = 1 - (2/pi)(asin(d) + d sqrt(1 - d^2)) of their stiffness and damping. A
limit cycle is then where the linear gear with N k_psi and N c_psi has a spectral abscissa of zero.
"""

import numpy as np
import pytest
from basic_twin import LAYOUT, parameters, spectral_abscissa, state_matrix
from components_of import damper_block
from scipy.integrate import quad
from scipy.optimize import brentq
from tolerances import DESCRIBED_AMPLITUDE, DESCRIBED_FREQUENCY, GAP_PROPORTION, QUADRATURE, SAME_CYCLE, printed

import damperopt
from damperopt.motion.exact import ExactSimulator
from damperopt.motion.simulate import Simulator
from damperopt.motion.trajectory import motion_of

# ------------------------------------------------------------------------------------------------------- Thota et al. 2009


@pytest.fixture(scope="module")
def nose_gear(configs_of_module):
    return Simulator(damperopt.load(configs_of_module / "nose_gear_thota.yaml"), engine="cvodes")


@pytest.fixture(scope="module")
def configs_of_module(request):
    return request.config.rootpath / "configs"


def end_of(motion, name, seconds):
    """Half the peak-to-peak value over the last part of a motion."""
    return np.ptp(motion[name][motion.time > motion.time[-1] - seconds]) / 2


@pytest.mark.parametrize("start", [0.05, 0.2], ids=["from within", "from without"])
def test_torsional_limit_cycle_at_40_metres_per_second(nose_gear, start):
    motion = nose_gear(40.0, 150e3, {"release": {"yaw_angle": start}}, 12.0)
    found = motion_of(motion)
    assert found.kind == "limit cycle"
    assert found.amplitude == printed("0.135")
    assert found.frequency == printed("10.58")
    # the strut hardly bends: it is the torsional mode
    assert end_of(motion, "lateral_displacement", 1.0) < 0.003


@pytest.mark.parametrize("start", [0.03, pytest.param(0.05, marks=pytest.mark.slow)], ids=["from within", "from without"])
def test_lateral_limit_cycle_at_175_metres_per_second(nose_gear, start):
    motion = nose_gear(175.0, 350e3, {"release": {"yaw_angle": 0.01, "bending_angle": start}}, 18.0)
    assert end_of(motion, "lateral_displacement", 1.0) == printed("0.102")
    assert motion_of(motion).frequency == printed("16.04")


def component(motion, name, after, low, high, span=4.0):
    """Largest amplitude of an oscillation between two frequencies [Hz] in the `span` seconds after a time; Hann window."""
    part = motion[name][(motion.time >= after) & (motion.time < after + span)]
    window = np.hanning(part.size)
    spectrum = 2 * abs(np.fft.rfft(part * window)) / window.sum()
    frequency = np.fft.rfftfreq(part.size, motion.time[1])
    return spectrum[(frequency > low) & (frequency < high)].max()


@pytest.mark.slow
def test_both_modes_live_for_half_a_minute_at_155_metres_per_second_and_the_lateral_one_stays(nose_gear):
    """Torsion at some 13.5 Hz, bending at 16.04 Hz; linear frequencies 13.43 and 16.03 Hz."""
    motion = nose_gear(155.0, 350e3, {"release": {"yaw_angle": 0.05}}, 100.0)
    assert motion.status == "completed"
    torsion, bending = (12.8, 14.4), (15.5, 16.6)
    twisting = [component(motion, "yaw_angle", after, *torsion) for after in (2.0, 10.0, 20.0, 29.0)]
    swaying = [component(motion, "lateral_displacement", after, *bending) for after in (2.0, 10.0, 20.0, 29.0)]
    assert min(twisting) > 0.01
    assert min(swaying) > 0.003
    assert swaying == sorted(swaying)
    assert component(motion, "yaw_angle", 95.0, *torsion) < 1e-3
    assert component(motion, "lateral_displacement", 95.0, *bending) > 0.09
    assert motion_of(motion).frequency == printed("16.04")


# --------------------------------------------------------------------------------------------------------------- freeplay

SPEED, LOAD, CRITICAL = 40.0, 150e3, 2.0
"""The damper is twice the one that the gear without a gap needs."""

ELL = LAYOUT["L"] * np.sin(LAYOUT["gamma"])
K_PSI = 3.8e6 * ELL**2


def abscissa(k_psi, c_psi):
    return spectral_abscissa(state_matrix(SPEED, LOAD, parameters(k_psi=k_psi, c_psi=c_psi), 3))


C_PSI = CRITICAL * brentq(lambda c: abscissa(K_PSI, c), 1.0, 3e3)


def describing(d):
    return 1 - 2 / np.pi * (np.arcsin(d) + d * np.sqrt(1 - d**2))


def described(gap):
    """Amplitude [rad] and frequency [Hz] by the describing function."""
    share = brentq(lambda n: abscissa(n * K_PSI, n * C_PSI), 0.05, 1.0)
    d = brentq(lambda d: describing(d) - share, 0.0, 1.0)
    values = np.linalg.eigvals(state_matrix(SPEED, LOAD, parameters(k_psi=share * K_PSI, c_psi=share * C_PSI), 3))
    return gap / ELL / d, abs(values[values.real.argmax()].imag) / (2 * np.pi)


@pytest.fixture
def with_gap(main_gear):
    def study(gap, smoothing=1e-3):
        return main_gear.replace(gear__order=3, damper=damper_block("boeing", freeplay={"gap": gap, "smoothing": smoothing}))

    return study


DESIGN = {"L": LAYOUT["L"], "gamma": LAYOUT["gamma"], "k_lambda": 3.8e6, "c_lambda": C_PSI / ELL**2}
GAP = 2e-4


def limit_cycle(study, start, duration=4.0):
    found = motion_of(Simulator(study, DESIGN, "cvodes", 1e-8)(SPEED, LOAD, {"release": {"yaw_angle": start}}, duration))
    assert found.kind == "limit cycle"
    return found


def test_describing_function_is_the_first_harmonic_of_a_dead_band():
    """Of the spring behind the gap, in phase with the angle, and of the damper, in phase with the rate."""
    for d in (0.1, 0.37, 0.8):
        edge = np.arcsin(d)
        spring = 4 / np.pi * quad(lambda u, d=d: (np.sin(u) - d) * np.sin(u), edge, np.pi / 2)[0]
        damper = 4 / np.pi * quad(lambda u: np.cos(u) ** 2, edge, np.pi / 2)[0]
        assert describing(d) == pytest.approx(spring, rel=QUADRATURE)
        assert describing(d) == pytest.approx(damper, rel=QUADRATURE)


def test_the_gear_is_stable_without_a_gap_and_unstable_without_its_damper(main_gear):
    study = main_gear.replace(gear__order=3, damper=damper_block("boeing"))
    assert damperopt.linear_gear(study, DESIGN).abscissa(SPEED, LOAD)[0] < -3.0
    assert damperopt.linear_gear(study, DESIGN | {"c_lambda": 1.0}).abscissa(SPEED, LOAD)[0] > 1.0


def test_without_a_gap_the_gear_comes_to_rest(main_gear):
    study = main_gear.replace(gear__order=3, damper=damper_block("boeing"))
    motion = Simulator(study, DESIGN, "cvodes", 1e-8)(SPEED, LOAD, {"release": {"yaw_angle": 0.005}}, 3.0)
    assert motion_of(motion).kind == "settled"


@pytest.mark.parametrize("share", [0.6, 2.0], ids=["from within", "from without"])
def test_gap_leaves_the_limit_cycle_of_the_describing_function(with_gap, share):
    """The true one is 4 % smaller and 1.4 % slower: the third harmonic of the dead band, which the describing function
    neglects, passes the gear damped by its inertia only."""
    amplitude, frequency = described(GAP)
    found = limit_cycle(with_gap(GAP), share * amplitude)
    assert found.amplitude == pytest.approx(amplitude, rel=DESCRIBED_AMPLITUDE)
    assert found.frequency == pytest.approx(frequency, rel=DESCRIBED_FREQUENCY)


@pytest.mark.slow
def test_exact_simulation_has_the_same_limit_cycle(with_gap):
    amplitude, _ = described(GAP)
    smooth = limit_cycle(with_gap(GAP), amplitude)
    exact = ExactSimulator(with_gap(GAP), DESIGN)(SPEED, LOAD, {"release": {"yaw_angle": amplitude}}, 3.0, points=3001)
    found = motion_of(exact)
    assert found.kind == "limit cycle"
    assert found.amplitude == pytest.approx(smooth.amplitude, rel=SAME_CYCLE)
    assert found.frequency == pytest.approx(smooth.frequency, rel=SAME_CYCLE)


def test_amplitude_grows_in_proportion_to_the_gap_and_frequency_stays(with_gap):
    """As long as angles are small: nothing else in the model has a length of its own."""
    small, large = (limit_cycle(with_gap(gap), 1.2 * described(gap)[0]) for gap in (1e-5, 4e-4))
    assert large.amplitude / small.amplitude == pytest.approx(40.0, rel=GAP_PROPORTION)
    assert large.frequency == pytest.approx(small.frequency, rel=GAP_PROPORTION)


@pytest.mark.slow
def test_a_stronger_damper_makes_the_limit_cycle_smaller_but_never_removes_it(with_gap):
    """It does not act inside the gap: the amplitude stays above the gap."""
    amplitudes = []
    for factor in (1.0, 2.0, 4.0):
        motion = Simulator(with_gap(GAP), DESIGN | {"c_lambda": factor * DESIGN["c_lambda"]}, "cvodes", 1e-8)(
            SPEED, LOAD, {"release": {"yaw_angle": 2 * GAP / ELL}}, 4.0
        )
        amplitudes.append(motion_of(motion).amplitude)
    assert amplitudes[0] > amplitudes[1] > amplitudes[2] > GAP / ELL

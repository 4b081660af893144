"""Decay ratio and its derivatives, against a matrix exponential and SciPy on the gear written in NumPy."""

import numpy as np
import pytest
from basic_twin import E_STEEL, parameters, planar_coefficients, planar_torque, right_hand_side, state_matrix
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq
from tolerances import DECAY_GRADIENT, DECAY_RATIO, SAME_WORST

from damperopt.motion.decay import DIVERGED, DecayAnalysis
from damperopt.motion.exact import ExactSimulator
from damperopt.motion.integrators import best_engine, has_compiler
from damperopt.motion.trajectory import decay

LOAD, CYCLES = 150e3, 3
DESIGNS = {
    "boeing": {"c_lambda": 8e3, "k_lambda": 2.8e7, "L": 0.55, "gamma": 0.71},
    "utas": {"c_lambda": 1.5e5, "I_arm": 9e-7, "L": 0.49, "gamma": 0.57, "b": 0.14},
    "arreaza": {"c_lambda": 3.5e4, "I_arm": 5.7e-7, "L": 0.48, "gamma": 0.53, "b": 0.15},
}
STEEL = {"youngs_modulus": E_STEEL, "density": 7850.0, "yield_strength": 1e9}


@pytest.fixture(scope="module")
def study(main_gear_with_decay):
    return main_gear_with_decay.replace(material=STEEL)


@pytest.fixture(scope="module")
def analysis(study):
    kept = {}

    def of(topology="arreaza", **changes):
        key = topology, repr(changes)
        if key not in kept:
            kept[key] = DecayAnalysis(study.replace(damper__topology=topology, **changes))
        return kept[key]

    return of


def ratio_of(yaw, end):
    """First extremum is the release; the largest |yaw| beyond the sixth zero, found on a fine grid and refined on it."""
    t = np.linspace(0, end, 40_001)
    psi = yaw(t)
    zeros = np.flatnonzero(psi[1:] * psi[:-1] < 0)
    start = brentq(lambda u: float(yaw(np.array([u]))[0]), *t[zeros[2 * CYCLES - 1] + np.arange(2)], xtol=1e-14)
    later = np.abs(np.where(t > start, psi, 0.0))
    top = int(later.argmax())
    fit = np.polyfit(t[top - 2 : top + 3] - t[top], later[top - 2 : top + 3], 4)
    stationary = np.roots(np.polyder(fit))
    at = min(stationary[np.abs(stationary.imag) < 1e-12].real, key=abs)
    return np.polyval(fit, at) / abs(psi[0])


def scipy_ratio(topology, design, V, release, **changes):
    """DOP853 at 1e-12 on the twin's nonlinear gear."""
    k_psi, c_psi = planar_coefficients(topology, **design)
    p = parameters(k_psi=k_psi, c_psi=c_psi, torque=planar_torque(topology, **design), **changes)
    x0 = np.array([release, 0, 0, 0, 0])
    end = 7 * 2 * np.pi / np.sqrt(k_psi / p.I_z)
    found = solve_ivp(
        lambda t, x: right_hand_side(x, V, LOAD, p), (0, end), x0, "DOP853", rtol=1e-12, atol=1e-18, dense_output=True
    )
    return ratio_of(lambda t: found.sol(t)[0], end)


@pytest.mark.parametrize("topology", DESIGNS)
@pytest.mark.parametrize("V", [pytest.param(12.0, marks=pytest.mark.slow), 37.0, 90.0])
def test_small_release_decays_like_the_matrix_exponential(analysis, topology, V):
    """Release of 1e-6 rad: the nonlinear terms are of relative order 1e-10 (of the arm) to 1e-6 (UTAS' lever)."""
    k_psi, c_psi = planar_coefficients(topology, **DESIGNS[topology])
    A = state_matrix(V, LOAD, parameters(k_psi=k_psi, c_psi=c_psi))
    end = 7 * 2 * np.pi / np.sqrt(k_psi / 100.0)
    step = expm(A * end / 40_000)
    powers = [np.eye(5)[:, 0]]
    for _ in range(40_000):
        powers.append(step @ powers[-1])
    path = np.array(powers)[:, 0]

    def yaw(t):
        if t.size == path.size:
            return path
        return np.array([(expm(A * u) @ np.eye(5)[:, 0])[0] for u in t])

    tiny = analysis(topology, requirements__decay__release={"yaw_angle": 1e-6}, solver__integration_tolerance=1e-10)
    assert tiny.at(DESIGNS[topology], V, LOAD).ratio == pytest.approx(ratio_of(yaw, end), rel=DECAY_RATIO)


@pytest.mark.parametrize("topology", DESIGNS)
@pytest.mark.parametrize("V", [pytest.param(20.0, marks=pytest.mark.slow), 60.0])
def test_ratio_and_gradient_are_those_of_scipy(analysis, topology, V):
    """Release of 2 deg on the nonlinear gear; gradients against central differences of SciPy's ratio."""
    design, release = DESIGNS[topology], np.deg2rad(2.0)
    point = analysis(topology, requirements__decay__release={"yaw_angle": release}).at(design, V, LOAD, gradient=True)
    assert point.ratio == pytest.approx(scipy_ratio(topology, design, V, release), rel=DECAY_RATIO)
    h = 1e-4
    for i, name in enumerate(design):
        up, down = (np.log(scipy_ratio(topology, design | {name: design[name] * (1 + s * h)}, V, release)) for s in (1, -1))
        assert point.gradient[i] == pytest.approx((up - down) / (2 * h), rel=DECAY_GRADIENT, abs=DECAY_GRADIENT), name


@pytest.mark.slow
@pytest.mark.parametrize("topology", ["utas", "arreaza"])
def test_gradient_in_space_is_that_of_the_exact_simulation(study, analysis, topology):
    """Differences of the event-exact simulation, which shares no integrator and no smoothing."""
    spatial = analysis(topology, damper__geometry="spatial")
    design = DESIGNS[topology] | {"I_arm": 4e-6, "c_lambda": 6e4}
    point = spatial.at(design, 40.0, LOAD, gradient=True)

    def exact(design):
        simulator = ExactSimulator(spatial.study, design)
        motion = simulator(40.0, LOAD, spatial.requirement.disturbance, 1.5 * point.time, 1e-11, 4000)
        return decay(motion.time, motion["yaw_angle"], motion["yaw_rate"], CYCLES).ratio

    assert point.ratio == pytest.approx(exact(design), rel=DECAY_RATIO)
    for i, name in enumerate(design):
        up, down = (np.log(exact(design | {name: design[name] * (1 + s * 1e-4)})) for s in (1, -1))
        assert point.gradient[i] == pytest.approx((up - down) / 2e-4, rel=DECAY_GRADIENT, abs=DECAY_GRADIENT), name


def test_engines_agree(analysis):
    """erk where there is a C compiler; without one the default is cvodes."""
    assert best_engine() == ("erk" if has_compiler() else "cvodes")
    points = [
        analysis(solver__engine=engine).at(DESIGNS["arreaza"], 37.0, LOAD, gradient=True)
        for engine in ("erk", "cvodes", "idas")
    ]
    for point in points[1:]:
        assert point.ratio == pytest.approx(points[0].ratio, rel=DECAY_RATIO)
        assert point.gradient == pytest.approx(points[0].gradient, rel=DECAY_GRADIENT, abs=DECAY_GRADIENT)


def test_data_gradient_is_that_of_scipy(analysis):
    design, release = DESIGNS["boeing"], np.deg2rad(2.0)
    found = analysis("boeing", requirements__decay__release={"yaw_angle": release}).data_gradient(design, 40.0, LOAD)
    for key, twin, value in (("gear.caster_length", "e", 0.12), ("tyre.relaxation_length", "sigma", 0.3)):
        h = 1e-4 * value
        up, down = (np.log(scipy_ratio("boeing", design, 40.0, release, **{twin: value + s * h})) for s in (1, -1))
        assert float(found[key][0]) == pytest.approx((up - down) / (2 * h), rel=DECAY_GRADIENT), key


def test_growth_is_the_largest_ratio_and_has_no_gradient(analysis):
    """Hardly any damping at 80 m/s: shimmy; the requirement is missed by as much as the program can say."""
    point = analysis().at(DESIGNS["arreaza"] | {"c_lambda": 100.0}, 80.0, LOAD, gradient=True)
    assert 1.0 < point.ratio <= DIVERGED


def test_creeping_yaw_is_judged_at_the_latest_count(analysis):
    """Damping so large that yaw never completes three cycles: the ratio is read at twice three periods of the yaw mode."""
    design = DESIGNS["arreaza"] | {"c_lambda": 3e6}
    k_psi, c_psi = planar_coefficients("arreaza", **design)
    A = state_matrix(40.0, LOAD, parameters(k_psi=k_psi, c_psi=c_psi))
    latest = 2 * CYCLES * 2 * np.pi / np.sqrt(-A[1, 0])
    tiny = analysis(requirements__decay__release={"yaw_angle": 1e-6})
    point = tiny.at(design, 40.0, LOAD)
    later = [abs((expm(A * t) @ np.eye(5)[:, 0])[0]) for t in np.linspace(latest, 2 * latest, 400)]
    assert point.ratio == pytest.approx(max(later), rel=SAME_WORST)


def test_worst_speed_is_that_of_a_fine_grid(analysis):
    search = analysis("utas")
    worst = search.worst(DESIGNS["utas"])[0]
    fine = max(search.at(DESIGNS["utas"], V, LOAD).ratio for V in np.geomspace(5, 100, 61))
    assert fine * (1 - SAME_WORST) < worst.ratio < fine * (1 + SAME_WORST)


def test_chosen_speeds_are_the_only_ones_looked_at(analysis):
    points = analysis(requirements__decay__speeds=[20.0, 80.0]).worst(DESIGNS["arreaza"])
    assert {p.speed for p in points} == {20.0, 80.0}


def test_a_range_of_loads_is_looked_at_in_five(analysis):
    points = analysis(envelope__vertical_load={"min": 80e3, "max": 160e3}).worst(DESIGNS["arreaza"], refined=False)
    assert {p.load for p in points} == {80e3, 100e3, 120e3, 140e3, 160e3}


def test_another_design_gets_another_answer(analysis):
    """Answers are kept for one design at a time."""
    search, design = analysis(), DESIGNS["arreaza"]
    first = search.at(design, 40.0, LOAD).ratio
    other = search.at(design | {"c_lambda": 2e4}, 40.0, LOAD).ratio
    assert other > 1.2 * first
    assert search.at(design, 40.0, LOAD).ratio == first

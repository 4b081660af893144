"""Numbers of Thota, Krauskopf & Lowenberg (2009), Nonlinear Dynamics 57, and of the first author's own AUTO run.

The 2009 set is Table 0.1 of the thesis with the rake of the source, 9 deg rounded to 0.1571 rad. Numbers are those of section
6 of the theory page, which had them from the equations of the authors' code.
"""

import numpy as np
import pytest
from basic_twin import parameters, state_matrix
from tolerances import half_last_digit, printed

import damperopt

RAKE = 0.1571
EIGENVALUES = [
    (40.0, 150e3, [("1.320", "70.87"), ("-0.203", "100.81")]),
    (175.0, 350e3, [("-0.046", "84.45"), ("0.276", "100.74")]),
    (155.0, 350e3, [("0.134", "84.40"), ("0.336", "100.71")]),
]
"""Speed, load, pairs (real, imaginary part). The theory page prints 70.88 for 70.87: see the test of the twin."""

AUTO_RUN = {"e": 0.16, "c_psi": 110.0, "k_psi": 3.0e5, "phi": 0.2583755, "k_delta": 3.24e6, "c_delta": 1.0, "C_F": 0.01}
AUTO_LOAD = 60e3


@pytest.fixture
def gear_at_rake(main_gear):
    def gear(rake):
        damper = {"topology": "rotational", "torsional_stiffness": 3.8e5, "torsional_damping": 300.0}
        return damperopt.linear_gear(main_gear.replace(damper=damper, gear__rake_angle=rake))

    return gear


@pytest.fixture
def auto_run(main_gear):
    """The parameter set of the AUTO run; what it does not list is as in Table 0.1."""
    study = main_gear.replace(
        damper={
            "topology": "rotational",
            "torsional_stiffness": AUTO_RUN["k_psi"],
            "torsional_damping": AUTO_RUN["c_psi"],
        },
        gear__caster_length=AUTO_RUN["e"],
        gear__rake_angle=AUTO_RUN["phi"],
        gear__lateral__stiffness=AUTO_RUN["k_delta"],
        gear__lateral__damping=AUTO_RUN["c_delta"],
        tyre__cornering_coefficient=AUTO_RUN["C_F"],
    )
    return damperopt.linear_gear(study)


def mode_of(gear, crossing):
    """Name of the mode whose eigenvalue lies on the imaginary axis at a critical speed."""
    table = damperopt.track_modes(gear, np.array([crossing.speed]), crossing.load)
    return table.names[np.abs(table.eigenvalues[0].real).argmin()]


def hopf_speeds(gear, load, mode, low=2.0, high=250.0):
    crossings = [c for c in damperopt.critical_speeds(gear, load, low, high) if c.kind == "hopf"]
    return [c.speed for c in crossings if mode_of(gear, c) == mode]


def oscillating(A):
    """Eigenvalues with a positive imaginary part, slowest first."""
    values = np.linalg.eigvals(A)
    return sorted(values[values.imag > 0], key=lambda value: value.imag)


@pytest.mark.parametrize(
    ("rake", "load", "speeds"),
    [
        (RAKE, 150e3, ["5.612", "93.40"]),
        (0.0, 150e3, ["4.153", "129.08"]),
        (RAKE, 350e3, ["3.725", "169.47"]),
    ],
)
def test_hopf_speeds_of_the_torsional_mode(gear_at_rake, rake, load, speeds):
    assert hopf_speeds(gear_at_rake(rake), load, "torsional") == [printed(speed) for speed in speeds]


def test_torsional_mode_is_unstable_between_its_hopf_speeds(gear_at_rake):
    crossings = damperopt.critical_speeds(gear_at_rake(RAKE), 150e3, 2.0, 250.0)
    assert [(c.destabilising, c.boundary) for c in crossings] == [(True, True), (False, True)]


def test_double_hopf_at_275_kN(gear_at_rake):
    """Torsional and lateral mode cross the axis at one speed, 155.0 m/s to the digits of the source."""
    gear = gear_at_rake(RAKE)
    torsion = hopf_speeds(gear, 275e3, "torsional", low=100.0)
    lateral = hopf_speeds(gear, 275e3, "lateral", low=100.0)
    assert torsion == [printed("155.0")]
    assert lateral == [printed("155.0")]


@pytest.mark.parametrize(("speed", "load", "pairs"), EIGENVALUES)
def test_eigenvalues_at_nine_degrees(gear_at_rake, speed, load, pairs):
    found = oscillating(gear_at_rake(RAKE).matrices(speed, load)[0])
    assert [value.real for value in found] == [printed(real) for real, _ in pairs]
    assert [value.imag for value in found] == [printed(imaginary) for _, imaginary in pairs]


@pytest.mark.parametrize(("speed", "load", "pairs"), EIGENVALUES)
def test_eigenvalues_of_the_twin(speed, load, pairs):
    """The same from a state matrix worked out by hand, so that 70.87 does not rest on the package."""
    found = oscillating(state_matrix(speed, load, parameters(phi=RAKE)))
    assert [value.real for value in found] == [printed(real) for real, _ in pairs]
    assert [value.imag for value in found] == [printed(imaginary) for _, imaginary in pairs]


def test_rake_decides_which_mode_shimmies_at_175_metres_per_second(gear_at_rake):
    """350 kN: the source, with rake, sees the lateral mode alone; rake 0, as the thesis states, leaves torsion unstable."""
    with_rake = oscillating(gear_at_rake(RAKE).matrices(175.0, 350e3)[0])
    without = oscillating(gear_at_rake(0.0).matrices(175.0, 350e3)[0])
    assert [value.real > 0 for value in with_rake] == [False, True]
    assert without[0].real > 0


def test_hopf_speeds_of_the_auto_run(auto_run):
    crossings = damperopt.critical_speeds(auto_run, AUTO_LOAD, 1.0, 200.0)
    assert {c.kind for c in crossings} == {"hopf"}
    assert [c.speed for c in crossings] == [printed("1.43267"), printed("9.76563"), printed("55.7775")]


def test_eigenvalues_of_the_auto_run(auto_run):
    """At a speed that is printed as well: half its last digit moves the eigenvalues, the real one most."""
    speed, width = 19.9656, half_last_digit("19.9656")
    at, beside = (np.sort_complex(np.linalg.eigvals(auto_run.matrices(V, AUTO_LOAD)[0])) for V in (speed, speed + width))
    real_root, second, first = at[0], at[2], at[4]
    of_speed = np.abs(beside - at)
    assert real_root.real == printed("-67.8583", beyond=of_speed[0])
    assert (second.real, second.imag) == (printed("-0.337235", of_speed[2]), printed("73.9189", of_speed[2]))
    assert (first.real, first.imag) == (printed("0.301464", of_speed[4]), printed("58.674", of_speed[4]))


def test_the_twin_has_the_hopf_speeds_of_the_auto_run():
    """The abscissa of the hand-made matrix changes its sign within half the last printed digit of each."""
    p = parameters(**AUTO_RUN)
    for text in ("1.43267", "9.76563", "55.7775"):
        ends = float(text) - half_last_digit(text), float(text) + half_last_digit(text)
        below, above = (np.linalg.eigvals(state_matrix(V, AUTO_LOAD, p)).real.max() for V in ends)
        assert below * above < 0

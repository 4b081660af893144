"""What the text of the thesis says of its transients, Figs 4.11 to 4.20, against the three geometries of the package.

The figures themselves are lost, and with them releases, durations and most damping values; what can be held to the text are
the thresholds, frequencies and tendencies that it states. Each test says whether the text and the numbers agree. Table 0.1 at
150 kN without rake, steel of 200 GPa, L 0.6 m, gamma 31 deg; b 0.15 m unless said otherwise. `published` has the printed
stiffness and damping and no asymmetry at all, `spatial` is the linkage that the thesis had in its multibody model.

In `spatial` the arm of 3.4e-6 m^4 puts the torsional mode at 15 Hz, next to the lateral mode at 16.05 Hz. They couple, and the
fifth-order gear then needs up to 3.2 times the damping of the third-order one.
"""

import numpy as np
import pytest
from basic_twin import E_STEEL, LAYOUT, parameters, planar_coefficients, published_coefficients, spectral_abscissa, state_matrix
from components_of import damper_block
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import brentq
from tolerances import (
    CONVERGENCE_ORDER,
    MIDDLE_OF_EXTREMA,
    ROUNDING,
    SAME_CYCLE_FROM_WITHOUT,
    SAMPLED_HARMONIC,
    SECOND_HARMONIC,
    printed,
)

from damperopt.motion.measure import extrema
from damperopt.motion.simulate import Simulator
from damperopt.motion.trajectory import motion_of
from damperopt.stability.linear import LinearModel

LOAD = 150e3
STEEL = {"youngs_modulus": E_STEEL, "density": 7850.0, "yield_strength": 1e9}
"""E of the thesis; the other two numbers have no part in a motion."""

SLENDER, STIFF = 3.4e-6, 8.3e-6
"""I_arm [m^4] of Figs 4.14 to 4.19, and of Figs 4.16 and 4.20."""

DESIGN = LAYOUT | {"b": 0.15, "I_arm": SLENDER, "k_lambda": 3.8e6}
ELL = LAYOUT["L"] * np.sin(LAYOUT["gamma"])
GEOMETRIES = ["published", "planar", "spatial"]

every_geometry = pytest.mark.parametrize("geometry", GEOMETRIES)


class Gear:
    """Critical damping and motions of a layout; models and motions are made once for all tests."""

    def __init__(self, study):
        self._study, self._models, self._simulators, self._motions = study, {}, {}, {}

    def study(self, topology, geometry, order=5):
        return self._study.replace(damper=damper_block(topology, geometry=geometry), material=STEEL, gear__order=order)

    def abscissa(self, topology, geometry, V, c_lambda, order=5, **changes):
        return spectral_abscissa(self._matrix(topology, geometry, V, c_lambda, order, **changes))

    def frequency(self, topology, geometry, V, c_lambda, **changes):
        """Of the mode other than the lateral one at 16.05 Hz [Hz]."""
        found = np.linalg.eigvals(self._matrix(topology, geometry, V, c_lambda, 5, **changes)).imag / (2 * np.pi)
        return max(found[found > 0], key=lambda f: abs(f - 16.05))

    def critical(self, topology, geometry, V, order=5, **changes):
        """Least c_lambda [N s/m] beyond which the gear is stable; bisection on the spectral abscissa."""

        def at(logarithm):
            return self.abscissa(topology, geometry, V, 10**logarithm, order, **changes)

        return 10 ** brentq(at, 2.0, 5.3, xtol=1e-12)

    def motion(self, topology, geometry, V, c_lambda, release, seconds, **changes):
        design = DESIGN | changes | {"c_lambda": c_lambda}
        key = topology, geometry, *design.values()
        if key not in self._simulators:
            study = self.study(topology, geometry)
            model = self._model(topology, geometry, 5)
            self._simulators[key] = Simulator(study, {name: design[name] for name in model.design_names})
        key += V, release, seconds
        if key not in self._motions:
            self._motions[key] = self._simulators[key[:-3]](V, LOAD, {"release": {"yaw_angle": release}}, seconds)
        return self._motions[key]

    def _model(self, *key):
        if key not in self._models:
            self._models[key] = LinearModel(self.study(*key))
        return self._models[key]

    def _matrix(self, topology, geometry, V, c_lambda, order, **changes):
        model, design = self._model(topology, geometry, order), DESIGN | changes | {"c_lambda": c_lambda}
        return model.at({name: design[name] for name in model.design_names}).matrices(V, LOAD)[0]


@pytest.fixture(scope="module")
def gear(main_gear):
    return Gear(main_gear)


def harmonics(motion):
    """Complex amplitudes of the yaw angle over its last cycle, by order; and the middle of its last two extrema."""
    turns, heights = extrema(motion.time, motion["yaw_angle"], motion["yaw_rate"])
    phase = np.arange(1024) / 1024
    values = CubicHermiteSpline(motion.time, motion["yaw_angle"], motion["yaw_rate"])(
        turns[-3] + phase * (turns[-1] - turns[-3])
    )
    return 2 * np.fft.rfft(values)[:5] / 1024, (heights[-1] + heights[-2]) / 2


def hand_coefficients(topology, geometry, **design):
    """(k_psi, c_psi) by hand; `spatial`: section 3 of the theory, levers ell l_arm/L and 2 b ell/l_arm at rest."""
    if geometry != "spatial":
        return {"published": published_coefficients, "planar": planar_coefficients}[geometry](topology, **design)
    L, b, c_lambda = design["L"], design["b"], design["c_lambda"]
    if topology == "arreaza":
        return 3 * E_STEEL * design["I_arm"] * ELL**2 / L**3, c_lambda * ELL**2
    l_arm = np.hypot(L, b)
    return 3 * E_STEEL * design["I_arm"] / l_arm**3 * (ELL * l_arm / L) ** 2, c_lambda * (2 * b * ELL / l_arm) ** 2


# ------------------------------------------------------------------------------------------------ 4.4.1, Figs 4.11 to 4.13


BOEING_POINTS = {"soft": {"k_lambda": 3.8e6, "c_lambda": 1e3}, "stiff": {"k_lambda": 1e7, "c_lambda": 5e3}}
"""Own choice: the spring of Fig. 3.4 with light damping, and one 2.6 times as stiff, the strut then at 16 Hz."""


@every_geometry
@pytest.mark.parametrize(
    ("k_lambda", "values"), [(3.8e6, ["8.15e3", "4.87e3", "2.56e3"]), (1e7, ["1.438e4", "6.22e3", "3.24e3"])]
)
def test_boeing_needs_less_damping_at_higher_speed(gear, geometry, k_lambda, values):
    """Agrees: 8151, 4868, 2565 N s/m at 40, 80, 160 m/s for 3.8e6 N/m, 14385, 6218, 3241 for 1e7; one for all geometries."""
    found = [gear.critical("boeing", geometry, V, k_lambda=k_lambda) for V in (40.0, 80.0, 160.0)]
    assert found == [printed(value) for value in values]
    assert found == sorted(found, reverse=True)


@pytest.mark.slow
@every_geometry
def test_boeing_soft_spring_shimmies_less_at_higher_speed(gear, geometry):
    """Agrees: limit cycles of 0.209, 0.175, 0.141 rad at 40, 80, 160 m/s; each at least a tenth below the one before."""
    point = BOEING_POINTS["soft"]
    found = [motion_of(gear.motion("boeing", geometry, V, release=0.1, seconds=20.0, **point)) for V in (40.0, 80.0, 160.0)]
    assert [f.kind for f in found] == ["limit cycle"] * 3
    amplitudes = np.array([f.amplitude for f in found])
    assert (amplitudes[1:] < 0.9 * amplitudes[:-1]).all()


@pytest.mark.slow
@every_geometry
def test_boeing_stiff_spring_shimmies_least_at_the_highest_speed_only(gear, geometry):
    """Agrees in part: settles at 160 m/s, but the yaw amplitude is 0.064 rad at 40 and 0.084 to 0.088 rad at 80 m/s.

    At 16 Hz the strut bends along (l_g sin(delta) 0.060 and 0.067 m); the mode is no longer one of yaw alone.
    """
    point = BOEING_POINTS["stiff"]
    at_40, at_80, at_160 = (
        motion_of(gear.motion("boeing", geometry, V, release=0.1, seconds=25.0, **point)) for V in (40.0, 80.0, 160.0)
    )
    assert at_160.kind == "settled"
    assert at_40.kind == at_80.kind == "limit cycle"
    assert at_80.amplitude > 1.2 * at_40.amplitude
    assert at_40.peaks["lateral_displacement"] > 0.05


# ----------------------------------------------------------------------------------------------------- 4.4.2, Fig. 4.14

UTAS_40 = {"published": "8.667e4", "planar": "1.735e4", "spatial": "9.523e4"}
"""Critical c_lambda [N s/m] of UTAS at 40 m/s."""


@every_geometry
def test_critical_damping_of_utas_at_40_metres_per_second(gear, geometry):
    """Fig. 4.14 ends the vibration at 1e5 N s/m: agrees in `published` and `spatial`, in `planar` 1.7e4 will do.

    The twin, with stiffness and damping by hand, changes its side at the critical damping of the package.
    """
    found = gear.critical("utas", geometry, 40.0)
    assert found == printed(UTAS_40[geometry])

    def twin(c_lambda):
        k_psi, c_psi = hand_coefficients("utas", geometry, **(DESIGN | {"c_lambda": c_lambda}))
        return spectral_abscissa(state_matrix(40.0, LOAD, parameters(k_psi=k_psi, c_psi=c_psi)))

    assert twin(found * (1 + 1e-6)) < 0 < twin(found * (1 - 1e-6))


@pytest.mark.parametrize(
    ("geometry", "at_3e4"),
    [("published", False), ("planar", True), ("spatial", False)],
)
def test_utas_at_the_values_of_the_text(gear, geometry, at_3e4):
    """1e5 N s/m is stable, 3e4 not: agrees in `published` and `spatial`; `planar` is stable at both."""
    assert (gear.abscissa("utas", geometry, 40.0, 3e4) < 0) == at_3e4
    assert gear.abscissa("utas", geometry, 40.0, 1e5) < 0


@pytest.mark.parametrize(("b", "dampings", "critical"), [(0.15, "4.37", "5.00"), (0.2, "5.43", "5.63")])
def test_damping_that_the_printed_formula_of_utas_lacks(gear, b, dampings, critical):
    """10 b/R: 4.37 for b 0.15 m of Fig. 4.14, 5.43 for Table 0.1; the critical damping differs a little more, 5.00 and 5.63.

    `planar` is also stiffer, by 3EI in place of 2EI and its lever, so that it needs less about the yaw axis.
    """
    ratio = {g: hand_coefficients("utas", g, **(DESIGN | {"b": b, "c_lambda": 1.0})) for g in ("published", "planar")}
    assert ratio["planar"][1] / ratio["published"][1] == printed(dampings)
    assert 10 * b / np.hypot(ELL, b) == printed(dampings)
    assert gear.critical("utas", "published", 40.0, b=b) / gear.critical("utas", "planar", 40.0, b=b) == printed(critical)
    assert ratio["planar"][0] > ratio["published"][0]


@pytest.mark.parametrize(("topology", "V", "least"), [("utas", 40.0, 3.0), ("utas", 80.0, 2.3), ("arreaza", 40.0, 2.9)])
def test_lateral_mode_is_what_the_spatial_linkage_needs_damping_for(gear, topology, V, least):
    """Fifth over third order: 3.2 (utas, 40), 2.5 (80), 3.0 (arreaza, 40 m/s) in `spatial`, within 2 % of 1 elsewhere."""
    ratio = {g: gear.critical(topology, g, V) / gear.critical(topology, g, V, order=3) for g in GEOMETRIES}
    assert ratio["spatial"] > least
    assert [ratio["published"], ratio["planar"]] == pytest.approx([1.0, 1.0], abs=0.02)


@pytest.mark.slow
@every_geometry
def test_motions_of_utas_on_either_side_of_the_critical_damping(gear, geometry):
    """10 % below: one limit cycle (0.083, 0.090, 0.034 rad), from within and from without; 10 % above: 0.2 rad die out."""
    critical = float(UTAS_40[geometry])
    rate = gear.abscissa("utas", geometry, 40.0, 0.9 * critical)
    within, without = (
        motion_of(gear.motion("utas", geometry, 40.0, 0.9 * critical, start, round(seconds / rate)))
        for start, seconds in ((0.02, 8.0), (0.15, 4.0))
    )
    assert within.amplitude > 1.5 * 0.02
    assert without.amplitude < 0.7 * 0.15
    assert within.amplitude == pytest.approx(without.amplitude, rel=SAME_CYCLE_FROM_WITHOUT)
    rate = gear.abscissa("utas", geometry, 40.0, 1.1 * critical)
    above = motion_of(gear.motion("utas", geometry, 40.0, 1.1 * critical, 0.2, round(6 / -rate)))
    assert above.kind == "settled"


# -------------------------------------------------------------------------------------------------- 4.4.2 and 5.1: asymmetry

GEOMETRIC = -(DESIGN["b"] / (2 * ELL)) * (1 - 1.2 * np.sin(LAYOUT["gamma"]) ** 2)
"""Middle of the extrema over the amplitude squared [1/rad] for UTAS in space: -e2/e1 of the arm deflection e1 psi + e2 psi^2.

The restoring torque eps eps' is as psi + 3 (e2/e1) psi^2, and a weak square beta psi^2 shifts both extrema by -beta A^2/3.
The closed loop gives e1 = ell l/L and e2 = (l/L)(b/2)(1 - (6/5) sin(gamma)^2). The stiffness has no part in it.
"""


def test_vibration_of_utas_leans_to_one_side_in_space(gear):
    """Agrees: extrema of +0.229 and -0.248 rad at 80 m/s, 1e3 N s/m; the larger ones away from the root of the arm."""
    found = motion_of(gear.motion("utas", "spatial", 80.0, 1e3, 0.2, 20.0))
    assert found.kind == "limit cycle"
    assert found.mean / found.amplitude**2 == pytest.approx(GEOMETRIC, rel=MIDDLE_OF_EXTREMA)
    assert found.mean < -0.03 * found.amplitude


@pytest.mark.slow
def test_stiffer_arm_of_utas_leans_as_much(gear):
    """Differs: at 1e3 N s/m the middle of the extrema is 4.0 % of the amplitude for 3.4e-6 and 4.4 % for 8.3e-6 m^4.

    It goes with the square of the amplitude, which the stiffer arm has larger at equal damping (0.258 for 0.239 rad). The text
    holds where the stiffer arm settles: 3e4 N s/m, 1.0 % of 0.059 rad and nothing.
    """
    slender, stiff = (motion_of(gear.motion("utas", "spatial", 80.0, 1e3, 0.2, 20.0, I_arm=I)) for I in (SLENDER, STIFF))
    for found in (slender, stiff):
        assert found.mean / found.amplitude**2 == pytest.approx(GEOMETRIC, rel=MIDDLE_OF_EXTREMA)
    assert abs(stiff.mean) / stiff.amplitude > abs(slender.mean) / slender.amplitude
    slender, stiff = (motion_of(gear.motion("utas", "spatial", 80.0, 3e4, 0.1, 15.0, I_arm=I)) for I in (SLENDER, STIFF))
    assert abs(slender.mean) > 0.005 * slender.amplitude
    assert slender.amplitude > 0.05
    assert stiff.kind == "settled"


@pytest.mark.slow
def test_asymmetry_of_utas_goes_with_the_side_distance(gear):
    """Agrees with 5.1: -0.168, -0.056, -0.022 times the amplitude squared for b 0.15, 0.05, 0.02 m, c_lambda b^2 kept."""
    found = []
    for b in (0.15, 0.05, 0.02):
        motion = motion_of(gear.motion("utas", "spatial", 80.0, 1e3 * (0.15 / b) ** 2, 0.2, 20.0, b=b))
        assert motion.amplitude > 0.2
        found.append(motion.mean / motion.amplitude**2 / b)
    assert found == pytest.approx([GEOMETRIC / 0.15] * 3, rel=MIDDLE_OF_EXTREMA)


@pytest.mark.slow
def test_planar_utas_is_asymmetric_through_its_damper_alone(gear):
    """Differs: the arm's stroke is odd; the damper's lever gives a second harmonic of 1.7e-4, which shifts no extremum.

    c_psi (1 + 2 q psi) psi' with q = ell b/R^2 puts c_psi q A^2 w at 2w on an inertia: c_psi q A/(3 I_z w) of the amplitude.
    """
    c_lambda = 1e4
    motion = gear.motion("utas", "planar", 80.0, c_lambda, 0.15, 30.0)
    found, (h, middle) = motion_of(motion), harmonics(motion)
    _, c_psi = hand_coefficients("utas", "planar", **(DESIGN | {"c_lambda": c_lambda}))
    q = ELL * DESIGN["b"] / (ELL**2 + DESIGN["b"] ** 2)
    expected = c_psi * q * found.amplitude / (3 * parameters().I_z * 2 * np.pi * found.frequency)
    assert abs(h[2] / h[1]) == pytest.approx(expected, rel=SECOND_HARMONIC, abs=SAMPLED_HARMONIC / 4)
    assert abs(middle) < SAMPLED_HARMONIC * found.amplitude


@pytest.mark.slow
@pytest.mark.parametrize(
    ("topology", "geometry"), [("arreaza", "spatial"), ("arreaza", "planar"), ("boeing", "spatial"), ("utas", "published")]
)
def test_vibrations_of_the_other_layouts_are_symmetric(gear, topology, geometry):
    """Agrees: second harmonic below 2e-5 of the first, the error of reading it; UTAS in space has 2e-2."""
    h, _ = harmonics(gear.motion(topology, geometry, 80.0, 1e3, 0.2, 20.0, I_arm=STIFF))
    assert abs(h[2]) < SAMPLED_HARMONIC * abs(h[1])


def test_new_design_in_space_is_symmetric_to_the_third_order(gear):
    """Agrees: the arm's deflection is odd, the damper's stroke but for psi^4, its lever squared but for psi^3."""
    even, odd = [], []
    for psi in (0.05, 0.1):
        plus, minus = (gear.motion("arreaza", "spatial", 80.0, 1e4, sign * psi, 1e-3) for sign in (1, -1))
        assert plus["spring_deflection"][0] == pytest.approx(-minus["spring_deflection"][0], rel=ROUNDING)
        even.append(abs(plus["damper_stroke"][0] + minus["damper_stroke"][0]) / 2)
        odd.append(abs(plus["damper_stroke"][0] - minus["damper_stroke"][0]) / 2)
    assert np.log2(even[1] / even[0]) == pytest.approx(4.0, abs=CONVERGENCE_ORDER)
    assert odd[1] > 1e3 * even[1]


# ---------------------------------------------------------------------------------------------- 4.4.3, Figs 4.17 to 4.20

NEW_80 = {"published": ("3.32e3", "2.12e3"), "planar": ("2.78e3", "1.61e3"), "spatial": ("9.31e3", "4.15e3")}
"""Critical c_lambda [N s/m] of the new design at 80 m/s for the slender and for the stiff arm."""


@every_geometry
def test_critical_damping_of_the_new_design(gear, geometry):
    """Below 1e4 N s/m at 80 m/s, and less for the stiffer arm: agrees in all geometries."""
    found = [gear.critical("arreaza", geometry, 80.0, I_arm=I) for I in (SLENDER, STIFF)]
    assert found == [printed(value) for value in NEW_80[geometry]]
    assert found[1] < found[0] < 1e4
    for I_arm, critical in zip((SLENDER, STIFF), found, strict=True):
        sides = []
        for factor in (1 - 1e-6, 1 + 1e-6):
            k_psi, c_psi = hand_coefficients("arreaza", geometry, **(DESIGN | {"I_arm": I_arm, "c_lambda": factor * critical}))
            sides.append(spectral_abscissa(state_matrix(80.0, LOAD, parameters(k_psi=k_psi, c_psi=c_psi))))
        assert sides[1] < 0 < sides[0]


@pytest.mark.parametrize(("geometry", "ratio"), [("published", "25.7"), ("planar", "6.6"), ("spatial", "5.3")])
def test_utas_needs_several_times_the_damping_of_the_new_design(gear, geometry, ratio):
    """Agrees in all geometries at 80 m/s; the factor is 26 by the printed damping of UTAS, 5 to 7 by the consistent ones."""
    assert gear.critical("utas", geometry, 80.0) / gear.critical("arreaza", geometry, 80.0) == printed(ratio)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("geometry", "slender", "stiff"), [("published", "33.5", "52.2"), ("planar", "40.6", "63.4"), ("spatial", "15.3", "23.5")]
)
def test_frequency_of_the_new_design(gear, geometry, slender, stiff):
    """From about 20 to about 30 Hz: the ratio agrees in all geometries (1.54 to 1.56), the level is nearest in `spatial`.

    It is 15.3 and 23.5 Hz there in limit cycles at 1e3 N s/m, a fifth below the text; 67 % and more above it elsewhere.
    """
    found = [motion_of(gear.motion("arreaza", geometry, 80.0, 1e3, 0.15, 25.0, I_arm=I)) for I in (SLENDER, STIFF)]
    assert [f.frequency for f in found] == [printed(slender), printed(stiff)]
    # the arm alone gives sqrt(8.3/3.4) = 1.562; the tyre adds the same stiffness to both; 30/20 of the text
    assert 1.5 < found[1].frequency / found[0].frequency < np.sqrt(STIFF / SLENDER)
    off = [found[0].frequency / 20 - 1, found[1].frequency / 30 - 1]
    if geometry == "spatial":
        assert -0.25 < min(off) <= max(off) < -0.15
    else:
        assert min(off) > 0.6


def test_linear_frequency_of_the_new_design_in_space(gear):
    """16.2 and 24.2 Hz at the critical damping of either arm: a fifth below the 20 and 30 Hz of the text."""
    found = [
        gear.frequency("arreaza", "spatial", 80.0, float(c), I_arm=I)
        for c, I in zip(NEW_80["spatial"], (SLENDER, STIFF), strict=True)
    ]
    assert found == [printed("16.2"), printed("24.2")]


@every_geometry
def test_ten_newton_seconds_per_metre_is_too_little_for_either_arm(gear, geometry):
    """4.4.3 as printed, differs: unstable at 10 N s/m, growing by 0.76 to 2.7 1/s."""
    assert min(gear.abscissa("arreaza", geometry, 80.0, 10.0, I_arm=I) for I in (SLENDER, STIFF)) > 0.7


@every_geometry
def test_ten_newton_seconds_per_millimetre_is_enough_for_either_arm_to_first_order(gear, geometry):
    """4.4.3 read as 1e4 N s/m: stable with both arms; with the slender one 3.0, 3.6, 1.07 times critical.

    The text is true of damping between the critical values of the two arms: 2.1e3 to 3.3e3, 1.6e3 to 2.8e3, 4.2e3 to 9.3e3.
    """
    slender, stiff = (float(value) for value in NEW_80[geometry])
    assert stiff < slender < 1e4
    assert (1e4 / slender < 1.1) == (geometry == "spatial")
    between = np.sqrt(slender * stiff)
    assert gear.abscissa("arreaza", geometry, 80.0, between, I_arm=STIFF) < 0
    assert gear.abscissa("arreaza", geometry, 80.0, between, I_arm=SLENDER) > 0


def share_left(motion, after):
    """Largest |yaw| in the tenth of a second before a time, over the release."""
    psi = np.abs(motion["yaw_angle"])
    return psi[(motion.time > after - 0.1) & (motion.time <= after)].max() / psi[0]


@pytest.mark.slow
def test_ten_newton_seconds_per_millimetre_in_space_is_enough_for_the_stiff_arm_only(gear):
    """Agrees in `spatial` at large: 0.3 rad end in a limit cycle of 0.059 rad (16.1 Hz) for 3.4e-6, and die out for 8.3e-6.

    After 0.1 rad the slender arm settles too, but a quarter of the angle is left after 3 s, and less than 1 % with the other.
    """
    slender, stiff = (gear.motion("arreaza", "spatial", 80.0, 1e4, 0.3, 60.0, I_arm=I) for I in (SLENDER, STIFF))
    assert motion_of(slender).kind == "limit cycle"
    assert 0.05 < motion_of(slender).amplitude < 0.065
    assert motion_of(stiff).kind == "settled"
    slender, stiff = (gear.motion("arreaza", "spatial", 80.0, 1e4, 0.1, 20.0, I_arm=I) for I in (SLENDER, STIFF))
    assert motion_of(slender).amplitude < 0.1 * 0.1
    assert share_left(slender, 3.0) > 0.2
    assert share_left(stiff, 3.0) < 0.01


@pytest.mark.slow
@pytest.mark.parametrize("geometry", ["published", "planar"])
def test_ten_newton_seconds_per_millimetre_is_enough_for_either_arm_elsewhere(gear, geometry):
    """Differs in `published` and `planar`: 0.3 rad die out with either arm; less than 1 % is left after 4 s."""
    for I_arm in (SLENDER, STIFF):
        assert share_left(gear.motion("arreaza", geometry, 80.0, 1e4, 0.3, 4.0, I_arm=I_arm), 4.0) < 0.01


@pytest.mark.slow
@pytest.mark.parametrize(("geometry", "below_boeing"), [("published", False), ("planar", False), ("spatial", True)])
def test_new_design_vibrates_faster_and_less(gear, geometry, below_boeing):
    """At 80 m/s and 1e3 N s/m; Boeing with 3.8e6 N/m. Agrees in `spatial`; elsewhere less than UTAS, but more than Boeing.

    Boeing, UTAS, new design: 0.175, 0.349, 0.194 rad at 10, 28.5, 33.5 Hz `published`; 0.175, 0.276, 0.199 rad at 9.9, 30.8,
    40.6 Hz `planar`; 0.175, 0.239, 0.166 rad at 10, 14.6, 15.3 Hz `spatial`.
    """
    boeing, utas, new = (
        motion_of(gear.motion(topology, geometry, 80.0, 1e3, release, seconds))
        for topology, release, seconds in (("boeing", 0.1, 20.0), ("utas", 0.2, 20.0), ("arreaza", 0.15, 25.0))
    )
    assert new.frequency > utas.frequency > boeing.frequency
    assert new.amplitude < 0.9 * utas.amplitude
    assert (new.amplitude < 0.97 * boeing.amplitude) == below_boeing


@pytest.mark.slow
@pytest.mark.parametrize(("c_lambda", "less"), [(1e3, False), (5e3, True)])
def test_amplitude_of_the_new_design_with_the_stiffer_arm(gear, c_lambda, less):
    """Much smaller, says 4.4.3: agrees in `spatial` beyond 4.2e3 N s/m, where it settles, and the slender arm does not.

    Differs below: 0.187 rad for 0.166 at 1e3 N s/m.
    """
    slender, stiff = (
        motion_of(gear.motion("arreaza", "spatial", 80.0, c_lambda, 0.15, 20.0, I_arm=I)) for I in (SLENDER, STIFF)
    )
    assert slender.amplitude > 0.06
    assert (stiff.amplitude < 0.1 * slender.amplitude) == less
    assert (stiff.amplitude > 1.05 * slender.amplitude) != less


# --------------------------------------------------------------------------------------------------- 4.4.2, Figs 4.15 and 4.16


@pytest.mark.parametrize(
    ("geometry", "ratios"),
    [("published", ["2.00", "1.46"]), ("planar", ["2.08", "1.53"]), ("spatial", ["4.59", "2.79"])],
)
def test_stiffness_of_the_arm_matters_less_at_high_speed(gear, geometry, ratios):
    """Agrees: critical c_lambda of UTAS, slender over stiff arm, at 40 and 80 m/s; falls on to 160 m/s, but not to 1."""
    found = [
        gear.critical("utas", geometry, V, I_arm=SLENDER) / gear.critical("utas", geometry, V, I_arm=STIFF)
        for V in (40.0, 80.0, 160.0)
    ]
    assert found[:2] == [printed(ratio) for ratio in ratios]
    assert found == sorted(found, reverse=True)
    assert found[-1] > 1

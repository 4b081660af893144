"""Fatigue against the example of ASTM E1049, numbers worked out before, and cycles that are counted by hand."""

import math

import casadi as ca
import numpy as np
import pytest
import rainflow
from tolerances import ROUNDING, half_last_digit

from damperopt.strength.fatigue import (
    Basquin,
    FlightStresses,
    Spectrum,
    counted,
    goodman,
    life_damage,
    life_damage_counted,
    of_cycles,
    of_decaying_sine,
    stress_margin,
    words_of,
)
from damperopt.strength.materials import Material

STEEL = Basquin(1655e6, -0.076, 1172e6)
M = 1 / 0.076


def test_rainflow_counts_the_series_of_astm_e1049():
    series = [-2, 1, -3, 5, -1, 3, -4, 4, -2]
    assert rainflow.count_cycles(series) == [(3, 0.5), (4, 1.5), (6, 0.5), (8, 1.0), (9, 0.5)]


def test_one_cycle_at_the_life_of_basquin():
    """At s = sigma_f' (2N)^b the damage of N cycles is 1."""
    N = 3e5
    assert of_cycles(1655e6 * (2 * N) ** -0.076, N, STEEL) == pytest.approx(1.0, rel=ROUNDING)


def test_goodman_by_hand():
    """100 MPa at a mean of 293 MPa under an ultimate of 1172 MPa: 100/(1 - 1/4)."""
    assert goodman(100e6, 293e6, 1172e6) == pytest.approx(100e6 / 0.75, rel=ROUNDING)
    assert goodman(100e6, -293e6, 1172e6) == 100e6


def decaying(peak, rate, frequency, cycles=40, samples=400):
    t = np.linspace(0, cycles / frequency, cycles * samples + 1)
    return peak * np.exp(rate * t) * np.cos(2 * np.pi * frequency * t)


def test_decaying_sine_by_count_and_bound():
    """490 MPa, 11 Hz, -4.03 1/s: 6.007e-8 by the count, 2.235e-7 by the bound."""
    by_count = counted(decaying(490e6, -4.03, 11.0), STEEL)
    bound = of_decaying_sine(490e6, math.exp(-4.03 / 11), STEEL)
    assert by_count == pytest.approx(6.007e-8, abs=half_last_digit("6.007e-8") * 1.5)
    assert bound == pytest.approx(2.235e-7, abs=half_last_digit("2.235e-7"))


@pytest.mark.parametrize("seed", range(20))
def test_bound_holds(seed):
    rng = np.random.default_rng(seed)
    law = Basquin(rng.uniform(1.2e9, 2.2e9), -rng.uniform(0.06, 0.15), rng.uniform(0.9e9, 1.9e9))
    peak, rate = rng.uniform(0.2, 0.99) * law.ultimate, -(10 ** rng.uniform(-1, 1.2))
    assert counted(decaying(peak, rate, 11.0), law) <= of_decaying_sine(peak, math.exp(rate / 11), law)


@pytest.mark.parametrize("seed", range(20))
def test_bound_of_a_life_holds(seed):
    """Whatever stands beside what in a flight: the count pairs peaks of one event with valleys of another."""
    rng = np.random.default_rng(seed)
    stresses = FlightStresses(*(rng.uniform(50e6, 600e6, 3)), rng.uniform(0.2, 0.95))
    spectrum = Spectrum(turns=float(rng.integers(0, 9)), tows=float(rng.integers(0, 3)), landings=float(rng.integers(0, 3)))
    assert life_damage_counted(stresses, spectrum, STEEL) <= life_damage(stresses, spectrum, STEEL)


def test_life_by_hand():
    """20 000 flights of one turn at 400 MPa to one side, scatter 4: by hand 0 - 400 - 0, amplitude 200 at a mean of 200."""
    spectrum = Spectrum(turns=1.0, tows=0.0, landings=0.0)
    by_hand = 4 * 20000 * 2 * (200 / (1 - 200 / 1172) / 1655) ** M
    found = life_damage_counted(FlightStresses(turn=400e6), spectrum, STEEL)
    assert found == pytest.approx(by_hand, rel=ROUNDING)
    assert life_damage(FlightStresses(turn=400e6), spectrum, STEEL) == pytest.approx(8e4 * 2 * (400 / 1655) ** M, rel=1e-9)


def test_a_simulated_transient_stands_for_the_decaying_sine():
    spectrum = Spectrum(turns=0.0, tows=0.0)
    stresses = FlightStresses(landing=490e6, decay=math.exp(-4.03 / 11))
    by_extrema = life_damage_counted(stresses, spectrum, STEEL)
    by_samples = life_damage_counted(stresses, spectrum, STEEL, transient=decaying(490e6, -4.03, 11.0))
    # extrema of the envelope's cosine are a little before those of its half periods
    assert by_samples == pytest.approx(by_extrema, rel=0.02)


def test_mean_at_the_ultimate_strength_ends_the_life():
    assert counted([0.0, 2400e6, 0.0], STEEL) == math.inf


def test_margin_is_a_factor_on_all_stresses():
    spectrum, stresses = Spectrum(), FlightStresses(200e6, 150e6, 300e6, 0.5)
    factor = 1 + stress_margin(life_damage(stresses, spectrum, STEEL), STEEL)
    scaled = FlightStresses(factor * 200e6, factor * 150e6, factor * 300e6, 0.5)
    assert life_damage(scaled, spectrum, STEEL) == pytest.approx(1.0, rel=1e-10)


def test_symbols_are_taken_as_well():
    turn, tow, landing, decay, b = ca.vertsplit(ca.SX.sym("x", 5))
    law = Basquin(1655e6, b, 1172e6)
    damage = life_damage(FlightStresses(turn, tow, landing, decay), Spectrum(), law)
    function = ca.Function("damage", [turn, tow, landing, decay, b], [damage, stress_margin(damage, law)])
    expected = life_damage(FlightStresses(200e6, 150e6, 300e6, 0.5), Spectrum(), STEEL)
    found = [float(value) for value in function(200e6, 150e6, 300e6, 0.5, -0.076)]
    assert found == pytest.approx([expected, stress_margin(expected, STEEL)], rel=1e-11)


def test_materials_without_data_have_no_law():
    assert Basquin.of(Material.model_validate("CFRP UD")) is None
    assert Basquin.of(Material.model_validate("Ti-6Al-4V")).exponent == -0.104


def test_the_usual_spectrum_is_called_typical():
    assert words_of(Spectrum()).startswith("typical spectrum, of no aircraft: 20000 flights")
    assert "6 turns, 1 tow and 1 landing transient a flight" in words_of(Spectrum())
    assert "1 turn, 0 tows and 2 landing transients" in words_of(Spectrum(turns=1.0, tows=0.0, landings=2.0))
    assert words_of(Spectrum(flights=5e4)).startswith("spectrum as given: 50000 flights")

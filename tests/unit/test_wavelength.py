"""The shortest wave of a motion in contact lengths, and who says it where a result rests on another contact line."""

import math

import numpy as np
import pytest
from memory_twin import F_Z, T, gear, study_text

import damperopt
from damperopt import linear_gear, loads
from damperopt.charts.waves import boundary_wavelength
from damperopt.stability.wavelength import contact_line_words, shortest_wavelength


def study(contact, **changes):
    return loads(study_text(gear(T), contact=contact, **changes))


def optimise_says(of):
    """What the result of one start leaves out."""
    return damperopt.optimise(of.replace(solver__starts=1)).leaves_out


def test_wave_of_the_fastest_mode_that_swings():
    """At 40 m/s the modes of Table 0.1 have 70.763 and 100.870 rad/s; its contact length is 0.2 m."""
    of = study("leading_point")
    wave = shortest_wavelength(of, linear_gear(of), [40.0], [F_Z])
    assert wave.length == pytest.approx(2 * math.pi * 40 / 100.870, rel=1e-5)
    assert wave.contact_lengths == pytest.approx(wave.length / 0.2)
    (words,) = contact_line_words(of, wave)
    assert "2.49 m, 12.5 contact lengths, at 40 m/s and 150 kN; below 16" in words


def test_an_approximation_s_own_roots_are_no_waves():
    """Pade's approximation has roots at -295.6 +- 171.2i 1/s at 20 m/s: they die out within a part of their turn."""
    of = study("{kind: pade, line: von_schlippe}")
    assert np.abs(linear_gear(of).roots([20.0], [F_Z])[0] - (-295.578 + 171.197j)).min() < 0.01
    assert shortest_wavelength(of, linear_gear(of), [20.0], [F_Z]).length == pytest.approx(2 * math.pi * 20 / 100.87, rel=1e-4)


def test_the_exact_line_needs_no_word():
    of = study("memory")
    assert contact_line_words(of, shortest_wavelength(of, linear_gear(of))) == ()


def test_curves_of_a_chart_have_the_wave_of_their_frequency():
    of = study("leading_point")
    record = damperopt.chart(of, ("speed", 5.0, 20.0), ("damper.torsional_damping", 0.0, 1500.0), load=F_Z, tolerance=1e-3)
    wave = boundary_wavelength(of, record)
    points = [(p[0], f) for c in record.families[0].curves for p, f in zip(c.points, c.frequency, strict=True) if f > 0]
    assert wave.contact_lengths == pytest.approx(min(V / f for V, f in points) / 0.2, rel=0.1)
    assert wave.length == pytest.approx(wave.contact_lengths * 0.2)


@pytest.mark.parametrize("contact", ["leading_point", "memory"])
def test_a_result_says_what_it_rests_on(configs, contact):
    of = damperopt.load(configs / "minimal.yaml").replace(tyre__contact=contact)
    said = optimise_says(of)
    assert any("stands for the exact one (tyre.contact memory): the shortest wavelength" in words for words in said) == (
        contact == "leading_point"
    )

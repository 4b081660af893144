"""Tyres of NASA TR R-64 (Smiley and Horne): numbers of an independent prototype, continuity, and the deflection solved back."""

import math

import numpy as np
import pytest
from components_of import tyre_of

import damperopt
from damperopt.expressions.corners import Linear
from damperopt.study.scope import covers

POUND, INCH, PSI = 4.4482216152605, 0.0254, 6894.757293168

# size, pressure psi, load lb: deflection in, a m, K_y N/m, L_y m, N N/rad, K_a N m/rad
TABLE = [
    ("49x17", 170, 20_000, (1.913, 0.2049, 1.1563e6, 0.3708, 5.9970e5, 6.1233e4)),
    ("49x17", 170, 39_600, (3.454, 0.2708, 1.0767e6, 0.5402, 7.3298e5, 1.4137e5)),
    ("18x5.5", 150, 3_000, (0.885, 0.0840, 3.1793e5, 0.1512, 6.2517e4, 2.6032e3)),
    ("18x5.5", 150, 5_000, (1.402, 0.1042, 2.9435e5, 0.1665, 6.6392e4, 4.7899e3)),
]


def tyre(size="49x17", kind="VII", rated=170.0, **more):
    return tyre_of(law="tr_r64", size=size, type=kind, rated_pressure=rated * PSI, **more)


@pytest.mark.parametrize(("size", "psi", "pounds", "expected"), TABLE)
def test_table(size, psi, pounds, expected):
    found, load = tyre(size, rated=psi), pounds * POUND
    N, trail_N, sigma, a = found.linear(load, None)
    more = found.others(load, None)
    values = more["vertical_deflection"] / INCH, a, more["lateral_stiffness"], sigma, N, more["twist_stiffness"]
    assert values == pytest.approx(expected, rel=6e-4)  # half of the last digit that is printed
    assert trail_N == pytest.approx(0.8 * a * N, rel=1e-14)


@pytest.mark.parametrize(("row", "shorter"), list(zip(TABLE, (0.15, 0.24, 0.26, 0.27), strict=True)))
def test_the_other_relaxation_length_is_shorter_as_the_page_says(row, shorter):
    size, psi, pounds, _ = row
    both = [tyre(size, rated=psi, relaxation=which) for which in ("yawed_rolling", "stiffness_ratio")]
    lengths = [found.linear(pounds * POUND, None).relaxation_length for found in both]
    assert 1 - lengths[1] / lengths[0] == pytest.approx(shorter, abs=0.01)
    assert both[0].others(pounds * POUND, None)["stiffness_ratio_length"] == pytest.approx(lengths[1], rel=1e-14)


@pytest.mark.parametrize("kind", ["VII", "III"])
@pytest.mark.parametrize("part", [0.6, 1.0, 1.4])
def test_deflection_solves_the_vertical_law(kind, part):
    """The printed law, load of deflection, at the deflection that was found; on both sides of its break."""
    C_z = {"VII": 0.02, "III": 0.03}[kind]
    p, p_r, w, d = part * 170.0, 170.0, 17.0, 49.0
    found = tyre(kind=kind, pressure=p * PSI)
    for x in (0.1 * C_z, 3 * C_z, 10 / 3 * C_z, 4 * C_z, 0.29):
        f = 0.96 * x + 0.216 * x**2 / C_z if x <= 10 / 3 * C_z else 2.4 * (x - C_z)
        load = f * (p + 0.08 * p_r) * w * math.sqrt(w * d) * POUND
        assert found.others(load, p * PSI)["vertical_deflection"] == pytest.approx(x * w * INCH, rel=1e-12)


def loads_about(found, name, value, quantity):
    """Loads just below and above that at which a quantity has a value, by bisection."""
    low, high = 1.0, 400e3
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if quantity(middle) < value else (low, middle)
    return low * (1 - 1e-9), high * (1 + 1e-9)


@pytest.mark.parametrize("value", [0.03, 0.053, 0.068, 0.0875])
def test_every_piece_goes_on_where_the_last_ends(value):
    """At the breaks in d0/d."""
    found = tyre()
    below, above = loads_about(found, "d0/d", value, lambda F: found.others(F, None)["vertical_deflection"] / (49 * INCH))
    one, other = found.linear(below, None), found.linear(above, None)
    assert tuple(one) == pytest.approx(tuple(other), rel=1e-6)
    twist = [found.others(F, None)["twist_stiffness"] for F in (below, above)]
    assert twist[0] == pytest.approx(twist[1], rel=1e-6)


def test_force_and_moment_by_their_printed_pieces():
    found, load = tyre(), 100e3
    N, _, _, h = found.linear(load, None)
    grip = (0.93 - 0.0011 * 170) * load
    for P in (0.05, 0.1, 0.3, 0.55, 1.0, 1.49, 1.6, 2.5, 3.1):
        alpha = P * grip / N
        F = grip * (P - 4 / 27 * P**3 if P <= 1.5 else 1)
        M = 0.8 * P if P <= 0.1 else P - P**2 - 0.01 if P <= 0.55 else max(0.2925 - 0.1 * P, 0)
        for sign in (1, -1):
            assert found.force(sign * alpha, load, None) == pytest.approx(sign * F, rel=1e-12)
            assert found.moment(sign * alpha, load, None, Linear()) == pytest.approx(sign * M * grip * h, rel=1e-12, abs=1e-9)


def test_pressure_moves_all_of_it():
    low, high = tyre(pressure=140 * PSI), tyre(pressure=170 * PSI)
    assert tyre().linear(1e5, None) == high.linear(1e5, 170 * PSI)
    softer, harder = low.linear(1e5, low.pressure), high.linear(1e5, high.pressure)
    assert softer.half_contact_length > harder.half_contact_length
    assert softer.relaxation_length > harder.relaxation_length


def test_numbers_of_the_study_stand_for_the_estimates():
    found = tyre(half_contact_length=0.2, relaxation_length=0.5, friction=0.6)
    N, trail_N, sigma, a = found.linear(1e5, None)
    assert (sigma, a) == (0.5, 0.2)
    assert trail_N == pytest.approx(0.8 * 0.2 * N)
    assert found.peaks(1e5, None).side_force == pytest.approx(0.6e5)


@pytest.mark.parametrize(
    ("keys", "says"),
    [
        ({"size": "46x17R20"}, "radial"),
        ({"size": "8.50-10", "kind": "III"}, "names no outside diameter"),
        ({"size": "17x49"}, "found a diameter"),
        ({"size": "49 by 17"}, "names no outside diameter"),
        ({"pressure": 300 * PSI}, "of the rated pressure"),
    ],
)
def test_what_the_formulas_do_not_hold_for_is_refused(keys, says):
    with pytest.raises(ValueError, match=says):
        tyre(**keys)


def test_sizes_are_read_as_they_are_written():
    same = [tyre(size=size).linear(1e5, None) for size in ("49x17", "49X17", "49 x 17", "49x17-20")]
    assert len(set(same)) == 1
    named = tyre(size="8.50-10", kind="III", rated=50.0, outside_diameter=25.3 * INCH, width=8.7 * INCH)
    assert named.linear(10e3, None).half_contact_length > 0


def test_a_load_that_flattens_the_tyre_is_refused(configs):
    study = damperopt.load(configs / "nose_gear_thota.yaml")
    block = {"law": "tr_r64", "size": "49x17", "type": "VII", "rated_pressure": 170 * PSI}
    assert study.replace(tyre=block, envelope__vertical_load=150e3).tyre.law == "tr_r64"
    with pytest.raises(damperopt.ConfigError, match=r"350 kN presses a 49x17 tyre flat by 0\.3"):
        study.replace(tyre=block, envelope__vertical_load=350e3)
    kept = study.replace(tyre=block, envelope__vertical_load=150e3)
    with pytest.raises(damperopt.ConfigError, match="presses a 49x17 tyre flat"):
        damperopt.simulate(kept, speed=20.0, load=400e3, disturbance={"kick": {"yaw_rate": 0.1}}, duration=0.1)
    with pytest.raises(damperopt.ConfigError, match="presses a 49x17 tyre flat"):
        damperopt.chart(kept, ("speed", 5.0, 50.0), ("vertical_load", 50e3, 400e3))


def test_a_size_without_a_law_means_this_one(configs):
    text = (configs / "nose_gear_thota.yaml").read_text()
    start, end = text.index("tyre:"), text.index("damper:")
    block = "tyre: {size: 49x17, type: VII, rated_pressure: 170 psi, pressure: 160 psi}\n\n"
    study = damperopt.loads((text[:start] + block + text[end:]).replace("[150 kN, 350 kN]", "150 kN"))
    assert (study.tyre.law, study.tyre.pressure) == ("tr_r64", pytest.approx(160 * PSI))
    assert any("TR R-64" in words for words in covers(study))


def test_certificate_over_loads_agrees_with_eigenvalues(configs):
    """Load by load, and over a range, with memory and without."""
    study = damperopt.load(configs / "nose_gear_thota.yaml")
    block = {"law": "tr_r64", "size": "49x17", "type": "VII", "rated_pressure": 170 * PSI}
    study = study.replace(tyre=block, envelope__vertical_load=[100e3, 150e3], envelope__speed__max=100.0)
    gear, speeds = damperopt.linear_gear(study), np.linspace(2, 100, 400)
    worst = max(gear.abscissa(speeds, load).max() for load in (100e3, 150e3))
    assert damperopt.certify(study, {}, margin=0.0).proved == (worst < 0)
    over_a_range = study.replace(envelope__vertical_load={"min": 1e5, "max": 1.5e5})
    for contact in ("memory", "leading_point"):
        changed = over_a_range.replace(tyre__contact=contact)
        reaches = damperopt.linear_gear(changed).abscissa(np.tile(speeds, 2), np.repeat([1e5, 1.5e5], speeds.size)).max()
        assert damperopt.certify(changed, {}, margin=0.0).verdict == ("proved" if reaches < 0 else "refuted")

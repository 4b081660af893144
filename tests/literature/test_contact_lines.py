"""Contact lines: transfer functions, eigenvalues, critical speeds of an independent prototype, to the digits that it gives."""

from __future__ import annotations

import numpy as np
import pytest
from memory_twin import F_Z, O, S, T, characteristic, gear, matrix, rightmost, study_text

from damperopt import critical_speeds, linear_gear, loads, worst_points
from damperopt.charts.explicit import joint_boundary
from damperopt.tyres.assembly import contact_lines
from damperopt.tyres.base import Linear

a, sigma, c_c = 0.1, 0.3, 1.4e6
STRING = Linear(2 * c_c * (a + sigma) ** 2, 2 * c_c * a * (sigma * (a + sigma) + a**2 / 3), sigma, a)

RESPONSES = {
    2: (278867.839 - 254845.907j, -422830.403 - 637114.766j, 18657.516 - 17372.282j, -39689.544 - 43430.705j),
    8: (-50720.261 - 118243.706j, -1246800.652 - 295609.264j, -535.234 + 15042.550j, -87671.419 + 37606.376j),
    20: (14109.248 - 3814.692j, -1084726.879 - 9536.731j, 39986.298 + 20168.661j, 13632.412 + 50421.652j),
}
"""F/theta, F/eta, M/theta, M/eta at s = i k [1/m]."""


def line(tag, **keys):
    return contact_lines()[tag](contact=tag, **keys)


def study(numbers, contact="memory", **changes):
    return loads(study_text(gear(numbers, **changes), contact=contact))


@pytest.mark.parametrize("k", RESPONSES)
def test_memory_over_path_frequency(k):
    found = line("memory").response(1j * k, STRING)
    assert found == pytest.approx(RESPONSES[k], abs=6e-4)  # three digits after the point are given


@pytest.mark.parametrize(
    ("tag", "force", "moment"),
    [
        ("von_schlippe", (0.0034, 0.067), (0.0001, 0.003)),
        ("parabola", (0.0002, 0.018), (0.0001, 0.003)),
        ("leading_point", (0.037, 0.73), (0.185, 2.10)),
    ],
)
def test_errors_of_approximations(tag, force, moment):
    """Relative, of F/theta and M/theta at k = 2 and 8 1/m, as rounded in print."""
    for k, of_force, of_moment in zip((2, 8), force, moment, strict=True):
        found, exact = line(tag).response(1j * k, STRING), RESPONSES[k]
        for i, printed in ((0, of_force), (2, of_moment)):
            digits = len(str(printed).split(".")[1])
            assert abs(found[i] / exact[i] - 1) == pytest.approx(printed, abs=0.51 * 10.0**-digits)


def test_response_by_integrals_along_the_line():
    """Force and moment of the deflections of a wavy path, by quadrature over the whole string."""
    k = 6.0
    for theta, eta in ((1.0, 0.0), (0.0, 1.0)):
        q1 = (eta + (a + sigma) * theta) / (1 + sigma * 1j * k)
        x, w = np.polynomial.legendre.leggauss(40)
        x, w = a * x, a * w
        v = q1 * np.exp(-1j * k * (a - x)) - eta - x * theta
        v1, v2 = q1 - eta - a * theta, q1 * np.exp(-2j * k * a) - eta + a * theta
        t, weights = np.polynomial.laguerre.laggauss(20)  # outside: v decays over sigma
        outside = sigma * weights
        force = c_c * (w @ v + (v1 + v2) * outside.sum())
        moment = -c_c * (w @ (x * v) + outside @ ((a + sigma * t) * v1 - (a + sigma * t) * v2))
        found = line("memory").response(1j * k, STRING)
        assert found[0 if theta else 1] == pytest.approx(force, rel=1e-12)
        assert found[2 if theta else 3] == pytest.approx(moment, rel=1e-12)


@pytest.mark.parametrize("n", [2, 3, 4, 7])
def test_pade_tends_to_memory_with_its_error(n):
    """|error of E| ~ (n!)^2/((2n)! (2n+1)!) theta^(2n+1): the whole response follows it."""
    from math import factorial

    k = np.array([4.0, 4.8])
    errors = [
        np.abs(np.array(line("pade", order=n).response(1j * x, STRING)) - line("memory").response(1j * x, STRING)) for x in k
    ]
    leading = factorial(n) ** 2 / (factorial(2 * n) * factorial(2 * n + 1)) * (2 * a * k[0]) ** (2 * n + 1)
    assert (errors[0] < 60 * leading * np.abs(RESPONSES[2])).all()
    if n < 5:
        growth = np.log(errors[1] / errors[0]) / np.log(1.2)
        assert growth == pytest.approx(2 * n + 1, abs=2.5)  # E/z and E/z^2 fall by one and two powers, G rises


EIGENVALUES = {
    ("T", 10): (-0.4020135 + 100.9221j, -3.316983 + 64.34719j, -47.94699),
    ("T", 20): (1.271324 + 66.88323j, -0.3342898 + 100.8692j, -81.18842),
    ("T", 40): (1.827369 + 70.16812j, -0.2991516 + 100.8515j, -144.4306),
    ("S", 20): (-0.4827198 + 62.40717j, -10.93754 + 154.1385j, -32.51338),
    ("S", 40): (0.9345564 + 63.61043j, -29.22652 + 144.3984j, -71.26468),
    ("O", 8.75): (-0.052938 + 101.1721j, -15.23984 + 124.9395j, -33.08004),
}
SETS = {"T": T, "S": S, "O": O}


@pytest.mark.parametrize("case", EIGENVALUES, ids=str)
def test_eigenvalues(case):
    name, V = case
    found = linear_gear(study(SETS[name])).roots(V, F_Z)[0]
    upper = found[found.imag > -1e-9]
    assert upper == pytest.approx(np.array(EIGENVALUES[case]), rel=1e-6, abs=1e-6)  # seven digits are given


@pytest.mark.parametrize("V", [0.5, 2.0, 8.75, 60.0])
@pytest.mark.parametrize("phi", [0.0, 0.1571])
@pytest.mark.parametrize("order", [3, 5])
def test_eigenvalues_against_collocation(V, phi, order):
    """The twin's Chebyshev line, and its characteristic function."""
    p = gear(S, phi=phi)
    found = linear_gear(loads(study_text(p, low=0.1, order=order))).roots(V, F_Z)[0]
    others = rightmost(V, F_Z, p, order, nodes=80)[: len(found)]
    for s in found[:3]:
        assert np.abs(others - s).min() < 1e-7 * abs(s)
        step = 1e-4 * (1 + abs(s))
        slope = (characteristic(s + step, V, F_Z, p, order) - characteristic(s - step, V, F_Z, p, order)) / (2 * step)
        assert abs(characteristic(s, V, F_Z, p, order) / slope) < 1e-9 * abs(s)


HOPF = {
    "memory": (15.0745, 24.6194),
    "von_schlippe": (15.0755, 24.6258),
    "parabola": (15.0765, 24.6151),
    "{kind: pade, order: 1, line: von_schlippe}": (14.9725, 24.5535),
    "{kind: pade, order: 2, line: von_schlippe}": (15.0740, 24.6255),
    "leading_point": (4.1527, 16.8797),
    "{kind: pade}": (15.07516, 24.61978),
    "{kind: smiley, order: 1}": (7.109, 20.743),
    "{kind: smiley, order: 2}": (15.833, 25.145),
    "{kind: smiley, order: 3}": (15.0615, 24.582),
    "{kind: smiley, order: 4}": (14.867, 24.537),
}
"""First Hopf speed of T and S [m/s]; series of higher orders have others before, near 24 Hz, of their own making."""


@pytest.mark.parametrize("contact", HOPF)
def test_first_hopf_speeds(contact):
    for numbers, printed in zip((T, S), HOPF[contact], strict=True):
        crossings = critical_speeds(linear_gear(study(numbers, contact)), F_Z, 4.0, 40.0)
        found = next(c for c in crossings if c.destabilising and c.frequency < 12.0)
        digits = len(str(printed).split(".")[1])
        assert found.speed == pytest.approx(printed, abs=0.51 * 10.0**-digits)
        assert found.kind == "hopf"


def test_bands_of_instability():
    """Memory moves both ends: T, T with rake, a stiff damped one that the straight tangent has in another band, S."""
    cases = [
        (T, {}, (15.0745, 127.435)),
        (T, {"phi": 0.1571}, (17.0679, 90.999)),
        (T, {"k_psi": 1.1e6, "c_psi": 2047.7}, (6.963, 22.353)),
    ]
    for numbers, changes, ends in cases:
        found = critical_speeds(linear_gear(study(numbers, **changes)), F_Z, 1.0, 200.0)
        assert [c.speed for c in found] == pytest.approx(list(ends), abs=1e-3)
    assert critical_speeds(linear_gear(study(S)), F_Z, 200.0, 400.0)[0].speed == pytest.approx(302, abs=0.5)


def test_margin_of_a_design_that_the_straight_tangent_proves():
    memory, tangent = (linear_gear(study(O, contact)) for contact in ("memory", "leading_point"))
    assert worst_points(tangent, study(O).envelope)[0].abscissa == pytest.approx(-0.2287, abs=5e-5)
    worst = worst_points(memory, study(O).envelope)[0]
    assert (worst.speed, worst.abscissa) == pytest.approx((8.67, -0.052901), abs=5e-3)
    assert worst.abscissa == pytest.approx(-0.052901, abs=5e-7)
    lost = critical_speeds(memory, F_Z, 5.0, 100.0, margin=0.1)
    assert [c.speed for c in lost] == pytest.approx([6.18304, 11.94381], abs=5e-6)


def test_a_gear_that_the_straight_tangent_calls_stable():
    changes = {"e": 0.1655, "k_psi": 229210.0, "c_psi": 734.48, "k_delta": 4.63257e6, "c_delta": 32.98, "I_z": 45.105}
    changes |= {"sigma": 0.135}
    c_c, s = 2.96296e6, 0.135
    tyre = {"C_F": 2 * c_c * (s + a) ** 2, "C_M": 2 * c_c * a * (s * (s + a) + a**2 / 3)}
    found = [linear_gear(study(T | tyre, contact, **changes)).abscissa(7.5, F_Z)[0] for contact in ("leading_point", "memory")]
    assert found == pytest.approx([-7.9482, 0.16469], abs=5e-5)


CRITICAL_DAMPING = {
    ("T", "leading_point"): (433.5, 824.2, 1006.3, 806.8, 482.9, 334.7, 254.6),
    ("T", "memory"): (None, None, 612.5, 718.4, 468.6, 330.2, 252.7),
    ("S", "leading_point"): (213.7, 476.6, 601.3, 478.6, 283.0, 195.4, 148.5),
    ("S", "memory"): (None, 108.8, 479.2, 452.6, 279.0, 194.2, 147.9),
}
"""c_psi [N m s/rad] of the third-order gear at the speeds below; none is needed where it is None."""
SPEEDS = (5.0, 10.0, 20.0, 40.0, 80.0, 120.0, 160.0)


@pytest.mark.parametrize("case", CRITICAL_DAMPING, ids=str)
def test_critical_damping_of_the_third_order_gear(case):
    name, contact = case
    p = gear(SETS[name])
    yaw = loads(study_text(p, contact=contact, order=3))
    for V, printed in zip(SPEEDS, CRITICAL_DAMPING[case], strict=True):
        frequencies = np.linspace(9.0, 14.0, 20_001)
        k, c = joint_boundary(yaw, V, F_Z, frequencies)
        found = np.interp(p.k_psi, k[np.argsort(k)], c[np.argsort(k)])
        if printed is None:
            assert found < 0
        else:
            assert found == pytest.approx(printed, abs=0.06)


def test_moreland():
    """S at 40 m/s: the prototype's roots, and the straight tangent without contact length as tau goes to 0."""
    moreland = "{kind: moreland, lateral_stiffness: 1.12e6, time_constant: 2.5e-3}"
    text = study_text(gear(S), contact=moreland).replace("relaxation_length: 0.3, ", "")
    text = text.replace(f"aligning_stiffness: {S['C_M']!r}", "aligning_stiffness: 0")
    found = linear_gear(loads(text)).roots(40.0, F_Z)[0]
    expected = np.array([0.0855007 + 63.1739j, -30.9241 + 147.702j, -71.8564, -270.109])
    assert found[found.imag > -1e-9] == pytest.approx(expected, abs=6e-4)

    quick = linear_gear(loads(text.replace("2.5e-3", "1e-6"))).roots(40.0, F_Z)[0]
    point = study_text(gear(S, a=1e-6, sigma=0.4, C_M=0.0), contact="leading_point")
    tangent = linear_gear(loads(point)).roots(40.0, F_Z)[0]
    assert np.sort_complex(quick[:5]) == pytest.approx(np.sort_complex(tangent), rel=1e-3)
    assert np.abs(tangent - (-23.418 - 137.771j)).min() < 6e-4


def test_twin_agrees_with_its_collocation():
    """The twin's own two ways: rounding of 40 points against Newton's method on D."""
    p = gear(T)
    for V in (5.0, 20.0, 40.0):
        coarse, fine = (np.sort_complex(np.linalg.eigvals(matrix(V, F_Z, p, nodes=n)))[::-1][:4] for n in (16, 60))
        assert coarse == pytest.approx(fine, abs=1e-8)

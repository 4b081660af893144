"""Margins of safety against numbers worked by hand."""

import math

import casadi as ca
import numpy as np
import pytest
from scipy.linalg import eigh
from tolerances import ROUNDING

from damperopt.strength.fatigue import Basquin
from damperopt.strength.margins import (
    Column,
    Lug,
    Margin,
    bolt_margin,
    column_margins,
    column_stress,
    critical,
    euler_load,
    fatigue_margin,
    lug_margins,
    margin_of_safety,
    stress_margins,
    wall_buckling_stress,
)
from damperopt.strength.materials import Material

STEEL = Material.model_validate("AISI 4340")
LAMINATE = Material.model_validate("CFRP UD")


def of(margins, check):
    (found,) = [margin for margin in margins if margin.check == check]
    return found


def test_margin_by_hand():
    """500 MPa allowed, 200 MPa applied, factor 2: 500/400 - 1."""
    assert margin_of_safety(500e6, 200e6, 2.0) == pytest.approx(0.25)
    assert margin_of_safety(500e6, 600e6) == pytest.approx(-1 / 6)
    assert margin_of_safety(500e6, 0.0) == math.inf


def test_stress_of_a_metal_and_of_a_laminate():
    """4340 at 700 MPa: 1103/700 - 1 and 1172/1050 - 1; laminate at 300 MPa: 630/450 - 1."""
    metal = stress_margins("arm", "side_load", 700e6, STEEL)
    assert [(m.check, m.level) for m in metal] == [("yield", "limit"), ("rupture", "ultimate")]
    assert [m.value for m in metal] == pytest.approx([403 / 700, 122 / 1050])
    assert of(stress_margins("arm", "side_load", 700e6, STEEL, (1.5, 1.5)), "yield").value == pytest.approx(53 / 1050)
    (laminate,) = stress_margins("arm", "side_load", 300e6, LAMINATE)
    assert (laminate.check, laminate.value) == ("design strain", pytest.approx(0.4))


def test_euler_load_is_the_least_eigenvalue_of_a_pinned_beam():
    """Beam elements with geometric stiffness: least P of det(K - P G) = 0, rotations free and ends held."""
    E, I, length, n = 207e9, 7.4e-8, 0.494, 40
    h = length / n
    k = E * I / h**3 * np.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h**2, -6 * h, 2 * h**2]] * 2)
    k[2:] = E * I / h**3 * np.array([[-12, -6 * h, 12, -6 * h], [6 * h, 2 * h**2, -6 * h, 4 * h**2]])
    g = np.array([[36, 3 * h, -36, 3 * h], [3 * h, 4 * h**2, -3 * h, -(h**2)]] * 2) / (30 * h)
    g[2:] = np.array([[-36, -3 * h, 36, -3 * h], [3 * h, -(h**2), -3 * h, 4 * h**2]]) / (30 * h)
    K, G = np.zeros((2, 2 * n + 2, 2 * n + 2))
    for i in range(n):
        K[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += k
        G[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += g
    free = [i for i in range(2 * n + 2) if i not in (0, 2 * n)]
    largest = eigh(G[np.ix_(free, free)], K[np.ix_(free, free)], eigvals_only=True)[-1]
    assert euler_load(E, I, length) == pytest.approx(1 / largest, rel=1e-6)


def test_column_by_hand():
    """Leg of 225 mm^2, tube t/d 0.1, 0.494 m: d^2 = A/(pi 0.09), I = A d^2 0.82/8, Euler 205 kN at 912 MPa: Johnson governs."""
    area, length = 225e-6, 0.494
    diameter = math.sqrt(area / (math.pi * 0.09))
    inertia = area * diameter**2 * (1 + 0.8**2) / 16
    euler = math.pi**2 * 207e9 * inertia / length**2
    stress = euler / area
    expected = stress if stress < 1103e6 / 2 else 1103e6 * (1 - 1103e6 / (4 * stress))
    column = Column(area, inertia, length, 0.45 * diameter, 0.1 * diameter)
    found = column_margins("leg", "side_load", 60e3, column, STEEL)
    assert of(found, "column").value == pytest.approx(expected / (1.5 * 60e3 / area) - 1)
    assert of(found, "wall").value > 10  # a wall of a tenth yields long before it buckles
    assert len(column_margins("rod", "side_load", 60e3, Column(area, inertia, length), STEEL)) == 1


def test_johnson_meets_euler_with_its_slope():
    half = 1103e6 / 2
    below, at, above = (column_stress(half * factor, 1103e6) for factor in (1 - 1e-4, 1.0, 1 + 1e-4))
    assert at == pytest.approx(half, rel=ROUNDING)
    assert above - at == pytest.approx(at - below, rel=1e-3)
    assert column_stress(1e15, 1103e6) == pytest.approx(1103e6, rel=1e-5)
    assert column_stress(100e6, 1103e6) == 100e6


@pytest.mark.parametrize(
    ("load", "ratio", "gamma"),
    # 1 - 0.901 (1 - exp(-sqrt(r/t)/16)) and 0.731 in bending, exp(-0.625) = 0.5352614, exp(-0.3125) = 0.7316157
    [("axial", 100.0, 0.581271), ("axial", 25.0, 0.758186), ("bending", 100.0, 0.660276)],
)
def test_wall_buckling_by_hand(load, ratio, gamma):
    """Classical 0.605 E t/r at nu 0.3, times the knock-down."""
    found = wall_buckling_stress(70e9, 0.1, 0.1 / ratio, 0.3, load)
    assert found == pytest.approx(gamma * 0.605228 * 70e9 / ratio, rel=2e-6)


def test_lug_by_hand():
    """20 kN, D 16, t 10, W 40, e 26 mm: bearing 125, shear-out 20/(2 10 18) = 55.56, net tension 83.33 MPa."""
    found = lug_margins("lug", "side_load", 20e3, Lug(0.016, 0.010, 0.040, 0.026), STEEL)
    assert of(found, "bearing").value == pytest.approx(1172 / (1.5 * 125) - 1)
    assert of(found, "shear-out").value == pytest.approx(1172 / math.sqrt(3) / (1.5 * 20e3 / 360) - 1)
    assert of(found, "net tension").value == pytest.approx(1172 / (1.5 * 20e3 / 240) - 1)
    fitted = lug_margins("lug", "side_load", 20e3, Lug(0.016, 0.010, 0.040, 0.026), STEEL, (1.5, 1.15))
    assert of(fitted, "bearing").value == pytest.approx(1172 / (1.5 * 1.15 * 125) - 1)
    given = STEEL.model_copy(update={"bearing_ultimate_strength": 1600e6, "shear_ultimate_strength": 700e6})
    asked = lug_margins("lug", "side_load", 20e3, Lug(0.016, 0.010, 0.040, 0.026), given)
    assert of(asked, "bearing").value == pytest.approx(1600 / 187.5 - 1)
    assert of(asked, "shear-out").value == pytest.approx(700 / (1.5 * 20e3 / 360) - 1)


def test_pin_in_double_shear_by_hand():
    """20 kN on 16 mm: 10 kN on 201.06 mm^2 is 49.74 MPa."""
    found = bolt_margin("pin", "side_load", 20e3, 0.016, STEEL)
    assert found.applied == pytest.approx(49.736e6, rel=1e-4)
    assert found.value == pytest.approx(1172 / math.sqrt(3) / (1.5 * 49.7359) - 1, rel=1e-5)


def test_fatigue_margin_is_on_stress():
    """A hundredth of the life at m = 10 leaves 100^(1/10) - 1 = 0.585 on stress."""
    assert fatigue_margin("arm", 0.01, Basquin(1e9, -0.1, 1e9)).value == pytest.approx(0.58489, rel=1e-5)


def test_critical_margin_of_each_part():
    margins = [
        Margin("arm", "yield", "turning", "limit", 2.0, 3.0),
        Margin("arm", "rupture", "side_load", "ultimate", 2.0, 4.5, 1.5),
        Margin("arm", "yield", "side_load", "limit", 2.0, 2.5),
        Margin("link", "column", "side_load", "ultimate", 2.0, 2.7, 1.5),
    ]
    assert [(m.part, m.check, m.case) for m in critical(margins)] == [
        ("link", "column", "side_load"),
        ("arm", "yield", "side_load"),
    ]
    assert str(critical(margins)[0]) == "link, column at ultimate load, side_load: MS -0.10"


def test_more_load_is_never_more_margin():
    sizes = Column(225e-6, 1.8e-8, 0.494, 0.013, 0.0028)
    for check in (
        lambda F: column_margins("leg", "", F, sizes, STEEL),
        lambda F: lug_margins("lug", "", F, Lug(0.016, 0.010, 0.040, 0.026), STEEL),
        lambda F: [bolt_margin("pin", "", F, 0.016, STEEL)],
        lambda F: stress_margins("arm", "", F / 225e-6, STEEL),
    ):
        for less, more in zip(check(20e3), check(26e3), strict=True):
            assert more.value <= less.value


def test_symbols_are_taken_as_well():
    F, A, I, length, r, t, D = ca.vertsplit(ca.SX.sym("x", 7))
    values = (60e3, 225e-6, 1.8e-8, 0.494, 0.013, 0.0028, 0.016)

    def everything(F, A, I, length, r, t, D):
        margins = [
            *column_margins("leg", "", F, Column(A, I, length, r, t), STEEL),
            *lug_margins("lug", "", F, Lug(D, 0.6 * D, 3 * D, 1.6 * D), STEEL),
            bolt_margin("pin", "", F, D, STEEL),
            *stress_margins("arm", "", F / A, STEEL),
        ]
        return [margin.value for margin in margins]

    found = ca.Function("margins", [F, A, I, length, r, t, D], everything(F, A, I, length, r, t, D))(*values)
    assert [float(value) for value in found] == pytest.approx(everything(*values), rel=ROUNDING)

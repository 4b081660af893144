"""Cross-section families: shape numbers against areas and moments integrated over the section itself."""

from itertools import pairwise

import casadi as ca
import numpy as np
import pytest
from scipy.integrate import quad
from tolerances import QUADRATURE, ROUNDING

from damperopt.ports.section import Section
from damperopt.strength.sections import area, area_for_modulus, fibre_distance, section_modulus, shape_numbers

FAMILIES = {
    "solid_round": Section(family="solid_round"),
    "tube": Section(family="tube", thickness_ratio=0.1),
    "thin_tube": Section(family="tube", thickness_ratio=0.02),
    "rectangle": Section(family="rectangle", aspect_ratio=2.5),
    "flat_rectangle": Section(family="rectangle", aspect_ratio=0.4),
    "i_section": Section(family="i_section", aspect_ratio=2.0, thickness_ratio=0.05),
    "wide_i_section": Section(family="i_section", aspect_ratio=0.8, thickness_ratio=0.1),
}


@pytest.fixture(params=FAMILIES)
def section(request):
    return FAMILIES[request.param]


def width_at(section, height, z):
    """Width of material at a distance z from the neutral axis, of the member of the given height."""
    if section.family in ("solid_round", "tube"):
        radius = height / 2
        bore = radius - height * section.thickness_ratio if section.family == "tube" else 0.0
        return 2 * np.sqrt(radius**2 - z**2) - 2 * np.sqrt(max(bore**2 - z**2, 0.0))
    flange = height / section.aspect_ratio
    if section.family == "i_section" and abs(z) < height / 2 - height * section.thickness_ratio:
        return height * section.thickness_ratio
    return flange


def edges(section, height):
    """Distances at which the width has a kink or a jump."""
    ratio = section.thickness_ratio or 0.0
    return [0.0, height / 2 - height * ratio, height / 2] if ratio else [0.0, height / 2]


def integrated(section, height):
    """Area and second moment of area by quadrature over strips."""
    pieces = list(pairwise(edges(section, height)))
    A = sum(2 * quad(lambda z: width_at(section, height, z), *piece, epsabs=0)[0] for piece in pieces)
    I = sum(2 * quad(lambda z: z**2 * width_at(section, height, z), *piece, epsabs=0)[0] for piece in pieces)
    return A, I


@pytest.mark.parametrize("height", [0.02, 0.3])
def test_area_and_fibre_distance_are_those_of_the_drawn_section(section, height):
    A, I = integrated(section, height)
    assert area(section, I) == pytest.approx(A, rel=QUADRATURE)
    assert fibre_distance(section, I) == pytest.approx(height / 2, rel=QUADRATURE)
    assert section_modulus(section, I) == pytest.approx(I / (height / 2), rel=QUADRATURE)


def test_solid_round_by_hand():
    """40 mm: A = pi d^2/4 = 1256.637 mm^2, I = pi d^4/64 = 125663.7 mm^4, Z = pi d^3/32 = 6283.185 mm^3."""
    section = FAMILIES["solid_round"]
    assert area(section, 125663.7) == pytest.approx(1256.637, rel=1e-6)
    assert fibre_distance(section, 125663.7) == pytest.approx(20.0, rel=1e-6)
    assert section_modulus(section, 125663.7) == pytest.approx(6283.185, rel=1e-6)


def test_tube_by_hand():
    """40 mm with a wall of 4 mm: A = pi 36 4 = 452.3893 mm^2, I = pi (40^4 - 32^4)/64 = 74191.85 mm^4."""
    assert area(FAMILIES["tube"], 74191.85) == pytest.approx(452.3893, rel=1e-6)
    assert fibre_distance(FAMILIES["tube"], 74191.85) == pytest.approx(20.0, rel=1e-6)


def test_rectangle_by_hand():
    """50 mm high, 20 mm wide: A = 1000 mm^2, I = 20 50^3/12 = 208333.3 mm^4, Z = 20 50^2/6 = 8333.333 mm^3."""
    section = FAMILIES["rectangle"]
    assert area(section, 208333.33) == pytest.approx(1000.0, rel=1e-6)
    assert section_modulus(section, 208333.33) == pytest.approx(8333.333, rel=1e-6)


def test_i_section_by_hand():
    """200 mm high, 100 mm wide, 10 mm throughout: A = 3800 mm^2, I = (100 200^3 - 90 180^3)/12 = 22.92667e6 mm^4."""
    section = FAMILIES["i_section"]
    assert area(section, 22.92666667e6) == pytest.approx(3800.0, rel=1e-6)
    assert fibre_distance(section, 22.92666667e6) == pytest.approx(100.0, rel=1e-6)


def test_thickest_tube_is_a_solid_round():
    almost = Section(family="tube", thickness_ratio=0.4999999)
    assert shape_numbers(almost) == pytest.approx(shape_numbers(FAMILIES["solid_round"]), rel=1e-6)


def test_i_section_with_a_web_as_wide_as_the_flange_would_be_a_rectangle():
    almost = Section(family="i_section", aspect_ratio=2.5, thickness_ratio=0.3999999999)
    assert shape_numbers(almost) == pytest.approx(shape_numbers(FAMILIES["rectangle"]), rel=1e-6)


def test_shape_is_kept_at_every_size(section):
    """Twice the height: four times the area, eight times the modulus, sixteen times the second moment."""
    I = 3.4e-6
    assert area(section, 16 * I) == pytest.approx(4 * area(section, I), rel=ROUNDING)
    assert fibre_distance(section, 16 * I) == pytest.approx(2 * fibre_distance(section, I), rel=ROUNDING)
    assert section_modulus(section, 16 * I) == pytest.approx(8 * section_modulus(section, I), rel=ROUNDING)


def test_area_for_modulus_undoes_the_section_modulus(section):
    for I in (1e-8, 3.4e-6, 1e-4):
        assert area_for_modulus(section, section_modulus(section, I)) == pytest.approx(area(section, I), rel=ROUNDING)


def test_hollow_sections_need_less_area_for_the_same_stiffness():
    I = 3.4e-6
    by_area = sorted(FAMILIES, key=lambda name: area(FAMILIES[name], I))
    assert by_area.index("thin_tube") < by_area.index("tube") < by_area.index("solid_round")
    assert by_area.index("i_section") < by_area.index("rectangle") < by_area.index("flat_rectangle")


def test_expressions_of_casadi_are_taken_as_well(section):
    I = ca.SX.sym("I")
    found = ca.Function("of_section", [I], [area(section, I), fibre_distance(section, I), section_modulus(section, I)])
    expected = (area(section, 3.4e-6), fibre_distance(section, 3.4e-6), section_modulus(section, 3.4e-6))
    assert tuple(float(value) for value in found(3.4e-6)) == pytest.approx(expected, rel=ROUNDING)

"""Materials: what the library says of its numbers, allowables by hand, and a user's own with their sources."""

import casadi as ca
import pytest

import damperopt
from damperopt.strength.materials import (
    MATERIALS,
    Material,
    allowable_stress,
    bearing_strength,
    shear_strength,
    ultimate_stress,
    words_about,
)

STEEL = Material.model_validate("AISI 4340")
LAMINATE = Material.model_validate("CFRP UD")
TABLE_9_1 = {"AISI 4340": (1103, 1172, 1758, -0.0977), "Ti-6Al-4V": (1185, 1233, 2030, -0.104)}
"""Yield, ultimate, sigma_f' [MPa] and b as Dowling prints them."""


@pytest.mark.parametrize("name", TABLE_9_1)
def test_numbers_are_those_of_the_table_that_is_named(name):
    material = Material.model_validate(name)
    yields, ruptures, coefficient, exponent = TABLE_9_1[name]
    found = material.yield_strength, material.ultimate_strength, material.fatigue_strength_coefficient
    assert found == (yields * 1e6, ruptures * 1e6, coefficient * 1e6)
    assert material.fatigue_exponent == exponent
    assert "Table 9.1" in material.source_of("yield_strength").source


def test_stress_life_of_4340_goes_through_published_tests():
    """Smooth specimens at mean zero (Dowling, Table E9.1): amplitude [MPa] and cycles; tests scatter."""
    for amplitude, cycles in ((948, 222), (834, 992), (703, 6004), (631, 14130), (579, 43860), (524, 132150)):
        stress = STEEL.fatigue_strength_coefficient * (2 * cycles) ** STEEL.fatigue_exponent
        assert stress == pytest.approx(amplitude * 1e6, rel=0.05)


@pytest.mark.parametrize("name", MATERIALS)
def test_every_number_of_the_library_has_a_source_and_is_called_typical(name):
    material = Material.model_validate(name)
    for key in material.numbers:
        source = material.source_of(key)
        assert source.source
        assert source.basis == "typical"
    (words,) = words_about([material, material])
    assert words.startswith(f"Typical values, no design allowables: {name}, youngs_modulus")


def test_allowables_by_hand():
    """4340: 1103 over 1.0 and 1172 over 1.5 at limit load; over 1.5 both, yield is the less."""
    assert allowable_stress(STEEL, 1.0) == pytest.approx(1172e6 / 1.5)
    assert allowable_stress(STEEL, 1.5) == pytest.approx(1103e6 / 1.5)
    assert allowable_stress(STEEL, 1.0, ultimate_factor=1.0) == 1103e6
    assert allowable_stress(LAMINATE, 3.0) == pytest.approx(140e9 * 0.0045 / 1.5)
    assert shear_strength(STEEL) == pytest.approx(676.65e6, rel=1e-4)
    assert bearing_strength(STEEL) == 1172e6


def test_without_an_ultimate_strength_the_yield_strength_stands_for_it():
    plain = Material(youngs_modulus=70e9, density=2700.0, yield_strength=300e6)
    assert ultimate_stress(plain) == 300e6
    assert allowable_stress(plain, 1.0) == pytest.approx(200e6)


def test_symbols_are_taken_as_well():
    E, rupture, yields, limit, ultimate = ca.vertsplit(ca.SX.sym("x", 5))
    steel = Material.model_construct(
        **{**dict(STEEL), "youngs_modulus": E, "ultimate_strength": rupture, "yield_strength": yields}
    )
    function = ca.Function("allowable", [rupture, yields, limit, ultimate], [allowable_stress(steel, limit, ultimate)])
    assert float(function(1172e6, 1103e6, 1.0, 1.5)) == pytest.approx(1172e6 / 1.5)
    assert float(function(1172e6, 1103e6, 1.6, 1.5)) == pytest.approx(1103e6 / 1.6)


OWN = """
material:
  name: our steel
  youngs_modulus: 205 GPa
  density: 7850 kg/m^3
  yield_strength: 1517 MPa
  ultimate_strength: 1862 MPa
  basis: S
  specification: AMS 6417, bar
  sources:
    youngs_modulus: {basis: typical, source: handbook}
"""


def test_own_allowables_with_their_basis(configs):
    text = (configs / "minimal.yaml").read_text()
    material = damperopt.loads(text + OWN).material
    assert material.source_of("yield_strength").basis == "S"
    assert material.source_of("youngs_modulus").source == "handbook"
    assert words_about([material]) == [
        "Typical values, no design allowables: our steel, youngs_modulus.",
    ]
    bare = damperopt.loads(text + OWN.replace("  basis: S\n", "")).material
    assert "Values of no stated basis: our steel, density, yield_strength, ultimate_strength." in words_about([bare])


@pytest.mark.parametrize(
    ("old", "new", "where", "says"),
    [
        ("basis: S", "basis: C", "material.basis", "'C' is not one of the choices"),
        ("1862 MPa", "1400 MPa", "material.ultimate_strength", "less than yield_strength"),
        ("youngs_modulus: {basis", "stiffness: {basis", "material.sources.stiffness", "is no number of this material"),
        ("{basis: typical,", "{base: typical,", "material.sources.youngs_modulus.base", "did you mean 'basis'"),
    ],
)
def test_what_is_wrong_is_said_once(configs, old, new, where, says):
    assert old in OWN
    with pytest.raises(damperopt.ConfigError) as error:
        damperopt.loads((configs / "minimal.yaml").read_text() + OWN.replace(old, new))
    (problem,) = error.value.problems
    assert f": {where}: " in problem
    assert says in problem

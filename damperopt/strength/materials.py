"""Materials: a record with where each of its numbers comes from, and a library of typical ones.

No number of the library is a statistical design allowable: all have the basis "typical" and say so in every result. For a
part that is certified the allowables of its specification are written into the study, with their own basis and source.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Any, Literal, Self

from pydantic import GetJsonSchemaHandler, model_validator
from pydantic_core import CoreSchema

from ..expressions.calculus import Expr, where
from ..quantities.record import Density, Name, Record, Stress, refuse
from ..quantities.units import Quantity
from ..reading import quoted

__all__ = [
    "MATERIALS",
    "Material",
    "Source",
    "allowable_stress",
    "bearing_strength",
    "shear_strength",
    "ultimate_stress",
    "words_about",
]

_DOWLING_9_1 = {"basis": "typical", "source": "Dowling, Mechanical Behavior of Materials, Table 9.1 (smooth, axial, mean zero)"}
_DOWLING_14_1 = {"basis": "typical", "source": "Dowling, Mechanical Behavior of Materials, Table 14.1"}
_ELASTIC = {"basis": "typical", "source": "handbooks; batches differ by a few per cent"}

MATERIALS: dict[str, dict[str, Any]] = {
    "300M": {
        "youngs_modulus": 205e9,
        "density": 7850.0,
        "yield_strength": 1586e6,
        "ultimate_strength": 1931e6,
        "basis": "typical",
        "source": "230 and 280 ksi, as quoted for AMS 6257 and 6419; AMS 6417 has minima of 1517 and 1862 MPa",
        "sources": {"youngs_modulus": _ELASTIC, "density": _ELASTIC},
    },
    "AISI 4340": {
        "youngs_modulus": 207e9,
        "density": 7830.0,
        "yield_strength": 1103e6,
        "ultimate_strength": 1172e6,
        "fatigue_strength_coefficient": 1758e6,
        "fatigue_exponent": -0.0977,
        **_DOWLING_9_1,
        "specification": "aircraft quality, quenched and tempered",
        "sources": {"youngs_modulus": _ELASTIC, "density": _ELASTIC},
    },
    "Ti-6Al-4V": {
        "youngs_modulus": 117e9,
        "density": 4430.0,
        "yield_strength": 1185e6,
        "ultimate_strength": 1233e6,
        "fatigue_strength_coefficient": 2030e6,
        "fatigue_exponent": -0.104,
        **_DOWLING_9_1,
        "specification": "solution treated and aged",
        "sources": {"youngs_modulus": _ELASTIC, "density": _ELASTIC},
    },
    "Ti-10V-2Fe-3Al": {
        "youngs_modulus": 107e9,
        "density": 4650.0,
        "yield_strength": 1170e6,
        "ultimate_strength": 1250e6,
        "basis": "typical",
        "source": "solution treated and aged; above the minima of AMS 4984, 1103 and 1193 MPa",
        "sources": {"youngs_modulus": _ELASTIC, "density": _ELASTIC},
    },
    "Al 7075-T6": {
        "youngs_modulus": 71e9,
        "density": 2810.0,
        "yield_strength": 469e6,
        "ultimate_strength": 578e6,
        "fatigue_strength_coefficient": 1466e6,
        "fatigue_exponent": -0.143,
        **_DOWLING_14_1,
        "sources": {"youngs_modulus": _ELASTIC, "density": _ELASTIC},
    },
    "CFRP UD": {
        "youngs_modulus": 140e9,
        "density": 1580.0,
        "design_strain": 0.0045,
        "basis": "typical",
        "source": "carbon and epoxy along the fibre; a design strain of 0.45 % at ultimate load, before any tests of the part",
    },
}
"""Young's modulus and strengths [Pa], density [kg/m^3], at room temperature."""


class Source(Record):
    """Where a number comes from."""

    basis: Literal["A", "B", "S", "typical", "not stated"] = "not stated"
    """A: exceeded by 99 % of all parts, B: by 90 %, with 95 % confidence; S: minimum of a specification; typical: a mean."""
    specification: Name | None = None
    """Material specification, form and heat treatment."""
    source: Name | None = None
    """Handbook, table, test report."""
    temperature: Name = "room temperature"
    """At which it holds, in words."""


class Material(Source):
    """Material of a part; a name from the library or the numbers.

    Metals carry `yield_strength`; a laminate carries `design_strain` instead, and its allowable is E times that strain.
    """

    name: Name = "custom"
    """Of the material, for tables."""
    youngs_modulus: Stress
    """E [Pa]."""
    density: Density
    """Mass per volume [kg/m^3]."""
    yield_strength: Stress | None = None
    """Of a metal [Pa]."""
    ultimate_strength: Stress | None = None
    """Of a metal, at rupture [Pa]; left out: its yield strength."""
    shear_ultimate_strength: Stress | None = None
    """In shear, at rupture [Pa]; left out: 1/sqrt(3) of ultimate_strength."""
    bearing_ultimate_strength: Stress | None = None
    """Of a lug under its pin [Pa]; left out: ultimate_strength, which handbooks exceed by a third or more."""
    design_strain: Annotated[float, Quantity("1", above=0, below=0.1)] | None = None
    """Of a laminate, at ultimate load: its allowable stress is E times this [1]."""
    poissons_ratio: Annotated[float, Quantity("1", at_least=0, below=0.5)] = 0.3
    """For the buckling of walls [1]."""
    fatigue_strength_coefficient: Stress | None = None
    """sigma_f' of Basquin's law [Pa]."""
    fatigue_exponent: Annotated[float, Quantity("1", above=-1, below=0)] | None = None
    """b of Basquin's law, negative [1]."""
    sources: dict[Name, Source] = {}  # noqa: RUF012  # frozen, and copied by pydantic
    """Of numbers that come from elsewhere than the rest, by their key."""

    @model_validator(mode="before")
    @classmethod
    def _named(cls, data: Any) -> Any:
        if isinstance(data, str):
            if data not in MATERIALS:
                raise refuse("", f"{quoted(data)} is no known material", ", ".join(MATERIALS) + ", or the numbers as a mapping")
            return {"name": data, **MATERIALS[data]}
        if not isinstance(data, (dict, Material)):
            raise refuse("", f"found {quoted(data)}", ", ".join(MATERIALS) + ", or the numbers as a mapping")
        return data

    @model_validator(mode="after")
    def _complete(self) -> Self:
        if (self.yield_strength is None) == (self.design_strain is None):
            raise refuse("", "neither or both of yield_strength and design_strain", "exactly one of them")
        if (self.fatigue_strength_coefficient is None) != (self.fatigue_exponent is None):
            raise refuse("", "half a Basquin law", "fatigue_strength_coefficient and fatigue_exponent together, or neither")
        numbers = self.numbers
        for key in self.sources:
            if key not in numbers:
                raise refuse(f"sources.{key}", f"{quoted(key)} is no number of this material", ", ".join(numbers))
        return self

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if self.yield_strength and self.ultimate_strength and self.ultimate_strength < self.yield_strength:
            raise refuse("ultimate_strength", "less than yield_strength", "yield_strength, or more")
        return self

    @property
    def numbers(self) -> tuple[str, ...]:
        """Keys of the numbers that it has."""
        given = (
            key for key in type(self).model_fields if key not in (*Source.model_fields, "name", "sources", "poissons_ratio")
        )
        return tuple(key for key in given if getattr(self, key) is not None)

    @property
    def has_fatigue_data(self) -> bool:
        return self.fatigue_exponent is not None

    def source_of(self, key: str) -> Source:
        """Where a number comes from: its own source, or that of the material."""
        return self.sources.get(key) or Source(**{name: getattr(self, name) for name in Source.model_fields})

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"anyOf": [{"enum": list(MATERIALS)}, handler.resolve_ref_schema(handler(schema))]}


def words_about(materials: Iterable[Material]) -> list[str]:
    """What a result says about the numbers of its materials: a sentence for each that holds more than A, B and S values.

    Parameters
    ----------
    materials : iterable of Material

    Examples
    --------
    >>> words_about([Material.model_validate("CFRP UD")])
    ['Typical values, no design allowables: CFRP UD, youngs_modulus, density, design_strain.']
    """
    found: dict[str, None] = {}
    for material in materials:
        bases = {key: material.source_of(key).basis for key in material.numbers}
        for basis, words in (("typical", "Typical values, no design allowables"), ("not stated", "Values of no stated basis")):
            if keys := [key for key, its in bases.items() if its == basis]:
                found[f"{words}: {material.name}, {', '.join(keys)}."] = None
    return list(found)


def allowable_stress(material: Any, limit_factor: Expr, ultimate_factor: Expr = 1.5) -> Expr:
    """Largest stress at limit load that keeps yield at limit and rupture at ultimate load away [Pa].

    Parameters
    ----------
    material : Material
        Floats or symbols.
    limit_factor : Expr
        On yield strength at limit load.
    ultimate_factor : Expr
        Ultimate over limit load; on ultimate strength, and on the design strain of a laminate.
    """
    if material.design_strain is not None:
        return ultimate_stress(material) / ultimate_factor
    against_yield, against_rupture = material.yield_strength / limit_factor, ultimate_stress(material) / ultimate_factor
    return where(against_yield < against_rupture, against_yield, against_rupture)


def ultimate_stress(material: Any) -> Expr:
    """Stress that a part may have at ultimate load [Pa]: rupture of a metal, the design strain of a laminate."""
    if material.design_strain is not None:
        return material.youngs_modulus * material.design_strain
    return material.yield_strength if material.ultimate_strength is None else material.ultimate_strength


def shear_strength(material: Any) -> Expr:
    """In shear at ultimate load [Pa]; by the energy of distortion where it is not given."""
    given = material.shear_ultimate_strength
    return ultimate_stress(material) / 3**0.5 if given is None else given


def bearing_strength(material: Any) -> Expr:
    """Of a lug under its pin, force over diameter and thickness, at ultimate load [Pa]."""
    given = material.bearing_ultimate_strength
    return ultimate_stress(material) if given is None else given

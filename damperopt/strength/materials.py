"""Materials: a record, and a library of room-temperature design values; a config may write the numbers out instead."""

from __future__ import annotations

from typing import Annotated, Any, Self

from pydantic import GetJsonSchemaHandler, model_validator
from pydantic_core import CoreSchema

from ..quantities.record import Density, Name, Record, Stress, refuse
from ..quantities.units import Quantity
from ..reading import quoted

__all__ = ["MATERIALS", "Material", "allowable_stress"]

# Young's modulus and strengths in Pa, density in kg/m^3. Sources: MMPDS-class handbook values for the metals
# (300M and 4340 at the quoted heat treatments, Ti-6Al-4V solution treated and aged); Basquin sigma_a = sigma_f' (2N)^b
# from strain-life tables, given only where published for that condition. CFRP: laminate along the fibre, sized by a
# design strain limit of 0.45 % instead of a yield stress.
MATERIALS: dict[str, dict[str, Any]] = {
    "300M": {"youngs_modulus": 205e9, "density": 7850.0, "yield_strength": 1586e6, "ultimate_strength": 1931e6},
    "AISI 4340": {
        "youngs_modulus": 207e9,
        "density": 7830.0,
        "yield_strength": 1103e6,
        "ultimate_strength": 1172e6,
        "fatigue_strength_coefficient": 1655e6,
        "fatigue_exponent": -0.076,
    },
    "Ti-6Al-4V": {
        "youngs_modulus": 117e9,
        "density": 4430.0,
        "yield_strength": 1185e6,
        "ultimate_strength": 1233e6,
        "fatigue_strength_coefficient": 2030e6,
        "fatigue_exponent": -0.104,
    },
    "Ti-10V-2Fe-3Al": {"youngs_modulus": 107e9, "density": 4650.0, "yield_strength": 1170e6, "ultimate_strength": 1250e6},
    "Al 7075-T6": {
        "youngs_modulus": 71e9,
        "density": 2810.0,
        "yield_strength": 469e6,
        "ultimate_strength": 578e6,
        "fatigue_strength_coefficient": 1466e6,
        "fatigue_exponent": -0.143,
    },
    "CFRP UD": {"youngs_modulus": 140e9, "density": 1580.0, "design_strain": 0.0045},
}


class Material(Record):
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
    """Of a metal, at rupture [Pa]."""
    design_strain: Annotated[float, Quantity("1", above=0, below=0.1)] | None = None
    """Of a laminate: its allowable stress is E times this [1]."""
    fatigue_strength_coefficient: Stress | None = None
    """sigma_f' of Basquin's law [Pa]."""
    fatigue_exponent: Annotated[float, Quantity("1", above=-1, below=0)] | None = None
    """b of Basquin's law, negative [1]."""

    @model_validator(mode="before")
    @classmethod
    def _named(cls, data: Any) -> Any:
        if isinstance(data, str):
            if data not in MATERIALS:
                raise refuse("", f"{quoted(data)} is no known material", ", ".join(MATERIALS) + ", or the numbers as a mapping")
            return {"name": data, **MATERIALS[data]}
        return data

    @model_validator(mode="after")
    def _complete(self) -> Self:
        if (self.yield_strength is None) == (self.design_strain is None):
            raise refuse("", "neither or both of yield_strength and design_strain", "exactly one of them")
        if (self.fatigue_strength_coefficient is None) != (self.fatigue_exponent is None):
            raise refuse("", "half a Basquin law", "fatigue_strength_coefficient and fatigue_exponent together, or neither")
        return self

    @property
    def has_fatigue_data(self) -> bool:
        return self.fatigue_exponent is not None

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"anyOf": [{"enum": list(MATERIALS)}, handler.resolve_ref_schema(handler(schema))]}


def allowable_stress(material: Any, safety_factor: Any) -> Any:
    """Allowable stress at the limit event [Pa]: yield over the safety factor, or E times the design strain."""
    if material.design_strain is not None:
        return material.youngs_modulus * material.design_strain
    return material.yield_strength / safety_factor

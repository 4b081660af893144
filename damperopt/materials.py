"""Named materials: room-temperature design values, each overridable in a config by writing the numbers out."""

from __future__ import annotations

from typing import Any

__all__ = ["MATERIALS"]

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

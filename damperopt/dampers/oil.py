"""Oil over temperature: viscosity by Walther's equation, density, and the damping that a damper keeps of them.

log10 log10(nu + 0.7) = A - B log10(T), nu in mm^2/s (cSt), T in K, from two points (ASTM D341). What of the damping is a
laminar leak goes with the viscosity nu; what is an orifice goes with the density rho alone:

    c(T)/c(T_0) = f nu(T)/nu(T_0) + (1 - f) rho(T)/rho(T_0).

Source: Walther (1931), in the form of ASTM D341; the points of the default are typical of oils to MIL-PRF-5606.
"""

from __future__ import annotations

import math
from typing import Annotated, Self

from pydantic import model_validator

from ..quantities.record import Record, refuse
from ..quantities.temperature import ZERO_CELSIUS
from ..quantities.units import Quantity

__all__ = ["SHOWN", "Oil", "damping_factor", "orifice_area"]

SHOWN = tuple(ZERO_CELSIUS + celsius for celsius in (-54.0, 20.0, 70.0))
"""Temperatures at which damping is reported [K]."""

SHIFT = 0.7
"""Added to the viscosity in Walther's equation [mm^2/s]."""

FIXED = ZERO_CELSIUS + 40.0, ZERO_CELSIUS + 100.0
"""Where the viscosity of an oil is given [K]."""

_Viscosity = Annotated[float, Quantity("m^2/s", above=2e-7, below=1e-2, example="13.5 mm^2/s")]


class Oil(Record):
    """Fluid of the damper by its viscosity at 40 and 100 degC; left out, an oil of the class MIL-PRF-5606 (typical)."""

    viscosity_40: _Viscosity = 13.5e-6
    """Kinematic, at 40 degC [m^2/s]; 1 mm^2/s is 1 cSt."""
    viscosity_100: _Viscosity = 5.0e-6
    """At 100 degC [m^2/s]."""
    expansion: Annotated[float, Quantity("1/K", at_least=0, at_most=3e-3, example="8e-4 1/K")] = 8e-4
    """Of the volume per kelvin, about the reference temperature [1/K]; typical of mineral oils."""

    @model_validator(mode="after")
    def _thins(self) -> Self:
        if not self.viscosity_40 > self.viscosity_100:
            raise refuse(
                "viscosity_100", f"{self.viscosity_100:g} m^2/s is not below viscosity_40", "an oil that thins with heat"
            )
        return self

    def viscosity(self, temperature: float) -> float:
        """Kinematic viscosity [m^2/s] at a temperature [K].

        Examples
        --------
        >>> [round(1e6 * Oil().viscosity(273.15 + t), 1) for t in (-54, 20, 70)]
        [522.8, 21.7, 7.7]
        """
        W_40, W_100 = (math.log10(math.log10(1e6 * nu + SHIFT)) for nu in (self.viscosity_40, self.viscosity_100))
        B = (W_40 - W_100) / math.log10(FIXED[1] / FIXED[0])
        W = W_40 - B * math.log10(temperature / FIXED[0])
        return 1e-6 * (10 ** (10**W) - SHIFT)


def damping_factor(oil: Oil, temperature: float, reference: float, laminar_fraction: float) -> float:
    """c(T)/c(T_0).

    Parameters
    ----------
    oil : Oil
    temperature, reference : float
        T and T_0 [K].
    laminar_fraction : float
        f, what of the damping at T_0 is a laminar leak.

    Examples
    --------
    >>> round(damping_factor(Oil(), 273.15 - 54, 293.15, 0.2), 3)
    5.663
    """
    thickened = oil.viscosity(temperature) / oil.viscosity(reference)
    denser = 1 - oil.expansion * (temperature - reference)
    return laminar_fraction * thickened + (1 - laminar_fraction) * denser


def orifice_area(damping: float, area: float, rate: float, density: float, discharge: float = 0.65) -> float:
    """Area of an orifice whose first harmonic is a viscous damping, (8/(3 pi)) c_2 v with c_2 = rho A^3/(2 C_d^2 A_o^2) [m^2].

    Parameters
    ----------
    damping : float
        [N s/m]
    area : float
        Of the piston [m^2].
    rate : float
        v, amplitude of a sinusoidal rate of the stroke [m/s].
    density : float
        [kg/m^3]
    discharge : float
        C_d [1]; 0.65 is typical of a sharp edge.
    """
    return math.sqrt(4 * density * area**3 * rate / (3 * math.pi * damping)) / discharge

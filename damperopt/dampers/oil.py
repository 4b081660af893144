"""Oil of a damper at a temperature: viscosity over temperature, and what it makes of the damping."""

from __future__ import annotations

import math
from typing import Annotated, Self

from pydantic import model_validator

from ..expressions.calculus import Expr, exp, log
from ..quantities.record import Record, refuse
from ..quantities.units import Quantity

__all__ = ["Oil", "damping_factor"]

Temperature = Annotated[float, Quantity("K", at_least=200, at_most=450, example="233 K")]
Viscosity = Annotated[float, Quantity("m^2/s", above=1e-6, at_most=0.1, example="1.4e-5 m^2/s")]

WALTHER = 0.7
"""Added to the viscosity in mm^2/s by ASTM D341, so that one line fits all temperatures."""


class Oil(Record):
    """Oil of the damper at one temperature; damping is given at the reference temperature."""

    temperature: Temperature
    """T, of this study [K]."""
    reference_temperature: Temperature = 293.15
    """T_0, at which the damping is what the design says [K]."""
    laminar_fraction: Annotated[float, Quantity("1", at_least=0, at_most=1, example="0.2")] = 0.2
    """f, of the damping that is in proportion to the viscosity, typical of an orifice with a leak [1]."""
    viscosity_at_40_degrees: Viscosity = 1.35e-5
    """Kinematic, at 313.15 K; typical of a hydraulic fluid [m^2/s]."""
    viscosity_at_100_degrees: Viscosity = 5.0e-6
    """Kinematic, at 373.15 K; typical of a hydraulic fluid [m^2/s]."""
    expansion: Annotated[float, Quantity("1/K", at_least=0, at_most=0.002, example="8e-4 1/K")] = 8e-4
    """Of the volume, by which the density falls; typical [1/K]."""

    @model_validator(mode="after")
    def _thins(self) -> Self:
        if not self.viscosity_at_100_degrees < self.viscosity_at_40_degrees:
            raise refuse("viscosity_at_100_degrees", "not below that at 40 degrees", "an oil that is thinner when it is hot")
        return self

    def viscosity(self, temperature: Expr) -> Expr:
        """Kinematic viscosity [m^2/s] by ASTM D341, log log(nu + 0.7) = A - B log(T) with nu in mm^2/s, through both points.

        Parameters
        ----------
        temperature : Expr
            [K]

        Examples
        --------
        >>> oil = Oil(temperature=293.15)
        >>> [round(1e6 * oil.viscosity(273.15 + degrees), 2) for degrees in (-54, -40, 20, 70, 135)]
        [522.8, 219.42, 21.71, 7.71, 3.37]
        """
        low, high = (log(log(1e6 * nu + WALTHER)) for nu in (self.viscosity_at_40_degrees, self.viscosity_at_100_degrees))
        slope = (high - low) / math.log(373.15 / 313.15)
        return 1e-6 * (exp(exp(low + slope * log(temperature / 313.15))) - WALTHER)

    def factor(self, temperature: Expr = None) -> Expr:
        """f nu(T)/nu(T_0) + (1 - f) rho(T)/rho(T_0).

        Parameters
        ----------
        temperature : Expr or None
            [K]; None: that of the study.
        """
        T, f = self.temperature if temperature is None else temperature, self.laminar_fraction
        thin = self.viscosity(T) / self.viscosity(self.reference_temperature)
        return f * thin + (1 - f) * (1 - self.expansion * (T - self.reference_temperature))


def damping_factor(oil: Oil | None, temperature: Expr = None) -> Expr:
    """Damping over that of the design; 1 without an oil.

    Parameters
    ----------
    oil : Oil or None
    temperature : Expr or None
        [K]; None: that of the oil.
    """
    return 1 if oil is None else oil.factor(temperature)

"""Oil of a damper at a temperature: viscosity over temperature, and what it makes of the damping."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Self

from pydantic import Discriminator, Field, Tag, model_validator
from pydantic.config import JsonDict

from ..expressions.calculus import Expr, exp, log
from ..quantities.record import Number, Pressure, Record, refuse
from ..quantities.temperature import ZERO_CELSIUS, Temperature, TemperatureRange
from ..quantities.units import Quantity
from .base import Damper

__all__ = ["SHOWN", "VAPOUR_PRESSURE", "Oil", "Oiled", "damping_factor", "orifice_area"]

SHOWN = tuple(ZERO_CELSIUS + celsius for celsius in (-54.0, 20.0, 70.0))
"""Temperatures at which damping is reported [K]."""

_Temperatures = Annotated[
    Annotated[TemperatureRange, Tag("<range>")] | Annotated[Temperature, Tag("<number>")],
    Discriminator(lambda data: "<range>" if isinstance(data, (dict, TemperatureRange)) else "<number>"),
]
_TWO: JsonDict = {"minItems": 2, "maxItems": 2}
Viscosity = Annotated[float, Quantity("m^2/s", above=1e-6, at_most=0.1, example="1.4e-5 m^2/s")]

WALTHER = 0.7
"""Added to the viscosity in mm^2/s by ASTM D341, so that one line fits all temperatures."""


class Oil(Record):
    """Oil of the damper at one temperature, or over a range of them; damping is given at the reference temperature."""

    temperature: _Temperatures = Field(examples=["233 K"])
    """T, of this study, or the range at all of which the requirements hold [K]."""
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

    @model_validator(mode="after")
    def _refers(self) -> Self:
        given, T_0 = self.temperature, self.reference_temperature
        if isinstance(given, TemperatureRange) and not given.min <= T_0 <= given.max:
            raise refuse("reference_temperature", f"{T_0:g} K", f"within the range, {given.min:g} to {given.max:g} K")
        return self

    @property
    def span(self) -> TemperatureRange | None:
        """The range of temperatures, where there is one."""
        return self.temperature if isinstance(self.temperature, TemperatureRange) else None

    def constants(self) -> tuple[str, ...]:
        """All of them where the damping is an interval: its ends are numbers of the proof."""
        return tuple(type(self).model_fields) if self.span else ()

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
            [K]; None: that of the study, of a range the reference.
        """
        if temperature is None and self.span:
            return 1.0
        T: Expr = self.temperature if temperature is None else temperature
        f = self.laminar_fraction
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


VAPOUR_PRESSURE = 1e3
"""Of hydraulic oil, absolute; typical [Pa]."""


class Oiled(Damper):
    """What dampers with oil have in common: its temperature, and an interval of dampings that the requirements survive."""

    oil: Oil | None = None
    """Its temperature; left out: that at which the damping is given."""
    damping_range: list[Number] | None = Field(None, examples=[[0.5, 2.0]], json_schema_extra=_TWO)
    """Least and largest factor on the damping at which the requirements hold, such as [0.5, 2]; comes before the oil's."""

    charge_pressure: Pressure | None = None
    """Of both chambers at rest, absolute, by which cavitation is judged [Pa]; left out: it is not looked at."""
    vapour_pressure: Annotated[float, Quantity("Pa", at_least=0, example="1 kPa")] | None = None
    """Of the oil, absolute, below which it boils [Pa]; left out: 1 kPa, which is typical."""

    @model_validator(mode="after")
    def _uncertain(self) -> Self:
        found = self.damping_range
        if found is not None and not (len(found) == 2 and found[0] < found[1] and found[0] <= 1 <= found[1]):
            allowed = "two factors on the damping, the first below the second, with 1 among them or between them"
            raise refuse("damping_range", f"found {found}", allowed)
        return self

    def swept(self, design: Mapping[str, Expr]) -> Expr | None:
        """Area of the piston [m^2], or displacement of the vanes [m^3/rad]; None: what the working pressure asks of a force.

        Parameters
        ----------
        design : mapping of str to Expr
            Design variables by name [SI].
        """
        return self.piston(design)

    def damping_factors(self) -> tuple[float, float]:
        """Ends of `damping_range`, or what the oil makes at the hot and the cold end of its range."""
        if self.damping_range is not None:
            return self.damping_range[0], self.damping_range[1]
        if self.oil is None or self.oil.span is None:
            return 1.0, 1.0
        return float(self.oil.factor(self.oil.span.max)), float(self.oil.factor(self.oil.span.min))

    def damping_by_temperature(self) -> dict[float, float]:
        """At the temperatures of `SHOWN`."""
        return {} if self.oil is None else {T: float(self.oil.factor(T)) for T in SHOWN}

    def orifice_share(self) -> float | None:
        """What of the damping at the reference temperature is no laminar leak [1]."""
        return None if self.oil is None else 1 - self.oil.laminar_fraction


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

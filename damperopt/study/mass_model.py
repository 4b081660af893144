"""Numbers of the mass model, with their documented defaults."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import model_validator

from ..ports.section import Section
from ..quantities.record import Coordinate, Density, Distance, Fraction, Length, Record, Stress, refuse
from ..quantities.units import Quantity
from ..strength.materials import Material, allowable_stress

__all__ = ["MassModel"]

_TUBE = Section(family="tube", thickness_ratio=0.1)


LEAST_EDGE = 1.5
"""Edge distance over bore from which on bearing strengths hold."""

_Ratio = Annotated[float, Quantity("1", above=0, example="0.6")]


class LugModel(Record):
    """Eyes at the ends of links, arm and support, in parts of the outer size of the section; typical proportions."""

    bore: _Ratio = 0.6
    """Of the pin [1]."""
    thickness: _Ratio = 0.6
    """[1]"""
    width: _Ratio = 1.4
    """[1]"""
    edge: _Ratio = 0.95
    """From the middle of the bore to the free end, at least 1.5 bores [1]."""
    fitting_factor: Annotated[float, Quantity("1", at_least=1)] = 1.15
    """On ultimate loads of lugs; 1.15 is usual [1]."""

    @model_validator(mode="after")
    def _bearing_strengths_hold(self) -> Self:
        if self.edge < LEAST_EDGE * self.bore * (1 - 1e-9):
            what = f"{self.edge:g} is {self.edge / self.bore:.3g} bores, for which no bearing strength holds"
            raise refuse("edge", what, f"{LEAST_EDGE:g} bores ({LEAST_EDGE * self.bore:g}), or more")
        if self.width <= self.bore:
            raise refuse("width", f"{self.width:g} leaves nothing beside the bore", f"more than the bore, {self.bore:g}")
        return self


class MassModel(Record):
    """Numbers of the mass model; the defaults suit a main gear and are explained in the documentation."""

    arm_section: Section = _TUBE
    """Cross-section of the bending arm."""
    link_section: Section = _TUBE
    """Cross-section of the torque links."""
    support_section: Section = _TUBE
    """Cross-section of the support arm."""
    hinge_section: Section = _TUBE
    """Cross-section of the beams between the feet of torque links and support."""
    cantilever_taper: Annotated[float, Quantity("1", above=0, at_most=1)] = 0.6
    """Mass of a tapered link or support over the prismatic one; 3/5 is exact for uniform stress in one shape."""
    link_fittings_fraction: Fraction = 0.2
    """Lugs, pins and bushings, as a fraction of the mass of links, bending arm and support arm."""
    damper_material: Material = Material.model_validate("AISI 4340")
    """Cylinder, rod, caps and Belleville spring; a metal."""
    working_pressure: Stress = 20.7e6
    """Peak damper pressure at the limit event [Pa] (3000 psi)."""
    dead_length: Length = 0.12
    """Damper length that is not stroke: eyes, glands, piston [m]."""
    bulk_modulus: Stress = 1.0e9
    """Effective, of the oil with its air and hoses [Pa]."""
    chamber_dead_length: Length = 0.02
    """Length of each chamber that the piston does not sweep [m]."""
    wall_allowance: Distance = 2e-3
    """Added to the wall and caps that pressure needs [m]."""
    lug: LugModel = LugModel()
    """Eyes and pins, for their margins of safety."""
    proof_factor: Annotated[float, Quantity("1", at_least=1)] = 1.5
    """Proof pressure over the peak pressure at limit load [1]."""
    burst_factor: Annotated[float, Quantity("1", at_least=1)] = 2.0
    """Burst pressure over the peak pressure at limit load [1]."""
    least_rod_diameter: Length = 0.012
    """Thinnest rod that is made [m]."""
    rod_buckling_factor: Annotated[float, Quantity("1", at_least=1)] = 2.0
    """Euler load of the rod over the largest damper force, at least [1]."""
    oil_density: Density = 860.0
    """Of the damper fluid [kg/m^3]."""
    damper_fittings_fraction: Fraction = 0.5
    """Eyes, seals, valve and bearings, as a fraction of cylinder, rod and caps."""
    damper_fixed_mass: Annotated[float, Quantity("kg", at_least=0, example="1 kg")] = 1.0
    """Reservoir, valve, thermal compensator: what no size of the damper changes; a typical figure, of elastic dampers alone."""
    spring_utilisation: Annotated[float, Quantity("1", above=0, at_most=1)] = 0.3
    """Stored energy of a Belleville stack over that of the same volume under uniform stress."""
    lower_lug_height: Coordinate = 0.0
    """Height of the lower torque-link hinge above the wheel axle [m]."""

    @model_validator(mode="after")
    def _damper_is_metal(self) -> Self:
        if self.damper_material.yield_strength is None:
            raise refuse("damper_material", f"'{self.damper_material.name}' has no yield strength", "a metal")
        return self

    def wall_thickness(self, bore: float, limit_factor: float, ultimate_factor: float) -> float:
        """Wall of the cylinder [m]: p D/(2 sigma) and the allowance, as its mass is reckoned."""
        sigma = allowable_stress(self.damper_material, limit_factor, ultimate_factor)
        return float(self.wall_allowance + self.working_pressure * bore / (2 * sigma))

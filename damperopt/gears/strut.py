"""The shock strut: how far the gear has come in under its load, and what that makes of its numbers.

The numbers of a study hold for the strut fully out. At a vertical load F_z a gas spring in balance has come in by the stroke

    x_s = (V_0/A) (1 - (p/p_0)^(-1/n)),   p = F_z/A + p_a,

p and p_0 absolute, between its stops at 0 and at the travel; or the stroke is a table over the load. The axle then stands x_s
nearer to the attachment, and the lugs of the torque links stand x_s nearer to each other (`linkages.base.reach_and_height`).
Gas curve: Milwitzky & Cook, NACA Report 1154 (1953), with the pressure of the air around. A mass m that comes in with the axle
takes m (l_g^2 - (l_g - x_s)^2) off the inertia of bending; while it moves, so that the momentum I_x delta' is kept, the rate
of I_x acts as a damping. Friction of the strut, its oil, and the weight of what comes in have no part in the balance.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import Annotated, Any, Self

from pydantic import model_validator

from ..expressions.calculus import Expr, exp, log, piecewise
from ..ports.over_load import OverLoad, straight
from ..quantities.record import Coordinate, Distance, Force, Length, Pressure, Record, Stiffness, TorsionalStiffness, refuse
from ..quantities.units import Quantity

__all__ = ["GasSpring", "ShockStrut"]

ATMOSPHERE = 101_325.0
"""[Pa]"""

ROUNDING = 1e-9
"""Of a stroke at the end of a table [m]."""


class GasSpring(Record):
    """Gas of a strut, whose pressure acts on one area."""

    pressure: Pressure
    """p_0 - p_a of the gas with the strut fully out, as a gauge shows it [Pa]."""
    area: Annotated[float, Quantity("m^2", above=0, example="0.012 m^2")]
    """A, on which the gas acts [m^2]."""
    volume: Annotated[float, Quantity("m^3", above=0, example="0.005 m^3")]
    """V_0 of the gas with the strut fully out [m^3]."""
    exponent: Annotated[float, Quantity("1", at_least=1, at_most=1.7, example="1.1")]
    """n of p V^n: 1 where heat has time to pass (rolling), 1.1 to 1.35 in a landing [1]."""
    ambient: Annotated[float, Quantity("Pa", at_least=0, example="101325 Pa")] = ATMOSPHERE
    """p_a, of the air around [Pa]."""

    def force(self, stroke: Expr) -> Expr:
        """F_z at a stroke [N]."""
        p_0, n = self.pressure + self.ambient, self.exponent
        return self.area * (p_0 * exp(-n * log(1 - stroke * self.area / self.volume)) - self.ambient)

    def stroke(self, load: Expr) -> Expr:
        """x_s in balance with a load [m], without stops."""
        ratio = (load / self.area + self.ambient) / (self.pressure + self.ambient)
        return self.volume / self.area * (1 - exp(-log(ratio) / self.exponent))


class StrokeTable(OverLoad):
    """Stroke of the strut over load, ``{load: [20 kN, 150 kN], value: [0 m, 0.3 m]}``."""

    value: tuple[Distance, ...]
    """The stroke at each load [m]; 0: fully out."""

    @model_validator(mode="after")
    def _comes_in(self) -> Self:
        if any(low > high for low, high in pairwise(self.value)):
            raise refuse("value", "strokes that fall with the load", "strokes that ascend with it")
        return self


class OverStrut(Record):
    """A number over the load on the gear, or over the stroke, ``{stroke: [0 mm, 300 mm], value: [2 MN m/rad, 3 MN m/rad]}``."""

    load: tuple[Force, ...] | None = None
    """Loads on the gear, ascending [N]; or"""
    stroke: tuple[Distance, ...] | None = None
    """strokes, ascending [m]."""
    value: tuple[float, ...]
    """The number at each of them, in the unit of its key."""

    @model_validator(mode="after")
    def _whole(self) -> Self:
        if (self.load is None) == (self.stroke is None):
            raise refuse("", "neither load nor stroke" if self.load is None else "load and stroke", "one of the two")
        if len(self.places) < 2 or len(self.places) != len(self.value):
            found = f"{len(self.places)} places and {len(self.value)} values"
            raise refuse("", found, "as many values as loads or strokes, two at least")
        if any(low >= high for low, high in pairwise(self.places)):
            raise refuse("load" if self.stroke is None else "stroke", "does not ascend", "each above the one before")
        return self

    @property
    def places(self) -> tuple[float, ...]:
        """Loads [N] or strokes [m]."""
        return (self.load if self.stroke is None else self.stroke) or ()

    def at(self, load: Expr, stroke: Expr) -> Expr:
        """The number at a load [N] and a stroke [m]; beyond the table its last line goes on, and `beyond` says so."""
        return straight(load if self.stroke is None else stroke, self.places, self.value)

    def beyond(self, load: float, stroke: float) -> str:
        """Ends of the table, in words, if load or stroke lies beyond; else nothing."""
        first, last = self.places[0], self.places[-1]
        if self.stroke is None:
            return "" if first <= load <= last else f"{first / 1e3:g} to {last / 1e3:g} kN"
        inside = first - ROUNDING <= stroke <= last + ROUNDING
        return "" if inside else f"{first * 1e3:g} to {last * 1e3:g} mm, with a stroke of {stroke * 1e3:.4g} mm"


class TorsionTable(OverStrut):
    """A torsional stiffness over load or stroke, ``{load: [20 kN, 150 kN], value: [200 kN m/rad, 300 kN m/rad]}``."""

    value: tuple[TorsionalStiffness, ...]
    """The stiffness at each load or stroke [N m/rad]."""


class StiffnessTable(OverStrut):
    """A lateral stiffness at the axle over load or stroke, ``{load: [20 kN, 150 kN], value: [2 MN/m, 3 MN/m]}``."""

    value: tuple[Stiffness, ...]
    """The stiffness at each load or stroke [N/m]."""


class CasterTable(OverStrut):
    """The caster over load or stroke, of wheels on a lever, ``{stroke: [0 mm, 300 mm], value: [90 mm, 120 mm]}``."""

    value: tuple[Coordinate, ...]
    """e at each load or stroke [m]."""


TABLES = ("bending_stiffness", "lateral_stiffness", "torsional_stiffness", "caster_length")


class ShockStrut(Record):
    """Stroke of the shock strut over the vertical load on the gear, and the numbers of the gear that change with it."""

    gas: GasSpring | None = None
    """Gas spring that carries the load."""
    travel: Length | None = None
    """Stroke at which a gas spring meets its stop [m]."""
    stroke: StrokeTable | None = None
    """Stroke over load in the place of a gas spring."""
    moving_mass: Annotated[float, Quantity("kg", above=0, example="120 kg")] | None = None
    """m at the axle that comes in with the stroke; left out: the inertia of bending stays what it is [kg]."""
    bending_stiffness: TorsionTable | None = None
    """k_delta over load or stroke, in the place of gear.lateral.stiffness [N m/rad]."""
    lateral_stiffness: StiffnessTable | None = None
    """k_w over load or stroke, in the place of gear.sideways.stiffness [N/m]."""
    torsional_stiffness: TorsionTable | None = None
    """Of piston and cylinder over load or stroke, in the place of damper.compliance.torsion; with a rotational layout, in the
    place of damper.torsional_stiffness [N m/rad]."""
    caster_length: CasterTable | None = None
    """e over load or stroke, in the place of gear.caster_length [m]."""

    @model_validator(mode="after")
    def _one_curve(self) -> Self:
        if (self.gas is None) == (self.stroke is None):
            raise refuse("", "no load-stroke curve" if self.gas is None else "two load-stroke curves", "gas, or stroke")
        if (self.gas is None) != (self.travel is None):
            raise refuse("travel", "missing key" if self.gas else "beside stroke, whose last value it is", "travel beside gas")
        if self.gas is not None and self.travel is not None and not self.travel < self.gas.volume / self.gas.area:
            most = f"less than volume/area, {self.gas.volume / self.gas.area:.4g} m"
            raise refuse("travel", f"{self.travel:g} m, where no gas is left", most)
        return self

    @property
    def longest(self) -> Expr:
        """The largest stroke [m]."""
        return self.travel if self.stroke is None else self.stroke.value[-1]

    def at_load(self, load: Expr) -> Expr:
        """x_s at a vertical load on the gear [N], [m]."""
        if self.stroke is not None:
            return self.stroke.at(load)
        gas, travel = self.gas, self.travel
        assert gas is not None
        return piecewise(load, [gas.force(0.0), gas.force(travel)], [lambda F: 0.0, gas.stroke, lambda F: travel])

    def torsion(self, load: Expr, stroke: Expr) -> Expr | None:
        """Stiffness in torsion at a load [N] and a stroke [m], [N m/rad]; None where the strut says none."""
        return None if self.torsional_stiffness is None else self.torsional_stiffness.at(load, stroke)

    def changed(self, gear: Any, load: Expr, stroke: Expr, rate: Expr) -> dict[str, Any]:
        """Fields of a gear as they are at a load [N], a stroke [m] and a rate of it [m/s]."""
        found: dict[str, Any] = {}
        if self.caster_length is not None:
            found["caster_length"] = self.caster_length.at(load, stroke)
        if (lateral := getattr(gear, "lateral", None)) is not None:
            found["lateral"] = lateral.model_copy(update=self._bending(lateral, load, stroke, rate))
        if self.lateral_stiffness is not None:
            found["sideways"] = gear.sideways.model_copy(update={"stiffness": self.lateral_stiffness.at(load, stroke)})
        if (height := getattr(gear, "swivelling_height", None)) is not None:
            found["swivelling_height"] = height - stroke
        return found

    def _bending(self, lateral: Any, load: Expr, stroke: Expr, rate: Expr) -> dict[str, Expr]:
        height = lateral.height - stroke
        found: dict[str, Expr] = {"height": height}
        if self.bending_stiffness is not None:
            found["stiffness"] = self.bending_stiffness.at(load, stroke)
        if self.moving_mass is not None:
            found["inertia"] = lateral.inertia - self.moving_mass * (lateral.height**2 - height**2)
            found["damping"] = lateral.damping - 2 * self.moving_mass * height * rate
        return found

    def refuse_beside(self, gear: Any) -> None:
        """Raises where a gear has no use for a number, or none is left of its own."""
        if not gear.STROKES:
            raise refuse("strut", f"gear.kind {gear.kind} is made for one stroke", "a kind with numbers of its own")
        lateral = getattr(gear, "lateral", None) if "bending_angle" in _states(gear) else None
        asked: Mapping[str, bool] = {
            "moving_mass": lateral is not None,
            "bending_stiffness": lateral is not None,
            "lateral_stiffness": hasattr(gear, "sideways"),
        }
        for key, used in asked.items():
            if getattr(self, key) is not None and not used:
                raise refuse(f"strut.{key}", f"gear.kind {gear.kind} has nothing that it changes", "to leave it out")
        if lateral is None:
            return
        if not self.longest < lateral.height:
            raise refuse("strut", f"a stroke of {self.longest:g} m", f"less than gear.lateral.height, {lateral.height:g} m")
        if self.moving_mass is not None and not self.moving_mass * lateral.height**2 < lateral.inertia:
            least = f"less than gear.lateral.inertia/height^2, {lateral.inertia / lateral.height**2:.4g} kg"
            raise refuse("strut.moving_mass", f"{self.moving_mass:g} kg", least)

    def beyond(self, load: float, stroke: float | None = None) -> str:
        """Why the strut has no answer at a load [N], and a stroke [m] if it is not in balance; empty where it has one."""
        table = self.stroke
        if stroke is None and table is not None and not table.load[0] <= load <= table.load[-1]:
            return f"is beyond the table of gear.strut.stroke, {table.load[0] / 1e3:g} to {table.load[-1] / 1e3:g} kN"
        at = float(self.at_load(load)) if stroke is None else stroke
        for key in TABLES:
            if getattr(self, key) is not None and (ends := getattr(self, key).beyond(load, at)):
                return f"is beyond the table of gear.strut.{key}, {ends}"
        return ""


def _states(gear: Any) -> set[str]:
    return {state.name for state in gear.states()}

"""A damper that is bought: what its maker states, and no size to be chosen."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from ..expressions.calculus import Expr
from ..expressions.corners import Corners
from ..ports.sizing import Capacity, Force, LimitEvent, Sized
from ..quantities.record import Damping, Length, Name, Record, SeriesStiffness, refuse
from ..quantities.record import Force as Newtons
from ..quantities.units import Quantity
from .base import Context, Damper

__all__ = ["Bought", "CatalogueDamper"]


class CatalogueDamper(Record):
    """A damper that can be bought: a row of the catalogue."""

    name: Annotated[Name, Field(examples=["type 14-4"])]
    """Part number."""
    c: Damping
    """Linear damping [N s/m]."""
    stroke: Length
    """Usable stroke to one side of the middle [m]."""
    length: Length
    """From pin to pin at the middle of the stroke [m]."""
    force: Newtons
    """Largest force at limit load [N]."""
    mass: Annotated[float, Quantity("kg", above=0, example="3.2 kg")]
    """With its fluid [kg]."""
    series_stiffness: SeriesStiffness
    """Of oil column, rod and eyes [N/m]."""


class Bought(Damper):
    """A damper of a catalogue, F = c v, with its own stiffness in series, and limits of force and stroke."""

    kind: Literal["bought"] = "bought"
    row: CatalogueDamper
    """Of the catalogue."""

    @model_validator(mode="after")
    def _one_stiffness(self) -> Self:
        compliance = getattr(self, "compliance", None)
        if compliance is not None and not isinstance(compliance.damper, str):
            found = f"{compliance.damper:g} N/m beside series_stiffness of the row"
            raise refuse("compliance.damper", found, "the row's alone")
        return self

    def force(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        rate: Expr,
        context: Context,
        corners: Corners,
    ) -> Force:
        """F = c v."""
        return Force(self.row.c * rate)

    def rate(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        force: Expr,
        context: Context,
        corners: Corners,
    ) -> Expr:
        """v = F/c."""
        return force / self.row.c

    def equivalent(self, design: Mapping[str, Expr], amplitude: Expr, frequency: Expr, context: Context) -> tuple[Expr, Expr]:
        """c, without the stiffness in series."""
        return 0.0, self.row.c

    def series(self, design: Mapping[str, Expr]) -> Expr:
        """Of oil column, rod and eyes."""
        return self.row.series_stiffness

    def parts(self, event: LimitEvent, model: Any) -> Sized:
        """Its mass and length as they are; force and stroke of the limit event must not exceed what it can do."""
        row, torque = self.row, ("damper.row", "loads")
        can = (
            Capacity("largest_force", "N", row.force, event.damper_force, torque),
            Capacity("usable_stroke", "m", row.stroke, event.stroke, torque),
        )
        return Sized({"damper": row.mass}, length=row.length, capacities=can)

    def leaves_out(self) -> tuple[str, ...]:
        """What a row of a catalogue does not say."""
        return (
            "mass and stiffness of what lengthens a bought damper to the pins of the layout",
            "strength and fatigue of a bought damper beyond its largest force",
            "temperature of a bought damper, whose row holds at the one that its maker states",
        )

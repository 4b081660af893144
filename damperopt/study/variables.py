"""Records of the design variables: bounds and starts, each with its unit."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import Field, GetJsonSchemaHandler, model_validator
from pydantic_core import CoreSchema

from ..quantities.record import AcuteAngle, Damping, Length, Record, SecondMoment, Stiffness, refuse
from ..quantities.units import Quantity

__all__ = ["DESIGN_VARIABLES", "TOPOLOGIES", "Design", "Solver", "Variable"]

TOPOLOGIES = ("boeing", "utas", "arreaza")
"""Layouts that can be optimised; ``rotational`` (stiffness and damping given directly) can only be analysed."""

DESIGN_VARIABLES: dict[str, tuple[str, ...]] = {
    "boeing": ("c_lambda", "k_lambda", "L", "gamma"),
    "utas": ("c_lambda", "I_arm", "L", "gamma", "b"),
    "arreaza": ("c_lambda", "I_arm", "L", "gamma", "b"),
    "rotational": (),
}
"""Design variables of each layout, in the order of every table and file."""


class Variable(Record):
    """A design variable: start, min and max, or a single number, which fixes it."""

    start: float
    min: float
    max: float

    @model_validator(mode="before")
    @classmethod
    def _single_number_fixes(cls, data: Any) -> Any:
        return data if isinstance(data, (dict, Variable)) else {"start": data, "min": data, "max": data}

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if not self.min <= self.start <= self.max:
            raise refuse(
                "",
                f"inverted range or start outside it: min {self.min:g}, start {self.start:g}, max {self.max:g}",
                "min <= start <= max",
            )
        return self

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        block = handler.resolve_ref_schema(handler(schema))
        return {"anyOf": [block["properties"]["start"], block]}


class DampingVariable(Variable):
    """Damping of the damper [N s/m]."""

    start: Damping
    min: Damping
    max: Damping


class StiffnessVariable(Variable):
    """Stiffness of a spring [N/m]."""

    start: Stiffness
    min: Stiffness
    max: Stiffness


class SecondMomentVariable(Variable):
    """Second moment of area [m^4]."""

    start: SecondMoment
    min: SecondMoment
    max: SecondMoment


class LengthVariable(Variable):
    """Length [m]."""

    start: Length
    min: Length
    max: Length


class AngleVariable(Variable):
    """Acute angle [rad]."""

    start: AcuteAngle
    min: AcuteAngle
    max: AcuteAngle


class Design(Record):
    """Bounds and starts of the design variables; a layout needs those of `DESIGN_VARIABLES`, others may stand by."""

    c_lambda: DampingVariable | None = None
    I_arm: SecondMomentVariable | None = None
    k_lambda: StiffnessVariable | None = None
    L: LengthVariable | None = None
    gamma: AngleVariable | None = None
    b: LengthVariable | None = None


class Solver(Record):
    """Numbers of the solution method."""

    starts: Annotated[int, Field(strict=True, ge=1, le=4096)] = 16
    """Starting points: the config's own and Sobol points within the bounds."""
    seed: Annotated[int, Field(strict=True, ge=0)] = 1
    tolerance: Annotated[float, Quantity("1", above=0, at_most=1e-4)] = 1e-8
    """Of IPOPT, in scaled variables."""
    margin_reserve: Annotated[float, Quantity("1/s", above=0, at_most=0.1)] = 1e-6
    """Added to the stability margin while solving, so that the exact proof of the margin itself has room [1/s]."""
    engine: Literal["auto", "erk", "cvodes", "idas"] = "auto"
    """Integrator of the transients; auto: the fastest that this machine offers."""
    integration_tolerance: Annotated[float, Quantity("1", at_least=1e-12, at_most=1e-5)] = 1e-8
    """Of the integrator, relative."""
    decay_reserve: Annotated[float, Quantity("1", above=0, at_most=0.1)] = 1e-4
    """Part of the decay ratio that is kept back while solving, for the exact simulation between the speeds used."""
    decay_speeds: Annotated[int, Field(strict=True, ge=2, le=1000)] = 16
    """Speeds of the search for the worst decay; twice as many verify the result."""
    verification_speeds: Annotated[int, Field(strict=True, ge=2, le=1_000_000)] = 2000

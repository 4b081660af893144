"""Records of the design variables: bounds and starts, each with its unit."""

from __future__ import annotations

from typing import Annotated, Any, Self

from pydantic import GetJsonSchemaHandler, create_model, model_validator
from pydantic_core import CoreSchema

from ..quantities.named import DesignVariable
from ..quantities.record import Record, refuse
from ..quantities.units import Quantity
from .components import design_variables

__all__ = ["Design", "Variable"]


class Variable(Record):
    """A design variable: start, min and max, or a single number, which fixes it."""

    start: float
    """Where the search begins."""
    min: float
    """Least that is allowed."""
    max: float
    """Most that is allowed."""

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


def _variable_of(declared: DesignVariable) -> type[Variable]:
    """Record class of a declared design variable, with its unit and limits."""
    number = Annotated[float, Quantity(declared.unit, above=0, below=declared.below, example=declared.example)]
    name = f"{declared.name}_variable"
    fields: dict[str, Any] = dict.fromkeys(("start", "min", "max"), (number, ...))
    words = f"{declared.meaning or declared.name} [{declared.unit}]."
    made = create_model(name, __base__=Variable, __module__=__name__, __doc__=words[:1].upper() + words[1:], **fields)
    globals()[name] = made  # where pickle looks for it
    return made


_FIELDS: dict[str, Any] = {name: (_variable_of(declared) | None, None) for name, declared in design_variables().items()}

Design: Any = create_model(
    "Design",
    __base__=Record,
    __module__=__name__,
    __doc__="Bounds and starts of the design variables; a layout needs its own, others may stand by.",
    **_FIELDS,
)

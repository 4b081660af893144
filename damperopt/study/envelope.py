"""Where the gear must be stable."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import BeforeValidator, Discriminator, Tag, TypeAdapter, WithJsonSchema, model_validator

from ..quantities.record import Force, LoadRange, Record, SpeedRange, refuse

__all__ = ["Envelope"]


_LOAD = TypeAdapter(Force).json_schema()


class Envelope(Record):
    """Where the gear must be stable: every speed of a range, at one load, a list of loads, or a range of loads."""

    speed: SpeedRange
    """Every speed between the two is proved."""
    vertical_load: Annotated[
        Annotated[LoadRange, Tag("LoadRange")] | Annotated[list[Force], Tag("list")],
        Discriminator(lambda data: "LoadRange" if isinstance(data, (dict, LoadRange)) else "list"),
        BeforeValidator(lambda data: data if isinstance(data, (dict, list, LoadRange)) else [data]),
        WithJsonSchema(
            {
                "anyOf": [
                    *_LOAD["anyOf"],
                    {"type": "array", "items": _LOAD, "minItems": 1},
                    {
                        "type": "object",
                        "properties": {"min": _LOAD, "max": _LOAD},
                        "required": ["min", "max"],
                        "additionalProperties": False,
                    },
                ],
                "$comment": "[N] a load such as '150 kN', a list of loads, or a range {min, max}",
            }
        ),
    ]
    """Vertical load on the gear: one, a list, or a range."""

    @model_validator(mode="after")
    def _some_load(self) -> Self:
        if isinstance(self.vertical_load, list):
            if not self.vertical_load:
                raise refuse("vertical_load", "an empty list", "one load or more, or {min, max}")
            if len(set(self.vertical_load)) < len(self.vertical_load):
                raise refuse("vertical_load", "names a load twice", "different loads")
        return self

    @property
    def loads(self) -> tuple[float, ...]:
        """Vertical loads [N]: the list, or the two ends of the range."""
        load = self.vertical_load
        return (load.min, load.max) if isinstance(load, LoadRange) else tuple(load)

    def samples(self, count: int) -> tuple[float, ...]:
        """The list of loads, or so many of the range, its ends included [N]."""
        if not self.load_is_range:
            return self.loads
        low, high = self.loads
        return tuple(low + (high - low) * i / (count - 1) for i in range(count))

    @property
    def load_is_range(self) -> bool:
        return isinstance(self.vertical_load, LoadRange)

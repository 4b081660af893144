"""Temperatures at the border: ``20 degC``, ``-65 degF`` and ``293.15 K`` become kelvins; these scales have no factor alone."""

from __future__ import annotations

import re
from dataclasses import dataclass
from decimal import Decimal
from typing import Annotated, Any

from ..reading import quoted
from .record import Range
from .units import Quantity

__all__ = ["ZERO_CELSIUS", "Temperature", "TemperatureRange"]

ZERO_CELSIUS = 273.15
"""0 degC [K]."""

_NUMBER = r"[-+]?(?:(?:0|[1-9][0-9]*)(?:\.[0-9]*)?|\.[0-9]+)"
_SCALES = {r"K|kelvin": (Decimal(1), Decimal(0)), r"degC|°C|celsius": (Decimal(1), Decimal("273.15"))}
_SCALES |= {r"degF|°F|fahrenheit": (Decimal(5) / 9, Decimal("459.67") * 5 / 9)}
"""Spellings -> factor, and kelvins at the scale's zero."""


@dataclass(frozen=True)
class _Kelvin(Quantity):
    """A quantity in K that also takes scales with a zero of their own."""

    unit: str = "K"

    def describe(self) -> str:
        return f"a number in K, or text with the unit degC, degF or K, such as '{self.example}', {self._limits()}"

    def _limits(self) -> str:
        return f"{self.at_least:g} to {self.at_most:g} K"

    def _number(self, found: Any) -> float:
        if not isinstance(found, str):
            return super()._number(found)
        readings = ((re.fullmatch(rf"\s*({_NUMBER})\s*(?:{words})\s*", found), scale) for words, scale in _SCALES.items())
        value = next((float(Decimal(match[1]) * factor + zero) for match, (factor, zero) in readings if match), None)
        if value is None:
            self._refuse(f"{quoted(found)} is no temperature")
        return value

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        words = "|".join(_SCALES)
        text = {"type": "string", "pattern": rf"^\s*{_NUMBER}\s*(?:{words})\s*$"}
        plain = {"type": "number", "minimum": self.at_least, "maximum": self.at_most}
        return {"anyOf": [plain, text], "$comment": self.describe()}


Temperature = Annotated[float, _Kelvin(at_least=200, at_most=450, example="20 degC", hint="20 is 20 K; write 20 degC")]


class TemperatureRange(Range):
    """A closed interval of temperatures."""

    min: Temperature
    max: Temperature

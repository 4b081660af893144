"""Units at the border: text such as ``150 kN`` becomes a float in SI, and nothing else does."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from decimal import Context, Decimal
from functools import cache
from typing import Any, NoReturn

from pydantic_core import PydanticCustomError, core_schema

__all__ = ["Quantity"]

_NUMBER_AND_UNIT = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*")

SMALLEST, LARGEST = 1e-15, 1e15
"""Numbers beyond are typing errors, and overflow in the middle of a solution."""

_DECIMALS = Context(prec=40, traps=[])


@cache
def _registry():
    import pint  # slow to import (0.5 s): only when a file has text quantities

    return pint.UnitRegistry(cache_folder=":auto:")


@cache
def _factor(unit_text: str, target: str) -> float | None:
    """Factor from `unit_text` to `target`, or None where the dimensions differ or a unit is unknown."""
    registry = _registry()
    spelled = re.sub(r"([A-Za-z])(\d)", r"\1^\2", unit_text)  # kg/m3 and kNm, as engineers write them
    spelled = re.sub(r"N([ms])(?![a-zA-Z])", r"N \1", spelled)
    try:
        unit, wanted = registry.parse_units(spelled), registry.parse_units("" if target == "1" else target)
        # radians are dimensionless for pint; a percentage is no angle and an angle no plain number
        root = (1.0 * unit).to_root_units().units
        if target in ("rad", "1") and root != registry.parse_units("" if target == "1" else target):
            return None
        return float((1.0 * unit).to(wanted).magnitude)
    except Exception:  # pint raises a dozen kinds of error for text that is no unit: all mean "not this unit"
        return None


def _product(number_text: str, factor: float) -> float:
    """Decimal text times factor, rounded once: 600 mm is 0.6 m, not 0.6000000000000001 m."""
    return float(_DECIMALS.multiply(Decimal(number_text), Decimal(repr(factor))))


@dataclass(frozen=True)
class Quantity:
    """What a key of the configuration accepts, a unit and a range: ``Annotated[float, Quantity("m", above=0)]``.

    Parameters
    ----------
    unit : str
        SI unit; plain numbers are taken in it. ``"1"`` for a plain number.
    above, below : float or None
        Open limits, in `unit`.
    at_least, at_most : float or None
        Closed limits, in `unit`.
    example : str
        A value that would be accepted, for the error message.
    """

    unit: str
    above: float | None = None
    below: float | None = None
    at_least: float | None = None
    at_most: float | None = None
    example: str = ""

    def describe(self) -> str:
        """Sentence that says what is allowed."""
        limits = [
            f"{sign} {limit:g}"
            for sign, limit in ((">", self.above), (">=", self.at_least), ("<", self.below), ("<=", self.at_most))
            if limit is not None
        ]
        allowed = "a number" if self.unit == "1" else f"a number in {self.unit}, or text with a unit of that dimension"
        if self.example:
            allowed += f" such as '{self.example}'"
        return allowed + (", " + " and ".join(limits) + (f" {self.unit}" if self.unit != "1" else "") if limits else "")

    def __call__(self, found: Any) -> float:
        """The value in SI.

        Parameters
        ----------
        found : object
            A number, or text with a unit.

        Returns
        -------
        float
            [`unit`]

        Raises
        ------
        pydantic_core.PydanticCustomError
            For anything else, a non-finite value or one out of range.
        """
        value = self._number(found)
        if not math.isfinite(value):
            self._refuse(f"{found!r} is not a finite number")
        inside = (
            (self.above is None or value > self.above)
            and (self.at_least is None or value >= self.at_least)
            and (self.below is None or value < self.below)
            and (self.at_most is None or value <= self.at_most)
        )
        if value and not SMALLEST < abs(value) < LARGEST:
            self._refuse(f"{found} is beyond any landing gear ({SMALLEST:g} to {LARGEST:g} in SI)")
        if not inside:
            converted = isinstance(found, str) and not found.endswith(" " + self.unit)
            given = f" (= {value:g} {self.unit})" if converted else ""
            self._refuse(f"{found}{given} is out of range")
        return value

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self)

    def __get_pydantic_json_schema__(self, schema: core_schema.CoreSchema, handler: Any) -> dict[str, Any]:
        number: dict[str, Any] = {"type": "number"}
        for keyword, limit in (
            ("exclusiveMinimum", self.above),
            ("minimum", self.at_least),
            ("exclusiveMaximum", self.below),
            ("maximum", self.at_most),
        ):
            if limit is not None:
                number[keyword] = limit
        if self.unit == "1":
            return number
        number_text = r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?"
        text = {"type": "string", "pattern": rf"^\s*{number_text}(\s+\S|[^\d\s.eE+-]).*$"}
        return {"anyOf": [number, text], "description": f"[{self.unit}] {self.describe()}"}

    def _number(self, found: Any) -> float:
        if isinstance(found, bool) or not isinstance(found, (int, float, str)):
            kind = {"NoneType": "nothing", "dict": "a mapping", "list": "a list"}.get(type(found).__name__, repr(found))
            self._refuse(f"found {kind}")
        if not isinstance(found, str):
            return float(found)
        match = _NUMBER_AND_UNIT.fullmatch(found)
        if not match:
            self._refuse(f"{found!r} is not a number with a unit")
        number, unit = match.groups()
        if not unit:
            self._refuse(f"{found!r} is text without a unit (remove the quotes, or add the unit)")
        factor = _factor(unit, self.unit)
        if factor is None:
            self._refuse(f"{found!r} has the unit '{unit}', which is unknown or of another dimension")
        return _product(number, factor)

    def _refuse(self, what: str) -> NoReturn:
        raise PydanticCustomError("quantity", "{what}; allowed: {allowed}", {"what": what, "allowed": self.describe()})

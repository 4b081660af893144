"""Units at the border: text such as ``150 kN`` becomes a float in SI, and nothing else does."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from decimal import Context, Decimal
from functools import cache
from typing import Any, NoReturn

from pydantic_core import PydanticCustomError, core_schema

from ..reading import quoted
from .spelling import LONGEST, advice, spellings, text_pattern

__all__ = ["Quantity", "number", "underflows"]

_DIGITS = r"(?:(?:0|[1-9][0-9]*)(?:\.[0-9]*)?|\.[0-9]+)"
_NUMBER = re.compile(rf"([-+]?{_DIGITS})(?:[eE]([-+]?[0-9]+))?")
_NUMBER_AND_UNIT = re.compile(rf"\s*({_NUMBER.pattern})\s*(.*?)\s*", re.DOTALL)
_LONGEST_NUMBER = 60

_SIZES = {
    "m": (1e-7, 1e4),
    "rad": (1e-12, 1e2),
    "kg m^2": (1e-9, 1e9),
    "N": (1e-2, 1e9),
    "N m": (1e-4, 1e10),
    "N m/rad": (1e-4, 1e12),
    "N m s/rad": (1e-6, 1e11),
    "m/s": (1e-12, 1e4),
    "s": (1e-6, 1e6),
    "Pa": (1e2, 1e13),
    "kg/m^3": (1e-1, 1e5),
    "N s/m": (1e-6, 1e12),
    "N/m": (1e-3, 1e13),
    "m^4": (1e-18, 1e2),
    "1/s": (1e-9, 1e5),
    "rad/s": (1e-12, 1e4),
}
"""Smallest and largest magnitude of each quantity [SI], far on both sides of any gear or model of one: typing errors are
beyond, and overflow in the middle of a solution."""
_ANY_SIZE = (1e-15, 1e15)

_DECIMALS = Context(prec=40, traps=[])

_FRAGMENTS = (
    (
        re.compile(r"[-+]?[0-9]+(?:[,'\u2019 ][0-9]{3})+(?:\.[0-9]*)?(?![0-9]).*"),
        "write the number without separators, as 12000.5",
    ),
    (re.compile(r"[-+]?[0-9]+,[0-9]+.*"), "write the decimal sign as a point, as in 9.5"),
    (re.compile(r"[-+]?0[0-9].*"), "write the number without leading zeros: to some readers 010 is 8"),
    (re.compile(r"[-+]?0[xXbBoO][0-9a-fA-F]+.*"), "write the number in decimal digits"),
    (re.compile(r"[-+]?[0-9][0-9_]*_[0-9].*"), "write the number without underscores"),
    (re.compile(r"[-+]?[0-9]+:[0-9].*"), "write the number in decimal digits: to some readers 1:30 is 90"),
    (re.compile(r"[\u2010-\u2015\u2212].*"), "write the sign as -"),
    (re.compile(r".*(?=\d)[^0-9].*"), "digits are 0 to 9"),
)
"""What looks like a number and is none, and what to do."""


@cache
def _registry():
    import pint  # slow to import (0.5 s): only when a file has text quantities

    try:
        registry = pint.UnitRegistry(cache_folder=":auto:")
    except Exception:  # no home, a full or read-only one, a broken cache: it saves 0.3 s and decides nothing
        registry = pint.UnitRegistry()
    registry.define("megapound_per_square_inch = 1e6 psi = Msi")
    registry.define("@alias revolution = rev")
    return registry


@cache
def _factor(unit_text: str, target: str) -> float | None:
    """Factor from `unit_text` to `target`, or None where the dimensions differ or a unit is unknown."""
    for text in spellings(unit_text):
        factor = _factor_of(text, target)
        if factor is not None:
            return factor
    return None


def _factor_of(text: str, target: str) -> float | None:
    registry = _registry()
    try:
        unit, wanted = registry.parse_units(text), registry.parse_units("" if target == "1" else target)
        root, aim = (dict((1.0 * u).to_root_units().unit_items()) for u in (unit, wanted))
        # radians and counts are dimensionless for pint; an angle is no plain number, a percentage no angle, 10 m % no metre,
        # and a hertz may be a cycle or a radian per second
        angle, turns = root.pop("radian", 0), aim.pop("radian", 0)
        goes_without_saying = angle == 0 and aim and turns and target != "rad/s"
        frequency = any(name in ("hertz", "counts_per_second", "becquerel") for name, _ in (1.0 * unit).unit_items())
        parts = target != "1" and any(name in ("percent", "permille", "ppm") for name, _ in (1.0 * unit).unit_items())
        if root != aim or (angle != turns and not goes_without_saying) or frequency or parts:
            return None
        return float((1.0 * unit).to(wanted).magnitude)
    except Exception:  # pint raises a dozen kinds of error for text that is no unit: all mean "not this unit"
        return None


def number(text: str) -> float | None:
    """The number that text stands for in every reader's eyes, or None.

    Parameters
    ----------
    text : str
        Decimal digits, a point, an exponent.

    Returns
    -------
    float or None
        None also where it is larger or smaller than any float but 0.
    """
    text = text.strip()
    if len(text) > _LONGEST_NUMBER or not _NUMBER.fullmatch(text):
        return None
    value = float(text)
    return None if math.isinf(value) or underflows(text) else value


def underflows(text: str) -> bool:
    """Whether digits that are not all zero make a number too small for a float: it would become 0 without a word."""
    return float(text) == 0 and bool(re.search("[1-9]", re.split("[eE]", text)[0]))


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
    hint : str
        What to do about a value out of range.
    """

    unit: str
    above: float | None = None
    below: float | None = None
    at_least: float | None = None
    at_most: float | None = None
    example: str = ""
    hint: str = ""

    @property
    def size(self) -> tuple[float, float]:
        """Smallest and largest magnitude of a value other than zero [`unit`]."""
        return _SIZES.get(self.unit, _ANY_SIZE)

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
            self._refuse(f"{quoted(found)} is not a finite number")
        converted = isinstance(found, str) and not found.endswith(" " + self.unit)
        shown = (found if isinstance(found, str) and len(found) < _LONGEST_NUMBER else quoted(found)) + (
            f" (= {value:g} {self.unit})" if converted and self.unit != "1" else ""
        )
        smallest, largest = self.size
        if value and not smallest <= abs(value) <= largest:
            unit = "" if self.unit == "1" else f" {self.unit}"
            self._refuse(f"{shown} is beyond any landing gear ({smallest:g} to {largest:g}{unit})")
        inside = (
            (self.above is None or value > self.above)
            and (self.at_least is None or value >= self.at_least)
            and (self.below is None or value < self.below)
            and (self.at_most is None or value <= self.at_most)
        )
        if not inside:
            self._refuse(f"{shown} is out of range" + (f" ({self.hint})" if self.hint else ""))
        return value + 0.0  # no negative zero

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self)

    def __get_pydantic_json_schema__(self, schema: core_schema.CoreSchema, handler: Any) -> dict[str, Any]:
        plain: dict[str, Any] = {"type": "number"}
        smallest, largest = self.size
        at_least = self.at_least if self.above is None else max(self.above, smallest) if self.above == 0 else None
        for keyword, limit in (
            ("exclusiveMinimum", None if at_least is not None else self.above),
            ("minimum", at_least if at_least is not None else None if self.above is not None else -largest),
            ("exclusiveMaximum", self.below),
            ("maximum", largest if self.at_most is None else min(self.at_most, largest)),
        ):
            if limit is not None:
                plain[keyword] = limit
        if self.unit == "1":
            parts = {
                "type": "string",
                "pattern": r"^\s*[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?\s*(?:%|percent|ppm)\s*$",
            }
            return {"anyOf": [plain, parts], "$comment": self.describe()}
        text = {"type": "string", "pattern": text_pattern(self.unit)}
        return {"anyOf": [plain, text], "$comment": self.describe()}

    def _number(self, found: Any) -> float:
        if isinstance(found, bool) or not isinstance(found, (int, float, str)):
            kind = {"NoneType": "nothing", "dict": "a mapping", "list": "a list"}.get(type(found).__name__, quoted(found))
            self._refuse(f"found {kind}")
        if not isinstance(found, str):
            try:
                return float(found)
            except OverflowError:
                self._refuse(f"{quoted(found)} is beyond any landing gear")
        match = _NUMBER_AND_UNIT.fullmatch(found)
        if not match or re.match(r"[,_:'\u2019]|\d(?!(?<=1)\s*/)", match[4]):
            self._refuse(f"{quoted(found)} is not a number with a unit" + self._about_digits(found))
        text, exponent, unit = match[1], match[3] or "0", match[4]
        if len(text) > _LONGEST_NUMBER:
            self._refuse(f"{quoted(found)} has more digits than any measurement")
        if not unit and math.isinf(float(found)):
            self._refuse(f"{quoted(found)} is not a finite number")
        if not unit and underflows(found):
            self._refuse(f"{quoted(found)} is too small for a number and would become 0")
        if not unit:
            self._refuse(
                f"{quoted(found)} is text without a unit (remove the quotes, or add the unit)" + self._about_digits(found)
            )
        if len(exponent.lstrip("+-0")) > 4:  # beyond any float; Decimal itself would refuse it
            self._refuse(f"{quoted(found)} is not a finite number" if exponent[0] != "-" else f"{quoted(found)} would become 0")
        factor = _factor(unit, self.unit) if len(unit) <= LONGEST else None
        if factor is None:
            self._refuse(
                f"{quoted(found)} has the unit {quoted(unit)}, which is unknown or of another dimension"
                + (self._about_unit(unit) or self._about_digits(found))
            )
        value = _product(text, factor)
        if not value and re.search("[1-9]", match[2]):
            self._refuse(f"{quoted(found)} is too small for a number and would become 0")
        return value

    def _about_digits(self, found: str) -> str:
        text = found.strip()[:100]
        advice_for = next((words for rule, words in _FRAGMENTS if rule.fullmatch(text) and not _NUMBER.fullmatch(text)), "")
        return f" ({advice_for})" if advice_for else ""

    def _about_unit(self, unit: str) -> str:
        """Advice where a unit is spelled in another way, or means two things."""
        if re.search(r"\b[kM]?Hz\b|\bcps\b", unit) and self.unit in ("rad/s", "1/s"):
            meant = "rad/s, deg/s or rpm" if self.unit == "rad/s" else "1/s"
            return f" (Hz may count cycles or radians; write {meant})"
        meant = next((text for text in advice(unit, self.unit) if _factor(text, self.unit) is not None), "")
        return f" (did you mean '{meant}'?)" if meant else ""

    def _refuse(self, what: str) -> NoReturn:
        raise PydanticCustomError("quantity", "{what}; allowed: {allowed}", {"what": what, "allowed": self.describe()})

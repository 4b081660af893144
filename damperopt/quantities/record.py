"""What every record of a study is made of: the base class, the kinds of numbers with their units, ranges."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, Self

from pydantic import AfterValidator, BaseModel, ConfigDict, StringConstraints, model_validator
from pydantic_core import PydanticCustomError

from ..reading import quoted, unprintable
from .units import Quantity

__all__ = ["LengthRange", "LoadRange", "Name", "Range", "Record", "SpeedRange", "quantity_of", "refuse"]


_LONGEST_MESSAGE = 300


def refuse(key: str, what: str, allowed: str) -> PydanticCustomError:
    """Error about `key` (a path below the block that is checked; empty: the block itself)."""
    if len(what) > _LONGEST_MESSAGE:
        what = f"{what[:_LONGEST_MESSAGE]}..."
    return PydanticCustomError("study", "{what}; allowed: {allowed}", {"what": what, "allowed": allowed, "key": key})


def _of_characters(text: str) -> str:
    """Names come back in files, figures and terminals: no control characters, no half of a character pair."""
    if words := unprintable(text):
        raise refuse("", f"{quoted(text)} holds {words}", "printable text")
    return text


Name = Annotated[str, StringConstraints(min_length=1, max_length=200), AfterValidator(_of_characters)]
"""What a user calls a thing."""

Length = Annotated[float, Quantity("m", above=0, example="0.6 m")]
Coordinate = Annotated[float, Quantity("m", example="120 mm")]
Distance = Annotated[float, Quantity("m", at_least=0, example="50 mm")]
Angle = Annotated[float, Quantity("rad", above=-1.5, below=1.5, example="9 deg")]
AcuteAngle = Annotated[float, Quantity("rad", above=0, below=1.5707963, example="31 deg")]
Inertia = Annotated[float, Quantity("kg m^2", above=0, example="100 kg m^2")]
TorsionalStiffness = Annotated[float, Quantity("N m/rad", at_least=0, example="380 kN m/rad")]
TorsionalDamping = Annotated[float, Quantity("N m s/rad", at_least=0, example="300 N m s/rad")]
Force = Annotated[float, Quantity("N", above=0, example="150 kN")]
Torque = Annotated[float, Quantity("N m", above=0, example="12 kN m")]
Speed = Annotated[
    float,
    Quantity(
        "m/s",
        at_least=1e-3,
        at_most=1e4,
        example="120 kt",
        hint="a wheel at rest does not shimmy, and 1/V has no value there; begin to taxi at a small speed, such as 1 kt",
    ),
]
Time = Annotated[float, Quantity("s", above=0, example="3 s")]
Stress = Annotated[float, Quantity("Pa", above=0, example="200 GPa")]
Pressure = Annotated[float, Quantity("Pa", above=0, example="160 psi")]
Density = Annotated[float, Quantity("kg/m^3", above=0, example="7850 kg/m^3")]
Damping = Annotated[float, Quantity("N s/m", above=0, example="1e4 N s/m")]
Stiffness = Annotated[float, Quantity("N/m", above=0, example="4 MN/m")]
SeriesStiffness = Annotated[float, Quantity("N/m", above=0, at_most=1e10, example="30 MN/m")]
SecondMoment = Annotated[float, Quantity("m^4", above=0, example="3.4e-6 m^4")]
Rate = Annotated[float, Quantity("1/s", at_least=0, example="0.1 1/s")]
Number = Annotated[float, Quantity("1", above=0, example="1.5")]
Fraction = Annotated[float, Quantity("1", at_least=0, example="0.2")]


class Record(BaseModel):
    """Base of all records: frozen, no unknown keys."""

    def constants(self) -> tuple[str, ...]:
        """Fields that stay numbers where the others become symbols: no derivative is taken of them."""
        return ()

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Range(Record):
    """A closed interval; `min` below `max`."""

    min: float
    """Lower end, included."""
    max: float
    """Upper end, included."""

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if not self.min < self.max:
            raise refuse("", f"inverted or empty range: min {self.min:g}, max {self.max:g}", "min < max")
        return self


class SpeedRange(Range):
    """Speed envelope; a single speed is allowed as min = max."""

    min: Speed
    max: Speed

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if not self.min <= self.max:
            raise refuse("", f"inverted range: min {self.min:g}, max {self.max:g} m/s", "min <= max")
        return self


class LoadRange(Range):
    """Continuous range of the vertical load."""

    min: Force
    max: Force


class LengthRange(Range):
    """Range of a length."""

    min: Distance
    max: Length


def quantity_of(annotation: Any, metadata: Sequence[Any] = ()) -> Quantity | None:
    """What a field accepts, if it is a number with a unit; optional fields included."""
    for note in (*metadata, *getattr(annotation, "__metadata__", ())):
        if isinstance(note, Quantity):
            return note
    inner = (quantity_of(part) for part in getattr(annotation, "__args__", ()))
    return next((quantity for quantity in inner if quantity), None)

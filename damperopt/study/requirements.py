"""Records of what a design must meet, with their documented defaults."""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from ..quantities.record import (
    Distance,
    Length,
    LengthRange,
    Number,
    Rate,
    Record,
    Speed,
    Torque,
    refuse,
)
from ..quantities.units import Quantity
from ..reading import quoted
from ..strength.fatigue import Spectrum
from .disturbances import Disturbance, Kick, Release

__all__ = ["DecayRequirement", "Fatigue", "LargestLimitCycle", "Requirements"]


_FRACTION = re.compile(r"\s*(0|[1-9][0-9]{0,8})\s*/\s*([1-9][0-9]{0,8})\s*")


def _fraction(found: Any) -> Any:
    """1/3 as a number; everything else as it is."""
    if not isinstance(found, str) or "/" not in found:
        return found
    parts = _FRACTION.fullmatch(found)
    if not parts:
        raise refuse("", f"{quoted(found)} is no fraction", "a number such as 0.3, or a fraction such as 1/3")
    return int(parts[1]) / int(parts[2])


_Ratio = Annotated[
    float,
    Quantity("1", above=0, below=1, example="1/3"),
    BeforeValidator(_fraction),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1},
                {"type": "string", "pattern": r"^\s*(0|[1-9][0-9]{0,8})\s*/\s*[1-9][0-9]{0,8}\s*$"},
            ]
        }
    ),
]


_Factor = Annotated[float, Quantity("1", at_least=1, example="1.5")]


class Fatigue(Record):
    """Fatigue life of the bending arm: `cycles` at `stress_fraction` of the limit-event stress (Basquin)."""

    stress_fraction: Annotated[float, Quantity("1", above=0, at_most=1)] = 0.5
    """Amplitude of the repeated stress, as a part of that of the limit event [1]."""
    cycles: Annotated[float, Quantity("1", at_least=1)] = 1e6
    """Cycles to be survived [1]."""
    spectrum: Spectrum = Spectrum()
    """What a flight brings, and how many flights."""


class DecayRequirement(Record):
    """|yaw| <= `ratio` times its first extremum at all times after `cycles` cycles that follow a disturbance."""

    ratio: _Ratio = 1 / 3
    """Of |yaw| to its first extremum, allowed after the cycles [1]."""
    cycles: Annotated[int, Field(strict=True, ge=1, le=100)] = 3
    """Cycles that follow the disturbance."""
    release: Release | None = None
    """The gear is let go from an angle; this or a kick."""
    kick: Kick | None = None
    """The gear starts with a rate; this or a release."""
    speeds: list[Speed] | None = None
    """Speeds to look at [m/s]; left out: the worst of the envelope is sought."""

    @model_validator(mode="after")
    def _one_disturbance(self) -> Self:
        if (self.release is None) == (self.kick is None):
            raise refuse("", "release and kick" if self.release else "neither release nor kick", "one of the two")
        if not any(name.startswith("yaw") for name, value in self.disturbance.initial_values.items() if value):
            raise refuse("", "a disturbance without yaw", "a yaw_angle or yaw_rate other than 0")
        if self.speeds is not None and not self.speeds:
            raise refuse("speeds", "an empty list", "one speed or more, or leave it out")
        return self

    @property
    def disturbance(self) -> Disturbance:
        return Disturbance(release=self.release, kick=self.kick)


class LargestLimitCycle(Record):
    """No stable limit cycle of more yaw than this at any speed and load, with the play that is stated.

    It is checked after the optimisation, from motions by continuation; the optimiser does not see it.
    """

    yaw_angle: Annotated[float, Quantity("rad", above=0, below=1.0, example="0.1 deg")]
    """Largest amplitude of a stable limit cycle [rad]."""
    speeds: list[Speed] | None = None
    """Speeds to look at [m/s]; left out: every speed of the envelope that the branches pass."""
    gap: Length | None = None
    """Play of the apex joint to one side [m]; left out: that of damper.freeplay, or none."""

    @model_validator(mode="after")
    def _some_speeds(self) -> Self:
        if self.speeds is not None and not self.speeds:
            raise refuse("speeds", "an empty list", "one speed or more, or leave it out")
        return self


class Requirements(Record):
    """What a design must meet; limits are inclusive."""

    stability_margin: Rate
    """Spectral abscissa <= -stability_margin at every speed and load [1/s]."""
    fail_safe_margin: Rate | None = None
    """The same with the actuator of `damper.control` off, proved for itself [1/s]; left out: 0."""
    damping_ratio: Annotated[float, Quantity("1", above=0, below=1, example="0.05")] | None = None
    """Least damping ratio of the yaw mode at every speed and load [1]; left out: none is asked for."""
    decay: DecayRequirement | None = None
    """On the nonlinear model, at every speed and load, after a release or a kick."""
    largest_limit_cycle: LargestLimitCycle | None = None
    """Largest limit cycle with the stated play; left out: none is looked for."""
    limit_event: Literal["torque", "simulated"] = "torque"
    """What the parts must carry: a yaw torque, or the peaks of the motions that the decay requirement looks at."""
    limit_torque: Torque | None = None
    """Yaw torque of the limit event [N m]; left out: limit_torque_factor times the tyre's peak moment."""
    limit_torque_factor: Number = 1.5
    """Limit torque over the peak that the tyre can make, where no limit_torque is given [1]."""
    limit_factor: _Factor = 1.0
    """On yield strength at limit load [1]."""
    safety_factor: _Factor | None = Field(None, exclude=True)
    """An older name of limit_factor."""
    ultimate_factor: _Factor = 1.5
    """Ultimate over limit load [1], as 14 CFR 25.303 has it: on ultimate strength, buckling, a laminate's design strain."""
    fatigue: Fatigue = Fatigue()
    """Fatigue of the bending arm."""
    apex_clearance: Length = 0.127e-3
    """Free clearance at the apex joint [m]; 0.127 mm is the figure of a 737."""
    stroke_ratio: Number = 10.0
    """Least ratio of the damper's working stroke at the limit event to the apex clearance."""
    service_torque: Torque | None = None
    """Yaw torque of everyday turns, under which the damper has its working stroke [N m]; left out: a quarter of the largest
    static yaw torque of the rules at the largest load of the envelope."""
    lug_distance: LengthRange
    """Allowed distance between the strut lugs, 2 L cos(gamma) [m]."""
    reach: LengthRange
    """Allowed reach of the apex from the strut axis, L sin(gamma) [m]."""
    apex_room: Length = 0.4
    """Most that a damper across the apex may be long, pin to pin, where no other length of the layout limits it [m]."""
    tyre_clearance: Distance = 0.05
    """Least height of the apex above the top of the tyre [m]."""

    @model_validator(mode="after")
    def _factor_by_its_older_name(self) -> Self:
        given = {key: getattr(self, key) for key in ("limit_factor", "safety_factor") if key in self.model_fields_set}
        if len(set(given.values())) > 1:
            raise refuse("safety_factor", "another number than limit_factor", "limit_factor alone")
        factor = next(iter(given.values()), self.limit_factor)
        self.__dict__.update(limit_factor=factor, safety_factor=factor)  # frozen for everyone else
        return self

    @model_validator(mode="after")
    def _motions_to_size_by(self) -> Self:
        if self.limit_event == "simulated" and self.decay is None:
            raise refuse("decay", "missing key", "the block decay, whose motions limit_event 'simulated' takes its peaks from")
        return self

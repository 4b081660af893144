"""What a real linkage has besides its ideal one: compliance of the links, freeplay, stops."""

from __future__ import annotations

import math
from typing import Annotated

from ..expressions.calculus import Expr
from ..expressions.corners import Corners
from ..quantities.record import Length, Record, SeriesStiffness, Stiffness
from ..quantities.units import Quantity
from .elastic import Compliance

__all__ = ["EndStop", "Freeplay", "Joints", "RotaryEndStop", "RotaryFreeplay", "RotaryJoints", "beyond_gap", "stop_force"]

_Smoothing = Annotated[float, Quantity("1", above=0, at_most=0.5)]


class Freeplay(Record):
    """Clearance of the apex joint: it moves freely by `gap` to either side before it carries a force."""

    gap: Length
    """To one side, along the path of the apex [m]."""
    smoothing: _Smoothing = 0.02
    """Width of the rounded corner of the smooth version, as a fraction of the gap."""


class EndStop(Record):
    """Stop of the damper at +-`stroke` from rest; without `stiffness` the model ends there."""

    stroke: Length
    """To one side [m]."""
    stiffness: Stiffness | None = None
    """Of the contact [N/m]."""
    smoothing: _Smoothing = 0.002
    """Width of the rounded corner of the smooth version, as a fraction of the stroke."""


class Joints(Record):
    """Keys of a study's damper that belong to the joints of its linkage."""

    compliance: Compliance = Compliance()
    """What gives way between the gear and the damper; ``sized`` or ``rigid`` says it for every part."""
    link_stiffness: SeriesStiffness | None = None
    """Deprecated: compliance.link [N/m]."""
    freeplay: Freeplay | None = None
    """Play of the apex joint."""
    end_stop: EndStop | None = None
    """Stop of the damper's stroke."""

    def leaves_out(self) -> tuple[str, ...]:
        """What these joints do not hold, and what of them only a simulation of large motion holds."""
        words = []
        if self.freeplay is None:
            words.append("freeplay (damper.freeplay)")
        else:
            words.append(f"the freeplay of {1e3 * self.freeplay.gap:g} mm, taken as closed: simulate shows its limit cycle")
        if self.end_stop is None:
            words.append("end stops (damper.end_stop)")
        else:
            words.append(f"the end stop at {1e3 * self.end_stop.stroke:g} mm, which small motions do not meet")
        return tuple(words)


_Clearance = Annotated[float, Quantity("rad", above=0, below=1, example="0.5 deg")]


class RotaryFreeplay(Record):
    """Play between the gear and what stands about the yaw axis: it turns freely by `gap` to either side."""

    gap: _Clearance
    """To one side [rad]."""
    smoothing: _Smoothing = 0.02
    """Width of the rounded corner of the smooth version, as a fraction of the gap."""


class RotaryEndStop(Record):
    """Stop at +-`stroke` from rest; without `stiffness` the model ends there."""

    stroke: _Clearance
    """To one side [rad]."""
    stiffness: Annotated[float, Quantity("N m/rad", above=0, example="1 MN m/rad")] | None = None
    """Of the contact [N m/rad]."""
    smoothing: _Smoothing = 0.002
    """Width of the rounded corner of the smooth version, as a fraction of the stroke."""


class RotaryJoints(Record):
    """Keys of a study's damper that belong to play and stop about the yaw axis."""

    freeplay: RotaryFreeplay | None = None
    """Play in front of spring and damper."""
    end_stop: RotaryEndStop | None = None
    """Stop of the damper's angle."""

    def leaves_out(self) -> tuple[str, ...]:
        """What of play and stop only a simulation of large motion holds."""
        words = []
        if self.freeplay is not None:
            gap = math.degrees(self.freeplay.gap)
            words.append(f"the freeplay of {gap:g} deg, taken as closed: simulate shows its limit cycle")
        if self.end_stop is not None:
            words.append(f"the end stop at {math.degrees(self.end_stop.stroke):g} deg, which small motions do not meet")
        return tuple(words)


def beyond_gap(freeplay: Freeplay | RotaryFreeplay, reach: Expr, corners: Corners, angle: Expr) -> tuple[Expr, Expr]:
    """Angle beyond the play of an apex at `reach` [m] (1 about the yaw axis), and its slope; [rad]."""
    half_width = freeplay.gap / reach
    return corners.gap("freeplay", angle, half_width, freeplay.smoothing * half_width)


def stop_force(stop: EndStop | RotaryEndStop | None, corners: Corners, stroke: Expr) -> Expr:
    """Force of the stop [N], or torque [N m]; 0 without a stop, or with one at which the model ends."""
    if stop is None or stop.stiffness is None:
        return 0
    return stop.stiffness * corners.contact("end stop", stroke, stop.stroke, stop.smoothing * stop.stroke)

"""Control beside a damper: a torque u = -K(V) x of an actuator, or the current of a semi-active damper, with gains over speed.

K is a polynomial in V for each state that is measured, so that the closed loop is rational in V: as long as the actuator does
not saturate, proofs hold for it as for a passive gear. Saturated, and where a law commands a current, only simulation speaks.
The actuator acts where linkage and damper act, between piston and strut, beside them; off, it leaves the gear to the damper.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar

from pydantic import Field

from ..expressions.calculus import Expr
from ..expressions.corners import Corners
from ..quantities.named import Output, State
from ..quantities.record import Record, Time, Torque
from ..quantities.units import Quantity

__all__ = ["ACTUATOR", "CONTROL_OUTPUTS", "Control", "Controlled", "Gain"]

_Coefficient = Annotated[float, Quantity("1", example="1000")]
_Mass = Annotated[float, Quantity("kg", above=0, example="2 kg")]

ACTUATOR = State("actuator_torque", "N m", "actuator")
"""What an actuator with a lag adds to the states."""

CONTROL_OUTPUTS = (Output("control_torque", "N m", "of the actuator, on the gear"),)


class Gain(Record):
    """Gain of one state over speed, constant + linear V + quadratic V^2 + cubic V^3, in N m per SI unit of the state."""

    constant: _Coefficient = 0.0
    """k_0."""
    linear: _Coefficient = 0.0
    """k_1, per m/s."""
    quadratic: _Coefficient = 0.0
    """k_2, per (m/s)^2."""
    cubic: _Coefficient = 0.0
    """k_3, per (m/s)^3."""

    def at(self, speed: Expr) -> Expr:
        """Its value at a speed [m/s].

        Examples
        --------
        >>> Gain(constant=100.0, linear=-2.0).at(20.0)
        60.0
        """
        return self.constant + speed * (self.linear + speed * (self.quadratic + speed * self.cubic))

    @property
    def powers(self) -> tuple[int, ...]:
        """Powers of V in it."""
        return tuple(k for k, name in enumerate(type(self).model_fields) if getattr(self, name))


class Control(Record):
    """What is measured and how it acts: a torque u = -K(V) x about the axis of the damper, or a current that makes it."""

    LOAD_POWERS: ClassVar = (0,)

    gains: dict[str, Gain] = Field(min_length=1, examples=[{"yaw_rate": {"constant": 1000}}])
    """K by the name of a state that is measured: yaw_rate, yaw_angle, bending_angle, ..."""
    lag: Time | None = None
    """tau of the actuator, tau u' = -K x - u [s]; left out: none."""
    limit: Torque | None = None
    """Most that the actuator gives [N m], which only simulation has; left out: no end."""
    smoothing: Annotated[float, Quantity("1", above=0, at_most=0.5)] = 0.01
    """Width of the rounded corner at the limit in the smooth version, as a fraction of it."""
    mass: _Mass | None = None
    """Of actuator, sensors and their supply, counted as it is [kg]; left out: not counted."""

    @property
    def SPEED_POWERS(self) -> tuple[int, ...]:  # as components name theirs
        """Powers of V in the gains."""
        return tuple(sorted({0, *(k for gain in self.gains.values() for k in gain.powers)}))

    def wanted(self, x: Mapping[str, Expr], speed: Expr) -> Expr:
        """-K(V) x [N m], on the gear.

        Parameters
        ----------
        x : mapping of str to Expr
            States by name.
        speed : Expr
            V [m/s].
        """
        return -sum(gain.at(speed) * x[name] for name, gain in self.gains.items())

    def torque(self, x: Mapping[str, Expr], own: Expr, speed: Expr, corners: Corners) -> tuple[Expr, Expr]:
        """What the actuator gives [N m], and the rate of its state (None without a lag).

        Parameters
        ----------
        x : mapping of str to Expr
            States of gear and tyre by name.
        own : Expr
            Torque of an actuator that lags [N m].
        speed : Expr
            V [m/s].
        corners : Corners
            Version of the limit.
        """
        u = self.wanted(x, speed)
        if self.limit is not None:
            u = u - corners.contact("actuator limit", u, self.limit, self.smoothing * self.limit)
        return (u, None) if self.lag is None else (own, (u - own) / self.lag)


class Controlled(Record):
    """The key of a study's damper that belongs to its control."""

    control: Control | None = None
    """Gains over speed of an actuator beside the damper, or of the current of a semi-active one; left out: none."""

    def leaves_out(self) -> tuple[str, ...]:
        """What proofs of a controlled gear do not hold."""
        if self.control is None or getattr(self, "COMMANDED", False):
            return ()
        words = ["sampling, noise and failures of the control other than no torque at all"]
        if self.control.limit is None:
            words.append("saturation of the actuator (damper.control.limit)")
        else:
            words.append(
                f"saturation of the actuator at {self.control.limit:g} N m: beyond it no proof speaks, simulate has it"
            )
        if self.control.lag is None:
            words.append("lag of the actuator (damper.control.lag)")
        return tuple(words)

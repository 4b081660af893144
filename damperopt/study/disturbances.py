"""Records of what disturbs the gear: a release, a kick, a step of torque, a rotating unbalance."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import model_validator

from ..quantities.record import Record, refuse
from ..quantities.units import Quantity

__all__ = ["Disturbance", "Kick", "Release", "Step", "Unbalance"]

_Angle = Annotated[float, Quantity("rad", above=-1.0, below=1.0, example="1 deg")]
_Rate = Annotated[float, Quantity("rad/s", above=-1e3, below=1e3, example="0.5 rad/s")]


class _SomethingMoves(Record):
    @model_validator(mode="after")
    def _moves(self) -> Self:
        if not any(getattr(self, key) for key in type(self).model_fields):
            raise refuse("", "nothing is disturbed", f"a value other than 0 for {' or '.join(type(self).model_fields)}")
        return self


class Release(_SomethingMoves):
    """The gear is let go at rest from these angles, the tyre's string straight."""

    yaw_angle: _Angle = 0.0
    """Of the piston about the strut axis [rad]."""
    bending_angle: _Angle = 0.0
    """Lateral, of the strut [rad]."""
    string_deflection: Annotated[float, Quantity("m", above=-1.0, below=1.0, example="5 mm")] = 0.0
    """Of the tyre at its leading contact point [m]."""


class Kick(_SomethingMoves):
    """The gear starts in its rest position with these rates."""

    yaw_rate: _Rate = 0.0
    """Of the piston about the strut axis [rad/s]."""
    bending_rate: _Rate = 0.0
    """Lateral, of the strut [rad/s]."""


class Step(_SomethingMoves):
    """A torque about the strut axis acts from the start."""

    yaw_torque: Annotated[float, Quantity("N m", example="2 kN m")]
    """About the strut axis, from the start on [N m]."""


class Unbalance(_SomethingMoves):
    """A rotating unbalance: yaw torque `moment` Omega^2 sin(Omega t), Omega = V/wheel radius.

    `moment` is mass times radius times the lateral distance of its plane from the strut axis.
    """

    moment: Annotated[float, Quantity("kg m^2", example="0.01 kg m^2")]
    """Mass times radius times lateral distance from the strut axis [kg m^2]."""


class Disturbance(Record):
    """One or more of them together."""

    release: Release | None = None
    kick: Kick | None = None
    step: Step | None = None
    unbalance: Unbalance | None = None

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not any(getattr(self, key) is not None for key in type(self).model_fields):
            raise refuse("", "nothing disturbs the gear", "release, kick, step or unbalance")
        return self

    @property
    def initial_values(self) -> dict[str, float]:
        """Initial states by name; those not named are zero."""
        parts = [part.model_dump() for part in (self.release, self.kick) if part is not None]
        return {name: value for part in parts for name, value in part.items()}

    def start(self, state_names: tuple[str, ...]) -> list[float]:
        """Initial states in the order of `state_names`."""
        return [self.initial_values.get(name, 0.0) for name in state_names]

    @property
    def yaw_torque(self) -> float:
        """Constant torque [N m]."""
        return self.step.yaw_torque if self.step else 0.0

    @property
    def unbalance_moment(self) -> float:
        """[kg m^2]"""
        return self.unbalance.moment if self.unbalance else 0.0

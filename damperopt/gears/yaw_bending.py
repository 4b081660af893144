"""The gear that yaws and bends sideways: two degrees of freedom and the tyre."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import ClassVar, Literal

from ..expressions.calculus import Expr, cos, sin
from ..expressions.corners import Corners
from ..ports.motion import Motion, Torque
from ..ports.wheel import Contact, Wheel
from ..quantities.named import Output, State
from .base import Gear, Names
from .drag import pushes
from .yaw import LateralMode, Yaw

__all__ = ["YawBending"]


class YawBending(Yaw):
    """Yaw of the piston and lateral bending of the strut; with a string tyre, fifth order."""

    STATES: ClassVar[tuple[State, ...]] = (
        *Yaw.STATES,
        State("bending_angle", "rad", "bending", twin="bending_rate"),
        State("bending_rate", "rad/s", "bending", twin="bending_angle"),
    )
    OUTPUTS: ClassVar[tuple[Output, ...]] = (
        *Yaw.OUTPUTS,
        Output("lateral_displacement", "m", "of the wheel by bending, l_g sin(delta)"),
    )
    ORDER: ClassVar[int | None] = 5

    kind: Literal["yaw_bending"]  # type: ignore[assignment]  # each kind has a literal of its own
    lateral: LateralMode

    def wheels(self, x: Names, speed: Expr, load: Expr) -> tuple[Wheel, ...]:
        """One wheel behind the strut axis, moved sideways by l_g sin(delta)."""
        (wheel,) = super().wheels(x, speed, load)
        delta, delta_t, l_g = x["bending_angle"], x["bending_rate"], self.lateral.height
        lateral, rate = wheel.lateral - l_g * sin(delta), wheel.lateral_rate - l_g * delta_t * cos(delta)
        return (replace(wheel, lateral=lateral, lateral_rate=rate),)

    def rates(self, x: Names, contacts: Sequence[Contact], damper: Torque, yaw_torque: Expr, corners: Corners) -> Motion:
        """Thesis (4-3), (4-4) with the signs of the theory page."""
        # theory page, section 2: delta bending, phi rake, l_g height, e_eff effective caster
        yaw = super().rates(x, contacts, damper, yaw_torque, corners)
        (contact,) = contacts
        wheel, strut = contact.wheel, self.lateral
        assert wheel is not None
        delta, delta_t, l_g, theta = x["bending_angle"], x["bending_rate"], strut.height, wheel.swivel
        bending = -strut.stiffness * delta - strut.damping * delta_t
        at_ground, at_axle = pushes(self.drag, wheel, self.wheel_radius)
        sideways = l_g * (at_ground - contact.side_force * cos(theta)) + (l_g - self.wheel_radius) * at_axle
        bending += sideways * cos(self.rake_angle) * cos(delta)
        bending += wheel.load * wheel.trail * sin(theta)
        rates = {"bending_angle": delta_t, "bending_rate": bending / strut.inertia}
        return Motion({**yaw.rates, **rates}, {**yaw.outputs, "lateral_displacement": l_g * sin(delta)})

    def leaves_out(self) -> tuple[str, ...]:
        """The wheel of this kind does not spin."""
        return ("gyroscopic moments of the spinning wheel (gear.wheel_polar_inertia)", *Gear.leaves_out(self))

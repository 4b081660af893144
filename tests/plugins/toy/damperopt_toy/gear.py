"""A gear whose torque links hold the piston against a steering collar, and that against the strut."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Literal

from damperopt.expressions.calculus import Expr
from damperopt.expressions.corners import Corners
from damperopt.gears.base import Names
from damperopt.gears.yaw_bending import YawBending
from damperopt.ports.motion import Motion, Torque
from damperopt.ports.wheel import Contact
from damperopt.quantities.named import Output, State
from damperopt.quantities.record import Inertia, Record, TorsionalDamping, TorsionalStiffness


class Collar(Record):
    """Steering collar between piston and strut."""

    inertia: Inertia
    """I_s, about the strut axis [kg m^2]."""
    link_stiffness: TorsionalStiffness
    """k_t, of torque links and piston [N m/rad]."""
    link_damping: TorsionalDamping = 0.0
    """c_t, of a damper at the apex [N m s/rad]."""
    steering_stiffness: TorsionalStiffness
    """k_s, of the steering actuator [N m/rad]."""
    steering_damping: TorsionalDamping
    """c_s, of the shimmy damper in the actuator [N m s/rad]."""


class SteeringCollar(YawBending):
    """As yaw_bending, with a collar chi: I_s chi'' = -c_s chi' - k_s chi + c_t (psi' - chi') + k_t (psi - chi)."""

    STATES: ClassVar = (
        *YawBending.STATES,
        State("collar_angle", "rad", "collar", twin="collar_rate"),
        State("collar_rate", "rad/s", "collar", twin="collar_angle"),
    )
    OUTPUTS: ClassVar = (*YawBending.OUTPUTS, Output("steering_torque", "N m", "of the actuator on the collar"))
    ORDER: ClassVar = None

    kind: Literal["steering_collar"]
    collar: Collar

    def rates(self, x: Names, contacts: Sequence[Contact], damper: Torque, yaw_torque: Expr, corners: Corners) -> Motion:
        """The links' torque acts on the piston and, turned around, on the collar."""
        c, chi, chi_t = self.collar, x["collar_angle"], x["collar_rate"]
        links = c.link_stiffness * (x["yaw_angle"] - chi) + c.link_damping * (x["yaw_rate"] - chi_t)
        steering = -c.steering_stiffness * chi - c.steering_damping * chi_t
        gear = super().rates(x, contacts, damper, yaw_torque - links, corners)
        rates = {"collar_angle": chi_t, "collar_rate": (steering + links) / c.inertia}
        return Motion({**gear.rates, **rates}, {**gear.outputs, "steering_torque": steering})

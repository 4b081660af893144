"""The gear with a steering collar between piston and strut: yaw, collar, bending and the tyre are of seventh order."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Literal, Self

from pydantic import model_validator

from ..expressions.calculus import Expr
from ..expressions.corners import Corners
from ..ports.motion import Attachment, Motion, Torque
from ..ports.wheel import Contact
from ..quantities.named import Output, State
from ..quantities.record import Inertia, Record, TorsionalDamping, TorsionalStiffness, refuse
from .base import Gear, Names
from .spinning_wheel import gyroscopic
from .yaw_bending import YawBending

__all__ = ["Collar", "Seventh"]


class Collar(Record):
    """Steering collar about the strut axis: torque links hold the piston against it, and the steering holds it."""

    inertia: Inertia
    """I_s, about the strut axis [kg m^2]."""
    damper_at: Literal["links", "steering"] = "links"
    """Where linkage and damper of the study act: between piston and collar, or between collar and strut."""
    link_stiffness: TorsionalStiffness = 0.0
    """k_t of torque links and piston, beside the linkage where that is here [N m/rad]."""
    link_damping: TorsionalDamping = 0.0
    """c_t of a damper at the apex, beside the linkage's where that is here [N m s/rad]."""
    steering_stiffness: TorsionalStiffness
    """k_s of the steering actuator; 0 is free castering [N m/rad]."""
    steering_damping: TorsionalDamping
    """c_s inside the steering actuator [N m s/rad]."""
    swivel_damping: TorsionalDamping = 0.0
    """c_0 of the piston against the strut [N m s/rad]."""

    @model_validator(mode="after")
    def _held(self) -> Self:
        if self.damper_at == "steering" and not self.link_stiffness:
            raise refuse("link_stiffness", "nothing holds the piston", "a stiffness > 0 where the damper is at the steering")
        return self


class Seventh(YawBending):
    """As yaw_bending, with a steering collar between piston and strut; seventh order with a string tyre of one state.

    Stiffness in series caps what a damper in the steering can do: beyond c_s = (k_t + k_s)/omega, more damping is worse.
    """

    STATES: ClassVar[tuple[State, ...]] = (
        *YawBending.STATES,
        State("collar_angle", "rad", "collar", twin="collar_rate"),
        State("collar_rate", "rad/s", "collar", twin="collar_angle"),
    )
    OUTPUTS: ClassVar[tuple[Output, ...]] = (
        *YawBending.OUTPUTS,
        Output("link_torque", "N m", "through the torque links, on the piston"),
        Output("steering_torque", "N m", "of the steering on the collar"),
    )
    ORDER: ClassVar[int | None] = None

    kind: Literal["seventh"]  # type: ignore[assignment]  # each kind has a literal of its own
    collar: Collar

    def rates(self, x: Names, contacts: Sequence[Contact], damper: Torque, yaw_torque: Expr, corners: Corners) -> Motion:
        """The torque of the links acts on the piston and, turned around, on the collar.

        I_z psi'' = ... - c_0 psi' - c_t (psi' - chi') - k_t (psi - chi) and
        I_s chi'' = -c_s chi' - k_s chi + c_t (psi' - chi') + k_t (psi - chi), with the damper's torque on one of the two.
        """
        c, chi, chi_t, psi_t = self.collar, x["collar_angle"], x["collar_rate"], x["yaw_rate"]
        links = -c.link_stiffness * (x["yaw_angle"] - chi) - c.link_damping * (psi_t - chi_t)
        steering = -c.steering_stiffness * chi - c.steering_damping * chi_t
        if c.damper_at == "links":
            links += damper.torque
        else:
            steering += damper.torque
        motion = super().rates(x, contacts, Torque(0), yaw_torque + links - c.swivel_damping * psi_t, corners)
        if self.wheel_polar_inertia is not None:
            (wheel,) = (contact.wheel for contact in contacts)
            assert wheel is not None
            h = self.wheel_polar_inertia * wheel.speed / self.wheel_radius
            motion = gyroscopic(motion, x, h, self.yaw_inertia, self.lateral.inertia)
        rates = {"collar_angle": chi_t, "collar_rate": (steering - links) / c.inertia}
        torques = {"linkage_torque": damper.torque, "link_torque": links, "steering_torque": steering}
        return Motion({**motion.rates, **rates}, {**motion.outputs, **torques})

    def attachments(self, x: Names) -> dict[str, Attachment]:
        """``damper`` where the collar says, and ``steering_damper`` between collar and strut."""
        chi, chi_t = x["collar_angle"], x["collar_rate"]
        steering = Attachment(chi, chi_t, {"collar_rate": 1})
        links = Attachment(x["yaw_angle"] - chi, x["yaw_rate"] - chi_t, {"yaw_rate": 1, "collar_rate": -1})
        return {"damper": links if self.collar.damper_at == "links" else steering, "steering_damper": steering}

    def leaves_out(self) -> tuple[str, ...]:
        """Gyroscopic moments, where no inertia of the wheel is given, and the valves of the steering."""
        steering = ("hydraulics and control of the steering: it is a spring and a damper (gear.collar)",)
        if self.wheel_polar_inertia is None:
            return (*super().leaves_out(), *steering)
        return (*Gear.leaves_out(self), *steering)

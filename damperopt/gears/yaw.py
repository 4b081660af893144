"""The gear that only yaws: one degree of freedom and the tyre."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, ClassVar, Literal

from ..expressions.calculus import Expr, cos, sin
from ..expressions.corners import Corners
from ..ports.motion import Motion, Torque
from ..ports.wheel import Contact, Wheel
from ..quantities.named import Output, State
from ..quantities.record import Record, TorsionalDamping
from ..quantities.units import Quantity
from .base import Gear, Names
from .drag import Dragged, deflected
from .friction import friction_torque

__all__ = ["LateralMode", "PolarInertia", "Yaw"]

PolarInertia = Annotated[float, Quantity("kg m^2", above=0, example="6 kg m^2")]


class LateralMode(Record):
    """Lateral bending of the strut about its attachment."""

    inertia: Annotated[float, Quantity("kg m^2", above=0, example="600 kg m^2")]
    """I_x of all that bends sideways, about its attachment [kg m^2]."""
    stiffness: Annotated[float, Quantity("N m/rad", at_least=0, example="6.1 MN m/rad")]
    """k_delta [N m/rad]."""
    damping: TorsionalDamping
    """c_delta [N m s/rad]."""
    height: Annotated[float, Quantity("m", above=0, example="2.5 m")]
    """l_g, from the ground to the attachment [m]."""


class Yaw(Gear):
    """Yaw of the piston alone; with a string tyre, third order."""

    STATES: ClassVar[tuple[State, ...]] = (
        State("yaw_angle", "rad", "yaw", twin="yaw_rate"),
        State("yaw_rate", "rad/s", "yaw", twin="yaw_angle"),
    )
    OUTPUTS: ClassVar[tuple[Output, ...]] = (
        Output("linkage_torque", "N m", "of linkage and damper on the piston"),
        Output("torque_without_friction", "N m", "about the strut axis, all but dry friction"),
    )
    ORDER: ClassVar[int | None] = 3

    kind: Literal["yaw"]
    lateral: LateralMode | None = None
    """Has no part in this kind; stands by for ``yaw_bending``."""
    wheel_polar_inertia: PolarInertia | None = None
    """I_p of the spinning parts about the axle; without bending it has no effect on yaw [kg m^2]."""

    drag: Dragged = None
    """Steady braking and rolling drag; left out: the wheel rolls freely."""

    def wheels(self, x: Names, speed: Expr, load: Expr) -> tuple[Wheel, ...]:
        """One wheel behind the strut axis."""
        psi, psi_t, phi, e_eff = x["yaw_angle"], x["yaw_rate"], self.rake_angle, self.lever()
        theta, theta_t = psi * cos(phi), psi_t * cos(phi)
        return (Wheel(speed, theta, theta_t, -e_eff * sin(theta), -e_eff * cos(theta) * theta_t, e_eff, load),)

    def rates(self, x: Names, contacts: Sequence[Contact], damper: Torque, yaw_torque: Expr, corners: Corners) -> Motion:
        """Thesis (3-1) with the signs of the theory page: I_z psi'' = torques about the strut axis."""
        # theory page, section 2: psi yaw, phi rake; damper.torque acts on the piston, -T_damper of the page
        (contact,) = contacts
        wheel = contact.wheel
        assert wheel is not None
        psi_t, phi, e_eff, theta = x["yaw_rate"], self.rake_angle, wheel.trail, wheel.swivel
        M_load = wheel.load * sin(phi) * e_eff * sin(theta)
        torque = damper.torque - e_eff * contact.side_force - contact.aligning_moment + M_load + yaw_torque
        torque += deflected(self.drag, contact, self.wheel_radius) * cos(phi)
        psi_tt = (torque - friction_torque(self.friction, psi_t, corners)) / self.yaw_inertia
        outputs = {"linkage_torque": damper.torque, "torque_without_friction": torque}
        return Motion({"yaw_angle": psi_t, "yaw_rate": psi_tt}, outputs)

    def leaves_out(self) -> tuple[str, ...]:
        """Words for what only a gear that bends can show."""
        words = "lateral bending of the strut, and with it gyroscopic moments of the wheel (gear.kind yaw)"
        return (words, *Gear.leaves_out(self))

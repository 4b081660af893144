"""The gear that yaws and bends, with a wheel that spins: gyroscopic coupling of the two."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Literal

from ..expressions.calculus import Expr
from ..expressions.corners import Corners
from ..ports.motion import Motion, Torque
from ..ports.wheel import Contact
from .base import Gear, Names
from .yaw import PolarInertia
from .yaw_bending import YawBending

__all__ = ["SpinningWheel", "gyroscopic"]


def gyroscopic(motion: Motion, x: Names, momentum: Expr, yaw_inertia: Expr, bending_inertia: Expr) -> Motion:
    """I_z psi'' = ... + h delta', I_x delta'' = ... - h psi': what spinning wheels add to a gear that yaws and bends.

    Parameters
    ----------
    motion : Motion
        Without them.
    x : mapping of str to Expr
        States by name.
    momentum : Expr
        h, angular momentum of all wheels about their axle [kg m^2/s].
    yaw_inertia, bending_inertia : Expr
        I_z, I_x [kg m^2].
    """
    yaw, bending = momentum * x["bending_rate"], -momentum * x["yaw_rate"]
    rates = {
        "yaw_rate": motion.rates["yaw_rate"] + yaw / yaw_inertia,
        "bending_rate": motion.rates["bending_rate"] + bending / bending_inertia,
    }
    drive = motion.outputs["torque_without_friction"] + yaw
    return Motion({**motion.rates, **rates}, {**motion.outputs, "torque_without_friction": drive})


class SpinningWheel(YawBending):
    """As yaw_bending, with the gyroscopic moments of a wheel that rolls at V/R_w."""

    ORDER: ClassVar[int | None] = None
    EXTENDS: ClassVar = ("yaw_bending", "wheel_polar_inertia")

    kind: Literal["spinning_wheel"]  # type: ignore[assignment]  # each kind has a literal of its own
    wheel_polar_inertia: PolarInertia
    """I_p of wheel, tyre and rotating brake about the axle [kg m^2]."""

    def rates(self, x: Names, contacts: Sequence[Contact], damper: Torque, yaw_torque: Expr, corners: Corners) -> Motion:
        """With the angular momentum h = I_p V/R_w of the wheel."""
        motion = super().rates(x, contacts, damper, yaw_torque, corners)
        wheel = contacts[0].wheel
        assert wheel is not None
        h = self.wheel_polar_inertia * wheel.speed / self.wheel_radius
        return gyroscopic(motion, x, h, self.yaw_inertia, self.lateral.inertia)

    def leaves_out(self) -> tuple[str, ...]:
        """What every gear leaves out."""
        return Gear.leaves_out(self)

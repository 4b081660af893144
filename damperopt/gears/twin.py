"""The gear with two wheels side by side, on one axle that spins as a whole or each for itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated, ClassVar, Literal

from ..expressions.calculus import Expr, cos
from ..expressions.corners import Corners
from ..ports.motion import Motion, Torque
from ..ports.wheel import Contact, Wheel
from ..quantities.named import Output, State
from ..quantities.record import Distance, Length, Pressure, Record, Stiffness, TorsionalDamping
from ..quantities.units import Quantity
from .base import Gear, Names
from .spinning_wheel import gyroscopic
from .yaw import PolarInertia
from .yaw_bending import YawBending

__all__ = ["Axle", "Twin", "TwinIndependent"]


class Axle(Record):
    """Two wheels side by side; every number is that of one wheel."""

    half_track: Distance
    """t_w, of the middle of a wheel from that of the axle [m]."""
    slip_stiffness: Annotated[float, Quantity("N", at_least=0, example="1.2 MN")]
    """C_kappa, longitudinal force over longitudinal slip, of one tyre [N]."""
    longitudinal_relaxation: Length
    """sigma_x, over which the longitudinal force builds up [m]."""
    vertical_stiffness: Stiffness
    """K_z of one tyre, by which they resist roll [N/m]."""
    axle_roll: bool = True
    """Whether the axle rolls with the bending of the strut, so that the tyres resist it as 2 K_z t_w^2."""
    left_share: Annotated[float, Quantity("1", above=0, below=1, example="0.6")] | None = None
    """Part of the load on the left wheel, such as beside a soft tyre; left out: half of it [1]."""
    left_pressure: Pressure | None = None
    """Of the left tyre; left out: that of the tyre [Pa]."""
    right_pressure: Pressure | None = None
    """Of the right tyre [Pa]."""

    @property
    def deflection_stiffness(self) -> Expr:
        """K_x = C_kappa/sigma_x of one tyre [N/m]."""
        return self.slip_stiffness / self.longitudinal_relaxation

    @property
    def roll_stiffness(self) -> Expr:
        """2 K_z t_w^2, 0 where the axle does not roll [N m/rad]."""
        return 2 * self.vertical_stiffness * self.half_track**2 if self.axle_roll else 0


class Twin(YawBending):
    """As yaw_bending, with two wheels on a common axle: they cannot turn without slipping, which damps yaw.

    Each tyre carries half the load, or its share, and has a string and, if one is given, a pressure of its own. Terms of second
    order in the track are left out, so that both strings are moved alike. The longitudinal force of either tyre lags behind its
    slip as a string of length sigma_x.
    """

    STATES: ClassVar[tuple[State, ...]] = (*YawBending.STATES, State("fore_aft_deflection", "m", "fore-aft"))
    OUTPUTS: ClassVar[tuple[Output, ...]] = (
        *YawBending.OUTPUTS,
        Output("scrub_moment", "N m", "of the longitudinal forces of both tyres about the vertical, against the swivel"),
    )
    ORDER: ClassVar[int | None] = None

    kind: Literal["twin"]  # type: ignore[assignment]  # each kind has a literal of its own
    axle: Axle

    def wheels(self, x: Names, speed: Expr, load: Expr) -> tuple[Wheel, ...]:
        """Two, left and right, each with half the load; the right one comes forward in a positive yaw."""
        (both,) = super().wheels(x, speed, load)
        axle, forward = self.axle, self.axle.half_track * both.swivel_rate
        loads = (load / 2, load / 2) if axle.left_share is None else (axle.left_share * load, (1 - axle.left_share) * load)
        of_left = {"load": loads[0], "pressure": axle.left_pressure, "forward_rate": -forward, "index": 0}
        of_right = {"load": loads[1], "pressure": axle.right_pressure, "forward_rate": forward, "index": 1}
        return replace(both, **of_left), replace(both, **of_right)

    def rates(self, x: Names, contacts: Sequence[Contact], damper: Torque, yaw_torque: Expr, corners: Corners) -> Motion:
        """Both tyres together as one, and the moment of their opposite longitudinal forces.

        u' = t_w theta' - (V/sigma_x) u with the yaw moment -2 K_x t_w u; I_x delta'' = ... - 2 K_z t_w^2 delta;
        h = 2 I_p V/R_w.
        """
        axle, u, delta = self.axle, x["fore_aft_deflection"], x["bending_angle"]
        one, other = contacts
        wheel = one.wheel
        assert wheel is not None
        assert other.wheel is not None
        total = replace(wheel, load=wheel.load + other.wheel.load)
        force, moment = one.side_force + other.side_force, one.aligning_moment + other.aligning_moment
        known = one.deflection is not None and other.deflection is not None
        deflection = (one.deflection + other.deflection) / 2 if known else None  # each under half of the drag
        both = Contact((), force, moment, deflection=deflection, wheel=total)
        scrub = 2 * axle.deflection_stiffness * axle.half_track * u
        motion = super().rates(x, (both,), damper, yaw_torque - scrub * cos(self.rake_angle), corners)
        bending = motion.rates["bending_rate"] - axle.roll_stiffness * delta / self.lateral.inertia
        slip = axle.half_track * wheel.swivel_rate - wheel.speed / axle.longitudinal_relaxation * u
        rates = {**motion.rates, "bending_rate": bending, "fore_aft_deflection": slip}
        motion = Motion(rates, {**motion.outputs, "scrub_moment": scrub})
        if self.wheel_polar_inertia is None:
            return motion
        h = 2 * self.wheel_polar_inertia * wheel.speed / self.wheel_radius
        return gyroscopic(motion, x, h, self.yaw_inertia, self.lateral.inertia)

    def leaves_out(self) -> tuple[str, ...]:
        """Gyroscopic moments, where no inertia of a wheel is given, and what makes the two tyres different."""
        words = (
            "what turns an axle whose wheels are braked or loaded differently, and the limit of grip where side and "
            "longitudinal force meet (gear.axle)"
        )
        return (words, *(super().leaves_out() if self.wheel_polar_inertia is None else Gear.leaves_out(self)))


class TwinIndependent(Twin):
    """As twin, with wheels that spin each for itself, but for a coupling.

    A coupling to infinity is the common axle.
    """

    STATES: ClassVar[tuple[State, ...]] = (*Twin.STATES, State("spin_difference", "rad/s", "fore-aft"))

    kind: Literal["twin_independent"]  # type: ignore[assignment]  # each kind has a literal of its own
    wheel_polar_inertia: PolarInertia
    """I_p of one wheel with tyre and rotating brake about the axle [kg m^2]."""
    corotation: TorsionalDamping = 0.0
    """k_co, torque between the wheels over the difference of their spins [N m s/rad]."""

    def rates(self, x: Names, contacts: Sequence[Contact], damper: Torque, yaw_torque: Expr, corners: Corners) -> Motion:
        """u' = ... - R_w Omega_d, I_p Omega_d' = R_w K_x u - 2 k_co Omega_d; Omega_d is half the difference of the spins."""
        axle, u, spin = self.axle, x["fore_aft_deflection"], x["spin_difference"]
        motion = super().rates(x, contacts, damper, yaw_torque, corners)
        faster = self.wheel_radius * axle.deflection_stiffness * u - 2 * self.corotation * spin
        rates = {
            "fore_aft_deflection": motion.rates["fore_aft_deflection"] - self.wheel_radius * spin,
            "spin_difference": faster / self.wheel_polar_inertia,
        }
        return Motion({**motion.rates, **rates}, motion.outputs)

"""The gear whose strut gives way sideways as a whole, and swivelling parts whose mass lies off the strut axis.

With the displacement w of the strut at the axle (or l_c sin(delta) at the height of the mass), a swivelling mass m at the
distance x_g behind the axis moves by w + x_g sin(psi): the kinetic energy m (w' + x_g cos(psi) psi')^2/2 couples both motions.
Lateral elasticity in the place of bending: Bourcier de Carbon, NACA TM 1337 (1952). The equations are Lagrange's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import model_validator

from ..expressions.calculus import Expr, cos, sin
from ..expressions.corners import Corners
from ..ports.motion import Motion, Torque
from ..ports.wheel import Contact, Wheel
from ..quantities.named import Output, State
from ..quantities.record import Coordinate, Record, Stiffness, refuse
from ..quantities.units import Quantity
from .base import Gear, Names
from .drag import pushes
from .spinning_wheel import gyroscopic
from .yaw import Yaw
from .yaw_bending import YawBending

__all__ = ["BendingOffset", "Sideways", "Swivelling", "YawTranslation"]

Mass = Annotated[float, Quantity("kg", above=0, example="80 kg")]


class Sideways(Record):
    """Lateral translation of the strut."""

    mass: Mass
    """m_w of all that moves sideways, the swivelling parts included [kg]."""
    stiffness: Stiffness
    """k_w at the axle [N/m]."""
    damping: Annotated[float, Quantity("N s/m", at_least=0, example="50 N s/m")]
    """c_w [N s/m]."""


class Swivelling(Record):
    """Mass of the parts that swivel, and where it is."""

    mass: Mass
    """m of fork, axle, wheel and tyre [kg]."""
    offset: Coordinate
    """x_g, of its centre behind the strut axis [m]."""


class YawTranslation(Yaw):
    """Yaw of the piston and lateral translation of the strut, coupled by a mass off the strut axis; fifth order."""

    STATES: ClassVar[tuple[State, ...]] = (
        *Yaw.STATES,
        State("translation", "m", "lateral", twin="translation_rate"),
        State("translation_rate", "m/s", "lateral", twin="translation"),
    )
    OUTPUTS: ClassVar[tuple[Output, ...]] = (*Yaw.OUTPUTS, Output("lateral_displacement", "m", "of the axle by the strut, w"))
    ORDER: ClassVar[int | None] = None

    kind: Literal["yaw_translation"]  # type: ignore[assignment]  # each kind has a literal of its own
    sideways: Sideways
    swivelling: Swivelling | None = None
    """Mass off the strut axis; without it nothing but the tyre couples both motions."""

    @model_validator(mode="after")
    def _inertia(self) -> Self:
        if self.swivelling is not None:
            _refuse_indefinite(self, self.sideways.mass, "gear.sideways.mass", 1.0)
        return self

    def wheels(self, x: Names, speed: Expr, load: Expr) -> tuple[Wheel, ...]:
        """One wheel behind the strut axis, moved sideways by w."""
        (wheel,) = super().wheels(x, speed, load)
        lateral, rate = wheel.lateral - x["translation"], wheel.lateral_rate - x["translation_rate"]
        return (replace(wheel, lateral=lateral, lateral_rate=rate),)

    def rates(self, x: Names, contacts: Sequence[Contact], damper: Torque, yaw_torque: Expr, corners: Corners) -> Motion:
        """I_z psi'' + P cos(psi) w'' = Q_psi, m_w w'' + P cos(psi) psi'' - P sin(psi) psi'^2 = Q_w, with P = m x_g.

        Q_w = -k_w w - c_w w' - F_y cos(theta) cos(phi). Nothing rolls, so that the load has no lever on the strut.
        """
        yaw = super().rates(x, contacts, damper, yaw_torque, corners)
        (contact,), strut = contacts, self.sideways
        wheel, w, w_t = contact.wheel, x["translation"], x["translation_rate"]
        assert wheel is not None
        push = -strut.stiffness * w - strut.damping * w_t
        aside = sum(pushes(self.drag, wheel, self.wheel_radius))
        push += (aside - contact.side_force * cos(wheel.swivel)) * cos(self.rake_angle)
        P = 0 if self.swivelling is None else self.swivelling.mass * self.swivelling.offset
        psi, psi_t = x["yaw_angle"], x["yaw_rate"]
        yaw_tt, w_tt = _accelerations(
            (self.yaw_inertia * yaw.rates["yaw_rate"], push + P * sin(psi) * psi_t**2),
            (self.yaw_inertia, strut.mass, P * cos(psi)),
        )
        rates = {**yaw.rates, "yaw_rate": yaw_tt, "translation": w_t, "translation_rate": w_tt}
        return Motion(rates, {**yaw.outputs, "lateral_displacement": w})

    def leaves_out(self) -> tuple[str, ...]:
        """Roll of the wheel, and what hangs on it."""
        return (
            "roll of the wheel with the strut, and with it gyroscopic moments (gear.kind yaw_translation)",
            *Gear.leaves_out(self),
        )


class BendingOffset(YawBending):
    """As yaw_bending, with a swivelling mass off the strut axis: yaw and bending are coupled by inertia too."""

    ORDER: ClassVar[int | None] = None
    EXTENDS: ClassVar = ("yaw_bending", "swivelling")

    kind: Literal["yaw_bending_offset"]  # type: ignore[assignment]  # each kind has a literal of its own
    swivelling: Swivelling
    swivelling_height: Annotated[float, Quantity("m", above=0, example="2.1 m")]
    """l_c, of the swivelling mass below the attachment about which the strut bends [m]."""

    @model_validator(mode="after")
    def _inertia(self) -> Self:
        _refuse_indefinite(self, self.lateral.inertia, "gear.lateral.inertia", self.swivelling_height)
        return self

    def rates(self, x: Names, contacts: Sequence[Contact], damper: Torque, yaw_torque: Expr, corners: Corners) -> Motion:
        """I_z psi'' + P c_psi c_delta delta'' = Q_psi + P s_delta c_psi delta'^2, and alike for delta, with P = m x_g l_c."""
        motion = super().rates(x, contacts, damper, yaw_torque, corners)
        if self.wheel_polar_inertia is not None:
            wheel = contacts[0].wheel
            assert wheel is not None
            h = self.wheel_polar_inertia * wheel.speed / self.wheel_radius
            motion = gyroscopic(motion, x, h, self.yaw_inertia, self.lateral.inertia)
        psi, delta, psi_t, delta_t = (x[name] for name in ("yaw_angle", "bending_angle", "yaw_rate", "bending_rate"))
        I_z, I_x, P = (
            self.yaw_inertia,
            self.lateral.inertia,
            self.swivelling.mass * self.swivelling.offset * self.swivelling_height,
        )
        yaw_tt, delta_tt = _accelerations(
            (
                I_z * motion.rates["yaw_rate"] + P * sin(delta) * cos(psi) * delta_t**2,
                I_x * motion.rates["bending_rate"] + P * cos(delta) * sin(psi) * psi_t**2,
            ),
            (I_z, I_x, P * cos(psi) * cos(delta)),
        )
        return Motion({**motion.rates, "yaw_rate": yaw_tt, "bending_rate": delta_tt}, motion.outputs)

    def leaves_out(self) -> tuple[str, ...]:
        """Gyroscopic moments, where no inertia of the wheel is given."""
        return super().leaves_out() if self.wheel_polar_inertia is None else Gear.leaves_out(self)


def _accelerations(forces: tuple[Expr, Expr], inertias: tuple[Expr, Expr, Expr]) -> tuple[Expr, Expr]:
    """Solution of [[m_1, P], [P, m_2]] a = forces."""
    (Q_1, Q_2), (m_1, m_2, P) = forces, inertias
    determinant = m_1 * m_2 - P**2
    return (m_2 * Q_1 - P * Q_2) / determinant, (m_1 * Q_2 - P * Q_1) / determinant


def _refuse_indefinite(gear: Any, inertia: float, key: str, height: float) -> None:
    """An inertia below what the swivelling mass alone has makes motions without energy."""
    m, x_g = gear.swivelling.mass, gear.swivelling.offset
    for name, found, least in (("gear.yaw_inertia", gear.yaw_inertia, m * x_g**2), (key, inertia, m * height**2)):
        if not found > least:
            words = f"{name.removeprefix('gear.')} {found:g} is not above {least:g}, what the swivelling mass alone has"
            raise refuse(name.removeprefix("gear."), words, "all that moves, the swivelling mass included")

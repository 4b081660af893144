"""Dry friction as the damper, about the yaw axis: washers or a collar under a spring, as light gears have it.

Linear models and proofs see the viscous part alone: the smallest motions stick, and what friction adds falls with amplitude. A
gear that is unstable without friction stays at rest up to a kick, and beyond it does not: only simulation says which.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from importlib import import_module
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import model_validator

from ..expressions.calculus import Expr
from ..expressions.corners import Corners, Linear
from ..ports.sizing import Force
from ..quantities.named import Output, State
from ..quantities.record import Distance, Length, Torque, TorsionalDamping, refuse
from ..quantities.record import Force as ForceNumber
from ..quantities.units import Quantity
from .base import FORGOTTEN, Context, Damper

__all__ = ["Dahl", "FrictionDamper"]


class _Friction(Damper):
    """What both have: the torque at which it breaks out."""

    ROTARY: ClassVar = True
    OUTPUTS: ClassVar = (Output("friction_torque", "N m", "of the friction damper, against the motion"),)

    breakout_torque: Torque | None = None
    """T_0, without load [N m]; or `breakout_force` at `breakout_lever`."""
    breakout_force: ForceNumber | None = None
    """Sideways pull at which the wheel swivels, as builders measure it, such as 25 lbf at the axle [N]."""
    breakout_lever: Length | None = None
    """Of that pull about the strut axis [m]; left out: it is at the axle, at the caster length of the gear."""
    load_lever: Distance = 0.0
    """r_f, by which the torque grows with the load, T_c = T_0 + r_f F_z: coefficient times radius of a thrust face [m]."""
    viscous_damping: TorsionalDamping = 0.0
    """c, beside the friction [N m s/rad]."""

    @model_validator(mode="before")
    @classmethod
    def _as_builders_say(cls, data: Any) -> Any:
        """``breakout: 25 lbf at the axle``, ``25 lbf at 0.11 m``, or a torque, as the keys that say the same."""
        if not isinstance(data, dict) or "breakout" not in data:
            return data
        rest, text = {key: value for key, value in data.items() if key != "breakout"}, data["breakout"]
        what, at, where = text.partition(" at ") if isinstance(text, str) else (text, "", "")
        if not at:
            return {**rest, "breakout_torque": what}
        lever = {} if where.strip() == "the axle" else {"breakout_lever": where.strip()}
        return {**rest, "breakout_force": what.strip(), **lever}

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        by_force, lever = self.breakout_force is not None, self.breakout_lever is not None
        if by_force == (self.breakout_torque is not None) or (lever and not by_force):
            ways = "breakout_torque, or breakout_force (with breakout_lever, or at the axle)"
            raise refuse("", "incomplete or double breakout", ways)
        return self

    def breakout(self, context: Context) -> Expr:
        """T_c at a vertical load, and with the axle where the gear has it [N m]."""
        at_rest = self.breakout_torque
        if self.breakout_force is not None:
            at_rest = self.breakout_force * (context.axle if self.breakout_lever is None else self.breakout_lever)
        return at_rest + self.load_lever * context.load

    def leaves_out(self) -> tuple[str, ...]:
        """What the linear model of friction is."""
        return ("the friction of the damper, which small motions do not overcome: simulate has it (damper.breakout_torque)",)


class FrictionDamper(_Friction):
    """Coulomb friction about the yaw axis that sticks exactly, T = c psi' + T_c sign(psi')."""

    kind: Literal["friction"]
    smoothing: Annotated[float, Quantity("rad/s", above=0, example="0.001 rad/s")] = 1e-3
    """Yaw rate over which the smooth version turns around [rad/s]."""

    def force(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        rate: Expr,
        context: Context,
        corners: Corners,
    ) -> Force:
        """T = c psi' + T_c sign(psi'); an exact simulation lets it stick."""
        dry = self.breakout(context) * corners.sign("damper friction", rate, self.smoothing)
        return Force(self.viscous_damping * rate + dry, {}, {"friction_torque": dry})

    def equivalent(self, design: Mapping[str, Expr], amplitude: Expr, frequency: Expr, context: Context) -> tuple[Expr, Expr]:
        """c + 4 T_c/(pi omega X)."""
        return 0.0, self.viscous_damping + 4 * self.breakout(context) / (math.pi * frequency * amplitude)


class Dahl(_Friction):
    """Friction with an elastic beginning (Dahl), T' = sigma_0 psi' (1 - T sign(psi')/T_c); small motions meet a spring.

    The linear model is that spring, T_d = sigma_0 psi.
    """

    STATES: ClassVar = (State("dahl_torque", "N m", "friction"),)

    kind: Literal["dahl"]
    presliding_stiffness: Annotated[float, Quantity("N m/rad", above=0, example="20 kN m/rad")]
    """sigma_0, of the contact before it slides [N m/rad]."""
    smoothing: Annotated[float, Quantity("rad/s", above=0, example="1e-5 rad/s")] = 1e-5
    """Yaw rate below which the smooth version creeps [rad/s]."""

    def force(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        rate: Expr,
        context: Context,
        corners: Corners,
    ) -> Force:
        """T = c psi' + T_d, with the state T_d."""
        dry, sigma_0 = states["dahl_torque"], self.presliding_stiffness
        if isinstance(corners, Linear):
            forgotten = FORGOTTEN * (dry - sigma_0 * stroke)
        else:
            forgotten = sigma_0 * dry * corners.magnitude(rate, self.smoothing) / self.breakout(context)
        rates = {"dahl_torque": sigma_0 * rate - forgotten}
        return Force(self.viscous_damping * rate + dry, rates, {"friction_torque": dry})

    def equivalent(self, design: Mapping[str, Expr], amplitude: Expr, frequency: Expr, context: Context) -> tuple[Expr, Expr]:
        """2 T_c I_1(rho)/(X cosh(rho)) and 4 T_c/(pi omega X) (1 - tanh(rho)/rho), rho = sigma_0 X/T_c; numbers alone."""
        T_c, X = self.breakout(context), amplitude
        rho = self.presliding_stiffness * X / T_c
        # I_1 and cosh both grow as exp(rho)
        stiffness = 4 * T_c * import_module("scipy.special").i1e(rho) / (X * (1 + math.exp(-2 * rho)))
        damping = 4 * T_c / (math.pi * frequency * X) * (1 - math.tanh(rho) / rho)
        return stiffness, self.viscous_damping + damping

"""Viscous damping about the yaw axis, given as it is."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Literal

from ..expressions.calculus import Expr
from ..expressions.corners import Corners
from ..ports.sizing import Force
from ..quantities.record import TorsionalDamping
from .base import Context, Damper

__all__ = ["Torsional"]


class Torsional(Damper):
    """Torque in proportion to the yaw rate, T = torsional_damping psi'."""

    ROTARY: ClassVar = True

    kind: Literal["torsional"] = "torsional"
    torsional_damping: TorsionalDamping
    """c_psi about the yaw axis [N m s/rad]."""

    def force(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        rate: Expr,
        context: Context,
        corners: Corners,
    ) -> Force:
        """T = c_psi psi' [N m]."""
        return Force(self.torsional_damping * rate)

    def equivalent(self, design: Mapping[str, Expr], amplitude: Expr, frequency: Expr, context: Context) -> tuple[Expr, Expr]:
        """c_psi."""
        return 0.0, self.torsional_damping

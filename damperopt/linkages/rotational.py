"""Stiffness and damping about the yaw axis, without a linkage."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Literal

from ..expressions.calculus import Expr
from ..ports.linkage import Linkage
from ..quantities.record import TorsionalStiffness
from .base import Layout, straight

__all__ = ["Rotational"]


class Rotational(Layout):
    """Spring and damper act about the yaw axis itself; for gears whose stiffness and damping are given."""

    ROTARY: ClassVar = True
    DAMPER: ClassVar = "torsional"

    topology: Literal["rotational"]
    torsional_stiffness: TorsionalStiffness
    """k_psi about the yaw axis [N m/rad]."""

    def linkage(self, design: Mapping[str, Expr], youngs_modulus: Expr, stroke: Expr = 0) -> Linkage:
        """Levers of 1, so that strokes are angles, and forces torques."""
        return straight(self.torsional_stiffness, 1, 1, 1)

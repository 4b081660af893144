"""Loads that size the parts, and what a damper answers to them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ..expressions.calculus import Expr

__all__ = ["Capacity", "Force", "LimitEvent", "Peaks", "Size", "Sized"]


@dataclass(frozen=True)
class Force:
    """Force of a damper along its stroke; expressions.

    Attributes
    ----------
    force : Expr
        Against the stroke where positive [N] (for a rotary damper a torque [N m]).
    rates : mapping of str to Expr
        Derivatives of the damper's own states, by name.
    outputs : mapping of str to Expr
        By declared name [SI].
    """

    force: Expr
    rates: Mapping[str, Expr] = field(default_factory=dict)
    outputs: Mapping[str, Expr] = field(default_factory=dict)


@dataclass(frozen=True)
class Peaks:
    """Largest side force [N] and aligning moment [N m] that a slip law can give at a load."""

    side_force: Expr
    aligning_moment: Expr


@dataclass(frozen=True)
class LimitEvent:
    """Loads of the limit event; expressions.

    Attributes
    ----------
    torque : Expr
        Yaw torque T_lim [N m].
    yaw, yaw_rate : Expr
        Static yaw angle [rad] and peak yaw rate [rad/s].
    stroke, damper_force : Expr
        Peak damper stroke to one side [m] and peak damper force [N].
    apex_force : Expr
        Lateral force at the apex of the torque links [N].
    arm_moment : Expr
        Root bending moment of the bending arm [N m]; 0 without an arm.
    spring_force : Expr
        Force of the spring or arm tip [N].
    spring_energy : Expr
        Energy that the spring stores [J].
    safety_factor : Expr
        On yield strength under these loads.
    ultimate_factor : Expr
        On rupture and buckling under these loads.
    service_stroke : Expr
        Damper stroke to one side under the torque of service [m]; None: the same as `stroke`.
    flight : FlightStresses or None
        Torques of a flight over the limit torque; None: the parts are not sized by a spectrum.
    design : mapping of str to Expr
        Design variables by name [SI].
    """

    torque: Expr
    yaw: Expr
    yaw_rate: Expr
    stroke: Expr
    damper_force: Expr
    apex_force: Expr
    arm_moment: Expr
    spring_force: Expr
    spring_energy: Expr
    safety_factor: Expr = 1
    ultimate_factor: Expr = 1.5
    service_stroke: Expr = None
    flight: Any = None
    design: Mapping[str, Expr] = field(default_factory=dict)


@dataclass(frozen=True)
class Size:
    """A size of a part that the optimiser chooses because several limits act on it: its mass grows with it.

    Attributes
    ----------
    name, unit : str
    symbol : Expr
        Stands for it in masses and lengths.
    least : mapping of str to (Expr, tuple of str)
        Least value by the name of the limit, and the key paths that would relax it.
    start, lower, upper : float
        [unit]; of a size that is no design variable.
    """

    name: str
    unit: str
    symbol: Expr
    least: Mapping[str, tuple[Expr, tuple[str, ...]]]
    start: float = 1.0
    lower: float = 0.0
    upper: float = math.inf


@dataclass(frozen=True)
class Capacity:
    """What a part of given size can do, and what the limit event asks of it; expressions.

    Attributes
    ----------
    name, unit : str
    has, asked : Expr
        Most that it can do, and the least that it must [unit].
    relaxed_by : tuple of str
        Key paths that would relax it.
    """

    name: str
    unit: str
    has: Expr
    asked: Expr
    relaxed_by: tuple[str, ...]


@dataclass(frozen=True)
class Sized:
    """A damper sized by the limit event; expressions.

    Attributes
    ----------
    masses : mapping of str to Expr
        Part -> mass [kg], fittings included.
    sizes : tuple of Size
        Sizes to be chosen, that the masses hang on: design variables by their name, or numbers of their own.
    length : Expr or None
        Pin-to-pin length that it needs [m].
    capacities : tuple of Capacity
        Of what is given and not chosen.
    """

    masses: Mapping[str, Expr]
    sizes: tuple[Size, ...] = ()
    length: Expr = None
    capacities: tuple[Capacity, ...] = ()

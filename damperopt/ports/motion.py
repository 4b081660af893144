"""What a gear answers: its accelerations, and where a damper holds it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ..expressions.calculus import Expr

__all__ = ["Attachment", "Motion", "Torque"]


@dataclass(frozen=True)
class Motion:
    """Equations of a gear; expressions.

    Attributes
    ----------
    rates : mapping of str to Expr
        Derivative of every state of the gear, by its name.
    outputs : mapping of str to Expr
        Other quantities by declared name [SI].
    """

    rates: Mapping[str, Expr]
    outputs: Mapping[str, Expr] = field(default_factory=dict)


@dataclass(frozen=True)
class Attachment:
    """Where a linkage or a damper acts on a gear; expressions.

    Attributes
    ----------
    angle, rate : Expr
        That the linkage feels [rad], [rad/s].
    row : mapping of str to Expr
        Generalised force on each state's equation of motion for a unit torque, by the name of the rate; of the yaw axis
        ``{"yaw_rate": 1}``.
    """

    angle: Expr
    rate: Expr
    row: Mapping[str, Expr] = field(default_factory=lambda: {"yaw_rate": 1})


@dataclass(frozen=True)
class Torque:
    """Torque of linkage and damper on the gear, and the states and unknowns that it needs; expressions.

    Attributes
    ----------
    torque : Expr
        On the gear [N m], against positive yaw where negative.
    states, rates : mapping of str to Expr
        Further states, in their order, and their derivatives.
    unknowns : sequence of Expr
        Algebraic unknowns (symbols), with
    rest, residuals : sequence of Expr
        their values at rest and the equations = 0.
    outputs : mapping of str to Expr
        By declared name [SI].
    newton_steps : int or None
        That the unknowns need from their first-order guess; None: as few as a closed linkage.
    relaxed : mapping of str to Expr
        Value of further states where the gear is held still for long, of its states; others rest at 0.
    """

    torque: Expr
    states: Mapping[str, Expr] = field(default_factory=dict)
    rates: Mapping[str, Expr] = field(default_factory=dict)
    unknowns: tuple[Expr, ...] = ()
    rest: tuple[Expr, ...] = ()
    residuals: tuple[Expr, ...] = ()
    outputs: Mapping[str, Expr] = field(default_factory=dict)
    newton_steps: int | None = None
    relaxed: Mapping[str, Expr] = field(default_factory=dict)

"""What a gear tells a tyre, and what the tyre answers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from ..expressions.calculus import Expr

__all__ = ["Contact", "Wheel"]


@dataclass(frozen=True)
class Wheel:
    """A wheel on the ground, as its gear moves it; expressions.

    Attributes
    ----------
    speed : Expr
        V, forward [m/s].
    swivel, swivel_rate : Expr
        theta, angle of the wheel plane to the direction of motion [rad], [rad/s].
    lateral, lateral_rate : Expr
        eta, displacement of the contact centre in the direction of the side force [m], [m/s]: of the gears here
        -(e_eff sin(theta) + l_g sin(delta)).
    trail : Expr
        Of the contact centre behind the strut axis, e_eff [m].
    load : Expr
        Vertical load F_z on this wheel [N].
    forward_rate : Expr
        Forward speed of the axle against the aircraft [m/s].
    camber : Expr
        [rad]
    index : int
        Of this wheel among those of the gear.
    pressure : Expr or None
        Of its tyre [Pa]; None: that of the study.
    load_rate : Expr
        Of F_z along a history [N/s].
    """

    speed: Expr
    swivel: Expr
    swivel_rate: Expr
    lateral: Expr
    lateral_rate: Expr
    trail: Expr
    load: Expr
    forward_rate: Expr = 0
    camber: Expr = 0
    index: int = 0
    pressure: Expr = None
    load_rate: Expr = 0


@dataclass(frozen=True)
class Contact:
    """What the ground does to a wheel; expressions.

    Attributes
    ----------
    rates : sequence of Expr
        Derivatives of the tyre's states, in their order.
    side_force : Expr
        F_y on the wheel [N]; a positive one turns the wheel back to swivel 0 behind a positive trail.
    aligning_moment : Expr
        Moment about the vertical that turns the wheel back [N m], that of the tread width (kappa theta'/V) included.
    drag : Expr
        Backwards [N].
    outputs : mapping of str to Expr
        Other quantities by declared name [SI].
    deflection : Expr or None
        Of the tyre on the ground against its wheel, in the direction of the side force, were it standing [m]; None: unknown.
    wheel : Wheel or None
        The wheel that it belongs to: gears read load and speed from it.
    """

    rates: Sequence[Expr]
    side_force: Expr
    aligning_moment: Expr
    drag: Expr = 0
    outputs: Mapping[str, Expr] = field(default_factory=dict)
    deflection: Expr = 0
    wheel: Wheel | None = None

"""A damper linkage: lengths and levers as expressions of an angle, and the members that it is made of."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from ..expressions.calculus import Expr

__all__ = ["Compliant", "Linkage", "Member", "Path", "Point", "Position"]

Point = tuple[Expr, Expr, Expr]
"""x aft, y to the side, z up the strut [m]; origin on the strut axis at the height of the apex at rest."""


@dataclass(frozen=True)
class Position:
    """The linkage at an angle; expressions.

    Attributes
    ----------
    deflection, stroke : Expr
        Deflection eps of the spring or arm tip, and stroke s of the damper from rest [m].
    spring_lever, damper_lever : Expr
        d eps/d psi and ds/d psi [m/rad].
    """

    deflection: Expr
    spring_lever: Expr
    stroke: Expr
    damper_lever: Expr


@dataclass(frozen=True)
class Path:
    """The linkage along a coordinate of its own, in which all of it is explicit; expressions.

    Attributes
    ----------
    angle, deflection, stroke : Expr
        psi [rad], eps [m] and s [m].
    angle_slope, deflection_slope, stroke_slope : Expr
        Their derivatives with respect to the coordinate.
    """

    angle: Expr
    angle_slope: Expr
    deflection: Expr
    deflection_slope: Expr
    stroke: Expr
    stroke_slope: Expr


@dataclass(frozen=True)
class Compliant:
    """An elastic part of the chain from the gear to the damper.

    Attributes
    ----------
    part : str
        Key of the study's block ``compliance``: ``link``, ``arm``, ``support`` or ``damper``.
    stiffness : Expr
        In front: laterally at the apex; otherwise along the damper [N/m].
    in_front : bool
        Whether it stands between the gear and the linkage, or between the linkage and the damper.
    """

    part: str
    stiffness: Expr
    in_front: bool = False


@dataclass(frozen=True)
class Linkage:
    """A damper layout; expressions in the design variables.

    Attributes
    ----------
    stiffness : Expr
        k_eps [N/m] along the deflection.
    at : callable
        Angle psi [rad] -> Position.
    spring_lever, damper_lever : Expr
        d eps/d psi and ds/d psi at psi = 0 [m/rad].
    reach : Expr
        Horizontal distance of the apex from the strut axis, L sin(gamma) [m].
    arm_length : Expr or None
        Length of the bending arm that enters its bending [m].
    damper_length : Expr or None
        Pin-to-pin length of the damper [m]; None where the layout does not limit it.
    unknowns, rest : sequence of Expr
        Algebraic unknowns of the closed loop (symbols), and their values at psi = 0; empty unless the loop is in space.
    closure : callable
        psi -> residuals, zero where the loop is closed.
    as_printed : mapping of str to Expr
        Design values that a printed formula puts in the place of the design's own, as seen by the damper.
    path : callable or None
        Coordinate -> Path; None: the coordinate is psi itself.
    coordinate : str
        Its name among the states of an elastic chain.
    links : Expr or None
        Stiffness of all that stands in front of the linkage, laterally at the apex [N/m]; None: rigid.
    series : Expr or None
        Stiffness of all that stands in series with the damper, along it [N/m]; None: rigid.
    """

    stiffness: Expr
    at: Callable[[Expr], Position]
    spring_lever: Expr
    damper_lever: Expr
    reach: Expr
    arm_length: Expr = None
    damper_length: Expr = None
    unknowns: Sequence[Expr] = ()
    rest: Sequence[Expr] = ()
    closure: Callable[[Expr], Sequence[Expr]] = lambda psi: ()
    as_printed: Mapping[str, Expr] = field(default_factory=dict)
    path: Callable[[Expr], Path] | None = None
    coordinate: str = "link_angle"
    links: Expr = None
    series: Expr = None

    def along(self, coordinate: Expr) -> Path:
        """The linkage at a value of its own coordinate."""
        if self.path is not None:
            return self.path(coordinate)
        found = self.at(coordinate)
        return Path(coordinate, 1, found.deflection, found.spring_lever, found.stroke, found.damper_lever)

    @property
    def torsional_stiffness(self) -> Expr:
        """k_psi of the spring or arm [N m/rad] at psi = 0."""
        return self.stiffness * self.spring_lever**2


@dataclass(frozen=True)
class Member:
    """A straight member of a layout: drawn, weighed and checked from this one record.

    Attributes
    ----------
    name : str
        Such as ``lower torque link``.
    part : str
        Part of the mass table that it counts to; empty: it is not weighed here (a damper weighs itself).
    kind : str
        ``link``, ``arm``, ``beam`` (of its section), ``hinge``, ``foot`` (hinge of a support), ``support`` or ``damper``.
    start, end : Point
        [m], at rest.
    section : str
        Key of the mass model's section, such as ``link_section``.
    inertia : Expr or None
        Second moment of area [m^4] at the root of a member that bends.
    area : Expr or None
        Of a leg, which carries along itself alone [m^2]. Neither area nor inertia: a cantilever of uniform stress that is sized
        by its load.
    load : str
        Of the limit event, at its end: ``apex_force``, ``damper_force`` or ``spring_force``.
    share : Expr
        Force along a leg over the load.
    taper : float
        Mass over that of the prismatic member.
    variable : str
        Design variable that its section hangs on, where that is chosen; members that share one are sized by the first.
    length : Expr or None
        Length that is weighed [m]; None: from start to end.
    bending_length : Expr or None
        Lever of the load at the root [m]; None: the length.
    thrust : Expr
        Force along a member that bends over the load.
    """

    name: str
    part: str
    kind: str
    start: Point
    end: Point
    section: str = ""
    inertia: Expr = None
    area: Expr = None
    load: str = "apex_force"
    share: Expr = 1
    taper: float = 1.0
    variable: str = ""
    length: Expr = None
    bending_length: Expr = None
    thrust: Expr = 0

    @property
    def is_beam(self) -> bool:
        """Whether others turn on it: it has no eyes of its own."""
        return self.kind in ("beam", "hinge", "foot")

"""What every load case is: forces on the gear by a rule, and the torque about the strut axis that they make."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

from ..expressions.calculus import Expr, absolute, where
from ..quantities.kinds import kinds
from ..quantities.record import Record

__all__ = [
    "Context",
    "LoadCase",
    "Loads",
    "Row",
    "larger",
    "load_cases",
    "load_table",
    "standard_cases",
    "trail_left",
    "worst_torque",
]

ULTIMATE = 1.5
"""Ultimate over limit load (14 CFR 25.303)."""

FRICTION = 0.8
"""Of a tyre on dry ground, as the rules have it (25.493, 25.503)."""


def larger(a: Expr, b: Expr) -> Expr:
    """The larger of two numbers."""
    return where(a > b, a, b)


@dataclass(frozen=True)
class Context:
    """The gear that a case acts on; expressions.

    Attributes
    ----------
    largest_vertical : Expr
        Largest vertical load of the envelope [N]; stands for each vertical that is not given.
    e_eff : Expr
        Lever of the contact point behind the strut axis [m].
    trail : Expr
        Pneumatic trail of the tyre at small slip [m].
    half_contact_length, wheel_radius : Expr
        [m]
    half_track : Expr
        Of two wheels beside the strut axis [m]; 0 for a single one.
    wheels : int
        1 or 2.
    gear : str
        ``main`` or ``nose``.
    landing_vertical : Expr or None
        Largest vertical reaction of a level landing [N].
    static_reaction : Expr or None
        Of the gear at ramp weight [N].
    aircraft_weight : Expr or None
        At ramp, a force [N].
    brake_torque : Expr or None
        Nominal maximum static torque of the gear's brakes [N m].
    unsprung_mass : Expr or None
        [kg]
    tyre_moment : Expr or None
        Largest yaw torque that the tyre's own law can make [N m]; None where it has no peak.
    limit_torque, limit_torque_factor : Expr or None
        Of the requirements [N m, 1].
    shimmy_torque : Expr or None
        Peak of the simulated release or kick [N m].
    """

    largest_vertical: Expr
    e_eff: Expr
    trail: Expr
    half_contact_length: Expr
    wheel_radius: Expr
    half_track: Expr = 0.0
    wheels: int = 1
    gear: Literal["main", "nose"] = "main"
    landing_vertical: Expr = None
    static_reaction: Expr = None
    aircraft_weight: Expr = None
    brake_torque: Expr = None
    unsprung_mass: Expr = None
    tyre_moment: Expr = None
    limit_torque: Expr = None
    limit_torque_factor: Expr = 1.5
    shimmy_torque: Expr = None

    def landing(self, share: float) -> Expr:
        """F_z of a landing case [N]: `share` of the largest of a landing; where that is not given, the envelope's."""
        return self.largest_vertical if self.landing_vertical is None else share * self.landing_vertical

    @property
    def static(self) -> Expr:
        """F_z of a case of ground handling at 1 g [N]."""
        return self.largest_vertical if self.static_reaction is None else self.static_reaction


@dataclass(frozen=True)
class Loads:
    """Forces of a case, and where they act; expressions, magnitudes.

    Attributes
    ----------
    vertical, side, drag : Expr
        F_z, F_y, F_x [N].
    lever : Expr
        Of the side force about the strut axis [m], e_eff + t.
    offset : Expr
        Of the drag beside the strut axis [m].
    moment : Expr
        About the vertical, beside what the forces make: scrub of the tyre [N m].
    acts_at : str
        Where the forces act, in words.
    """

    vertical: Expr
    side: Expr = 0.0
    drag: Expr = 0.0
    lever: Expr = 0.0
    offset: Expr = 0.0
    moment: Expr = 0.0
    acts_at: str = "ground contact point"

    @property
    def yaw_torque(self) -> Expr:
        """T about the strut axis [N m]: side force on its lever, drag on its offset, scrub; all in one sense."""
        return absolute(self.side) * self.lever + absolute(self.drag) * self.offset + self.moment


class LoadCase(Record):
    """A load case: a rule, its numbers, and the loads that they give on a gear.

    A case is a class with a literal `kind` in a file of this room, or of another distribution.
    """

    GROUP: ClassVar[str] = "damperopt.load_cases"
    RULE: ClassVar[str] = ""
    """Number of the rule."""
    READ: ClassVar[str] = ""
    """Where its text was read; empty: it was not, and the case is off until it is enabled."""
    GEARS: ClassVar[tuple[str, ...]] = ("main", "nose")
    """Gears that it is for."""
    NEEDS: ClassVar[tuple[str, ...]] = ()
    """Numbers of the context without which it has no loads."""

    kind: str
    enabled: bool | None = None
    """Whether it counts; left out: if it is for this gear, its rule has been read and its numbers are given."""

    @property
    def rule(self) -> str:
        """Number of the rule, or what stands for it."""
        return self.RULE

    @property
    def level(self) -> Literal["limit", "ultimate"]:
        """What the loads are: limit loads, or ultimate ones."""
        return "limit"

    @property
    def nature(self) -> Literal["static", "dynamic"]:
        """Static loads load spring and arm, a dynamic one is the peak of a motion."""
        return "static"

    def missing(self, context: Context) -> tuple[str, ...]:
        """Numbers of the context that it lacks."""
        return tuple(name for name in self.NEEDS if getattr(context, name) is None)

    def off(self, context: Context) -> str:
        """Why the case does not count, in words; empty where it does.

        Parameters
        ----------
        context : Context
        """
        if missing := self.missing(context):
            return f"needs {', '.join(missing)}"
        if self.enabled is not None:
            return "" if self.enabled else "switched off"
        if context.gear not in self.GEARS:
            return f"is for a {' or '.join(self.GEARS)} gear"
        return "" if self.READ else "its text has not been read: enable it to count it"

    def loads(self, context: Context) -> Loads | None:
        """Forces of the case; None where the context lacks numbers.

        Parameters
        ----------
        context : Context
            Floats or symbols.
        """
        return None if self.missing(context) else self.forces(context)

    def forces(self, context: Context) -> Loads:
        """Forces of the case on a gear that has all its numbers.

        Parameters
        ----------
        context : Context
            Floats or symbols.
        """
        raise NotImplementedError  # every case says it


def trail_left(side: float, drag: float = 0.0) -> float:
    """Part of the pneumatic trail of small slip that is left at a force in the ground, 1 to 0 at the friction limit.

    Brush tyre with parabolic pressure (Pacejka 2012, chapter 3): with u the part of the friction that is used,
    t/t_0 = 3 (1 - u) (1 - (1 - u)^(1/3))/u.

    Parameters
    ----------
    side, drag : float
        Over the vertical load [1].

    Returns
    -------
    float

    Examples
    --------
    >>> trail_left(0.8), round(trail_left(0.5), 4), round(trail_left(1e-6), 4)
    (0.0, 0.502, 1.0)
    """
    u = (side**2 + drag**2) ** 0.5 / FRICTION
    if u <= 0:
        return 1.0
    return max(0.0, 3 * (1 - u) * (1 - (1 - u) ** (1 / 3)) / u) if u < 1 else 0.0


@dataclass(frozen=True)
class Row:
    """A line of the table of load cases.

    Attributes
    ----------
    name, rule, read : str
        Name of the case, its rule, where that was read.
    loads : Loads or None
        None where the case lacks numbers.
    level, nature : str
        ``limit`` or ``ultimate``, ``static`` or ``dynamic``.
    off : str
        Why it does not count; empty where it does.
    """

    name: str
    rule: str
    read: str
    loads: Loads | None
    level: str
    nature: str
    off: str = ""

    def limit_torque(self) -> Expr:
        """Yaw torque at limit load [N m]: of an ultimate case its part, whatever factor a study asks for beyond it."""
        if self.loads is None:
            return 0.0
        return self.loads.yaw_torque / (ULTIMATE if self.level == "ultimate" else 1)


def load_cases() -> dict[str, type[LoadCase]]:
    """Load cases by kind."""
    return kinds("load_cases", LoadCase, "kind")


def standard_cases() -> dict[str, LoadCase]:
    """Load cases that need no numbers of a study's own, by kind, at their defaults."""
    return {
        tag: kind(kind=tag)
        for tag, kind in load_cases().items()
        if not any(field.is_required() for name, field in kind.model_fields.items() if name != "kind")
    }


def load_table(cases: Mapping[str, Any], context: Context) -> tuple[Row, ...]:
    """Every case with its loads, those that count and those that do not.

    Parameters
    ----------
    cases : mapping of str to LoadCase
        By name.
    context : Context
        Floats or symbols.

    Returns
    -------
    tuple of Row
    """
    return tuple(
        Row(name, case.rule, case.READ, case.loads(context), case.level, case.nature, case.off(context))
        for name, case in cases.items()
    )


def worst_torque(table: tuple[Row, ...], static_only: bool = False) -> Expr:
    """Largest limit yaw torque of the cases that count [N m]; 0 where none does.

    Parameters
    ----------
    table : tuple of Row
    static_only : bool
        Without the peaks of motions.
    """
    worst: Expr = 0.0
    for row in table:
        if not row.off and not (static_only and row.nature == "dynamic"):
            worst = larger(row.limit_torque(), worst)
    return worst

"""Named quantities: what a component declares where it arises, and what tables, figures and reports read."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["DesignVariable", "Output", "State"]


@dataclass(frozen=True)
class State:
    """A state of the equations of motion.

    Attributes
    ----------
    name : str
        Such as ``yaw_angle``.
    unit : str
        SI unit.
    freedom : str
        Degree of freedom that it belongs to (``yaw``, ``bending``, ``string``, ...); modes are named by it.
    twin : str or None
        Name of the rate that goes with an angle, or of the angle that goes with a rate.
    hidden : bool
        An internal state, left out of tables and figures.
    even : bool
        Whether a mirrored motion has it unchanged, as a current; others change sign.
    """

    name: str
    unit: str
    freedom: str
    twin: str | None = None
    hidden: bool = False
    even: bool = False


@dataclass(frozen=True)
class Output:
    """A quantity that a trajectory shows beside the states: name, SI unit, what it is."""

    name: str
    unit: str
    meaning: str = ""


@dataclass(frozen=True)
class DesignVariable:
    """A number that the optimiser may choose; always positive.

    Attributes
    ----------
    name : str
        Key in ``design`` and in results.
    unit : str
        SI unit.
    symbol : str
        For the axes of figures, in mathtext.
    meaning : str
        In words.
    logarithmic : bool
        Whether it is scaled by its logarithm (quantities that range over decades), or as it is.
    below : float or None
        Open upper limit, where the quantity has one.
    example : str
        A value with a unit that would be accepted.
    """

    name: str
    unit: str
    symbol: str = ""
    meaning: str = ""
    logarithmic: bool = True
    below: float | None = None
    example: str = ""

"""What was found at a point, proved over an envelope, and seen of the decay: plain data of a result."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from pydantic import ConfigDict

__all__ = ["FINITE", "Certificate", "DecayCheck", "LimitCycleCheck", "OperatingPoint"]

FINITE = ConfigDict(allow_inf_nan=False, extra="forbid")
"""What `optimise` cannot have written is refused when a file is read: a NaN would pass for proved."""

Verdict = Literal["proved", "refuted", "undecided"]
"""Of a certificate: it holds, a point of the envelope contradicts it, or neither was shown."""


@dataclass(frozen=True)
class OperatingPoint:
    """A speed [m/s], a vertical load [N] and a factor on the damping, with the spectral abscissa there [1/s]."""

    __pydantic_config__: ClassVar[ConfigDict] = FINITE

    speed: float
    load: float
    abscissa: float
    damping: float = 1.0

    @property
    def place(self) -> tuple[float, float, float]:
        """Speed, load, factor on the damping."""
        return self.speed, self.load, self.damping


@dataclass(frozen=True)
class Certificate:
    """Outcome of `certify`.

    Attributes
    ----------
    proved : bool
        True: every speed and load of the envelope has a spectral abscissa below -margin.
    margin : float
        The margin that was tested [1/s].
    speed : tuple of float
        Speed range [m/s].
    loads : tuple of float
        The loads, or the ends of the range [N].
    method : str
        ``sturm`` or ``bernstein``; with contact memory ``balls``, over a range of loads ``balls, rectangle``.
    counterexample : tuple of float or None
        (speed [m/s], load [N]) where the margin is missed or not strictly met, if not proved; None also where a load range
        could not be decided.
    reason : str
        One sentence.
    boxes : int
        Rectangles examined (``bernstein``), or boxes of frequency, speed and load (``balls``).
    verdict : str or None
        ``proved``, ``refuted`` or ``undecided``.
    frequency : float or None
        Of the root at the counterexample, or where it could not be decided [rad/s].
    damping : tuple of float or None
        Ends of the interval of factors on the damping; None: the damping as designed alone.
    damping_factor : float or None
        Of the counterexample, with an interval.
    """

    __pydantic_config__: ClassVar[ConfigDict] = FINITE

    proved: bool
    margin: float
    speed: tuple[float, float]
    loads: tuple[float, ...]
    method: str
    counterexample: tuple[float, float] | None
    reason: str
    boxes: int = 0
    verdict: Verdict | None = None
    frequency: float | None = None
    damping: tuple[float, float] | None = None
    damping_factor: float | None = None

    @property
    def place(self) -> tuple[float, float, float] | None:
        """Speed, load and damping factor of the counterexample."""
        return None if self.counterexample is None else (*self.counterexample, self.damping_factor or 1.0)

    @property
    def over_a_range(self) -> bool:
        """Whether `loads` are the ends of a range."""
        return self.method in ("bernstein", "balls, rectangle")

    @property
    def found(self) -> Verdict:
        """The verdict; where none was given, that of the other fields."""
        return self.verdict or ("proved" if self.proved else "undecided" if self.counterexample is None else "refuted")


@dataclass(frozen=True)
class DecayCheck:
    """Decay of a design over the envelope.

    Attributes
    ----------
    passed : bool
        The ratio is not exceeded anywhere that was looked at.
    limit : float
        Required ratio.
    cycles : int
        Cycles that are counted.
    speed, load, ratio : float
        Where it is largest [m/s], [N], by the exact simulation, and how large.
    optimised : float
        Largest ratio by the smooth simulation that the optimiser used.
    simulations : int
        Exact simulations that were made.
    peaks : dict of str to float
        Largest magnitudes that they show [SI].
    engine : str
        Integrator of the optimiser, and whether a missing C compiler decided that.
    damping : float
        Factor on the damping where the ratio is largest.
    """

    __pydantic_config__: ClassVar[ConfigDict] = FINITE

    passed: bool
    limit: float
    cycles: int
    speed: float
    load: float
    ratio: float
    optimised: float
    simulations: int
    peaks: dict[str, float]
    engine: str = ""
    damping: float = 1.0


@dataclass(frozen=True)
class LimitCycleCheck:
    """Limit cycles of a design over the envelope, as branches from motions show them.

    Attributes
    ----------
    passed : bool
        No stable cycle of more yaw was found, no branch was lost, and no motion left the range of the model.
    limit, yaw_angle : float
        Largest amplitude allowed, and found [rad]; 0 where no stable cycle was found.
    speed, load : float
        Where it is largest [m/s], [N].
    gap : float
        Play of the apex joint to one side [m].
    branches, lost : int
        How many were followed, and on how many the method failed before their ends.
    left : int
        Motions that left the range of the model; what becomes of these is not known.
    """

    __pydantic_config__: ClassVar[ConfigDict] = FINITE

    passed: bool
    limit: float
    yaw_angle: float
    speed: float
    load: float
    gap: float
    branches: int
    lost: int
    left: int

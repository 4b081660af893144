"""What the thesis' text says of its stability charts, each statement put to the numbers: it agrees, or differs for a reason."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...charts.chart import StabilityChart
from .charts import needed_damping

__all__ = ["CHART_CLAIMS", "Claim", "Verdict"]

LEVELS = np.linspace(0.1, 0.9, 17)
"""Fractions of the vertical axis at which curves are compared."""

ALIKE, NEAR_ZERO, SLOW_SPEED = 0.02, 1e-4, 3.0


@dataclass(frozen=True)
class Verdict:
    """Whether a claim holds, and the numbers that say so."""

    agrees: bool
    numbers: str


@dataclass(frozen=True)
class Claim:
    """A statement of the thesis' text.

    Attributes
    ----------
    text : str
    holds : callable
        Takes the chart, or the responses, of the figure; and those of the figure `against` where there is one.
    against : str
        Number of the figure that the text compares with.
    why_not : str
        Where the numbers differ: why.
    """

    text: str
    holds: Callable[..., Verdict]
    against: str = ""
    why_not: str = ""


def _needed(record: StabilityChart, levels: np.ndarray = LEVELS) -> np.ndarray:
    """(families, levels)"""
    heights = record.y.low + (record.y.high - record.y.low) * levels
    return np.array([[needed_damping(record, k, height) for height in heights] for k in range(len(record.families))])


def _words(record: StabilityChart, numbers: np.ndarray) -> str:
    assert record.varied is not None
    name = record.varied.name.split(".")[-1].replace("_", " ").replace("youngs modulus", "E")
    scale, unit = {"Pa": (1e-9, "GPa"), "rad": (180 / np.pi, "deg")}.get(record.varied.unit, (1.0, record.varied.unit))
    values = ", ".join(f"{scale * (family.value or 0):.3g}" for family in record.families)
    return f"{', '.join(f'{n:.3g}' for n in numbers)} for {name} {values} {unit}"


def _ratio(needed: np.ndarray) -> float:
    """Largest over least; infinite where some need no damping, 1 where none does."""
    least, largest = float(needed.min()), float(needed.max())
    return largest / least if least > 0 else np.inf if largest > 0 else 1.0


def _median(record: StabilityChart) -> np.ndarray:
    """(families,) over the levels."""
    return np.median(_needed(record), axis=1)


def _falls(record: StabilityChart) -> Verdict:
    middle = _median(record)
    return Verdict(bool((np.diff(middle) < 0).all()), f"median damping needed [N s/m]: {_words(record, middle)}")


def _rises(record: StabilityChart) -> Verdict:
    middle = _median(record)
    return Verdict(bool((np.diff(middle) > 0).all()), f"median damping needed [N s/m]: {_words(record, middle)}")


def _slow_needs_more_when_soft(record: StabilityChart) -> Verdict:
    soft = _needed(record, LEVELS[:1])[:, 0]
    return Verdict(bool((np.diff(soft) < 0).all()), f"damping needed with a slender arm [N s/m]: {_words(record, soft)}")


def _stiffness_share(record: StabilityChart) -> np.ndarray:
    """(families,) largest over least damping needed along the vertical axis."""
    needed = _needed(record)
    return np.array([_ratio(row) for row in needed])


def _stiffness_matters_less(record: StabilityChart) -> Verdict:
    needed, share = _needed(record), _stiffness_share(record)
    return Verdict(
        bool((np.diff(share) < 0).all()),
        f"largest over least damping needed: {_words(record, share)}; largest less least [N s/m]: "
        + ", ".join(f"{n:.3g}" for n in np.ptp(needed, axis=1)),
    )


def _alike_at_high_stiffness(record: StabilityChart) -> Verdict:
    low, high = np.ptp(_needed(record), axis=0)[[0, -1]]
    return Verdict(
        bool(high < low), f"difference of the damping needed: {low:.3g} N s/m at the low, {high:.3g} at the high end"
    )


def _meet_without_arm(record: StabilityChart) -> Verdict:
    needed = _needed(record, np.array([NEAR_ZERO]))[:, 0]
    return Verdict(bool(np.ptp(needed) < ALIKE * needed.max()), f"damping needed without arm [N s/m]: {_words(record, needed)}")


def _as_good_as_steel(family: int, record: StabilityChart) -> Verdict:
    """Of the moduli 70, 140 (carbon fibre) and 200 GPa (steel), one against the last."""
    needed = _median(record)
    return Verdict(bool(needed[family] < 1.5 * needed[-1]), f"median damping needed [N s/m]: {_words(record, needed)}")


def _long_ones_alike(record: StabilityChart) -> Verdict:
    short, middle, long = needed = _median(record)
    return Verdict(bool(middle - long < (short - middle) / 2), f"median damping needed [N s/m]: {_words(record, needed)}")


def _share(record: StabilityChart, speeds: np.ndarray) -> np.ndarray:
    """Stable share of positive caster at each speed."""
    e = np.linspace(0, record.y.high, 401)[1:]
    return np.array([record.stable(np.full(e.size, V), e).mean() for V in speeds])


def _faster_is_stabler(record: StabilityChart) -> Verdict:
    shares = _share(record, np.array([40.0, 80.0, 120.0, 160.0]))
    listed = ", ".join(f"{100 * share:.0f} %" for share in shares)
    return Verdict(bool((np.diff(shares) >= 0).all()), f"stable share of e > 0 at 40, 80, 120, 160 m/s: {listed}")


def _slow_is_unstable(record: StabilityChart) -> Verdict:
    slow, fast = _share(record, np.array([SLOW_SPEED, 160.0]))
    return Verdict(
        bool(slow < fast), f"stable share of e > 0: {100 * slow:.0f} % at {SLOW_SPEED:g} m/s, {100 * fast:.0f} % at 160 m/s"
    )


def _larger_area(record: StabilityChart, other: StabilityChart) -> Verdict:
    speeds = np.linspace(record.x.low, record.x.high, 100)
    ours, theirs = (float(_share(r, speeds).mean()) for r in (record, other))
    return Verdict(ours > theirs, f"stable part of the plane at e > 0: {100 * ours:.0f} %, was {100 * theirs:.0f} %")


def _spread(record: StabilityChart) -> float:
    """Largest over least median damping needed, between the families."""
    return _ratio(_median(record))


def _closer_together(record: StabilityChart, other: StabilityChart) -> Verdict:
    ours, theirs = _spread(record), _spread(other)
    return Verdict(ours < theirs, f"largest over least median damping between the curves: {ours:.3g}, against {theirs:.3g}")


def _further_apart(record: StabilityChart, other: StabilityChart) -> Verdict:
    verdict = _closer_together(record, other)
    return Verdict(_spread(record) > _spread(other), verdict.numbers)


def _far_less_damping(record: StabilityChart, other: StabilityChart) -> Verdict:
    ours, theirs = (float(_median(r).max()) for r in (record, other))
    return Verdict(2 * ours < theirs, f"largest median damping needed [N s/m]: {ours:.3g}, against {theirs:.3g}")


def _far_more_damping(record: StabilityChart, other: StabilityChart) -> Verdict:
    verdict = _far_less_damping(record, other)
    ours, theirs = (float(_median(r).max()) for r in (record, other))
    return Verdict(ours > 2 * theirs, verdict.numbers)


def _arm_matters_less(record: StabilityChart, other: StabilityChart) -> Verdict:
    ours, theirs = (float(np.median(_stiffness_share(r))) for r in (record, other))
    return Verdict(ours < theirs, f"largest over least damping needed along I_arm: {ours:.3g}, against {theirs:.3g}")


_TREAD = (
    "With the tread-width moment put right (erratum 1) it damps, the more the slower the wheel rolls; "
    "the printed sign makes low speeds unstable."
)
FASTER = Claim("The higher the velocity the more stable, for positive caster.", _faster_is_stabler, why_not=_TREAD)
SLOW = Claim("For positive caster, low velocities are unstable.", _slow_is_unstable, why_not=_TREAD)
GREATER_V = Claim("The greater the velocity, the bigger the stable region.", _falls)
SLENDER_SLOW = Claim("Lower velocities are unstable at lower stiffness of the arm.", _slow_needs_more_when_soft)
HIGH_V = Claim(
    "At high velocity stiffness stops having an effect.",
    _stiffness_matters_less,
    why_not="In proportion it matters as much at 160 as at 40 m/s; in N s/m the effect falls, which a figure shows.",
)
LONGER = Claim("The longer the torque links, the bigger the stable region.", _falls)
WIDER = Claim("The larger the angle, the bigger the stable region.", _falls)
SIDE = Claim(
    "The bigger b, the smaller the stable region.",
    _rises,
    why_not="(3-30), c ell^2 b/(10 R), grows with b, and so does the consistent damping: the text"
    " reads its formula the wrong way. What a larger b costs is stiffness, through R.",
)
CARBON = Claim(
    "Carbon fibre performs almost like steel (needs less than half as much damping again).", partial(_as_good_as_steel, 1)
)
LIGHT = Claim(
    "A lighter, less stiff material has the same stability map (needs less than half as much damping again).",
    partial(_as_good_as_steel, 0),
    why_not="At 40 m/s an arm of 70 GPa needs twice the damping of one of steel, with printed coefficients nearly so at 100.",
)
MEET = Claim("All curves meet where the arm's moment of inertia is zero.", _meet_without_arm)
ALIKE_HIGH = Claim("At high moments of inertia the differences become negligible.", _alike_at_high_stiffness)
LONG_ALIKE = Claim("A very short link is bad; 0.6 and 1 m are quite similar.", _long_ones_alike)

CHART_CLAIMS: dict[str, Sequence[Claim]] = {
    "3.4": (FASTER,),
    "3.5": (GREATER_V, HIGH_V),
    "3.6": (LONGER,),
    "3.7": (WIDER,),
    "3.10": (FASTER,),
    "3.11": (FASTER,),
    "3.12": (
        SLENDER_SLOW,
        HIGH_V,
        Claim(
            "A much larger damping coefficient is needed than for Boeing's.",
            _far_more_damping,
            "3.5",
            "The printed damping of UTAS is 5.4 times too small (erratum 8); it really needs a third more than Boeing's.",
        ),
    ),
    "3.13": (LONGER,),
    "3.14": (LONGER, Claim("The arm's moment of inertia has less effect than at 40 m/s.", _arm_matters_less, "3.13")),
    "3.15": (SIDE,),
    "3.16": (
        SIDE,
        Claim("b has more effect than at 40 m/s.", _further_apart, "3.15"),
    ),
    "3.17": (CARBON, MEET),
    "3.18": (CARBON, MEET),
    "3.21": (SLOW, Claim("The region of stability at positive caster is larger than UTAS'.", _larger_area, "3.10")),
    "3.22": (SLOW, Claim("The region of stability at positive caster is larger than UTAS'.", _larger_area, "3.11")),
    "3.23": (
        Claim(
            "The regions of the velocities lie closer together than UTAS'.",
            _closer_together,
            "3.12",
            "By virtual work the spread is the same within 1 %.",
        ),
        Claim("The regions of the velocities lie closer together than Boeing's.", _closer_together, "3.5"),
        Claim("The damping coefficient needed is significantly less than UTAS'.", _far_less_damping, "3.12"),
        Claim("The damping coefficient needed is much lower than Boeing's.", _far_less_damping, "3.5"),
    ),
    "3.24": (LONG_ALIKE, ALIKE_HIGH),
    "3.25": (ALIKE_HIGH,),
    "3.26": (
        LIGHT,
        Claim(
            "E makes even less difference than the length of the links.",
            _closer_together,
            "3.24",
            "The printed coefficients take the stiffness over ell^2 for ell (erratum 6): the length then matters less.",
        ),
        Claim("Less damping is needed than with UTAS'.", _far_less_damping, "3.17"),
    ),
    "3.27": (LIGHT, Claim("E makes even less difference than the length of the links.", _closer_together, "3.25")),
    "3.28": (Claim("The lower the velocity, the less impact has the angle.", _closer_together, "3.29"), ALIKE_HIGH),
    "3.29": (ALIKE_HIGH,),
}
"""By figure."""

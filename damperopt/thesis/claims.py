"""What the thesis' text says of its figures, each statement put to the numbers: it agrees, or differs for a reason."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..chart import StabilityChart
from .charts import needed_damping
from .responses import Response

__all__ = ["CHART_CLAIMS", "RESPONSE_CLAIMS", "Claim", "Verdict"]

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


# ------------------------------------------------------------------------------------------------------ stability charts


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
    return needed.max(axis=1) / needed.min(axis=1)


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


def _light_as_good_as_steel(record: StabilityChart) -> Verdict:
    needed = _median(record)
    return Verdict(bool(needed[-2] < 1.5 * needed[-1]), f"median damping needed [N s/m]: {_words(record, needed)}")


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
    needed = _median(record)
    return float(needed.max() / needed.min())


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
CARBON = Claim("Carbon fibre performs almost like steel (needs less than half as much damping again).", _light_as_good_as_steel)
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
        CARBON,
        Claim(
            "E makes even less difference than the length of the links.",
            _closer_together,
            "3.24",
            "The printed coefficients take the stiffness over ell^2 for ell (erratum 6): the length then matters less.",
        ),
        Claim("Less damping is needed than with UTAS'.", _far_less_damping, "3.17"),
    ),
    "3.27": (CARBON, Claim("E makes even less difference than the length of the links.", _closer_together, "3.25")),
    "3.28": (Claim("The lower the velocity, the less impact has the angle.", _closer_together, "3.29"), ALIKE_HIGH),
    "3.29": (ALIKE_HIGH,),
}
"""By figure."""


# -------------------------------------------------------------------------------------------------------------- responses

Responses = Sequence[Response]


def _listed(found: Any, form: str = ".3g") -> str:
    return ", ".join(f"{value:{form}}" for value in found)


def _amplitudes(found: Responses) -> np.ndarray:
    return np.array([0.0 if one.motion.kind == "settled" else one.motion.amplitude for one in found])


def _bending(one: Response) -> float:
    """Amplitude of l_g sin(delta) in the last second [m]."""
    last = one.trajectory.time > one.trajectory.time[-1] - 1
    return float(np.ptp(one.trajectory["lateral_displacement"][last]) / 2)


def _torsional(found: Responses) -> Verdict:
    psi, y = found[0].motion.amplitude, _bending(found[0])
    return Verdict(psi > 0.1 and y < 0.005, f"yaw {psi:.3g} rad, lateral {1e3 * y:.2g} mm, {found[0].motion.frequency:.4g} Hz")


def _lateral(found: Responses, torsional: Responses) -> Verdict:
    psi, psi_before = found[0].motion.amplitude, torsional[0].motion.amplitude
    y, y_before = _bending(found[0]), _bending(torsional[0])
    return Verdict(
        psi < psi_before and y > 10 * y_before,
        f"yaw {psi:.3g} after {psi_before:.3g} rad, lateral {1e3 * y:.3g} after {1e3 * y_before:.2g} mm",
    )


def _both_modes(found: Responses) -> Verdict:
    """Torsion at 13.4 Hz in the yaw angle, bending at 16.0 Hz in the lateral displacement, both from 10 to 30 s."""
    motion = found[0].trajectory
    even = np.linspace(10, 30, 8192)
    frequency, window = np.fft.rfftfreq(even.size, even[1] - even[0]), np.hanning(even.size)

    def line(name: str, low: float, high: float) -> float:
        spectrum = 2 * np.abs(np.fft.rfft(window * np.interp(even, motion.time, motion[name]))) / window.sum()
        return float(spectrum[(frequency > low) & (frequency < high)].max())

    torsion, bending = line("yaw_angle", 12.8, 14.4), line("lateral_displacement", 15.5, 16.6)
    return Verdict(
        torsion > 5e-3 and bending > 5e-3,
        f"10 to 30 s: yaw {torsion:.2g} rad at 13.4 Hz, lateral {1e3 * bending:.2g} mm at 16 Hz",
    )


def _calmer(found: Responses, slower: Responses) -> Verdict:
    ours, theirs = _amplitudes(found), _amplitudes(slower)
    return Verdict(bool((ours <= theirs).all()), f"yaw [rad] {_listed(ours)} after {_listed(theirs)} for the two points")


def _only_the_largest_damps(found: Responses) -> Verdict:
    rates = [one.abscissa for one in found]
    numbers = ", ".join(f"{one.abscissa:.2g}" for one in found)
    c = _listed((one.design["c_lambda"] for one in found), "g")
    return Verdict(rates[-1] < 0 < min(rates[:-1]), f"spectral abscissa [1/s] {numbers} for c_lambda {c} N s/m")


def _leans(one: Response) -> float:
    """Middle of the extrema in parts of the amplitude."""
    return abs(one.motion.mean) / one.motion.amplitude if one.motion.kind != "settled" else 0.0


def _asymmetric(found: Responses) -> Verdict:
    lean = _leans(found[0])
    return Verdict(lean > 0.01, f"the middle of the extrema lies {100 * lean:.2g} % of the amplitude to one side")


def _symmetric(found: Responses) -> Verdict:
    verdict = _asymmetric(found)
    return Verdict(_leans(found[0]) < 1e-3, verdict.numbers)


def _leans_less(found: Responses, slender: Responses) -> Verdict:
    ours, theirs = _leans(found[0]), _leans(slender[0])
    return Verdict(
        1e-3 < ours < theirs, f"middle of the extrema {100 * ours:.2g} % of the amplitude, {100 * theirs:.2g} % before"
    )


def _higher_frequency(found: Responses, other: Responses) -> Verdict:
    ours, theirs = (r[0].motion.frequency for r in (found, other))
    return Verdict(ours > theirs, f"{ours:.3g} Hz, against {theirs:.3g} Hz at the lowest damping")


def _smaller_amplitude(found: Responses, other: Responses) -> Verdict:
    """At the largest damping that both figures draw and one of them shimmies with."""
    c, ours, theirs = max(
        (one.design["c_lambda"], a, b)
        for one, a in zip(found, _amplitudes(found), strict=True)
        for two, b in zip(other, _amplitudes(other), strict=True)
        if one.design["c_lambda"] == two.design["c_lambda"] and max(a, b) > 0.01
    )
    return Verdict(bool(ours < theirs), f"yaw {ours:.3g} rad, against {theirs:.3g} rad at {c:g} N s/m")


def _less_damping(found: Responses, other: Responses) -> Verdict:
    """The least of the dampings drawn that is stable."""
    ours, theirs = (min((one.design["c_lambda"] for one in r if one.abscissa < 0), default=np.inf) for r in (found, other))
    return Verdict(ours < theirs, f"least damping drawn that is stable: {ours:g} N s/m, against {theirs:g}")


def _twenty_to_thirty(found: Responses, slender: Responses) -> Verdict:
    ours, theirs = found[0].motion.frequency, slender[0].motion.frequency
    near = abs(theirs / 20 - 1) < 0.25 and abs(ours / 30 - 1) < 0.25
    return Verdict(bool(near), f"{theirs:.3g} to {ours:.3g} Hz")


def _enough_for_the_stiff_only(found: Responses, slender: Responses) -> Verdict:
    ours, theirs = found[-1].abscissa, slender[-1].abscissa
    return Verdict(ours < 0 < theirs, f"spectral abscissa at 1e4 N s/m: {ours:.2g} 1/s stiff, {theirs:.2g} 1/s slender")


RESPONSE_CLAIMS: dict[str, Sequence[Claim]] = {
    "4.5": (Claim("At 40 m/s the strut rotates much; its lateral displacement is very small.", _torsional),),
    "4.7": (Claim("At 175 m/s the rotation is less, the lateral mode is excited.", _lateral, "4.5"),),
    "4.9": (Claim("At 155 m/s both modes interact.", _both_modes),),
    "4.12": (
        Claim(
            "Vibrations decrease at higher velocity (from 40 to 80 m/s).",
            _calmer,
            "4.11",
            "The stiff point's torsion lies at 16 Hz, next to the lateral mode: the strut bends along.",
        ),
    ),
    "4.13": (Claim("Vibrations decrease at higher velocity (from 80 to 160 m/s).", _calmer, "4.12"),),
    "4.14": (
        Claim(
            "1e5 N s/m ends the vibration, any lower value does not.",
            _only_the_largest_damps,
            why_not="The printed damping is 4.4 times too small at this b (erratum 8): in the plane 1.7e4 will do.",
        ),
    ),
    "4.15": (
        Claim(
            "The vibration is asymmetric.",
            _asymmetric,
            why_not="The printed stiffness and damping are constants: nothing leans. The linkage in space does.",
        ),
    ),
    "4.16": (
        Claim(
            "A stiffer arm makes the vibration slightly less asymmetric.",
            _leans_less,
            "4.15",
            "As printed nothing leans. In space the lean goes with amplitude and side distance; the stiffer arm swings wider.",
        ),
    ),
    "4.18": (
        Claim(
            "The frequency is higher than UTAS'.",
            _higher_frequency,
            "4.15",
            "In space the torsion of either lies at 15 Hz; UTAS, with ten times the damping, shimmies laterally at 16 Hz.",
        ),
        Claim("The amplitude is much smaller than UTAS'.", _smaller_amplitude, "4.15"),
        Claim("The vibration is symmetric.", _symmetric),
        Claim("Less damping is needed than with UTAS'.", _less_damping, "4.15"),
    ),
    "4.20": (
        Claim(
            "The stiffer arm raises the frequency from about 20 to about 30 Hz.",
            _twenty_to_thirty,
            "4.18",
            "The ratio is right, sqrt(8.3/3.4); the printed arm, of length ell, is far stiffer than one of length L.",
        ),
        Claim(
            "The stiffer arm makes the amplitude smaller.",
            _smaller_amplitude,
            "4.18",
            "With the stiff arm less damping is enough; but where it shimmies, it swings wider.",
        ),
        Claim(
            "10 N s/m (read 10 N s/mm) are enough with the stiff arm, not with the slender one.",
            _enough_for_the_stiff_only,
            "4.18",
            "True of damping between the critical values of the two arms, which lie below 1e4 N s/m; in space also "
            "of 1e4 N s/m after 0.3 rad: the slender arm then ends in a cycle of 0.06 rad.",
        ),
    ),
}
"""By figure."""

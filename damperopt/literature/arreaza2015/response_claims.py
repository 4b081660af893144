"""What the thesis' text says of its responses, each statement put to the motions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from .claims import Claim, Verdict
from .responses import Response

__all__ = ["RESPONSE_CLAIMS"]

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

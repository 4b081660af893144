"""The lower bound on the mass of a study's designs: searched by `optimum`, checked by `proof`, and put into words."""

from __future__ import annotations

from collections.abc import Sequence

import flint

from .answers.bound import MassBound
from .errors import CertificateError, ConfigError
from .optimum.branch import lower_bound
from .proof.lightness import Lightness
from .proof.optimality import check_bound
from .proof.yaw import Contour, YawGear
from .results import DesignResult
from .stability.linear import LinearModel
from .study.study import Study

__all__ = ["mass_bound"]

ROOT = 1e-5
"""Of D at a root over D a hundredth beside it."""

CONTRADICTION = 1e-6
"""Relative, by which a bound may lie above a design that meets every requirement to the tolerance of the program."""


def mass_bound(study: Study, result: DesignResult) -> MassBound:
    """No design of a study is lighter than this.

    Parameters
    ----------
    study : Study
    result : DesignResult
        With the design that was found, or without one.

    Returns
    -------
    MassBound
        As the check has it, whatever the search says.
    """
    if why := _none(study, result):
        return MassBound(why=why)
    assert result.mass is not None
    found, solver = result.mass.total, study.solver
    try:
        gear = YawGear(study)
        if result.design and not reduces(study, result, gear):
            return MassBound(why="stiffness and damping reach this gear through more than the numbers of the bound")
        tree = lower_bound(study, found, solver.bound_gap, solver.bound_seconds, _oracle(gear))
        certificate = tree.certificate()
        checked = check_bound(study, certificate)
    except (CertificateError, ConfigError) as error:
        return MassBound(why=str(error))
    if checked.bound is None:
        return MassBound(why=checked.reason)
    if checked.bound > found * (1 + CONTRADICTION):
        return MassBound(
            why=f"bound {checked.bound:.6g} kg and design contradict each other: a fault of this program, please report it"
        )
    mass = min(checked.bound, found)
    return MassBound(
        mass=mass,
        gap=1 - mass / found,
        covers=covers(study, bool(checked.shimmies)),
        proved=(*(("stability_margin",) if checked.shimmies else ()), *checked.used),
        unused=unused(study, bool(checked.shimmies)),
        heavier=checked.heavier,
        shimmies=checked.shimmies,
        finished=tree.finished,
        certificate=certificate,
    )


def reduces(study: Study, result: DesignResult, gear: YawGear) -> bool:
    """Whether the rightmost root of the design's own model is one of its reduced form.

    Parameters
    ----------
    study : Study
    result : DesignResult
    gear : YawGear
        Of the study.
    """
    light = Lightness(study)
    if not light.numbers:
        return True
    values = light.function(light.vector(result.design | result.derived | result.limit_event)).full().ravel()
    k0, kappa, tau = (*values[-len(light.numbers) :].tolist(), 0.0)[:3]
    built, load = study.damper.with_damping(result.design, light.factor), study.envelope.loads[-1]
    speed = study.envelope.speed.max
    root = complex(LinearModel(study).at(built).roots(speed, load, 1)[0, 0])

    def D(s: complex) -> complex:
        D0, D1 = (complex(part) for part in gear.pair(speed, load).at(flint.acb(s.real, s.imag)))
        return (1 + tau * s) * D0 + (k0 + kappa * s) * D1

    return abs(D(root)) < ROOT * abs(D(root * (1 + 1e-2)))


def covers(study: Study, stability: bool) -> str:
    """What a bound is about, in a sentence."""
    names = ", ".join(study.variable_names)
    with_stability = "the stability margin at a few speeds and loads of the envelope, " if stability else ""
    return f"proved for every {names} within their bounds, from {with_stability}strength, strokes and lengths"


def unused(study: Study, stability: bool) -> tuple[str, ...]:
    """Requirements that a bound does not use."""
    required = study.required
    left = [] if stability else ["stability"]
    left += ["decay"] if required.decay is not None else []
    left += ["damping ratio"] if required.damping_ratio is not None else []
    return tuple(left)


def _none(study: Study, result: DesignResult) -> str:
    """Why no bound is looked for; empty: one is."""
    if result.mass is None:
        return "no design was found"
    if study.solver.bound_seconds == 0:
        return "solver.bound_seconds is 0"
    if study.required.limit_event == "simulated":
        return "the parts are sized by simulated motions (requirements.limit_event), which have no bound"
    if result.stock is not None:
        return "sizes that exist are not searched by boxes; their list is"
    if study.damper.ROTARY:
        return "the layout has no parts to weigh"
    if study.gear.strut is not None:
        return "the shock strut moves, and the reduction of the bound holds for a frozen one alone"
    return ""


def _oracle(gear: YawGear):
    def shimmies(
        low: Sequence[float], high: Sequence[float], speed: float, load: float, contour: tuple[float, float, float]
    ) -> bool:
        ends = [tuple(map(flint.arb, end)) for end in (low, high)]
        return gear.shimmies(ends[0], ends[1], speed, load, Contour(*contour))

    return shimmies

"""The check of a design against `requirements.largest_limit_cycle`: continuation from motions, corners as events."""

from __future__ import annotations

import math
from collections.abc import Mapping

from ..answers.verdicts import LimitCycleCheck
from ..study.study import Study
from .amplitude_map import largest_stable
from .branches import Question
from .motions import from_motions
from .orbit import Branch

__all__ = ["check_limit_cycles", "cycle_failures", "with_gap"]


def with_gap(study: Study) -> Study:
    """The study with the play that its requirement is to be kept at."""
    required = study.required.largest_limit_cycle
    if required is None or required.gap is None:
        return study
    return study.replace(damper__freeplay={"gap": required.gap})


def check_limit_cycles(study: Study, design: Mapping[str, float]) -> LimitCycleCheck | None:
    """The largest stable limit cycle that is found over the speeds and loads of the envelope; None where none is asked for.

    Parameters
    ----------
    study : Study
    design : mapping of str to float
        [SI]
    """
    required = study.required.largest_limit_cycle
    if required is None:
        return None
    played, envelope = with_gap(study), study.envelope
    worst, at, lost, count, left = 0.0, (envelope.speed.min, max(envelope.loads)), 0, 0, 0
    for load in envelope.loads:
        branches, motions = from_motions(Question.of(played, design, "speed", load=load), values=required.speeds)
        count += len(branches)
        left += len(motions)
        lost += sum(branch.lost for branch in branches)
        for yaw, speed in _sizes(branches, required.speeds):
            if yaw > worst:
                worst, at = yaw, (speed, load)
    gap = played.damper.play.gap if played.damper.play is not None else 0.0
    passed = worst <= required.yaw_angle and not lost and not left
    return LimitCycleCheck(passed, required.yaw_angle, worst, *at, gap, count, lost, left)


def _sizes(branches: list[Branch], speeds: list[float] | None) -> list[tuple[float, float]]:
    """Amplitudes of stable cycles and the speeds that they are at: those asked for, or all of the branches."""
    if speeds is None:
        return [(o.amplitudes["yaw_angle"], o.parameter) for branch in branches for o in branch.orbits if o.stable]
    return list(zip(largest_stable(branches, speeds).tolist(), speeds, strict=True))


def cycle_failures(check: LimitCycleCheck | None) -> list[str]:
    """Why a check is not passed, in words; with the play that would do, to which small cycles are in proportion."""
    if check is None or check.passed:
        return []
    if check.yaw_angle <= check.limit:
        words = f"limit cycles are undecided: {check.lost} of {check.branches} branches were lost"
        return [f"{words}, {check.left} motions left the range of the model"]
    words = (
        f"a stable limit cycle of {math.degrees(check.yaw_angle):.4g} deg at {check.speed:.6g} m/s, {check.load / 1e3:.6g} kN; "
        f"allowed {math.degrees(check.limit):.4g} deg"
    )
    if not check.gap:
        return [words]
    least = 1e3 * check.gap * check.limit / check.yaw_angle
    return [f"{words} (with {1e3 * check.gap:.4g} mm of play; about {least:.3g} mm would do)"]

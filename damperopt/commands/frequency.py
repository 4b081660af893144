"""The loop of a gear over frequency."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import ConfigError
from ..reading import quoted
from .shared import ConfigArgument, DesignOption, OutputOption, all_or_nothing, out, study_and_design

if TYPE_CHECKING:
    from ..stability.margins_of_loop import Locus, LoopMargins, OverSpeed
    from ..study.study import Study

__all__ = ["frequency"]

SPEEDS = 40
"""Of the margins over speed: that many evenly, and that many by their logarithm."""

MOST_SPEEDS = 12
"""At which loci are drawn."""

CUT = {"tyre": "force and moment of all tyres", "damper": "the damping"}


def frequency(
    file: ConfigArgument,
    design: DesignOption = None,
    speed: Annotated[str, typer.Option(metavar="V,...", help="Speeds of the loci. [default: the weakest]")] = "",
    load: Annotated[str, typer.Option(help="Vertical load. [default: the largest of the envelope]")] = "",
    where: Annotated[str, typer.Option("--break", metavar="tyre|damper", help="Where the loop is opened.")] = "tyre",
    output: OutputOption = None,
) -> None:
    """Loop between structure and tyre, or damper: Bode, Nyquist and its count, gain, phase and disk margins over speed.

    The contact line is the study's, with its exact delay. Exit code 0 also where the gear is unstable: that is an answer.
    """
    from ..output.folder import run_folder, write_run
    from ..output.loops import write_loops
    from ..stability.loop import BREAKS, opened
    from ..stability.margins_of_loop import locus_of, margins_of, margins_over_speed
    from .arguments import speeds_of

    study, values = study_and_design(file, design)
    if where not in BREAKS:
        raise ConfigError(f"--break: found {quoted(where)}; allowed: {' or '.join(BREAKS)}")
    asked = speeds_of(speed, "--speed", MOST_SPEEDS) if speed else []
    F_z = load_of(load, study)
    with all_or_nothing():
        at = opened(study, study.start if values is None else values, where)
        folder = run_folder(output, f"{file.stem}-loop")
        low, high = study.envelope.speed.min, study.envelope.speed.max
        import numpy as np

        row = np.unique(np.clip(np.concatenate([np.linspace(low, high, SPEEDS), np.geomspace(low, high, SPEEDS)]), low, high))
        over = margins_over_speed(at, row, F_z)
        loops = {V: at(V, F_z) for V in asked or [float(over.speeds[over.weakest])]}
        loci = {V: locus_of(loop) for V, loop in loops.items()}
        shown = [(V, loci[V], margins_of(loops[V], loci[V])) for V in loops]
        write_run(folder, lambda place: write_loops(place, over, list(loci.items()), where))
    _show(over, shown, where)
    out.print(f"\nResults in {folder}", soft_wrap=True, markup=False)


def load_of(text: str, study: Study) -> float:
    """Vertical load of an option, the largest of the envelope if empty; one that the tyre has data for."""
    from ..quantities.record import Force
    from .arguments import quantity

    if not text:
        return max(study.envelope.loads)
    load = quantity(text, Force, "--load")
    for own in study.wheel_loads(load):
        if why := study.tyre.beyond(own, study.tyre.pressure):
            raise ConfigError(f"--load: {own / 1e3:.6g} kN on a wheel {why}; allowed: loads that the tyre has data for")
    return load


def _show(over: OverSpeed, shown: list[tuple[float, Locus, LoopMargins]], where: str) -> None:
    from .summary import plain_table

    low, high = over.speeds[0], over.speeds[-1]
    weak, V = over.margins[over.weakest], over.speeds[over.weakest]
    words = f"Loop opened at the {where}, {over.load / 1e3:.6g} kN: margins of one factor on {CUT[where]}."
    out.print(f"\n{words}", soft_wrap=True)
    unstable = [speed for speed, m in zip(over.speeds, over.margins, strict=True) if m.unstable]
    if unstable:
        found = f"UNSTABLE at {len(unstable)} of {len(over.speeds)} speeds looked at"
        words = f"{found}, from {unstable[0]:.4g} to {unstable[-1]:.4g} m/s; there is no margin there."
        out.print(words, soft_wrap=True)
    else:
        searched = f"of {len(over.speeds)} speeds from {low:.4g} to {high:.4g} m/s"
        out.print(f"Weakest {searched}: {V:.4g} m/s, disk margin {weak.disk:.4g}: {_borne(weak.disk)}.", soft_wrap=True)
    table = plain_table("speed, m/s", "P", "N", "P + N", "gain down", "gain up", "phase, deg", "disk", "at, Hz")
    for speed, locus, m in shown:
        counts = (str(n) for n in (locus.open_unstable, locus.turns, locus.implied))
        numbers = (m.gain_down or math.nan, m.gain_up, math.degrees(m.phase), m.disk, m.disk_at / (2 * math.pi))
        table.add_row(f"{speed:.5g}", *counts, *(f"{n:.4g}" if math.isfinite(n) else "none" for n in numbers))
    out.print(table)
    out.print(
        "P: unstable poles of the open loop; N: clockwise turns about -1; P + N: those of the gear by Nyquist's count, "
        "with which its eigenvalues agree. Gains and phase are those at the limit of stability, disk is the margin alpha.",
        soft_wrap=True,
    )


def _borne(alpha: float) -> str:
    """Gains and phases that a disk margin bears, in words."""
    phase = math.degrees(2 * math.atan(alpha / 2))
    if alpha >= 2:
        return f"any gain, or a phase of {phase:.3g} deg"
    return f"gains from {(2 - alpha) / (2 + alpha):.3g} to {(2 + alpha) / (2 - alpha):.3g}, or phases of {phase:.3g} deg"

"""Motion after a disturbance."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import ConfigError
from .shared import ConfigArgument, DesignOption, OutputOption, all_or_nothing, out, study_and_design

if TYPE_CHECKING:
    from ..stability.linear import LinearGear

__all__ = ["simulate"]

CYCLES = 12
"""Of the slowest mode, that are shown unless a duration is given."""

LONGEST = 3.0
"""Longest duration that is chosen for the user [s]."""


def simulate(
    file: ConfigArgument,
    speed: Annotated[str, typer.Option(help="Speed in m/s, such as 40, or '120 kt'.")] = "",
    design: DesignOption = None,
    load: Annotated[str, typer.Option(help="Vertical load [N]. [default: the largest of the envelope]")] = "",
    release: Annotated[list[str] | None, typer.Option(metavar="NAME=VALUE", help="yaw, bending or string let go.")] = None,
    kick: Annotated[list[str] | None, typer.Option(metavar="NAME=VALUE", help="yaw or bending rate at the start.")] = None,
    step: Annotated[list[str] | None, typer.Option(metavar="torque=VALUE", help="Yaw torque from the start.")] = None,
    unbalance: Annotated[list[str] | None, typer.Option(metavar="moment=VALUE", help="Rotating unbalance.")] = None,
    duration: Annotated[str, typer.Option(help="Time in s. [default: 12 cycles of the slowest mode, at most 3 s]")] = "",
    engine: Annotated[str, typer.Option(help="erk, cvodes, idas, exact (corners as events), or auto.")] = "auto",
    history: Annotated[
        Path | None,
        typer.Option(help="CSV file of time, speed, load, and if wanted stroke and yaw_torque, in the place of --speed."),
    ] = None,
    output: OutputOption = None,
) -> None:
    """Motion after a disturbance: trajectories, cycles, decay, and whether it settles, cycles or diverges.

    Along a history of speed and load, such as a landing roll: peaks, and when the gear could shimmy. Exit code 0 also where
    the motion diverges: that is an answer. 2: the question is not well posed.
    """
    from ..motion.exact import ExactSimulator
    from ..motion.integrators import ENGINES
    from ..motion.question import output_points, posed
    from ..motion.simulate import Simulator
    from ..motion.trajectory import motion_of
    from ..optimum.left_out import left_out_by_number
    from ..output.folder import run_folder, write_run
    from ..output.tables import write_motion, write_trajectory
    from ..quantities.record import Force, Speed, Time
    from ..results import load_result
    from ..stability.linear import linear_gear
    from ..stability.wavelength import shortest_wavelength
    from ..study.cavitation import cavitation
    from . import summary
    from .along import run_along
    from .arguments import disturbance_of, quantity

    study, values = study_and_design(file, design)
    given = {"release": release or [], "kick": kick or [], "step": step or [], "unbalance": unbalance or []}
    required = study.requirements.decay if study.requirements else None
    if any(given.values()):
        disturbance = disturbance_of(given)
    elif required is not None:
        disturbance = required.disturbance
    else:
        disturbance = disturbance_of({"release": ["yaw=1deg"]})
    if engine not in ("auto", "exact", *ENGINES):
        raise ConfigError(f"--engine: found '{engine}'; allowed: auto, exact, {', '.join(ENGINES)}")
    sized = load_result(design).limit_event if design is not None else {}
    if history is not None:
        for option, text in (("--speed", speed), ("--load", load), ("--duration", duration)):
            if text:
                raise ConfigError(f"{option}: found {text} beside --history, which says it; allowed: one of the two")
        run_along(study, values, history, disturbance, any(given.values()), engine, output, file.stem, sized)
        return
    if not speed:
        raise ConfigError("--speed: missing; allowed: a speed such as 40 or '120 kt', or --history with a CSV file")
    chosen = "" if any(given.values()) else "of requirements.decay" if required is not None else "as none was given"
    at_speed, at_load = quantity(speed, Speed, "--speed"), quantity(load, Force, "--load") if load else None
    seconds = quantity(duration, Time, "--duration") if duration else None
    gear = linear_gear(study, values)
    if seconds is None:
        seconds = _enough(gear, at_speed, at_load or max(study.envelope.loads))
    # a question that is not well posed leaves no folder behind
    posed(study, gear.state_names, at_speed, at_load or max(study.envelope.loads), disturbance, seconds)
    output_points(gear, at_speed, at_load or max(study.envelope.loads), seconds)
    folder = run_folder(output, f"{file.stem}-simulation")
    run = ExactSimulator(study, values) if engine == "exact" else Simulator(study, values, engine)
    with all_or_nothing():
        motion = run(at_speed, at_load, disturbance, seconds)
    found = motion_of(motion, required.cycles if required else 3)

    def write(place: Path) -> None:
        from .. import figures  # matplotlib takes longer to import than a motion takes to find

        write_trajectory(place / "trajectory.csv", motion)
        write_motion(place / "motion.json", motion, found, disturbance, values or study.start)
        after = f"after {summary.disturbance_words(disturbance)}"
        figures.save_each({"trajectory": lambda: figures.trajectory(motion, found, after)}, place)

    write_run(folder, write)
    words = " ".join(filter(None, (summary.disturbance_words(disturbance), chosen)))
    left_out = left_out_by_number(study, study.start if values is None else values)
    wave = shortest_wavelength(study, gear, [at_speed], [motion.load])
    summary.show_motion(out, motion, found, required.cycles if required else 3, words, sized, left_out)
    summary.show_contact_line(out, study, wave)
    force = found.peaks.get("damper_torque" if study.damper.ROTARY else "damper_force", 0.0)
    if boils := cavitation(study, study.start if values is None else values, force):
        out.print(f"[yellow]Cavitation[/]: {boils}", soft_wrap=True)
    out.print(f"\nResults in {folder}", soft_wrap=True, markup=False)


def _enough(gear: LinearGear, speed: float, load: float) -> float:
    """Seconds that show what a motion does: `CYCLES` of the slowest mode that oscillates, at most `LONGEST`."""
    import numpy as np

    rates = np.abs(np.linalg.eigvals(gear.visible(speed, load)[0]).imag)
    slowest = rates[rates > 1e-6 * max(float(rates.max()), 1.0)].min(initial=np.inf)
    return float(min(2 * np.pi * CYCLES / slowest, LONGEST)) if np.isfinite(slowest) else LONGEST

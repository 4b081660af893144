"""Motion after a disturbance."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import ConfigError
from ..motion.exact import ExactSimulator
from ..motion.integrators import ENGINES
from ..motion.simulate import Simulator
from ..motion.trajectory import motion_of
from ..output.folder import run_folder, write_run
from ..output.tables import write_motion, write_trajectory
from ..quantities.record import Force, Speed, Time
from . import summary
from .arguments import disturbance_of, quantity
from .shared import ConfigArgument, DesignOption, OutputOption, all_or_nothing, out, study_and_design

__all__ = ["simulate"]


def simulate(
    file: ConfigArgument,
    speed: Annotated[str, typer.Option(help="Speed in m/s, such as 40, or '120 kt'.")],
    design: DesignOption = None,
    load: Annotated[str, typer.Option(help="Vertical load [N]. [default: the largest of the envelope]")] = "",
    release: Annotated[list[str] | None, typer.Option(metavar="NAME=VALUE", help="yaw, bending or string let go.")] = None,
    kick: Annotated[list[str] | None, typer.Option(metavar="NAME=VALUE", help="yaw or bending rate at the start.")] = None,
    step: Annotated[list[str] | None, typer.Option(metavar="torque=VALUE", help="Yaw torque from the start.")] = None,
    unbalance: Annotated[list[str] | None, typer.Option(metavar="moment=VALUE", help="Rotating unbalance.")] = None,
    duration: Annotated[str, typer.Option(help="Time to simulate in s.")] = "3",
    engine: Annotated[str, typer.Option(help=f"{', '.join(ENGINES)}, exact (corners as events), or auto.")] = "auto",
    output: OutputOption = None,
) -> None:
    """Motion after a disturbance: trajectories, cycles, decay, and whether it settles, cycles or diverges.

    Exit code 0 also where the motion diverges: that is an answer. 2: the question is not well posed.
    """
    study, values = study_and_design(file, design)
    given = {"release": release or [], "kick": kick or [], "step": step or [], "unbalance": unbalance or []}
    required = study.requirements.decay if study.requirements else None
    if any(given.values()):
        disturbance = disturbance_of(given)
    elif required is not None:
        disturbance = required.disturbance
    else:
        disturbance = disturbance_of({"release": ["yaw=1deg"]})
    at_speed, at_load = quantity(speed, Speed, "--speed"), quantity(load, Force, "--load") if load else None
    seconds = quantity(duration, Time, "--duration")
    folder = run_folder(output, f"{file.stem}-simulation")
    if engine not in ("auto", "exact", *ENGINES):
        raise ConfigError(f"--engine: found '{engine}'; allowed: auto, exact, {', '.join(ENGINES)}")
    run = ExactSimulator(study, values) if engine == "exact" else Simulator(study, values, engine)
    with all_or_nothing():
        motion = run(at_speed, at_load, disturbance, seconds)
    found = motion_of(motion, required.cycles if required else 3)

    def write(place: Path) -> None:
        from .. import figures  # matplotlib takes longer to import than a motion takes to find

        write_trajectory(place / "trajectory.csv", motion)
        write_motion(place / "motion.json", motion, found, disturbance, values or study.start)
        figures.save_each({"trajectory": lambda: figures.trajectory(motion, found)}, place)

    write_run(folder, write)
    summary.show_motion(out, motion, found, required.cycles if required else 3)
    out.print(f"\nResults in {folder}", soft_wrap=True)

"""Motion along a history, for `damperopt simulate --history`."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from ..errors import ConfigError
from ..motion.history import frozen_along, posed_along, simulate_along
from ..motion.roll import Roll, Stretch, roll_of
from ..motion.trajectory import Trajectory
from ..output.folder import run_folder, write_run
from ..output.tables import write_roll, write_trajectory
from ..quantities.shown import scale
from ..reading import printable
from ..study.disturbances import Disturbance
from ..study.history import History, read_history
from ..study.study import Study
from . import summary
from .shared import all_or_nothing, out

__all__ = ["run_along"]

SHOWN = ("yaw_angle", "damper_force", "damper_torque", "damper_stroke", "arm_stress", "side_force", "strut_stroke")
"""Peaks on the screen."""


def run_along(
    study: Study,
    values: Mapping[str, float] | None,
    file: Path,
    disturbance: Disturbance,
    asked: bool,
    engine: str,
    output: Path | None,
    stem: str,
    sized: Mapping[str, float],
) -> None:
    """Simulate, write and show.

    Parameters
    ----------
    study : Study
    values : mapping or None
        Design variables [SI].
    file : Path
        Of the history.
    disturbance : Disturbance
        At the start; one that nobody asked for is left out where the history has a torque of its own.
    asked : bool
        Whether the user gave it.
    engine : str
    output : Path or None
        Folder.
    stem : str
        Of the study's file.
    sized : mapping of str to float
        Peaks that the parts were sized for.
    """
    history = read_history(file)
    own = any(history.column("yaw_torque") or [0.0])
    start = disturbance if asked or not own else None
    # a question that is not well posed leaves no folder behind
    try:
        posed_along(study, values or study.start, history, start)
    except ConfigError as error:
        named = [
            problem.replace("history: ", f"{printable(file)}: ", problem.startswith("history: ")) for problem in error.problems
        ]
        raise ConfigError(named) from None
    folder = run_folder(output, f"{stem}-simulation")
    with all_or_nothing():
        motion = simulate_along(study, values, history=history, disturbance=start, engine=engine)
        frozen = frozen_along(study, values, history)
    margin = study.requirements.stability_margin if study.requirements else 0.0
    found = roll_of(motion, frozen, margin)
    after = " and ".join(
        [*(["the yaw torque of the history"] if own else []), *([summary.disturbance_words(start)] if start else [])]
    )

    def write(place: Path) -> None:
        from .. import figures  # matplotlib takes longer to import than a motion takes to find

        write_trajectory(place / "trajectory.csv", motion)
        write_roll(place / "motion.json", motion, found, start, values or study.start)
        figures.save_each({"trajectory": lambda: figures.roll(motion, found, frozen, f"after {after}")}, place)

    write_run(folder, write)
    _show(motion, found, after, sized)
    if words := _beyond(study, history):
        out.print(words, soft_wrap=True)
    out.print(f"\nResults in {folder}", soft_wrap=True, markup=False)


def _show(motion: Trajectory, found: Roll, after: str, sized: Mapping[str, float]) -> None:
    out.print(f"\n[bold]Along the history[/]: {motion.along}", soft_wrap=True)
    if motion.message:
        out.print(f"[bold red]stopped[/]: {motion.message}", soft_wrap=True)
    out.print(f"After {after}", soft_wrap=True)
    table = summary.plain_table("peak", "value", "unit", "at [s]", "m/s", "kN", *(("sized for",) if sized else ()))
    for name in SHOWN:
        if name in found.peaks:
            peak, unit = found.peaks[name], motion.units[name]
            limit, (words, factor) = sized.get(name), scale(unit)
            beside = (
                "" if limit is None else f"{factor * limit:.4g} {words}" + (" [red]exceeded[/]" if peak.value > limit else "")
            )
            place = f"{peak.time:.4g}", f"{peak.speed:.4g}", f"{peak.load / 1e3:.4g}"
            own = f"{factor * peak.value:.4g}", words
            table.add_row(name.replace("_", " "), *own, *place, *((beside,) if sized else ()))
    out.print(table)
    at = found.worst_at
    out.print(
        f"With time held: at worst {found.worst:+.4g} 1/s, at {at.time:.4g} s, {at.speed:.4g} m/s, {at.load / 1e3:.4g} kN; "
        + (_words("unstable", found.unstable) or "stable throughout"),
        soft_wrap=True,
    )
    if found.margin and found.below != found.unstable:
        out.print(_words(f"Margin below {found.margin:g} 1/s", found.below), soft_wrap=True)
    out.print(
        "That is no proof for a roll: growth takes time, and speed and load change meanwhile. Each motion is one simulation.",
        soft_wrap=True,
    )


def _beyond(study: Study, history: History) -> str:
    """Where a history leaves the envelope that is proved, in words; empty where it does not."""
    parts, speed, loads = [], study.envelope.speed, study.envelope.loads
    for name, unit, per, low, high in (
        ("speed", "m/s", 1.0, speed.min, speed.max),
        ("load", "kN", 1e3, min(loads), max(loads)),
    ):
        values = history.column(name) or []
        if min(values) < low or max(values) > high:
            parts.append(
                f"{name} {min(values) / per:.4g} to {max(values) / per:.4g} {unit} ({low / per:.4g} to {high / per:.4g})"
            )
    return f"It leaves the envelope of the study, of which alone a proof speaks: {', '.join(parts)}" if parts else ""


def _words(what: str, stretches: tuple[Stretch, ...]) -> str:
    parts = [f"{s.time[0]:.4g} to {s.time[1]:.4g} s ({s.speed[0]:.4g} to {s.speed[1]:.4g} m/s)" for s in stretches]
    return f"{what} {', '.join(parts)}" if parts else ""

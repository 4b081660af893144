"""Run folders: results are written beside their place and moved into it when complete."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Iterable, Mapping
from contextlib import nullcontext
from dataclasses import asdict
from datetime import datetime
from itertools import count
from pathlib import Path

import numpy as np

from .. import interrupts
from ..charts.chart import StabilityChart
from ..errors import Interrupted, OutputError
from ..motion.trajectory import TRAJECTORY_UNITS, Motion, Trajectory
from ..results import DesignResult
from ..stability.modes import ModeTable
from ..study.disturbances import Disturbance
from .staging import Claim, claim, occupied

__all__ = [
    "run_folder",
    "write_chart",
    "write_chart_json",
    "write_modes",
    "write_motion",
    "write_ranking",
    "write_run",
    "write_trajectory",
]

LONGEST_STEM = 180
"""Bytes of a study's name in that of its folder, which takes date and number more: file systems allow 255."""

MODE_COLUMNS = (
    "speed_m_s",
    "vertical_load_N",
    "mode",
    "real_1_s",
    "imag_rad_s",
    "frequency_Hz",
    "damping_ratio",
)


_claims: dict[Path, Claim] = {}
"""Folders that `run_folder` has given out and `write_run` has not filled yet."""


def run_folder(output: Path | None, name: str) -> Path:
    """Folder of a run, claimed for this process; its parent is made and proved writable before any work is done.

    Parameters
    ----------
    output : Path or None
        The folder to make; None: ``runs/NAME-DATE-TIME``.
    name : str
        Name of the study.

    Returns
    -------
    Path

    Raises
    ------
    OutputError
        If it exists and is not empty, cannot be written, or another run is going to fill it.
    """
    interrupts.begin()
    try:
        if output is None:
            return _first_free(name)
        if occupied(output):
            raise OutputError(f"{output}: exists already and is not an empty folder; choose another with -o, or remove it")
        if not _claimed(output):
            raise OutputError(f"{output}: another run is at work for this folder; choose another with -o")
    except OSError as error:
        raise OutputError(f"{output or 'runs'}: cannot be written: {error.strerror}; choose another folder with -o") from error
    return output


def _first_free(name: str) -> Path:
    stem = "".join(c if c.isalnum() else "-" for c in name.lower()).strip("-") or "run"
    short = stem.encode()[:LONGEST_STEM].decode(errors="ignore")
    base = Path("runs") / f"{short}-{datetime.now():%Y%m%d-%H%M%S}"
    for number in count(1):
        folder = base if number == 1 else base.with_name(f"{base.name}-{number}")
        if not folder.exists() and _claimed(folder):
            return folder
    raise AssertionError("numbers do not end")


def _claimed(folder: Path) -> bool:
    found = claim(folder)
    if found is not None:
        _claims[folder] = found
    return found is not None


def write_run(folder: Path, write: Callable[[Path], None], *, hold: bool = True) -> None:
    """Fill a folder atomically.

    Parameters
    ----------
    folder : Path
        Of `run_folder`.
    write : callable
        Writes everything into the folder it is given; if it raises, nothing remains.
    hold : bool
        Whether an interrupt waits until the folder is whole; not where `write` does the work itself.

    Raises
    ------
    OutputError
        If the disk refuses.
    Interrupted
        After the folder is whole.
    """
    try:
        found = _claims.pop(folder, None) or claim(folder)
        if found is None:
            raise OutputError(f"{folder}: another run is at work for this folder; choose another with -o")
        came: list[int] = []
        try:
            found.staging.mkdir(parents=True, exist_ok=True)  # somebody may have tidied up meanwhile
            with (
                interrupts.held("interrupted: writing the results; once more to drop them")
                if hold
                else nullcontext(came) as came
            ):
                write(found.staging)
                place = found.finish()
        finally:
            found.release()
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written: {error.strerror}; choose another folder with -o") from error
    if place != folder:
        raise OutputError(f"{folder}: appeared while the run was at work; the results are in {place}")
    if came:
        raise Interrupted(f"interrupted; the results are whole in {folder}")


def write_modes(path: Path, tables: Iterable[ModeTable]) -> None:
    """Modes as CSV, one row per speed and mode (of a conjugate pair the root with a positive imaginary part)."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(MODE_COLUMNS)
        for table in tables:
            for i, j in table.upper_half():
                root = table.eigenvalues[i, j]
                numbers = [root.real, abs(root.imag), table.frequency[i, j], table.damping_ratio[i, j]]
                speed_load = [f"{table.speeds[i]:.12g}", f"{table.load:.12g}"]
                writer.writerow([*speed_load, table.names[j], *(np.format_float_scientific(v, precision=11) for v in numbers)])


def write_ranking(path: Path, results: Iterable[DesignResult]) -> None:
    """Ranking as CSV: one row per combination, the lightest first."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        names = ("c_lambda", "k_lambda", "I_arm", "L", "gamma", "b")
        writer.writerow(["rank", "topology", "material", "status", "mass_kg", "abscissa_1_s", *names])
        for rank, result in enumerate(results, 1):
            mass = f"{result.mass.total:.9g}" if result.mass else ""
            abscissa = f"{result.stability.abscissa:.9g}" if result.stability else ""
            design = [f"{result.design[name]:.9g}" if name in result.design else "" for name in names]
            writer.writerow([rank, result.topology, result.material, result.status, mass, abscissa, *design])


def write_trajectory(path: Path, motion: Trajectory) -> None:
    """Trajectory as CSV: time, states and outputs in SI, one row per output time."""
    names = ("time", *motion.states, *motion.outputs)
    columns = (motion.time, *motion.states.values(), *motion.outputs.values())
    header = ",".join(f"{name} [{TRAJECTORY_UNITS[name]}]" for name in names)
    np.savetxt(path, np.column_stack(columns), fmt="%.10e", delimiter=",", header=header, comments="", encoding="utf-8")


def write_motion(
    path: Path, trajectory: Trajectory, motion: Motion, disturbance: Disturbance, design: Mapping[str, float]
) -> None:
    """What a trajectory shows as JSON, with the question that it answers."""
    record = {
        "speed": trajectory.speed,
        "load": trajectory.load,
        "disturbance": disturbance.model_dump(exclude_none=True),
        "design": dict(design),
        "engine": trajectory.engine,
        "status": trajectory.status,
        "message": trajectory.message,
        "duration": float(trajectory.time[-1]),
        **asdict(motion),
    }
    path.write_text(json.dumps(record, indent=2, allow_nan=False) + "\n", encoding="utf-8")


def write_chart(path: Path, record: StabilityChart) -> None:
    """Curves of a chart as CSV: one row per point, in order along each curve."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        varied = f"{record.varied.name} [{record.varied.unit}]" if record.varied else "family"
        axes = [f"{axis.name} [{axis.unit}]" for axis in (record.x, record.y)]
        writer.writerow([varied, "curve", *axes, "type", "frequency [Hz]"])
        for family in record.families:
            for number, curve in enumerate(family.curves, 1):
                for (x, y), hopf, frequency in zip(curve.points, curve.hopf, curve.frequency, strict=True):
                    kind = "Hopf" if hopf else "divergence"
                    value = "" if family.value is None else f"{family.value:.12g}"
                    writer.writerow([value, number, f"{x:.12g}", f"{y:.12g}", kind, f"{frequency:.9g}"])


def write_chart_json(path: Path, record: StabilityChart) -> None:
    """The same as JSON, with everything that was held fixed."""
    data = asdict(record)
    for family in data["families"]:
        for curve in family["curves"]:
            curve.update({key: curve[key].tolist() for key in ("points", "hopf", "frequency", "corners")})
    path.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")

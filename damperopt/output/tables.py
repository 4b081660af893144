"""Tables of a run: modes, rankings, motions and charts as CSV and JSON."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..charts.chart import StabilityChart
from ..motion.trajectory import Motion, Trajectory
from ..results import DesignResult
from ..stability.modes import ModeTable
from ..study.components import unit_of_name
from ..study.disturbances import Disturbance
from ..tyres.curves import TyreCurves
from ..tyres.path_response import RESPONSES, PathResponse

if TYPE_CHECKING:
    from ..motion.roll import Roll

__all__ = [
    "write_chart",
    "write_chart_json",
    "write_modes",
    "write_motion",
    "write_ranking",
    "write_response",
    "write_roll",
    "write_trajectory",
    "write_tyre",
]

MODE_COLUMNS = (
    "speed_m_s",
    "vertical_load_N",
    "mode",
    "real_1_s",
    "imag_rad_s",
    "frequency_Hz",
    "damping_ratio",
)


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


def write_ranking(path: Path, results: Sequence[DesignResult]) -> None:
    """Ranking as CSV: one row per combination, the lightest first; design variables in SI, their unit in the name."""
    names = list(dict.fromkeys(name for result in results for name in result.design))
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        columns = [f"{name} [{unit_of_name(name)}]" for name in names]
        writer.writerow(["rank", "topology", "material", "status", "mass_kg", "abscissa_1_s", *columns])
        for rank, result in enumerate(results, 1):
            mass = f"{result.mass.total:.9g}" if result.mass else ""
            abscissa = f"{result.stability.abscissa:.9g}" if result.stability else ""
            design = [f"{result.design[name]:.9g}" if name in result.design else "" for name in names]
            writer.writerow([rank, result.topology, result.material, result.status, mass, abscissa, *design])


def write_trajectory(path: Path, motion: Trajectory) -> None:
    """Trajectory as CSV: time, states and outputs in SI, one row per output time."""
    names = ("time", *motion.states, *motion.outputs)
    columns = (motion.time, *motion.states.values(), *motion.outputs.values())
    header = ",".join(f"{name} [{motion.units[name]}]" for name in names)
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


def write_roll(
    path: Path, trajectory: Trajectory, found: Roll, disturbance: Disturbance | None, design: Mapping[str, float]
) -> None:
    """What a motion along a history shows as JSON, with the question that it answers."""
    record = {
        "along": trajectory.along,
        "disturbance": None if disturbance is None else disturbance.model_dump(exclude_none=True),
        "design": dict(design),
        "engine": trajectory.engine,
        "status": trajectory.status,
        "message": trajectory.message,
        "duration": float(trajectory.time[-1] - trajectory.time[0]),
        **asdict(found),
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


def write_tyre(folder: Path, record: TyreCurves) -> None:
    """A tyre over load as ``tyre.csv``, its force and moment over slip as ``tyre-slip.csv``; SI."""
    with open(folder / "tyre.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["load [N]", *(f"{name} [{column.unit}]" for name, column in record.table.items())])
        for i, load in enumerate(record.loads):
            writer.writerow([f"{load:.9g}", *(_or_empty(column.values[i]) for column in record.table.values())])
    with open(folder / "tyre-slip.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["load [N]", "slip_angle [rad]", "side_force [N]", "aligning_moment [N m]"])
        for load, force, moment in zip(record.drawn, record.force, record.moment, strict=True):
            for alpha, F_y, M_z in zip(record.slips, force, moment, strict=True):
                writer.writerow([f"{load:.9g}", f"{alpha:.9g}", _or_empty(F_y), _or_empty(M_z)])


def write_response(path: Path, record: PathResponse) -> None:
    """Force and moment over path frequency as CSV: a row for each contact line and frequency, real and imaginary parts [SI]."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        parts = [f"{name} {part} [{unit}]" for name, unit in RESPONSES.items() for part in ("real", "imaginary")]
        writer.writerow(["contact line", "load [N]", "path frequency [rad/m]", "contact lengths per wave", *parts])
        for line, values in record.lines.items():
            for k, length, response in zip(record.frequencies, record.contact_lengths, values.T, strict=True):
                numbers = [part for value in response for part in (value.real, value.imag)]
                writer.writerow([line, *(f"{number:.9g}" for number in (record.load, k, length, *numbers))])


def _or_empty(value: float) -> str:
    return f"{value:.9g}" if np.isfinite(value) else ""

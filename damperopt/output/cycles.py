"""Files of limit cycles: branches as CSV and JSON, the largest cycle over time."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from ..cycles.amplitude_map import AmplitudeMap
from ..cycles.criticality import Criticality
from ..cycles.edge import Kicker, Threshold
from ..cycles.orbit import Branch, Orbit
from ..stability.critical import CriticalSpeed

__all__ = ["branch_record", "write_branches", "write_critical", "write_cycle", "write_map", "write_threshold"]


def write_branches(folder: Path, branches: Sequence[Branch], question: Mapping[str, Any]) -> None:
    """Branches as ``cycles.csv``, one row per orbit, and ``cycles.json`` with the question that they answer; SI."""
    answer = {"question": dict(question), "branches": [branch_record(branch) for branch in branches]}
    (folder / "cycles.json").write_text(json.dumps(answer, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    if not branches:
        return
    units, shown = _shown(branches[0].orbits[0])
    with open(folder / "cycles.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        varied = f"{branches[0].name} [{branches[0].unit}]"
        words = ("amplitude of", "peak of", "mean of")
        columns = [f"{word} {name} [{units[name]}]" for name in shown for word in words]
        head = ["branch", varied, "frequency [Hz]", "stable", "unstable multipliers", "largest multiplier", "label", "beyond"]
        writer.writerow([*head, *columns])
        for number, branch in enumerate(branches, 1):
            for orbit in branch.orbits:
                values = [f"{table[name]:.9g}" for name in shown for table in (orbit.amplitudes, orbit.peaks, orbit.means)]
                size = float(np.abs(orbit.multipliers).max())
                facts = [f"{orbit.parameter:.12g}", f"{orbit.frequency:.12g}", str(orbit.stable).lower(), orbit.unstable]
                writer.writerow([number, *facts, f"{size:.9g}", orbit.label, orbit.beyond, *values])


def _shown(orbit: Orbit) -> tuple[Mapping[str, str], list[str]]:
    """Units of states and outputs, and names of those that are shown."""
    flow = orbit.path.legs[0].flow
    hidden = {state.name for state in flow.states if state.hidden}
    return flow.units, [name for name in flow.output_names if name not in hidden]


def branch_record(branch: Branch) -> dict[str, Any]:
    """A branch as data for JSON."""
    _, shown = _shown(branch.orbits[0])
    return {
        "varied": branch.name,
        "unit": branch.unit,
        "kind": branch.kind,
        "begins": branch.begins,
        "ends": branch.ends,
        "relative_error": branch.error if np.isfinite(branch.error) else None,
        "multiplier_error": branch.multiplier_error if np.isfinite(branch.multiplier_error) else None,
        "orbits": [_orbit_record(orbit, shown) for orbit in branch.orbits],
    }


def _orbit_record(orbit: Orbit, shown: Sequence[str]) -> dict[str, Any]:
    tables = {"amplitudes": orbit.amplitudes, "peaks": orbit.peaks, "means": orbit.means}
    return {
        "parameter": orbit.parameter,
        "frequency": orbit.frequency,
        "stable": orbit.stable,
        "label": orbit.label,
        "beyond": orbit.beyond,
        "multipliers": [[value.real, value.imag] for value in orbit.multipliers],
        **{key: {name: table[name] for name in shown} for key, table in tables.items()},
    }


def write_cycle(path: Path, orbit: Orbit) -> None:
    """States of one limit cycle over a period as CSV; SI."""
    flow = orbit.path.legs[0].flow
    kept = [i for i, state in enumerate(flow.states) if not state.hidden]
    time, states = orbit.time_and_states()
    header = ",".join(["time [s]", *(f"{flow.states[i].name} [{flow.states[i].unit}]" for i in kept)])
    table = np.column_stack([time, states[:, kept]])
    np.savetxt(path, table, fmt="%.10e", delimiter=",", header=header, comments="", encoding="utf-8")


def write_critical(path: Path, critical: Sequence[CriticalSpeed], criticality: Sequence[Criticality]) -> None:
    """Critical speeds as CSV, with how their limit cycles begin; empty where none does."""
    begins = {(c.speed, c.load): c for c in criticality}
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        head = ["speed [m/s]", "load [N]", "kind", "frequency [Hz]", "destabilising", "boundary", "touching"]
        writer.writerow([*head, "criticality", "growth rate per amplitude squared", "amplitude of"])
        for c in critical:
            facts = [str(value).lower() for value in (c.destabilising, c.boundary, c.touching)]
            found = begins.get((c.speed, c.load)) if c.kind == "hopf" and not c.touching else None
            more = [found.kind, f"{found.coefficient:.9g}", found.leading] if found else ["", "", ""]
            writer.writerow([f"{c.speed:.12g}", f"{c.load:.12g}", c.kind, f"{c.frequency:.9g}", *facts, *more])


def write_threshold(folder: Path, found: Sequence[Threshold], kicker: Kicker, question: Mapping[str, Any]) -> None:
    """Largest disturbances that die over speed, as ``threshold.csv`` and ``threshold.json``; SI."""
    rows = [asdict(t) for t in found]
    record = {"question": dict(question), "disturbance": kicker.kind, "of": kicker.name, "unit": kicker.unit, "points": rows}
    (folder / "threshold.json").write_text(json.dumps(record, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    with open(folder / "threshold.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["speed [m/s]", "load [N]", f"dies [{kicker.unit}]", f"does not die [{kicker.unit}]", "which then"])
        for t in found:
            sizes = ["" if value is None else f"{value:.9g}" for value in (t.dies, t.not_dies)]
            writer.writerow([f"{t.speed:.12g}", f"{t.load:.12g}", *sizes, t.fate])


def write_map(path: Path, found: AmplitudeMap) -> None:
    """Largest stable cycles over two quantities as CSV, one row per point; SI."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        axes = [f"{axis.name} [{axis.unit}]" for axis in (found.x, found.y)]
        writer.writerow([*axes, "amplitude of yaw_angle [rad]", "branch lost"])
        for k, y in enumerate(found.rows):
            for i, x in enumerate(found.columns):
                writer.writerow([f"{x:.12g}", f"{y:.12g}", f"{found.yaw[k, i]:.9g}", str(bool(found.lost[k, i])).lower()])

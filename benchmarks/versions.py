"""Numbers of the package at fixed studies and designs, to compare two versions of it.

    python benchmarks/versions.py write FILE         with the version to keep
    python benchmarks/versions.py compare FILE       with the version that has changed; prints the differences

Matrices, masses, constraints, charts, critical speeds and transients are compared at fixed designs; ``--optima``: optima too.
"""

from __future__ import annotations

import argparse
import json
import warnings
from collections.abc import Iterator
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import numpy as np

import damperopt

CONFIGS = Path(__file__).parents[1] / "configs"
DESIGN = {"c_lambda": 34803.0, "I_arm": 5.6663e-7, "k_lambda": 2.5e7, "L": 0.4781, "gamma": 0.53215, "b": 0.15244}
LAYOUTS = ("boeing", "utas", "arreaza")
GEOMETRIES = ("published", "planar", "spatial")
EXTRAS = {
    "plain": {},
    "link": {"damper__link_stiffness": 2e7},
    "series": {"damper__series_stiffness": 3e7},
    "both": {"damper__link_stiffness": 2e7, "damper__series_stiffness": 3e7},
    "joints": {
        "damper__freeplay": {"gap": 2e-4},
        "damper__end_stop": {"stroke": 5e-3, "stiffness": 1e9},
        "damper__orifice": {"coefficient": 5e4},
        "gear__friction": {"torque": 20.0},
    },
}
TYRES = {
    "linear": {"law": "linear", "cornering_slope": 8.0, "aligning_coefficient": 0.5},
    "tangent": {"law": "straight_tangent", "carcass_stiffness": 1.4e6},
}
SHARED = {"half_contact_length": 0.1, "relaxation_length": 0.3, "tread_width_moment": 570.0}


def _problem(study: damperopt.Study) -> object:
    old, new = "damperopt.problem", "damperopt.optimum.problem"
    module = import_module(old if find_spec(old) else new)
    return module.DesignProblem(study)


def _studies() -> Iterator[tuple[str, damperopt.Study]]:
    main = damperopt.load(CONFIGS / "thesis_gear.yaml")
    design = {
        "c_lambda": {"start": 15000.0, "min": 100.0, "max": 1e7},
        "k_lambda": {"start": 3.8e6, "min": 1e5, "max": 1e9},
        "I_arm": {"start": 5e-6, "min": 1e-8, "max": 1e-4},
        "L": {"start": 0.6, "min": 0.2, "max": 1.5},
        "gamma": {"start": 0.541, "min": 0.09, "max": 1.48},
        "b": {"start": 0.2, "min": 0.02, "max": 0.6},
    }
    for layout in LAYOUTS:
        for geometry in GEOMETRIES:
            for extra, changes in EXTRAS.items():
                study = main.replace(damper__topology=layout, damper__geometry=geometry, design=design, **changes)
                yield f"{layout} {geometry} {extra}", study
    for name, tyre in TYRES.items():
        yield f"tyre {name}", main.replace(tyre={**SHARED, **tyre}, requirements__limit_torque=12500.0)
    for file in ("nose_gear_somieski", "nose_gear_thota", "minimal"):
        yield file, damperopt.load(CONFIGS / f"{file}.yaml")


def collect(optima: bool) -> dict[str, dict[str, list[float]]]:
    """Numbers by study and kind."""
    found: dict[str, dict[str, list[float]]] = {}
    for name, study in _studies():
        mine = found[name] = {}
        design = {key: DESIGN.get(key, start) for key, start in study.start.items()}
        gear = damperopt.linear_gear(study, design)
        speeds, loads = np.array([1.0, 5.0, 8.75, 40.0, 150.0]), study.envelope.loads[0]
        mine["matrices"] = gear.matrices(speeds, loads).ravel().tolist()
        mine["matrices, other load"] = gear.matrices(speeds, 0.4 * loads).ravel().tolist()
        if "joints" not in name or "planar" in name:
            motion = damperopt.simulate(
                study, design, speed=30.0, disturbance={"release": {"yaw_angle": 0.01}}, duration=0.4, engine="cvodes"
            )
            shown = [] if "rotational" in study.damper.topology else sorted(set(motion.outputs) - {"unclosed"})
            rows = [motion.time, *motion.states.values(), *(motion.outputs[key] for key in shown)]
            sizes = [np.abs(row).max() or 1.0 for row in rows]  # each quantity in units of its largest value
            shown_rows = [row[:: max(len(row) // 20, 1)] / size for row, size in zip(rows, sizes, strict=True)]
            mine["transient"] = np.concatenate(shown_rows).tolist()
        if design and study.requirements is not None:
            problem = _problem(study)
            mine["mass"] = [mass for _, mass in sorted(problem.parts(design).items())]
            mine["constraints"] = [row for _, row in sorted(problem.rows(design).items())]
            mine["values"] = [number for _, pair in sorted(problem.values(design).items()) for number in pair]
            mine["limit event"] = list(problem.limit_event(design).values())
        if "link" in name or "series" in name or "both" in name:
            continue
        crossing = damperopt.critical_speeds(gear, loads, 1.0, 200.0)
        mine["critical speeds"] = [n for c in crossing for n in (c.speed, c.frequency)]
        mine["worst"] = [n for p in damperopt.worst_points(gear, study.envelope) for n in (p.speed, p.load, p.abscissa)][:3]
        mine["certificate"] = [float(damperopt.certify(study, design, margin=m).proved) for m in (0.0, 0.1)]
        if "plain" in name:
            spring = "k_lambda" if study.damper.topology == "boeing" else "I_arm"
            record = damperopt.chart(
                study, ("c_lambda", 0.0, 1e5), (spring, 0.0, 2 * design[spring]), vary=("speed", [20.0, 80.0]), design=design
            )
            points = [c.points for f in record.families for c in f.curves]
            mine["chart"] = np.concatenate([p[:: max(len(p) // 10, 1)].ravel() for p in points] or [np.zeros(0)]).tolist()
    if optima:
        for layout in LAYOUTS:
            study = damperopt.load(CONFIGS / "thesis_gear.yaml").replace(damper__topology=layout, solver__starts=6)
            for kind, variant in (("decay", study), ("stable", study.replace(requirements__decay=None))):
                result = damperopt.optimise(variant)
                mass = result.mass.total if result.mass else float("nan")
                found[f"optimum {layout} {kind}"] = {"optimum mass": [mass], "optimum design": list(result.design.values())}
    return found


def compare(before: dict[str, dict[str, list[float]]], after: dict[str, dict[str, list[float]]]) -> None:
    """Print the largest relative difference of each kind, relative to the largest number of its list where that is more."""
    worst: dict[str, tuple[float, str]] = {}
    for study, kinds in before.items():
        for kind, old in kinds.items():
            new = after.get(study, {}).get(kind)
            if new is None or len(new) != len(old):
                worst[kind] = (np.inf, f"{study}: {len(old)} numbers, now {None if new is None else len(new)}")
                continue
            a, b = np.array(old), np.array(new)
            floor = 1.0 if kind == "transient" else 1e-9
            scale = np.maximum(np.abs(a), floor * np.abs(a).max(initial=0.0) + 1e-300)
            difference = float((np.abs(a - b) / scale).max(initial=0.0))
            if difference >= worst.get(kind, (-1.0, ""))[0]:
                worst[kind] = (difference, study)
    for kind, (difference, study) in worst.items():
        print(f"{kind:24s} {difference:9.2e}   {study}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("action", choices=("write", "compare"))
    parser.add_argument("file", type=Path)
    parser.add_argument("--optima", action="store_true")
    chosen = parser.parse_args()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # names of the older version serve both
        numbers = collect(chosen.optima)
    if chosen.action == "write":
        chosen.file.write_text(json.dumps(numbers))
    else:
        compare(json.loads(chosen.file.read_text()), numbers)


if __name__ == "__main__":
    main()

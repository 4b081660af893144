"""What contact memory costs: certificates over speed and over speed and load, and charts beside those without memory.

    python benchmarks/memory.py

Processor time. Goals: a certificate over speed 0.3 s, over speed and load 10 s; a traced chart with memory five times the time
of one with `leading_point`.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from typing import Any

import damperopt
from damperopt.stability.linear import LinearModel

GEAR = """
name: benchmark
gear: {kind: yaw_bending, yaw_inertia: 100 kg m^2, caster_length: 0.12 m, wheel_radius: 0.362 m,
       lateral: {inertia: 600 kg m^2, stiffness: 6.1e6 N m/rad, damping: 300 N m s/rad, height: 2.5 m}}
tyre: {law: stiffness, contact: memory, half_contact_length: 0.1 m, relaxation_length: 0.3 m, cornering_stiffness: 2100 N/rad,
       aligning_stiffness: 1.5e5 N m/rad, tread_width_moment: 570 N m^2/rad}
damper: {topology: rotational, torsional_stiffness: 1.4507e6 N m/rad, torsional_damping: 2047.7 N m s/rad}
envelope: {speed: {min: 5 m/s, max: 100 m/s}, vertical_load: 150 kN}
"""
RANGE = {"min": 80e3, "max": 150e3}
PLANES: dict[str, tuple[Any, Any]] = {
    "speed by damping, traced": (("speed", 5.0, 100.0), ("damper.torsional_damping", 0.0, 3000.0)),
    "damping by stiffness, explicit": (("damper.torsional_damping", 0.0, 3000.0), ("damper.torsional_stiffness", 0.0, 2e6)),
}


def spent(work: Callable[[], Any], repeats: int = 3) -> tuple[Any, float]:
    """Answer, and the least processor time [s]."""
    times = []
    for _ in range(repeats):
        begin = time.process_time()
        found = work()
        times.append(time.process_time() - begin)
    return found, min(times)


def certificates(study: damperopt.Study) -> None:
    print("| certificate | margin | verdict | boxes | s |\n|---|---|---|---|---|")
    for words, changes in (("over speed", {}), ("over speed and load", {"envelope__vertical_load": RANGE})):
        changed = study.replace(**changes)
        model = LinearModel(changed)
        for margin in (0.05, 0.1):
            found, seconds = spent(partial(damperopt.certify, changed, {}, margin, model))
            print(f"| {words} | {margin} | {found.verdict} | {found.boxes} | {seconds:.3f} |")


def charts(study: damperopt.Study) -> None:
    print("\n| chart | memory, s | leading_point, s | ratio |\n|---|---|---|---|")
    for words, (x, y) in PLANES.items():
        both = [study.replace(tyre__contact=contact) for contact in ("memory", "leading_point")]
        ours, theirs = (spent(lambda study=study, x=x, y=y: damperopt.chart(study, x, y))[1] for study in both)
        print(f"| {words} | {ours:.2f} | {theirs:.2f} | {ours / theirs:.1f} |")


if __name__ == "__main__":
    towed = damperopt.loads(GEAR)
    certificates(towed)
    charts(towed)

"""CPU seconds of `damperopt optimise configs/main_gear.yaml`, all in: what memory, figures, layouts and materials cost.

    python benchmarks/main_job.py [--runs 3] [--all]

User and system seconds of the process and its children, the least of some runs: on a busy machine they are longer than on an
idle one, so the ratios to the first row count. With --all three layouts with every material too, in one process.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

STUDY = Path(__file__).parents[1] / "configs" / "main_gear.yaml"
COMBINATIONS = ("--topology", "boeing,utas,arreaza", "--material", "all", "--no-figures", "--workers", "1")


def cpu(study: str, *options: str) -> float:
    """Seconds of one run of the command."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "study.yaml"
        file.write_text(study, encoding="utf-8")
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        command = [sys.executable, "-m", "damperopt", "optimise", str(file), "-o", f"{folder}/run", *options]
        subprocess.run(command, check=True, capture_output=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--all", action="store_true", help="three layouts with every material too")
    arguments = parser.parse_args()
    memory = STUDY.read_text(encoding="utf-8")
    jobs: dict[str, tuple[str, tuple[str, ...]]] = {
        "as it is": (memory, ()),
        "without figures": (memory, ("--no-figures",)),
        "leading point, without figures": (memory.replace("contact: memory", "contact: leading_point"), ("--no-figures",)),
    }
    if arguments.all:
        jobs["three layouts with every material, without figures"] = memory, COMBINATIONS
    print("| main job | CPU [s] | over the first |\n|---|---|---|")
    first = None
    for name, (study, options) in jobs.items():
        seconds = min(cpu(study, *options) for _ in range(arguments.runs))
        first = first or seconds
        print(f"| {name} | {seconds:.1f} | {seconds / first:.2f} |", flush=True)


if __name__ == "__main__":
    main()

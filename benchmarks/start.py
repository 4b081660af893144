"""CPU seconds until help is printed: the interpreter alone, then the help of every command, the least of some runs."""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys

COMMANDS = ("", "optimise", "report", "analyse", "simulate", "chart", "sweep", "thesis", "validate", "init", "schema")


def cpu(*arguments: str) -> float:
    """User and system seconds of one Python process."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, *arguments], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=5)
    runs = parser.parse_args().runs
    print(f"{'python -c pass':28}{min(cpu('-c', 'pass') for _ in range(runs)):.3f} s")
    for name in COMMANDS:
        words = [*name.split(), "--help"]
        print(f"{'damperopt ' + ' '.join(words):28}{min(cpu('-m', 'damperopt', *words) for _ in range(runs)):.3f} s")


if __name__ == "__main__":
    main()

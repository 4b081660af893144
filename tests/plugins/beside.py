"""Run command lines of a JSON list from standard input one after the other in this process: starting takes a second each."""

import contextlib
import io
import json
import os
import shlex
import sys
import traceback
from pathlib import Path

ROOT = Path(__file__).parents[2]
TOY = Path(__file__).parent / "toy"


def environment(place: Path) -> dict[str, str]:
    """Of a process that finds the distributions in a folder beside this package."""
    return os.environ | {"PYTHONPATH": os.pathsep.join([str(place), str(ROOT)])}


def run(lines: list[str]) -> list[dict]:
    """Code, stdout and stderr of each."""
    answers = []
    for line in lines:
        out, err = io.StringIO(), io.StringIO()
        sys.argv, code = ["damperopt", *shlex.split(line)], 0
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            try:
                from damperopt.cli import main

                main()
            except SystemExit as end:
                code = end.code or 0
            except BaseException:
                traceback.print_exc()
                code = -1
        answers.append({"code": code, "out": out.getvalue(), "err": err.getvalue()})
    return answers


if __name__ == "__main__":
    json.dump(run(json.load(sys.stdin)), sys.stdout)

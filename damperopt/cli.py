"""Command line: the commands under one name; errors become exit codes."""

from __future__ import annotations

import os
import signal
import sys
from importlib.metadata import version
from typing import Annotated, Any

import typer

from .commands import analyse, chart, init, optimise, report, schema, simulate, sweep, thesis, validate
from .commands.shared import err, out, pressed
from .errors import DamperoptError

__all__ = ["app", "main"]

app = typer.Typer(
    name="damperopt",
    help="Lightest shimmy damper for a landing gear, proved stable at every speed of its envelope.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
for command in (optimise, report, analyse, simulate, chart, sweep, thesis, validate, init, schema):
    app.command()(command)


def _interrupt(number: int, frame: Any) -> None:
    pressed.append(number)
    raise KeyboardInterrupt


def main() -> None:
    """Entry point of the command ``damperopt``."""
    signal.signal(signal.SIGINT, _interrupt)
    os.environ.setdefault("MPLBACKEND", "Agg")  # figures go to files, in worker processes too
    try:
        app()
    except DamperoptError as error:
        err.print(str(error), markup=False, soft_wrap=True)
        sys.exit(error.exit_code)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)


def _show_version(wanted: bool) -> None:
    if wanted:
        out.print(f"damperopt {version('damperopt')}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    pass

"""Command line: the commands under one name; errors become exit codes."""

from __future__ import annotations

import io
import os
import sys
from typing import Annotated

from . import interrupts

with interrupts.at_once():
    import typer

    from .commands import (
        analyse,
        breakout,
        chart,
        components,
        cycles,
        export,
        frequency,
        gains,
        init,
        optimise,
        report,
        schema,
        simulate,
        sweep,
        thesis,
        tyre,
        validate,
        verify,
    )
    from .commands.shared import err, out
    from .errors import DamperoptError, OutputError

__all__ = ["app", "main"]

app = typer.Typer(
    name="damperopt",
    help="Lightest shimmy damper for a landing gear, proved stable at every speed of its envelope.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # markup would eat "[default: ...]" and "damperopt[cluster]"
)
IN_ORDER = (
    optimise,
    verify,
    report,
    analyse,
    simulate,
    cycles,
    breakout,
    chart,
    frequency,
    sweep,
    tyre,
    export,
    gains,
    thesis,
    components,
    validate,
    init,
    schema,
)
for command in IN_ORDER:
    app.command(short_help=(command.__doc__ or "").splitlines()[0])(command)  # as it is: by itself it would end at "C."


def main() -> None:
    """Entry point of the command ``damperopt``."""
    interrupts.listen()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal that lacks a character shows a sign in its place
    os.environ.setdefault("MPLBACKEND", "Agg")  # figures go to files, in worker processes too
    try:
        code = _run()
    except KeyboardInterrupt:
        code = _interrupted("")
    interrupts.end()
    sys.exit(code)


def _run() -> int:
    """Run the command of the command line; its exit code."""
    try:
        try:
            app()
        finally:
            sys.stdout.flush()
    except DamperoptError as error:
        if interrupts.heard():
            return _interrupted(str(error))
        err.print(str(error), markup=False, soft_wrap=True)
        return error.exit_code
    except SystemExit as end:
        if interrupts.heard():
            return _interrupted("")
        return end.code if isinstance(end.code, int) else int(end.code is not None)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except OSError as error:
        if error.filename is not None:  # of a file, and not of the output
            raise
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        words = f"the output cannot be written: {error.strerror}; results that were written before are kept"
        err.print(words, markup=False, soft_wrap=True)
        return OutputError.exit_code
    except Exception:  # a library turns an interrupt into an error of its own now and then
        if not interrupts.heard():
            raise
        return _interrupted("")
    return 0


def _interrupted(words: str) -> int:
    """Say it; the exit code tells Ctrl-C from SIGTERM."""
    interrupts.answered()
    err.print(words or "interrupted", markup=False, soft_wrap=True)
    return interrupts.exit_code()


def _show_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        out.print(f"damperopt {version('damperopt')}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    pass

"""What the commands share: consoles, options, progress, interrupts."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from rich.markup import escape
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    Task,
    TaskID,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.text import Text

from .. import interrupts
from ..errors import ConfigError, Interrupted

if TYPE_CHECKING:  # a command imports its work when it runs: help must not wait for it
    from ..results import DesignResult
    from ..study.study import Study

__all__ = [
    "ConfigArgument",
    "DesignOption",
    "OutputOption",
    "all_or_nothing",
    "bar",
    "err",
    "out",
    "progress",
    "study_and_design",
    "workers_for",
]

FEW_STARTS = 24

SECONDS_A_LINE = 5.0
"""Between two lines of progress where there is no terminal."""


class _Plain(Console):
    """Console that shows control characters of names and files as a sign: what a file says must not steer the terminal."""

    def render_str(self, text: str, **options: Any) -> Text:
        """Text of rich's markup, without control characters other than line feed and tabulator."""
        return super().render_str(
            "".join(c if c in "\n\t" or c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text), **options
        )


# no emoji: 5:100:1 is a range of speeds
out, err = _Plain(highlight=False, emoji=False), _Plain(stderr=True, highlight=False, emoji=False)

ConfigArgument = Annotated[Path, typer.Argument(metavar="CONFIG", help="Study, a YAML file.")]
OutputOption = Annotated[
    Path | None, typer.Option("-o", "--output", metavar="DIR", help="New folder for the results. [default: runs/NAME-DATE]")
]
DesignOption = Annotated[
    Path | None, typer.Option(help="result.json of 'optimise', or its folder. [default: the starts of the study]")
]


@contextmanager
def all_or_nothing() -> Iterator[None]:
    """Work that leaves nothing behind when it is interrupted."""
    interrupts.begin()
    try:
        yield
        interrupts.check()  # an interrupt that was swallowed: the answer must not pass for a whole one
    except Interrupted:
        raise
    except BaseException as error:  # where a wrapped library was interrupted, it raises what it likes
        if not (interrupts.heard() or isinstance(error, KeyboardInterrupt)):
            raise
        interrupts.answered()
        raise Interrupted("interrupted; nothing was written") from None


class _RateColumn(ProgressColumn):
    """Steps per minute."""

    def render(self, task: Task) -> Text:
        return Text("" if task.speed is None else f"{60 * task.speed:.3g}/min")


class _Lines:
    """Progress where no terminal shows a bar: a line every few seconds, none for short work."""

    def __init__(self) -> None:
        self._words, self._said, self._done = "", "", 0.0
        self._total: float | None = None
        self._ended, self._clock = threading.Event(), time.monotonic()
        self._thread = threading.Thread(target=self._print, daemon=True)
        self._thread.start()

    def add_task(self, description: str, total: float | None = None, completed: float = 0) -> TaskID:
        self._words, self._done, self._total = description, completed, total
        return TaskID(0)

    def update(
        self,
        task: TaskID,
        *,
        advance: float = 0,
        completed: float | None = None,
        total: float | None = None,
        description: str | None = None,
    ) -> None:
        self._done = self._done + advance if completed is None else completed
        self._total = self._total if total is None else total
        self._words = description or self._words

    def _print(self) -> None:
        while not self._ended.wait(SECONDS_A_LINE):
            self._say()

    def _say(self) -> None:
        self._said = self._state
        with suppress(OSError):  # nobody reads it
            err.print(f"{self._said}, {time.monotonic() - self._clock:.0f} s", markup=False, soft_wrap=True)

    @property
    def _state(self) -> str:
        return f"{self._words}: {self._done:g}" + ("" if self._total is None else f" of {self._total:g}")

    def end(self) -> None:
        """The last line that was shown is brought up to date; short work stays without one."""
        self._ended.set()
        self._thread.join()
        if self._said not in ("", self._state):
            self._say()


@contextmanager
def bar() -> Iterator[Progress | _Lines]:
    """Progress on the error stream: a bar that is gone when done, or, without a terminal, a line every few seconds."""
    interrupts.begin()
    if not err.is_terminal:
        lines = _Lines()
        try:
            yield lines
        finally:
            lines.end()
        return
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        _RateColumn(),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=err, transient=True) as shown:
        yield shown


@contextmanager
def progress() -> Iterator:
    """Report of finished starts by study."""
    with bar() as shown:
        task = shown.add_task("starting", total=None)

        def report(done: int, total: int, study: Study) -> None:
            interrupts.check()
            words = f"{study.damper.topology}, {study.material.name}"
            shown.update(task, completed=done, total=total, description=escape(words))

        yield report


def workers_for(studies: Sequence[Study]) -> int:
    """One process per core, or one alone for few starts: new processes take as long to start as 20 starts to solve."""
    if sum(study.solver.starts for study in studies) <= FEW_STARTS:
        return 1
    from ..workers import cores

    return cores()


def study_and_design(file: Path, design: Path | None) -> tuple[Study, dict[str, float] | None]:
    """A study, and the design of a result with the layout that it was made for; without one, None."""
    from ..results import load_result
    from ..study import config

    study = config.load(file)
    return (study, None) if design is None else _with_design(study, load_result(design), file, design)


def _with_design(study: Study, result: DesignResult, file: Path, source: Path) -> tuple[Study, dict[str, float]]:
    """The study with the layout and material that the result was made for, and its design."""
    changes: dict[str, Any] = {
        "damper__topology": result.topology,
        "damper__geometry": result.geometry,
        "material": result.config.get("material", study.material.name),
    }
    if kind := result.config.get("damper", {}).get("kind"):
        changes["damper__kind"] = kind
    older = _as_it_was(study, result)
    changes |= {key.replace(".", "__"): value for key, value in older.items()}
    if result.stock is not None:
        changes |= {path.replace(".", "__"): value for path, value in result.stock.changes.items()}
        if "damper" in changes:  # the whole block, of a bought damper
            changes = {path: value for path, value in changes.items() if not path.startswith("damper__")}
    try:
        changed = study.replace(**changes)
    except ConfigError as error:
        raise ConfigError([f"{file}: does not go with {source}: {problem}" for problem in error.problems]) from None
    names = changed.variable_names
    if set(result.design) != set(names) or not all(0 < value < math.inf for value in result.design.values()):
        raise ConfigError(
            f"{source}:1: design: found {result.design or 'none'} (status {result.status}); "
            f"allowed: a result with positive {', '.join(names) or 'design variables'}"
        )
    out.print(
        f"Layout ({result.topology}, {result.geometry}) and material ({result.material}) are those of {source}; "
        f"all else is that of {file}.",
        soft_wrap=True,
        markup=False,
    )
    if older:
        taken = ", ".join(f"{key} {value}" for key, value in older.items())
        out.print(f"{source} is {result.completed[0]}; taken from it: {taken}.", soft_wrap=True, markup=False)
    return changed, result.design


def _as_it_was(study: Study, result: DesignResult) -> dict[str, Any]:
    """What a design of schema version 1 was made for, of those keys that the study leaves to their defaults."""
    if not result.completed:
        return {}
    found = {"damper.compliance": "rigid"} if "compliance" not in study.damper.model_fields_set else {}
    return found | ({"tyre.contact": "leading_point"} if "contact" not in study.tyre.model_fields_set else {})

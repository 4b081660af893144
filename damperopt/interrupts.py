"""Ctrl-C, SIGTERM and a closed terminal: what was heard, and how the work at hand takes it.

Until work begins that must be cleared up, a signal ends the process at once: nothing is lost, and no import can swallow it.
Afterwards it is raised as KeyboardInterrupt, again every few seconds until somebody says that he deals with it: now and then a
library swallows the exception. While results are written it waits until they are whole.
"""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

__all__ = ["answered", "at_once", "begin", "check", "end", "exit_code", "heard", "held", "listen"]

AGAIN = 3.0
"""Seconds after which an interrupt that nobody answered is raised once more."""

ONE_PRESS = 1.0
"""Seconds within which signals count as one: `timeout`, for one, sends each twice."""


class _State:
    """Of this process; signals are the process's own."""

    def __init__(self) -> None:
        self.heard: list[int] = []
        self.last = -ONE_PRESS
        self.begun = False
        self.unanswered = False
        self.holding = False
        self.came = False
        self.words = ""


_state = _State()


def _signals() -> list[int]:
    known = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
    hangup = getattr(signal, "SIGHUP", None)  # ignored under nohup, which must stay so
    return [number for number in known if number != hangup or signal.getsignal(number) is not signal.SIG_IGN]


def listen() -> None:
    """Take signals from now on; in the main thread, by the command line alone."""
    for number in _signals():
        signal.signal(number, _hear)
    if hasattr(signal, "setitimer"):
        signal.signal(signal.SIGALRM, _raise_again)


@contextmanager
def at_once() -> Iterator[None]:
    """A signal ends the process here without a traceback, as nothing has been done yet."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.signal(number, lambda number, frame: _leave(number)) for number in _signals()}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def begin() -> None:
    """From now on there is something to clear up, and a signal is raised as KeyboardInterrupt."""
    _state.begun = True


def check() -> None:
    """Raise the interrupt that a library has swallowed, if there is one.

    Raises
    ------
    KeyboardInterrupt
    """
    if _state.unanswered and not _state.holding:
        raise KeyboardInterrupt


def answered() -> None:
    """The interrupt has arrived where it is dealt with: it is not raised again."""
    _state.unanswered = False
    if hasattr(signal, "setitimer") and threading.current_thread() is threading.main_thread():
        signal.setitimer(signal.ITIMER_REAL, 0)


@contextmanager
def held(words: str = "") -> Iterator[list[int]]:
    """Signals wait for the end of the block; a second one, later than a second after the first, is raised.

    Parameters
    ----------
    words : str
        For the user who interrupts, on the error stream.

    Yields
    ------
    list
        Empty; holds the signals that came once the block is over.
    """
    answered()
    came: list[int] = []
    before = len(_state.heard)
    _state.holding, _state.came, _state.words = True, False, words
    try:
        yield came
    finally:
        _state.holding = False
        came.extend(_state.heard[before:])


def heard() -> bool:
    """Whether a signal has come."""
    return bool(_state.heard)


def exit_code() -> int:
    """128 and the number of the first signal: 130 for Ctrl-C, 143 for SIGTERM."""
    return 128 + (_state.heard[0] if _state.heard else signal.SIGINT)


def end() -> None:
    """The command is over: what is left of the process is short and must not be cut."""
    answered()
    for number in _signals():
        signal.signal(number, signal.SIG_IGN)


def _leave(number: int) -> None:
    os.write(2, b"interrupted; nothing was written\n")
    os._exit(128 + number)


def _hear(number: int, frame: Any) -> None:
    if not _state.begun:
        _leave(number)
    _state.heard.append(number)
    now, last = time.monotonic(), _state.last
    _state.last = now
    if now - last < ONE_PRESS:
        return
    if _state.holding and not _state.came:
        _state.came = True
        if _state.words:
            os.write(2, f"{_state.words}\n".encode())
        return
    _state.unanswered = True
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_REAL, AGAIN, AGAIN)
    raise KeyboardInterrupt


def _raise_again(number: int, frame: Any) -> None:
    check()

"""Files that a user names, and quotations of what stands in them: neither may be larger than memory or a message bears."""

from __future__ import annotations

import os
import reprlib
import stat
import unicodedata
from pathlib import Path
from typing import Any

from .errors import ConfigError

__all__ = ["MOST_RESULT_BYTES", "MOST_STUDY_BYTES", "bytes_of", "code_point", "printable", "quoted", "text_of", "unprintable"]

MOST_STUDY_BYTES = 256 * 1024
"""Of a study or a sweep; the largest in use have 10 kB, and YAML is read at some 100 kB/s."""

MOST_RESULT_BYTES = 64 * 1024 * 1024
"""Of a result; 4096 starts make 2 MB."""

_QUOTED = 60

_short = reprlib.Repr()
_short.maxstring = _short.maxother = _QUOTED
_short.maxlong = 30


def quoted(value: Any) -> str:
    """What was found, for a message: printable and short.

    Parameters
    ----------
    value : object
        Text, number, list or mapping.

    Returns
    -------
    str

    Examples
    --------
    >>> quoted("5 kg")
    "'5 kg'"
    """
    if isinstance(value, str) and len(value) > _QUOTED:
        return f"{value[: _QUOTED // 2]!r}... ({len(value)} characters)"
    try:
        return _short.repr(value)
    except ValueError:  # Python writes no whole number of more than 4300 digits
        return "a whole number of thousands of digits"


def printable(name: object) -> str:
    """A name of a file or key as a terminal can show it: what is not printable stands as an escape.

    Parameters
    ----------
    name : object

    Returns
    -------
    str
    """
    text = str(name)
    shown = text if len(text) <= 4 * _QUOTED else f"{text[:_QUOTED]}... ({len(text)} characters)"
    return "".join(letter if letter.isprintable() else ascii(letter)[1:-1] for letter in shown)


def unprintable(text: str) -> str:
    """What in a text cannot be shown: control characters, line breaks, halves of a pair, marks that turn the direction of
    reading; in words, empty where there is nothing of the kind.
    """
    return next((f"the character {code_point(c)}" for c in text if _cannot_be_shown(c)), "")


def _cannot_be_shown(letter: str) -> bool:
    turns = unicodedata.bidirectional(letter) in ("LRE", "RLE", "LRO", "RLO", "PDF", "LRI", "RLI", "FSI", "PDI")
    return turns or unicodedata.category(letter) in ("Cc", "Cs", "Zl", "Zp")


def code_point(character: int | str) -> str:
    """A character by its number, such as U+001B."""
    return f"U+{character if isinstance(character, int) else ord(character):04X}"


def bytes_of(path: str | Path, kind: str, most_bytes: int) -> bytes:
    """Content of a file that a user names.

    Parameters
    ----------
    path : str or Path
    kind : str
        What is allowed, for the message.
    most_bytes : int
        Larger files are refused.

    Returns
    -------
    bytes

    Raises
    ------
    ConfigError
        If it cannot be read, is no regular file (a pipe blocks, a device never ends), or is too large.
    """
    where = printable(path)
    try:
        # not blocking: else opening a pipe waits for its writer
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
        try:
            found = _not_regular(os.fstat(handle).st_mode)
            if found:
                raise ConfigError(f"{where}: cannot be read: is {found}; allowed: {kind}")
            with open(handle, "rb", closefd=False) as file:
                data = file.read(most_bytes + 1)
        finally:
            os.close(handle)
    except OSError as error:
        raise ConfigError(f"{where}: cannot be read: {error.strerror}; allowed: {kind}") from error
    except ValueError as error:  # a zero byte in the path
        raise ConfigError(f"{where}: cannot be read: {error}; allowed: {kind}") from error
    if len(data) > most_bytes:
        raise ConfigError(f"{where}: is larger than {most_bytes // 1024} KiB; allowed: {kind}, no larger")
    return data


def text_of(path: str | Path, kind: str = "a readable YAML file", most_bytes: int = MOST_STUDY_BYTES) -> str:
    """Text of a file that a user names.

    Parameters
    ----------
    path : str or Path
    kind : str
        What is allowed, for the message.
    most_bytes : int
        Larger files are refused.

    Returns
    -------
    str

    Raises
    ------
    ConfigError
        As `bytes_of`, and if it is no UTF-8 text.
    """
    data = bytes_of(path, kind, most_bytes)
    try:
        return data.decode("utf-8").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        where = printable(path)
        raise ConfigError(f"{where}:{line}: is not UTF-8 text (byte {error.start}); allowed: {kind}") from error


def _not_regular(mode: int) -> str:
    """What a file is that is not regular, in words; empty for a regular one."""
    if stat.S_ISREG(mode):
        return ""
    kinds = ((stat.S_ISDIR, "a folder"), (stat.S_ISFIFO, "a pipe"), (stat.S_ISSOCK, "a socket"), (stat.S_ISCHR, "a device"))
    return next((words for test, words in kinds if test(mode)), "no regular file")

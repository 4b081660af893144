"""The text of an Adams-style property file (TeimOrbit, ``.tir``): sections, keys, values, units; nothing of what they mean.

::

    [UNITS]
    LENGTH = 'meter'          $ comment
    ! comment
    [SHAPE]
    {radial width}
     1.0    0.0
"""

from __future__ import annotations

import codecs
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ..errors import ConfigError
from ..reading import bytes_of, printable, quoted

__all__ = ["Entry", "PropertyText", "decoded", "property_text"]

KIND = "a readable property file (.tir)"
MOST_BYTES = 1024 * 1024
"""Of a property file; the longest in use have 60 kB."""
MOST_PROBLEMS = 20
"""That are listed; those behind them are often the same."""

_SECTION = re.compile(r"\[\s*([^\[\]]+?)\s*\]")
_KEY = re.compile(r"[A-Za-z_][A-Za-z0-9_.\-]*")
_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eEdD][-+]?[0-9]{1,4})?")

UNITS: Mapping[str, Mapping[str, float]] = {
    "LENGTH": {
        **dict.fromkeys(("meter", "metre", "meters", "metres", "m"), 1.0),
        **dict.fromkeys(("mm", "millimeter", "millimetre"), 1e-3),
        **dict.fromkeys(("cm", "centimeter", "centimetre"), 1e-2),
        **dict.fromkeys(("km", "kilometer", "kilometre"), 1e3),
        **dict.fromkeys(("inch", "inches", "in"), 0.0254),
        **dict.fromkeys(("foot", "feet", "ft"), 0.3048),
    },
    "FORCE": {
        **dict.fromkeys(("newton", "newtons", "n"), 1.0),
        **dict.fromkeys(("kilonewton", "knewton", "kn"), 1e3),
        **dict.fromkeys(("kilogram_force", "kg_force", "kgf"), 9.80665),
        **dict.fromkeys(("pound_force", "lbf"), 4.4482216152605),
    },
    "ANGLE": {
        **dict.fromkeys(("radian", "radians", "rad"), 1.0),
        **dict.fromkeys(("degree", "degrees", "deg"), math.pi / 180),
    },
    "PRESSURE": {
        **dict.fromkeys(("pascal", "pascals", "pa"), 1.0),
        **dict.fromkeys(("kilopascal", "kpascal", "kpa"), 1e3),
        **dict.fromkeys(("megapascal", "mpascal", "mpa"), 1e6),
        "bar": 1e5,
        "psi": 6894.757293168,
    },
}
"""Factors to SI of the units that a file may name; those of mass and time belong to no number that is read."""


@dataclass(frozen=True)
class Entry:
    """``KEY = value`` of a file.

    Attributes
    ----------
    section, key, value : str
        Section and key in capitals, value without quotes and comment.
    line : int
    """

    section: str
    key: str
    value: str
    line: int


@dataclass
class PropertyText:
    """The entries of a file, and the problems that are met while they are read.

    Attributes
    ----------
    name : str
        Of the file, for messages.
    entries : list of Entry
    sections : dict of str to int
        Line of each section.
    problems : list of (int, str)
        By line.
    """

    name: str
    entries: list[Entry] = field(default_factory=list)
    sections: dict[str, int] = field(default_factory=dict)
    problems: list[tuple[int, str]] = field(default_factory=list)

    def say(self, line: int, section: str, key: str, what: str) -> None:
        """Note a problem."""
        place = " ".join(filter(None, (f"[{printable(section)}]" if section else "", printable(key))))
        self.problems.append((line, f"{self.name}:{line}: {place + ': ' if place else ''}{what}"))

    def refuse_problems(self) -> None:
        """`ConfigError` with all of them, in the order of the lines."""
        if self.problems:
            found = [text for _, text in sorted(dict.fromkeys(self.problems))]
            rest = len(found) - MOST_PROBLEMS
            raise ConfigError(found if rest <= 0 else [*found[:MOST_PROBLEMS], f"... and {rest} problems more"])

    def find(self, key: str) -> Entry | None:
        """The entry of a key outside [UNITS]; a second one is a problem."""
        found = [entry for entry in self.entries if entry.key == key and entry.section != "UNITS"]
        for other in found[1:]:
            words = f"found a second time, first on line {found[0].line}; allowed: each key once"
            self.say(other.line, other.section, key, words)
        return found[0] if found else None

    def number(self, entry: Entry) -> float | None:
        """The number of an entry as it stands; None, and a problem, where it is none."""
        if _NUMBER.fullmatch(entry.value):
            value = float(re.sub("[dD]", "e", entry.value))
            if math.isfinite(value):
                return value
        hint = " (write the decimal sign as a point)" if re.fullmatch(r"[-+]?[0-9]+,[0-9]+", entry.value) else ""
        found = quoted(entry.value) if entry.value else "nothing"
        self.say(entry.line, entry.section, entry.key, f"found {found}; allowed: a number{hint}")
        return None

    def factors(self) -> dict[str, float]:
        """Factors to SI of LENGTH, FORCE, ANGLE and PRESSURE: 1 where [UNITS] has none."""
        found = {}
        given = {entry.key: entry for entry in self.entries if entry.section == "UNITS"}
        for entry in self.entries:
            if entry.section == "UNITS" and given[entry.key] is not entry:
                last = given[entry.key]
                self.say(last.line, "UNITS", last.key, f"found a second time, first on line {entry.line}; allowed: each once")
        for dimension, units in UNITS.items():
            unit = given.get(dimension)
            if unit is not None and unit.value.lower() not in units:
                self.say(unit.line, "UNITS", dimension, f"found {quoted(unit.value)}; allowed: {', '.join(units)}")
            found[dimension] = 1.0 if unit is None else units.get(unit.value.lower(), 1.0)
        if "PRESSURE" not in given:
            found["PRESSURE"] = found["FORCE"] / found["LENGTH"] ** 2
        return found


def decoded(path: str | Path) -> str:
    """Text of a property file, whatever program wrote it: UTF-8, UTF-16 with a mark, or the characters of old Windows.

    Parameters
    ----------
    path : str or Path

    Raises
    ------
    ConfigError
        If it cannot be read, or is no text.
    """
    data = bytes_of(path, KIND, MOST_BYTES)
    marks = ((codecs.BOM_UTF8, "utf-8-sig"), (codecs.BOM_UTF16_LE, "utf-16"), (codecs.BOM_UTF16_BE, "utf-16"))
    known = next((name for mark, name in marks if data.startswith(mark)), None)
    for encoding in [known] if known else ["utf-8", "cp1252", "latin-1"]:
        try:
            text = data.decode(encoding)
            break
        except UnicodeDecodeError:
            continue
    else:
        raise ConfigError(f"{printable(path)}: is no text in the encoding that its first bytes name; allowed: {KIND}")
    if "\0" in text:
        raise ConfigError(f"{printable(path)}: holds zero bytes; allowed: {KIND}")
    return text


def property_text(text: str, name: str) -> PropertyText:
    """Sections, keys and values of a text.

    Parameters
    ----------
    text : str
    name : str
        Of the file, for messages.
    """
    found = PropertyText(printable(name))
    section, table = "", False
    for line, content in _contents(text):
        if content.startswith("["):
            match = _SECTION.fullmatch(content)
            if match is None:
                found.say(line, "", "", f"found {quoted(content)}; allowed: a section as [NAME]")
            section, table = (match[1] if match else content.strip("[]")).upper(), False
            found.sections.setdefault(section, line)
        elif content[0] in "{(":
            table = True
        elif not table:
            _entry(found, section, content, line)
    return found


def _contents(text: str) -> Iterator[tuple[int, str]]:
    """Lines that hold something, without comments."""
    for number, line in enumerate(re.split("\r\n|\r|\n", text), 1):
        content = _without_comment(line.replace("\xa0", " ").replace("\x1a", "")).strip()
        if content:
            yield number, content


def _without_comment(line: str) -> str:
    quote = ""
    for position, letter in enumerate(line):
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "'\"":
            quote = letter
        elif letter in "$!":
            return line[:position]
    return line


def _entry(found: PropertyText, section: str, content: str, line: int) -> None:
    key, equals, value = (part.strip() for part in content.partition("="))
    if not equals and all(_NUMBER.fullmatch(part) for part in content.split()):
        return  # the row of a table without a head
    if not (equals and _KEY.fullmatch(key)):
        allowed = "[SECTION], KEY = value, a {table}, or a comment behind $ or !"
        found.say(line, section, "", f"found {quoted(content)}; allowed: {allowed}")
        return
    if value[:1] in ("'", '"'):
        if len(value) < 2 or value[-1] != value[0]:
            found.say(line, section, key, f"found {quoted(value)}; allowed: text between two quotes")
            return
        value = value[1:-1].strip()
    found.entries.append(Entry(section, key.upper(), value, line))

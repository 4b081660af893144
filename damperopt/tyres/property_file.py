"""What a property file (``.tir``) means: the block `tyre` of a study, and what of the file is used, missing, left aside.

Read are the Magic Formula (PAC2002, MF 5.x; of MF 6.x what lateral slip without camber needs) and the brush laws Fiala and UA,
which Adams Aircraft calls Basic and Enhanced.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ..errors import ConfigError
from ..reading import printable, quoted
from .coefficients import OFFSETS, Coefficients
from .property_text import Entry, PropertyText, decoded, property_text

__all__ = ["PropertyFile", "block_of_file", "property_file"]

MAGIC_5 = ("PAC2002", "PAC02", "MF05", "MF5", "MF50", "MF51", "MF52", "5", "50", "51", "52")
MAGIC_6 = ("MF6", "MF60", "MF61", "MF62", "6", "60", "61", "62")
BRUSH = ("FIALA", "UA", "AIRCRAFTBASIC", "AIRCRAFTENHANCED")
FORMATS = "PAC2002, MF_05, MF_52 (FITTYP 5, 51, 52), MF_61, MF_62 (FITTYP 6, 61, 62), FIALA, UA"

OF_MF_6 = ("PKY4", "LATERAL_STIFFNESS", "PCFY1", "PCFY2", "PCFY3")
"""Coefficients that older formulas do not have."""
ALSO = {"INFLPRES": "IP", "NOMPRES": "IP_NOM", "PPZ1": "QPZ1", "LFZO": "LFZ0"}
"""Other spellings."""
DIMENSIONS: Mapping[str, Mapping[str, int]] = {
    **{key: {"FORCE": 1} for key in ("FNOMIN", "FZMIN", "FZMAX")},
    **{key: {"LENGTH": 1} for key in ("UNLOADED_RADIUS", "REL_LEN_LAT", "WIDTH")},
    **{key: {"PRESSURE": 1} for key in ("INFLPRES", "NOMPRES")},
    **{key: {"ANGLE": 1} for key in ("ALPMIN", "ALPMAX")},
    "LATERAL_STIFFNESS": {"FORCE": 1, "LENGTH": -1},
    "CALPHA": {"FORCE": 1, "ANGLE": -1},
}
"""Powers of the units in a number; shape coefficients have none: the formula is written in radians."""

_OTHER_KEYS = {
    "LATERAL_COEFFICIENTS": r"P[CDEHKV]Y\d|R[BCEHV]Y\d|PTY\d|PPY\d|PDYP\d|PKYP\d|PHYP\d",
    "ALIGNING_COEFFICIENTS": r"Q[BCDEH]Z\d+|SSZ\d|QTZ1|MBELT|PPZ\d|QPZ\d|Q[CD]RP\d|QBRP\d|QDTP\d",
    "SCALING_COEFFICIENTS": r"L(FZ[O0]|[CEKHV]X|KXK|MU[XYV]|GA[XYZ]|[CEKHV]Y|KYC|KZC|KYA|KYG|KG|TR|RES|XAL|YKA|VYKA|S|MX|MY"
    r"|VMX|MP|SGKP|SGAL|GYR|CZ|IP|MR|KZG|XA|YK)",
}
"""Keys of the formula that lateral slip without camber does not need; others in these sections are unknown."""

PART_OF_6 = (
    "of MF 6.x used: side force and aligning moment at zero camber, with PKY4 and pressure; not used: camber, turn slip, "
    "combined slip, belt"
)

PLAIN_SECTIONS = re.compile(
    r"MDI_HEADER|UNITS|MODEL|DIMENSION|SHAPE|VERTICAL|OPERATING_CONDITIONS|TIRE_CONDITIONS|INERTIA|STRUCTURAL|CONTACT_PATCH"
    r"|[A-Z_]+_RANGE|(?:LONGITUDINAL|OVERTURNING|ROLLING|TURNSLIP|LATERAL|ALIGNING|SCALING)_COEFFICIENTS|PARAMETERS?|[A-Z_]+_CURVE"
)


@dataclass(frozen=True)
class PropertyFile:
    """What was read.

    Attributes
    ----------
    name, kind : str
        Of the file, and the formula in words.
    block : dict
        Keys of the block `tyre` [SI].
    used, absent, aside, unknown : tuple of str
        Keys that the law uses; that it would use and takes as 0; that are not needed; that no formula here knows.
    notes : tuple of str
        What else a user must know.
    newer : bool
        Whether the formula is one of which a part alone is used.
    """

    name: str
    kind: str
    block: dict[str, Any]
    used: tuple[str, ...]
    absent: tuple[str, ...]
    aside: tuple[str, ...]
    unknown: tuple[str, ...]
    notes: tuple[str, ...]
    newer: bool = False


def block_of_file(block: Mapping[str, Any], folder: Path, where: str) -> tuple[dict[str, Any], PropertyFile]:
    """A block `tyre` with `file`, as one with the numbers of that file; keys beside `file` come first.

    Parameters
    ----------
    block : mapping
    folder : Path
        To which `file` is relative.
    where : str
        Place of the key, for messages.

    Raises
    ------
    ConfigError
        If the file cannot be read, or not be used.
    """
    named = block["file"]
    if not isinstance(named, str) or not named.strip():
        raise ConfigError(f"{where}: found {quoted(named)}; allowed: the name of a property file (.tir)")
    if "coefficients" in block:
        raise ConfigError(f"{where}: found coefficients beside it; allowed: a file or coefficients, not both")
    try:
        text = decoded(folder / named)
    except ConfigError as error:
        raise ConfigError([f"{where}: {problem}" for problem in error.problems]) from None
    found = property_file(text, str(folder / named), block)
    laws = {"magic_formula": ("magic_formula", "pac2002"), "brush": ("brush", "fiala", "ua")}[found.block["law"]]
    if block.get("law", laws[0]) not in laws:
        raise ConfigError(
            f"{where}: holds a tyre of law {laws[0]}; found law {quoted(block['law'])}; allowed: that law, or none"
        )
    given = {key: value for key, value in block.items() if key not in ("file", "law")}
    return {**found.block, **given}, found


def property_file(text: str, name: str, given: Iterable[str] = ()) -> PropertyFile:
    """What a property file says of a tyre.

    Parameters
    ----------
    text : str
        Of the file.
    name : str
        For messages.
    given : iterable of str
        Keys that the study has beside it: `relaxation_length` stands for coefficients that are missing.

    Raises
    ------
    ConfigError
        With all problems: ``file:line: [SECTION] KEY: found ...; allowed: ...``.
    """
    found = property_text(text, name)
    factors, kind = found.factors(), _kind(found)
    found.refuse_problems()
    read = _brush if kind in BRUSH else _magic
    result = read(found, kind, factors, set(given))
    found.refuse_problems()
    return result


def _kind(text: PropertyText) -> str:
    """The formula, by FITTYP or PROPERTY_FILE_FORMAT; the first that is known."""
    entries = [entry for entry in map(text.find, ("FITTYP", "PROPERTY_FILE_FORMAT")) if entry is not None]
    kinds = [re.sub(r"[\s_.\-]", "", re.sub(r"\.0*$", "", entry.value)).upper() for entry in entries]
    known = next((kind for kind in kinds if kind in (*MAGIC_5, *MAGIC_6, *BRUSH)), None)
    if known is None:
        line = entries[-1].line if entries else text.sections.get("MODEL", 1)
        found = f"found {quoted(entries[-1].value)}" if entries else "missing key"
        text.say(line, "MODEL", "PROPERTY_FILE_FORMAT", f"{found}; allowed: {FORMATS}")
    return known or ""


def _value(text: PropertyText, key: str, factors: Mapping[str, float]) -> tuple[Entry | None, float | None]:
    """Entry and value [SI] of a key, under any of its spellings."""
    entry = text.find(key) or (text.find(ALSO[key]) if key in ALSO else None)
    value = None if entry is None else text.number(entry)
    if value is None:
        return entry, None
    for dimension, power in DIMENSIONS.get(key, {}).items():
        value *= factors[dimension] ** power
    return entry, value if abs(value) > 1e-15 else 0.0


def _missing(text: PropertyText, key: str, allowed: str) -> None:
    sections = {"FNOMIN": "VERTICAL", "UNLOADED_RADIUS": "DIMENSION"}
    section = sections.get(key) or {"P": "LATERAL_COEFFICIENTS", "Q": "ALIGNING_COEFFICIENTS"}.get(key[0], "PARAMETER")
    text.say(text.sections.get(section, 1), section, key, f"missing key; allowed: {allowed}")


def _magic(text: PropertyText, kind: str, factors: Mapping[str, float], given: set[str]) -> PropertyFile:
    newer = kind in MAGIC_6
    names = [name for name in Coefficients.model_fields if newer or name not in OF_MF_6]
    entries, values = {}, {}
    for name in names:
        entry, value = _value(text, name, factors)
        if entry is not None:
            entries[name] = entry
        if value is not None:
            values[name] = value
    required = [name for name in names if Coefficients.model_fields[name].is_required()]
    if not ("relaxation_length" in given or (newer and "LATERAL_STIFFNESS" in entries)):
        required += ["PTY1", "PTY2"]
    for name in required:
        if name not in entries:
            instead = ", or tyre.relaxation_length in the study" if name.startswith("PTY") else ""
            _missing(text, name, f"a number{instead}")
    if "QDZ1" not in entries:
        _missing(text, "QDZ1", "a number > 0: without a trail there is no aligning moment")
    for name, kept in {"PKY1": "not 0", "PDY1": "not 0", "QDZ1": "> 0"}.items():
        value = values.get(name, 1.0)
        if value == 0 or (kept == "> 0" and value < 0):
            text.say(entries[name].line, entries[name].section, name, f"found {value:g}; allowed: a number, {kept}")
    _check(text, values, entries)
    block: dict[str, Any] = {"law": "magic_formula", "coefficients": values, "source": Path(text.name).name}
    ranges = _ranges(text, factors, block)
    side = text.find("TYRESIDE")
    offsets = [name for name in OFFSETS if values.get(name)]
    older = [name for name in names if newer or not name.startswith("PP")]
    asked = [name for name in older if name[0] in "PQ" and name not in (*OFFSETS, *required, "QBZ9", "QBZ10")]
    notes = {
        f"offsets removed: {', '.join(offsets)}": offsets,
        f"measured on the side {side.value if side else ''}, which decides the signs of offsets alone": side,
        "no [UNITS]: taken as SI": "UNITS" not in text.sections,
        "ANGLE is that of ALPMIN and ALPMAX; shape coefficients are per radian, as the formula is": factors["ANGLE"] != 1,
        PART_OF_6: newer,
        "relaxation length: cornering over lateral stiffness": newer and "PTY1" not in entries,
    }
    aside, unknown = _rest(text, {entry.key for entry in entries.values()} | ranges)
    kind_words = f"Magic Formula, {kind if kind[0] in 'PM' else 'FITTYP ' + kind}"
    absent = tuple(name for name in asked if name not in entries)
    lists = tuple(entries), absent, aside, unknown, tuple(words for words, said in notes.items() if said)
    return PropertyFile(text.name, kind_words, block, *lists, newer=newer)


def _check(text: PropertyText, values: Mapping[str, float], entries: Mapping[str, Entry]) -> None:
    """What the record refuses, at its line in the file."""
    try:
        Coefficients.model_validate(values)
    except ValidationError as error:
        for problem in error.errors(include_url=False):
            name = str(problem["loc"][0])
            if name in values:  # those that are missing, or no number, have been named
                text.say(entries[name].line, entries[name].section, name, f"found {problem['msg']}")


def _ranges(text: PropertyText, factors: Mapping[str, float], block: dict[str, Any]) -> set[str]:
    """Ranges of load and slip into the block; returns the keys that are used."""
    used = set()
    for low, high in (("FZMIN", "FZMAX"), ("ALPMIN", "ALPMAX")):
        (entry, least), (last, most) = (_value(text, key, factors) for key in (low, high))
        if entry is None or last is None or least is None or most is None:
            continue
        if not (least < most and most > 0):
            text.say(last.line, last.section, high, f"found {most:g} after {low} {least:g} [SI]; allowed: above it, and > 0")
            continue
        used |= {low, high}
        if low == "FZMIN":
            block["data_loads"] = {"min": max(least, 0.0), "max": most}
        else:
            trusted = most if least >= 0 else min(-least, most)
            block["slip_range"] = min(trusted, 0.7853981633974483)  # not beyond the default, 45 deg
    return used


def _brush(text: PropertyText, kind: str, factors: Mapping[str, float], given: set[str]) -> PropertyFile:
    keys = {"CALPHA": "cornering_stiffness", "UMAX": "friction", "UMIN": "sliding_friction", "REL_LEN_LAT": "relaxation_length"}
    optional = {"UMIN"} | ({"REL_LEN_LAT"} if "relaxation_length" in given else set())
    block: dict[str, Any] = {"law": "brush"}
    for name, key in keys.items():
        entry, value = _value(text, name, factors)
        if entry is None and name not in optional:
            _missing(text, name, "a number" + (", or tyre.relaxation_length in the study" if name == "REL_LEN_LAT" else ""))
        if entry is not None and value is not None:
            most = 2.0 if name in ("UMIN", "UMAX") else math.inf
            if not 0 < value <= most:
                words = f"a number > 0{' and <= 2' if most == 2 else ''}"
                text.say(entry.line, entry.section, name, f"found {value:g}; allowed: {words}")
            block[key] = value
    if block.get("sliding_friction", 0) > block.get("friction", 2):
        del block["sliding_friction"]
        entry = text.find("UMIN")
        assert entry is not None
        text.say(entry.line, entry.section, "UMIN", f"found {entry.value}; allowed: at most UMAX")
    _, width = _value(text, "WIDTH", factors)
    notes = (
        [f"WIDTH, {width:g} m, stands in the place of half_contact_length in some programs; here it is not used"]
        if width
        else []
    )
    aside, unknown = _rest(text, set(keys))
    used = tuple(name for name in keys if text.find(name) is not None)
    return PropertyFile(text.name, f"brush, {kind}", block, used, (), aside, unknown, tuple(notes))


def _rest(text: PropertyText, used: set[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Keys that are not used: those that some formula knows, and the others."""
    aside: list[str] = []
    unknown: list[str] = []
    for entry in text.entries:
        if entry.section == "UNITS" or entry.key in used | {"FITTYP", "PROPERTY_FILE_FORMAT", "TYRESIDE"}:
            continue
        of_formula = _OTHER_KEYS.get(entry.section)
        known = re.fullmatch(of_formula, entry.key) if of_formula else PLAIN_SECTIONS.fullmatch(entry.section)
        (aside if known else unknown).append(printable(entry.key))
    return tuple(dict.fromkeys(aside)), tuple(dict.fromkeys(unknown))

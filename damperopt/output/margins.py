"""Tables of loads, margins of safety and sizes: which case sizes what, the critical margin of each part, the parts list."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ..quantities.shown import shown
from ..results import DesignResult, LoadRow, MarginRow
from ..study.components import unit_of_name
from ..study.study import Study
from .facts import Size, damper_speed
from .words import Line

__all__ = [
    "critical_margins",
    "critical_rows",
    "load_cases",
    "margin_words",
    "margins_by_case",
    "parts_list",
    "peak_rows",
    "shown_margin",
    "sized_by",
    "unchecked",
]

PEAKS = {
    "linkage_torque": "torque about the strut axis",
    "yaw_angle": "yaw angle",
    "damper_stroke": "damper stroke to one side",
    "damper_force": "damper force",
    "spring_force": "force at the tip of spring or arm",
}
"""What the peaks of the limit event are called."""

NONE_LEFT = 5e-4
"""Margin of safety that is shown as 0: what it is of has no room left."""


def critical_rows(margins: Iterable[MarginRow]) -> list[MarginRow]:
    """The least margin of each part, the least of all first.

    Parameters
    ----------
    margins : iterable of MarginRow
    """
    least: dict[str, MarginRow] = {}
    for row in sorted(margins, key=lambda row: row.value):
        least.setdefault(row.part, row)
    return list(least.values())


def sized_by(case: LoadRow, margins: Iterable[MarginRow]) -> list[str]:
    """Parts that have no margin left in a load case.

    Parameters
    ----------
    case : LoadRow
    margins : iterable of MarginRow
    """
    return list(dict.fromkeys(row.part for row in margins if row.case == case.case and row.value < NONE_LEFT))


def unchecked(result: DesignResult) -> list[str]:
    """Parts of the mass table that no margin is of: a spring is sized by the energy that it stores at its allowable stress."""
    parts = {} if result.mass is None else result.mass.parts
    return [part for part in parts if not any(row.part.startswith(part) for row in result.margins)]


def shown_margin(value: float) -> str:
    """A margin of safety with its sign.

    Examples
    --------
    >>> shown_margin(1e-9), shown_margin(0.128), shown_margin(-0.02), shown_margin(12.3)
    ('0', '+0.13', '-0.02', '+12')
    """
    if abs(value) < NONE_LEFT:
        return "0"
    return ">100" if value > 100 else f"{value:+.{4 if abs(value) < 0.01 else 2 if abs(value) < 10 else 0}f}"


def margin_words(row: MarginRow) -> str:
    """A margin with its check, level and case."""
    return f"{shown_margin(row.value)} ({row.check}, {row.level}, {row.case})"


def load_cases(result: DesignResult) -> list[Line]:
    """Each load case: name, rule, where it was read, forces, torque, apex force, kind, and what it sizes.

    Parameters
    ----------
    result : DesignResult

    Returns
    -------
    list of Line
        The heaviest first; a case that does not count has no numbers, and the reason in the last cell.
    """
    found = []
    for row in sorted(result.loads, key=lambda row: (bool(row.off), -row.yaw_torque)):
        name, rule = row.case.replace("_", " "), (row.rule, "" if row.read == "no rule" else row.read)
        if row.off:
            found.append(Line((name, *rule, *[""] * 6, f"off: {row.off}")))
            continue
        forces = [shown(value, "N")[0] for value in (row.vertical, row.side, row.drag)]
        torques = shown(row.yaw_torque, "N m")[0], shown(row.apex_force, "N")[0]
        sizes = ", ".join(sized_by(row, result.margins)) or ("the parts" if row.sizing and not result.margins else "")
        found.append(Line((name, *rule, *forces, *torques, f"{row.level}, {row.nature}", sizes), row.sizing))
    return found


def critical_margins(result: DesignResult) -> list[Line]:
    """Least margin of each part: part, check, case, level, applied, allowable, unit, factor, margin."""
    found = []
    for row in critical_rows(result.margins):
        (applied, unit), (allowable, _) = shown(row.applied, row.unit), shown(row.allowable, row.unit)
        margin = shown_margin(row.value)
        cells = (
            row.part,
            row.check,
            row.case.replace("_", " "),
            row.level,
            applied,
            allowable,
            unit,
            f"{row.factor:g}",
            margin,
        )
        found.append(Line(cells, row.value < NONE_LEFT))
    return found


def margins_by_case(result: DesignResult) -> tuple[list[str], list[Line]]:
    """Every margin: a row for each part, check and level, a column for each case.

    Parameters
    ----------
    result : DesignResult

    Returns
    -------
    tuple of list of str and list of Line
        Cases in the order of the load table, then the others; rows by part, the one with the least margin first.
    """
    order = [row.case for row in sorted(result.loads, key=lambda row: -row.yaw_torque)]
    cases = sorted({row.case for row in result.margins}, key=lambda case: order.index(case) if case in order else len(order))
    found: dict[tuple[str, str, str], dict[str, float]] = {}
    for row in result.margins:
        found.setdefault((row.part, row.check, row.level), {})[row.case] = row.value
    parts = [row.part for row in critical_rows(result.margins)]
    lines = []
    for key, values in sorted(found.items(), key=lambda item: (parts.index(item[0][0]), min(item[1].values()))):
        cells = [shown_margin(values[case]) if case in values else "" for case in cases]
        lines.append(Line((*key, *cells), min(values.values()) < NONE_LEFT))
    return [case.replace("_", " ") for case in cases], lines


def peak_rows(study: Study, result: DesignResult) -> list[Line]:
    """What the parts must bear in the limit event: quantity, value, unit."""
    lines = []
    for name, value in result.limit_event.items():
        lines.append(Line((PEAKS.get(name, name.replace("_", " ")), *shown(value, unit_of_name(name)))))
    speed = damper_speed(study, result)
    if speed is not None:
        lines.append(Line(("damper speed", *shown(speed, "m/s"))))
    return lines


def parts_list(result: DesignResult, sizes: Sequence[Size]) -> list[Line]:
    """Parts with their masses, each followed by its sizes: part, dimension, value, unit, margin of safety.

    Parameters
    ----------
    result : DesignResult
        With masses.
    sizes : sequence of Size

    Returns
    -------
    list of Line
        The lines of the parts themselves are strong. The margins of a design with elastic parts stand in a table of their own.
    """
    lines = []
    for part, mass in (result.mass.parts if result.mass else {}).items():
        lines.append(Line((part, "mass, fittings included", f"{mass:.3f}", "kg", ""), strong=True))
        seen = set()
        for size in (size for size in sizes if size.group == part):
            words = size.words.partition(", against")[0] if result.margins else size.words
            if (size.part, words) not in seen:
                margin = "" if size.margin is None or result.margins else shown_margin(size.margin)
                lines.append(Line((size.part, words, *shown(size.value, size.unit), margin)))
            seen.add((size.part, words))
    return lines

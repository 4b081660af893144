"""Numbers as engineers write them: the one place that says in which unit a quantity is shown, and with how many digits."""

from __future__ import annotations

from collections.abc import Sequence

__all__ = ["as_written", "axis_label", "rounded", "scale", "shown", "unit_text", "written"]

_SCALES: dict[str, tuple[str, float]] = {
    "m": ("mm", 1e3),
    "m^2": ("mm^2", 1e6),
    "m^3": ("cm^3", 1e6),
    "m^4": ("mm^4", 1e12),
    "rad": ("deg", 57.29577951308232),
    "rad/s": ("deg/s", 57.29577951308232),
    "N": ("kN", 1e-3),
    "Pa": ("MPa", 1e-6),
    "N/m": ("kN/m", 1e-3),
    "N m": ("kN m", 1e-3),
    "N m/rad": ("kN m/rad", 1e-3),
    "N/rad": ("kN/rad", 1e-3),
    "N/m^2": ("MN/m^2", 1e-6),
}
"""Unit and factor for quantities whose SI unit is too large or too small for a landing gear; all others stay in SI."""

_WRITTEN: dict[str, tuple[tuple[str, float], ...]] = {
    "m/s": (("m/s", 1.0), ("kt", 1852 / 3600), ("km/h", 1 / 3.6), ("mph", 0.44704), ("ft/s", 0.3048)),
    "N": (("kN", 1e3), ("lbf", 4.4482216152605)),
    "m": (("mm", 1e-3), ("in", 0.0254)),
}
"""Units in which questions are asked, the one that is preferred first, in SI."""

_SHORT = 5
"""Digits up to which a number was written by somebody; 0.514444 m/s was not."""

_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def scale(unit: str) -> tuple[str, float]:
    """Unit in which a quantity is shown, and the factor to it.

    Parameters
    ----------
    unit : str
        SI unit.

    Returns
    -------
    tuple of str and float

    Examples
    --------
    >>> scale("m^4")
    ('mm^4', 1000000000000.0)
    """
    return _SCALES.get(unit, (unit, 1.0))


def unit_text(unit: str) -> str:
    """A unit with raised exponents; nothing for a plain number.

    Examples
    --------
    >>> unit_text("rad/s^2")
    'rad/s²'
    """
    if unit == "1":
        return ""
    head, *powers = unit.split("^")
    for power in powers:
        digits = len(power) - len(power.lstrip("-0123456789"))
        head += power[:digits].translate(_RAISED) + power[digits:]
    return head


def rounded(value: float) -> str:
    """Five digits, thousands apart; powers of ten only beyond a thousand million and below a ten-thousandth.

    Examples
    --------
    >>> rounded(23456.78), rounded(1234567.0), rounded(0.0123456), rounded(3.2e-7), rounded(-0.0)
    ('23 457', '1 234 600', '0.012346', '3.2e-07', '0')
    """
    if value == 0:
        return "0"
    if not 1e-4 <= abs(value) < 1e9:
        return f"{value:.4g}"
    value = float(f"{value:.5g}")
    return (f"{value:,.0f}" if abs(value) >= 1e4 else f"{value:,.5g}").replace(",", " ")


def shown(value: float, unit: str) -> tuple[str, str]:
    """Number and unit of a result, as the console, the report and the figures show it.

    Parameters
    ----------
    value : float
        [SI]
    unit : str
        SI unit.

    Returns
    -------
    tuple of str
        Number and unit; the unit of a plain number is empty.

    Examples
    --------
    >>> shown(4.6e-6, "m^4"), shown(0.5410521, "rad")
    (('4 600 000', 'mm⁴'), ('31', 'deg'))
    """
    name, factor = scale(unit)
    return rounded(value * factor), unit_text(name)


def axis_label(words: str, unit: str) -> str:
    """Label of an axis that shows a quantity in the unit of `scale`.

    Examples
    --------
    >>> axis_label("Yaw angle", "rad")
    'Yaw angle [deg]'
    """
    return f"{words} [{unit_text(scale(unit)[0]) or '1'}]"


def as_written(values: Sequence[float], unit: str) -> tuple[list[str], str]:
    """Numbers of a question in the unit in which they were asked: that in which all of them are short.

    Parameters
    ----------
    values : sequence of float
        [SI]
    unit : str
        SI unit.

    Returns
    -------
    tuple of list of str and str
        The numbers, and their unit.

    Examples
    --------
    >>> as_written([1852 / 3600, 120 * 1852 / 3600], "m/s")
    (['1', '120'], 'kt')
    >>> as_written([5.0, 100.0], "m/s"), as_written([150e3], "N")
    ((['5', '100'], 'm/s'), (['150'], 'kN'))
    """
    candidates = _WRITTEN.get(unit, ())
    for name, size in candidates:
        if all(_is_short(value / size) for value in values):
            return [f"{value / size:.{_SHORT}g}" for value in values], name
    name, size = candidates[0] if candidates else (scale(unit)[0], 1 / scale(unit)[1])
    return [f"{value / size:.{_SHORT}g}" for value in values], unit_text(name)


def _is_short(value: float) -> bool:
    return abs(float(f"{value:.{_SHORT}g}") - value) <= 1e-12 * abs(value)


def written(speed: float | None = None, load: float | None = None) -> str:
    """A speed [m/s], a vertical load [N] or both, in the units in which they were asked.

    Examples
    --------
    >>> written(61.733333333333334, 22e3)
    '120 kt, 22 kN'
    """
    found = [as_written([value], unit) for value, unit in ((speed, "m/s"), (load, "N")) if value is not None]
    return ", ".join(f"{numbers[0]} {unit}" for numbers, unit in found)

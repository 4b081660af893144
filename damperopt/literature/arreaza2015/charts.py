"""Stability charts of the thesis, Figs 3.4 to 3.29, each traced from the values of its caption.

The figures themselves are not at hand: ranges of the axes are a choice, and so are values that a caption does not give (three
speeds, lengths, angles, side distances and moduli). Each figure is traced in five forms, from what is printed to what is right:

`coefficients`
    the printed characteristic coefficients, misprints and all;
`matrix`
    the printed matrix (3-5): coefficients derived from it, the tread-width moment still with the printed sign;
`published`
    signs put right, stiffness and damping of the layout as printed;
`planar`
    stiffness and damping by virtual work;
`memory`
    the same on a tyre whose contact line remembers: what contact memory changes in a statement, beside `planar`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.resources import files

import numpy as np

from ...charts.chart import StabilityChart, chart
from ...charts.plane import Axis, Plane
from ...study.config import loads
from ...study.study import Study
from .printed import PrintedPlane, PrintedTreadMoment

__all__ = [
    "FIGURES",
    "FORMS",
    "LOAD",
    "STEEL",
    "ThesisFigure",
    "misprints",
    "needed_damping",
    "rigid",
    "thesis_gear",
    "trace_figure",
]

FORMS: dict[str, tuple[str, type[Plane], str]] = {
    "coefficients": ("published", PrintedPlane, "leading_point"),
    "matrix": ("published", PrintedTreadMoment, "leading_point"),
    "published": ("published", Plane, "leading_point"),
    "planar": ("planar", Plane, "leading_point"),
    "memory": ("planar", Plane, "memory"),
}
"""Geometry of the damper, what gives the matrices, and the contact line of the tyre."""

MISPRINTS_OF = {
    "boeing": ("(3-17)", "(3-18)", "(3-19)"),
    "utas": ("(3-34)", "(3-35)", "(3-37)"),
    "arreaza": ("(3-49)", "(3-50)", "(3-51)", "stiffness"),
}

LOAD = 150e3
STEEL = {"youngs_modulus": 200e9, "density": 7850.0, "yield_strength": 1e9}
"""E of the thesis; the other two numbers have no part in a chart or a motion."""

PRINTED_TOO_LITTLE = 5.0
"""The printed damping of UTAS is 5.4 times less than that by virtual work (erratum 8)."""


@dataclass(frozen=True)
class ThesisFigure:
    """A stability figure by the values of its caption [SI]."""

    number: str
    topology: str
    x: tuple[str, float, float]
    y: tuple[str, float, float]
    vary: tuple[str, tuple[float, ...]] | None = None
    speed: float = 40.0
    design: Mapping[str, float] = field(default_factory=dict)


_SPEEDS = ("speed", (40.0, 80.0, 160.0))
_LENGTHS = ("L", (0.3, 0.6, 1.0))
_ANGLES = ("gamma", tuple(np.deg2rad([20.0, 31.0, 45.0]).tolist()))
_SIDES = ("b", (0.1, 0.2, 0.3))
_MODULI = ("material.youngs_modulus", (70e9, 140e9, 200e9))
_CASTER = ("speed", 1.0, 200.0), ("caster_length", -0.2, 0.5)
_BOEING = ("c_lambda", 0.0, 3e4), ("k_lambda", 0.0, 1e7)
_UTAS = ("c_lambda", 0.0, 6e5), ("I_arm", 0.0, 1e-5)
_NEW = ("c_lambda", 0.0, 4e4), ("I_arm", 0.0, 1e-5)

FIGURES = (
    ThesisFigure("3.4", "boeing", *_CASTER, design={"c_lambda": 1000.0, "k_lambda": 3.8e6}),
    ThesisFigure("3.5", "boeing", *_BOEING, _SPEEDS),
    ThesisFigure("3.6", "boeing", *_BOEING, _LENGTHS),
    ThesisFigure("3.7", "boeing", *_BOEING, _ANGLES),
    ThesisFigure("3.10", "utas", *_CASTER, design={"c_lambda": 1000.0, "I_arm": 5e-6}),
    ThesisFigure("3.11", "utas", *_CASTER, design={"c_lambda": 1000.0, "I_arm": 5e-5}),
    ThesisFigure("3.12", "utas", *_UTAS, _SPEEDS),
    ThesisFigure("3.13", "utas", *_UTAS, _LENGTHS),
    ThesisFigure("3.14", "utas", *_UTAS, _LENGTHS, speed=100.0),
    ThesisFigure("3.15", "utas", *_UTAS, _SIDES),
    ThesisFigure("3.16", "utas", *_UTAS, _SIDES, speed=100.0),
    ThesisFigure("3.17", "utas", *_UTAS, _MODULI),
    ThesisFigure("3.18", "utas", *_UTAS, _MODULI, speed=100.0),
    ThesisFigure("3.21", "arreaza", *_CASTER, design={"c_lambda": 1000.0, "I_arm": 1e-6}),
    ThesisFigure("3.22", "arreaza", *_CASTER, design={"c_lambda": 1000.0, "I_arm": 1e-5}),
    ThesisFigure("3.23", "arreaza", *_NEW, _SPEEDS),
    ThesisFigure("3.24", "arreaza", *_NEW, _LENGTHS),
    ThesisFigure("3.25", "arreaza", *_NEW, _LENGTHS, speed=100.0),
    ThesisFigure("3.26", "arreaza", *_NEW, _MODULI),
    ThesisFigure("3.27", "arreaza", *_NEW, _MODULI, speed=100.0),
    ThesisFigure("3.28", "arreaza", *_NEW, _ANGLES),
    ThesisFigure("3.29", "arreaza", *_NEW, _ANGLES, speed=100.0),
)


def thesis_gear() -> Study:
    """The main gear of Table 0.1, with its tread-width moment."""
    text = files(__package__).joinpath("gear.yaml").read_text(encoding="utf-8")
    return loads(text, "gear.yaml")


def rigid(topology: str, geometry: str) -> dict[str, str]:
    """Block `damper` of a layout without compliance, as the thesis has it.

    Parameters
    ----------
    topology, geometry : str
    """
    return {"topology": topology, "geometry": geometry, "compliance": "rigid"}


def trace_figure(figure: ThesisFigure, study: Study, form: str) -> StabilityChart:
    """Chart of a figure.

    Parameters
    ----------
    figure : ThesisFigure
    study : Study
        The thesis' main gear.
    form : str
        One of `FORMS`.

    Returns
    -------
    StabilityChart
    """
    geometry, plane_type, contact = FORMS[form]
    gear = _gear(figure, study, geometry).replace(tyre__contact=contact)
    name, low, high = figure.x
    if figure.topology == "utas" and name == "c_lambda" and geometry != "published":
        high /= PRINTED_TOO_LITTLE  # so that the curves fill the figure
    return chart(gear, (name, low, high), figure.y, vary=figure.vary, speed=figure.speed, load=LOAD, plane_type=plane_type)


def _gear(figure: ThesisFigure, study: Study, geometry: str) -> Study:
    gear = study.replace(damper=rigid(figure.topology, geometry), material=STEEL)
    caption = {"L": 0.6, "gamma": float(np.deg2rad(31.0)), "b": 0.2, "c_lambda": 1e3, "I_arm": 5e-6, "k_lambda": 3.8e6}
    design = {name: value for name, value in {**caption, **figure.design}.items() if name in gear.start}
    return gear.replace(**{f"design__{name}__start": value for name, value in design.items()})


def misprints(figure: ThesisFigure, study: Study, points: int = 200) -> dict[str, float]:
    """What one misprint of the coefficients alone does: the part of a figure's plane that changes sides, all else put right.

    Parameters
    ----------
    figure : ThesisFigure
        Where it varies something, the first value counts.
    study : Study
        The thesis' main gear.
    points : int
        Along each axis.

    Returns
    -------
    dict
        By misprint, last all of them together.
    """
    gear = _gear(figure, study, "published")
    if figure.topology != "arreaza":
        gear = gear.replace(gear__lateral__damping=0.0)  # as (3-15) to (3-20) and (3-32) to (3-37) take it
    u, v = (grid.ravel() for grid in np.meshgrid(*2 * [(np.arange(points) + 0.5) / points]))
    fixed = {figure.vary[0]: figure.vary[1][0]} if figure.vary else {}
    axes = Axis.of(gear, *figure.x), Axis.of(gear, *figure.y)

    def stable(right: frozenset[str]) -> np.ndarray:
        return PrintedPlane(gear, *axes, gear.start, figure.speed, LOAD, fixed=fixed, right=right).excess(u, v) < 0

    names = frozenset(MISPRINTS_OF[figure.topology])
    proper = stable(names)
    alone = {name: stable(names - {name}) for name in MISPRINTS_OF[figure.topology]}
    return {name: float((found != proper).mean()) for name, found in (alone | {"all": stable(frozenset())}).items()}


def needed_damping(record: StabilityChart, family: int, level: float) -> float:
    """Damping beyond which a family is stable at a value of the vertical axis; 0 where it is stable without.

    Parameters
    ----------
    record : StabilityChart
        With damping on the horizontal axis.
    family : int
    level : float
        Of the vertical axis [SI].

    Returns
    -------
    float
        [N s/m]; infinite where the end of the axis is unstable.
    """
    end = record.x.high
    if not record.stable(np.array([end]), np.array([level]), family)[0]:
        return np.inf
    found = [0.0]
    for curve in record.families[family].curves:
        a, b = curve.points[:-1], curve.points[1:]
        across = (a[:, 1] < level) != (b[:, 1] < level)
        p, q = a[across], b[across]
        found += (p[:, 0] + (q[:, 0] - p[:, 0]) * (level - p[:, 1]) / (q[:, 1] - p[:, 1])).tolist()
    return max(found)

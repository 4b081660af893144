"""Stability charts of the thesis (C. Arreaza, Toronto 2015), Figs 3.4 to 3.29, and what its text says of them.

Each figure is traced from the values of its caption, in the formulas as printed (`published`) and made consistent (`planar`),
and its claims are put to both. The figures themselves are not at hand: ranges of the axes are a choice, and so are values that
a caption does not give (three speeds, lengths, angles, side distances and moduli).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path

import numpy as np

from .chart import StabilityChart, chart
from .config import loads
from .specs import Study

__all__ = [
    "FIGURES",
    "GEOMETRIES",
    "Claim",
    "ThesisFigure",
    "Verdict",
    "needed_damping",
    "thesis_gear",
    "trace_figure",
    "write_thesis",
]

GEOMETRIES = ("published", "planar")
LEVELS = np.linspace(0.1, 0.9, 17)
"""Fractions of the vertical axis at which curves are compared."""

PRINTED_TOO_LITTLE = 5.0
"""The printed damping of UTAS is 5.4 times less than that by virtual work (erratum 8)."""

ALIKE, NEAR_ZERO = 0.02, 1e-4


@dataclass(frozen=True)
class Verdict:
    """Whether a claim holds for a chart, and the numbers that say so."""

    agrees: bool
    reason: str


@dataclass(frozen=True)
class Claim:
    """A statement of the thesis' text and how it is put to a chart."""

    text: str
    holds: Callable[[StabilityChart], Verdict]


@dataclass(frozen=True)
class ThesisFigure:
    """A stability figure by the values of its caption [SI]."""

    number: str
    topology: str
    x: tuple[str, float, float]
    y: tuple[str, float, float]
    claims: tuple[Claim, ...]
    vary: tuple[str, tuple[float, ...]] | None = None
    speed: float = 40.0
    design: Mapping[str, float] = field(default_factory=dict)


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


def _needed(record: StabilityChart) -> np.ndarray:
    """(families, levels)"""
    levels = record.y.low + (record.y.high - record.y.low) * LEVELS
    return np.array([[needed_damping(record, k, level) for level in levels] for k in range(len(record.families))])


def _words(record: StabilityChart, numbers: np.ndarray) -> str:
    assert record.varied is not None
    values = ", ".join(f"{family.value:.3g}" for family in record.families)
    return f"{', '.join(f'{n:.3g}' for n in numbers)} for {record.varied.name.split('.')[-1]} {values}"


def _falls(record: StabilityChart) -> Verdict:
    middle = np.median(_needed(record), axis=1)
    return Verdict(bool((np.diff(middle) < 0).all()), f"median damping needed: {_words(record, middle)}")


def _rises(record: StabilityChart) -> Verdict:
    middle = np.median(_needed(record), axis=1)
    return Verdict(bool((np.diff(middle) > 0).all()), f"median damping needed: {_words(record, middle)}")


def _stiffness_matters_less(record: StabilityChart) -> Verdict:
    needed = _needed(record)
    spread = needed.max(axis=1) / needed.min(axis=1)
    return Verdict(bool((np.diff(spread) < 0).all()), f"largest over least damping needed: {_words(record, spread)}")


def _alike_at_high_stiffness(record: StabilityChart) -> Verdict:
    needed = _needed(record)
    low, high = np.ptp(needed, axis=0)[[0, -1]]
    return Verdict(
        bool(high < low), f"difference of the damping needed: {low:.3g} N s/m at the low end, {high:.3g} at the high end"
    )


def _meet_without_arm(record: StabilityChart) -> Verdict:
    level = record.y.low + NEAR_ZERO * (record.y.high - record.y.low)
    needed = np.array([needed_damping(record, k, level) for k in range(len(record.families))])
    return Verdict(bool(np.ptp(needed) < ALIKE * needed.max()), f"damping needed without arm: {_words(record, needed)}")


def _light_as_good_as_steel(record: StabilityChart) -> Verdict:
    needed = np.median(_needed(record), axis=1)
    carbon, steel = needed[-2:]
    return Verdict(bool(carbon < 1.5 * steel), f"median damping needed: {_words(record, needed)}")


def _stable_share(record: StabilityChart, speed: float) -> float:
    e = np.linspace(0, record.y.high, 401)[1:]
    return float(record.stable(np.full(e.size, speed), e).mean())


def _faster_is_stabler(record: StabilityChart) -> Verdict:
    speeds = (40.0, 80.0, 120.0, 160.0)
    shares = np.array([_stable_share(record, speed) for speed in speeds])
    listed = ", ".join(f"{100 * share:.0f} %" for share in shares)
    return Verdict(bool((np.diff(shares) >= 0).all()), f"stable share of e > 0 at 40, 80, 120, 160 m/s: {listed}")


def _slow_is_unstable(record: StabilityChart) -> Verdict:
    slow, fast = _stable_share(record, 10.0), _stable_share(record, 160.0)
    return Verdict(slow < fast, f"stable share of e > 0: {100 * slow:.0f} % at 10 m/s, {100 * fast:.0f} % at 160 m/s")


_SPEEDS = ("speed", (40.0, 80.0, 160.0))
_LENGTHS = ("L", (0.3, 0.6, 1.0))
_ANGLES = ("gamma", tuple(np.deg2rad([20.0, 31.0, 45.0]).tolist()))
_SIDES = ("b", (0.1, 0.2, 0.3))
_MODULI = ("material.youngs_modulus", (70e9, 140e9, 200e9))
_CASTER = ("speed", 1.0, 200.0), ("caster_length", -0.2, 0.5)
_BOEING = ("c_lambda", 0.0, 3e4), ("k_lambda", 0.0, 1e7)
_UTAS = ("c_lambda", 0.0, 6e5), ("I_arm", 0.0, 1e-5)
_NEW = ("c_lambda", 0.0, 4e4), ("I_arm", 0.0, 1e-5)

FASTER = Claim("The higher the velocity the more stable, for positive caster.", _faster_is_stabler)
SLOW = Claim("For positive caster, low velocities are unstable.", _slow_is_unstable)
GREATER_V = Claim("The greater the velocity, the bigger the stable region.", _falls)
HIGH_V = Claim("At high velocity stiffness stops having an effect.", _stiffness_matters_less)
LONGER = Claim("The longer the torque links, the bigger the stable region.", _falls)
WIDER = Claim("The larger the angle, the bigger the stable region.", _falls)
SIDE = Claim("The bigger b, the smaller the stable region.", _rises)
CARBON = Claim("Carbon fibre performs almost like steel (needs less than half as much damping again).", _light_as_good_as_steel)
MEET = Claim("All curves meet where the arm's moment of inertia is zero.", _meet_without_arm)
ALIKE_HIGH = Claim("At high moments of inertia the differences become negligible.", _alike_at_high_stiffness)

FIGURES = (
    ThesisFigure("3.4", "boeing", *_CASTER, (FASTER,), design={"c_lambda": 1000.0, "k_lambda": 3.8e6}),
    ThesisFigure("3.5", "boeing", *_BOEING, (GREATER_V, HIGH_V), _SPEEDS),
    ThesisFigure("3.6", "boeing", *_BOEING, (LONGER,), _LENGTHS),
    ThesisFigure("3.7", "boeing", *_BOEING, (WIDER,), _ANGLES),
    ThesisFigure("3.10", "utas", *_CASTER, (FASTER,), design={"c_lambda": 1000.0, "I_arm": 5e-6}),
    ThesisFigure("3.11", "utas", *_CASTER, (FASTER,), design={"c_lambda": 1000.0, "I_arm": 5e-5}),
    ThesisFigure("3.12", "utas", *_UTAS, (GREATER_V, HIGH_V), _SPEEDS),
    ThesisFigure("3.13", "utas", *_UTAS, (LONGER,), _LENGTHS),
    ThesisFigure("3.14", "utas", *_UTAS, (LONGER,), _LENGTHS, speed=100.0),
    ThesisFigure("3.15", "utas", *_UTAS, (SIDE,), _SIDES),
    ThesisFigure("3.16", "utas", *_UTAS, (SIDE,), _SIDES, speed=100.0),
    ThesisFigure("3.17", "utas", *_UTAS, (CARBON, MEET), _MODULI),
    ThesisFigure("3.18", "utas", *_UTAS, (CARBON, MEET), _MODULI, speed=100.0),
    ThesisFigure("3.21", "arreaza", *_CASTER, (SLOW,), design={"c_lambda": 1000.0, "I_arm": 1e-6}),
    ThesisFigure("3.22", "arreaza", *_CASTER, (SLOW,), design={"c_lambda": 1000.0, "I_arm": 1e-5}),
    ThesisFigure("3.23", "arreaza", *_NEW, (GREATER_V, HIGH_V), _SPEEDS),
    ThesisFigure("3.24", "arreaza", *_NEW, (LONGER, ALIKE_HIGH), _LENGTHS),
    ThesisFigure("3.25", "arreaza", *_NEW, (LONGER, ALIKE_HIGH), _LENGTHS, speed=100.0),
    ThesisFigure("3.26", "arreaza", *_NEW, (CARBON, MEET), _MODULI),
    ThesisFigure("3.27", "arreaza", *_NEW, (CARBON, MEET), _MODULI, speed=100.0),
    ThesisFigure("3.28", "arreaza", *_NEW, (ALIKE_HIGH,), _ANGLES),
    ThesisFigure("3.29", "arreaza", *_NEW, (ALIKE_HIGH,), _ANGLES, speed=100.0),
)


def thesis_gear() -> Study:
    """The main gear of Table 0.1: the starter study's, with the tread-width moment that the starter leaves out."""
    starter = files("damperopt").joinpath("starter.yaml").read_text(encoding="utf-8")
    return loads(starter, "starter.yaml").replace(tyre__tread_width_moment=570.0)


def trace_figure(figure: ThesisFigure, study: Study, geometry: str) -> StabilityChart:
    """Chart of a figure.

    Parameters
    ----------
    figure : ThesisFigure
    study : Study
        The thesis' main gear.
    geometry : str
        ``published``, ``planar`` or ``spatial``.

    Returns
    -------
    StabilityChart
    """
    steel = {"youngs_modulus": 200e9, "density": 7850.0, "yield_strength": 1e9}
    gear = study.replace(damper={"topology": figure.topology, "geometry": geometry}, material=steel)
    caption = {"L": 0.6, "gamma": float(np.deg2rad(31.0)), "b": 0.2, "c_lambda": 1e3, "I_arm": 5e-6, "k_lambda": 3.8e6}
    design = {name: value for name, value in {**caption, **figure.design}.items() if name in gear.start}
    gear = gear.replace(**{f"design__{name}__start": value for name, value in design.items()})
    name, low, high = figure.x
    if figure.topology == "utas" and name == "c_lambda" and geometry != "published":
        high /= PRINTED_TOO_LITTLE  # so that the curves fill the figure
    return chart(gear, (name, low, high), figure.y, vary=figure.vary, speed=figure.speed, load=150e3)


def write_thesis(place: Path, study: Study) -> list[tuple[str, str, str, Verdict]]:
    """Draw all figures into a folder with one page.

    Parameters
    ----------
    place : Path
        Folder, which exists.
    study : Study
        The thesis' main gear.

    Returns
    -------
    list of tuple
        (figure, geometry, claim, verdict), in the order of the page.
    """
    import jinja2

    from . import plots
    from .chart_plot import chart as draw

    rows, page = [], []
    for figure in FIGURES:
        panels = []
        for geometry in GEOMETRIES:
            record = trace_figure(figure, study, geometry)
            name = f"figure-{figure.number}-{geometry}"
            plots.save(draw(record), place, name)
            verdicts = [(claim.text, claim.holds(record)) for claim in figure.claims]
            rows += [(figure.number, geometry, text, verdict) for text, verdict in verdicts]
            panels.append({"geometry": geometry, "image": f"{name}.png", "verdicts": verdicts})
        page.append({"number": figure.number, "topology": figure.topology, "speed": figure.speed, "panels": panels})
    template = (Path(__file__).with_name("thesis.html")).read_text(encoding="utf-8")
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    (place / "index.html").write_text(environment.from_string(template).render(figures=page), encoding="utf-8")
    return rows

"""What the command line shows: the answer first, then what it rests on."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from ..charts.chart import StabilityChart
from ..cycles.criticality import Criticality
from ..literature.arreaza2015 import Row
from ..motion.measure import PEAKS
from ..motion.trajectory import ROUNDING, Motion, Trajectory
from ..quantities.record import quantity_of
from ..quantities.shown import rounded, scale, unit_text
from ..results import Certificate, OperatingPoint
from ..stability.critical import CriticalSpeed
from ..stability.wavelength import Wavelength, contact_line_words
from ..study.components import unit_of_name
from ..study.disturbances import Disturbance
from ..study.scope import covers, leaves_out
from ..study.study import Study
from ..tyres.curves import TyreCurves
from ..tyres.path_response import PathResponse
from ..tyres.property_file import PropertyFile
from .cycle_words import show_criticality

__all__ = [
    "disturbance_words",
    "number_and_unit",
    "plain_table",
    "show_analysis",
    "show_chart",
    "show_claims",
    "show_contact_line",
    "show_motion",
    "show_tyre",
]

SHOWN_PEAKS = (
    "yaw_angle",
    "lateral_displacement",
    "string_deflection",
    "slip_angle",
    "damper_stroke",
    "damper_force",
    "arm_stress",
)


def dampings(certificate: Certificate) -> str:
    """The interval of dampings that a certificate covers, in words; empty where it is the design's own alone."""
    if certificate.damping is None:
        return ""
    return f", every damping from {certificate.damping[0]:.6g} to {certificate.damping[1]:.6g} times that of the design"


def times(factor: float, certificate: Certificate) -> str:
    """A factor on the damping, where it is uncertain."""
    return "" if certificate.damping is None else f", {factor:.4g} times the damping"


def worst_words(worst: OperatingPoint, certificate: Certificate) -> str:
    """Where the spectral abscissa is largest."""
    at = times(worst.damping, certificate)
    return f"Worst point: {worst.abscissa:.6f} 1/s at {worst.speed:.2f} m/s, {worst.load / 1e3:g} kN{at}"


def disturbance_words(disturbance: Disturbance) -> str:
    """A disturbance in words, such as ``release of yaw angle 1 deg``."""
    parts = []
    for kind in type(disturbance).model_fields:
        block = getattr(disturbance, kind)
        for name, field in type(block).model_fields.items() if block is not None else ():
            quantity, value = quantity_of(field.annotation, field.metadata), getattr(block, name)
            if value:
                parts.append(
                    " ".join((kind, "of", name.replace("_", " "), *number_and_unit(value, quantity.unit if quantity else "")))
                )
    return ", ".join(parts)


def show_motion(
    console: Console,
    trajectory: Trajectory,
    motion: Motion,
    cycles: int,
    disturbance: str = "",
    sized: Mapping[str, float] = {},
    left_out: Sequence[str] = (),
) -> None:
    """What a trajectory shows, after what, beside the loads that the parts were sized for, and what its model leaves out."""
    console.print(
        f"\n[bold]{motion.kind}[/]: {trajectory.speed:g} m/s, {trajectory.load / 1e3:g} kN, {trajectory.time[-1]:.4g} s"
    )
    if trajectory.message:
        console.print(f"[bold red]stopped[/]: {escape(trajectory.message)}", soft_wrap=True)
    if disturbance:
        console.print(f"After {escape(disturbance)}", soft_wrap=True)
    ratio = "" if motion.decay_ratio is None else f"{motion.decay_ratio:.4g} of the first amplitude"
    counted = f"{motion.cycles:g} cycles" if motion.cycles else "No whole cycle"
    console.print(f"{counted}; after {cycles}: {ratio}" if ratio else f"{counted}, fewer than the {cycles} of the decay")
    if motion.frequency and motion.amplitude < ROUNDING:
        console.print("At the end: at rest, to rounding")
    elif motion.frequency:
        degrees = math.degrees(motion.amplitude)
        console.print(
            f"At the end: yaw +-{motion.amplitude:.4g} rad ({degrees:.3g} deg) about {motion.mean:.2g} rad, "
            f"{motion.frequency:.4g} Hz",
            soft_wrap=True,
        )
    table = plain_table("peak", "value", "unit", *(("sized for",) if sized else ()))
    for name in SHOWN_PEAKS:
        if name in motion.peaks:
            value, unit = motion.peaks[name], trajectory.units[name]
            limit = sized.get(name) if name in PEAKS else None
            beside = "" if limit is None else f"{limit:.4g} {unit}" + (" [red]exceeded[/]" if value > limit else "")
            shown = number_and_unit(value, unit) if unit == "rad" else (f"{value:.4g}", unit)
            table.add_row(name.replace("_", " "), *shown, *((beside,) if sized else ()))
    console.print(table)
    _show_left_out(console, left_out)


def _show_left_out(console: Console, words: Sequence[str]) -> None:
    if words:
        console.print("Left out: " + escape("; ".join(words)), soft_wrap=True, style="dim")


def show_analysis(
    console: Console,
    study: Study,
    design: Mapping[str, float],
    critical: Sequence[CriticalSpeed],
    worst: OperatingPoint,
    certificates: Sequence[Certificate],
    searched: tuple[float, float],
    wave: Wavelength | None,
    marginal: bool = False,
    fail_safe: Sequence[Certificate] = (),
    left_out: Sequence[str] = (),
    criticality: Sequence[Criticality] = (),
) -> None:
    """Critical speeds and how their limit cycles begin, worst point and certificates of a given design."""
    console.print(f"\n[bold]{escape(study.name)}[/], {study.damper.topology} ({study.damper.geometry})")
    if design:
        text = ", ".join(" ".join((name, *number_and_unit(value, unit_of_name(name)))) for name, value in design.items())
        console.print(text, soft_wrap=True)
    if critical:
        table = plain_table("critical speed", "load", "kind", "frequency", "root", "gear")
        for c in critical:
            after = "unstable" if c.destabilising else "stable"
            sides = "touches the line, nothing changes" if c.touching else "unstable on both sides"
            change = f"{after} above" if c.boundary else sides
            direction = "destabilised" if c.destabilising else "stabilised"
            table.add_row(f"{_fixed(c.speed)} m/s", f"{c.load / 1e3:g} kN", c.kind, f"{c.frequency:.3f} Hz", direction, change)
        console.print(table)
        show_criticality(console, criticality)
    else:
        low, high = searched
        console.print(
            "[yellow]Marginal at every speed[/]: a root lies on the line all over."
            if marginal
            else f"No critical speed between {low:g} and {high:g} m/s."
        )
    console.print(worst_words(worst, certificates[0]))
    console.print(escape(" ".join(covers(study))), soft_wrap=True)
    for i, certificate in enumerate((*certificates, *fail_safe)):
        goal = "stable" if certificate.margin == 0 else f"margin {certificate.margin:g} 1/s"
        goal += ", actuator off" if i >= len(certificates) else ""
        verdict = "[green]proved[/] over the whole envelope" if certificate.proved else f"[red]{escape(certificate.reason)}[/]"
        if certificate.counterexample is not None:
            verdict = f"[red]not met[/]: {escape(certificate.reason)}"
        console.print(f"Exact certificate, {goal}{dampings(certificate)}: {verdict}", soft_wrap=True)
    console.print("Not checked: " + escape("; ".join((*left_out, *leaves_out(study)))), soft_wrap=True, style="dim")
    show_contact_line(console, study, wave)


def show_contact_line(console: Console, study: Study, wave: Wavelength | None) -> None:
    """The shortest wave, and what it means for a contact line that is not the exact one."""
    if words := contact_line_words(study, wave):
        console.print(f"[yellow]Rests on[/]: {escape(words[0])}.", soft_wrap=True)
    elif wave is not None:
        console.print(
            f"Shortest wavelength: {wave.length:.3g} m, {wave.contact_lengths:.3g} contact lengths, at {wave.speed:.4g} m/s",
            soft_wrap=True,
        )


def plain_table(*columns: str) -> Table:
    """Table without lines."""
    table = Table(box=None, header_style="dim", padding=(0, 2, 0, 0))
    for column in columns:
        table.add_column(column, justify="right" if column in ("value", "mass, kg") else "left")
    return table


def _fixed(speed: float) -> str:
    """A speed with four decimals; one that these would show as 0 with four digits."""
    return f"{speed:.4f}" if speed >= 1e-3 else f"{speed:.4g}"


def number_and_unit(value: float, unit: str) -> tuple[str, str]:
    """Five digits; angles in degrees."""
    if unit == "rad":
        return f"{math.degrees(value):.4g}", "deg"
    return f"{value:.5g}", unit


def show_chart(console: Console, record: StabilityChart, left_out: Sequence[str] = ()) -> None:
    """Families of a chart with the length, kind and frequency of their curves, and what its model leaves out."""
    _show_left_out(console, left_out)
    table = Table(box=None, pad_edge=False)
    varied, unit = (record.varied.name, record.varied.unit) if record.varied else ("boundary", "")
    for name in (varied, "curves", "points", "type", "frequency", "corners"):
        table.add_column(name, justify="left" if name in (varied, "type") else "right")
    for family in record.families:
        hopf = np.concatenate([c.hopf for c in family.curves] or [np.zeros(0, bool)])
        frequency = np.concatenate([c.frequency for c in family.curves] or [np.zeros(0)])[hopf]
        kinds = [word for word, there in (("Hopf", hopf.any()), ("divergence", (~hopf).any())) if there]
        everywhere = "stable" if family.origin_stable else "unstable"
        value = "" if family.value is None else f"{family.value:g} {unit}"
        band = f"{frequency.min():.3g} to {frequency.max():.3g} Hz" if frequency.size else ""
        corners = sum(len(c.corners) for c in family.curves)
        table.add_row(
            value, str(len(family.curves)), str(hopf.size), " and ".join(kinds) or f"{everywhere} all over", band, str(corners)
        )
    console.print(table)
    for family in record.families:
        if family.abscissa is not None:
            where = "" if family.value is None else f" at {family.value:g} {unit}"
            console.print(f"Spectral abscissa of the design{where}: {family.abscissa:.6g} 1/s")
    looked = sum(family.evaluations for family in record.families)
    if all(family.explicit for family in record.families):
        console.print(
            f"Explicit curves (both quantities act at one joint) to {record.tolerance:g} of the ranges, "
            f"checked with {looked} eigenvalue problems."
        )
    else:
        console.print(
            f"Traced to {record.tolerance:g} of the ranges with {looked} eigenvalue problems; islands smaller than "
            f"{record.cell:.3g} of the ranges may be missed."
        )


def show_claims(console: Console, rows: Sequence[Row]) -> None:
    """Claims of the thesis: a row each, a column for every form of the figures."""
    forms = list(dict.fromkeys(row.form for row in rows))
    table = Table(box=None, pad_edge=False)
    for name in ("figure", "the text", *forms):
        table.add_column(name)
    found: dict[tuple[str, str], dict[str, str]] = {}
    for row in rows:
        found.setdefault((row.figure, row.claim), {})[row.form] = "agrees" if row.verdict.agrees else "differs"
    for (number, claim), verdicts in found.items():
        table.add_row(number, escape(claim), *(verdicts.get(form, "") for form in forms))
    console.print(table)
    for form in forms:
        agreed = [row.verdict.agrees for row in rows if row.form == form]
        console.print(f"{form}: {sum(agreed)} of {len(agreed)} agree")


SHOWN_WAVES = 50.0, 16.0, 8.0, 4.0, 2.0
"""Contact lengths per wave at which contact lines are compared."""

TYRE_LOADS = 4
"""Columns of the table of a tyre; the file has more."""


def show_tyre(console: Console, record: TyreCurves, tyre: Any, read: PropertyFile | None) -> None:
    """A tyre over load, what it comes from, and what of a property file was used."""
    console.print(f"\n[bold]{escape(record.name)}[/]", soft_wrap=True)
    for words in (tyre.origin(), *(() if read is None else _about_file(read))):
        if words:
            console.print(escape(words), soft_wrap=True)
    shown = np.unique(np.linspace(0, len(record.loads) - 1, TYRE_LOADS).round().astype(int))
    table = Table(box=None, header_style="dim", padding=(0, 2, 0, 0))
    table.add_column("load of a wheel", no_wrap=True)
    for i in shown:
        table.add_column(f"{record.loads[i] / 1e3:.4g} kN", justify="right")
    table.add_column("unit")
    for name, column in record.table.items():
        factor, unit = scale(column.unit)[1], unit_text(scale(column.unit)[0])
        cells = [rounded(v * factor) if math.isfinite(v) else "-" for v in column.values[shown]]
        table.add_row(name.replace("_", " "), *cells, unit)
    console.print(table)
    if record.response is not None:
        _show_response(console, record.response)


def _show_response(console: Console, found: PathResponse) -> None:
    """How far each contact line is from the exact one, over the wavelength."""
    columns = [int(np.abs(found.contact_lengths - length).argmin()) for length in SHOWN_WAVES]
    table = Table(box=None, header_style="dim", padding=(0, 2, 0, 0))
    table.add_column("contact line", no_wrap=True)
    for at in columns:
        table.add_column(f"{found.contact_lengths[at]:.3g}", justify="right", no_wrap=True)
    table.add_column("within 10 % from", justify="right", no_wrap=True)
    for line in list(found.lines)[1:]:
        worst, least = 100 * found.errors(line).max(axis=0), found.holds_to(line)
        table.add_row(line, *(_percent(worst[at]) for at in columns), f"{least:.3g}" if math.isfinite(least) else "never")
    console.print(
        f"Distance of force and moment at {found.load / 1e3:.4g} kN from those of the exact contact line (memory), over "
        "contact lengths per wave:",
        soft_wrap=True,
    )
    console.print(table)


def _percent(value: float) -> str:
    return "< 0.01 %" if value < 0.01 else f"{value:.2g} %" if value < 100 else f"{value:.0f} %"


def _about_file(read: PropertyFile) -> list[str]:
    """What of a property file is used, and what is not."""
    lists = (
        ("used", read.used),
        ("not in the file, taken as 0", read.absent),
        ("not needed for pure lateral slip without camber", read.aside),
        ("unknown", read.unknown),
    )
    return [read.kind, *(f"{words}: {', '.join(keys)}" for words, keys in lists if keys), *read.notes]

"""Limit cycles in words: what exists, how large, stable or not, from where to where."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby

import numpy as np
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from ..cycles.amplitude_map import AmplitudeMap
from ..cycles.branches import Question, worded
from ..cycles.criticality import Criticality
from ..cycles.edge import Kicker, Threshold
from ..cycles.elements import joints_of
from ..cycles.orbit import Branch, Orbit
from ..motion.measure import PEAKS
from ..quantities.shown import shown

__all__ = ["kept", "show_criticality", "show_cycles", "show_map", "show_threshold"]

FATES = {
    "dies": "dies",
    "grows": "grows",
    "stays": "neither dies nor grows",
    "leaves": "leaves the range of the model",
}

SHOWN_LEFT = 3
"""Motions that left the model, of which so many are named."""

EXACT = 1e-6
"""Relative error of amplitude and period below which nothing is said of it."""


def show_cycles(
    console: Console,
    question: Question,
    branches: Sequence[Branch],
    begin: str = "hopf",
    sized: Mapping[str, float] = {},
    left: Sequence[str] = (),
) -> None:
    """Branches in words, the answer first; beside the loads that the parts are sized for, where they are known."""
    axis, held = question.axis, []
    if axis.name != "speed":
        held.append(worded(question.speed, "m/s"))
    if axis.name != "vertical_load":
        held.append(worded(question.load, "N"))
    searched = f"{axis.name} {worded(axis.low, axis.unit)} to {worded(axis.high, axis.unit)}" + "".join(f", {h}" for h in held)
    if not branches and begin == "simulation":
        console.print(f"\n[bold]no limit cycle found[/]: {escape(searched)}", soft_wrap=True)
        console.print(
            "Of motions after some releases, at both ends and in the middle of the range, none settles on a cycle; this is a "
            "search, no proof that none exists.",
            soft_wrap=True,
        )
        _show_left(console, left)
        return
    if not branches:
        console.print(f"\n[bold]no Hopf point[/]: {escape(searched)}", soft_wrap=True)
        if not question.rest_is_stable([axis.low, axis.high]).any():
            console.print(
                "[bold]Rest is unstable[/] all over it, joints closed and without friction: what the gear settles on has no "
                "beginning in this range; take a wider one, or --from simulation.",
                soft_wrap=True,
            )
        console.print(
            "No limit cycle grows out of rest in this range. Cycles that are cut off from rest are not excluded by this: "
            "--from simulation looks for them.",
            soft_wrap=True,
        )
        return
    stable = [orbit for branch in branches for orbit in branch.orbits if orbit.stable and not orbit.beyond]
    head = f"[bold]{len(branches)} branch{'es' * (len(branches) > 1)} of limit cycles[/]: {escape(searched)}"
    console.print(f"\n{head}", soft_wrap=True)
    if stable:
        most = max(stable, key=lambda orbit: orbit.amplitudes["yaw_angle"])
        console.print(f"Largest stable cycle: {_size(most)} at {worded(most.parameter, axis.unit)}", soft_wrap=True)
        _show_loads(console, stable, sized, axis.unit)
    else:
        console.print(
            "No stable limit cycle is among them: each is a threshold between motions that die and that grow.", soft_wrap=True
        )
    for number, branch in enumerate(branches, 1):
        console.print(f"\nBranch {number}: from {escape(branch.begins)}; {escape(branch.ends)}", soft_wrap=True)
        for line in _parts(branch):
            console.print(f"  {escape(line)}", soft_wrap=True)
        if branch.error > EXACT:
            console.print(f"  accurate to {branch.error:.1g} of amplitude and period (intervals halved)", soft_wrap=True)
        near = [o for o in branch.orbits if not o.label and abs(np.abs(o.multipliers).max() - 1) < branch.multiplier_error]
        if branch.multiplier_error > EXACT and near:
            console.print(
                f"  [yellow]multipliers are accurate to {branch.multiplier_error:.1g}[/]: {len(near)} orbits are too near to "
                "neutral for their stability to be known",
                soft_wrap=True,
            )
        if branch.kind == "hopf":
            _hidden(console, branch)
    _show_left(console, left)
    if begin == "hopf" and (joints := joints_of(question.study)):
        console.print(f"Joints closed, without friction ({', '.join(joints)}): --from simulation has them.", soft_wrap=True)


def _show_loads(console: Console, stable: Sequence[Orbit], sized: Mapping[str, float], unit: str) -> None:
    """Largest peaks of all stable cycles against what the parts are sized for."""
    flow = stable[0].path.legs[0].flow
    for name in PEAKS:
        if name not in sized or name not in flow.units:
            continue
        loudest = max(stable, key=lambda orbit: orbit.peaks[name])
        value, limit = loudest.peaks[name], sized[name]
        number, shown_unit = shown(value, flow.units[name])
        console.print(
            f"  {name.replace('_', ' ')} up to {number} {shown_unit} at {worded(loudest.parameter, unit)}: "
            f"{100 * value / limit:.3g} % of what the parts are sized for" + (" [red]exceeded[/]" if value > limit else ""),
            soft_wrap=True,
        )


def kept(console: Console, branches: Sequence[Branch], limit: float, unknown: Sequence[str]) -> bool:
    """Whether no stable cycle of more yaw [rad] was found and nothing is unknown; said in words."""
    largest = " ".join(shown(limit, "rad"))
    larger = [orbit for branch in branches for orbit in branch.orbits if orbit.stable and orbit.amplitudes["yaw_angle"] > limit]
    if larger:
        words = f"[red]not kept[/]: {len(larger)} stable cycles of more than {largest} were found"
    elif unknown:
        words = f"[yellow]undecided[/]: none of more than {largest} was found, but {escape('; '.join(unknown))}"
    else:
        words = f"[green]kept[/]: no stable cycle of more than {largest} was found (a search, no proof)"
    console.print(words, soft_wrap=True)
    return not (larger or unknown)


def show_map(console: Console, found: AmplitudeMap) -> None:
    """Where the largest stable cycle of a map lies."""
    row, column = np.unravel_index(found.yaw.argmax(), found.yaw.shape)
    if not found.yaw.any():
        console.print("\n[bold]no stable limit cycle grows out of a Hopf point[/] anywhere in the map", soft_wrap=True)
    else:
        at = f"{worded(found.columns[column], found.x.unit)}, {worded(found.rows[row], found.y.unit)}"
        number = " ".join(shown(float(found.yaw[row, column]), "rad"))
        console.print(f"\n[bold]Largest stable cycle[/]: yaw {number} at {escape(at)}", soft_wrap=True)
    console.print(f"{100 * (found.yaw > 0).mean():.3g} % of the map has one.", soft_wrap=True)
    if found.lost.any():
        console.print(
            f"[yellow]{100 * found.lost.mean():.3g} % is not known[/]: a branch was lost, or rest is unstable and no branch "
            "that begins in this range arrives; take a wider one",
            soft_wrap=True,
        )


def _show_left(console: Console, left: Sequence[str]) -> None:
    """Motions of which nothing more is known."""
    if left:
        words = "; ".join(left[:SHOWN_LEFT]) + ("; ..." if len(left) > SHOWN_LEFT else "")
        console.print(f"[bold]{len(left)} motions left the range of the model[/]: {escape(words)}", soft_wrap=True)


def _size(orbit: Orbit) -> str:
    return f"yaw {' '.join(shown(orbit.amplitudes['yaw_angle'], 'rad'))}, {orbit.frequency:.4g} Hz"


def _parts(branch: Branch) -> Iterator[str]:
    """Stretches of one stability, and the special points between them."""
    for stable, run in groupby(branch.orbits, key=lambda orbit: orbit.stable):
        orbits = list(run)
        ends = f"{worded(orbits[0].parameter, branch.unit)} to {worded(orbits[-1].parameter, branch.unit)}"
        sizes = [orbit.amplitudes["yaw_angle"] for orbit in orbits]
        low, high = (" ".join(shown(size, "rad")) for size in (min(sizes), max(sizes)))
        yield f"{'stable' if stable else 'unstable'} from {ends}: yaw {low} to {high}"
    for orbit in branch.special:
        yield f"{orbit.label} at {worded(orbit.parameter, branch.unit)}: {_size(orbit)}"
    if branch.orbits[-1].beyond:
        yield f"the last orbit is beyond the model: {branch.orbits[-1].beyond}"


def _hidden(console: Console, branch: Branch) -> None:
    """A branch that leaves rest unstable: shimmy where rest is stable."""
    if branch.orbits[0].stable or branch.orbits[0].unstable > 1:
        return
    console.print(
        "  [bold]hidden shimmy[/]: the branch leaves rest on its stable side; there a disturbance larger than the unstable "
        "cycle does not die",
        soft_wrap=True,
    )


def show_criticality(console: Console, found: Sequence[Criticality]) -> None:
    """How the limit cycles of the critical speeds begin."""
    for c in found:
        stable, unstable = ("below", "above") if c.stable_below else ("above", "below")
        words = {
            "supercritical": f"supercritical: a stable limit cycle begins there with amplitude zero and grows {unstable} it",
            "subcritical": (
                f"[bold]subcritical[/]: hidden shimmy {stable} it, where small disturbances die: one larger than an unstable "
                "limit cycle does not ('damperopt cycles' shows how large and how far)"
            ),
            "degenerate": "neither super- nor subcritical to third order: the laws have no curvature that says it",
        }[c.kind]
        console.print(f"Hopf at {worded(c.speed, 'm/s')}, {worded(c.load, 'N')}: {words}.", soft_wrap=True)


def show_threshold(console: Console, kicker: Kicker, found: Sequence[Threshold]) -> None:
    """The largest disturbance that dies, over speed, and what the next larger one does."""
    what = f"{kicker.kind} of {kicker.name.replace('_', ' ')}"
    both = [t for t in found if t.dies is not None and t.not_dies is not None]
    if both:
        least = min(both, key=lambda t: t.dies or 0.0)
        size = " ".join(shown(least.dies or 0.0, kicker.unit))
        console.print(f"\n[bold]Least threshold[/]: a {what} of {size} dies at {worded(least.speed, 'm/s')}", soft_wrap=True)
    table = Table(box=None, header_style="dim", padding=(0, 2, 0, 0))
    for column in ("speed", "dies", "does not die", "which then"):
        table.add_column(column)
    for t in found:
        sizes = ["none tried" if v is None else " ".join(shown(v, kicker.unit)) for v in (t.dies, t.not_dies)]
        table.add_row(worded(t.speed, "m/s"), *sizes, FATES[t.fate] if t.not_dies is not None else "")
    console.print(table)
    console.print(
        "Exact motions, corners as events; found by bisection: between the sizes that were tried there may be others.",
        soft_wrap=True,
        style="dim",
    )

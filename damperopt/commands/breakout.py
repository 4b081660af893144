"""How much breakout friction a castering wheel needs."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import ConfigError
from .shared import ConfigArgument, OutputOption, all_or_nothing, bar, out

if TYPE_CHECKING:
    from ..study.disturbances import Disturbance
    from ..study.study import Study

__all__ = ["breakout"]

POUND = 4.4482216152605


def breakout(
    file: ConfigArgument,
    kick: Annotated[list[str] | None, typer.Option(help="Yaw rate at the start, such as 3rad/s; a row for each.")] = None,
    release: Annotated[list[str] | None, typer.Option(help="Yaw angle let go, such as 5deg; a row for each.")] = None,
    pressure: Annotated[list[str] | None, typer.Option(help="Of the tyre, such as 25psi; a row for each.")] = None,
    speeds: Annotated[int, typer.Option(min=1, max=200, help="How many of the envelope are looked at.")] = 8,
    load: Annotated[str, typer.Option(help="Vertical load [N]. [default: the largest of the envelope]")] = "",
    duration: Annotated[str, typer.Option(help="Within which the wheel must rest [s].")] = "2",
    output: OutputOption = None,
) -> None:
    """Least breakout of a friction damper that brings the wheel to rest at every speed, by exact simulation.

    For each disturbance and tyre pressure. No proof: speeds between those that were looked at are not, and border cases count
    as not at rest.
    """
    import numpy as np

    from ..motion.breakout import least_breakout
    from ..output.folder import run_folder, write_run
    from ..quantities.record import Force, Time
    from ..study.config import load as read
    from .arguments import quantity

    study = read(file)
    disturbances = _disturbances(kick or [], release or [])
    at_load = quantity(load, Force, "--load") if load else max(study.envelope.loads)
    seconds = quantity(duration, Time, "--duration")
    low, high = study.envelope.speed.min, study.envelope.speed.max
    V = np.geomspace(low, high, speeds) if speeds > 1 else np.array([low])
    at_pressures = [(text, _at_pressure(study, text)) for text in pressure] if pressure else [("", study)]
    folder = run_folder(output, f"{file.stem}-breakout")
    rows: list[dict[str, Any]] = []
    sentences: list[str] = []
    with all_or_nothing(), bar() as shown:
        task = shown.add_task("searching", total=len(at_pressures) * len(disturbances))
        for text, own in at_pressures:
            for words, disturbance in disturbances:
                begin = ", ".join(filter(None, (text, words)))
                shown.update(task, description=begin)

                def tell(speed: float, torque: float, begin: str = begin) -> None:
                    shown.update(task, description=f"{begin}, {speed:.3g} m/s, {torque:.3g} N m")

                found = least_breakout(own, disturbance, V.tolist(), at_load, seconds, progress=tell)
                rows.append(
                    {"pressure": text, "disturbance": words, "speed [m/s]": found.speed, "breakout [N m]": found.torque}
                )
                shown.update(task, advance=1)
                sentences.append(f"{begin}: {_answer(own, found.torque, found.speed)}")
    for sentence in sentences:
        out.print(sentence, soft_wrap=True, markup=False)
    listed = ", ".join(f"{speed:.3g}" for speed in V)
    out.print(
        f"\nBy exact simulation over {seconds:g} s at {listed} m/s, {at_load:g} N: no proof.", soft_wrap=True, markup=False
    )

    def write(place: Path) -> None:
        with open(place / "breakout.csv", "w", newline="", encoding="utf-8") as table:
            writer = csv.DictWriter(table, list(rows[0]))
            writer.writeheader()
            writer.writerows(rows)

    write_run(folder, write)
    out.print(f"Results in {folder}", soft_wrap=True, markup=False)


def _disturbances(kicks: list[str], releases: list[str]) -> list[tuple[str, Disturbance]]:
    from .arguments import disturbance_of

    asked = [("kick", "yaw rate", text) for text in kicks] + [("release", "yaw", text) for text in releases]
    if not asked:
        raise ConfigError("breakout: found no disturbance; allowed: --kick 3rad/s, --release 5deg, each as often as you like")
    return [(f"{kind} of {what} {text}", disturbance_of({kind: [f"yaw={text}"]})) for kind, what, text in asked]


def _at_pressure(study: Study, text: str) -> Study:
    from ..quantities.record import Pressure
    from .arguments import quantity

    value = quantity(text, Pressure, "--pressure")
    changed = study.replace(tyre__pressure=value)
    F_z = max(study.envelope.loads)
    if changed.tyre.linear(F_z, value) == study.tyre.linear(F_z, study.tyre.pressure) and value != study.tyre.pressure:
        allowed = "a tyre by its size, or a property file with a pressure"
        raise ConfigError(f"--pressure: the law '{study.tyre.law}' does not depend on it; allowed: {allowed}")
    return changed


def _answer(study: Study, torque: float | None, speed: float) -> str:
    if torque is None:
        return f"no breakout suffices at {speed:.3g} m/s"
    lever = study.damper.breakout_lever or study.gear.caster_length
    force = torque / lever
    at = f"{force / POUND:.3g} lbf ({force:.3g} N) at {1e3 * lever:.4g} mm"
    return f"{torque:.3g} N m, {at}; {speed:.3g} m/s asks for it"

"""How much friction holds a kick."""

from __future__ import annotations

from typing import Annotated

import typer

from .shared import ConfigArgument, out

__all__ = ["breakout"]

LBF = 4.4482216152605
"""[N]"""


def breakout(
    file: ConfigArgument,
    kick: Annotated[list[str], typer.Option(metavar="NAME=VALUE", help="Yaw or bending rate at the start.")],
    speeds: Annotated[str, typer.Option(metavar="V,V,..", help="Speeds to look at. [default: 12 over the envelope]")] = "",
    duration: Annotated[str, typer.Option(help="Time within which the gear must rest, in s.")] = "3",
) -> None:
    """Least breakout torque of a friction damper with which the gear rests after a kick, at every speed that is looked at.

    By exact simulation, since no proof holds friction. Exit code 2: no torque is enough, or the question is not well posed.
    """
    from ..motion.breakout import least_breakout
    from ..quantities.record import Speed, Time
    from ..study import config
    from .arguments import disturbance_of, quantity
    from .shared import all_or_nothing
    from .summary import disturbance_words

    study, disturbance = config.load(file), disturbance_of({"kick": kick})
    row = [quantity(part.strip(), Speed, "--speeds") for part in speeds.split(",") if part.strip()]
    with all_or_nothing():
        found = least_breakout(study, disturbance, speeds=row, duration=quantity(duration, Time, "--duration"))
    force = "" if found.force is None else f", {found.force:.4g} N ({found.force / LBF:.3g} lbf) at the axle"
    out.print(f"\n[bold]{found.torque:.4g} N m[/]{force} hold a {disturbance_words(disturbance)}", soft_wrap=True)
    looked_at = ", ".join(f"{V:.3g}" for V in found.speeds)
    out.print(
        f"Worst: {found.speed:.4g} m/s, {found.load / 1e3:g} kN, where 1 % less does not. Looked at: {looked_at} m/s, with "
        f"{found.simulations} exact simulations; between these speeds nothing is known, and nothing is proved.",
        soft_wrap=True,
    )

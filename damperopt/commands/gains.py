"""Gains over speed for an actuator beside the damper."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import ConfigError
from .shared import ConfigArgument, DesignOption, out, study_and_design

if TYPE_CHECKING:
    from ..results import Certificate
    from ..stability.gain_schedule import GainSchedule
    from ..study.study import Study

__all__ = ["gains"]

SHOWN = 5
"""Speeds of the table."""


def gains(
    file: ConfigArgument,
    size: Annotated[list[str], typer.Option(metavar="STATE=VALUE", help="Size of a state that counts 1 in the cost.")],
    torque: Annotated[str, typer.Option(help="Torque that counts 1 in the cost, such as '500 N m'.")],
    measured: Annotated[str, typer.Option(help="States that the law has, a comma list. [default: all that can be]")] = "",
    degree: Annotated[int, typer.Option(min=0, max=3, help="Of the polynomials of the speed.")] = 2,
    design: DesignOption = None,
) -> None:
    """Gains u = -K(V) x of least quadratic cost, fitted over the speeds, as a block for the study; and what is proved of them.

    Exit code 0 also where the margin is not met with them: that is an answer.
    """
    from ..proof.certify import certify
    from ..quantities.record import Torque
    from ..stability.gain_schedule import gain_schedule
    from .arguments import quantity

    study, values = study_and_design(file, design)
    sizes = _sizes(size, study)
    names = [name.strip() for name in measured.split(",") if name.strip()] or None
    found = gain_schedule(study, sizes, quantity(torque, Torque, "--torque"), measured=names, degree=degree, design=values)
    control = study.damper.control
    given = {} if control is None else control.model_dump(exclude_none=True)
    with_gains = study.replace(damper__control={**given, "gains": found.block})
    _show(found, certify(with_gains, study.start if values is None else values), with_gains)


def _sizes(texts: list[str], study: Study) -> dict[str, float]:
    """Sizes of states [SI] of texts such as ``yaw_rate=0.1rad/s``."""
    from ..quantities.units import Quantity
    from ..reading import quoted
    from .arguments import quantity

    units, found = {state.name: state.unit for state in (*study.gear.states(), *study.tyre.states)}, {}
    for text in (part.strip() for given in texts for part in given.split(",")):
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals or name not in units:
            raise ConfigError(f"--size: found {quoted(text)}; allowed: STATE=VALUE with a state of {', '.join(units)}")
        kind: Any = Annotated[float, Quantity(units[name], above=0)]
        found[name] = quantity(value, kind, f"--size {name}")
    return found


def _show(found: GainSchedule, certificate: Certificate, study: Study) -> None:
    from .summary import plain_table

    rows = sorted({round(k * (len(found.speeds) - 1) / (SHOWN - 1)) for k in range(SHOWN)})
    table = plain_table("state", *(f"{found.speeds[i]:.4g} m/s" for i in rows), "fit misses")
    for k, state in enumerate(found.states):
        table.add_row(state, *(f"{found.gains[i, k]:.5g}" for i in rows), f"{100 * found.errors[k]:.3g} %")
    out.print("\nGains in N m per SI unit of the state, and what the polynomials miss of the largest at most:")
    out.print(table)
    out.print("\nFor the block damper of the study:\n\n  control:\n    gains:", highlight=False)
    for state, row in found.block.items():
        words = ", ".join(f"{power}: {value:.6g}" for power, value in row.items())
        out.print(f"      {state}: {{{words}}}", markup=False, highlight=False, soft_wrap=True)
    met = "proved" if certificate.proved else "NOT met"
    speed = study.envelope.speed
    words = (
        f"Exact certificate with these gains, margin {certificate.margin:g} 1/s from {speed.min:g} to {speed.max:g} m/s: {met}"
    )
    out.print(f"\n{words}" + ("" if certificate.proved else f" ({certificate.reason})"), markup=False, soft_wrap=True)

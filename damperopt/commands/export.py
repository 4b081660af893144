"""A gear for other tools."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import ConfigError
from ..reading import quoted
from .shared import ConfigArgument, DesignOption, all_or_nothing, out, study_and_design

if TYPE_CHECKING:
    from ..stability.state_space import StateSpace

__all__ = ["export"]

SPEEDS = 20
"""Over the envelope, if none are given."""

MOST_POINTS = 10_000


def export(
    file: ConfigArgument,
    to: Annotated[Path, typer.Option(metavar="FILE", help="New file, .npz or .mat.")],
    design: DesignOption = None,
    speeds: Annotated[str, typer.Option(metavar="MIN:MAX:STEP", help="In m/s. [default: 20 over the envelope]")] = "",
    loads: Annotated[str, typer.Option(metavar="F,...", help="Such as 20kN,150kN. [default: those of the envelope]")] = "",
    order: Annotated[
        int | None, typer.Option(min=1, max=128, help="Of the contact line as a field. [default: that of the study]")
    ] = None,
) -> None:
    """State-space matrices over speeds and loads with names and units; with a delay, its data beside a rational twin."""
    import numpy as np

    from ..output.state_space import FORMATS, write_state_space
    from ..stability.state_space import state_space
    from .arguments import speed_grid
    from .frequency import load_of

    if to.suffix.lower() not in FORMATS:
        raise ConfigError(f"--to: found {quoted(to.name)}; allowed: a file that ends with {' or '.join(FORMATS)}")
    study, values = study_and_design(file, design)
    envelope = study.envelope.speed
    grid = speed_grid(speeds, study) if speeds else np.unique(np.linspace(envelope.min, envelope.max, SPEEDS))
    own = sorted({load_of(part.strip() or "-", study) for part in loads.split(",")}) if loads else sorted(study.envelope.loads)
    if len(grid) * len(own) > MOST_POINTS:
        words = f"{len(grid)} speeds x {len(own)} loads"
        raise ConfigError(f"--speeds: found {words}; allowed: at most {MOST_POINTS} points")
    with all_or_nothing():
        record = state_space(study, study.start if values is None else values, grid.tolist(), own, order)
        write_state_space(to, record)
    _show(record, to)


def _show(record: StateSpace, to: Path) -> None:
    from .summary import plain_table

    p, q = len(record.speeds), len(record.loads)
    at = f"{p} speeds from {record.speeds[0]:.5g} to {record.speeds[-1]:.5g} m/s"
    under = ", ".join(f"{load / 1e3:.6g} kN" for load in record.loads[:5]) + (f" and {q - 5} more" if q > 5 else "")
    out.print(f"\nx' = A x + B u, y = C x + D u at {at}, {under}", soft_wrap=True, markup=False)
    table = plain_table("", "name", "unit")
    for symbol, declared in (("x", record.states), ("u", record.inputs), ("y", record.outputs)):
        for k, quantity in enumerate(declared):
            table.add_row(symbol if not k else "", quantity.name, quantity.unit)
    out.print(table)
    out.print(f"Contact line {record.contact}.", soft_wrap=True, markup=False)
    if record.delay is not None:
        error = record.delay.field_error
        import numpy as np

        i, j = np.unravel_index(int(error.argmax()), error.shape)
        where = f"{record.speeds[i]:.5g} m/s, {record.loads[j] / 1e3:.6g} kN"
        words = f"Its eigenvalues miss the exact ones by {error[i, j]:.2g} at most, relative (at {where}); delay_... are exact."
        out.print(words, soft_wrap=True, markup=False)
    out.print(f"\nWritten: {to}", soft_wrap=True, markup=False)

"""What the command line shows of a design: mass, loads and margins, proof, and what it does not look at."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console
from rich.markup import escape

from ..answers.bound import bound_words
from ..answers.stock import candidate_cells, stock_words
from ..output.margins import critical_rows, margin_words
from ..results import DesignResult, StockResult
from ..study.components import unit_of_name
from ..study.scope import covers
from ..study.study import Study
from .summary import dampings, number_and_unit, plain_table, times, worst_words

__all__ = ["show_design", "show_ranking"]

WORDS = {"solved": "[bold green]solved[/]", "infeasible": "[bold red]infeasible[/]", "failed": "[bold red]failed[/]"}


AMPLE = 1.0
"""Margin of safety beyond which a part is not named."""


def show_design(console: Console, result: DesignResult, study: Study) -> None:
    """One result: mass, design, constraints, proof and what it covers."""
    console.print(
        f"\n{WORDS[result.status]}: {escape(result.study)}, {result.topology} ({result.geometry}), {escape(result.material)}"
    )
    mass, worst, certificate, check = result.mass, result.stability, result.certificate, result.verification
    if mass is None or worst is None or certificate is None or check is None:
        console.print(escape(result.message), soft_wrap=True)
        _show_stock(console, result.stock)
        return
    parts = ", ".join(f"{name} {m:.2f}" for name, m in mass.parts.items())
    console.print(f"[bold]{mass.total:.3f} kg[/] = {parts}")
    for said in result.completed:
        console.print(f"[yellow]This is {escape(said)}[/]", soft_wrap=True)
    table = plain_table("design variable", "value", "unit")
    for name, value in (result.design | result.derived).items():
        table.add_row(name, *number_and_unit(value, unit_of_name(name, result.units)))
    console.print(table)
    _show_stock(console, result.stock)
    table = plain_table("constraint", "value", "limit", "unit", "kg per unit of the limit")
    for c in result.constraints:
        style = "bold" if c.active else "dim"
        price = f"{c.shadow_price:.3g}" if c.active else ""
        table.add_row(c.name, f"{c.value:.5g}", f"{c.sense} {c.limit:.5g}", c.unit, price, style=style)
    console.print(table)
    _show_loads(console, result)
    console.print(worst_words(worst, certificate))
    for proof, off in ((certificate, ""), (result.fail_safe, ", actuator off")):
        if proof is None:
            continue
        proved = "[green]proved[/]" if proof.proved else "[red]NOT proved[/]"
        loads = f"{' to ' if proof.over_a_range else ', '}".join(f"{load / 1e3:g}" for load in proof.loads)
        console.print(
            f"Exact certificate{off}: {proved}: margin {proof.margin:g} 1/s at every speed from {proof.speed[0]:g} to "
            f"{proof.speed[1]:g} m/s, {loads} kN{dampings(proof)}",
            soft_wrap=True,
        )
    console.print(escape(next(iter(result.covers or covers(study)))), soft_wrap=True)
    console.print(
        f"Eigenvalues on {check.grid_speeds} x {check.grid_loads} points: worst {check.worst.abscissa:.6f} 1/s; "
        f"KKT residual {check.kkt_residual:.1g}; {check.agreeing_starts} of {len(result.starts)} starts end here",
        soft_wrap=True,
    )
    if result.bound is not None:
        console.print(escape(bound_words(result.bound)), soft_wrap=True)
    if result.decay is not None:
        decay = result.decay
        verdict = "[green]kept[/]" if decay.passed else "[red]NOT kept[/]"
        console.print(
            f"Decay: {verdict}: {decay.ratio:.5f} of the first amplitude after {decay.cycles} cycles at {decay.speed:.2f} m/s, "
            f"{decay.load / 1e3:g} kN{times(decay.damping, certificate)}, the worst of {decay.simulations} exact simulations; "
            f"required {decay.limit:.5f}"
            f"; optimised with {decay.engine}",
            soft_wrap=True,
        )
    if result.limit_cycle is not None:
        cycle = result.limit_cycle
        verdict = "[green]kept[/]" if cycle.passed else "[red]NOT kept[/]"
        largest = " ".join(number_and_unit(cycle.yaw_angle, "rad")) if cycle.yaw_angle else "none"
        console.print(
            f"Limit cycles: {verdict}: largest stable one {largest} at {cycle.speed:.2f} m/s, {cycle.load / 1e3:g} kN, with "
            f"{1e3 * cycle.gap:g} mm of play, on {cycle.branches} branches from motions, {cycle.lost} lost, "
            f"{cycle.left} motions left the model; required "
            f"{' '.join(number_and_unit(cycle.limit, 'rad'))}; a search, no proof",
            soft_wrap=True,
        )
    if result.decided_by:
        kinds = ", ".join(f"{kind} {weight:.2g} %" for kind, weight in result.decided_by.items())
        console.print(f"What decides the mass, per 1 % of the limits: {kinds}", soft_wrap=True)
    others = [f"{o.mass:.3f} kg ({o.starts})" for o in result.local_optima[1:]]
    if others:
        console.print(f"Other local optima (starts): {', '.join(others)}", soft_wrap=True)
    top = [s for s in result.sensitivities if s.value != 0][:5]
    console.print("Mass per +1 % of: " + ", ".join(f"{s.input} {s.elasticity:+.2f} %" for s in top), soft_wrap=True)
    for flag in result.implausible:
        console.print(f"[yellow]Not usual[/]: {escape(flag)}", soft_wrap=True)
    console.print("Not checked: " + escape("; ".join(result.not_checked)), soft_wrap=True, style="dim")
    if result.status == "failed":
        console.print(f"[bold red]{escape(result.message)}[/]", soft_wrap=True)


def _show_loads(console: Console, result: DesignResult) -> None:
    """The load case that sizes, and the critical margin of safety of each part."""
    for row in result.loads:
        if row.sizing:
            forces = f"yaw torque {row.yaw_torque / 1e3:.4g} kN m, {row.apex_force / 1e3:.4g} kN at the apex"
            console.print(f"Sizing load case: {escape(row.case)} ({escape(row.rule)}): {forces}", soft_wrap=True)
    if result.margins:
        critical = critical_rows(result.margins)
        least = "; ".join(f"{m.part} {margin_words(m)}" for m in critical if m.value < AMPLE)
        rest = f"; of all other parts above {AMPLE:+g}" if critical[-1].value >= AMPLE else ""
        console.print(f"Least margins of safety: {escape(least)}{rest}", soft_wrap=True)
        console.print(escape("; ".join(result.rests_on)), soft_wrap=True, style="dim")


SHOWN_CANDIDATES = 8
"""Rows of sizes that exist; result.json and the report have all."""


def _show_stock(console: Console, stock: StockResult | None) -> None:
    """Sizes that exist: what was chosen, what it costs, and what became of the others."""
    if stock is None:
        return
    console.print(escape(stock_words(stock)), soft_wrap=True)
    for row in stock.candidates[:SHOWN_CANDIDATES]:
        sizes, mass, outcome = candidate_cells(row)
        line = f"{mass or '-':>10}  {sizes}: {outcome}"
        console.print(escape(line), soft_wrap=True, style="bold" if row.outcome == "chosen" else "dim")
    if (more := len(stock.candidates) - SHOWN_CANDIDATES) > 0:
        console.print(f"and {more} more in result.json", style="dim")


def show_ranking(console: Console, results: Sequence[DesignResult]) -> None:
    """Combinations at equal margins, the lightest first."""
    table = plain_table("", "topology", "material", "mass, kg", "status", "decided by")
    for position, result in enumerate(results, 1):
        mass = f"{result.mass.total:.3f}" if result.mass else ""
        active = ", ".join(c.name for c in result.constraints if c.active)
        table.add_row(str(position), result.topology, escape(result.material), mass, WORDS[result.status], active)
    console.print(table)
    for result in results:
        if result.status != "solved":
            console.print(f"{result.topology}, {escape(result.material)}: {escape(result.message)}", soft_wrap=True)

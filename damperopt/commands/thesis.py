"""Figures and claims of the thesis."""

from __future__ import annotations

from .shared import OutputOption, all_or_nothing, bar, out

__all__ = ["thesis"]


def thesis(output: OutputOption = None) -> None:
    """Draw the figures of C. Arreaza's thesis, and put what its text says of them to the numbers."""
    from ..literature.arreaza2015 import Row, panels, thesis_gear, write_thesis
    from ..output.folder import run_folder, write_run
    from ..workers import cores, executor
    from . import summary

    study = thesis_gear()
    folder = run_folder(output, "thesis")
    rows: list[Row] = []
    with all_or_nothing(), bar() as shown, executor(cores()) as pool:
        task = shown.add_task("figures", total=len(panels()))

        def on_panel(number: str) -> None:
            shown.update(task, advance=1, description=f"figure {number}")

        write_run(folder, lambda place: rows.extend(write_thesis(place, study, pool, on_panel)), hold=False)
    summary.show_claims(out, rows)
    out.print(f"\nOpen {folder / 'index.html'}", soft_wrap=True, markup=False)

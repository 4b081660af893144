"""Which layout is the lightest, and which choices reverse it: the thesis' statement on the true structure, at equal margin.

    python benchmarks/ranking.py [--only 'hinge width']

The study is main_gear.yaml: linkage in space, every sized part elastic, loads of 14 CFR 25, 0.1 1/s and the damping ratio of
the yaw mode. Not its own: no decay in time, 2 starts, and the contact line `leading_point`, all for speed; each answer is
held against contact memory afterwards. One choice at a time is changed from the base.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import damperopt

STUDY = Path(__file__).parents[1] / "configs" / "main_gear.yaml"
LAYOUTS = ("boeing", "utas", "arreaza")
SIMPLER = {"requirements__decay": None, "solver__starts": 2, "tyre__contact": "leading_point"}
ARMS, SUPPORTED = ("utas", "arreaza"), ("arreaza",)
I_SECTION = {"family": "i_section", "thickness_ratio": 0.1, "aspect_ratio": 2.0}
MEMORY: dict[str, Any] = {"tyre__contact": "memory", "solver__starts": 1}
CHOICES: dict[str, tuple[tuple[str, ...], dict[str, Any]]] = {  # name: the layouts that it concerns, what it changes
    "base": (LAYOUTS, {}),
    "material 300M": (LAYOUTS, {"material": "300M"}),
    "material Ti-6Al-4V": (LAYOUTS, {"material": "Ti-6Al-4V"}),
    "links cantilever": (LAYOUTS, {"damper__links__form": "cantilever"}),
    "support cantilever on the hinge line": (SUPPORTED, {"damper__support__form": "cantilever"}),
    "support cantilever on the strut": (SUPPORTED, {"damper__support": {"form": "cantilever", "root": "strut"}}),
    "hinge width 0.15 m": (LAYOUTS, {"damper__links__hinge_width": 0.15}),
    "hinge width 0.25 m": (LAYOUTS, {"damper__links__hinge_width": 0.25}),
    "hinge width 0.35 m": (LAYOUTS, {"damper__links__hinge_width": 0.35}),
    "hinges held on the axis": (LAYOUTS, {"damper__links": {"form": "a_frame"}}),
    "strut 0.2 m wide": (LAYOUTS, {"damper__links__strut_width": 0.2}),
    "arm i_section": (ARMS, {"mass__arm_section": I_SECTION}),
    "lower_lug_height 0.25 m": (LAYOUTS, {"mass__lower_lug_height": 0.25}),
    "links and support cantilever": (
        LAYOUTS,
        {"damper__links__form": "cantilever", "damper__support__form": "cantilever"},
    ),
    "contact memory": (LAYOUTS, MEMORY),
    "contact memory, lower_lug_height 0.25 m": (LAYOUTS, MEMORY | {"mass__lower_lug_height": 0.25}),
    "planar and rigid, as the thesis": (LAYOUTS, {"damper__geometry": "planar", "damper__compliance": "rigid"}),
}
EVEN = 2.0
"""Difference of two masses that is none, in per cent: contact memory moves those of the base by as much."""
STATEMENTS = {
    "arreaza lighter than utas": ("arreaza", "utas"),
    "arreaza lighter than boeing": ("arreaza", "boeing"),
    "utas lighter than boeing": ("utas", "boeing"),
}
Masses = Mapping[str, float]


def study_of(layout: str, changes: Mapping[str, Any]) -> damperopt.Study:
    """The study of a layout under one choice; a layout without a support ignores that block."""
    base = damperopt.load(STUDY)
    return base.replace(damper__topology=layout, **(SIMPLER | dict(changes)))


def with_memory(study: damperopt.Study, design: Mapping[str, float]) -> float:
    """Largest real part over the envelope with contact memory [1/s]."""
    gear = damperopt.linear_gear(study.replace(tyre__contact="memory"), design)
    return damperopt.worst_points(gear, study.envelope)[0].abscissa


def cell(layout: str, changes: Mapping[str, Any]) -> tuple[float | None, str]:
    """Mass [kg], and what the table shows of one optimum."""
    study = study_of(layout, changes)
    result = damperopt.optimise(study)
    if result.status != "solved" or result.mass is None:
        return None, result.status
    worst = with_memory(study, result.design)
    kept = worst <= -study.required.stability_margin
    return result.mass.total, f"{result.mass.total:.2f}" + ("" if kept else f" ({worst:+.2f})")


def masses_of(names: list[str]) -> Iterator[tuple[str, Masses]]:
    """Of each choice, printed as a row; a layout that a choice does not concern keeps its mass of the base."""
    base: dict[str, float] = {}
    for name in names:
        layouts, changes = CHOICES[name]
        found, shown = dict(base), []
        clock = time.process_time()
        for layout in LAYOUTS:
            if layout not in layouts:
                shown.append("as base")
                continue
            mass, words = cell(layout, changes)
            found.pop(layout, None)
            if mass is not None:
                found[layout] = mass
            shown.append(words)
        base = base or found
        order = " < ".join(sorted(found, key=found.__getitem__))
        print(f"| {name} | {' | '.join(shown)} | {order} | {time.process_time() - clock:.0f} |", flush=True)
        yield name, found


def verdict(lighter: str, heavier: str, masses: Masses) -> str:
    """Whether a statement holds, and by how much."""
    if lighter not in masses or heavier not in masses:
        return "no answer"
    share = 100 * (masses[lighter] / masses[heavier] - 1)
    word = "even" if abs(share) < EVEN else "holds" if share < 0 else "fails"
    return f"{word} ({share:+.1f} %)"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="choices whose name contains this, beside the base")
    only = parser.parse_args().only
    names = [name for name in CHOICES if name == "base" or only in name]
    print("Masses [kg]; in brackets the largest real part with contact memory [1/s] where it misses the margin.\n")
    print(f"| choice | {' | '.join(LAYOUTS)} | order | CPU [s] |\n|---|{'---|' * len(LAYOUTS)}---|---|")
    rows = dict(masses_of(names))
    print(f"\n| choice | {' | '.join(STATEMENTS)} |\n|---|{'---|' * len(STATEMENTS)}")
    for name, masses in rows.items():
        print(f"| {name} | {' | '.join(verdict(*pair, masses) for pair in STATEMENTS.values())} |")


if __name__ == "__main__":
    main()

"""The lightest design of sizes that exist: branch and bound over tubes, bores and dampers, the continuous rest solved inside.

A box of choices is one damper (a bore, or a row of a catalogue) and for each part a run of tubes, in the order of the number
that the optimiser knows of them: the area of a leg, the second moment of area of what bends. Its bound is the optimum with that
number free between the ends of the run, and the wall free between the thinnest and the thickest of it. The box with the least
bound is split next, at its own optimum; one that holds a single choice is solved as it is, and proved when nothing is left that
could be lighter. Bounds are local optima, from the optimum of the box around and from the study's own start.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import count
from typing import Any

from .. import interrupts
from ..answers.stock import StockCandidate, StockResult
from ..errors import ConfigError
from ..results import DesignResult, Infeasibility
from ..strength.stock import Tube, tubes
from ..study.study import Study
from .answer import missing_words, nothing_yet
from .diagnose import diagnose
from .exchange import EnvelopeSolution, first_points
from .local import best_local
from .problem import DesignProblem
from .solve import NlpSolver

__all__ = ["StockSearch", "of_chosen_sizes", "of_stock"]

SECTIONS = {
    "A_link": ("torque links", "link_section"),
    "I_link": ("torque links", "link_section"),
    "A_support": ("support", "support_section"),
    "I_support": ("support", "support_section"),
    "I_arm": ("bending arm", "arm_section"),
}
"""Parts that can be made of tubes, by their design variable: name, and section of the mass model."""

MOST_SOLVED = 2000
"""Optima after which the search gives up."""

OF_DAMPERS = ("largest_force", "usable_stroke", "piston_pressure", "damper_length", "apex_room")
"""Constraints that another damper would meet: looked at first where there is no design."""

EXPLAINED = 12
"""Dampers for which the least relaxation is looked for where there is no design; it takes seconds for each."""

BOUNDS = (
    "bounds of sizes judged together are local optima, from two starts each: a lighter choice in another basin would be missed"
)


def of_chosen_sizes(study: Study, result: DesignResult) -> Study:
    """The study with the sizes that a result has chosen, and no others; the study itself where it has none."""
    if result.stock is None or not result.stock.changes:
        return study
    changes = {path.replace(".", "__"): value for path, value in result.stock.changes.items()}
    return study.replace(available=None, catalogue=None, **changes)


@dataclass(frozen=True)
class _Damper:
    """A damper that can be had: its name, and the changes of the study that fit it."""

    name: str = ""
    changes: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class _Box:
    """Choices that are judged together: one damper, and for each part, by its variable, a run of tubes."""

    damper: _Damper
    runs: Mapping[str, tuple[Tube, ...]]

    @property
    def combinations(self) -> int:
        return math.prod(map(len, self.runs.values()))

    @property
    def parts(self) -> dict[str, str]:
        """What each part is made of, in words."""
        made = {SECTIONS[name][0]: _words(run) for name, run in self.runs.items()}
        return made | ({"damper": self.damper.name} if self.damper.name else {})

    @property
    def walls(self) -> dict[str, tuple[float, float]]:
        """Sections whose walls are open, and between what."""
        ratios = {name: [tube.wall / tube.diameter for tube in run] for name, run in self.runs.items() if len(run) > 1}
        return {SECTIONS[name][1]: (min(r), max(r)) for name, r in ratios.items() if min(r) < max(r)}

    def changes(self) -> dict[str, Any]:
        """Of a study, by key path, that put the box into it."""
        found: dict[str, Any] = dict(self.damper.changes)
        for name, run in self.runs.items():
            low, high = _number(name, run[0]), _number(name, run[-1])
            found[f"design.{name}"] = {"start": math.sqrt(low * high), "min": low, "max": high} if low < high else low
            found[f"mass.{SECTIONS[name][1]}"] = run[0].section.model_dump(exclude_none=True)
        return found

    def split(self, design: Mapping[str, float]) -> list[_Box]:
        """In two, at the number that the optimum has for the part whose run is the widest."""
        widest = max(self.runs, key=lambda name: (_spread(name, self.runs[name]), len(self.runs[name])))
        run = self.runs[widest]
        below = sum(_number(widest, tube) <= design[widest] for tube in run)
        at = below if 0 < below < len(run) else len(run) // 2
        return [_Box(self.damper, {**self.runs, widest: half}) for half in (run[:at], run[at:])]


def _number(variable: str, tube: Tube) -> float:
    """What the optimiser knows of a tube."""
    return tube.area if variable.startswith("A_") else tube.inertia


def _spread(variable: str, run: Sequence[Tube]) -> float:
    return _number(variable, run[-1]) / _number(variable, run[0]) if len(run) > 1 else 0.0


def _words(run: Sequence[Tube]) -> str:
    if len(run) == 1:
        return str(run[0])
    ends = [f"{1e3 * min(sizes):g} to {1e3 * max(sizes):g}" for sizes in ([t.diameter for t in run], [t.wall for t in run])]
    return f"{' x '.join(ends)} mm ({len(run)})"


class StockSearch:
    """Search for the lightest design of sizes that exist.

    Parameters
    ----------
    study : Study
        With `available`, `catalogue` or both.
    prove : callable
        (solver, found) -> result of an optimum, with its proof and its checks.
    """

    def __init__(self, study: Study, prove: Callable[[NlpSolver, EnvelopeSolution], DesignResult]):
        self._study = study.replace(available=None, catalogue=None, solver__starts=1)
        self._prove = prove
        self._rows: list[StockCandidate] = []
        self._open: list[tuple[float, int, _Box, EnvelopeSolution]] = []
        self._order, self._solved = count(), 0
        self._left_out = [BOUNDS]
        runs = self._runs(study)
        self._boxes = [_Box(damper, runs) for damper in self._dampers(study)]
        self.answer: DesignResult | None = None
        self._chosen: _Box | None = None

    def _runs(self, study: Study) -> dict[str, tuple[Tube, ...]]:
        """Tubes of each part that can be made of one, within the bounds of its variable."""
        stock = study.available
        if stock is None or not stock.walls:
            return {}
        found = {}
        for name in (name for name in study.variable_names if name in SECTIONS):
            part, section = SECTIONS[name]
            if getattr(study.mass, section).family != "tube":
                self._left_out.append(f"the {part} of mass.{section} are no tubes, and of any size")
                continue
            bounds, every = study.variable(name), tubes(stock.tube_diameters, stock.walls)
            run = [tube for tube in every if bounds.min <= _number(name, tube) <= bounds.max]
            if not run:
                raise ConfigError(
                    f"{study.name}: available: no tube for the {part}, design.{name} from {bounds.min:.4g} to "
                    f"{bounds.max:.4g}; allowed: diameters and walls with one"
                )
            found[name] = tuple(sorted(run, key=lambda tube: (_number(name, tube), tube.diameter)))
        known = {SECTIONS[name][1] for name in study.variable_names if name in SECTIONS}
        members = [member for member in study.damper.members(study.start) if member.section and member.section not in known]
        if any(member.section == "hinge_section" for member in members):
            self._left_out.append("tubes for the beams of hinges: they are of one piece with the strut, and of any size")
        others = {member.part for member in members if member.section != "hinge_section"}
        self._left_out += [
            f"tubes for the {part}: without a compliance of its own its section is no choice" for part in sorted(others)
        ]
        return found

    def _dampers(self, study: Study) -> list[_Damper]:
        """Rows of the catalogue, or bores; neither: the damper as it is."""
        bores = [] if study.available is None else study.available.bores
        if study.catalogue is not None:
            if bores:
                self._left_out.append("bores: the damper is bought")
            return [_Damper(row.name, {"damper": _bought(study, row)}) for row in study.catalogue]
        if not bores:
            return [_Damper()]
        if "bore" not in type(study.damper).model_fields:
            self._left_out.append(f"bores: a damper of kind '{study.damper.kind}' takes none")
            return [_Damper()]
        if study.damper.bore is not None:
            self._left_out.append("bores: damper.bore gives one")
            return [_Damper()]
        return [_Damper(f"bore {1e3 * bore:g} mm", {"damper.bore": bore}) for bore in sorted(bores)]

    def run(self, start: Mapping[str, float]) -> None:
        """Until the lightest choice is proved, or nothing is left; an interrupt leaves what is known so far to `record`.

        Parameters
        ----------
        start : mapping
            The continuous optimum, or another design [SI].
        """
        for box in self._boxes:
            self._solve(box, start, (), explained=len(self._boxes) <= EXPLAINED)
        while self._open and self._solved < MOST_SOLVED:
            bound, _, box, found = self._open[0]
            if box.combinations > 1:
                for half in box.split(found.solution.design):
                    self._solve(half, found.solution.design, found.solution.points)
                self._drop(box)
                continue
            result = self._proved(box, found)
            self._drop(box)
            if result.status == "solved":
                self.answer, self._chosen = result, box
                return
            self._rows.append(StockCandidate(box.parts, 1, "not proved", bound, result.message))

    def _drop(self, box: _Box) -> None:
        self._open = [entry for entry in self._open if entry[2] is not box]
        heapq.heapify(self._open)

    def _solve(
        self, box: _Box, start: Mapping[str, float], points: Sequence[tuple[float, ...]], explained: bool = False
    ) -> None:
        """Bound of a box, or why it has no design."""
        try:
            solver = self._solver(box)
        except ConfigError as error:
            self._rows.append(StockCandidate(box.parts, box.combinations, "no design", None, "; ".join(error.problems)))
            return
        self._solved += 1
        own = solver.problem.study.start
        for design in ({name: start.get(name, value) for name, value in own.items()}, own):
            found = best_local(solver, design, points or first_points(solver))
            if found.solved:
                heapq.heappush(self._open, (found.solution.objective, next(self._order), box, found))
                return
        why = f"no design found from two starts ({found.solution.status})"
        if explained:
            why = _lacking(solver, own) or why
        self._rows.append(StockCandidate(box.parts, box.combinations, "no design", None, why))

    def _solver(self, box: _Box) -> NlpSolver:
        changes = {path.replace(".", "__"): value for path, value in box.changes().items()}
        return NlpSolver(DesignProblem(self._study.replace(**changes), box.walls))

    def _proved(self, box: _Box, found: EnvelopeSolution) -> DesignResult:
        return self._prove(self._solver(box), found)

    def record(self, continuous_mass: float | None, finished: bool) -> StockResult:
        """What is known.

        Parameters
        ----------
        continuous_mass : float or None
            Of the optimum with any size [kg].
        finished : bool
            Whether `run` has come to its end.
        """
        heavier = [StockCandidate(box.parts, box.combinations, "heavier", bound) for bound, _, box, _ in self._open]
        rows, mass = sorted([*self._rows, *heavier], key=lambda row: math.inf if row.mass is None else row.mass), None
        if self._chosen is not None and self.answer is not None and self.answer.mass is not None:
            mass = self.answer.mass.total
            rows.insert(0, StockCandidate(self._chosen.parts, 1, "chosen", mass))
        chosen = self._chosen
        return StockResult(
            continuous_mass,
            None if mass is None or continuous_mass is None else mass - continuous_mass,
            {} if chosen is None else chosen.parts,
            {} if chosen is None else chosen.changes(),
            tuple(rows),
            sum(box.combinations for box in self._boxes),
            self._solved,
            finished and (chosen is not None or not self._open),
            tuple(self._left_out),
        )

    @property
    def idle(self) -> bool:
        """Whether no part of the study is made of what the lists have."""
        return not any(box.parts for box in self._boxes)


def _lacking(solver: NlpSolver, start: Mapping[str, float]) -> str:
    """What a damper would have to have for a design; where that is not enough, what else."""
    names = solver.problem.constraint_names
    for among in ([name for name in names if name in OF_DAMPERS], names):
        missing = diagnose(solver, [start], among).infeasibility if among else None
        if missing is not None:
            return missing_words(missing.shortfalls)
    return ""


def _bought(study: Study, row: Any) -> dict[str, Any]:
    """The block `damper` of a study with a row of its catalogue in the place of its damper."""
    layout = {key for key in type(study.damper).model_fields if key not in study.damper.KIND.model_fields}
    block = study.damper.model_dump(exclude_none=True, include=layout | set(study.damper.LAYOUT.model_fields))
    if not isinstance(block.get("compliance", {}).get("damper", ""), str):
        block["compliance"]["damper"] = "sized"  # the row brings its own
    return {**block, "kind": "bought", "row": row.model_dump()}


def of_stock(study: Study, search: StockSearch, continuous: DesignResult) -> tuple[DesignResult, bool]:
    """The lightest design of sizes that exist.

    Parameters
    ----------
    study : Study
    search : StockSearch
        Not yet run.
    continuous : DesignResult
        The optimum of any size.

    Returns
    -------
    tuple
        (result, whether the search was interrupted; the optimum of any size then stands).
    """
    mass, stopped = None if continuous.mass is None else continuous.mass.total, False
    if search.idle:
        return continuous.model_copy(update={"stock": search.record(mass, finished=True)}), False
    interrupts.begin()
    try:
        search.run(continuous.design or study.start)
    except KeyboardInterrupt:
        interrupts.answered()
        stopped = True
    stock = search.record(mass, finished=not stopped)
    if search.answer is not None:
        beside = "" if stock.price is None else f", {stock.price:+.3g} kg beside the optimum of any size"
        message = f"of sizes that exist{beside}: {search.answer.message}"
        return search.answer.model_copy(update={"stock": stock, "message": message}), False
    if stopped:
        message = f"interrupted before a design of sizes that exist was proved; of any size: {continuous.message}"
        return continuous.model_copy(update={"stock": stock, "message": message}), True
    failed = not stock.finished or any(row.outcome == "not proved" for row in stock.candidates)
    message = f"no design of sizes that exist was found; of any size: {continuous.message}"
    found = nothing_yet(study).model_copy(update={"message": message, "stock": stock, "starts": continuous.starts})
    if failed:
        return found, False
    nothing = Infeasibility(shortfalls=(), alone_enough=())
    return found.model_copy(update={"status": "infeasible", "infeasibility": nothing}), False

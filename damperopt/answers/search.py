"""Rows of a result on the search: its starts and optima, what the mass depends on, what stands in the way of a design."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict

__all__ = ["Infeasibility", "LocalOptimum", "Relaxation", "Sensitivity", "StartResult"]


class _Record(BaseModel):
    model_config = ConfigDict(frozen=True, allow_inf_nan=False, extra="forbid")


class StartResult(_Record):
    """What became of one start: solved or not, mass [kg], rounds of the exchange, program that succeeded."""

    index: int
    solved: bool
    status: str
    mass: float | None
    rounds: int
    form: str
    design: dict[str, float]


class LocalOptimum(_Record):
    """A local optimum and how many starts ended there."""

    mass: float
    starts: int
    design: dict[str, float]


class Sensitivity(_Record):
    """d mass/d input [kg per `unit`], and the change of mass in per cent for one per cent of the input."""

    input: str
    value: float
    unit: str
    derivative: float
    elasticity: float


class Relaxation(_Record):
    """A constraint that gives way: its limit, the limit that would do, and the inputs that move it."""

    name: str
    limit: float
    needed: float
    unit: str
    inputs: tuple[str, ...]
    speed: float | None = None
    load: float | None = None


class Infeasibility(_Record):
    """Why there is no design: the smallest set of shortfalls, and each relaxation that alone would be enough."""

    shortfalls: tuple[Relaxation, ...]
    alone_enough: tuple[Relaxation, ...]

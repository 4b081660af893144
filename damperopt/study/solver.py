"""Numbers of the solution method."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ..quantities.record import Record
from ..quantities.units import Quantity

__all__ = ["Solver"]


class Solver(Record):
    """Numbers of the solution method."""

    starts: Annotated[int, Field(strict=True, ge=1, le=4096)] = 16
    """Starting points: the config's own and Sobol points within the bounds."""
    seed: Annotated[int, Field(strict=True, ge=0)] = 1
    """Of the Sobol points; the same seed gives the same starts."""
    tolerance: Annotated[float, Quantity("1", above=0, at_most=1e-4)] = 1e-8
    """Of IPOPT, in scaled variables."""
    margin_reserve: Annotated[float, Quantity("1/s", above=0, at_most=0.1)] = 1e-6
    """Added to the stability margin while solving, so that the exact proof of the margin itself has room [1/s]."""
    engine: Literal["auto", "erk", "cvodes", "idas"] = "auto"
    """Integrator of the transients; auto: the fastest that this machine offers."""
    integration_tolerance: Annotated[float, Quantity("1", at_least=1e-12, at_most=1e-5)] = 1e-8
    """Of the integrator, relative."""
    decay_reserve: Annotated[float, Quantity("1", above=0, at_most=0.1)] = 1e-4
    """Part of the decay ratio that is kept back while solving, for the exact simulation between the speeds used."""
    decay_speeds: Annotated[int, Field(strict=True, ge=2, le=1000)] = 16
    """Speeds of the search for the worst decay; twice as many verify the result."""
    verification_speeds: Annotated[int, Field(strict=True, ge=2, le=1_000_000)] = 2000
    """Speeds of the grid on which eigenvalues are checked at the end."""
    bound_gap: Annotated[float, Quantity("1", above=0, at_most=1)] = 1e-3
    """Gap between the mass of a design and its lower bound at which the search for the bound ends."""
    bound_seconds: Annotated[float, Quantity("s", at_least=0, at_most=86400)] = 2.0
    """Processor time of that search; 0: no bound is looked for [s]."""

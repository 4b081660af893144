"""Rows of a result on loads: load cases, and margins of safety."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from pydantic import ConfigDict

__all__ = ["LoadRow", "MarginRow"]

_FINITE = ConfigDict(allow_inf_nan=False, extra="forbid")


@dataclass(frozen=True)
class LoadRow:
    """A load case: rule, where it was read, ``limit`` or ``ultimate``, ``static`` or ``dynamic``; forces on the ground [N], the
    yaw torque at limit load [N m], the force at the apex that carries it [N], why it does not count, whether it sizes."""

    __pydantic_config__: ClassVar[ConfigDict] = _FINITE

    case: str
    rule: str
    read: str
    level: str
    nature: str
    vertical: float
    side: float
    drag: float
    yaw_torque: float
    apex_force: float
    off: str
    sizing: bool


@dataclass(frozen=True)
class MarginRow:
    """A margin of safety: allowable/(applied x factor) - 1, of a part, by a check, in a load case, at a level."""

    __pydantic_config__: ClassVar[ConfigDict] = _FINITE

    part: str
    check: str
    case: str
    level: str
    applied: float
    allowable: float
    factor: float
    unit: str
    value: float

"""Versions of the corners for periodic orbits: joints closed, as near rest, or switched, as the motion meets them."""

from __future__ import annotations

from typing import Any

from ..dynamics import build
from ..expressions.corners import Corners, Linear, Smooth, Switched
from ..study.study import Study
from ..symbols import symbolic

__all__ = ["Closed", "Events", "joints_of"]


class Closed(Linear):
    """Tyre and orifice as they are, joints in contact, no friction: for Hopf points and the branches that leave rest there."""

    def magnitude(self, x: Any, width: Any) -> Any:
        """As the smooth version."""
        return Smooth().magnitude(x, width)

    def within(self, name: str, x: Any, limit: Any) -> Any:
        """As the smooth version."""
        return Smooth().within(name, x, limit)


class Events(Switched):
    """Gaps, stops and friction are events; of the orifice and of the slip limit, whose moment has no jump, none is made."""

    def magnitude(self, x: Any, width: Any) -> Any:
        """As the smooth version."""
        return Smooth().magnitude(x, width)

    def within(self, name: str, x: Any, limit: Any) -> Any:
        """As the smooth version."""
        return Smooth().within(name, x, limit)


class _Counted(Closed):
    """Notes which joints a model has."""

    def __init__(self) -> None:
        self.names: list[str] = []

    def sign(self, name: str, x: Any, width: Any) -> Any:
        self.names.append(name)
        return super().sign(name, x, width)

    def gap(self, name: str, x: Any, half_width: Any, width: Any) -> tuple[Any, Any]:
        self.names.append(name)
        return super().gap(name, x, half_width, width)

    def contact(self, name: str, x: Any, limit: Any, width: Any) -> Any:
        self.names.append(name)
        return super().contact(name, x, limit, width)


def joints_of(study: Study) -> tuple[str, ...]:
    """Names of the gaps, stops and frictions of a study's model."""
    corners: Corners = (counted := _Counted())
    build(symbolic(study), corners)
    return tuple(dict.fromkeys(counted.names))

"""Corners of the nonlinear elements: freeplay, stops and dry friction, linear, smooth or switched.

All of them are made of |x| and its slope: a dead band of half-width g is x + (|x - g| - |x + g|)/2, an end stop the same
band in front of a stiff spring, dry friction the slope of |x|. So one choice of |x| decides the version (an orifice, v |v|,
has no corner):

* `Linear` for small motion about rest with the joints in contact: no gap, no stop, no friction.
* `Smooth` for derivatives: |x| = sqrt(x^2 + w^2), with the width w in the configuration.
* `Switched` for an exact simulation: |x| = m x, where m = +-1 is a mode that changes when x passes through zero.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Protocol

from .calculus import absolute, sqrt, symbol

__all__ = ["Corners", "Linear", "Smooth", "Switch", "Switched"]


class Corners(Protocol):
    """How |x| is written."""

    def magnitude(self, x: Any, width: Any) -> Any:
        """|x| where it is multiplied by x: no corner."""

    def sign(self, name: str, x: Any, width: Any) -> Any:
        """Slope of |x|."""

    def gap(self, name: str, x: Any, half_width: Any, width: Any) -> tuple[Any, Any]:
        """Motion beyond a gap, and its slope."""

    def contact(self, name: str, x: Any, limit: Any, width: Any) -> Any:
        """Motion beyond a stop at +-limit."""

    def within(self, name: str, x: Any, limit: Any) -> Any:
        """1 where |x| <= limit, else 0."""


class Linear:
    """Small motion about rest, joints in contact."""

    def magnitude(self, x: Any, width: Any) -> Any:
        return 0

    def sign(self, name: str, x: Any, width: Any) -> Any:
        return 0

    def gap(self, name: str, x: Any, half_width: Any, width: Any) -> tuple[Any, Any]:
        return x, 1

    def contact(self, name: str, x: Any, limit: Any, width: Any) -> Any:
        return 0

    def within(self, name: str, x: Any, limit: Any) -> Any:
        return 1


class _Cornered:
    """Dead bands out of |x| and its slope; `Smooth` and `Switched` say what these two are."""

    def absolute(self, name: str, x: Any, width: Any) -> Any:
        raise NotImplementedError  # both versions have one of their own: rounded, or with a switch

    def sign(self, name: str, x: Any, width: Any) -> Any:
        raise NotImplementedError  # as above

    def gap(self, name: str, x: Any, half_width: Any, width: Any) -> tuple[Any, Any]:
        upper, lower = (f"{name} +", x - half_width, width), (f"{name} -", x + half_width, width)
        beyond = x + (self.absolute(*upper) - self.absolute(*lower)) / 2
        return beyond, 1 + (self.sign(*upper) - self.sign(*lower)) / 2

    def contact(self, name: str, x: Any, limit: Any, width: Any) -> Any:
        return self.gap(name, x, limit, width)[0]


class Smooth(_Cornered):
    """|x| = sqrt(x^2 + w^2)."""

    def magnitude(self, x: Any, width: Any) -> Any:
        return self.absolute("", x, width)

    def absolute(self, name: str, x: Any, width: Any) -> Any:
        return sqrt(x**2 + width**2)

    def sign(self, name: str, x: Any, width: Any) -> Any:
        return x / sqrt(x**2 + width**2)

    def within(self, name: str, x: Any, limit: Any) -> Any:
        return absolute(x) <= limit


@dataclass(frozen=True)
class Switch:
    """A mode symbol that is +1 where `argument` > 0 and -1 where it is < 0."""

    name: str
    argument: Any
    mode: Any


@dataclass
class Switched(_Cornered):
    """|x| = m x with a mode m for each corner, collected in `switches`."""

    switches: dict[str, Switch] = field(default_factory=dict)

    def magnitude(self, x: Any, width: Any) -> Any:
        return absolute(x)

    def sign(self, name: str, x: Any, width: Any) -> Any:
        if name not in self.switches:
            self.switches[name] = Switch(name, x, symbol(name))
        return self.switches[name].mode

    def absolute(self, name: str, x: Any, width: Any) -> Any:
        return self.sign(name, x, width) * x

    def within(self, name: str, x: Any, limit: Any) -> Any:
        return (self.sign(f"{name} -", x + limit, 0) - self.sign(f"{name} +", x - limit, 0)) / 2

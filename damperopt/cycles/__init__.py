"""Limit cycles of a gear: orbits by collocation, their stability, branches over any number of a study, hidden shimmy."""

from __future__ import annotations

__all__: list[str] = []

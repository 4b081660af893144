"""Dampers: the force along a stroke, and the parts that carry it."""

from __future__ import annotations

__all__: list[str] = []

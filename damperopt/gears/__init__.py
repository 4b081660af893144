"""Gears: the motion of the strut, and the wheels that it carries."""

from __future__ import annotations

__all__: list[str] = []

"""Contact lines: how the string of a tyre meets the ground."""

from __future__ import annotations

__all__: list[str] = []

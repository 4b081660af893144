"""The design problem and its solution."""

from __future__ import annotations

__all__: list[str] = []

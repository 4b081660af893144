"""A plane of two quantities: boundaries of stability, explicit and traced, and filled maps."""

from __future__ import annotations

__all__: list[str] = []

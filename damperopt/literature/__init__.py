"""Published works, a folder each: their printed formulas, figures and claims."""

from __future__ import annotations

__all__: list[str] = []

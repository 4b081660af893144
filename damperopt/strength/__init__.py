"""Materials, sections, and what sizes the parts."""

from __future__ import annotations

__all__: list[str] = []

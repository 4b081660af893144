"""Units at the border, the base of all records, named quantities, kinds of components."""

from __future__ import annotations

__all__: list[str] = []

"""Records that pass between gears, tyres, dampers and linkages."""

from __future__ import annotations

__all__: list[str] = []

"""Transients: integrators, exact simulation, decay."""

from __future__ import annotations

__all__: list[str] = []

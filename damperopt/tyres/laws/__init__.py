"""Slip laws: side force and aligning moment of a slip angle at a load and a pressure."""

from __future__ import annotations

__all__: list[str] = []

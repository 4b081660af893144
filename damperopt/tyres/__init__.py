"""Tyres: how the string meets the ground, and what a slip angle makes of it."""

from __future__ import annotations

__all__: list[str] = []

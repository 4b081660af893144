"""Tyres: a contact line says how the string meets the ground, a slip law what a slip angle makes of it."""

from __future__ import annotations

__all__: list[str] = []

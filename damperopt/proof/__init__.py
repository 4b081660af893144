"""Checks that share no code with the claim."""

from __future__ import annotations

__all__: list[str] = []

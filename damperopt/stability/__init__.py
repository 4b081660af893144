"""The linear gear: Routh-Hurwitz, critical speeds, worst points, modes."""

from __future__ import annotations

__all__: list[str] = []

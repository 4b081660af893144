"""Functions of the equations, corners, the system of equations, and walks over its graph."""

from __future__ import annotations

__all__: list[str] = []

"""Layouts of the shimmy damper: from the yaw angle to the stroke, and back to a torque."""

from __future__ import annotations

__all__: list[str] = []

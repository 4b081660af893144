"""Load cases of ground handling, landing and shimmy: forces at the ground and the yaw torque that they make."""

from __future__ import annotations

__all__: list[str] = []

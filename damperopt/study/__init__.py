"""The question: records of a study, and the YAML file that they come from."""

from __future__ import annotations

__all__: list[str] = []

"""What a result is made of: verdicts, loads and margins, the search, sizes that exist, older versions."""

from __future__ import annotations

__all__: list[str] = []

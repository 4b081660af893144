"""A design on one page: what was asked, the answer, why, and what was not checked."""

from __future__ import annotations

from .page import report_of, write_report

__all__ = ["report_of", "write_report"]

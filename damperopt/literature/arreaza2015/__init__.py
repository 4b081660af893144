"""C. Arreaza's thesis (Toronto, 2015): its stability charts and responses, and what its text says of them."""

from __future__ import annotations

from .charts import FIGURES, FORMS, ThesisFigure, needed_damping, thesis_gear, trace_figure
from .claims import CHART_CLAIMS, Claim, Verdict
from .page import RESPONSE_FORMS, Row, judge, panels, write_thesis
from .response_claims import RESPONSE_CLAIMS
from .responses import RESPONSES, Response, ThesisResponse, respond

__all__ = [
    "CHART_CLAIMS",
    "FIGURES",
    "FORMS",
    "RESPONSES",
    "RESPONSE_CLAIMS",
    "RESPONSE_FORMS",
    "Claim",
    "Response",
    "Row",
    "ThesisFigure",
    "ThesisResponse",
    "Verdict",
    "judge",
    "needed_damping",
    "panels",
    "respond",
    "thesis_gear",
    "trace_figure",
    "write_thesis",
]

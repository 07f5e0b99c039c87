"""Reading charts, and patterns to begin with."""

from __future__ import annotations

from fastapi import APIRouter

from app.operations.charts import ParsedChart, ParseRequest, parse_chart
from app.operations.patterns import Patterns, list_patterns

router = APIRouter(tags=["charts"])


@router.post("/charts/parse", summary="Read a chart text and find its repeat")
def post_parse(request: ParseRequest) -> ParsedChart:
    """K/P lines, the top row first; errors name line and stitch."""
    return parse_chart(request)


@router.get("/patterns", summary="Named patterns")
def get_patterns() -> Patterns:
    """Repeats to begin with: the four fabrics, ribs, basket, moss, diamonds."""
    return list_patterns()

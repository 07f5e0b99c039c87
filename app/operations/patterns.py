"""Named patterns to start from."""

from __future__ import annotations

from pydantic import Field

from app.models.base import NoRequest, ResultModel
from app.operations.context import Context
from app.operations.registry import Operation
from knitcore import patterns as library


class PatternResult(ResultModel):
    """A repeat with a name."""

    id: str
    name: str
    chart: str = Field(description="K/P lines of one repeat, the top row first.")
    note: str


class Patterns(ResultModel):
    """All named patterns."""

    patterns: list[PatternResult]


def patterns(request: NoRequest, context: Context) -> Patterns:
    """Repeats to start from: the four fabrics, ribs, basket and more, and those of extensions."""
    del request, context
    return Patterns(
        patterns=[
            PatternResult.of(p, id=p.identifier, chart=p.chart.text) for p in library.patterns()
        ]
    )


OPERATION = Operation(
    patterns,
    method="GET",
    tag="charts",
    summary="Named patterns",
)

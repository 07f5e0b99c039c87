"""Named patterns to start from."""

from __future__ import annotations

from app.context import Context
from app.models.base import NoRequest, ResultModel
from app.models.charts import RepeatText
from app.operations.registry import Operation
from knitcore.chart.patterns import PATTERNS


class PatternResult(ResultModel):
    """A repeat with a name."""

    id: str
    name: str
    repeat: RepeatText
    note: str


class Patterns(ResultModel):
    """All named patterns."""

    patterns: list[PatternResult]


def patterns(request: NoRequest, context: Context) -> Patterns:
    """Repeats to start from: the four fabrics, ribs, basket and more."""
    del request, context
    return Patterns(
        patterns=[PatternResult.of(p, id=p.identifier, repeat=p.chart.key) for p in PATTERNS]
    )


OPERATION = Operation(
    patterns,
    method="GET",
    tag="charts",
    summary="Named patterns",
)

"""Named patterns to start from."""

from __future__ import annotations

from knitcore.chart.patterns import PATTERNS

from ...context import Context
from ...requests.base import NoRequest, ResultModel
from ...requests.charts import RepeatText
from ..registry import Operation


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

"""Charts to start from: a typed text, and named patterns."""

from knitcore.chart.patterns import PATTERNS
from knitcore.chart.stitch_chart import StitchChart

from ...context import Context
from ...requests.base import NoRequest, RequestModel, ResultModel
from ...requests.charts import ChartLines, ChartText, RepeatText
from ..registry import Operation


class ParseRequest(RequestModel):
    """A chart as typed text."""

    text: ChartText


class ParsedChart(ResultModel):
    """A chart in canonical form and its smallest repeat."""

    rows: int
    columns: int
    text: ChartLines
    repeat: RepeatText


def parse(request: ParseRequest, context: Context) -> ParsedChart:
    """K/P lines, the top row first; errors name line and stitch."""
    del context
    chart = StitchChart.parse(request.text)
    return ParsedChart.of(chart, repeat=chart.repeat_cut().key)


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


PARSE = Operation(
    parse,
    path="/charts/parse",
    tag="charts",
    summary="Read a chart text and find its repeat",
    example={"text": "KPKP\nPKPK"},
)
PATTERNS_SHOWN = Operation(patterns, method="GET", tag="charts", summary="Named patterns")

"""Reading a typed chart."""

from __future__ import annotations

from knitcore.chart.stitch_chart import StitchChart

from ...context import Context
from ...requests.base import RequestModel, ResultModel
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


OPERATION = Operation(
    parse,
    path="/charts/parse",
    tag="charts",
    summary="Read a chart text and find its repeat",
    example={"text": "KPKP\nPKPK"},
)

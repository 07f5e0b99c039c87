"""Repeats relaxed in a yarn of the paper's samples."""

from typing import Any

from knitcore.chart.fabric import Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.model.paper_samples import Sample
from knitcore.yarn.study.relax import relax


def relaxed(chart: StitchChart | Fabric | str, entry: Sample, **options: Any) -> Any:
    """A repeat, or that of a pure fabric, in the yarn of a sample at its loop length."""
    if isinstance(chart, Fabric):
        chart = StitchChart.of_fabric(chart, 2, 2)
    elif isinstance(chart, str):
        chart = StitchChart.parse(chart)
    return relax(chart, entry.yarn, entry.loop_length_mm, **options)

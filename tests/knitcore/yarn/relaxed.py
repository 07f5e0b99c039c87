"""Repeats and single cells relaxed as the tests of several modules need them."""

from typing import Any

import numpy as np

from knitcore import Fabric, StitchChart
from knitcore.yarn.model.cell import YarnCell
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.paper_samples import Sample
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.growth import Start, grow
from knitcore.yarn.solve.newton import Options
from knitcore.yarn.study.relax import relax


def relaxed(chart: StitchChart | Fabric | str, entry: Sample, **options: Any) -> Any:
    """A repeat, or that of a pure fabric, in the yarn of a sample at its loop length."""
    if isinstance(chart, Fabric):
        chart = StitchChart.of_fabric(chart, 2, 2)
    elif isinstance(chart, str):
        chart = StitchChart.parse(chart)
    return relax(chart, entry.yarn, entry.loop_length_mm, **options)


def grown(
    cell: YarnCell,
    yarn: YarnModel,
    loop_length_mm: float,
    start: Start = Start("usual"),  # noqa: B008 - it is frozen
    *,
    convention: Convention = Convention.PUBLISHED,
    **options: Any,
) -> Any:
    """The state into which a cell with courses of one loop length grows."""
    lengths = np.full(cell.rows, loop_length_mm)
    return grow(cell, yarn, lengths, convention, start, options=Options(**options))

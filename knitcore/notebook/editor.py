"""An editor for charts in a notebook (an anywidget): paint knits and purls, and take the chart."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import anywidget
import traitlets

from knitcore.chart import StitchChart, check_stitches

MAX_STITCHES = 3600
"""Cells of a chart that can be painted."""


class ChartEditor(anywidget.AnyWidget):
    """A chart to paint with pointer or keyboard; :attr:`chart` is what is painted.

    Drag to paint the stitch that the first cell becomes. With the keyboard: arrows move, Space
    turns a stitch, K and P set it, Ctrl+Z takes back.

    Parameters
    ----------
    chart : to begin with, or its K/P lines.

    Raises
    ------
    InputError
        If it cannot be read, or has more than 3,600 stitches.

    Examples
    --------
    >>> editor = ChartEditor("KP/PK")
    >>> editor.chart.key
    'KP/PK'
    """

    _esm = Path(__file__).with_name("editor.js")
    _css = Path(__file__).with_name("editor.css")
    text = traitlets.Unicode("K").tag(sync=True)
    most_stitches = traitlets.Int(MAX_STITCHES).tag(sync=True)

    def __init__(self, chart: StitchChart | str = "KKKK/KKKK/KKKK/KKKK") -> None:
        read = StitchChart.parse(chart) if isinstance(chart, str) else chart
        super().__init__(text=_checked(read).text)

    @property
    def chart(self) -> StitchChart:
        """The painted chart; set it to show another one."""
        return StitchChart.parse(self.text)

    @chart.setter
    def chart(self, chart: StitchChart) -> None:
        self.text = _checked(chart).text

    @traitlets.validate("text")
    def _read(self, proposal: Any) -> str:
        return _checked(StitchChart.parse(proposal["value"])).text


def _checked(chart: StitchChart) -> StitchChart:
    check_stitches(chart.stitches, MAX_STITCHES, instead=", or a region")
    return chart

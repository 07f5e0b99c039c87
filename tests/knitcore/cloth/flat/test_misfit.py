"""Cloth at rest whose textures differ in gauge."""

from __future__ import annotations

import numpy as np
import pytest

from knitcore import StitchChart, material
from knitcore.cloth.flat import chart_sheet
from knitcore.cloth.flat.misfit import relaxed_shape


@pytest.mark.parametrize("above", ["K/P", "KP/PK"])
def test_a_ribbed_hem_pulls_in_below_any_texture(above: str) -> None:
    rib, texture = (StitchChart.parse(text) for text in ("KKPP", above))
    piece = StitchChart(np.vstack([rib.resized(8, 20).purl, texture.resized(16, 20).purl]))
    sheet = chart_sheet(piece, material("glove-wool"), draw_in=True)
    found = relaxed_shape(sheet)
    assert found.converged, found.problem
    corners = found.states[-1].corners.reshape(sheet.grid.rows + 1, sheet.grid.columns + 1, 2)
    widths = np.ptp(corners[..., 0], axis=1)
    assert widths[0] < 0.8 * widths[-1]
    assert np.all(np.diff(widths) > -0.01 * widths[-1])

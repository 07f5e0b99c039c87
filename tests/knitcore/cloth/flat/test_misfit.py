"""Cloth at rest whose textures differ in gauge."""

import numpy as np
import pytest

from knitcore import Fabric, StitchChart, material, strip_test
from knitcore.cloth.flat import chart_sheet, misfit, relaxed_shape
from knitcore.garment.shaped import outline_marks

ACRYLIC = material("acrylic:published")
GARTER = StitchChart.of_fabric("garter", rows=6, columns=8)


def test_one_gauge_has_no_misfit_and_two_have() -> None:
    assert misfit(chart_sheet(GARTER, ACRYLIC, draw_in=True).grid).largest < 1e-12
    halves = StitchChart(np.hstack([GARTER.purl, np.zeros_like(GARTER.purl)]))
    report = misfit(chart_sheet(halves, ACRYLIC, draw_in=True).grid)
    assert report.largest > 0.05
    assert report.by_fabric[Fabric.GARTER][1] * report.by_fabric[Fabric.STOCKINETTE][1] < 0


def test_draw_in_relaxes_the_misfit() -> None:
    halves = StitchChart(np.vstack([GARTER.purl, np.zeros_like(GARTER.purl)]))
    sheet = chart_sheet(halves, material("cotton:published"), draw_in=True)
    shape = relaxed_shape(sheet)
    assert shape.converged, shape.problem
    assert shape.energy_n_mm[-1] < sheet.energy(sheet.reference)
    drawn = strip_test(halves, material("cotton:published"), "wale", 0.2, steps=2, draw_in=True)
    assert drawn.converged, drawn.problem


def test_a_shaped_piece_draws_in() -> None:
    rib = StitchChart.parse("\n".join(["KKPPKKPP"] * 3 + ["KKKKPPPP"] * 3)).purl
    halves = StitchChart(np.hstack([rib, np.zeros_like(rib)]))
    waisted = outline_marks("xxxxxxxx\n.xxxxxx.\nxxxxxxxx\nxxxxxxxx\n.xxxxxx.\nxxxxxxxx")
    stitch = np.hstack([waisted, np.ones_like(waisted)])
    sheet = chart_sheet(halves, ACRYLIC, draw_in=True, stitch=stitch)
    assert misfit(sheet.grid).largest > 0.01
    shape = relaxed_shape(sheet)
    assert shape.converged, shape.problem
    assert shape.energy_n_mm[-1] < sheet.energy(sheet.reference)


@pytest.mark.parametrize("above", ["K/P", "KP/PK"])
def test_a_ribbed_hem_pulls_in_below_any_texture(above: str) -> None:
    rib, texture = (StitchChart.parse(text) for text in ("KKPP", above))
    piece = StitchChart(np.vstack([rib.resized(8, 20).purl, texture.resized(16, 20).purl]))
    sheet = chart_sheet(piece, material("glove-wool"), draw_in=True)
    shape = relaxed_shape(sheet)
    assert shape.converged, shape.problem
    corners = shape.states[-1].corners.reshape(sheet.grid.rows + 1, sheet.grid.columns + 1, 2)
    widths = np.ptp(corners[..., 0], axis=1)
    assert widths[0] < 0.8 * widths[-1]
    assert np.all(np.diff(widths) > -0.01 * widths[-1])

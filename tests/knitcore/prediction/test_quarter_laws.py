"""Laws of the quarter cells of a piece."""

import numpy as np
import pytest

from knitcore import StitchChart, material, predict
from knitcore.chart.fabric import PHASES, Direction, Fabric
from knitcore.cloth.flat import chart_sheet
from knitcore.prediction.quarter_laws import quarter_laws


def test_patches_of_a_repeat_go_on_through_the_piece() -> None:
    """Garter beside rib repeats every two rows; every row has the laws and sizes of both halves."""
    garter, rib = (StitchChart.of_fabric(f, rows=10, columns=40) for f in ("garter", "rib"))
    piece = StitchChart([[*g, *r] for g, r in zip(garter.purl, rib.purl, strict=True)])
    acrylic = material("acrylic")
    quarters = quarter_laws(piece, acrylic)
    assert (quarters.patch == quarters.patch[0]).all()
    np.testing.assert_allclose(
        quarters.scale, np.broadcast_to(quarters.scale[0], quarters.scale.shape), rtol=0.01
    )
    for column, fabric in ((24, "garter"), (56, "rib")):
        own, code = acrylic.law(fabric), PHASES.index(Fabric(fabric))
        law = quarters.laws[4 * int(quarters.patch[0, column]) + code]
        for direction in Direction:
            # the windows of both halves reach across the border
            assert law.modulus(direction) == pytest.approx(own.modulus(direction), rel=0.15)
    assert np.isfinite(quarters.scale).all()


def test_stitches_fold_by_their_surroundings_and_on_average_like_the_answer() -> None:
    hem, body = (StitchChart.parse(text) for text in ("KKPP", "KP/PK"))
    piece = StitchChart(np.vstack([hem.resized(20, 40).purl, body.resized(40, 40).purl]))
    acrylic = material("acrylic")
    scale = quarter_laws(piece, acrylic).scale
    assert scale[2, :, 0].max() < 0.9 * scale[50, :, 0].min()
    assert np.abs(np.diff(np.log(scale[..., 0]), axis=0)).max() < 0.1
    sheet = chart_sheet(piece, acrylic)
    assert sheet.grid.width_mm == pytest.approx(
        40 * predict(piece, acrylic).relaxed_course_mm, rel=0.02
    )

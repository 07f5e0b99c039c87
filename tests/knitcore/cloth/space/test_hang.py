"""Pieces that hang."""

from pathlib import Path

import meshio
import numpy as np
import pytest

from knitcore import CancelledError, Direction, Fabric, RelaxedSize, StitchChart, material
from knitcore.chart.in_space import corners_of
from knitcore.cloth.space.hang import HungBy, hang
from knitcore.garment.shaped import outline_marks

ACRYLIC = material("acrylic")
GARTER = StitchChart.of_fabric(Fabric.GARTER, rows=24, columns=8)


def test_a_piece_gets_longer_by_its_weight() -> None:
    """By half of what its whole weight would do at the end: w L² / 2 Y of a free strip."""
    hung = hang(GARTER, ACRYLIC, linear_density_g_per_m=0.5)
    record = ACRYLIC.record(Fabric.GARTER)
    width = 8 * record.stitch_course_mm
    stress = hung.weight_n / width
    free, held = 1.0 / record.law.modulus(Direction.WALE), 1.0 / record.law.stiffness_yyyy
    assert hung.converged
    assert 0.5 * stress * held <= hung.lengthening <= 1.02 * 0.5 * stress * free
    assert hung.depth_mm < 0.1


def test_twice_the_weight_pulls_twice_as_far() -> None:
    light, heavy = (hang(GARTER, ACRYLIC, linear_density_g_per_m=density) for density in (0.3, 0.6))
    assert heavy.weight_n == pytest.approx(2.0 * light.weight_n)
    assert heavy.lengthening == pytest.approx(2.0 * light.lengthening, rel=0.03)


def test_held_by_its_corners_the_top_edge_sags() -> None:
    edge, corners = (
        hang(GARTER, ACRYLIC, linear_density_g_per_m=0.5, by=by)
        for by in (HungBy.EDGE, HungBy.CORNERS)
    )
    assert corners.corners_mm[-1, 4, 1] < edge.corners_mm[-1, 4, 1] - 0.05


def test_the_bottom_of_stockinette_rolls_to_the_front_against_its_weight() -> None:
    hung = hang(StitchChart.parse("K").tile(12, 8), ACRYLIC, linear_density_g_per_m=0.5)
    assert hung.converged
    assert hung.corners_mm[0, 4, 2] > 0.5


def test_it_can_be_cancelled() -> None:
    with pytest.raises(CancelledError):
        hang(GARTER, ACRYLIC, linear_density_g_per_m=0.5, cancelled=lambda: True)


def test_a_piece_with_a_hole_hangs_by_its_highest_edge(tmp_path: Path) -> None:
    stitches = outline_marks("..xxxx..\nxxxxxxxx\nxxx..xxx\nxxx..xxx\nxxxxxxxx\n........")
    chart = StitchChart.of_fabric(Fabric.GARTER, rows=6, columns=8)
    hung = hang(chart, ACRYLIC, linear_density_g_per_m=0.5, stitches=stitches)
    whole = hang(chart, ACRYLIC, linear_density_g_per_m=0.5)
    assert hung.converged
    assert hung.weight_n == pytest.approx(whole.weight_n * stitches.mean(), rel=0.01)
    held = hung.corners_mm[-1, 2:7]
    assert not np.ptp(held[:, 1:], axis=0).any()
    height = ACRYLIC.record(Fabric.GARTER).stitch_wale_mm
    assert hung.drop_mm == pytest.approx(5 * height, rel=0.1)
    assert np.array_equal(hung.used, corners_of(stitches))
    hung.write(tmp_path / "x.vtu")
    assert len(meshio.read(tmp_path / "x.vtu").cells[0].data) == np.count_nonzero(stitches)


def test_a_piece_that_was_counted_larger_hangs_lower_and_has_more_yarn() -> None:
    """Loops are longer by the root of the area: 1.1 times here."""
    record = ACRYLIC.record(Fabric.GARTER)
    counted = RelaxedSize(1.1 * record.stitch_course_mm, 1.1 * record.stitch_wale_mm)
    plain, large = (
        hang(GARTER, ACRYLIC, linear_density_g_per_m=0.5, size=size) for size in (None, counted)
    )
    assert large.weight_n == pytest.approx(1.1 * plain.weight_n, rel=0.01)
    assert large.width_mm == pytest.approx(1.1 * plain.width_mm, rel=0.01)
    assert large.drop_mm == pytest.approx(1.1 * plain.drop_mm, rel=0.01)

"""Shapes that a knitter knows."""

from __future__ import annotations

import numpy as np
import pytest

from knitcore.answer.choose import choose
from knitcore.chart import StitchChart
from knitcore.errors import CancelledError, InputError
from knitcore.fabric import Fabric
from knitcore.materials import material
from knitcore.shell.curl import CurledPiece, curl

ACRYLIC = material("acrylic")


def _piece(repeat: str, across: int, up: int) -> CurledPiece:
    piece = curl(StitchChart.parse(repeat).tile(up, across), ACRYLIC)
    assert piece.converged
    return piece


def test_the_sides_of_stockinette_roll_to_the_back_and_its_ends_to_the_front() -> None:
    piece = _piece("K", 12, 12)
    assert piece.curl_course_mm < 0.0 < piece.curl_wale_mm
    tall, wide = _piece("K", 6, 20), _piece("K", 16, 4)
    assert tall.curl_course_mm < -0.5 * tall.thickness_mm
    assert wide.curl_wale_mm > 0.5 * wide.thickness_mm


def test_reverse_stockinette_rolls_the_other_way() -> None:
    tall = _piece("P", 6, 20)
    assert tall.curl_course_mm > 0.5 * tall.thickness_mm


@pytest.mark.parametrize("fabric", [Fabric.GARTER, Fabric.RIB, Fabric.SEED])
def test_balanced_fabrics_lie_flat_at_their_size(fabric: Fabric) -> None:
    piece = curl(StitchChart.of_fabric(fabric, rows=16, columns=16), ACRYLIC)
    record = ACRYLIC.record(fabric)
    assert piece.converged
    assert piece.depth_mm < 0.1
    assert piece.width_mm == pytest.approx(16 * record.stitch_course_mm, rel=1e-3)
    assert piece.height_mm == pytest.approx(16 * record.stitch_wale_mm, rel=1e-3)


def test_a_strip_rolls_up_into_scrolls_as_tight_as_it_can() -> None:
    """From both ends: each holds half of its length, π R² = length times thickness."""
    piece = _piece("K", 30, 2)
    length = float(np.ptp(piece.flat_mm[..., 0]))
    expected = np.sqrt(0.5 * length * piece.thickness_mm / np.pi)
    assert 0.5 * piece.depth_mm == pytest.approx(expected, rel=0.2)


def _block(knits: int) -> str:
    wide = "K" * knits + "P" * knits
    return "/".join([wide] * knits + [wide[::-1]] * knits)


@pytest.mark.parametrize(
    ("repeat", "up", "across"),
    [
        ("KKPP", 20, 6),
        ("KKKPPP", 20, 4),
        ("KKKKKKPPPPPP", 20, 3),
        ("K/K/P/P", 6, 16),
        ("K/K/K/P/P/P", 4, 16),
        (_block(3), 3, 3),
        (_block(4), 3, 3),
    ],
    ids=["2x2 rib", "3x3 rib", "6x6 rib", "2-2 welt", "3-3 welt", "3x3 basket", "4x4 basket"],
)
def test_folds_are_as_wide_and_high_as_the_relaxed_fabric(
    repeat: str, up: int, across: int
) -> None:
    """Extent of the inner repeats, over that of the answer."""
    chart = StitchChart.parse(repeat)
    piece = curl(chart.tile(up, across), ACRYLIC)
    assert piece.converged
    answer = choose(chart, ACRYLIC)
    for axis, along in ((1, answer.course), (0, answer.wale)):
        line = piece.corners_mm.mean(axis=1 - axis)
        ends = line[[chart.purl.shape[axis], -1 - chart.purl.shape[axis]]]
        count = len(line) - 1 - 2 * chart.purl.shape[axis]
        assert np.linalg.norm(ends[1] - ends[0]) / count == pytest.approx(along.relaxed_mm, rel=0.1)


def test_welts_draw_in_along_the_columns() -> None:
    piece = _piece("P\nP\nP\nK\nK\nK", 12, 3)
    flat = np.ptp(piece.flat_mm, axis=(0, 1))
    assert piece.height_mm < 0.85 * flat[1]
    assert piece.width_mm > 0.9 * flat[0]


def test_a_basket_pillows() -> None:
    piece = _piece(_block(4), 2, 2)
    assert piece.depth_mm > 2.0 * piece.thickness_mm


def test_a_single_stitch_is_flat() -> None:
    piece = curl(StitchChart.parse("K"), ACRYLIC)
    assert piece.converged
    assert piece.curl_course_mm == pytest.approx(0.0, abs=1e-6)


def test_a_test_that_did_not_converge_is_marked() -> None:
    piece = curl(StitchChart.parse("K").tile(20, 20), ACRYLIC, time_limit_s=0.0)
    assert not piece.converged


def test_a_piece_too_large_is_refused() -> None:
    with pytest.raises(InputError, match="stitches"):
        curl(StitchChart.of_fabric("garter", rows=101, columns=100), ACRYLIC)


def test_it_can_be_cancelled() -> None:
    with pytest.raises(CancelledError):
        curl(StitchChart.parse("K").tile(9, 9), ACRYLIC, cancelled=lambda: True)

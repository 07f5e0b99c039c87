"""Starts: a piece bent as a strip of it."""

import numpy as np
import pytest

from knitcore import CancelledError, Fabric, StitchChart, material
from knitcore.cloth.space.rolled import extruded, start, strip_of
from knitcore.cloth.space.sheet_shape import settle, shake_mm
from knitcore.cloth.space.stitch_sheet import sheet_of

ACRYLIC = material("acrylic")
NONE = np.zeros((0, 2), dtype=np.int64)


@pytest.mark.parametrize("axis", [0, 1])
def test_a_bent_sheet_has_the_energy_of_its_strip(axis: int) -> None:
    """But for the lines across, which stay straight: the same whatever the bend."""
    sheet = sheet_of(StitchChart.parse("K").tile(7, 5), ACRYLIC)
    strip = strip_of(sheet, axis)
    count = (5, 7)[axis]
    rises = []
    for height in (0.3, 1.0):
        shape = strip.flat_mm.copy()
        shape[:, 2] += height * np.cos(0.2 * shape[:, 1 - axis])
        rises.append(
            sheet.energy(extruded(sheet, axis, shape), NONE)[0]
            - count * strip.energy(shape, NONE)[0]
        )
    assert rises[0] == pytest.approx(rises[1], rel=1e-9)


def test_stockinette_begins_in_scrolls_from_its_ends() -> None:
    sheet = sheet_of(StitchChart.parse("K").tile(12, 20), ACRYLIC)
    begun = start(sheet).reshape(13, 21, 3)
    assert np.ptp(begun[..., 1]) < 0.5 * np.ptp(sheet.flat_mm[:, 1])
    assert begun[[0, -1], :, 2].mean() > begun[6, :, 2].mean()  # ends to the front


def test_a_long_piece_begins_with_its_sides_rolled_to_the_back() -> None:
    sheet = sheet_of(StitchChart.parse("K").tile(24, 6), ACRYLIC)
    begun = start(sheet).reshape(25, 7, 3)
    assert np.ptp(begun[..., 1]) == pytest.approx(np.ptp(sheet.flat_mm[:, 1]), rel=0.05)
    assert begun[:, [0, -1], 2].mean() < begun[:, 3, 2].mean()


def test_what_lies_flat_begins_flat() -> None:
    sheet = sheet_of(StitchChart.of_fabric(Fabric.SEED, rows=6, columns=6), ACRYLIC)
    assert np.allclose(start(sheet), sheet.flat_mm, atol=0.01)


def test_a_descent_ends_after_so_many_steps() -> None:
    """The long strip of a piece of 3 x 400 stitches must not take longer than the piece."""
    sheet = sheet_of(StitchChart.parse("K").tile(6, 6), ACRYLIC)
    shape = sheet.flat_mm + shake_mm(sheet.flat_mm.shape)
    ended = settle(sheet, shape, max_steps=8)
    assert 8 <= ended.steps < 16
    assert not ended.converged
    assert settle(sheet, shape).steps > 16


def test_it_can_be_cancelled() -> None:
    sheet = sheet_of(StitchChart.parse("K").tile(6, 6), ACRYLIC)
    with pytest.raises(CancelledError):
        start(sheet, cancelled=lambda: True)
